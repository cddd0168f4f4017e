// The faces of a luminaire's opening, merged, for its projected area and for sampling.
#pragma once

#include <vector>

#include "core/vector.h"
#include "optics/geometry/shape.h"

namespace lucerna::optics {

/// Plane faces of a convex opening, each with its outward normal; several triangles of one plane
/// are one face. A single plane is a sheet, which emits on both of its sides.
class LuminousFaces {
public:
    /// A mesh in the frame in which directions and points will be given.
    explicit LuminousFaces(const Mesh& mesh, const Placement& placement = Placement::Identity());
    /// A Rectangle or a MeshInstance; throws std::invalid_argument for other shapes, and if the
    /// faces are not those of a convex body.
    explicit LuminousFaces(const Shape& shape);

    /// Sum over the faces of area * max(0, n . direction); |n . direction| for a sheet [m2].
    double projected_area_m2(const Vec3& direction) const;

    /// Point on the faces that are seen from `direction`, uniform per projected area. The projected
    /// area must not be 0. `object` is left for the caller to set.
    SurfacePoint sample_toward(const Vec3& direction, double u1, double u2) const;

    /// A point chosen for illuminating x, with its density.
    struct Sample {
        SurfacePoint point;
        double pdf_area;  ///< [1/m2]; 0 if no face is seen from x
    };
    Sample sample_from(const Vec3& x, double u1, double u2) const;
    double pdf_area_from(const Vec3& x, const SurfacePoint& at) const;

    bool is_sheet() const { return faces_.size() == 1; }

private:
    struct Triangle {
        Vec3 a, b, c;
        std::uint32_t patch, primitive;
        double area_m2;
    };
    struct Face {
        Vec3 normal = Vec3::Zero();
        Vec3 centre = Vec3::Zero();
        double area_m2 = 0.0;
        std::vector<Triangle> triangles;
    };

    void add(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t patch,
             std::uint32_t primitive);
    void finish();
    double projected(const Face& face, const Vec3& direction) const;
    double weight_from(const Face& face, const Vec3& x) const;
    SurfacePoint sample_face(const Face& face, double u1, double u2) const;

    std::vector<Face> faces_;
};

}  // namespace lucerna::optics
