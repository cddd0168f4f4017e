// Forward paths that leave their first scattering event in several directions.
#include "optics/transport/plan.h"
#include "tests/support/check_mean.h"
#include "tests/support/cornell_scenes.h"
#include "tests/support/traced_scene.h"

using namespace lucerna;
using namespace lucerna::optics;
using test::SceneBuilder;
using test::TracedScene;

TEST_CASE("Split paths bring the flux of all orders of reflection", "[analytic]") {
    // A closed sphere that scatters 0.12 of what arrives and mirrors 0.08. Of each lumen emitted 1
    // arrives directly, 0.08 + 0.08^2 + ... = 2/23 by mirror reflection alone, and in all
    // 1 + 0.2 + 0.2^2 + ... = 5/4, so that 1/4 - 2/23 has been scattered. It is so dark that a path
    // which split at each event would still come to an end.
    constexpr double flux_lm = 100.0;
    SceneBuilder builder;
    const BsdfId diffuse = builder.diffuse(0.2);
    const BsdfId mirror = builder.mirror(0.2);
    builder.receiver(
        builder.object("sphere", Sphere{Vec3::Zero(), 1.0},
                       builder.parts.add(Bsdf{Mixture{{{0.6, diffuse}, {0.4, mirror}}}})));
    builder.light("lamp", PointLight{{0.3, 0.1, 0.0}}, flux_lm);
    const TracedScene traced(builder);

    constexpr std::uint32_t phases = 60, rays = 4000;
    Estimate direct_lm, caustic_lm, indirect_lm;
    for (std::uint32_t number = 0; number < phases; ++number) {
        const Phase phase(traced.stage, 1, number);
        ForwardTally tally(traced.stage.parts());
        constexpr std::uint8_t all =
            mask(History::direct) | mask(History::caustic) | mask(History::indirect);
        double direct = 0.0, caustic = 0.0, indirect = 0.0;
        int uneven = 0;
        for (const Photon& photon : trace_photons(
                 phase, traced.context, Emission(phase, RandomPurpose::indirect, {}, rays),
                 Reach::whole_path_split, all, rays, tally)) {
            const double photon_lm = phase.luminous(photon.flux);
            const bool whole = photon.history == History::direct;
            (whole                                ? direct
             : photon.history == History::caustic ? caustic
                                                  : indirect) += photon_lm / rays;
            // Each path splits once, and roulette keeps the flux of what is left of it.
            const double expected_lm = tally.emitted / rays / (whole ? 1 : 4);
            if (std::abs(photon_lm - expected_lm) > 1e-4 * expected_lm) ++uneven;
        }
        CHECK(uneven == 0);
        direct_lm.add(direct, 0.0);
        caustic_lm.add(caustic, 0.0);
        indirect_lm.add(indirect, 0.0);
    }
    const auto check = [](const Estimate& estimate, double truth_lm) {
        test::check_mean(estimate.mean(), estimate.standard_error(), truth_lm, {0.03});
    };
    check(direct_lm, flux_lm);
    check(caustic_lm, 2.0 / 23.0 * flux_lm);
    check(indirect_lm, (1.0 / 4.0 - 2.0 / 23.0) * flux_lm);
    // Were five parts of a quarter each followed:
    CHECK_FALSE(test::agrees(indirect_lm.mean(), indirect_lm.standard_error(),
                             5.0 / 4.0 * (1.0 / 4.0 - 2.0 / 23.0) * flux_lm));
}

TEST_CASE("The directions of a split fill the lobe evenly", "[analytic]") {
    // A beam onto a white plate at the centre of a dark sphere. Over a Lambert lobe the component
    // x of the direction has the variance 1/4, and the mean over 4 directions that know nothing of
    // each other a quarter of that; cos theta has the mean 2/3.
    SceneBuilder builder;
    const ObjectId plate =
        builder.object("plate", Disk{Vec3::Zero(), Vec3::UnitZ(), 0.01}, builder.diffuse(1.0));
    builder.receiver(builder.object("sphere", Sphere{Vec3::Zero(), 1.0}, builder.diffuse(1e-6)));
    builder.light("beam",
                  BeamLight{Disk{0.5 * Vec3::UnitZ(), -Vec3::UnitZ(), 0.001}, -Vec3::UnitZ()}, 1.0);
    const TracedScene traced(builder);
    const Phase phase(traced.stage, 1, 0);
    const Emission emission(phase, RandomPurpose::indirect);
    constexpr std::uint32_t rays = 4000;
    Estimate x, cosine;
    double square_sum = 0.0;
    for (std::uint32_t ray = 0; ray < rays; ++ray) {
        ForwardTally tally(traced.stage.parts());
        Vec3 sum = Vec3::Zero();
        int directions_found = 0;
        trace_forward(phase, emission, ray, Reach::whole_path_split, nullptr, tally,
                      [&](const Photon& photon) {
                          if (photon.point.object == plate) return;
                          sum += photon.direction;
                          ++directions_found;
                      });
        CHECK(directions_found == 4);
        x.add(sum.x() / 4.0, 0.0);
        cosine.add(sum.z() / 4.0, 0.0);
        square_sum += sum.x() * sum.x() / 16.0;
    }
    const double variance = square_sum / rays;
    INFO("variance " << variance);
    CHECK(variance < 0.5 * 0.25 / 4.0);
    CHECK(test::agrees(x.mean(), x.standard_error(), 0.0));
    test::check_mean(cosine.mean(), cosine.standard_error(), 2.0 / 3.0, {0.02});
    CHECK_FALSE(test::agrees(cosine.mean(), cosine.standard_error(), 0.5));  // all directions alike
}

TEST_CASE("Of split paths all light is accounted for") {
    const TracedScene traced(test::cornell_caustic(16));
    constexpr std::uint32_t phases = 40, rays = 1000;
    Estimate residue;
    for (std::uint32_t number = 0; number < phases; ++number) {
        const Phase phase(traced.stage, 1, number);
        ForwardTally tally(traced.stage.parts());
        trace_photons(phase, traced.context, Emission(phase, RandomPurpose::indirect, {}, rays),
                      Reach::whole_path_split, mask(History::indirect), rays, tally);
        double found =
            tally.escaped + tally.trapped + tally.inconsistent + tally.numerical + tally.residue;
        for (const double absorbed : tally.absorbed_by_object) found += absorbed;
        for (const double absorbed : tally.absorbed_by_solid) found += absorbed;
        // Ten or so roundings of floats a ray.
        CHECK(std::abs(found - tally.emitted) < 1e-6 * tally.emitted);
        residue.add(tally.residue / tally.emitted, 0.0);
    }
    INFO("residue " << residue.mean() << " +/- " << residue.standard_error());
    CHECK(test::agrees(residue.mean(), residue.standard_error(), 0.0));
    CHECK(residue.standard_error() < 0.01);
}

TEST_CASE("Paths that receivers count are not split for images") {
    const auto reach = [](bool receiver) {
        SceneBuilder scene = test::cornell_diffuse(16);
        if (receiver) scene.receiver(0);
        const TracedScene traced(scene);
        return make_plan(traced.context, traced.settings).indirect_reach;
    };
    CHECK(reach(false) == Reach::whole_path_split);
    CHECK(reach(true) == Reach::whole_path);
}
