// Irradiance behind a ball or a cylinder of glass in a parallel beam of unpolarised light.
#pragma once

#include <numbers>
#include <vector>

#include "validation/truth/fresnel.h"

namespace lucerna::truth {

/// A ball, or a long cylinder across the beam, around the origin; the beam runs along +z and the
/// screen lies in the plane z = screen_m, behind the lens.
struct RoundLens {
    bool is_ball;
    double radius_m;
    double index;
    double absorption_per_m;
    double screen_m;  ///< more than the radius
};

/// Where a ray that comes in at the height radius * sin(incidence) lands after `order` internal
/// reflections; order -1 is reflection from outside, which throws grazing light forward.
struct LensRay {
    bool lands = false;      ///< false: it runs away from the screen
    double landing_m = 0.0;  ///< height on the screen, negative across the axis
    double slope_m = 0.0;    ///< d landing / d incidence [m/rad]
    double transmittance = 0.0;
};

inline constexpr int outer_reflection = -1;

/// In the plane of axis and ray each refraction turns the ray by i - r and each reflection by
/// pi - 2 r (Born and Wolf, 7th ed., 4.1; Descartes' theory of the rainbow), and each chord takes
/// it pi - 2 r around the lens. That plane is the plane of incidence of all events.
inline LensRay lens_ray(const RoundLens& lens, double incidence_rad, int order) {
    constexpr double pi = std::numbers::pi;
    const Reflection fresnel = reflection(1.0, lens.index, std::cos(incidence_rad));
    const double refraction_rad = std::asin(std::sin(incidence_rad) / lens.index);
    const double refraction_slope =
        std::cos(incidence_rad) / (lens.index * fresnel.cosine_refracted);
    const int chords = order + 1;
    // Place of the exit and direction there, both as angles from +z.
    const double place = pi - incidence_rad - chords * (pi - 2.0 * refraction_rad);
    const double place_slope = -1.0 + 2.0 * chords * refraction_slope;
    const double direction =
        -2.0 * (incidence_rad - refraction_rad) - order * (pi - 2.0 * refraction_rad);
    const double direction_slope = -2.0 + 2.0 * chords * refraction_slope;

    LensRay ray;
    const double to_screen_m = lens.screen_m - lens.radius_m * std::cos(place);
    const double cosine = std::cos(direction);
    ray.lands = cosine > 0.0;
    if (!ray.lands) return ray;
    ray.landing_m = lens.radius_m * std::sin(place) + to_screen_m * std::tan(direction);
    ray.slope_m =
        lens.radius_m * place_slope * (std::cos(place) + std::sin(place) * std::tan(direction)) +
        to_screen_m * direction_slope / (cosine * cosine);
    const double chord_m = 2.0 * lens.radius_m * fresnel.cosine_refracted;
    const auto passed = [&](double reflectance) {
        if (order == outer_reflection) return reflectance;
        return std::pow(1.0 - reflectance, 2) * std::pow(reflectance, order);
    };
    ray.transmittance = 0.5 * (passed(fresnel.reflectance_s()) + passed(fresnel.reflectance_p())) *
                        std::exp(-lens.absorption_per_m * chords * chord_m);
    return ray;
}

/// Orders beyond this one carry less than 1e-6 of what enters the lens within 85 deg of incidence.
inline constexpr int lens_orders = 12;

/// Irradiance on the screen, which faces the lens, over that of the beam, by light that passed the
/// lens, or was reflected by it, and landed at `height_m` > 0 from the axis:
///   ball      sum of T h |dh / dx| / x        (a ring of the beam lands as a ring)
///   cylinder  sum of T |dh / dx|
/// over all branches x(h) = +-height. Diverges at folds dx/dh = 0.
/// Error: that of the bisection, 1e-12 of the incidence, and the orders left out.
inline double lens_irradiance(const RoundLens& lens, double height_m) {
    constexpr int steps = 4000;
    const auto incidence_of = [](int step) { return 0.5 * std::numbers::pi * step / steps; };
    // Of the ray between two steps that lands at `at_m`.
    const auto branch = [&](int order, double low_rad, double high_rad, double at_m) {
        const auto below = [&](double incidence_rad) {
            return lens_ray(lens, incidence_rad, order).landing_m - at_m < 0.0;
        };
        const bool low_is_below = below(low_rad);
        while (high_rad - low_rad > 1e-13) {
            const double middle_rad = 0.5 * (low_rad + high_rad);
            (below(middle_rad) == low_is_below ? low_rad : high_rad) = middle_rad;
        }
        const LensRay ray = lens_ray(lens, low_rad, order);
        const double beam_m = lens.radius_m * std::cos(low_rad);  // dh / d incidence
        const double spread = lens.is_ball ? lens.radius_m * std::sin(low_rad) / height_m : 1.0;
        return ray.transmittance * spread * beam_m / std::abs(ray.slope_m);
    };
    double sum = 0.0;
    for (int order = outer_reflection; order <= lens_orders; ++order) {
        LensRay low = lens_ray(lens, 0.0, order);
        for (int i = 0; i < steps; ++i) {
            const LensRay high = lens_ray(lens, incidence_of(i + 1), order);
            for (const double at_m : {height_m, -height_m}) {
                if (low.lands && high.lands && (low.landing_m < at_m) != (high.landing_m < at_m)) {
                    sum += branch(order, incidence_of(i), incidence_of(i + 1), at_m);
                }
            }
            low = high;
        }
    }
    return sum;
}

/// Heights on the screen at which branches of an order turn back, and irradiance diverges.
inline std::vector<double> lens_folds_m(const RoundLens& lens, int order) {
    constexpr int steps = 20000;
    std::vector<double> folds;
    LensRay before = lens_ray(lens, 0.0, order);
    for (int i = 1; i < steps; ++i) {
        const LensRay ray = lens_ray(lens, 0.5 * std::numbers::pi * i / steps, order);
        if (before.lands && ray.lands && (before.slope_m < 0.0) != (ray.slope_m < 0.0)) {
            folds.push_back(std::abs(ray.landing_m));
        }
        before = ray;
    }
    return folds;
}

}  // namespace lucerna::truth
