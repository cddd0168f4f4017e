#include "optics/light/light.h"

#include <algorithm>

#include "core/sampling.h"
#include "optics/light/spherical_rectangle.h"

namespace lucerna::optics {
namespace {

template <typename... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};
template <typename... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

// -- Area lights ---------------------------------------------------------------------------------

bool emits_toward(const AreaLight& light, double cosine) {
    if (light.both_sides) return cosine != 0.0;
    return light.inward ? cosine < 0.0 : cosine > 0.0;
}

// Radiance over that of a Lambertian surface of the same flux, toward a direction that leaves it.
double over_lambertian(const AreaLight& light, const Vec3& leaving) {
    return light.sky ? light.sky->over_lambertian(-leaving) : 1.0;
}

// L / Phi; of a Lambertian surface Phi = pi L A per emitting side.
double area_radiance_factor(const AreaLight& light, const Vec3& leaving) {
    return over_lambertian(light, leaving) /
           (pi * area_m2(light.shape) * (light.both_sides ? 2.0 : 1.0));
}

EmittedRay emit_from(const AreaLight& light, double u1, double u2, double u3, double u4) {
    SurfacePoint point = sample_area(light.shape, u1, u2);
    point.object = light.object;
    bool against = light.inward;
    if (light.both_sides) {
        against = u3 >= 0.5;
        u3 = against ? 2.0 * u3 - 1.0 : 2.0 * u3;
    }
    const Vec3 local = sample_cosine_hemisphere(u3, u4);
    const Frame frame(against ? Vec3(-point.normal) : point.normal);
    const Vec3 direction = frame.to_world(local);
    return {{point.position, direction}, point, over_lambertian(light, direction)};
}

// The cone under which a sphere is seen from a point outside it.
struct SphereCone {
    Vec3 axis;
    double distance_m;
    double cosine;
    double solid_angle_sr;
};

// Nothing for other shapes and where the whole outer side is not what is seen.
std::optional<SphereCone> sphere_cone(const AreaLight& light, const Vec3& x) {
    const auto* sphere = std::get_if<Sphere>(&light.shape);
    if (!sphere || (light.inward && !light.both_sides)) return std::nullopt;
    const Vec3 to_centre = sphere->centre - x;
    const double distance_m = to_centre.norm();
    if (!(distance_m > sphere->radius_m)) return std::nullopt;
    const double sine = sphere->radius_m / distance_m;
    const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
    // 1 - cos without cancellation for a distant sphere.
    return SphereCone{to_centre / distance_m, distance_m, cosine,
                      2.0 * pi * sine * sine / (1.0 + cosine)};
}

std::optional<Illumination> illuminate_by_cone(const AreaLight& light, const SphereCone& cone,
                                               const Vec3& x, double u1, double u2) {
    const Sphere& sphere = std::get<Sphere>(light.shape);
    // 1 - cos is uniform over the cone; its range is solid angle / (2 pi).
    const double one_minus_cos = u1 * cone.solid_angle_sr / (2.0 * pi);
    const double cos_theta = 1.0 - one_minus_cos;
    const double sin2_theta = one_minus_cos * (1.0 + cos_theta);
    const double sin_theta = std::sqrt(sin2_theta);
    const double phi = 2.0 * pi * u2;
    const Vec3 direction = Frame(cone.axis).to_world(
        {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta});
    // Near root of the intersection: the half chord from the sphere's radius.
    const double half_chord2 =
        sphere.radius_m * sphere.radius_m - cone.distance_m * cone.distance_m * sin2_theta;
    const double t = cone.distance_m * cos_theta - std::sqrt(std::max(0.0, half_chord2));
    const Vec3 normal = (x + t * direction - sphere.centre).normalized();

    Illumination result;
    result.direction = direction;
    result.position = sphere.centre + sphere.radius_m * normal;
    result.surface = {result.position, normal, light.object, 0, 0};
    result.pdf_solid_angle = 1.0 / cone.solid_angle_sr;
    result.factor = area_radiance_factor(light, -direction) * cone.solid_angle_sr;
    return result;
}

std::optional<SphericalRectangle> spherical_rectangle(const AreaLight& light, const Vec3& x) {
    const auto* rectangle = std::get_if<Rectangle>(&light.shape);
    return rectangle ? SphericalRectangle::seen_from(x, *rectangle) : std::nullopt;
}

std::optional<Illumination> illuminate_from(const AreaLight& light, const Vec3& x, double u1,
                                            double u2) {
    if (const auto cone = sphere_cone(light, x)) return illuminate_by_cone(light, *cone, x, u1, u2);
    SurfacePoint point = sample_area(light.shape, u1, u2);
    point.object = light.object;
    const auto seen = spherical_rectangle(light, x);
    if (seen) point.position = seen->sample(u1, u2);
    const Vec3 to_light = point.position - x;
    const double distance2_m2 = to_light.squaredNorm();
    if (distance2_m2 == 0.0) return std::nullopt;
    const Vec3 direction = to_light / std::sqrt(distance2_m2);
    const double cosine = -point.normal.dot(direction);
    if (!emits_toward(light, cosine)) return std::nullopt;

    Illumination result;
    result.direction = direction;
    result.position = point.position;
    result.surface = point;
    result.pdf_solid_angle = seen ? 1.0 / seen->solid_angle_sr()
                                  : distance2_m2 / (area_m2(light.shape) * std::abs(cosine));
    result.factor = area_radiance_factor(light, -direction) / result.pdf_solid_angle;
    return result;
}

double pdf_from(const AreaLight& light, const Vec3& x, const SurfacePoint& at) {
    const Vec3 from_light = x - at.position;
    const double distance2_m2 = from_light.squaredNorm();
    const double cosine = at.normal.dot(from_light);  // times the distance
    if (!emits_toward(light, cosine)) return 0.0;
    if (const auto cone = sphere_cone(light, x)) {
        return cosine > 0.0 ? 1.0 / cone->solid_angle_sr : 0.0;
    }
    if (const auto seen = spherical_rectangle(light, x)) return 1.0 / seen->solid_angle_sr();
    return distance2_m2 * std::sqrt(distance2_m2) / (area_m2(light.shape) * std::abs(cosine));
}

// -- Point lights --------------------------------------------------------------------------------

// From a point with the given intensity per unit of flux [1/sr] toward x.
template <typename IntensityFactor>
std::optional<Illumination> illuminate_from_point(const Vec3& position, const Vec3& x,
                                                  const IntensityFactor& intensity_factor) {
    const Vec3 to_light = position - x;
    const double distance2_m2 = to_light.squaredNorm();
    if (distance2_m2 == 0.0) return std::nullopt;
    Illumination result;
    result.direction = to_light / std::sqrt(distance2_m2);
    result.position = position;
    result.factor = intensity_factor(Vec3(-result.direction)) / distance2_m2;
    result.delta = true;
    if (result.factor == 0.0) return std::nullopt;
    return result;
}

// -- Beams ---------------------------------------------------------------------------------------

// Whether a point of the cross section's plane lies within it.
bool within(const Shape& cross_section, const Vec3& p) {
    if (const auto* disk = std::get_if<Disk>(&cross_section)) {
        const double distance_m = (p - disk->centre).norm();
        return distance_m <= disk->radius_m && distance_m >= disk->inner_radius_m;
    }
    if (const auto* rectangle = std::get_if<Rectangle>(&cross_section)) {
        const Vec3 offset = p - rectangle->corner;
        const double s = offset.dot(rectangle->edge_u) / rectangle->edge_u.squaredNorm();
        const double t = offset.dot(rectangle->edge_v) / rectangle->edge_v.squaredNorm();
        return s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0;
    }
    return false;
}

// A point and the normal of the plane of a disk or rectangle.
std::pair<Vec3, Vec3> plane_of(const Shape& cross_section) {
    if (const auto* disk = std::get_if<Disk>(&cross_section)) return {disk->centre, disk->normal};
    const auto& rectangle = std::get<Rectangle>(cross_section);
    return {rectangle.corner, rectangle.edge_u.cross(rectangle.edge_v).normalized()};
}

std::optional<Illumination> illuminate_from(const BeamLight& light, const Vec3& x) {
    const auto [origin, normal] = plane_of(light.cross_section);
    const double cosine = normal.dot(light.direction);
    const double along_m = normal.dot(x - origin) / cosine;  // from the cross section to x
    if (!(along_m > 0.0)) return std::nullopt;
    const Vec3 position = x - along_m * light.direction;
    if (!within(light.cross_section, position)) return std::nullopt;
    Illumination result;
    result.direction = -light.direction;
    result.position = position;
    result.factor = 1.0 / (area_m2(light.cross_section) * std::abs(cosine));
    result.delta = true;
    return result;
}

// -- Luminaires ----------------------------------------------------------------------------------

bool is_point(const Luminaire& light) {
    return light.object == no_object;
}

// I(w) / Phi [1/sr] toward a direction of the scene.
double intensity_factor(const Luminaire& light, const Vec3& direction) {
    return light.intensity->pdf_solid_angle(light.to_photometric * direction);
}

// Radiance per flux toward a direction from a face that is seen from there.
double face_radiance_factor(const Luminaire& light, const Vec3& direction) {
    const double area_m2 = light.opening.faces().projected_area_m2(direction);
    return area_m2 > 0.0 ? intensity_factor(light, direction) / area_m2 : 0.0;
}

EmittedRay emit_from(const Luminaire& light, double u1, double u2, double u3, double u4) {
    const Vec3 direction = light.to_photometric.transpose() * light.intensity->sample(u1, u2);
    if (is_point(light)) return {{light.position, direction}, free_source(), 1.0};
    const LuminousFaces& faces = light.opening.faces();
    if (!(faces.projected_area_m2(direction) > 0.0))
        return {{light.position, direction}, free_source(), 0.0};
    SurfacePoint point = faces.sample_toward(direction, u3, u4);
    point.object = light.object;
    return {{point.position, direction}, point, 1.0};
}

std::optional<Illumination> illuminate_from(const Luminaire& light, const Vec3& x, double u1,
                                            double u2) {
    if (is_point(light)) {
        return illuminate_from_point(light.position, x,
                                     [&](const Vec3& w) { return intensity_factor(light, w); });
    }
    const LuminousFaces& faces = light.opening.faces();
    auto [point, pdf_area] = faces.sample_from(x, u1, u2);
    if (pdf_area == 0.0) return std::nullopt;
    point.object = light.object;
    const Vec3 to_light = point.position - x;
    const double distance2_m2 = to_light.squaredNorm();
    if (distance2_m2 == 0.0) return std::nullopt;
    const Vec3 direction = to_light / std::sqrt(distance2_m2);
    const double cosine = -point.normal.dot(direction);
    if (faces.is_sheet() ? cosine == 0.0 : cosine <= 0.0) return std::nullopt;

    Illumination result;
    result.direction = direction;
    result.position = point.position;
    result.surface = point;
    result.pdf_solid_angle = pdf_area * distance2_m2 / std::abs(cosine);
    result.factor = face_radiance_factor(light, -direction) / result.pdf_solid_angle;
    if (result.factor == 0.0) return std::nullopt;
    return result;
}

double pdf_from(const Luminaire& light, const Vec3& x, const SurfacePoint& at) {
    if (is_point(light)) return 0.0;
    const Vec3 from_light = x - at.position;
    const double distance_m = from_light.norm();
    const double cosine = std::abs(at.normal.dot(from_light)) / distance_m;
    if (!(cosine > 0.0)) return 0.0;
    return light.opening.faces().pdf_area_from(x, at) * distance_m * distance_m / cosine;
}

}  // namespace

EmittedRay emit(const LightSource& light, double u1, double u2, double u3, double u4) {
    return std::visit(
        Overloaded{[&](const AreaLight& area) { return emit_from(area, u1, u2, u3, u4); },
                   [&](const PointLight& point) -> EmittedRay {
                       return {{point.position, sample_sphere(u1, u2)}, free_source(), 1.0};
                   },
                   [&](const BeamLight& beam) -> EmittedRay {
                       const SurfacePoint from = sample_area(beam.cross_section, u1, u2);
                       return {{from.position, beam.direction}, free_source(), 1.0};
                   },
                   [&](const Luminaire& lamp) { return emit_from(lamp, u1, u2, u3, u4); }},
        light);
}

std::optional<Illumination> illuminate(const LightSource& light, const Vec3& x, double u1,
                                       double u2) {
    return std::visit(
        Overloaded{[&](const AreaLight& area) { return illuminate_from(area, x, u1, u2); },
                   [&](const PointLight& point) {
                       return illuminate_from_point(point.position, x,
                                                    [](const Vec3&) { return 1.0 / (4.0 * pi); });
                   },
                   [&](const BeamLight& beam) { return illuminate_from(beam, x); },
                   [&](const Luminaire& lamp) { return illuminate_from(lamp, x, u1, u2); }},
        light);
}

double radiance_factor(const LightSource& light, const SurfacePoint& at, const Vec3& direction) {
    const double cosine = at.normal.dot(direction);
    return std::visit(
        Overloaded{[&](const AreaLight& area) {
                       return emits_toward(area, cosine) ? area_radiance_factor(area, direction)
                                                         : 0.0;
                   },
                   [](const PointLight&) { return 0.0; }, [](const BeamLight&) { return 0.0; },
                   [&](const Luminaire& lamp) {
                       if (is_point(lamp)) return 0.0;
                       const bool sheet = lamp.opening.faces().is_sheet();
                       const bool seen = sheet ? cosine != 0.0 : cosine > 0.0;
                       return seen ? face_radiance_factor(lamp, direction) : 0.0;
                   }},
        light);
}

double illuminate_pdf_solid_angle(const LightSource& light, const Vec3& x, const SurfacePoint& at) {
    return std::visit(
        Overloaded{[&](const AreaLight& area) { return pdf_from(area, x, at); },
                   [](const PointLight&) { return 0.0; }, [](const BeamLight&) { return 0.0; },
                   [&](const Luminaire& lamp) { return pdf_from(lamp, x, at); }},
        light);
}

ObjectId emitting_object(const LightSource& light) {
    if (const auto* area = std::get_if<AreaLight>(&light)) return area->object;
    if (const auto* lamp = std::get_if<Luminaire>(&light)) return lamp->object;
    return no_object;
}

}  // namespace lucerna::optics
