// Luminance of the sky and of the ground, seen through an opening.
#pragma once

#include <optional>

#include "core/vector.h"

namespace lucerna::optics {

/// Relative luminance distribution of a cloudy, partly cloudy or cloudless sky (ISO 15469:2004 /
/// CIE S 011:2003). Directions point from the observer to the sky.
class Sky {
public:
    /// The CIE standard general sky of a type from 1 to 15.
    /// @param up   unit.
    /// @param sun  unit, above the horizon; of no effect where depends_on_sun() says no.
    static Sky general(int type, const Vec3& up, const Vec3& sun);
    /// The CIE standard overcast sky in its own formula: L / Lz = (1 + 2 sin elevation) / 3.
    static Sky overcast(const Vec3& up);
    /// Whether a general sky is not the same in all azimuths.
    static bool depends_on_sun(int type);

    /// Luminance over that of the zenith, of a direction above the horizon.
    double relative_luminance(const Vec3& direction) const;
    /// Illuminance of an open horizontal plane over the luminance of the zenith [sr].
    double horizontal_sr() const { return horizontal_sr_; }
    const Vec3& up() const { return up_; }

private:
    /// Of gradation and indicatrix: phi = 1 + a exp(b / cos Z), f = 1 + c (exp(d chi) - exp(d pi /
    /// 2)) + e cos^2 chi, with Z the angle to the zenith and chi that to the sun.
    struct Parameters {
        double a, b, c, d, e;
    };
    static const Parameters& parameters(int type);

    std::optional<Parameters> general_;  // the overcast sky without it
    Vec3 up_ = Vec3::UnitZ(), sun_ = Vec3::UnitZ();
    double zenith_ = 1.0;  // of f phi
    double horizontal_sr_ = 0.0;
};

/// What a flat opening shows: the sky above the horizon, and below it a ground that reflects the
/// light of the whole sky diffusely.
class SkyView {
public:
    /// @param inward  unit normal of the opening, along the light that comes in.
    /// @param ground_reflectance  0 to 1; the ground is lit by the sky alone, without the sun.
    SkyView(const Sky& sky, const Vec3& inward, double ground_reflectance);

    /// Luminance in a direction from the observer over the luminance of the zenith.
    double relative_luminance(const Vec3& direction) const;
    /// Luminous exitance of the opening over the luminance of the zenith [sr].
    double exitance_sr() const { return exitance_sr_; }
    /// Luminance over that of a Lambertian opening of the same flux.
    double over_lambertian(const Vec3& direction) const {
        return relative_luminance(direction) * pi / exitance_sr_;
    }

private:
    Sky sky_;
    double ground_;
    double exitance_sr_ = 0.0;
};

}  // namespace lucerna::optics
