// Isotropic GGX microfacets in the frame whose z axis is the mean surface normal (Walter et al.,
// 2007), with Smith's height-correlated masking and shadowing (Heitz, JCGT 3(2), 2014).
#pragma once

#include "core/vector.h"

namespace lucerna::optics {

/// A statistical surface of microfacets. Directions and facet normals are unit vectors, z > 0
/// unless said otherwise.
class Ggx {
public:
    /// @param alpha  roughness, > 0: the slope distribution's width.
    explicit Ggx(double alpha) : alpha_(alpha) {}

    /// D(m): area of facets per solid angle of normal and per area of surface [1/sr].
    double facet_density(const Vec3& m) const;

    /// Share of the facets seen from w that no other facet hides; G1 = 1 / (1 + Lambda).
    double visible_share(const Vec3& w) const { return 1.0 / (1.0 + lambda(w)); }
    /// Share seen from both of two directions on the same side. Heitz 2014, eq. 99.
    double visible_share_same_side(const Vec3& a, const Vec3& b) const {
        return 1.0 / (1.0 + lambda(a) + lambda(b));
    }
    /// Share seen from a above and from b below (b.z < 0). Heitz et al., "Multiple-Scattering
    /// Microfacet BSDFs with the Smith Model", SIGGRAPH 2016: B(1 + Lambda_a, 1 + Lambda_b).
    double visible_share_opposite_sides(const Vec3& a, const Vec3& b) const;

    /// Facet normal with density visible_density() (Heitz, JCGT 7(4), 2018).
    Vec3 sample_visible(const Vec3& w, double u1, double u2) const;
    /// D_w(m) = G1(w) max(0, w.m) D(m) / w.z: density of the normals of facets seen from w [1/sr].
    double visible_density(const Vec3& w, const Vec3& m) const;

private:
    /// Smith's auxiliary function: hidden per visible projected area. Even in z; w.z != 0.
    double lambda(const Vec3& w) const;

    double alpha_;
};

}  // namespace lucerna::optics
