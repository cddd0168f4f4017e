// What is stated of a run: that it stopped where it was told to, what follows from several readings
// together, and the colour of a reading.
#include "spectral/colorimetry.h"
#include "spectral/illuminants.h"
#include "tests/support/cornell_scenes.h"
#include "tests/support/truth_checks.h"
#include "validation/cases/pane_shadow.h"
#include "validation/truth/polygon_light.h"

using namespace lucerna;
using namespace lucerna::optics;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using validation::SceneBuilder;

namespace {

// A square luminaire over a black floor, seen by a row of points.
constexpr double lamp_luminance = 1000.0;
const std::vector<Vec3> row{{0.0, 0, 0}, {0.5, 0, 0}, {1.0, 0, 0}, {1.5, 0, 0}, {2.0, 0, 0}};
const Vec3 corner(-0.3, -0.3, 1.5), u(0, 0.6, 0), v(0.6, 0, 0);

SceneBuilder luminaire_over_row() {
    SceneBuilder scene;
    scene.area_light(scene.object("lamp", Rectangle{corner, u, v}, scene.black()), lamp_luminance);
    scene.points(row, Vec3::UnitZ());
    return scene;
}

double illuminance(const Vec3& x) {
    return truth::polygon_illuminance(truth::corners(corner, u, v), lamp_luminance, x,
                                      Vec3::UnitZ());
}

// Agreement of an uncertain number with its truth at a level of 1e-6.
bool agrees(const Uncertain& result, double truth) {
    const double t = student_t(1.0 - 1e-6, result.degrees_of_freedom);
    return std::abs(result.value - truth) <= t * result.standard_error;
}

const DerivedQuantity& derived(const Result& result, const std::string& name) {
    return *std::ranges::find(result.derived, "points: " + name, &DerivedQuantity::name);
}

}  // namespace

TEST_CASE("A run stops when each sensor has the uncertainty that was asked for", "[statistical]") {
    const bool by_name = GENERATE(false, true);
    Settings settings;
    settings.max_phases = 20000;
    settings.forward_rays = 100;
    if (by_name) {
        settings.sensor_targets = {{"points", 0.0, 0.5}};  // lx
    } else {
        settings.sensor_accuracy = 0.003;
    }
    const Result result = simulate(luminaire_over_row().parts, settings);
    CHECK(result.stopped_by == "accuracy");
    CHECK(result.accuracy_reached);
    CHECK(result.phases >= 16);
    double worst = 0.0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const Uncertain reading = result.quantities[i].result();
        const double asked = by_name ? 0.5 : 0.003 * reading.value;
        worst = std::max(worst, reading.expanded_uncertainty() / asked);
        CHECK(agrees(reading, illuminance(row[i])));
    }
    CHECK(worst <= 1.0);
    if (result.phases > 40) CHECK(worst > 0.6);  // it did not go on for nothing
    // Twin: a run that may not go on says that it did not get there.
    settings.max_phases = 2;
    settings.sensor_targets.clear();
    settings.sensor_accuracy = 1e-6;
    const Result short_run = simulate(luminaire_over_row().parts, settings);
    CHECK_FALSE(short_run.accuracy_reached);
    CHECK(short_run.stopped_by == "phases");
    // It names the reading that lacks most.
    const auto relative = [](const Quantity& quantity) {
        return quantity.result().expanded_uncertainty() / quantity.result().value;
    };
    const Quantity& furthest = *std::ranges::max_element(short_run.quantities, {}, relative);
    CHECK(short_run.furthest.reading == furthest.name);
    CHECK_THAT(short_run.furthest.excess, WithinRel(relative(furthest) / 1e-6, 1e-9));
    CHECK(result.furthest.reading.empty());
}

TEST_CASE("The errors of an image are those of its pixels", "[unit]") {
    const Result result = test::run(test::cornell_diffuse(24), Method::automatic, {48, 50000, 4});
    const Image& image = result.images.at(0);
    double luminances = 0.0, biases = 0.0;
    for (const Estimate& pixel : image.luminance) {
        luminances += square(pixel.mean());
        biases += square(pixel.bias()) - square(pixel.bias_standard_error());
    }
    REQUIRE(biases > 0.0);
    CHECK_THAT(image.relative_bias, WithinRel(std::sqrt(biases / luminances), 1e-9));
    double values = 0.0, noise = 0.0, left = 0.0, whole_noise = 0.0, least = 1.0, most = 0.0;
    for (std::size_t i = 0; i < image.luminance.size(); ++i) {
        const Estimate& pixel = image.luminance[i];
        const double share = image.corrected_share(i);
        const double of_bias = square(pixel.bias()) - square(pixel.bias_standard_error());
        values += square(pixel.mean() - share * pixel.bias());
        noise += square(pixel.standard_error(share));
        left += square(1.0 - share) * of_bias;
        whole_noise += square(pixel.standard_error(1.0));
        least = std::min(least, share);
        most = std::max(most, share);
        CHECK_THAT(image.pixel(i).value, WithinRel(pixel.mean() - share * pixel.bias(), 1e-12));
        // The bias that is left, and half of what is taken off.
        const double unknown = std::max(1.0 - share, 0.5) * std::sqrt(std::max(0.0, of_bias));
        CHECK_THAT(image.pixel(i).standard_error,
                   WithinRel(std::hypot(pixel.standard_error(share), unknown), 1e-9));
    }
    CHECK_THAT(image.delta, WithinRel(std::sqrt(noise / values), 1e-9));
    CHECK_THAT(image.delta_bias, WithinAbs(std::sqrt(std::max(0.0, left) / values), 1e-9));
    // Pixels differ in how much is taken off, and all of it everywhere would be noisier.
    CHECK(most - least > 0.2);
    CHECK(whole_noise > noise);
}

TEST_CASE("Uniformity and mean follow from all points together", "[analytic]") {
    const Result result = test::run(luminaire_over_row(), Method::combined, {60, 100});
    double mean = 0.0;
    for (const Vec3& x : row) mean += illuminance(x) / static_cast<double>(row.size());
    const double least = illuminance(row.back());
    const double greatest = illuminance(row.front());
    struct Row {
        const char* name;
        double truth, wrong;
    };
    for (const auto& [name, truth, wrong] :
         {Row{"mean", mean, greatest}, Row{"minimum", least, mean}, Row{"maximum", greatest, mean},
          Row{"uniformity U0", least / mean, least / greatest},
          Row{"diversity Ud", least / greatest, least / mean}}) {
        INFO(name);
        const Uncertain value = derived(result, name).result;
        CHECK(agrees(value, truth));
        CHECK_FALSE(agrees(value, wrong));
        CHECK(value.standard_error < 0.003 * truth);
        CHECK(value.candidates == 1.0);  // the points are far apart
    }
}

TEST_CASE("Points are rivals for the least by the noise that they do not share", "[analytic]") {
    // All points see the lamp by the same wavelengths, whose luck is most of the noise.
    const double far_m = 1.0;
    const auto candidates = [&](double apart_m) {
        SceneBuilder scene;
        scene.area_light(scene.object("lamp", Rectangle{corner, u, v}, scene.black()),
                         lamp_luminance);
        const std::vector<Vec3> points{{0, 0, 0}, {far_m, 0, 0}, {far_m + apart_m, 0, 0}};
        scene.points(points, Vec3::UnitZ());
        const Result result = test::run(scene, Method::combined, {60, 100});
        if (apart_m > 0.0) {
            const double own_noise = result.quantities[2].estimate.standard_error();
            // Or each alone would tell them apart.
            CHECK(illuminance(points[1]) - illuminance(points[2]) < 2.0 * own_noise);
        }
        return derived(result, "minimum").result.candidates;
    };
    CHECK(candidates(0.0005) == 1.0);
    CHECK(candidates(0.0) == 2.0);  // the twin: alike in truth
}

TEST_CASE("Readings are known without the luck of the wavelengths", "[analytic]") {
    const Result result = test::run(luminaire_over_row(), Method::combined, {32, 100});
    for (std::size_t i = 0; i < row.size(); ++i) {
        INFO("point " << i);
        const Uncertain reading = result.quantities[i].result();
        const Estimate& as_read = result.quantities[i].estimate;
        CHECK(agrees(reading, illuminance(row[i])));
        CHECK(reading.degrees_of_freedom == 30.0);  // the regression takes one
        CHECK(reading.standard_error < 0.1 * as_read.standard_error());
        CHECK(reading.standard_error < 1e-4 * illuminance(row[i]));
        // The twin: what was read is off by more than the reading's error.
        CHECK_FALSE(agrees({as_read.value(), reading.standard_error, reading.degrees_of_freedom},
                           illuminance(row[i])));
    }
}

TEST_CASE("U holds what single precision rounds", "[analytic]") {
    SceneBuilder scene;
    scene.light("lamp", PointLight{{0.3, 0.4, 1.2}}, 4.0 * pi * 100.0);
    scene.object("floor", Rectangle{{-1, -1, -1}, {2, 0, 0}, {0, 2, 0}}, scene.black());
    scene.points({Vec3::Zero()}, Vec3::UnitZ());
    const Uncertain reading = test::run(scene, Method::combined, {64, 100}).quantities[0].result();
    const double off = std::abs(reading.value - 100.0 * 1.2 / std::pow(1.3, 3));
    CAPTURE(reading.value, off, reading.standard_error);
    CHECK(off <= reading.expanded_uncertainty());
    CHECK(reading.expanded_uncertainty() < 2e-6 * reading.value);
    CHECK(off > 5.0 * reading.standard_error);  // the twin: noise alone
}

TEST_CASE("Light that does not follow the sum of all lights is not calibrated by it",
          "[statistical]") {
    // A wall parts two lamps of different colours. The luck of one tells nothing of the other.
    const auto band = [](double nm) {
        return spectral::Spectrum({nm - 50.0, nm, nm + 50.0}, {0.0, 1.0, 0.0},
                                  spectral::Outside::zero);
    };
    SceneBuilder scene;
    scene.object("wall", Rectangle{{0, -9, -9}, {0, 18, 0}, {0, 0, 18}}, scene.black());
    for (const double side : {-1.0, 1.0}) {
        scene.light("lamp", PointLight{{side, 0, 1}}, 4.0 * pi * 100.0);
        scene.parts.lights.back().flux_w_per_nm = scene.parts.add(
            spectral::scaled_to_luminous(band(550.0 + 60.0 * side), 4.0 * pi * 100.0));
    }
    scene.points({{-1, 0, 0}, {1, 0, 0}}, Vec3::UnitZ());
    std::array<Estimate, 2> values;
    double largest_ratio = 0.0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const Result result = test::run(scene, Method::combined, {24, 100}, seed);
        for (const std::size_t i : {0u, 1u}) {
            const Quantity& point = result.quantities[i];
            values[i].add(point.result().value);
            CHECK(agrees(point.result(), 100.0));
            largest_ratio = std::max(
                largest_ratio, point.result().standard_error / point.estimate.standard_error());
        }
    }
    CHECK(largest_ratio < 1.2);
    for (const Estimate& value : values) {
        test::check_mean(value.mean(), value.standard_error(), 100.0, {0.1});
    }
}

TEST_CASE("The colour of a reading is that of the light that arrives", "[analytic]") {
    // Light A on red paint: X, Y, Z of the product by sums at 1 nm.
    const spectral::Spectrum red({360.0, 560.0, 620.0, 830.0}, {0.05, 0.08, 0.75, 0.85},
                                 spectral::Outside::hold);
    const spectral::Spectrum a = *spectral::illuminant("A");
    std::vector<double> wavelengths_nm, products;
    for (int nm = 360; nm <= 830; ++nm) {
        wavelengths_nm.push_back(nm);
        products.push_back(a.at(nm) * red.at(nm));
    }
    const spectral::Xyz xyz = spectral::tristimulus(
        spectral::Spectrum(wavelengths_nm, products, spectral::Outside::zero));
    SceneBuilder scene;
    scene.light("lamp", PointLight{{0, 0, 1}}, 1000.0);
    scene.parts.lights.back().flux_w_per_nm =
        scene.parts.add(spectral::scaled_to_luminous(a, 1000.0));
    const BsdfId paint = scene.diffuse(0.0);
    std::get<Diffuse>(scene.parts.bsdfs[paint]).reflectance = scene.parts.add(red);
    scene.object("paper", Disk{Vec3::Zero(), Vec3::UnitZ(), 0.2}, paint);
    scene.meter({0.5, 0.0, 0.5}, Vec3::Zero(), 0.02);
    const Result result = test::run(scene, Method::combined, {400, 100});
    REQUIRE(result.quantities[0].colour);
    const Colour& colour = *result.quantities[0].colour;
    const auto truth = *spectral::chromaticity(xyz);
    CHECK(agrees(colour.x, truth.x));
    CHECK(agrees(colour.y, truth.y));
    CHECK(colour.x.standard_error < 1e-3);
    CHECK(colour.y.standard_error < 1e-3);
    // Twins: the lamp's own colour, and X and Z exchanged.
    const auto lamp = *spectral::chromaticity(spectral::tristimulus(a));
    CHECK_FALSE(agrees(colour.x, lamp.x));
    CHECK_FALSE(agrees(colour.x, xyz.z / (xyz.x + xyz.y + xyz.z)));
}

TEST_CASE("Caustic light beside a wall does not read low", "[analytic]") {
    // A point light before a mirror; the points stand close to a wall, with no light behind it.
    constexpr double rho = 0.9;
    constexpr double intensity = 100.0;
    const Vec3 lamp(0.8, 0, 1), image(1.2, 0, 1);
    SceneBuilder scene;
    scene.object("mirror", Rectangle{{1, -3, 0}, {0, 0, 4}, {0, 6, 0}}, scene.mirror(rho));
    scene.object("floor", Rectangle{{-1, -2, 0}, {2, 0, 0}, {0, 4, 0}}, scene.black());
    scene.object("wall", Rectangle{{-1, 0.5, 0}, {2, 0, 0}, {0, 0, 2}}, scene.black());
    scene.light("lamp", PointLight{lamp}, 4.0 * pi * intensity);
    const std::vector<Vec3> points{{0.2, 0.4, 0.0}, {0.4, 0.35, 0.0}};
    scene.points(points, Vec3::UnitZ());
    const Stage stage(scene.parts);
    const SensorPlanes planes(stage.parts(), stage.caster(), 0.5);
    const Result result = test::run(scene, Method::combined, {100, 20000});
    for (std::size_t i = 0; i < points.size(); ++i) {
        CHECK_THAT(planes.point(0, i).clearance_m, WithinRel(0.5 - points[i].y(), 2e-3));
        const auto from = [&](const Vec3& source) {
            return intensity * source.z() / std::pow((source - points[i]).norm(), 3);
        };
        const Estimate& estimate = result.quantities[i].estimate;
        INFO("point " << i);
        test::check_mean(estimate.value(), estimate.standard_error(),
                         from(lamp) + rho * from(image), {0.1});
        // Twin: a quarter of the kernel behind the wall.
        test::check_refutes(estimate, from(lamp) + 0.75 * rho * from(image));
    }
}

TEST_CASE("U of points beside a sharp shadow holds what the step of light leaves", "[analytic]") {
    constexpr truth::PaneShadow shadow{.intensity_cd = 100.0,
                                       .lamp_height_m = 1.0,
                                       .pane_thickness_m = 0.01,
                                       .pane_index = 1.5,
                                       .screen_height_m = 0.1,
                                       .screen_edge_m = 0.2};
    SceneBuilder scene = validation::pane_and_screen(shadow);
    std::vector<Vec3> positions;
    for (const double beside_m : {0.0001, 0.0003, 0.001}) {
        positions.emplace_back(shadow.shadow_edge_m() - beside_m, 0.0, 1e-4);
    }
    scene.points(positions, Vec3::UnitZ());
    // Noise and two kernels alone, 17 lx, would let the run stop.
    constexpr double asked_lx = 25.0;
    Settings settings;
    settings.method = Method::combined;
    settings.seed = 7;
    settings.max_phases = 64;
    settings.forward_rays = 20000;
    settings.sensor_targets = {{"points", 0.0, asked_lx}};
    const Result result = simulate(scene.parts, settings);
    CHECK_FALSE(result.accuracy_reached);
    bool by_step = false, missed_without = false;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Quantity& point = result.quantities[i];
        const double off = std::abs(point.result().value - shadow.illuminance_lx(positions[i].x()));
        CAPTURE(i, off, point.result().bias_left, point.estimate.expanded_uncertainty());
        CHECK(off <= point.result().expanded_uncertainty());
        by_step = by_step || point.result().bias_left > point.estimate.bias_left();
        missed_without = missed_without || off > point.estimate.expanded_uncertainty();
        CHECK(point.estimate.expanded_uncertainty() < asked_lx);
    }
    CHECK(by_step);
    CHECK(missed_without);  // the twin: noise and two kernels alone
    // So do numbers that follow from the points.
    const auto derived = [&](const char* what) -> const Uncertain& {
        return std::ranges::find_if(
                   result.derived,
                   [&](const DerivedQuantity& d) { return d.name.find(what) != std::string::npos; })
            ->result;
    };
    const Uncertain &least = derived("minimum"), &greatest = derived("maximum");
    double squares = 0.0;
    bool of_least = false;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const Uncertain point = result.quantities[i].result();
        squares += square(point.bias_left);
        of_least = of_least || (point.bias_left == least.bias_left &&
                                std::abs(point.value / least.value - 1.0) < 1e-9);
    }
    CHECK(of_least);
    const Uncertain &mean = derived("mean"), &uniformity = derived("U0"), &ratio = derived("Ud");
    CHECK_THAT(mean.bias_left, WithinRel(std::sqrt(squares) / 3.0, 1e-9));
    CHECK_THAT(
        uniformity.bias_left / uniformity.value,
        WithinRel(std::hypot(least.bias_left / least.value, mean.bias_left / mean.value), 1e-9));
    CHECK_THAT(
        ratio.bias_left / ratio.value,
        WithinRel(std::hypot(least.bias_left / least.value, greatest.bias_left / greatest.value),
                  1e-9));
}
