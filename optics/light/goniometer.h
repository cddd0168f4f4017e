// The angles of photometric types A and B (LM-63-2002, section 3; LM-75) in our photometric frame.
#pragma once

#include <vector>

#include "core/vector.h"

namespace lucerna::optics {

/// Horizontal and vertical angle of a goniometer of type A or B [deg].
struct GoniometerAngles {
    double horizontal_deg;
    double vertical_deg;
};

/// Type A: the planes of constant H share the vertical axis.
///
/// LM-63-2002: the photometric horizontal (our +x, C0) is H = 0, V = 0; nadir (-z) is V = -90;
/// H turns clockwise, seen from above:  d = cos V (cos H x - sin H y) + sin V z.
/// @return H in (-180, 180], V in [-90, 90].
GoniometerAngles type_a_angles(const Vec3& direction);
Vec3 type_a_direction(const GoniometerAngles& angles);

/// Type B: the planes of constant V share a horizontal axis (our y, along the luminaire's width).
///
/// LM-63-2002: nadir (-z) is H = 0, V = 0; the photometric horizontal (+x) is H = 0, V = 90;
/// H turns clockwise, seen from above at V = 90:  d = cos H (sin V x - cos V z) - sin H y.
/// @return H in [-90, 90], V in (-180, 180].
GoniometerAngles type_b_angles(const Vec3& direction);
Vec3 type_b_direction(const GoniometerAngles& angles);

enum class GoniometerType { a, b };

/// A table over the angles of a goniometer of type A or B, bilinear in them and 0 outside.
class GoniometerTable {
public:
    /// @param mirrored  given for H >= 0 only: the same for -H
    /// @param values    [horizontal][vertical]; at least two increasing angles of each kind
    GoniometerTable(GoniometerType type, bool mirrored, std::vector<double> horizontal_deg,
                    std::vector<double> vertical_deg, std::vector<std::vector<double>> values);

    double at(const Vec3& direction) const;
    double finest_spacing_deg() const;

private:
    GoniometerType type_;
    bool mirrored_;
    std::vector<double> horizontal_deg_, vertical_deg_;
    std::vector<std::vector<double>> values_;
};

}  // namespace lucerna::optics
