// Rods as light guides: where the light of a Lambertian disk goes.
#include <fmt/format.h>

#include "validation/cases.h"
#include "validation/scene_builder.h"
#include "validation/truth/rod_guide.h"

namespace lucerna::validation {
namespace {

using namespace optics;
using truth::RodGuide;

// Between the glass and the virtual sheets around it; grazing light that passes through the gap is
// less than 2 * gap / radius of the flux that leaves.
constexpr double sheet_gap_m = 1e-7;

// What the glass absorbs. Its error follows from those of the receivers, which count the rest: the
// flux balance closes, so it is at most their sum.
Read absorbed_in_glass(std::vector<std::size_t> rest) {
    return [rest](const Result& result) {
        Reading reading = sensor(rest.front())(result);
        reading.standard_error = 0.0;
        reading.expanded_uncertainty = 0.0;
        for (const std::size_t i : rest) {
            const Reading part = sensor(i)(result);
            reading.standard_error += part.standard_error;
            reading.expanded_uncertainty += part.expanded_uncertainty;
        }
        reading.uncorrected_standard_error = reading.standard_error;
        reading.value = result.flux_balance_lm.absorbed.at("inside medium");
        reading.uncorrected_value = reading.value;
        return reading;
    };
}

Case rod_case(const std::string& id, const RodGuide& rod, const optics::Settings& settings) {
    const bool contact = rod.gap_m == 0.0;
    SceneBuilder scene;
    const double start_m = contact ? -0.001 : 0.0;  // glass behind the disk, where no light comes
    scene.solid("rod", Cylinder{{0, 0, start_m}, {0, 0, rod.length_m}, rod.radius_m},
                scene.medium(rod.index, rod.absorption_per_m));
    const ObjectId lamp = scene.object(
        "lamp", Disk{{0, 0, -rod.gap_m}, Vec3::UnitZ(), rod.source_radius_m}, scene.black());
    scene.light("lamp", AreaLight{lamp, scene.parts.objects[lamp].shape}, lamp_flux_lm);
    const auto sheet = [&](const std::string& name, const Shape& shape) {
        const ObjectId object = scene.object(name, shape, pass_through);
        scene.receiver(object);
    };
    sheet("far end", Disk{{0, 0, rod.length_m + sheet_gap_m}, -Vec3::UnitZ(), rod.radius_m});
    // The front of its inner side faces the rod; its end is too thin to catch light from the lamp.
    sheet("sides", Tube{{0, 0, 0},
                        {0, 0, rod.length_m},
                        rod.radius_m + 2.0 * sheet_gap_m,
                        rod.radius_m + sheet_gap_m});
    if (contact) {
        scene.receiver(lamp);
    } else {
        sheet("near end", Disk{{0, 0, -sheet_gap_m}, Vec3::UnitZ(), rod.radius_m});
    }

    const truth::RodFlux shares = truth::rod_flux(rod);
    const double truth_error =
        lamp_flux_lm * (2e-5 + 2.0 * sheet_gap_m / rod.radius_m);  // quadrature, sheets
    Case result{
        .id = id,
        .title =
            fmt::format("rod of {:g} mm x {:g} mm, n = {:g}, absorption {:g} /m, {}",
                        2e3 * rod.radius_m, 1e3 * rod.length_m, rod.index, rod.absorption_per_m,
                        contact ? std::string("source in contact")
                                : fmt::format("source {:g} mm before the end", 1e3 * rod.gap_m)),
        .source =
            "quadrature over the disk and directions, each reflection followed with its state "
            "of polarisation (Born and Wolf, 7th ed., 1.5.2 and 1.5.4)",
        .scene = {},
        .settings = settings,
        .checks = {}};
    const auto check = [&](const std::string& name, double share, Read read) {
        result.checks.push_back({name, "luminous flux", "lm", lamp_flux_lm * share, truth_error,
                                 std::move(read), 0.02});
    };
    check("out of the far end", shares.far, sensor(0));
    if (shares.sides > 1e-3) check("out of the sides", shares.sides, sensor(2));
    check(contact ? "back to the disk" : "from the near end", shares.near, sensor(4));
    if (!contact) check("onto the near end", shares.onto_near, sensor(5));
    if (rod.absorption_per_m > 0.0) {
        check("absorbed", shares.absorbed, absorbed_in_glass({0, 2, 4}));
        result.checks.back().detects_relative = 0.05;  // the errors of three receivers together
    }
    result.scene = std::move(scene.parts);
    return result;
}

}  // namespace

std::vector<Case> rod_guide_cases() {
    return {
        rod_case("rod_guide/air-clear", {0.01, 0.12, 1.5, 0.0, 0.002, 0.009}, effort(96, 8000)),
        rod_case("rod_guide/air-absorbing", {0.01, 0.3, 1.6, 2.0, 0.004, 0.006}, effort(96, 8000)),
        rod_case("rod_guide/air-leaking", {0.01, 0.1, 1.3, 1.0, 0.004, 0.007}, effort(128, 8000)),
        rod_case("rod_guide/contact-clear", {0.01, 0.1, 1.5, 0.0, 0.0, 0.01}, effort(96, 8000)),
        rod_case("rod_guide/contact-absorbing", {0.008, 0.2, 1.6, 3.0, 0.0, 0.008},
                 effort(96, 8000)),
    };
}

Case drawn_rod_guide(const std::string& id, Draw& draw) {
    const double radius_m = draw.log_between(0.003, 0.02);
    const double gap_m = draw.happens(0.6) ? draw.between(0.1, 0.6) * radius_m : 0.0;
    const RodGuide rod{
        .radius_m = radius_m,
        .length_m = draw.log_between(4.0, 40.0) * radius_m,
        .index = draw.between(1.25, 1.75),
        .absorption_per_m = draw.happens(0.5) ? draw.log_between(0.3, 5.0) : 0.0,
        .gap_m = gap_m,
        .source_radius_m = gap_m > 0.0 ? draw.between(0.3, 0.95) * radius_m : radius_m};
    return rod_case(id, rod, {});
}

}  // namespace lucerna::validation
