// The state of polarisation of light along a path, and what specular events do to it.
//
// Axes: s is perpendicular to the plane of incidence and p = k x s, k the direction of the ray,
// before and after the event (Born and Wolf, Principles of Optics, 7th ed., section 1.5.2), so that
// r_p = -r_s at normal incidence. Fields go as exp(-i omega t).
#pragma once

#include "core/vector.h"
#include "spectral/lanes.h"

namespace lucerna::optics {

using spectral::Lanes;

/// Mueller matrix of reflection or refraction at an isotropic smooth surface in the axes s, p:
///
///   I' = mean I + difference Q         U' = real U - imaginary V
///   Q' = difference I + mean Q         V' = imaginary U + real V
///
/// with the factors of flux mean = (R_s + R_p) / 2, difference = (R_s - R_p) / 2, and
/// real + i imaginary = r_s r_p*. Number: double, or Lanes where the lanes differ.
template <typename Number>
struct Mueller {
    Number mean, difference, real, imaginary;
};

/// The Stokes vector of a path beside its weight: the weight is I (or, backward, what the path
/// makes of I), and q, u, v are Q/I, U/I, V/I on each lane. With the axes e and k x e,
///
///   Q = <|E_e|^2> - <|E_kxe|^2>,   U + i V = 2 <E_e E*_kxe>.
///
/// What scales a path leaves its state alone. Backward paths carry the state that light sent along
/// the path from the observer would have: by reciprocity this is the adjoint of the Stokes vector,
/// up to the signs of U and V, and surfaces that scatter, lights and observers know I alone.
class Polarisation {
public:
    /// Unpolarised light; what is not read then is not set.
    Polarisation() {}

    void depolarise() { unpolarised_ = true; }
    bool unpolarised() const { return unpolarised_; }

    /// Refers the state to another axis.
    ///
    /// @param axis       unit, perpendicular to the ray.
    /// @param direction  of the ray, unit.
    void refer_to(const Vec3& axis, const Vec3& direction);

    /// Factor of flux of an event whose s axis is the axis of reference; in [0, 1].
    Lanes flux_factor(const Mueller<double>& event) const;
    Lanes flux_factor(const Mueller<Lanes>& event) const;

    /// Goes through that event. The axis stays, perpendicular to the new ray as well.
    void go_through(const Mueller<double>& event);
    void go_through(const Mueller<Lanes>& event);

    Lanes q() const { return unpolarised_ ? Lanes::Zero().eval() : q_; }
    Lanes u() const { return unpolarised_ ? Lanes::Zero().eval() : u_; }
    Lanes v() const { return unpolarised_ ? Lanes::Zero().eval() : v_; }

private:
    template <typename Number>
    void apply(const Number& mean, const Number& difference, const Number& real,
               const Number& imaginary);

    bool unpolarised_ = true;
    Vec3 axis_;        // not set while unpolarised
    Lanes q_, u_, v_;  // the same
};

/// The axis s where a ray meets a surface; any axis perpendicular to the ray at normal incidence.
Vec3 axis_across_incidence(const Vec3& normal, const Vec3& direction);

}  // namespace lucerna::optics
