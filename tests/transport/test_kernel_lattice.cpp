// Light in kernels that is interpolated between points of a lattice.
#include <catch2/catch.hpp>

#include <chrono>
#include <thread>

#include "core/parallel.h"
#include "optics/transport/forward_maps.h"
#include "optics/transport/path.h"
#include "validation/scene_builder.h"

using namespace lucerna;
using namespace lucerna::optics;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

// Linear along each axis, as interpolation keeps it.
std::optional<Arriving> of_point(int i, int j) {
    const double density = 2.0 + 3.0 * i - j + 0.5 * i * j;
    return Arriving{Lanes::Constant(static_cast<float>(density)),
                    Lanes::Constant(static_cast<float>(0.1 * density)), 10.0f};
}

double of_place(double x, double y) {
    return 2.0 + 3.0 * x - y + 0.5 * x * y;
}

}  // namespace

TEST_CASE("A lattice interpolates between the four points around a place", "[unit]") {
    // One with room, and one without.
    for (const std::size_t room : {std::size_t{1} << 12, std::size_t{16}}) {
        const KernelLattice lattice(room);
        int gathers = 0;
        const auto gather = [&](int i, int j) {
            ++gathers;
            return of_point(i, j);
        };
        RandomStream random(1, 0, RandomPurpose::test, 0);
        for (int i = 0; i < 2000; ++i) {
            const double x = 20.0 * random.uniform() - 10.0, y = 20.0 * random.uniform() - 5.0;
            const auto light = lattice.between({7, true, false}, x, y, gather);
            REQUIRE(light);
            CHECK_THAT(static_cast<double>(light->density[3]), WithinAbs(of_place(x, y), 1e-4));
            CHECK_THAT(static_cast<double>(light->bias[0]), WithinAbs(0.1 * of_place(x, y), 1e-5));
            CHECK_THAT(light->photons, WithinAbs(10.0, 1e-5));
        }
        if (room > 16) CHECK(gathers == 21 * 21);  // each point once
    }
}

TEST_CASE("Lattices of patches, sides and single wavelengths are different ones", "[unit]") {
    const KernelLattice lattice(1 << 12);
    const auto found = [&](const KernelLattice::Side& side, float value) {
        const auto gather = [&](int, int) -> std::optional<Arriving> {
            return Arriving{Lanes::Constant(value), Lanes::Zero(), 1.0f};
        };
        return lattice.between(side, 0.3, 0.6, gather)->density[0];
    };
    float value = 0.0f;
    for (const std::uint32_t patch : {0u, 1u, 2u, 4194303u}) {
        for (const bool above : {false, true}) {
            for (const bool hero_only : {false, true}) {
                value += 1.0f;
                CHECK_THAT(found({patch, above, hero_only}, value), WithinRel(value, 1e-6f));
                CHECK_THAT(found({patch, above, hero_only}, -1.0f), WithinRel(value, 1e-6f));
            }
        }
    }
}

TEST_CASE("Nothing is interpolated with a point that is none, nor beyond the lattice", "[unit]") {
    const KernelLattice lattice(1 << 10);
    int gathers = 0;
    const auto gather = [&](int i, int j) -> std::optional<Arriving> {
        ++gathers;
        return i == 5 ? std::nullopt : of_point(i, j);
    };
    for (int round = 0; round < 2; ++round) {
        CHECK(lattice.between({0, true, false}, 3.5, 0.5, gather));
        CHECK_FALSE(lattice.between({0, true, false}, 4.5, 0.5, gather));
        CHECK_FALSE(lattice.between({0, true, false}, 5.5, 0.5, gather));
    }
    CHECK(gathers == 4 + 1);  // (3, 4) x (0, 1), and (5, 0), which ends two look-ups
    CHECK_FALSE(lattice.between({0, true, false}, 1e6, 0.5, gather));
    CHECK_FALSE(lattice.between({0, true, false}, 0.5, -1e300, gather));
    CHECK_FALSE(lattice.between({0, true, false}, std::nan(""), 0.5, gather));
    CHECK_FALSE(lattice.between({0, true, false}, 0.5, std::nan(""), gather));
    CHECK_FALSE(lattice.between({1u << 22, true, false}, 0.5, 0.5, gather));
}

TEST_CASE("A lattice holds the same whichever threads fill it", "[unit]") {
    const KernelLattice lattice(1 << 11);
    // Long enough for other threads to come to the same point meanwhile.
    const auto slowly = [](int i, int j) {
        std::this_thread::sleep_for(std::chrono::microseconds(50));
        return of_point(i, j);
    };
    constexpr std::size_t blocks = 64;
    std::vector<int> wrong(blocks);
    for_each_block(blocks, 8, [&](std::size_t block) {
        for (int i = 0; i < 400; ++i) {
            const double x = i % 20 + 0.3, y = i / 20 + 0.8;
            const auto light = lattice.between({0, false, false}, x, y, slowly);
            const double error = static_cast<double>(light->density[0]) - of_place(x, y);
            if (!(std::abs(error) < 1e-3)) ++wrong[block];
        }
    });
    CHECK(wrong == std::vector<int>(blocks));
}

namespace {

constexpr double shared_kernel_m = 0.1;

// A white plate under photons from above.
struct Plate {
    validation::SceneBuilder scene;
    BsdfId paint = scene.diffuse(1.0);
    ObjectId plate = scene.object("plate", Rectangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, paint);

    explicit Plate(double wall_at_m = 0.0) {
        if (wall_at_m > 0.0) {
            scene.object("wall", Rectangle{{wall_at_m, 0, 0}, {0, 1, 0}, {0, 0, 1}}, paint);
        }
        scene.light("light", PointLight{{0, 0, 1}}, 1.0);
        scene.receiver(plate);
    }
    SurfacePoint at(double x, double y) const { return {{x, y, 0}, Vec3::UnitZ(), plate}; }
    Photon photon(double x, double y, double flux) const {
        return {at(x, y), -Vec3::UnitZ(), Lanes::Constant(static_cast<float>(flux)),
                History::indirect};
    }
};

// What is seen of a map at a place, as part of so large an area.
class View {
public:
    View(const Plate& plate, const Stage& stage)
        : plate_(plate), stage_(stage), phase_(stage, 1, 0) {}

    template <typename Use>
    auto with_point(double x, double y, double seen_m2, bool hero_only, const Use& use) const {
        const SurfacePoint point = plate_.at(x, y);
        const Frame frame(point.normal);
        const Vec3 wo = Vec3::UnitZ();
        const SurfaceOptics optics = optics_at(phase_, no_object, no_object, hero_only, 0);
        GatherPoint at{point, frame, wo, stage_.parts().bsdfs[plate_.paint], optics};
        at.seen_m2 = seen_m2;
        return use(at);
    }
    Gathered of(const ForwardMap& map, const Radii& radii, double x, double y, double seen_m2,
                bool hero_only = false) const {
        return with_point(x, y, seen_m2, hero_only,
                          [&](const GatherPoint& at) { return map.gather(phase_, radii, at); });
    }
    const Phase& phase() const { return phase_; }

private:
    const Plate& plate_;
    const Stage& stage_;
    Phase phase_;
};

constexpr double small_m2 = 1e-3 * shared_kernel_m * shared_kernel_m;

}  // namespace

TEST_CASE("What is interpolated has the bias that it states, in the mean over lattices",
          "[analytic]") {
    // E = 1 - 0.2 d^2, d in radii: kernels have the bias -0.2 / 2, and between points at a distance
    // h along both axes -0.2 * 2 h^2 / 6.
    const Plate plate;
    const Stage stage(plate.scene.parts);
    const View view(plate, stage);
    const Vec2 centre(0.5, 0.4);
    const double step_m = shared_kernel_m / 60.0, rays = 7.0;
    std::vector<Photon> photons{plate.photon(0, 0, 0.0)};
    for (int i = -110; i < 110; ++i) {
        for (int j = -110; j < 110; ++j) {
            const Vec2 offset((i + 0.5) * step_m, (j + 0.5) * step_m);
            const double field =
                1.0 - 0.2 * offset.squaredNorm() / (shared_kernel_m * shared_kernel_m);
            const Vec2 q = centre + offset;
            photons.push_back(plate.photon(q.x(), q.y(), field * step_m * step_m * rays));
        }
    }
    const Radii radii(std::vector<double>(stage.patch_count(), shared_kernel_m));
    constexpr int offsets = 5;
    double irradiance = 0.0, bias = 0.0;
    for (int i = 0; i < offsets; ++i) {
        for (int j = 0; j < offsets; ++j) {
            // The first photon, which brings nothing, lays the lattice.
            const double x = 0.2 + spacing_per_radius * shared_kernel_m * (i + 0.5) / offsets;
            const double y = 0.7 + spacing_per_radius * shared_kernel_m * (j + 0.5) / offsets;
            photons.front() = plate.photon(x, y, 0.0);
            const ForwardMap map(stage, radii, {&photons, 1}, static_cast<std::uint64_t>(rays), 1);
            const Gathered light = view.of(map, radii, centre.x(), centre.y(), small_m2);
            irradiance += pi * static_cast<double>(light.radiance[0]) / (offsets * offsets);
            bias += pi * static_cast<double>(light.bias[0]) / (offsets * offsets);
        }
    }
    const double of_lattice = -0.2 * 2.0 * spacing_per_radius * spacing_per_radius / 6.0;
    CHECK_THAT(irradiance, WithinAbs(1.0 - 0.1 + of_lattice, 1.5e-3));
    CHECK_THAT(bias, WithinAbs(-0.1 + of_lattice, 1.5e-3));
    CHECK(std::abs(of_lattice) > 10 * 1.5e-3);  // the twin: the bias of the kernels alone
}

namespace {

std::vector<Photon> at_random(const Plate& plate, int count) {
    std::vector<Photon> photons;
    RandomStream random(3, 0, RandomPurpose::test, 0);
    for (int i = 0; i < count; ++i) {
        const double x = random.uniform();
        photons.push_back(plate.photon(x, random.uniform(), random.uniform()));
        photons.back().on_common_lane = i % 3 == 0;
    }
    return photons;
}

bool are_same(const Gathered& a, const Gathered& b) {
    return (a.radiance == b.radiance).all() && (a.bias == b.bias).all() && a.photons == b.photons;
}

}  // namespace

TEST_CASE("Where much is seen of a surface its points share gathers, but at its rims", "[unit]") {
    const Plate plate;
    const Stage stage(plate.scene.parts);
    const View view(plate, stage);
    const std::vector<Photon> photons = at_random(plate, 200000);
    const Radii radii(std::vector<double>(stage.patch_count(), shared_kernel_m));
    const ForwardMap map(stage, radii, {&photons, 1}, 1000, 1);
    for (const bool hero_only : {false, true}) {
        const Gathered own = view.of(map, radii, 0.5, 0.4, infinity, hero_only);
        const Gathered shared = view.of(map, radii, 0.5, 0.4, small_m2, hero_only);
        CHECK_FALSE(are_same(own, shared));
        // 6300 photons each, most of them the same.
        CHECK_THAT(shared.radiance[0], WithinRel(own.radiance[0], 0.03f));
        CHECK_THAT(static_cast<float>(shared.photons),
                   WithinRel(static_cast<float>(own.photons), 0.03f));
        // A cell has 0.0025 m2, of which this gather stands for 1e-5 m2.
        CHECK_THAT(shared.summed, WithinRel(0.004f * static_cast<float>(shared.photons), 1e-3f));
        CHECK(own.summed == static_cast<float>(own.photons));
    }
    const auto shares = [&](double x, double y, double seen_m2) {
        return !are_same(view.of(map, radii, x, y, infinity), view.of(map, radii, x, y, seen_m2));
    };
    CHECK(shares(0.5, 0.4, 0.49 * 0.0025));
    CHECK_FALSE(shares(0.5, 0.4, 0.51 * 0.0025));
    // A corner of its cell lies off the plate, and so does one at the corner of the plate.
    CHECK_FALSE(shares(1e-4, 0.4, small_m2));
    CHECK_FALSE(shares(0.4, 1.0 - 1e-4, small_m2));
    CHECK_FALSE(shares(1.0 - 1e-4, 1.0 - 1e-4, small_m2));
    // The rim cuts kernels of its cell.
    CHECK(shares(0.06, 0.4, small_m2));
    CHECK(view.of(map, radii, 0.06, 0.4, small_m2).left < 1.0f);
    CHECK(shares(0.16, 0.4, small_m2));
    CHECK(view.of(map, radii, 0.16, 0.4, small_m2).left == 1.0f);
}

TEST_CASE("A lattice that is tilted by the digits of a normal stands for points near its plane",
          "[unit]") {
    const Plate plate;
    const Stage stage(plate.scene.parts);
    const View view(plate, stage);
    std::vector<Photon> photons = at_random(plate, 20000);
    const Radii radii(std::vector<double>(stage.patch_count(), shared_kernel_m));
    for (const bool tilted : {false, true}) {
        photons.front() = plate.photon(0.2, 0.2, 0.0);
        if (tilted) photons.front().point.normal = Vec3(1e-5, 0.0, 1.0).normalized();
        const ForwardMap map(stage, radii, {&photons, 1}, 1000, 1);
        const Gathered own = view.of(map, radii, 0.7, 0.5, infinity);
        CHECK(are_same(own, view.of(map, radii, 0.7, 0.5, small_m2)) == tilted);
    }
}

TEST_CASE("Kernels are not shared near a barrier that those around would reach across", "[unit]") {
    // A wall on the plate, 1.3 radii from the point: its own kernel does not reach it.
    const Plate plate(0.63);
    const Stage stage(plate.scene.parts);
    const View view(plate, stage);
    const std::vector<Photon> photons = at_random(plate, 20000);
    const Radii radii(std::vector<double>(stage.patch_count(), shared_kernel_m));
    ForwardMaps maps;
    maps.indirect = ForwardMap(stage, radii, {&photons, 1}, 1000, 1);
    maps.indirect_radii = radii;
    const auto found = [&](double x, bool looks_for_barriers) {
        return view.with_point(x, 0.5, small_m2, false, [&](const GatherPoint& at) {
            return maps.gather(view.phase(), at, mask(History::indirect), 1.0, looks_for_barriers);
        });
    };
    const auto own = [&](double x) { return view.of(maps.indirect, radii, x, 0.5, infinity); };
    CHECK(are_same(found(0.5, true).light, own(0.5)));
    CHECK(found(0.5, true).cut);
    CHECK_FALSE(are_same(found(0.5, false).light, own(0.5)));
    CHECK_FALSE(are_same(found(0.44, true).light, own(0.44)));
    CHECK_FALSE(found(0.44, true).cut);
}

namespace {

// Of photons on the strip beside the rim x = 0, around y = 0.5: E = 1 + d, d the distance from the
// rim in kernel radii.
std::vector<Photon> slope_beside_rim(const Plate& plate, double rays) {
    const double step_m = shared_kernel_m / 80.0;
    std::vector<Photon> photons{plate.photon(0, 0, 0.0)};
    for (int i = 0; i < 240; ++i) {
        for (int j = -120; j < 120; ++j) {
            const double x = (i + 0.5) * step_m, y = 0.5 + (j + 0.5) * step_m;
            const double field = 1.0 + x / shared_kernel_m;
            photons.push_back(plate.photon(x, y, field * step_m * step_m * rays));
        }
    }
    return photons;
}

// A disc of radius r at the distance d from a rim, cut or not.
struct CutDisc {
    double left = 1.0;    // of its area
    double middle = 0.0;  // of what is left: distance from the centre of the disc

    CutDisc(double r, double d) {
        if (d >= r) return;
        const double half_chord = std::sqrt(r * r - d * d);
        const double left_area = pi * r * r - (r * r * std::acos(d / r) - d * half_chord);
        left = left_area / (pi * r * r);
        middle = 2.0 / 3.0 * half_chord * half_chord * half_chord / left_area;
    }
};

}  // namespace

TEST_CASE("What is interpolated beside a rim comes from kernels with radii of their own",
          "[analytic]") {
    // Where whole kernels have the radius r and half ones r share, those at the distance d have
    // what cut_radius_m() says, and in the mean over lattices a point reads the mean of them
    // weighed by a triangle of half the base h.
    const Plate plate;
    const Stage stage(plate.scene.parts);
    const View view(plate, stage);
    constexpr double rays = 7.0;
    std::vector<Photon> photons = slope_beside_rim(plate, rays);
    Radii first(std::vector<double>(stage.patch_count(), shared_kernel_m));
    first.tell_cut_kernels_apart();
    const Radii radii = first.at_phase(63);
    const double r = radii[0] / shared_kernel_m, h = spacing_per_radius * r;
    const double d = 0.6 * r;  // all points of its cells lie on the plate

    double irradiance = 0.0, bias = 0.0, left = 0.0;
    constexpr int offsets = 40;
    for (int i = 0; i < offsets; ++i) {
        const double x = 0.2 + h * shared_kernel_m * (i + 0.5) / offsets;
        photons.front() = plate.photon(x, 0.5, 0.0);  // lays the lattice
        const ForwardMap map(stage, radii, {&photons, 1}, static_cast<std::uint64_t>(rays), 1);
        const Gathered light = view.of(map, radii, d * shared_kernel_m, 0.5, small_m2);
        irradiance += pi * static_cast<double>(light.radiance[0]) / offsets;
        bias += pi * static_cast<double>(light.bias[0]) / offsets;
        left += static_cast<double>(light.left) / offsets;
    }

    const auto expected = [&](double share) {
        Vec3 mean(0, 0, 0);  // of E, of what is left, and of the bias that two radii tell
        constexpr int steps = 400;
        for (int i = 0; i < steps; ++i) {
            const double t = 2.0 * (i + 0.5) / steps - 1.0;
            const double there = d + t * h, of_whole = 2.0 * CutDisc(r, there).left - 1.0;
            const double own = r * (share + (1.0 - share) * of_whole);
            const CutDisc disc(own, there), inner(inner_radius_factor * own, there);
            const double told = (2.0 + 2.0 * std::numbers::sqrt2 * (1.0 - inner.left)) *
                                (disc.middle - inner.middle);
            // Between points, the O(r^2) of whole discs grows by a sixth: see the test above.
            const double between = 1.0 + (2.0 * disc.left - 1.0) / 6.0;
            mean += (1.0 - std::abs(t)) * 2.0 / steps *
                    Vec3(1.0 + there + disc.middle, disc.left, told * between);
        }
        return mean;
    };
    const Vec3 mean = expected(radii.share_of_cut());
    INFO("E " << irradiance << " for " << mean.x() << ", left " << left << " for " << mean.y()
              << ", bias " << bias << " for " << mean.z());
    CHECK_THAT(irradiance, WithinAbs(mean.x(), 1e-3));
    CHECK_THAT(left, WithinAbs(mean.y(), 1e-3));
    CHECK(std::abs(expected(1.0).x() - mean.x()) > 10 * 1e-3);  // the twin: radii not their own
    CHECK(std::abs(expected(1.0).y() - mean.y()) > 10 * 1e-3);
    CHECK_THAT(bias, WithinRel(mean.z(), 0.01));
}

TEST_CASE("Kernels that a rim cuts shrink faster, and their bias with them", "[analytic]") {
    // E = 1 + d, d the distance from the rim in first radii. Half of a disc around a point of the
    // rim has its middle at 4 r / 3 pi. Whole kernels of the phase number 64 have 64^(-1/10) of the
    // first radius; a half one has 64^(-1/6), a half.
    const Plate plate;
    const Stage stage(plate.scene.parts);
    const View view(plate, stage);
    constexpr double rays = 7.0;
    const std::vector<Photon> photons = slope_beside_rim(plate, rays);
    Radii first(std::vector<double>(stage.patch_count(), shared_kernel_m));
    const auto at_rim = [&](const Radii& radii) {
        const ForwardMap map(stage, radii, {&photons, 1}, static_cast<std::uint64_t>(rays), 1);
        const Gathered light = view.of(map, radii, 1e-9, 0.5, small_m2);
        return pi * static_cast<double>(light.radiance[0]);
    };
    const auto of_radius = [](double radii) { return 1.0 + 4.0 * radii / (3.0 * pi); };
    CHECK(std::abs(at_rim(first.at_phase(63)) - of_radius(std::pow(64.0, -0.1))) < 0.01);
    first.tell_cut_kernels_apart();
    const double in_first = at_rim(first.at_phase(0)), later = at_rim(first.at_phase(63));
    INFO("E of the first phase " << in_first << ", of the 64th " << later);
    CHECK(std::abs(in_first - of_radius(1.0)) < 0.01);
    CHECK(std::abs(later - of_radius(0.5)) < 0.01);
    CHECK_FALSE(std::abs(later - of_radius(std::pow(64.0, -0.1))) < 0.01);

    // Between, in proportion to what is left beyond half of the disc.
    const auto left = [](double share) {
        return KernelAreas{share * pi, 0.5 * share * pi, share == 1.0};
    };
    CHECK(cut_radius_m(left(1.0), 1.0, 0.4) == 1.0);
    CHECK(std::abs(cut_radius_m(left(0.75), 1.0, 0.4) - 0.7) < 1e-12);
    CHECK(std::abs(cut_radius_m(left(0.3), 1.0, 0.4) - 0.4) < 1e-12);
}
