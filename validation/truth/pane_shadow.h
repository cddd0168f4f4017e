// The shadow of a screen below a pane, lit by a point.
#pragma once

#include <cmath>

#include "core/vector.h"
#include "validation/truth/tilted_slab.h"

namespace lucerna::truth {

/// A point of the same intensity in all directions above a clear pane above a floor, and between
/// pane and floor a screen that covers all beyond its straight edge. Light stays in the plane
/// through the axis below the point; the edge is across that plane.
struct PaneShadow {
    double intensity_cd;
    double lamp_height_m;  ///< over the floor
    double pane_thickness_m, pane_index;
    double screen_height_m, screen_edge_m;  ///< the latter from the axis

    /// Where light that leaves the lamp under an angle to the axis meets the floor after 2 * order
    /// internal reflections.
    double distance_m(double angle_rad, int order) const {
        const double sine = std::sin(angle_rad);
        const double root = std::sqrt(pane_index * pane_index - sine * sine);
        return (lamp_height_m - pane_thickness_m) * std::tan(angle_rad) +
               (2 * order + 1) * pane_thickness_m * sine / root;
    }

    /// The edge of the shadow of the light that is reflected never.
    double shadow_edge_m() const {
        double lit = 0.0, dark = 0.5 * pi;
        for (int i = 0; i < 100; ++i) {
            const double middle = 0.5 * (lit + dark);
            (at_screen_m(middle, 0) > screen_edge_m ? dark : lit) = middle;
        }
        return distance_m(lit, 0);
    }

    /// dPhi = I T 2 pi sin th dth falls on the ring dA = 2 pi x dx:
    ///   E = sum over orders of I T sin th / (x dx/dth).
    double illuminance_lx(double from_axis_m) const {
        double sum = 0.0;
        for (int order = 0; order <= slab_orders; ++order) {
            double near = 0.0, far = 0.5 * pi;
            for (int i = 0; i < 100; ++i) {
                const double middle = 0.5 * (near + far);
                (distance_m(middle, order) < from_axis_m ? near : far) = middle;
            }
            const double angle_rad = near;
            if (at_screen_m(angle_rad, order) > screen_edge_m) continue;
            const double sine = std::sin(angle_rad), cosine = std::cos(angle_rad);
            const double square = pane_index * pane_index - sine * sine;
            const double slope_m = (lamp_height_m - pane_thickness_m) / (cosine * cosine) +
                                   (2 * order + 1) * pane_thickness_m * cosine * pane_index *
                                       pane_index / (square * std::sqrt(square));
            const SlabBeam beam = slab_beam(pane_index, angle_rad, pane_thickness_m, 0.0, order);
            sum += intensity_cd * beam.transmittance * sine / (from_axis_m * slope_m);
        }
        return sum;
    }

private:
    double at_screen_m(double angle_rad, int order) const {
        return distance_m(angle_rad, order) - screen_height_m * std::tan(angle_rad);
    }
};

}  // namespace lucerna::truth
