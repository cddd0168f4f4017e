// Samplers of the analytic scattering models, reciprocity, and energy.
#include <catch2/catch.hpp>

#include "sampling_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using namespace lucerna::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

Surface diffuse(double reflectance, double transmittance) {
    Surface surface;
    surface.add(Diffuse{surface.spectrum(ramp(reflectance, 0.5 * reflectance)),
                        surface.spectrum(ramp(0.5 * transmittance, transmittance))});
    return surface;
}

Surface rough_metal(double roughness) {
    Surface surface;
    surface.add(RoughConductor{surface.spectrum(ramp(0.1, 1.0)), surface.spectrum(ramp(2.0, 6.0)),
                               roughness});
    return surface;
}

Surface rough_glass(double roughness, const Lanes& index) {
    Surface surface;
    surface.index_below = index;
    surface.dispersive = (index != index[0]).any();
    surface.add(RoughDielectric{roughness});
    return surface;
}

Surface mixture() {
    Surface surface;
    const BsdfId paint =
        surface.add(Diffuse{surface.spectrum(lanes(0.6)), surface.spectrum(lanes(0.2))});
    const BsdfId metal = surface.add(
        RoughConductor{surface.spectrum(lanes(0.5)), surface.spectrum(lanes(4.0)), 0.4});
    surface.add(Mixture{{{0.5, paint}, {0.4, metal}}});
    return surface;
}

// Any direction; of three, one within half a degree of the surface.
Vec3 any_direction(RandomStream& random) {
    const double turn = 360.0 * random.uniform();
    const double theta = 180.0 * random.uniform();
    return direction(random.uniform() < 1.0 / 3.0 ? 90.0 + (theta - 90.0) / 180.0 : theta, turn);
}

const std::vector<Vec3>& directions() {
    static const std::vector<Vec3> list{direction(0.0, 0.0), direction(30.0, 70.0),
                                        direction(65.0, 200.0), direction(84.0, 310.0),
                                        direction(140.0, 20.0)};
    return list;
}

}  // namespace

TEST_CASE("The diffuse sampler follows its density", "[statistical]") {
    check_sampler(diffuse(0.6, 0.3), direction(GENERATE(0.0, 80.0, 130.0), 20.0), Transport::flux);
}

TEST_CASE("A diffuse sheet chooses the side first", "[property]") {
    check_sides(diffuse(0.6, 0.3), direction(GENERATE(20.0, 130.0), 20.0), Transport::radiance);
    const Surface paint = diffuse(0.6, 0.0), mixed = mixture();
    CHECK_FALSE(event_split(paint.bsdf(), paint.at(), Vec3::UnitZ(), Transport::flux).has_both());
    CHECK_FALSE(event_split(mixed.bsdf(), mixed.at(), Vec3::UnitZ(), Transport::flux).has_both());
}

TEST_CASE("A mixture scatters below the u_lobe that its specular components begin with",
          "[property]") {
    Surface surface;
    const BsdfId paint =
        surface.add(Diffuse{surface.spectrum(lanes(0.6)), surface.spectrum(lanes(0.0))});
    const BsdfId mirror = surface.add(Mirror{surface.spectrum(lanes(0.9))});
    const BsdfId metal =
        surface.add(SmoothConductor{surface.spectrum(lanes(0.5)), surface.spectrum(lanes(4.0))});
    surface.add(Mixture{{{0.6, paint}, {0.1, mirror}, {0.2, metal}}});
    const Vec3 wo = direction(30.0, 70.0);
    const EventSplit split = event_split(surface.bsdf(), surface.at(), wo, Transport::radiance);
    CHECK_THAT(split.first, WithinRel(0.6 / 0.9, 1e-12));
    CHECK(split.probability_of(wo, direction(50.0, 10.0)) == split.first);
    for (int i = 0; i < 100; ++i) {
        const double u_lobe = (i + 0.5) / 100.0;
        const auto event =
            sample(surface.bsdf(), surface.at(), wo, u_lobe, 0.3, 0.4, Transport::radiance);
        REQUIRE(event);
        CHECK(event->specular == (u_lobe >= split.first));
    }
    surface.add(Mixture{{{0.1, mirror}, {0.6, paint}}});
    CHECK_FALSE(event_split(surface.bsdf(), surface.at(), wo, Transport::radiance).has_both());
}

TEST_CASE("The sampler of rough metal follows its density", "[statistical]") {
    const double roughness = GENERATE(0.15, 0.5, 1.0);
    CAPTURE(roughness);
    for (const Vec3& wo : directions())
        check_sampler(rough_metal(roughness), wo, Transport::radiance);
}

TEST_CASE("The sampler of rough glass follows its density", "[statistical]") {
    // The density of refraction ends abruptly where facets stand upright, which calls for a finer
    // quadrature the rougher they are.
    const auto [roughness, parts, detects] =
        GENERATE(table<double, int, double>({{0.15, 4, 0.025}, {0.35, 4, 0.025}, {0.9, 12, 0.04}}));
    CAPTURE(roughness);
    const Surface surface = rough_glass(roughness, lanes(1.5));
    for (const Vec3& wo : directions()) {
        check_sampler(surface, wo, Transport::radiance, parts, {detects});
    }
    check_sampler(surface, direction(30.0, 70.0), Transport::flux, parts, {detects});
}

TEST_CASE("Rough dispersive glass is unbiased on every lane", "[statistical]") {
    Surface surface = rough_glass(0.2, ramp(1.4, 1.8));
    surface.hero_only = GENERATE(false, true);
    check_sampler(surface, direction(GENERATE(40.0, 150.0), 70.0), Transport::radiance);
}

TEST_CASE("The sampler of a mixture follows its density", "[statistical]") {
    check_sampler(mixture(), direction(GENERATE(20.0, 75.0), 20.0), Transport::flux);
}

TEST_CASE("A sampler that leaves out the cosine is found", "[statistical]") {
    // Twin of the checks above: uniform directions against the cosine density.
    const auto uniform_hemisphere = [](double, double u1, double u2) -> std::optional<Vec3> {
        const double s = std::sqrt(1.0 - u1 * u1);
        return Vec3(s * std::cos(2.0 * pi * u2), s * std::sin(2.0 * pi * u2), u1);
    };
    const auto cosine = [](const Vec3& w) { return std::max(0.0, w.z()) / pi; };
    const DirectionCells cells;
    const Density uniform = [](const Vec3& w) { return w.z() > 0.0 ? 0.5 / pi : 0.0; };
    check_refutes(cells.counts(uniform_hemisphere, 10'000), cells.expected(uniform, 10'000),
                  cells.expected(cosine, 10'000));
}

TEST_CASE("Light may travel either way: f(out, in, radiance) = f(in, out, flux)", "[property]") {
    // Both are the f of light that goes from a to b.
    const Surface surface =
        GENERATE(diffuse(0.6, 0.3), rough_metal(0.3), mixture(), rough_glass(0.3, lanes(1.5)),
                 rough_glass(0.3, ramp(1.4, 1.8)));
    RandomStream random(5, 0, RandomPurpose::test, 0);
    for (int i = 0; i < 300; ++i) {
        const Vec3 a = any_direction(random), b = any_direction(random);
        const Lanes backward = evaluate(surface.bsdf(), surface.at(), b, a, Transport::radiance);
        const Lanes forward = evaluate(surface.bsdf(), surface.at(), a, b, Transport::flux);
        REQUIRE(((backward - forward).abs() <= 2e-5f * backward + 1e-12f).all());
    }
}

TEST_CASE("f / n_out^2 is symmetric", "[property]") {
    // Reciprocity across a boundary, Veach 1997, eq. 5.14: f(i -> o) / n_o^2 = f(o -> i) / n_i^2.
    const Surface surface =
        GENERATE(diffuse(0.6, 0.3), rough_metal(0.3), rough_glass(0.3, lanes(1.5)),
                 rough_glass(0.3, ramp(1.4, 1.8)));
    const bool boundary = std::holds_alternative<RoughDielectric>(surface.bsdf());
    RandomStream random(6, 0, RandomPurpose::test, 0);
    int transmitted = 0;
    for (int i = 0; i < 300; ++i) {
        const Vec3 a = any_direction(random), b = any_direction(random);
        const auto index = [&](const Vec3& w) -> Lanes {
            return w.z() > 0.0 ? surface.index_above : surface.index_below;
        };
        const Lanes ab =
            evaluate(surface.bsdf(), surface.at(), b, a, Transport::radiance) / index(b).square();
        const Lanes ba =
            evaluate(surface.bsdf(), surface.at(), a, b, Transport::radiance) / index(a).square();
        if (a.z() * b.z() < 0.0 && !boundary) continue;  // transmittances are alike by construction
        transmitted += a.z() * b.z() < 0.0 && ab.maxCoeff() > 0.0f;
        REQUIRE(((ab - ba).abs() <= 5e-5f * ab + 1e-12f).all());
    }
    if (boundary) CHECK(transmitted > 20);
}

TEST_CASE("No surface scatters more than arrives", "[property]") {
    for (const Vec3& wo : directions()) {
        for (const double roughness : {0.1, 0.5, 1.0}) {
            // A metal that reflects all: k -> infinity.
            Surface metal;
            metal.add(
                RoughConductor{metal.spectrum(lanes(1.0)), metal.spectrum(lanes(1e4)), roughness});
            CHECK(quadrature_albedo(metal, wo, Transport::flux)[0] < 1.001);
            CHECK(quadrature_albedo(rough_glass(roughness, lanes(1.5)), wo, Transport::flux)[0] <
                  1.001);
        }
    }
}

TEST_CASE("No surface scatters more than arrives at grazing incidence", "[property]") {
    // By samples, since no quadrature resolves lobes of half a degree. In a boundary the flux is
    // never scaled up; the factors 1/n^2 and n^2 of radiance have a test of their own.
    const double theta_deg = GENERATE(88.0, 89.5, 89.99, 90.01, 91.0, 92.0);
    CAPTURE(theta_deg);
    Surface metal;
    metal.add(RoughConductor{metal.spectrum(lanes(1.0)), metal.spectrum(lanes(1e4)),
                             GENERATE(0.05, 0.4, 1.0)});
    Surface smooth_metal;
    smooth_metal.add(
        SmoothConductor{smooth_metal.spectrum(lanes(0.1)), smooth_metal.spectrum(lanes(6.0))});
    for (const Surface& surface :
         {diffuse(0.7, 0.3), metal, smooth_metal, mixture(), rough_glass(0.05, lanes(1.5)),
          rough_glass(0.4, lanes(1.5)), rough_glass(1.0, lanes(1.5))}) {
        CAPTURE(surface.bsdf().index());
        const MeanWeight weight =
            mean_weight(surface, direction(theta_deg, 50.0), Transport::flux, 2000);
        CHECK((weight.mean >= 0.0).all());
        CHECK((weight.mean <= 1.0 + 1e-5 + level_1e6 * weight.standard_error).all());
        CHECK((weight.standard_error < 0.03).all());
    }
}

TEST_CASE("Single scattering of GGX at normal incidence loses what a second facet would catch",
          "[unit]") {
    // Documented loss: at normal incidence G1(wo) = 1 and the share that leaves at once is the
    // integral of D(m) cos(m) G1(wi) over m with wi = reflect(wo, m); here by quadrature over the
    // slope angle.
    const double roughness = GENERATE(0.1, 0.5, 1.0);
    double leaves = 0.0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        const double theta = pi / 4.0 * (i + 0.5) / steps;  // beyond 45 deg wi points down
        const double tan2 = std::tan(theta) * std::tan(theta), a2 = roughness * roughness;
        const double c = std::cos(theta);
        const double d = 1.0 / (pi * a2 * c * c * c * c * (1.0 + tan2 / a2) * (1.0 + tan2 / a2));
        const double tan_i = std::tan(2.0 * theta);
        const double g1 = 2.0 / (1.0 + std::sqrt(1.0 + a2 * tan_i * tan_i));
        leaves += d * c * g1 * 2.0 * pi * std::sin(theta) * pi / 4.0 / steps;
    }
    Surface metal;
    metal.add(RoughConductor{metal.spectrum(lanes(1.0)), metal.spectrum(lanes(1e5)), roughness});
    const MeanWeight weight = mean_weight(metal, direction(0.0, 0.0), Transport::flux, 400'000);
    check_mean(weight.mean[0], weight.standard_error[0], leaves, DetectsRelative{0.02}, 1e-4);
}

TEST_CASE("Rough glass without a difference of index is not there", "[unit]") {
    const Surface surface = rough_glass(0.5, lanes(1.0));
    const Vec3 wo = direction(50.0, 10.0);
    const auto event = sample(surface.bsdf(), surface.at(), wo, 0.7, 0.2, 0.4, Transport::radiance);
    REQUIRE(event);
    CHECK(event->specular);
    CHECK(event->wi == -wo);
    CHECK((event->weight == 1.0f).all());
}

TEST_CASE("Rough glass becomes smooth glass as the roughness vanishes", "[statistical]") {
    const Surface surface = rough_glass(1e-3, lanes(1.5));
    const Vec3 wo = direction(50.0, 0.0);
    RandomStream random(9, 0, RandomPurpose::test, 0);
    int reflected = 0;
    constexpr int count = 100'000;
    for (int i = 0; i < count; ++i) {
        const double u_lobe = random.uniform(), u1 = random.uniform(), u2 = random.uniform();
        const auto event =
            sample(surface.bsdf(), surface.at(), wo, u_lobe, u1, u2, Transport::flux);
        REQUIRE(event);
        reflected += event->wi.z() > 0.0;
    }
    // R of n = 1.5 at 50 deg: 0.0577 (amplitude form)
    const double ci = std::cos(50.0 * pi / 180.0), ct = std::sqrt(1.0 - (1.0 - ci * ci) / 2.25);
    const double rs = (ci - 1.5 * ct) / (ci + 1.5 * ct), rp = (1.5 * ci - ct) / (1.5 * ci + ct);
    const double r = 0.5 * (rs * rs + rp * rp);
    CHECK_THAT(static_cast<double>(reflected) / count,
               WithinAbs(r, 4.9 * std::sqrt(r * (1.0 - r) / count)));
}

TEST_CASE("A mixture passes on specular events of its components", "[unit]") {
    Surface surface;
    const BsdfId mirror = surface.add(Mirror{surface.spectrum(lanes(0.9))});
    const BsdfId paint =
        surface.add(Diffuse{surface.spectrum(lanes(0.5)), surface.spectrum(lanes(0.0))});
    surface.add(Mixture{{{0.2, mirror}, {0.6, paint}}});
    CHECK(has_specular_lobe(surface.bsdf(), surface.bsdfs));
    CHECK(has_scattering_lobe(surface.bsdf(), surface.bsdfs));
    const Vec3 wo = direction(30.0, 0.0);
    double total = 0.0;
    constexpr int count = 1000;
    for (int i = 0; i < count; ++i) {
        const auto event =
            sample(surface.bsdf(), surface.at(), wo, (i + 0.5) / count, 0.3, 0.4, Transport::flux);
        total += static_cast<double>(event->weight[0]) / count;
    }
    CHECK_THAT(total, WithinAbs(0.2 * 0.9 + 0.6 * 0.5, 1e-3));
}

TEST_CASE("What a material can do is told from its kind", "[unit]") {
    Surface surface = diffuse(0.5, 0.0);
    const std::vector<spectral::Spectrum> spectra{0.5, 0.0, 0.1};
    CHECK_FALSE(transmits(Diffuse{0, 1}, surface.bsdfs, spectra));
    CHECK(transmits(Diffuse{0, 2}, surface.bsdfs, spectra));
    CHECK(transmits(SmoothDielectric{}, surface.bsdfs, spectra));
    CHECK_FALSE(transmits(Mirror{0}, surface.bsdfs, spectra));
    CHECK_FALSE(has_specular_lobe(Black{}, surface.bsdfs));
    CHECK_FALSE(has_scattering_lobe(Black{}, surface.bsdfs));
    CHECK(has_specular_lobe(SmoothDielectric{}, surface.bsdfs));
    CHECK(has_scattering_lobe(RoughDielectric{0.1}, surface.bsdfs));
}
