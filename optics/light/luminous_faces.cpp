#include "optics/light/luminous_faces.h"

#include <algorithm>
#include <stdexcept>

namespace lucerna::optics {
namespace {

constexpr double same_normal = 1e-9;  // of unit vectors: rounding of the vertices only

// Index chosen in proportion to weights that sum to `total`; u is left as a fresh number.
template <typename Items, typename Weight>
std::size_t choose(const Items& items, const Weight& weight, double total, double& u) {
    double left = u * total;
    std::size_t last = 0;
    double last_weight = 0.0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const double w = weight(items[i]);
        if (w <= 0.0) continue;
        last = i;
        last_weight = w;
        if (left < w) break;
        left -= w;
    }
    u = std::clamp(left / last_weight, 0.0, std::nextafter(1.0, 0.0));
    return last;
}

}  // namespace

LuminousFaces::LuminousFaces(const Mesh& mesh, const Placement& placement) {
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        add(placement * mesh.vertices[a], placement * mesh.vertices[b],
            placement * mesh.vertices[c], mesh.patches.empty() ? 0 : mesh.patches[i], i);
    }
    finish();
}

LuminousFaces::LuminousFaces(const Shape& shape) {
    if (const auto* rectangle = std::get_if<Rectangle>(&shape)) {
        const Vec3 u_end = rectangle->corner + rectangle->edge_u;
        const Vec3 v_end = rectangle->corner + rectangle->edge_v;
        add(rectangle->corner, u_end, u_end + rectangle->edge_v, 0, 0);
        add(rectangle->corner, u_end + rectangle->edge_v, v_end, 0, 0);
        finish();
    } else if (const auto* instance = std::get_if<MeshInstance>(&shape)) {
        *this = LuminousFaces(*instance->mesh, instance->placement);
    } else {
        throw std::invalid_argument("a luminous opening is a rectangle or a mesh");
    }
}

void LuminousFaces::add(const Vec3& a, const Vec3& b, const Vec3& c, std::uint32_t patch,
                        std::uint32_t primitive) {
    const Vec3 cross = (b - a).cross(c - a);
    const double area_m2 = 0.5 * cross.norm();
    if (!(area_m2 > 0.0)) return;
    const Vec3 normal = cross / (2.0 * area_m2);
    const auto same = [&](const Face& face) {
        return (face.normal - normal).squaredNorm() < same_normal * same_normal;
    };
    // Triangles of one plane usually follow one another.
    auto face = faces_.rbegin();
    while (face != faces_.rend() && !same(*face)) ++face;
    Face& target = face == faces_.rend() ? faces_.emplace_back() : *face;
    target.normal = normal;
    target.centre =
        (target.area_m2 * target.centre + area_m2 / 3.0 * (a + b + c)) / (target.area_m2 + area_m2);
    target.area_m2 += area_m2;
    target.triangles.push_back({a, b, c, patch, primitive, area_m2});
}

void LuminousFaces::finish() {
    if (faces_.empty()) throw std::invalid_argument("a luminous opening must have an area");
    double extent_m = 0.0;
    for (const Face& face : faces_) {
        extent_m = std::max(extent_m, (face.centre - faces_.front().centre).norm());
    }
    for (const Face& face : faces_) {
        for (const Face& other : faces_) {
            for (const Triangle& t : other.triangles) {
                for (const Vec3* vertex : {&t.a, &t.b, &t.c}) {
                    if (face.normal.dot(*vertex - face.centre) > 1e-6 * extent_m + 1e-12) {
                        throw std::invalid_argument("a luminous opening must be convex");
                    }
                }
            }
        }
    }
}

double LuminousFaces::projected(const Face& face, const Vec3& direction) const {
    const double cosine = face.normal.dot(direction);
    return face.area_m2 * (is_sheet() ? std::abs(cosine) : std::max(0.0, cosine));
}

double LuminousFaces::projected_area_m2(const Vec3& direction) const {
    double area_m2 = 0.0;
    for (const Face& face : faces_) area_m2 += projected(face, direction);
    return area_m2;
}

SurfacePoint LuminousFaces::sample_face(const Face& face, double u1, double u2) const {
    const std::size_t index = choose(
        face.triangles, [](const Triangle& t) { return t.area_m2; }, face.area_m2, u1);
    const Triangle& t = face.triangles[index];
    // Uniform in a triangle: Turk, "Generating Random Points in Triangles", Graphics Gems, 1990.
    const double root = std::sqrt(u1);
    SurfacePoint point;
    point.position = (1.0 - root) * t.a + root * (1.0 - u2) * t.b + root * u2 * t.c;
    point.normal = face.normal;
    point.patch = t.patch;
    point.primitive = t.primitive;
    return point;
}

SurfacePoint LuminousFaces::sample_toward(const Vec3& direction, double u1, double u2) const {
    const auto weight = [&](const Face& face) { return projected(face, direction); };
    const std::size_t index = choose(faces_, weight, projected_area_m2(direction), u1);
    return sample_face(faces_[index], u1, u2);
}

// About the solid angle of the face; above 0 exactly where x lies in front of it.
double LuminousFaces::weight_from(const Face& face, const Vec3& x) const {
    const Vec3 to_x = x - face.centre;
    const double distance_m = to_x.norm();
    if (distance_m == 0.0) return 0.0;
    // Near the face its centre is not typical: bounded by the half space.
    const double area_by_distance = face.area_m2 / (distance_m * distance_m);
    return projected(face, to_x / distance_m) / face.area_m2 * std::min(area_by_distance, 2.0 * pi);
}

LuminousFaces::Sample LuminousFaces::sample_from(const Vec3& x, double u1, double u2) const {
    double total = 0.0;
    for (const Face& face : faces_) total += weight_from(face, x);
    if (!(total > 0.0)) return {{Vec3::Zero(), Vec3::Zero()}, 0.0};
    const auto weight = [&](const Face& face) { return weight_from(face, x); };
    const Face& face = faces_[choose(faces_, weight, total, u1)];
    const double pdf_area = weight_from(face, x) / total / face.area_m2;
    return {sample_face(face, u1, u2), pdf_area};
}

double LuminousFaces::pdf_area_from(const Vec3& x, const SurfacePoint& at) const {
    double total = 0.0;
    double chosen = 0.0;
    double best = -infinity;
    for (const Face& face : faces_) {
        const double weight = weight_from(face, x);
        total += weight;
        const double alike = face.normal.dot(at.normal);
        if (alike > best) {
            best = alike;
            chosen = weight / face.area_m2;
        }
    }
    return total > 0.0 ? chosen / total : 0.0;
}

}  // namespace lucerna::optics
