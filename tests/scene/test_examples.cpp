// The examples are read, and hold what their first lines promise.
#include "optics/geometry/mesh_check.h"
#include "scene_text.h"

using namespace lucerna;
using namespace lucerna::io;
using namespace lucerna::optics;
using Catch::Matchers::WithinRel;

namespace {

SceneFile example(const std::string& name) {
    return read_scene_file(std::filesystem::path(LUCERNA_EXAMPLES) / (name + ".yaml"));
}

double total_lm(const SceneFile& scene) {
    double sum = 0.0;
    for (const Light& light : scene.parts.lights) sum += light.luminous_flux_lm;
    return sum;
}

}  // namespace

TEST_CASE("All examples are read", "[unit]") {
    const std::string name =
        GENERATE("cornell_box", "cornell_caustic", "light_guides_1", "light_guides_2",
                 "light_guides_3", "room2", "prism_spectrum");
    const SceneFile scene = example(name);
    CHECK(std::filesystem::equivalent(scene.files.front(),
                                      std::filesystem::path(LUCERNA_EXAMPLES) / (name + ".yaml")));
    CHECK(scene.files.size() >= 2);
    CHECK(scene.settings.image_accuracy);
    const std::string summary = scene_summary(scene);
    for (const Light& light : scene.parts.lights)
        CHECK_THAT(summary, Catch::Contains(light.name + " ("));
    for (const std::string& warning : scene.warnings) CHECK_THAT(summary, Catch::Contains(warning));
}

TEST_CASE("The prism turns light of 550 nm least, to the middle of its screen", "[analytic]") {
    const SceneFile scene = example("prism_spectrum");
    const double half_apex_rad = std::atan2(34.641016, 60.0);
    const auto& beam = std::get<BeamLight>(scene.parts.lights.at(0).source);
    const Object& prism = scene.parts.objects.at(0);
    const double index = scene.parts.spectra[scene.parts.media[*prism.interior].index].at(550.0);
    // n sin(A / 2) = sin i: Born and Wolf, 7th ed., 4.7.2. Entry and exit are alike.
    const Vec3 entry_normal(-std::cos(half_apex_rad), 0.0, std::sin(half_apex_rad));
    const double sine = beam.direction.cross(entry_normal).norm();
    CHECK_THAT(sine, WithinRel(index * std::sin(half_apex_rad), 1e-4));
    const Vec3 out(beam.direction.x(), 0.0, -beam.direction.z());
    const auto middle_of = [](const Shape& shape) -> Vec3 {
        const auto& rectangle = std::get<Rectangle>(shape);
        return rectangle.corner + 0.5 * (rectangle.edge_u + rectangle.edge_v);
    };
    const Vec3 start = middle_of(beam.cross_section);
    const Vec3 mirrored(-start.x(), 0.0, start.z());  // on the way out
    const Vec3 way = middle_of(scene.parts.objects.at(1).shape) - mirrored;
    CHECK(way.cross(out).norm() < 1e-3);
}

TEST_CASE("The Cornell box is the published one", "[published]") {
    const SceneFile scene = example("cornell_box");
    CHECK(scene.parts.objects.size() == 8);
    // A Lambertian lamp of 130 mm x 105 mm and 10 000 cd/m2: pi L A.
    CHECK_THAT(total_lm(scene), WithinRel(3.14159265358979 * 1e4 * 0.130 * 0.105, 1e-12));
    const auto& camera = std::get<Camera>(scene.parts.observers.at(0));
    CHECK_THAT(std::tan(0.5 * camera.horizontal_fov_rad), WithinRel(0.0125 / 0.035, 1e-5));
    CHECK(camera.width == 512);
    for (const Object& object : scene.parts.objects) {
        CAPTURE(object.name);
        const Eigen::AlignedBox3d box = bounds(object.shape);
        CHECK(box.min().minCoeff() >= -1e-12);
        CHECK(box.max().maxCoeff() <= 0.5592 + 1e-12);
        if (object.name == "short block" || object.name == "tall block")
            CHECK(is_solid(object.shape));
        if (object.name == "lamp face") {
            // It emits downward.
            const SurfacePoint point = sample_area(object.shape, 0.5, 0.5);
            CHECK(point.normal.y() == -1.0);
        }
    }
}

TEST_CASE("The guides of PMMA hold their lamps and dots", "[unit]") {
    const SceneFile scene = example(GENERATE("light_guides_1", "light_guides_2", "light_guides_3"));
    REQUIRE(scene.parts.media.size() == 1);
    CHECK(scene.parts.media[0].dispersive);
    CHECK(scene.parts.media[0].absorbing);
    // Beadie et al. (2015), their formula worked out by hand at 587.6 nm.
    CHECK_THAT(scene.parts.spectra[scene.parts.media[0].index].at(587.6), WithinRel(1.49252, 1e-5));
    CHECK(scene.parts.receivers.size() == 5);
    CHECK_THAT(total_lm(scene), WithinRel(100.0, 1e-12));

    const auto guide_of = [&](const std::string& name) -> const Object* {
        for (const Object& object : scene.parts.objects)
            if (object.interior && name.rfind(object.name + " ", 0) == 0) return &object;
        return nullptr;
    };
    const bool lamps_inside = scene.parts.lights.back().source.index() == 0;
    for (const Object& object : scene.parts.objects) {
        const Object* guide = guide_of(object.name);
        if (!guide) continue;
        CAPTURE(object.name);
        const bool dot = object.name.find("dot") != std::string::npos;
        const bool lamp = object.name.find("lamp") != std::string::npos;
        // Wholly inside the solid: no surface of another material cuts the boundary of the glass.
        for (double u = 0.0; u < 1.0; u += 0.09)
            for (double v = 0.0; v < 1.0; v += 0.09)
                CHECK(contains(guide->shape, sample_area(object.shape, u, v).position) ==
                      (dot || (lamp && lamps_inside)));
    }
}

TEST_CASE("The furnished room has what its sensors need", "[unit]") {
    const SceneFile scene = example("room2");
    CHECK(scene.parts.objects.size() >= 60);
    REQUIRE(scene.parts.lights.size() == 3);
    // 0.8 of what the file of the downlight gives, and a pendant near its two lamps of 2900 lm.
    CHECK(scene.parts.lights[1].luminous_flux_lm > 0.6 * 5800.0);
    CHECK(scene.parts.lights[1].luminous_flux_lm < 5800.0);
    CHECK_THAT(scene.parts.lights[2].luminous_flux_lm, WithinRel(0.8 * 2112.0, 0.02));
    // 2 m x 1.4 m at 3000 cd/m2.
    CHECK_THAT(scene.parts.lights[0].luminous_flux_lm,
               WithinRel(3.14159265358979 * 3000 * 2.8, 1e-12));
    for (const Object& object : scene.parts.objects) {
        CAPTURE(object.name);
        const Eigen::AlignedBox3d box = bounds(object.shape);
        CHECK(box.min().x() >= -0.2 - 1e-9);
        CHECK(box.max().x() <= 6.0 + 1e-9);
        CHECK(box.min().y() >= -1e-9);
        CHECK(box.max().y() <= 4.0 + 1e-9);
        CHECK(box.min().z() >= -1e-9);
        CHECK(box.max().z() <= 2.8 + 1e-9);
    }
}

TEST_CASE("No sensor of an example stands inside a solid", "[unit]") {
    const SceneFile scene = example(GENERATE("cornell_caustic", "room2"));
    for (const Observer& observer : scene.parts.observers) {
        const auto* points = std::get_if<IlluminancePoints>(&observer);
        if (!points) continue;
        for (const Vec3& position : points->positions)
            for (const Object& object : scene.parts.objects) {
                CAPTURE(points->name, object.name, position.transpose());
                CHECK_FALSE((is_solid(object.shape) && contains(object.shape, position)));
            }
    }
}
