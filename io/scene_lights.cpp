#include "io/scene_lights.h"

#include <cmath>
#include <set>

#include "io/photometric_file.h"
#include "io/scene_shapes.h"
#include "io/scene_spectra.h"
#include "spectral/integral.h"
#include "spectral/photometry.h"

namespace lucerna::io {
namespace {

using namespace optics;
using spectral::Spectrum;

/// A flux as stated, in lm or W.
struct StatedFlux {
    double value;
    bool radiant;
};

/// Flux of something of which `extent` says how much there is: its area [m2] times its solid angle.
StatedFlux flux_of(const Quantity& stated, double extent) {
    return {stated.value * extent, stated.base.starts_with('W')};
}

class LightReader {
public:
    LightReader(SceneContext& context, const SceneObjects& objects)
        : context_(context), parts_(context.scene.parts), objects_(objects) {}

    void read(const YamlCursor& entry);

private:
    void read_area(YamlMap& map);
    void read_sky(YamlMap& map);
    std::optional<Sky> read_sky_type(YamlMap& map);
    void read_point(YamlMap& map);
    void read_beam(YamlMap& map);
    void read_luminaire(YamlMap& map);

    std::optional<Spectrum> relative_spectrum(YamlMap& map) {
        return read_spectrum(context_, map.required("spectrum", "an illuminant or a spectrum"),
                             SpectrumOf::emission);
    }
    /// Adds the light, its spectrum scaled to the flux.
    void add(YamlMap& map, LightSource source, const std::optional<Spectrum>& relative,
             const StatedFlux& flux);
    std::optional<Vec3> read_aim(YamlMap& map);

    SceneContext& context_;
    SceneParts& parts_;
    const SceneObjects& objects_;
    UniqueNames names_;
    std::string name_;                  ///< of the light that is being read
    std::map<ObjectId, int> emitters_;  ///< objects that emit, with the line that says so
};

void LightReader::add(YamlMap& map, LightSource source, const std::optional<Spectrum>& relative,
                      const StatedFlux& flux) {
    if (!relative || name_.empty() || std::isnan(flux.value)) return;
    const double of_relative =
        flux.radiant ? integral_of_product(*relative, Spectrum(1.0)) : luminous(*relative);
    const Spectrum scaled = relative->scaled(flux.value / of_relative);
    const double lumens = luminous(scaled);
    if (!std::isfinite(lumens) || lumens <= 0.0) {
        map.cursor().complain(
            fmt::format("has a luminous flux of {} lm, which cannot be simulated", lumens));
        return;
    }
    parts_.lights.push_back({name_, std::move(source), parts_.add(scaled), lumens});
}

void LightReader::read_area(YamlMap& map) {
    const YamlCursor on = map.required("on", "the name of the object whose surface emits");
    const auto object_id = objects_.find(on);
    const auto form = map.exactly_one({"flux", "luminance", "exitance"});
    const auto stated = read_quantity(form.value,
                                      form.key == "luminance"  ? dimension::luminance
                                      : form.key == "exitance" ? dimension::exitance
                                                               : dimension::flux,
                                      Accept::positive);
    const auto relative = relative_spectrum(map);
    const YamlCursor side_cursor = map.optional("side");
    const auto side = side_cursor.choice({"front", "back", "both"});
    if (!object_id) return;
    const Object& object = parts_.objects[*object_id];
    const bool solid = is_solid(object.shape);
    if (!side_cursor && !solid)
        map.cursor().complain(fmt::format(
            "the key 'side' is missing: '{}' is a sheet; expected front (where its normal points), "
            "back or both",
            object.name));
    if (side == "both" && solid)
        side_cursor.complain(
            fmt::format("'{}' is a solid; expected front (outward) or back (inward)", object.name));
    const auto [earlier, is_new] = emitters_.emplace(*object_id, on.where().line);
    if (!is_new)
        on.complain(fmt::format("'{}' emits already by line {}", object.name, earlier->second));
    if (!stated) return;

    const AreaLight light{*object_id, object.shape, side == "both", side == "back"};
    const double area = area_m2(object.shape) * (light.both_sides ? 2.0 : 1.0);
    // Lambertian: M = pi L (ILV 17-21-081).
    const double extent = form.key == "flux" ? 1.0 : form.key == "exitance" ? area : pi * area;
    add(map, light, relative, flux_of(*stated, extent));
}

std::optional<Sky> LightReader::read_sky_type(YamlMap& map) {
    const YamlCursor cursor =
        map.required("sky", "a type of the CIE standard general sky from 1 to 15, or overcast");
    const YamlCursor sun_cursor = map.optional("sun");
    const Vec3 sun = sun_cursor ? read_direction(sun_cursor) : Vec3(Vec3::UnitZ());
    if (!cursor) return {};
    const bool overcast = cursor.is_scalar() && cursor.word() == "overcast";
    const int type = overcast ? 0 : static_cast<int>(read_count(cursor, 1, 15));
    if (!context_.up) {
        cursor.complain(
            "the scene does not say where 'up' is; expected the key 'up' of the scene, such as "
            "\"up: z\"");
        return {};
    }
    if (!overcast && type == 0) return {};
    const bool needs_sun = !overcast && Sky::depends_on_sun(type);
    if (needs_sun && !sun_cursor) {
        map.cursor().complain(fmt::format(
            "the key 'sun' is missing: a sky of type {} is brighter around the sun; expected the "
            "direction toward it, such as [1, 0.5, 1]",
            type));
        return {};
    }
    if (!needs_sun && sun_cursor) {
        sun_cursor.complain("this sky is the same in all azimuths; expected no 'sun'");
        return {};
    }
    if (!sun.allFinite()) return {};
    if (needs_sun && !(sun.dot(*context_.up) > 0.0)) {
        sun_cursor.complain("the sun is not above the horizon; expected a direction toward it");
        return {};
    }
    return overcast ? Sky::overcast(*context_.up) : Sky::general(type, *context_.up, sun);
}

void LightReader::read_sky(YamlMap& map) {
    const YamlCursor on = map.required("on", "the name of the opening, a rectangle or a disk");
    const auto object_id = objects_.find(on);
    const auto side = map.required("side",
                                   "front (where its normal points) or back: the side on "
                                   "which the light comes in")
                          .choice({"front", "back"});
    const std::optional<Sky> sky = read_sky_type(map);
    const auto form = map.exactly_one({"illuminance", "zenith"});
    const auto stated = read_quantity(
        form.value, form.key == "zenith" ? dimension::luminance : dimension::irradiance,
        Accept::positive);
    const double ground =
        read_value(map.required("ground", "the reflectance of the ground, such as 20 %"),
                   dimension::fraction, Accept::up_to_one);
    const auto relative = relative_spectrum(map);
    if (!object_id) return;
    const Object& object = parts_.objects[*object_id];
    const auto* rectangle = std::get_if<Rectangle>(&object.shape);
    const auto* disk = std::get_if<Disk>(&object.shape);
    if (!rectangle && !disk) {
        on.complain(fmt::format("'{}' is no rectangle and no disk", object.name));
        return;
    }
    const auto [earlier, is_new] = emitters_.emplace(*object_id, on.where().line);
    if (!is_new)
        on.complain(fmt::format("'{}' emits already by line {}", object.name, earlier->second));
    if (!sky || !stated || !side || std::isnan(ground)) return;

    Vec3 inward = rectangle ? Vec3(rectangle->edge_u.cross(rectangle->edge_v).normalized())
                            : Vec3(disk->normal);
    if (side == "back") inward = -inward;
    const auto view = std::make_shared<const SkyView>(*sky, inward, ground);
    const double zenith = form.key == "zenith" ? 1.0 : 1.0 / sky->horizontal_sr();
    add(map, AreaLight{*object_id, object.shape, false, side == "back", view}, relative,
        flux_of(*stated, zenith * view->exitance_sr() * area_m2(object.shape)));
}

void LightReader::read_point(YamlMap& map) {
    const Vec3 position = read_lengths(map.required("position", "a position"));
    const auto form = map.exactly_one({"flux", "intensity"});
    const bool by_flux = form.key == "flux";
    const auto stated = read_quantity(form.value, by_flux ? dimension::flux : dimension::intensity,
                                      Accept::positive);
    const auto relative = relative_spectrum(map);
    if (stated && position.allFinite())
        add(map, PointLight{position}, relative, flux_of(*stated, by_flux ? 1.0 : 4.0 * pi));
}

void LightReader::read_beam(YamlMap& map) {
    const YamlCursor section = map.required(
        "cross_section", "a shape of type disk or rectangle; the beam leaves along its normal");
    const auto shape = read_shape(context_, section, Placement::Identity(), {"disk", "rectangle"});
    const auto form = map.exactly_one({"flux", "irradiance"});
    const bool by_flux = form.key == "flux";
    const auto stated = read_quantity(form.value, by_flux ? dimension::flux : dimension::irradiance,
                                      Accept::positive);
    const auto relative = relative_spectrum(map);
    if (!shape || !stated) return;
    const auto* rectangle = std::get_if<Rectangle>(&*shape);
    const Vec3 direction = rectangle ? rectangle->edge_u.cross(rectangle->edge_v).normalized()
                                     : std::get<Disk>(*shape).normal;
    add(map, BeamLight{*shape, direction}, relative,
        flux_of(*stated, by_flux ? 1.0 : area_m2(*shape)));
}

std::optional<Vec3> LightReader::read_aim(YamlMap& map) {
    const YamlCursor cursor = map.required("aim", "'down' or a direction");
    if (cursor.is_scalar() && cursor.word() == "down") {
        if (context_.up) return -*context_.up;
        cursor.complain(
            "the scene does not say where 'up' is; expected the key 'up' of the scene, such as "
            "\"up: z\", or a direction here");
        return {};
    }
    const Vec3 aim = read_direction(cursor);
    return aim.allFinite() ? std::optional(aim) : std::nullopt;
}

void LightReader::read_luminaire(YamlMap& map) {
    const YamlCursor file = map.required("file", "an IES or EULUMDAT file");
    const auto path = context_.file(file);
    const YamlCursor lamp_set = map.optional("lamp_set");
    const int lamps = lamp_set ? static_cast<int>(read_count(lamp_set, 1, 100)) : 1;
    const auto photometry =
        path ? context_.attempt(file, [&] { return read_photometric_file(*path, lamps); })
             : std::nullopt;
    const Vec3 position = read_lengths(map.required("position", "the photometric centre"));
    const auto aim = read_aim(map);
    const YamlCursor c0_cursor = map.required(
        "c0", "the direction to which the half plane C0 of the file points, such as x");
    const Vec3 c0 = read_direction(c0_cursor);
    const auto change = map.at_most_one({"flux", "dimming"});
    const auto amount = read_quantity(
        change.value, change.key == "flux" ? dimension::luminous_flux : dimension::percent,
        Accept::positive);
    if (change.key == "dimming" && amount && amount->value > 1.0)
        change.value.complain("must be at most 100 %");
    const auto relative = relative_spectrum(map);
    if (aim && aim->cross(c0).norm() < 1e-6) c0_cursor.complain("must not be along 'aim'");
    if (!photometry || !aim || !c0.allFinite() || !position.allFinite() || name_.empty()) return;
    if (change.value && !amount) return;
    for (const std::string& deviation : photometry->deviations)
        context_.warn(file, fmt::format("{}: {}", path->string(), deviation));

    Luminaire luminaire;
    luminaire.position = position;
    luminaire.to_photometric = to_photometric(*aim, c0);
    luminaire.intensity = std::make_shared<const IntensityDistribution>(photometry->intensity);
    if (auto opening = opening_mesh(photometry->opening)) {
        Placement placement = Placement::Identity();
        placement.linear() = luminaire.to_photometric.transpose();
        placement.translation() = position;
        luminaire.opening = MeshInstance{
            prepare_mesh(std::move(opening->vertices), std::move(opening->triangles)), placement};
        const BsdfId black = parts_.add(Bsdf(Black{}));
        luminaire.object = parts_.add(Object{
            name_ + " (opening)", luminaire.opening, black, black, {}, "luminous openings", {}});
    }
    const double file_flux_lm = luminaire.intensity->luminous_flux_lm();
    const double flux_lm = change.key == "flux"      ? amount->value
                           : change.key == "dimming" ? amount->value * file_flux_lm
                                                     : file_flux_lm;
    add(map, std::move(luminaire), relative, {flux_lm, false});
}

void LightReader::read(const YamlCursor& entry) {
    YamlMap map(entry);
    name_ = names_.read(map);
    const auto type = map.required("type", "the type of the light")
                          .choice({"area", "point", "beam", "luminaire", "sky"});
    if (!type) return;
    if (*type == "area") read_area(map);
    if (*type == "sky") read_sky(map);
    if (*type == "point") read_point(map);
    if (*type == "beam") read_beam(map);
    if (*type == "luminaire") read_luminaire(map);
    map.no_other_keys();
}

}  // namespace

Eigen::Matrix3d to_photometric(const Vec3& aim, const Vec3& c0) {
    const Vec3 z = -aim;  // gamma = 0 is nadir
    const Vec3 x = (c0 - c0.dot(z) * z).normalized();
    Eigen::Matrix3d rotation;
    rotation.row(0) = x;
    rotation.row(1) = z.cross(x);
    rotation.row(2) = z;
    return rotation;
}

void read_lights(SceneContext& context, const SceneObjects& objects, const YamlCursor& section) {
    LightReader reader(context, objects);
    for (const YamlCursor& entry : section.list()) reader.read(entry);
}

}  // namespace lucerna::io
