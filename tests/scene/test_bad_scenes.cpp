// What is wrong in the scene file itself: each complaint at its exact place.
#include "scene_text.h"

using namespace lucerna;
using namespace lucerna::io;

namespace {

/// The good scene with one place made wrong; the '@' marks where the complaint belongs.
void refuse(const std::string& from, const std::string& to, const std::string& message) {
    check_refused_at_mark(replaced(good_scene, from, to), message);
}

}  // namespace

TEST_CASE("The scene that the others vary is good", "[unit]") {
    CHECK_NOTHROW(read_scene_text(good_scene));
}

TEST_CASE("The version comes first", "[unit]") {
    refuse("lucerna: 1\nup: z", "up: z\nlucerna: @1", "must be the first key");
    refuse("lucerna: 1", "lucerna: @2", "expected 1, the version");
    refuse("lucerna: 1\nup", "@up", "the key 'lucerna' is missing");
    check_refused_at_mark("@just a word\n", "found a single value; expected a map");
}

TEST_CASE("Unknown keys are refused with the nearest one", "[unit]") {
    refuse("reflectance: 0.5}", "reflectance: 0.5, @colour: red}", "unknown key 'colour'");
    refuse("seed: 7", "@sead: 7", "did you mean 'seed'?");
    refuse("cameras:", "@camera: []\ncameras:", "did you mean 'cameras'?");
    refuse("inner_radius: 2 cm", "@inner_radius_: 2 cm", "did you mean 'inner_radius'?");
    refuse("image: 2 %", "@picture: 2 %", "unknown key 'picture'; expected 'image' or 'sensors'");
    refuse("type: sphere, ", "type: @spere, ", "did you mean 'sphere'?");
    refuse("type: mixture", "type: @blend", "'blend' is not known; expected 'diffuse'");
    refuse("method: combined", "method: @photons", "'photons' is not known");
}

TEST_CASE("Duplicate keys and names are refused", "[unit]") {
    refuse("fov: 40 deg", "fov: 40 deg, @fov: 50 deg", "duplicate key 'fov', first given in line");
    refuse("simulation:", "@up: y\nsimulation:", "duplicate key 'up', first given in line 2");
    refuse("  lined:", "  @white: {type: black}\n  lined:", "duplicate key 'white'");
    refuse("name: ball", "name: @plate", "the name 'plate' is taken by line 14");
    refuse("name: bulb", "name: @lamp", "the name 'lamp' is taken by line");
}

TEST_CASE("Missing keys are refused", "[unit]") {
    refuse("{type: sphere, center: [1 m, 0.5 m, 0.5 m], radius: 100 mm}",
           "@{type: sphere, center: [1 m, 0.5 m, 0.5 m]}", "the key 'radius' is missing");
    refuse("{type: dielectric, index: 1.5, absorption: 0.3 1/m, priority: 2}",
           "@{type: dielectric, index: 1.5, priority: 2}",
           "the key 'absorption' is missing; expected a coefficient such as \"0.3 1/m\"");
    refuse("{name: lamp, type: area, on: plate, side: front, luminance: 1000 cd/m2, spectrum: A}",
           "@{name: lamp, type: area, on: plate, side: front, spectrum: A}",
           "one of the keys 'flux', 'luminance' or 'exitance' is missing");
    refuse("{name: lamp, type: area, on: plate, side: front, luminance: 1000 cd/m2, spectrum: A}",
           "@{name: lamp, type: area, on: plate, side: front, luminance: 1000 cd/m2}",
           "the key 'spectrum' is missing");
    refuse("{name: lamp, type: area, on: plate, side: front,",
           "@{name: lamp, type: area, on: plate,", "the key 'side' is missing: 'plate' is a sheet");
    refuse("luminance: 1000 cd/m2", "flux: 10 lm, luminance: @1000 cd/m2",
           "only one of 'flux', 'luminance' or 'exitance'");
    refuse("  - name: gate\n    material: none\n", "  - @name: gate\n",
           "the key 'material' is missing");
}

TEST_CASE("Numbers need their units", "[unit]") {
    refuse("flux: 100 lm", "flux: @1200",
           "'1200' has no unit; expected a flux such as \"1200 lm\"");
    refuse("flux: 100 lm", "flux: @100 cd", "has the unit 'cd', not lm");
    refuse("luminance: 1000 cd/m2", "luminance: @1000 lm", "has the unit 'lm', not cd/m2");
    refuse("radius: 100 mm", "radius: @100", "has no unit; expected a length");
    refuse("radius: 100 mm", "radius: @100 deg", "has the unit 'deg', not m");
    refuse("fov: 40 deg", "fov: @40", "expected an angle such as \"20 deg\"");
    refuse("absorption: 0.3 1/m", "absorption: @0.3", "expected an absorption coefficient");
    refuse("time_limit: 10 min", "time_limit: @10", "expected a time");
    refuse("image: 2 %", "image: @0.02", "expected a percentage such as \"2 %\"");
    refuse("position: [1 m, 0.5 m, 2 m]", "position: [1 m, @0.5, 2 m]", "has no unit");
    refuse("normal: -z, radius", "normal: [0 , 0, @1 m], radius", "has the unit 'm'");
    refuse("index: 1.5,", "index: @1.5 m,", "has the unit 'm'");
}

TEST_CASE("Values out of their range are refused", "[unit]") {
    refuse("reflectance: 0.5}", "reflectance: @1.2}", "'1.2' is more than 1 (100 %)");
    refuse("reflectance: 0.5}", "reflectance: @-0.1}", "is negative");
    refuse("reflectance: 0.5}", "reflectance: @120 %}", "is more than 1");
    refuse("transmittance: 0.6", "transmittance: @0.8",
           "add up to 1.1 at some wavelength, more than 1");
    refuse("transmittance: 0.6",
           "transmittance: @{points: [[400 nm, 0.5], [500 nm, 0.9], [600 nm, 0.5]]}",
           "add up to 1.2");
    refuse("index: 1.5", "index: @0.9", "below 1");
    refuse("roughness: 0.3", "roughness: @0", "must be more than zero");
    refuse("roughness: 0.3", "roughness: @1.3", "must be at most 1");
    refuse("radius: 100 mm", "radius: @-100 mm", "is negative");
    refuse("radius: 100 mm", "radius: @0 mm", "must be more than zero");
    refuse("radius: 100 mm", "radius: @.inf mm", "is not a number");
    refuse("radius: 100 mm", "radius: @nan mm", "is not finite");
    refuse("{type: sphere, center: [1 m, 0.5 m, 0.5 m], radius: 100 mm}",
           "@{type: sphere, center: [1 m, 0.5 m, 0.5 m], radius: 1e200 m}", "no finite area");
    refuse("inner_radius: 2 cm", "inner_radius: @20 cm", "must be smaller than 'radius'");
    refuse("absorption: 0.3 1/m", "absorption: @-0.3 1/m", "is negative");
    refuse("flux: 100 lm", "flux: @0 lm", "must be more than zero");
    refuse("fov: 40 deg", "fov: @180 deg", "must be less than 180 deg");
    refuse("acceptance: 2 deg", "acceptance: @200 deg", "must be at most 180 deg");
    refuse("[64, 48]", "[@0, 48]", "'0' is not a whole number from 1 to");
    refuse("[64, 48]", "@[32768, 32768]", "more than 134217728 pixels");
    refuse("[64, 48]", "@[64]", "expected width and height");
    refuse("{image: 2 %,", "{image: @200 %,", "must be at most 100 %");
    refuse("seed: 7", "seed: @-7", "is not a whole number");
    refuse("seed: 7", "seed: @7.5", "is not a whole number");
    refuse("weight: 0.1,", "weight: @1.1,", "is more than 1");
    refuse("components: [{weight: 0.9", "components: @[{weight: 0.95",
           "the weights add up to 1.05");
}

TEST_CASE("Shapes that contradict themselves are refused", "[unit]") {
    refuse("{type: rectangle, corner: [0 m, 0 m, 0 m], edge_u: [2 m, 0 m, 0 m]",
           "@{type: rectangle, corner: [0 m, 0 m, 0 m], edge_u: [2 m, 1 mm, 0 m]",
           "not at right angles");
    refuse("normal: z, up: y}", "normal: z, up: @[0, 0, -2]}", "must not be along 'normal'");
    refuse("{type: sphere, center: [1 m, 0.5 m, 0.5 m], radius: 100 mm}",
           "{type: box, min: [0 m, 0 m, 1 m], max: @[1 m, 1 m, 1 m]}", "larger than 'min'");
    refuse("{type: sphere, center: [1 m, 0.5 m, 0.5 m], radius: 100 mm}",
           "@{type: cylinder, from: [0 m, 0 m, 1 m], to: [0 m, 0 m, 1 m], radius: 1 m}",
           "are the same point");
    refuse("normal: -z, radius", "normal: @[0, 0, 0], radius", "cannot be [0, 0, 0]");
    refuse("normal: -z, radius", "normal: @down, radius", "'down' is not known");
    refuse("center: [1 m, 0.5 m, 0.5 m]", "center: @[1 m, 0.5 m]", "has 2 entries; expected three");
    refuse("center: [1 m, 0.5 m, 0.5 m]", "center: @1 m", "found a single value; expected three");
    refuse("to: [1 m, 0 m, 0.5 m]", "to: @[1 m, -3 m, 1 m]", "must differ from 'from'");
}

TEST_CASE("Materials and objects that do not fit are refused", "[unit]") {
    refuse("front: white", "front: @whyte", "there is no material 'whyte'; did you mean 'white'?");
    refuse("front: white", "front: @glass", "cannot be one side of a surface");
    refuse("material: white}, {weight", "material: @glass}, {weight",
           "cannot be part of a mixture");
    refuse("material: white}, {weight", "material: @varnish}, {weight", "is made of itself");
    refuse("  lined:", "  none: @{type: black}\n  lined:", "'none' is the name for surfaces");
    refuse("    material: none\n    shape: {type: rect",
           "    material: glass\n    shape: @{type: rect",
           "cannot be of the dielectric 'glass': it is a flat sheet");
    refuse("    material: none\n", "    material: white\n    priority: @3\n",
           "only solids of a dielectric have a priority");
    refuse("on: plate", "on: @plat", "there is no object 'plat'; did you mean 'plate'?");
    refuse("on: gate", "on: @gat", "did you mean 'gate'?");
    refuse("on: plate, side: front", "on: ball, side: @both", "'ball' is a solid");
    refuse("{name: bulb, type: point, position: [1 m, 0.5 m, 2 m],",
           "{name: bulb, type: area, side: back, on: @plate,", "'plate' emits already by line");
}

TEST_CASE("Skies that make no sense are refused", "[unit]") {
    const std::string bulb =
        "{name: bulb, type: point, position: [1 m, 0.5 m, 2 m], flux: 100 lm, spectrum: D65}";
    const auto refuse_sky = [&](const std::string& light, const std::string& part) {
        refuse(bulb, light, part);
    };
    refuse_sky(
        "{name: bulb, type: sky, on: gate, side: back, sky: @16, zenith: 1 kcd/m2, ground: 0, "
        "spectrum: E}",
        "'16' is not a whole number from 1 to 15");
    refuse_sky(
        "@{name: bulb, type: sky, on: gate, side: back, sky: 12, zenith: 1 kcd/m2, ground: 0, "
        "spectrum: E}",
        "the key 'sun' is missing");
    refuse_sky(
        "{name: bulb, type: sky, on: gate, side: back, sky: 1, sun: @z, zenith: 1 kcd/m2, ground: "
        "0, spectrum: E}",
        "expected no 'sun'");
    refuse_sky(
        "{name: bulb, type: sky, on: gate, side: back, sky: 12, sun: @[0, 1, -1], zenith: 1 "
        "kcd/m2, "
        "ground: 0, spectrum: E}",
        "not above the horizon");
    refuse_sky(
        "{name: bulb, type: sky, on: @ball, side: back, sky: 5, zenith: 1 kcd/m2, ground: 0, "
        "spectrum: E}",
        "'ball' is no rectangle and no disk");
    refuse_sky(
        "@{name: bulb, type: sky, on: gate, side: back, sky: 5, zenith: 1 kcd/m2, spectrum: E}",
        "the key 'ground' is missing");
}

TEST_CASE("Spectra that make no sense are refused", "[unit]") {
    refuse("spectrum: A", "spectrum: @LED-B33", "did you mean 'LED-B3'?");
    refuse("spectrum: A", "spectrum: {planck: @2856}", "has no unit; expected a temperature");
    refuse("spectrum: A", "spectrum: {planck: @-5 K}", "is negative");
    refuse("spectrum: A", "spectrum: {daylight: @100 K}", "");
    refuse("spectrum: A", "spectrum: @{planck: 1 K}", "holds no visible light");
    refuse("spectrum: A", "spectrum: @{points: [[900 nm, 1], [1000 nm, 1]]}", "no visible light");
    refuse("spectrum: A", "spectrum: {points: [[500 nm, 1], [@400 nm, 1]]}", "must increase");
    refuse("spectrum: A", "spectrum: {points: [[500 nm, 1], @[600 nm]]}",
           "a wavelength and a value");
    refuse("spectrum: A", "spectrum: {points: @[[500 nm, 1]]}", "at least two points");
    refuse("spectrum: A", "spectrum: {points: [[@500, 1], [600 nm, 1]]}", "has no unit");
    refuse("spectrum: A", "spectrum: {points: [[500 nm, @-1], [600 nm, 1]]}", "is negative");
    refuse("absorption: 0.3 1/m", "absorption: @from index file",
           "holds no extinction coefficient");
    refuse("absorption: 0.3 1/m", "absorption: {transmittance: @0, thickness: 10 mm}",
           "which no absorption coefficient can give");
    refuse("absorption: 0.3 1/m", "absorption: @{transmittance: 0.9}", "'thickness' is missing");
}

TEST_CASE("A scene must be able to compute something", "[unit]") {
    const auto lights = good_scene.find("lights:");
    const auto cameras = good_scene.find("cameras:");
    const auto simulation = good_scene.find("simulation:");
    check_refused_at_mark("@" + good_scene.substr(0, lights) + good_scene.substr(cameras),
                          "no light is described");
    check_refused_at_mark("@" + good_scene.substr(0, cameras) + good_scene.substr(simulation),
                          "nothing is to be computed");
}

TEST_CASE("A bound is asked of a sensor that exists, in its unit", "[unit]") {
    const auto asked = [](const std::string& of) {
        return replaced(good_scene, "sensors: 1%", "sensors: {" + of + "}");
    };
    check_refused_at_mark(asked("sopt: @1 %"), "there is no sensor 'sopt'; did you mean 'spot'?");
    check_refused_at_mark(asked("spot: @2 lm"), "lm");
    check_refused_at_mark(asked("spot: @2 W/m2"), "'2 W/m2' is not in % or lx");
    check_refused_at_mark(asked("spot: @0 %"), "must be more than zero");
    check_refused_at_mark(asked("spot: @[1 %]"), "");
}

TEST_CASE("What needs the direction up asks for it", "[unit]") {
    const std::string no_up = replaced(good_scene, "up: z\n", "");
    check_refused_at_mark(replaced(no_up, "- {name: view", "- @{name: view"),
                          "the key 'up' is missing");
    CHECK_NOTHROW(read_scene_text(replaced(no_up, "fov: 40 deg", "fov: 40 deg, up: z")));
}

TEST_CASE("All errors of a file are reported at once, in its order", "[unit]") {
    std::string text = good_scene;
    text = replaced(text, "reflectance: 0.5}", "reflectance: 1.5}");
    text = replaced(text, "radius: 100 mm", "radius: 100");
    text = replaced(text, "on: plate", "on: nothing");
    text = replaced(text, "fov: 40 deg", "fow: 40 deg");
    text = replaced(text, "seed: 7", "seed: x");
    text = replaced(text, "name: gate", "name: floor");
    const ScratchFolder folder;
    const auto path = folder.write("scene.yaml", text);
    const auto list = complaints_about(path);
    // floor is white, which is wrong itself; that must not be said a second time, and neither may
    // the receiver on 'gate' be dropped silently.
    std::vector<std::string> found;
    for (const Diagnostic& diagnostic : list) {
        CHECK(diagnostic.where.file == path.string());
        found.push_back(diagnostic.text().substr(path.string().size()));
    }
    CAPTURE(found);
    REQUIRE(list.size() == 8);
    CHECK(found[0].rfind(":4:39: materials.white.reflectance: '1.5' is more than 1", 0) == 0);
    CHECK(found[1].rfind(":19:64: objects[2].shape.radius: '100' has no unit", 0) == 0);
    CHECK(found[2].rfind(":20:11: objects[3].name: the name 'floor' is taken by line 11", 0) == 0);
    CHECK(found[3].rfind(":24:34: lights[0].on: there is no object 'nothing'", 0) == 0);
    CHECK(found[4].rfind(":27:5: cameras[0]: the key 'fov' is missing", 0) == 0);
    CHECK(found[5].rfind(":27:84: cameras[0]: unknown key 'fow'; did you mean 'fov'?", 0) == 0);
    CHECK(found[6].rfind(":31:37: sensors[2].on: there is no object 'gate'", 0) == 0);
    CHECK(found[7].rfind(":32:95: simulation.seed: 'x' is not a whole number", 0) == 0);
}
