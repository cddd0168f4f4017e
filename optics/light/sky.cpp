#include "optics/light/sky.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace lucerna::optics {
namespace {

// Sum over a half space of directions about `up` by the midpoint rule in elevation and azimuth. The
// integrands have kinks at most: wrong by less than 1e-5.
template <typename Integrand>
double over_half_space(const Vec3& up, bool above, const Integrand& integrand) {
    constexpr int elevations = 512, azimuths = 1024;
    const Frame frame(up);
    double sum = 0.0;
    for (int i = 0; i < elevations; ++i) {
        const double elevation = pi / 2.0 * (i + 0.5) / elevations;
        const double sine = std::sin(elevation);
        const double cosine = std::cos(elevation);
        double ring = 0.0;
        for (int j = 0; j < azimuths; ++j) {
            const double azimuth = 2.0 * pi * (j + 0.5) / azimuths;
            ring += integrand(frame.to_world(
                {cosine * std::cos(azimuth), cosine * std::sin(azimuth), above ? sine : -sine}));
        }
        sum += ring * cosine;
    }
    return sum * pi * pi / (elevations * static_cast<double>(azimuths));
}

}  // namespace

const Sky::Parameters& Sky::parameters(int type) {
    // ISO 15469:2004, Table 1; the same in S. Darula and R. Kittler, "CIE general sky standard
    // defining luminance distributions", eSim 2002.
    static constexpr std::array<Parameters, 15> table{{{4.0, -0.70, 0.0, -1.0, 0.0},
                                                       {4.0, -0.70, 2.0, -1.5, 0.15},
                                                       {1.1, -0.8, 0.0, -1.0, 0.0},
                                                       {1.1, -0.8, 2.0, -1.5, 0.15},
                                                       {0.0, -1.0, 0.0, -1.0, 0.0},
                                                       {0.0, -1.0, 2.0, -1.5, 0.15},
                                                       {0.0, -1.0, 5.0, -2.5, 0.30},
                                                       {0.0, -1.0, 10.0, -3.0, 0.45},
                                                       {-1.0, -0.55, 2.0, -1.5, 0.15},
                                                       {-1.0, -0.55, 5.0, -2.5, 0.30},
                                                       {-1.0, -0.55, 10.0, -3.0, 0.45},
                                                       {-1.0, -0.32, 10.0, -3.0, 0.45},
                                                       {-1.0, -0.32, 16.0, -3.0, 0.30},
                                                       {-1.0, -0.15, 16.0, -3.0, 0.30},
                                                       {-1.0, -0.15, 24.0, -2.8, 0.15}}};
    if (type < 1 || type > 15) throw std::invalid_argument("general skies have the types 1 to 15");
    return table[static_cast<std::size_t>(type - 1)];
}

bool Sky::depends_on_sun(int type) {
    const Parameters& p = parameters(type);
    return p.c != 0.0 || p.e != 0.0;
}

Sky Sky::general(int type, const Vec3& up, const Vec3& sun) {
    Sky sky;
    sky.general_ = parameters(type);
    sky.up_ = up;
    sky.sun_ = sun;
    sky.zenith_ = sky.relative_luminance(up);
    sky.horizontal_sr_ = over_half_space(
        up, true, [&](const Vec3& w) { return sky.relative_luminance(w) * w.dot(up); });
    return sky;
}

Sky Sky::overcast(const Vec3& up) {
    Sky sky;
    sky.up_ = up;
    sky.horizontal_sr_ = 7.0 * pi / 9.0;  // the integral of (1 + 2 s) / 3 * s * 2 pi ds
    return sky;
}

double Sky::relative_luminance(const Vec3& direction) const {
    const double cos_zenith = direction.dot(up_);
    if (!general_) return (1.0 + 2.0 * cos_zenith) / 3.0;
    const auto& [a, b, c, d, e] = *general_;
    const double gradation = cos_zenith > 0.0 ? 1.0 + a * std::exp(b / cos_zenith) : 1.0;
    const double cos_sun = std::clamp(direction.dot(sun_), -1.0, 1.0);
    const double indicatrix = 1.0 +
                              c * (std::exp(d * std::acos(cos_sun)) - std::exp(d * pi / 2.0)) +
                              e * cos_sun * cos_sun;
    return gradation * indicatrix / zenith_;
}

SkyView::SkyView(const Sky& sky, const Vec3& inward, double ground_reflectance)
    : sky_(sky), ground_(ground_reflectance * sky.horizontal_sr() / pi) {
    for (const bool above : {true, false}) {
        exitance_sr_ += over_half_space(sky.up(), above, [&](const Vec3& w) {
            return relative_luminance(w) * std::max(0.0, -w.dot(inward));
        });
    }
}

double SkyView::relative_luminance(const Vec3& direction) const {
    return direction.dot(sky_.up()) > 0.0 ? sky_.relative_luminance(direction) : ground_;
}

}  // namespace lucerna::optics
