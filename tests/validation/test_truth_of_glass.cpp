// The truths of the families with glass against second derivations.
#include <catch2/catch.hpp>

#include "validation/truth/pane_shadow.h"
#include "validation/truth/prism.h"
#include "validation/truth/quadrature.h"
#include "validation/truth/rod_guide.h"
#include "validation/truth/round_lens.h"
#include "validation/truth/tilted_slab.h"

using namespace lucerna;
using namespace lucerna::truth;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

double radians(double degrees) {
    return degrees * pi / 180.0;
}

}  // namespace

TEST_CASE("Fresnel: the sine and tangent laws", "[unit]") {
    const double n = GENERATE(1.3, 1.5, 2.2);
    for (const double degrees : {5.0, 30.0, 56.0, 80.0, 89.0}) {
        const double in = radians(degrees);
        const double out = std::asin(std::sin(in) / n);
        const Reflection r = reflection(1.0, n, std::cos(in));
        // Born and Wolf, 7th ed., 1.5.2, eq. 21.
        CHECK_THAT(r.amplitude_s.real(),
                   WithinAbs(-std::sin(in - out) / std::sin(in + out), 1e-12));
        CHECK_THAT(r.amplitude_p.real(), WithinAbs(std::tan(in - out) / std::tan(in + out), 1e-12));
        // The same boundary from inside.
        const Reflection back = reflection(n, 1.0, std::cos(out));
        CHECK_THAT(back.reflectance_s(), WithinAbs(r.reflectance_s(), 1e-12));
        CHECK_THAT(back.reflectance_p(), WithinAbs(r.reflectance_p(), 1e-12));
    }
}

TEST_CASE("Fresnel: a rhomb of n = 1.51 shifts phases by 45 deg at 54 deg 37'", "[unit]") {
    // Born and Wolf, 7th ed., 1.5.4, below eq. 65.
    const Reflection r = reflection(1.51, 1.0, std::cos(radians(54.0 + 37.0 / 60.0)));
    CHECK_THAT(r.reflectance_s(), WithinAbs(1.0, 1e-12));
    CHECK_THAT(r.reflectance_p(), WithinAbs(1.0, 1e-12));
    const double shift = std::abs(std::arg(r.amplitude_p / r.amplitude_s));
    CHECK_THAT(shift, WithinAbs(radians(45.0), radians(0.05)));
}

TEST_CASE("Polarised ray: flux is kept, and two crossed Brewster mirrors extinguish", "[unit]") {
    const double n = 1.5;
    const Vec3 k = Vec3(0.3, -0.5, 0.8).normalized();
    const Vec3 normal = Vec3(-0.2, 0.1, 0.9).normalized();
    const PolarisedRay ray = PolarisedRay::unpolarised(k, 2.0);
    const SplitRay split = split_at_boundary(ray, normal, 1.0, n);
    REQUIRE(split.refracted);
    CHECK_THAT(split.reflected.flux() + split.refracted->flux(), WithinAbs(2.0, 1e-12));
    CHECK_THAT(split.reflected.flux(),
               WithinAbs(2.0 * reflection(1.0, n, std::abs(k.dot(normal))).reflectance(), 1e-12));
    CHECK_THAT(split.reflected.direction.dot(normal), WithinAbs(-k.dot(normal), 1e-12));
    CHECK_THAT(split.refracted->direction.cross(normal).norm() * n,
               WithinAbs(k.cross(normal).norm(), 1e-12));

    // Along +z onto a mirror at Brewster's angle that turns the light toward +x and away from z;
    // a second one whose plane of incidence is perpendicular to the first.
    const double brewster = std::atan(n);
    const PolarisedRay down = PolarisedRay::unpolarised(Vec3::UnitZ(), 1.0);
    const Vec3 first(std::sin(brewster), 0.0, -std::cos(brewster));
    const PolarisedRay turned = split_at_boundary(down, first, 1.0, n).reflected;
    const Vec3 across = Vec3::UnitY();  // the s direction of the first mirror
    const Vec3 second = -std::cos(brewster) * turned.direction + std::sin(brewster) * across;
    CHECK_THAT(split_at_boundary(turned, second, 1.0, n).reflected.flux(), WithinAbs(0.0, 1e-12));
    const Vec3 parallel = -std::cos(brewster) * turned.direction +
                          std::sin(brewster) * turned.direction.cross(across);
    const double rs = reflection(1.0, n, std::cos(brewster)).reflectance_s();
    CHECK_THAT(split_at_boundary(turned, parallel, 1.0, n).reflected.flux(),
               WithinAbs(0.5 * rs * rs, 1e-12));
}

TEST_CASE("Tilted slab: transmittance and shift", "[unit]") {
    const double degrees = GENERATE(0.0, 30.0, 60.0, 80.0);
    const double alpha = GENERATE(0.0, 5.0);
    const double n = 1.52;
    const double d = 0.02;
    const double in = radians(degrees);
    const Reflection r = reflection(1.0, n, std::cos(in));
    const double a = std::exp(-alpha * d / std::sqrt(1.0 - std::pow(std::sin(in) / n, 2)));
    // The sum of the geometric series.
    const auto summed = [&](double R) { return (1 - R) * (1 - R) * a / (1 - R * R * a * a); };
    CHECK_THAT(slab_transmittance(n, in, d, alpha),
               WithinAbs(0.5 * (summed(r.reflectance_s()) + summed(r.reflectance_p())), 1e-9));

    // The shift of the first two beams by following them through the slab 0 <= z <= d.
    const Vec3 k(std::sin(in), 0.0, std::cos(in));
    const Vec3 inside(std::sin(in) / n, 0.0, std::sqrt(1.0 - std::pow(std::sin(in) / n, 2)));
    const Vec3 exit = d / inside.z() * inside;
    const Vec3 later = exit + Vec3(2.0 * d * inside.x() / inside.z(), 0.0, 0.0);
    const Vec3 aside(-k.z(), 0.0, k.x());  // the normal's part perpendicular to the beam
    CHECK_THAT(slab_beam(n, in, d, alpha, 0).displacement_m, WithinAbs(exit.dot(aside), 1e-15));
    CHECK_THAT(slab_beam(n, in, d, alpha, 1).displacement_m, WithinAbs(later.dot(aside), 1e-15));
    // A wide beam passes whole.
    CHECK_THAT(slab_flux_beyond(n, in, d, alpha, 0.01, -10.0),
               WithinAbs(slab_transmittance(n, in, d, alpha), 1e-12));
}

TEST_CASE("Round lens: rays in space land where the truth says", "[unit]") {
    const int order = GENERATE(-1, 0, 1, 2, 3, 5);
    const RoundLens lens{true, 0.03, 1.5, 12.0, 0.07};
    for (const double height : {0.01, 0.35, 0.62, 0.8, 0.93, 0.99}) {
        PolarisedRay ray = PolarisedRay::unpolarised(Vec3::UnitZ(), 1.0);
        Vec3 position =
            lens.radius_m * Vec3(0.6 * height, 0.8 * height, -std::sqrt(1.0 - height * height));
        const SplitRay entry = split_at_boundary(ray, position / lens.radius_m, 1.0, lens.index);
        ray = order == outer_reflection ? entry.reflected : *entry.refracted;
        double passed = 1.0;
        for (int reflections = 0; reflections <= order; ++reflections) {
            const double chord_m = -2.0 * position.dot(ray.direction);
            passed *= std::exp(-lens.absorption_per_m * chord_m);
            position += chord_m * ray.direction;
            const SplitRay split =
                split_at_boundary(ray, position / lens.radius_m, lens.index, 1.0);
            ray = reflections == order ? *split.refracted : split.reflected;
        }
        const double t = (lens.screen_m - position.z()) / ray.direction.z();
        const LensRay truth = lens_ray(lens, std::asin(height), order);
        INFO("height " << height);
        REQUIRE(truth.lands == (t > 0.0));
        if (!truth.lands) continue;
        const Vec3 landing = position + t * ray.direction;
        CHECK_THAT(landing.dot(Vec3(0.6, 0.8, 0.0)), WithinAbs(truth.landing_m, 1e-9));
        CHECK_THAT(ray.flux() * passed, WithinRel(truth.transmittance, 1e-9));
        const double step = 1e-5;
        const double slope = (lens_ray(lens, std::asin(height) + step, order).landing_m -
                              lens_ray(lens, std::asin(height) - step, order).landing_m) /
                             (2.0 * step);
        CHECK_THAT(slope, WithinRel(truth.slope_m, 1e-4));
    }
}

TEST_CASE("Round lens: the axis, the rainbow and the sum of flux", "[unit]") {
    const bool ball = GENERATE(true, false);
    const double n = 1.5;
    const RoundLens lens{ball, 0.03, n, 0.0, 0.12};
    // Near the axis x = h (1 - Z / f), f = n R / (2 (n - 1)) from the centre (Hecht, Optics, 5th
    // ed., sec. 6.1).
    const double f = n * lens.radius_m / (2.0 * (n - 1.0));
    const LensRay paraxial = lens_ray(lens, 1e-5, 0);
    CHECK_THAT(paraxial.landing_m,
               WithinRel(lens.radius_m * 1e-5 * (1.0 - lens.screen_m / f), 1e-6));
    const double reflectance = std::pow((n - 1.0) / (n + 1.0), 2);
    CHECK_THAT(paraxial.transmittance, WithinRel(std::pow(1.0 - reflectance, 2), 1e-6));

    // Light of two reflections is turned least at cos i = sqrt((n^2 - 1) / 8) (van de Hulst, Light
    // Scattering by Small Particles, 13.21).
    const RoundLens drop{ball, 1.0, 1.6, 0.0, 1e9};
    const double bow = std::acos(std::sqrt((drop.index * drop.index - 1.0) / 8.0));
    const LensRay at_bow = lens_ray(drop, bow, 2);
    REQUIRE(at_bow.lands);
    CHECK(std::abs(at_bow.slope_m) < 1e-6 * std::abs(lens_ray(drop, bow - 0.1, 2).slope_m));

    // What lands on a ring (two strips) came in with the rays that land there.
    const double inner_m = 0.02;
    const double outer_m = 0.04;
    double sent = 0.0;
    constexpr int steps = 20000;
    for (int order = outer_reflection; order <= lens_orders; ++order) {
        for (int i = 0; i < steps; ++i) {
            const double in = 0.5 * pi * (i + 0.5) / steps;
            const LensRay ray = lens_ray(lens, in, order);
            const double landing_m = std::abs(ray.landing_m);
            if (!ray.lands || landing_m < inner_m || landing_m > outer_m) continue;
            const double beam_m = lens.radius_m * std::cos(in) * 0.5 * pi / steps;
            sent +=
                ray.transmittance * beam_m * (ball ? 2.0 * pi * lens.radius_m * std::sin(in) : 2.0);
        }
    }
    const double landed =
        integral([&](double x) { return lens_irradiance(lens, x) * (ball ? 2.0 * pi * x : 2.0); },
                 inner_m, outer_m, 2);
    CHECK_THAT(landed, WithinRel(sent, 1e-3));  // weak folds of high orders lie between the nodes
}

TEST_CASE("Prism: least deviation", "[unit]") {
    const double n = GENERATE(1.45, 1.6);
    const double apex = radians(50.0);
    const double in = least_deviation_incidence_rad(n, apex);
    const PrismBeam beam = prism_beam(n, apex, in);
    CHECK_THAT(std::sin(0.5 * (apex + beam.deviation_rad)) / std::sin(0.5 * apex),
               WithinAbs(n, 1e-12));
    CHECK_THAT(beam.widening, WithinAbs(1.0, 1e-12));
    for (const double aside : {-0.05, 0.05}) {
        CHECK(prism_beam(n, apex, in + aside).deviation_rad > beam.deviation_rad);
    }
    // A ray in space: faces through the apex at +-A/2 from the axis -z.
    const double angle = in + 0.07;
    const Vec3 entry_normal(-std::cos(0.5 * apex), 0.0, std::sin(0.5 * apex));
    const Vec3 exit_normal(std::cos(0.5 * apex), 0.0, std::sin(0.5 * apex));
    const Vec3 along_face(std::sin(0.5 * apex), 0.0, std::cos(0.5 * apex));  // toward the apex
    const Vec3 k = -std::cos(angle) * entry_normal + std::sin(angle) * along_face;
    const PolarisedRay inside =
        *split_at_boundary(PolarisedRay::unpolarised(k, 1.0), entry_normal, 1.0, n).refracted;
    const PolarisedRay out = *split_at_boundary(inside, exit_normal, n, 1.0).refracted;
    const PrismBeam expected = prism_beam(n, apex, angle);
    CHECK_THAT(std::acos(out.direction.dot(k)), WithinAbs(expected.deviation_rad, 1e-9));
    CHECK_THAT(out.flux(), WithinAbs(expected.transmittance, 1e-12));
}

TEST_CASE("Rod guide: what is known of it in closed form", "[unit]") {
    SECTION("light that meets the end face, as between coaxial disks") {
        const RodGuide rod{0.01, 0.1, 1.5, 0.0, 0.004, 0.007};
        const double r1 = rod.source_radius_m / rod.gap_m;
        const double r2 = rod.radius_m / rod.gap_m;
        const double s = 1.0 + (1.0 + r2 * r2) / (r1 * r1);  // Howell, A Catalog of Radiation
        const double factor = 0.5 * (s - std::sqrt(s * s - 4.0 * r2 * r2 / (r1 * r1)));  // C-41
        const RodFlux flux = rod_flux(rod);
        CHECK_THAT(flux.onto_near, WithinRel(factor, 1e-6));
        CHECK_THAT(flux.far + flux.near + flux.sides + flux.absorbed + flux.unfollowed,
                   WithinAbs(flux.onto_near, 1e-9));
        CHECK(flux.unfollowed < 1e-8);
        CHECK_THAT(flux.sides, WithinAbs(0.0, 1e-9));  // n > sqrt 2
    }
    SECTION("a small source: rays along meridians keep s and p, as in a slab") {
        const double alpha = GENERATE(0.0, 3.0);
        const RodGuide rod{0.01, 0.1, 1.5, alpha, 0.004, 1e-9};
        const double far = integral(
            [&](double angle) {
                return slab_transmittance(rod.index, angle, rod.length_m, alpha) *
                       std::sin(2.0 * angle);
            },
            0.0, std::atan(rod.radius_m / rod.gap_m));
        CHECK_THAT(rod_flux(rod).far, WithinRel(far, 1e-6));
    }
    SECTION("a source in contact: lossless total reflection leaves unpolarised light so") {
        const double alpha = GENERATE(0.0, 3.0);
        const RodGuide rod{0.01, 0.1, 1.5, alpha, 0.0, 0.01};
        const double critical = std::asin(1.0 / rod.index);
        const double far = integral(
            [&](double u) {  // u^2: a square root at the critical angle
                const double angle = critical * (1.0 - u * u);
                return (1.0 - reflection(rod.index, 1.0, std::cos(angle)).reflectance()) *
                       std::exp(-alpha * rod.length_m / std::cos(angle)) * std::sin(2.0 * angle) *
                       2.0 * u * critical;
            },
            0.0, 1.0);
        const RodFlux flux = rod_flux(rod);
        CHECK_THAT(flux.far, WithinRel(far, 1e-5));
        CHECK_THAT(flux.far + flux.near + flux.sides + flux.absorbed + flux.unfollowed,
                   WithinAbs(1.0, 1e-6));
        if (alpha > 0.0) return;
        // A long rod loses at its sides all that is not held, sin th cos g > cos i_c:
        //   integral of 4/pi cos^2 g (1 - cos^2 i_c / cos^2 g) dg over cos g > cos i_c
        const double c = std::sqrt(1.0 - 1.0 / (rod.index * rod.index));
        const double g = std::acos(c);
        const double held_not = 4.0 / pi * (0.5 * g + 0.25 * std::sin(2.0 * g) - c * c * g);
        const RodGuide longer{0.01, 2.0, 1.5, 0.0, 0.0, 0.01};
        CHECK_THAT(rod_flux(longer).sides, WithinRel(held_not, 1e-3));
    }
    SECTION("a skew ray that is held, followed one reflection at a time") {
        const RodGuide rod{0.01, 0.1, 1.5, 3.0, 0.0, 0.01};
        for (const double angle : {0.2, 0.6, 0.8}) {
            RodFlux flux;
            const Vec3 k(std::sin(angle), 0.0, std::cos(angle));
            detail::follow_in_rod(rod, {-0.003, 0.008, 0.0}, PolarisedRay::unpolarised(k, 1.0),
                                  flux);
            const double a = std::exp(-rod.absorption_per_m * rod.length_m / std::cos(angle));
            const double r = reflection(rod.index, 1.0, std::cos(angle)).reflectance();
            CHECK_THAT(flux.far, WithinAbs((1.0 - r) * a, 1e-9));
            CHECK_THAT(flux.near, WithinAbs(r * a * a, 1e-9));
            CHECK_THAT(flux.sides, WithinAbs(0.0, 1e-9));
        }
    }
    SECTION("more nodes change nothing") {
        const RodGuide rod = GENERATE(RodGuide{0.01, 0.08, 1.5, 2.0, 0.0, 0.01},
                                      RodGuide{0.01, 0.1, 1.3, 1.0, 0.004, 0.007},
                                      RodGuide{0.01, 0.1, 1.6, 1.0, 0.002, 0.009});
        const RodFlux few = rod_flux(rod, 2);
        const RodFlux many = rod_flux(rod);
        CHECK_THAT(few.far, WithinAbs(many.far, 2e-4));
        CHECK_THAT(few.near, WithinAbs(many.near, 2e-4));
        CHECK_THAT(few.sides, WithinAbs(many.sides, 2e-4));
        CHECK_THAT(few.absorbed, WithinAbs(many.absorbed, 2e-4));
    }
}

TEST_CASE("A pane of index 1 leaves the inverse square law and a straight shadow", "[analytic]") {
    const PaneShadow shadow{100.0, 1.2, 0.01, 1.0 + 1e-9, 0.3, 0.2};
    CHECK_THAT(shadow.shadow_edge_m(), WithinRel(0.2 * 1.2 / (1.2 - 0.3), 1e-6));
    for (const double x : {0.05, 0.2, 0.26}) {
        CHECK_THAT(shadow.illuminance_lx(x),
                   WithinRel(100.0 * 1.2 / std::pow(1.2 * 1.2 + x * x, 1.5), 1e-6));
    }
    CHECK(shadow.illuminance_lx(0.27) < 1e-6);
}

TEST_CASE("Light below a pane is what the pane lets through", "[analytic]") {
    // The screen is too far away to matter.
    const PaneShadow shadow{100.0, 1.0, 0.05, 1.6, 0.1, 1e3};
    const double reach = 0.9;  // of the angle, at which light that is reflected never ends
    const double edge_m = shadow.distance_m(reach, 0);
    double on_floor = 0.0, let_through = 0.0;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
        const double x = edge_m * (i + 0.5) / steps;
        on_floor += shadow.illuminance_lx(x) * 2.0 * pi * x * edge_m / steps;
    }
    for (int order = 0; order < 4; ++order) {
        for (int i = 0; i < steps; ++i) {
            const double angle = reach * (i + 0.5) / steps;
            if (shadow.distance_m(angle, order) > edge_m) continue;
            let_through += 100.0 * slab_beam(1.6, angle, 0.05, 0.0, order).transmittance * 2.0 *
                           pi * std::sin(angle) * reach / steps;
        }
    }
    CHECK_THAT(on_floor, WithinRel(let_through, 1e-4));
}
