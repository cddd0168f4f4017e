// Rays that are sent where they are of use: they still stand for all light, and have less noise.
#include "optics/transport/plan.h"
#include "tests/support/traced_scene.h"
#include "tests/support/truth_checks.h"
#include "validation/truth/luminance_weights.h"

using namespace lucerna;
using namespace lucerna::optics;
using test::SceneBuilder;

namespace {

constexpr std::array<double, 2> fluxes{1.0, 3.0};

/// What a ray brings: 8 from a sixteenth of the choices of the first light, 1/4 from half of those
/// of the second. Mean over all rays: 1/4 * 8/16 + 3/4 * 1/8 = 7/32; mean square 1/4 * 64/16 +
/// 3/4 * 1/32. Rays in proportion to what they bring come from the first light in 4 of 7 cases.
double brought(const Departure& ray) {
    if (ray.light == 0) return ray.u[0] < 0.25 && ray.u[1] >= 0.75 ? 8.0 : 0.0;
    return ray.u[3] < 0.5 ? 0.25 : 0.0;
}
constexpr double mean_brought = 7.0 / 32.0, mean_square_brought = 1.0 + 3.0 / 128.0;

EmissionGuide taught(std::uint32_t rays) {
    const DiscreteDistribution lights(fluxes);
    std::vector<RayOfUse> teachers;
    for (std::uint32_t i = 0; i < rays; ++i) {
        RandomStream random(1, 0, RandomPurpose::test, i);
        Departure ray{lights.sample(random.uniform()), {}, 1.0};
        for (double& u : ray.u) u = random.uniform();
        teachers.push_back({ray, brought(ray) * brought(ray)});
    }
    return {fluxes, teachers};
}

/// A mirror disk of radius 0.1 at half a metre from a point source in the middle of a sphere.
struct MirrorInSphere : test::TracedScene {
    static constexpr double radius_m = 0.1, distance_m = 0.5, reflectance = 0.9, flux_lm = 100.0;

    MirrorInSphere() : TracedScene(builder()) {}
    static SceneBuilder builder() {
        SceneBuilder builder;
        builder.object("sphere", Sphere{Vec3::Zero(), 1.0}, builder.diffuse(0.2));
        builder.object("mirror", Disk{{distance_m, 0, 0}, -Vec3::UnitX(), radius_m},
                       builder.mirror(reflectance));
        builder.light("lamp", PointLight{Vec3::Zero()}, flux_lm);
        builder.camera({0.2, 0, 0}, {-1, 0, 0}, Vec3::UnitZ(), 2.0, 32, 32);
        return builder;
    }

    /// Flux of the photons that the mirror sends to the sphere, over phases.
    template <typename MakeEmission>
    Estimate caustic_flux_lm(std::uint32_t phases, std::uint32_t rays,
                             const MakeEmission& make_emission) const {
        Estimate estimate;
        for (std::uint32_t number = 0; number < phases; ++number) {
            const Phase phase(stage, 1, number);
            ForwardTally unused(stage.parts());
            double flux = 0.0;
            for (const Photon& photon :
                 trace_photons(phase, context, make_emission(phase), Reach::first_scattering,
                               mask(History::caustic), rays, unused)) {
                flux += phase.luminous(photon.flux);
            }
            estimate.add(flux / rays, 0.0);
        }
        return estimate;
    }
};

}  // namespace

TEST_CASE("Guided rays stand for all rays, with less variance") {
    const EmissionGuide guide = taught(1 << 14);
    constexpr int rays = 1 << 16;
    double sum = 0.0, square = 0.0, sum_without_weights = 0.0;
    std::array<int, 2> of_lights{};
    for (std::uint32_t i = 0; i < rays; ++i) {
        RandomStream random(2, 0, RandomPurpose::test, i);
        const std::size_t light = guide.lights().sample(random.uniform());
        std::array<double, 4> u{};
        for (double& number : u) number = random.uniform();
        const Departure ray = guide.depart(light, u);
        for (const double number : ray.u) REQUIRE((number >= 0.0 && number < 1.0));
        ++of_lights[ray.light];
        const double value = brought(ray) * ray.weight;
        sum += value;
        square += value * value;
        sum_without_weights += brought(ray);
    }
    const double mean = sum / rays;
    const double error = std::sqrt((square / rays - mean * mean) / rays);
    test::check_mean(mean, error, mean_brought, {0.05});
    CHECK_FALSE(test::agrees(sum_without_weights / rays, error, mean_brought));
    CHECK(of_lights[0] > 2 * rays / 5);  // without a guide 1 / 4, by the best 4 / 7
    // The best of all densities has the square of the mean, 1 / 21 of that without a guide.
    INFO("mean square " << square / rays);
    CHECK(square / rays < 2.0 * mean_brought * mean_brought);
    CHECK(mean_square_brought > 20.0 * mean_brought * mean_brought);
}

TEST_CASE("Where no ray is of use, nothing is learned") {
    CHECK(EmissionGuide().empty());
    CHECK(EmissionGuide(fluxes, std::vector<RayOfUse>(100)).empty());
    CHECK_FALSE(taught(1 << 10).empty());
}

TEST_CASE("Evenly spread rays give each light its number") {
    SceneBuilder scene;
    scene.object("floor", Rectangle{{-1, -1, -9}, {2, 0, 0}, {0, 2, 0}}, scene.black());
    const std::array<double, 3> flux_lm{1.0, 2.0, 5.0};
    for (const double flux : flux_lm) scene.light("lamp", PointLight{{0, 0, flux}}, flux);
    scene.meter({0, 0, -8}, {0, 0, -9}, 0.1);
    const Stage stage(scene.parts);
    constexpr std::uint32_t rays = 1001, phases = 400;
    std::array<double, 3> sums{};
    for (std::uint32_t number = 0; number < phases; ++number) {
        const Phase phase(stage, 1, number);
        const Emission emission(phase, RandomPurpose::caustic, {}, rays);
        std::array<int, 3> counts{};
        for (std::uint32_t i = 0; i < rays; ++i) {
            RandomStream random = emission.random(i);
            const Departure departure = emission.depart(i, random);
            CHECK(departure.weight == 1.0);
            ++counts[departure.light];
        }
        for (std::size_t light = 0; light < 3; ++light) {
            CHECK(std::abs(counts[light] - rays * flux_lm[light] / 8.0) < 1.0);
            sums[light] += counts[light];
        }
    }
    // A count is one of two neighbours: its variance is 1/4 at most.
    for (std::size_t light = 0; light < 3; ++light) {
        test::check_mean(sums[light] / phases, 0.5 / std::sqrt(phases), rays * flux_lm[light] / 8.0,
                         {0.002});
    }
}

TEST_CASE("Guided photons carry the light of a small mirror", "[analytic]") {
    const MirrorInSphere room;
    const Plan plan = make_plan(room.context, room.settings);
    REQUIRE_FALSE(plan.caustic_guide.empty());
    // The mirror's solid angle is 2 pi (1 - cos a), tan a = radius / distance.
    const double cosine = 1.0 / std::hypot(1.0, room.radius_m / room.distance_m);
    const double truth = room.reflectance * room.flux_lm * (1.0 - cosine) / 2.0;
    constexpr std::uint32_t phases = 32, rays = 4096;
    const auto of = [&](const auto& make_emission) {
        return room.caustic_flux_lm(phases, rays, make_emission);
    };
    const Estimate plain =
        of([](const Phase& phase) { return Emission(phase, RandomPurpose::caustic); });
    const Estimate guided = of([&](const Phase& phase) {
        return Emission(phase, RandomPurpose::caustic, plan.caustic_guide);
    });
    const Estimate spread = of([&](const Phase& phase) {
        return Emission(phase, RandomPurpose::caustic, plan.caustic_guide, rays);
    });
    const Estimate even =
        of([&](const Phase& phase) { return Emission(phase, RandomPurpose::caustic, {}, rays); });
    test::check_mean(plain.value(), plain.standard_error(), truth, {0.3});
    test::check_mean(guided.value(), guided.standard_error(), truth, {0.05});
    test::check_mean(spread.value(), spread.standard_error(), truth, {0.02});
    // Twin: as much light as if both sides of the mirror were lit.
    CHECK_FALSE(test::agrees(guided.value(), guided.standard_error(), 2.0 * truth));
    CHECK_FALSE(test::agrees(spread.value(), spread.standard_error(), 1.02 * truth));
    CHECK(even.standard_error() < 0.5 * plain.standard_error());
    CHECK(guided.standard_error() < 0.2 * plain.standard_error());
    CHECK(spread.standard_error() < guided.standard_error());
}

TEST_CASE("Heavy guided rays go both ways at glass", "[analytic]") {
    // A beam falls straight onto a plate: 2 R / (1 + R) of it come back. The guide was told that
    // 1/16 of the choices are of use, so that rays elsewhere carry 4 times their natural flux or
    // so. Dispersive glass leaves them one wavelength each, which many phases even out.
    const bool disperses = GENERATE(false, true);
    CAPTURE(disperses);
    const auto index_at = [&](double nm) { return disperses ? 1.2 + 0.002 * (nm - 480.0) : 1.5; };
    constexpr double flux_lm = 100.0;
    SceneBuilder scene;
    const MediumId glass = scene.medium(1.5);
    scene.parts.media[glass].dispersive = disperses;
    if (disperses) {
        scene.parts.spectra[scene.parts.media[glass].index] = spectral::Spectrum(
            {380.0, 480.0, 780.0}, {1.2, 1.2, index_at(780.0)}, spectral::Outside::hold);
    }
    scene.solid("plate", Box{Placement::Identity(), {1.0, 1.0, 0.01}}, glass);
    const Vec3 down = -Vec3::UnitZ();
    scene.light("beam", BeamLight{Disk{{0.5, 0.5, 0.5}, down, 0.1}, down}, flux_lm);
    scene.receiver(scene.object("room", Sphere{{0.5, 0.5, 0.0}, 2.0}, scene.diffuse(0.5)));
    const Stage stage(scene.parts);
    std::vector<RayOfUse> teachers;
    for (std::uint32_t i = 0; i < 1 << 14; ++i) {
        RandomStream random(1, 0, RandomPurpose::test, i);
        Departure ray;
        for (double& u : ray.u) u = random.uniform();
        teachers.push_back({ray, ray.u[0] < 0.25 && ray.u[1] < 0.25 ? 1.0 : 0.0});
    }
    const EmissionGuide guide(std::array{flux_lm}, teachers);

    const std::uint32_t phases = disperses ? 1024 : 32, rays = disperses ? 128 : 4096;
    Estimate up, all;
    double heaviest_emitted = 0.0, heaviest_reflected = 0.0;  // over the natural flux
    for (std::uint32_t number = 0; number < phases; ++number) {
        const Phase phase(stage, 1, number);
        const Emission emission(phase, RandomPurpose::caustic, guide);
        ForwardTally tally(stage.parts());
        double up_lm = 0.0, all_lm = 0.0;
        for (std::uint32_t i = 0; i < rays; ++i) {
            RandomStream random = emission.random(i);
            heaviest_emitted = std::max(heaviest_emitted, emission.depart(i, random).weight);
            trace_forward(phase, emission, i, Reach::first_scattering, nullptr, tally,
                          [&](const Photon& photon) {
                              const double photon_lm = phase.luminous(photon.flux);
                              all_lm += photon_lm;
                              if (photon.point.position.z() < 0.0) return;
                              up_lm += photon_lm;
                              heaviest_reflected =
                                  std::max(heaviest_reflected, photon_lm / flux_lm);
                          });
        }
        up.add(up_lm / rays);
        all.add(all_lm / rays);
        CHECK(tally.emitted - tally.absorbed_by_object[1] - tally.residue ==
              Approx(0.0).margin(1e-6 * tally.emitted));
    }
    const auto one_side = [&](double nm) {
        const double n = index_at(std::clamp(nm, 480.0, 780.0));
        return square((n - 1.0) / (n + 1.0));
    };
    const double reflected_lm = flux_lm * truth::luminous_mean([&](double nm) {
                                    return 2.0 * one_side(nm) / (1.0 + one_side(nm));
                                });
    test::check_mean(up.value(), up.standard_error(), reflected_lm, {0.05});
    test::check_mean(all.value(), all.standard_error(), flux_lm, {0.05});
    // Twin: as much light as if only the upper side reflected.
    CHECK_FALSE(
        test::agrees(up.value(), up.standard_error(), flux_lm * truth::luminous_mean(one_side)));
    CHECK(heaviest_emitted > 3.0);
    // By the luck of one reflection it would carry as much.
    CHECK(heaviest_reflected < (disperses ? 1.0 : 0.25));  // its wavelength may be a bright one
}
