// Sources of light. Three verbs: emit a ray, illuminate a point, radiance toward a direction.
//
// Spectral convention: a light's spectrum is its spectral radiant flux [W/nm] in all directions;
// the directional and spatial part is a density common to all wavelengths. So
//   radiance(x, w) = flux_w_per_nm * radiance_factor(x, w),  radiance_factor in 1/(m2 sr).
#pragma once

#include <concepts>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "core/vector.h"
#include "optics/geometry/shape.h"
#include "optics/light/intensity_distribution.h"
#include "optics/light/luminous_faces.h"
#include "optics/light/sky.h"
#include "optics/material/bsdf.h"

namespace lucerna::optics {

/// Emission from the surface of an object, uniform over its area: Lambertian, or that of a sky
/// behind a flat opening, which emits on one side.
struct AreaLight {
    ObjectId object;
    Shape shape;              ///< of that object
    bool both_sides = false;  ///< sheets only; else it emits on the side of the normal
    bool inward = false;      ///< emits against the normal (the inner side of a closed shape)
    std::shared_ptr<const SkyView> sky = nullptr;  ///< none: Lambertian
};

/// Isotropic point source.
struct PointLight {
    Vec3 position;
};

/// Parallel beam of uniform irradiance over a disk or a rectangle; rays leave along the normal of
/// `cross_section` (a Disk or a Rectangle that is not an object of the scene).
struct BeamLight {
    Shape cross_section;
    Vec3 direction;
};

/// The shape of a luminaire's opening, with its faces prepared for sampling. Converts from and to
/// the shape, which is that of an object of the scene.
class LuminousOpening {
public:
    LuminousOpening() = default;
    /// A Rectangle or a MeshInstance that is flat or convex; throws std::invalid_argument else.
    template <typename S>
    requires(std::convertible_to<S, Shape> &&
             !std::same_as<std::remove_cvref_t<S>, LuminousOpening>)
        LuminousOpening(S&& shape)  // NOLINT: a shape is an opening
        : shape_(std::forward<S>(shape)), faces_(std::make_shared<const LuminousFaces>(shape_)) {}

    operator const Shape&() const { return shape_; }  // NOLINT: an opening is a shape
    const Shape& shape() const { return shape_; }
    const LuminousFaces& faces() const { return *faces_; }

private:
    Shape shape_;
    std::shared_ptr<const LuminousFaces> faces_;
};

/// A luminaire with a measured luminous intensity distribution, emitted uniformly from its luminous
/// opening, so that radiance = I(w) / projected area of the opening toward w. The opening is an
/// object of the scene (a convex mesh or a single sheet) that is black but for its emission; an
/// opening of size zero is a point with that intensity (object == no_object). A sheet emits on both
/// sides, as far as the intensities do; other faces on the side of their normal. Directions in
/// which there is intensity, but no face is seen, emit nothing.
struct Luminaire {
    ObjectId object = no_object;
    LuminousOpening opening;  ///< of that object, when there is one
    Vec3 position;            ///< photometric centre
    Eigen::Matrix3d
        to_photometric;  ///< rotates scene directions to the frame of the C-gamma system
    std::shared_ptr<const IntensityDistribution> intensity;
};

using LightSource = std::variant<AreaLight, PointLight, BeamLight, Luminaire>;

struct Light {
    std::string name;
    LightSource source;
    SpectrumId flux_w_per_nm;       ///< spectral radiant flux of the whole light
    double luminous_flux_lm = 0.0;  ///< the same, weighted by V(lambda)
};

/// Stands for the surface of a light that has none.
inline SurfacePoint free_source() {
    return {Vec3::Zero(), Vec3::Zero()};
}

/// A ray that leaves a light.
struct EmittedRay {
    Ray ray;
    SurfacePoint surface = free_source();  ///< where it leaves; no object for free sources
    /// Share of the light's flux that the ray stands for when one ray is sampled: expectation 1.
    double weight = 1.0;
};

/// How a light reaches a point x from one sampled point of it.
struct Illumination {
    Vec3 direction;  ///< from x toward the light, unit
    Vec3 position;   ///< of the emitting point; for a beam the point of its cross section
    SurfacePoint surface = free_source();  ///< of that point; no object for free sources
    /// Irradiance factor on a plane that faces the light, divided by the sampling density:
    /// E_perpendicular = flux_w_per_nm * factor, factor in 1/m2.
    double factor = 0.0;
    double pdf_solid_angle = 0.0;  ///< density of the direction seen from x; 0 for delta lights
    bool delta = false;            ///< point and beam: cannot be hit by a sampled direction
};

/// Emits one ray, in proportion to the light's radiance times cosine.
EmittedRay emit(const LightSource& light, double u1, double u2, double u3, double u4);

/// Samples a point of the light as seen from x; nothing if the light cannot reach x.
std::optional<Illumination> illuminate(const LightSource& light, const Vec3& x, double u1,
                                       double u2);

/// Radiance per unit of flux toward `direction` (leaving the light) at a point of its surface
/// [1/(m2 sr)]; 0 on the side that does not emit.
double radiance_factor(const LightSource& light, const SurfacePoint& at, const Vec3& direction);

/// Density with which illuminate() would have chosen the point `at` of the light, seen from x
/// [1/sr]; 0 for delta lights.
double illuminate_pdf_solid_angle(const LightSource& light, const Vec3& x, const SurfacePoint& at);

/// The object whose surface emits, or no_object.
ObjectId emitting_object(const LightSource& light);

}  // namespace lucerna::optics
