// What the scene file says arrives in the parts of the simulation with the right value and unit.
#include <cmath>

#include "io/scene_lights.h"
#include "io/scene_observers.h"
#include "scene_text.h"
#include "spectral/illuminants.h"
#include "spectral/integral.h"
#include "spectral/photometry.h"

using namespace lucerna;
using namespace lucerna::io;
using namespace lucerna::optics;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

const Object& object(const SceneFile& scene, const std::string& name) {
    for (const Object& each : scene.parts.objects)
        if (each.name == name) return each;
    FAIL("no object " << name);
    return scene.parts.objects.front();
}

/// The good scene with another ball.
SceneFile with_shape(const std::string& shape, const std::string& place = "") {
    std::string text = replaced(
        good_scene, "{type: sphere, center: [1 m, 0.5 m, 0.5 m], radius: 100 mm}", shape + place);
    return read_scene_text(replaced(text, "material: glass", "material: white"));
}

/// The light in place of the bulb.
Light with_light(const std::string& light) {
    const SceneFile scene = read_scene_text(
        replaced(good_scene,
                 "type: point, position: [1 m, 0.5 m, 2 m], flux: 100 lm, spectrum: D65", light));
    return scene.parts.lights.at(1);
}

}  // namespace

TEST_CASE("Materials arrive with their numbers", "[unit]") {
    const SceneFile scene = read_scene_text(good_scene);
    const SceneParts& parts = scene.parts;
    const auto& white = std::get<Diffuse>(parts.bsdfs[object(scene, "floor").front]);
    CHECK(parts.spectra[white.reflectance].at(555.0) == 0.5);
    CHECK(parts.spectra[white.transmittance].at(555.0) == 0.0);

    const Object& plate = object(scene, "plate");
    CHECK(plate.front != plate.back);
    const auto& steel = std::get<RoughConductor>(parts.bsdfs[plate.back]);
    CHECK(parts.spectra[steel.n].at(500.0) == 2.5);
    CHECK(parts.spectra[steel.k].at(500.0) == 3.4);
    CHECK(steel.roughness == 0.3);

    const Object& ball = object(scene, "ball");
    REQUIRE(ball.interior);
    const Medium& glass = parts.media[*ball.interior];
    CHECK(std::holds_alternative<SmoothDielectric>(parts.bsdfs[ball.front]));
    CHECK(parts.spectra[glass.index].at(600.0) == 1.5);
    CHECK(parts.spectra[glass.absorption_per_m].at(600.0) == 0.3);
    CHECK_FALSE(glass.dispersive);
    CHECK(glass.absorbing);
    CHECK(glass.priority == 2);
    CHECK(object(scene, "gate").front == pass_through);
    CHECK(object(scene, "gate").back == pass_through);
    CHECK_FALSE(object(scene, "gate").interior);
}

TEST_CASE("A mixture has what scatters before what is specular, whatever the file's order",
          "[unit]") {
    std::string text = replaced(good_scene, "type: conductor, n: 2.5, k: 3.4, roughness: 0.3",
                                "type: mirror, reflectance: 0.9");
    text = replaced(text, "{weight: 0.9, material: white}, {weight: 0.1, material: steel}",
                    "{weight: 0.1, material: steel}, {weight: 0.9, material: white}");
    text = replaced(text, "  - name: floor\n    material: white",
                    "  - name: floor\n    material: varnish");
    const SceneFile scene = read_scene_text(text);
    const auto& bsdfs = scene.parts.bsdfs;
    const auto& varnish = std::get<Mixture>(bsdfs[object(scene, "floor").front]);
    REQUIRE(varnish.components.size() == 2);
    CHECK(varnish.components[0].weight == 0.9);
    CHECK(std::holds_alternative<Diffuse>(bsdfs[varnish.components[0].bsdf]));
    CHECK(varnish.components[1].weight == 0.1);
    CHECK(std::holds_alternative<Mirror>(bsdfs[varnish.components[1].bsdf]));
}

TEST_CASE("Absorption by transmittance and thickness, and by k", "[analytic]") {
    const auto absorption = [](const std::string& index, const std::string& value) {
        std::string text = replaced(good_scene, "absorption: 0.3 1/m", "absorption: " + value);
        text = replaced(text, "index: 1.5", "index: " + index);
        const SceneFile scene = read_scene_text(text);
        return scene.parts.spectra[scene.parts.media[0].absorption_per_m];
    };
    // exp(-alpha 0.1 m) = 0.92
    CHECK_THAT(
        std::exp(-0.1 * absorption("1.5", "{transmittance: 0.92, thickness: 100 mm}").at(500)),
        WithinRel(0.92, 1e-14));
    const auto table = absorption(
        "1.5", "{transmittance: {points: [[400 nm, 0.5], [700 nm, 1]]}, thickness: 1 cm}");
    CHECK_THAT(table.at(400.0), WithinRel(69.3147180559945, 1e-13));  // ln 2 / 1 cm
    CHECK(table.at(700.0) == 0.0);
    // N-BK7 at 546 nm: k = 6.9658e-9, alpha = 4 pi k / lambda = 0.16032 1/m
    const std::string bk7 =
        "{file: " + std::string(LUCERNA_EXAMPLES) + "/data/refractive/n-bk7.yml}";
    CHECK_THAT(absorption(bk7, "from index file").at(546.0), WithinRel(0.160321, 1e-4));
    CHECK(absorption("1.5", "0 1/m").max() == 0.0);
}

TEST_CASE("A medium is dispersive if its index is not constant", "[unit]") {
    const SceneFile scene = read_scene_text(
        replaced(good_scene, "index: 1.5", "index: {points: [[400 nm, 1.52], [700 nm, 1.50]]}"));
    CHECK(scene.parts.media[0].dispersive);
    CHECK_THAT(scene.warnings.at(0), Catch::Contains("cover 400 to 700 nm"));
    const SceneFile flat = read_scene_text(
        replaced(good_scene, "index: 1.5", "index: {points: [[400 nm, 1.5], [800 nm, 1.5]]}"));
    CHECK_FALSE(flat.parts.media[0].dispersive);
}

TEST_CASE("Shapes arrive in metres", "[unit]") {
    const SceneFile good = read_scene_text(good_scene);
    const auto& disk = std::get<Disk>(object(good, "plate").shape);
    CHECK(disk.normal == Vec3(0, 0, -1));
    CHECK_THAT(disk.radius_m, WithinRel(0.1, 1e-15));
    CHECK_THAT(disk.inner_radius_m, WithinRel(0.02, 1e-15));

    // center, size, normal z, up y: width along x, height along y.
    const auto& gate = std::get<Rectangle>(object(good, "gate").shape);
    CHECK_THAT((gate.corner - Vec3(0.5, 0.25, 0.9)).norm(), WithinAbs(0.0, 1e-15));
    CHECK_THAT((gate.edge_u - Vec3(1, 0, 0)).norm(), WithinAbs(0.0, 1e-15));
    CHECK_THAT((gate.edge_v - Vec3(0, 0.5, 0)).norm(), WithinAbs(0.0, 1e-15));

    const auto box =
        with_shape("{type: box, center: [1 m, 2 m, 3 m], size: [10 cm, 20 cm, 30 cm]}");
    CHECK_THAT((bounds(object(box, "ball").shape).min() - Vec3(0.95, 1.9, 2.85)).norm(),
               WithinAbs(0.0, 1e-15));
    const auto tube = with_shape(
        "{type: tube, from: [0 m, 0 m, 0 m], to: [0 m, 0 m, 10 mm], radius: 3 mm, inner_radius: 2 "
        "mm}");
    // 2 pi (R + r) h + 2 pi (R^2 - r^2)
    CHECK_THAT(area_m2(object(tube, "ball").shape),
               WithinRel(2.0 * pi * (5e-3 * 10e-3 + 5e-6), 1e-13));
}

TEST_CASE("A placement turns about the origin, in order, and then moves", "[analytic]") {
    // (1, 0, 0) -> 90 deg about z -> (0, 1, 0) -> 90 deg about x -> (0, 0, 1) -> moved.
    const auto scene = with_shape("{type: sphere, center: [1 m, 0 m, 0 m], radius: 1 cm}",
                                  "\n    place:\n      move: [10 m, 20 m, 30 m]\n      rotate:\n"
                                  "        - {axis: z, angle: 90 deg}\n"
                                  "        - {axis: [1, 0, 0], angle: 90 deg}");
    const auto& ball = std::get<Sphere>(object(scene, "ball").shape);
    CHECK_THAT((ball.centre - Vec3(10, 20, 31)).norm(), WithinAbs(0.0, 1e-13));
}

TEST_CASE("One mesh file is one mesh, whatever the number of objects", "[unit]") {
    const ScratchFolder folder;
    folder.write("tri.obj", "v 0 0 0\nv 2 0 0\nv 0 3 0\nf 1 2 3\n");
    std::string text = good_scene;
    const std::string mesh = "{type: mesh, file: tri.obj, unit: in}";
    text = replaced(text, "{type: sphere, center: [1 m, 0.5 m, 0.5 m], radius: 100 mm}", mesh);
    text = replaced(text, "material: glass", "material: white");
    text = replaced(
        text,
        "{type: rectangle, center: [1 m, 0.5 m, 0.9 m], size: [1 m, 0.5 m], normal: z, up: y}",
        mesh + "\n    place: {move: [0 m, 0 m, 1 m]}");
    const SceneFile scene = read_scene_file(folder.write("scene.yaml", text));
    const auto& one = std::get<MeshInstance>(object(scene, "ball").shape);
    const auto& two = std::get<MeshInstance>(object(scene, "gate").shape);
    CHECK(one.mesh == two.mesh);
    CHECK(two.placement.translation() == Vec3(0, 0, 1));
    CHECK_THAT(area_m2(object(scene, "ball").shape), WithinRel(3.0 * 0.0254 * 0.0254, 1e-12));
    CHECK(scene.files.size() == 2);
}

TEST_CASE("Lights have the flux that was stated", "[analytic]") {
    const SceneFile good = read_scene_text(good_scene);
    // Lambertian: Phi = pi L A, one side of an annulus.
    const double area = pi * (0.1 * 0.1 - 0.02 * 0.02);
    CHECK_THAT(good.parts.lights[0].luminous_flux_lm, WithinRel(pi * 1000.0 * area, 1e-12));
    CHECK(good.parts.lights[1].luminous_flux_lm == Approx(100.0).epsilon(1e-12));
    for (const Light& light : good.parts.lights)
        CHECK_THAT(spectral::luminous(good.parts.spectra[light.flux_w_per_nm]),
                   WithinRel(light.luminous_flux_lm, 1e-13));
    // The shape of the spectrum is that of illuminant A.
    const auto& lamp = good.parts.spectra[good.parts.lights[0].flux_w_per_nm];
    const auto a = *spectral::illuminant("A");
    CHECK_THAT(lamp.at(700.0) / lamp.at(450.0), WithinRel(a.at(700.0) / a.at(450.0), 1e-12));

    CHECK_THAT(with_light("type: point, position: [1 m, 0.5 m, 2 m], intensity: 10 cd, spectrum: E")
                   .luminous_flux_lm,
               WithinRel(40.0 * pi, 1e-12));
    const Light both =
        with_light("type: area, on: gate, side: both, exitance: 30 lm/m2, spectrum: E");
    CHECK_THAT(both.luminous_flux_lm, WithinRel(30.0 * 0.5 * 2.0, 1e-12));
    CHECK(std::get<AreaLight>(both.source).both_sides);
    const Light back = with_light("type: area, on: gate, side: back, flux: 5 lm, spectrum: E");
    CHECK(std::get<AreaLight>(back.source).inward);
    // A wall opening under a uniform sky and a white ground: M = 1000 lx, seen from one side.
    const Light sky = with_light(
        "type: sky, on: gate, side: back, sky: 5, illuminance: 1000 lx, ground: 100 %, spectrum: "
        "D65");
    CHECK_THAT(sky.luminous_flux_lm, WithinRel(1000.0 * 0.5, 1e-5));
    CHECK(std::get<AreaLight>(sky.source).inward);
    CHECK_THAT(
        with_light("type: sky, on: gate, side: back, sky: overcast, zenith: 9 cd/m2, ground: "
                   "0, spectrum: E")
                .luminous_flux_lm /
            with_light("type: sky, on: gate, side: back, sky: overcast, illuminance: 22 lx, "
                       "ground: 0, spectrum: E")
                .luminous_flux_lm,
        WithinRel(7.0 * pi / 22.0, 1e-12));  // E = 7 pi / 9 Lz
    const Light beam = with_light(
        "type: beam, cross_section: {type: rectangle, corner: [0 m, 0 m, 5 m], edge_u: [0 m, 0.5 "
        "m, 0 "
        "m], edge_v: [0.4 m, 0 m, 0 m]}, irradiance: 1000 lx, spectrum: D65");
    CHECK_THAT(beam.luminous_flux_lm, WithinRel(200.0, 1e-12));
    CHECK(std::get<BeamLight>(beam.source).direction == Vec3(0, 0, -1));
}

TEST_CASE("A radiant flux is scaled by radiant power", "[analytic]") {
    const Light watt =
        with_light("type: point, position: [1 m, 0.5 m, 2 m], flux: 2 W, spectrum: E");
    // 470 nm of equal energy: 683.002 lm/W * 106.857 nm / 470 nm (Wyszecki and Stiles).
    CHECK_THAT(watt.luminous_flux_lm, WithinRel(2.0 * 683.002 * 106.857 / 470.0, 1e-5));
}

TEST_CASE("A luminaire stands as its file, its aim and its C0 say", "[analytic]") {
    // gamma = 0 along aim; C = 0 along the part of c0 across it; C = 90 a quarter turn onward,
    // counter-clockwise seen from above.
    const Eigen::Matrix3d down = to_photometric(Vec3(0, 0, -1), Vec3(1, 0, 0));
    CHECK((down - Eigen::Matrix3d::Identity()).norm() < 1e-15);
    const Eigen::Matrix3d turned = to_photometric(Vec3(0, 0, -1), Vec3(0, 3, -1));
    CHECK((turned * Vec3(0, 1, 0) - Vec3(1, 0, 0)).norm() < 1e-15);
    CHECK((turned * Vec3(-1, 0, 0) - Vec3(0, 1, 0)).norm() < 1e-15);
    const Eigen::Matrix3d to_wall = to_photometric(Vec3(1, 0, 0), Vec3(0, 0, 1));
    CHECK((to_wall * Vec3(1, 0, 0) - Vec3(0, 0, -1)).norm() < 1e-15);
    CHECK(to_wall.determinant() == Approx(1.0));

    const std::string file =
        std::string(LUCERNA_EXAMPLES) + "/data/luminaires/linear_downlight.ldt";
    const std::string start = "type: luminaire, file: " + file +
                              ", position: [1 m, 0.5 m, 2 m], aim: down, c0: x, spectrum: D65";
    const Light plain = with_light(start);
    const Light dimmed = with_light(start + ", dimming: 25 %");
    const Light other = with_light(start + ", flux: 500 lm");
    CHECK_THAT(dimmed.luminous_flux_lm, WithinRel(0.25 * plain.luminous_flux_lm, 1e-12));
    CHECK_THAT(other.luminous_flux_lm, WithinRel(500.0, 1e-12));
    const auto& luminaire = std::get<Luminaire>(plain.source);
    CHECK_THAT(plain.luminous_flux_lm, WithinRel(luminaire.intensity->luminous_flux_lm(), 1e-12));
    REQUIRE(luminaire.object != no_object);
    // The opening of the file is 1201 mm long and 38 mm wide; EULUMDAT lays the length along C90.
    const Eigen::AlignedBox3d box = bounds(luminaire.opening);
    CHECK_THAT(box.sizes().y(), WithinRel(1.201, 1e-9));
    CHECK_THAT(box.sizes().x(), WithinRel(0.038, 1e-9));
    CHECK_THAT((box.center() - Vec3(1.0, 0.5, 2.0)).norm(), WithinAbs(0.0, 1e-12));
}

TEST_CASE("Sensors stand where they should", "[unit]") {
    const SceneFile scene = read_scene_text(good_scene);
    const auto& camera = std::get<Camera>(scene.parts.observers[0]);
    CHECK(camera.up == Vec3(0, 0, 1));
    CHECK_THAT(camera.horizontal_fov_rad, WithinRel(40.0 * pi / 180.0, 1e-15));
    CHECK(camera.height == 48);
    // The acceptance is the full angle of the cone.
    const auto& meter = std::get<LuminanceMeter>(scene.parts.observers[2]);
    CHECK_THAT(meter.acceptance_half_angle_rad, WithinRel(pi / 180.0, 1e-15));
    CHECK_THAT((meter.direction - Vec3(0, 1.5, -1).normalized()).norm(), WithinAbs(0.0, 1e-15));
    REQUIRE(scene.parts.receivers.size() == 1);
    CHECK(scene.parts.objects[scene.parts.receivers[0].object].name == "gate");
}

TEST_CASE("Grid spacing follows EN 12464-1", "[published]") {
    // Table of the standard: 0.40 m -> 0.15, 0.6 -> 0.2, 1 -> 0.2, 2 -> 0.3, 5 -> 0.6, 10 -> 1,
    // 25 -> 2, 50 -> 3, 100 -> 5 (rounded there to one digit).
    const auto square = [](double d) { return en12464_spacing_m(d, d); };
    CHECK_THAT(square(1.0), WithinRel(0.2, 1e-12));
    CHECK_THAT(square(10.0), WithinRel(1.0, 1e-12));
    CHECK_THAT(square(100.0), WithinRel(5.0, 1e-12));
    CHECK_THAT(square(2.0), WithinAbs(0.325, 1e-3));
    CHECK_THAT(square(5.0), WithinAbs(0.616, 1e-3));
    CHECK(square(1e6) == 10.0);
    // A ratio of 2 or more: by the shorter side.
    CHECK(en12464_spacing_m(4.0, 2.0) == square(2.0));
    CHECK(en12464_spacing_m(3.9, 2.0) == square(3.9));
}

TEST_CASE("Grid points lie in the middle of their cells", "[analytic]") {
    const auto grid = [](const std::string& spacing) {
        const SceneFile scene = read_scene_text(
            replaced(good_scene,
                     "{name: spot, type: illuminance, position: [1 m, 0.5 m, 0.01 m], normal: z}",
                     "{name: spot, type: illuminance_grid, corner: [1 m, 0 m, 0.7 m], edge_u: [2 "
                     "m, 0 m, 0 m], "
                     "edge_v: [0 m, 1.2 m, 0 m], normal: z, " +
                         spacing + "}"));
        return std::get<IlluminancePoints>(scene.parts.observers.at(1));
    };
    // p(2 m) = 0.325 m: 2 / 0.325 -> 7 columns, 1.2 / 0.325 -> 4 rows.
    const IlluminancePoints by_standard = grid("spacing: auto");
    CHECK(by_standard.columns == 7);
    CHECK(by_standard.rows == 4);
    CHECK_THAT((by_standard.positions.front() - Vec3(1.0 + 1.0 / 7.0, 0.15, 0.7)).norm(),
               WithinAbs(0.0, 1e-14));
    CHECK_THAT((by_standard.positions.at(8) - Vec3(1.0 + 3.0 / 7.0, 0.45, 0.7)).norm(),
               WithinAbs(0.0, 1e-14));
    const IlluminancePoints by_length = grid("spacing: 0.4 m");
    CHECK(by_length.columns == 5);
    CHECK(by_length.rows == 3);
    const IlluminancePoints by_count = grid("columns: 2, rows: 3");
    CHECK(by_count.positions.size() == 6);
}

TEST_CASE("Settings arrive", "[unit]") {
    const Settings settings = read_scene_text(good_scene).settings;
    CHECK(settings.method == Method::combined);
    CHECK(settings.image_accuracy == 0.02);
    CHECK(settings.sensor_accuracy == 0.01);
    CHECK(settings.sensor_targets.empty());
    CHECK(settings.time_limit_s == 600.0);
    CHECK(settings.seed == 7);
    const Settings others =
        read_scene_text(replaced(good_scene, "seed: 7",
                                 "seed: 18446744073709551615, phases: 12, forward_rays: 1000, "
                                 "samples_per_pixel: 4, spectral_bins: 47"))
            .settings;
    CHECK(others.seed == 18446744073709551615u);
    CHECK(others.max_phases == 12u);
    CHECK(others.forward_rays == 1000u);
    CHECK(others.samples_per_pixel == 4);
    CHECK(others.spectral_bins == 47);
}

TEST_CASE("The summary names what was read", "[unit]") {
    const std::string summary = scene_summary(read_scene_text(good_scene));
    CHECK_THAT(summary, Catch::Contains("objects    4, with 0 triangles"));
    CHECK_THAT(summary, Catch::Contains("glass: index 1.5, absorption 0.3 1/m, priority 2"));
    CHECK_THAT(summary, Catch::Contains("lights     2, "));
    CHECK_THAT(summary, Catch::Contains("bulb (point): 100 lm"));
    CHECK_THAT(summary, Catch::Contains("camera 'view', 64 x 48 pixels"));
    CHECK_THAT(summary, Catch::Contains("luminance meter 'meter', 2 deg"));
    CHECK_THAT(summary, Catch::Contains("flux 'through' on 'gate'"));
    CHECK_THAT(summary, Catch::Contains("warnings   0"));
}

TEST_CASE("A bound can be asked of single sensors, as a share or in their unit", "[unit]") {
    const Settings settings =
        read_scene_text(replaced(good_scene, "sensors: 1%",
                                 "sensors: {spot: 2 lx, meter: 0.5 %, through: 10 mlm}"))
            .settings;
    CHECK_FALSE(settings.sensor_accuracy);
    REQUIRE(settings.sensor_targets.size() == 3);
    CHECK(settings.target_of("spot").wanted(500.0) == 2.0);
    CHECK_THAT(settings.target_of("meter").wanted(1000.0), WithinRel(5.0, 1e-12));
    CHECK_THAT(settings.target_of("through").wanted(7.0), WithinRel(0.01, 1e-12));
    CHECK(settings.target_of("another").wanted(7.0) == 0.0);
}
