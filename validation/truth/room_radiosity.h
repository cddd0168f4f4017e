// Diffuse interreflection in a room of axis-aligned rectangles by Galerkin radiosity.
#pragma once

#include <array>
#include <vector>

#include "core/vector.h"

namespace lucerna::truth {

/// A rectangle in a plane of constant coordinate `axis`; spans are those of the axes that follow
/// (axis + 1, axis + 2, modulo 3). It emits and reflects into the room.
struct Panel {
    int axis;
    double plane_m;
    std::array<double, 2> span_u_m, span_v_m;
    double reflectance;
    double emitted_luminance;
};

/// Panels that enclose a convex room, each cut into cells x cells pieces whose luminance varies
/// linearly. Exchange factors are in closed form, so that the error is that of the pieces alone,
/// O(1 / cells^2); see extrapolated().
class RoomRadiosity {
public:
    RoomRadiosity(std::vector<Panel> panels, int cells);

    /// Mean illuminance of a panel [lx].
    double mean_illuminance(std::size_t panel) const;
    /// Illuminance at a point in the room on a surface with the given normal [lx].
    double illuminance(const Vec3& x, const Vec3& normal) const;
    /// Luminance of a panel at a point of it [cd/m2].
    double luminance(std::size_t panel, const Vec3& x, const Vec3& normal) const;
    /// Mean luminance that a meter reads within a cone that sees one panel only.
    double cone_luminance(std::size_t panel, const Vec3& normal, const Vec3& position,
                          const Vec3& direction, double half_angle_rad) const;
    /// Largest deviation from 1 of the sum of a piece's form factors.
    double closure_error() const { return closure_error_; }

private:
    struct Piece {
        Panel panel;  // with the piece's own spans
        std::size_t of;
        double area_m2;
        double luminance;
        double illuminance;
    };
    std::vector<Panel> panels_;
    std::vector<Piece> pieces_;
    double closure_error_ = 0.0;
};

/// A functional of the solution without its leading error, by Richardson's extrapolation.
/// @param fine  has twice as many cells as `coarse`.
template <typename Functional>
double extrapolated(const RoomRadiosity& coarse, const RoomRadiosity& fine,
                    const Functional& functional) {
    const double value = functional(fine);
    return value + (value - functional(coarse)) / 3.0;
}

/// Area times form factor between two axis-aligned rectangles that face each other [m2].
double exchange_area_m2(const Panel& a, const Panel& b);

}  // namespace lucerna::truth
