// The same seed gives the same bits for any number of threads.
#include <catch2/catch.hpp>
#include <cstring>

#include "optics/transport/simulate.h"
#include "tests/support/cornell_scenes.h"

using namespace lucerna;
using namespace lucerna::optics;

namespace {

Result run(int threads, std::uint64_t seed, Method method, Scheduler scheduler = Scheduler::ordered,
           bool disperses = false) {
    auto scene = test::cornell_caustic(40);
    if (disperses) {
        Medium& glass = scene.parts.media.at(0);
        glass.dispersive = true;
        glass.index = scene.parts.add(
            spectral::Spectrum({360.0, 830.0}, {1.56, 1.50}, spectral::Outside::hold));
    }
    scene.points({{0.5, 0.4, 0.5}, {0.2, 0.4, 0.5}}, Vec3::UnitY());
    scene.receiver(0);
    Settings settings;
    settings.method = method;
    settings.threads = threads;
    settings.scheduler = scheduler;
    settings.seed = seed;
    settings.max_phases = 3;
    settings.forward_rays = 5000;
    settings.spectral_bins = 10;
    return simulate(scene.parts, settings);
}

bool same_bits(const Result& a, const Result& b) {
    const Image& p = a.images.front();
    const Image& q = b.images.front();
    const auto same = [](const auto& u, const auto& v) {
        return u.size() == v.size() &&
               std::memcmp(u.data(), v.data(), u.size() * sizeof(u[0])) == 0;
    };
    bool equal = same(p.luminance, q.luminance) && same(p.x, q.x) && same(p.z, q.z) &&
                 same(p.spectral_radiance, q.spectral_radiance);
    for (std::size_t i = 0; i < a.quantities.size(); ++i) {
        const Quantity &one = a.quantities[i], &other = b.quantities[i];
        equal = equal && one.estimate.mean() == other.estimate.mean() &&
                one.result().value == other.result().value &&
                one.colour.has_value() == other.colour.has_value() &&
                (!one.colour || one.colour->x.value == other.colour->x.value);
    }
    return equal && a.flux_balance_lm.absorbed == b.flux_balance_lm.absorbed;
}

}  // namespace

TEST_CASE("Same seed, same bits with 1, 2, 3 and 8 threads", "[golden]") {
    const auto method = GENERATE(Method::combined, Method::forward, Method::backward, Method::path);
    const Result one = run(1, 5, method);
    for (const int threads : {2, 3, 8}) {
        INFO(threads << " threads, method " << static_cast<int>(method));
        CHECK(same_bits(one, run(threads, 5, method)));
    }
    CHECK_FALSE(same_bits(one, run(1, 6, method)));
}

TEST_CASE("Sensors behind dispersive glass read the same bits with 1 and 3 threads", "[golden]") {
    const Result one = run(1, 5, Method::combined, Scheduler::ordered, true);
    CHECK(same_bits(one, run(3, 5, Method::combined, Scheduler::ordered, true)));
    CHECK_FALSE(same_bits(one, run(1, 5, Method::combined)));  // it matters
}

TEST_CASE("Phases of their own threads give the same bits as one after the other", "[golden]") {
    const Result one = run(1, 5, Method::combined);
    for (const int threads : {2, 5}) {
        CHECK(same_bits(one, run(threads, 5, Method::combined, Scheduler::asynchronous)));
    }
}
