#include "io/summary.h"

#include <algorithm>
#include <cmath>

#include "io/measured_value.h"
#include "io/report.h"
#include "io/text_table.h"

namespace lucerna::io {
namespace {

std::string images_text(const optics::Result& result) {
    std::string text;
    for (const auto& image : result.images) {
        text += fmt::format(
            "Image {}: {} x {} pixels, noise δ = {:.2g} %, kernel bias {:.2g} %, mean {} cd/m2\n",
            image.name, image.width, image.height, 100.0 * image.delta, 100.0 * image.delta_bias,
            measured_value(image.mean.value(), image.mean.expanded_uncertainty(report_coverage)));
    }
    return text;
}

// "x 0.3127 ± 0.0004  y 0.3290 ± 0.0004  6504 ± 12 K" where the quantity has a colour.
std::string colour_text(const optics::Quantity& quantity) {
    if (!quantity.colour) return "";
    const auto text_of = [](const Uncertain& result) {
        return measured_value(result.value, result.expanded_uncertainty(report_coverage));
    };
    std::string text =
        fmt::format("x {}  y {}", text_of(quantity.colour->x), text_of(quantity.colour->y));
    if (quantity.colour->cct_k) text += fmt::format("  {} K", text_of(*quantity.colour->cct_k));
    return text;
}

std::string quantities_text(const optics::Result& result) {
    if (result.quantities.empty()) return "";
    constexpr std::size_t shown = 40;  // a grid can have thousands; the report has them all
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < std::min(shown, result.quantities.size()); ++i) {
        const optics::Quantity& quantity = result.quantities[i];
        const Uncertain value = quantity.result();
        rows.push_back({quantity.name, quantity.quantity,
                        measured_value(value.value, value.expanded_uncertainty(report_coverage)) +
                            " " + quantity.unit,
                        colour_text(quantity)});
    }
    std::string text =
        fmt::format("\nQuantities, value ± U ({:.0f} %)\n", 100.0 * report_coverage) +
        text_table(rows);
    if (result.quantities.size() > shown) {
        text += fmt::format("  and {} more in the report\n", result.quantities.size() - shown);
    }
    rows.clear();
    for (const optics::DerivedQuantity& derived : result.derived) {
        const Uncertain& value = derived.result;
        rows.push_back({derived.name,
                        measured_value(value.value, value.expanded_uncertainty(report_coverage)) +
                            (derived.unit == "1" ? "" : " " + derived.unit)});
    }
    if (!rows.empty()) text += "\n" + text_table(rows);
    return text;
}

// What uncertain inputs do to each quantity: the table of an error budget.
std::string inputs_text(const optics::Result& result) {
    if (result.uncertain_inputs.empty()) return "";
    std::string text = fmt::format(
        "\nUncertain inputs, and the change of a quantity when one of them is shifted by its "
        "uncertainty ({:.0f} %)\n",
        100.0 * report_coverage);
    std::vector<std::string> heads{""};
    for (std::size_t i = 0; i < result.uncertain_inputs.size(); ++i) {
        text += fmt::format("  ({}) {}\n", i + 1, result.uncertain_inputs[i]);
        heads.push_back(fmt::format("({})", i + 1));
    }
    heads.insert(heads.end(), {"inputs", "simulation", "combined"});
    std::vector<std::vector<std::string>> rows{heads};
    const auto add = [&](const std::string& name, const optics::InputChanges& inputs,
                         const Uncertain& value) {
        const auto percent = [&](double part) {
            return value.value == 0.0 ? "-" : fmt::format("{:.2g} %", 100.0 * part / value.value);
        };
        std::vector<std::string> row{name};
        for (const double change : inputs.changes) row.push_back(percent(change));
        const double of_inputs = inputs.expanded_uncertainty();
        const double of_simulation = value.expanded_uncertainty(report_coverage);
        row.push_back(percent(of_inputs));
        row.push_back(percent(of_simulation));
        row.push_back(percent(std::hypot(of_inputs, of_simulation)));
        rows.push_back(row);
    };
    constexpr std::size_t shown = 40;
    for (std::size_t i = 0; i < std::min(shown, result.quantities.size()); ++i) {
        const optics::Quantity& quantity = result.quantities[i];
        add(quantity.name, quantity.inputs, quantity.result());
    }
    for (const auto& derived : result.derived) add(derived.name, derived.inputs, derived.result);
    return text + text_table(rows);
}

std::string flux_text(const optics::FluxBalance& flux) {
    if (!(flux.emitted > 0.0)) return "";
    std::vector<std::vector<std::string>> rows;
    const auto add = [&](const std::string& name, double flux_lm) {
        rows.push_back({name, fmt::format("{:.6g} lm", flux_lm),
                        fmt::format("{:.3f} %", 100.0 * flux_lm / flux.emitted)});
    };
    for (const auto& [material, flux_lm] : flux.absorbed) add("absorbed by " + material, flux_lm);
    const auto add_unless_zero = [&](const char* name, double flux_lm) {
        if (flux_lm != 0.0) add(name, flux_lm);
    };
    add_unless_zero("left the scene", flux.escaped);
    add_unless_zero("trapped in lossless solids", flux.trapped);
    add_unless_zero("lost to contradictions of solids", flux.inconsistent_medium);
    add_unless_zero("lost to undefined numbers", flux.numerical);
    add_unless_zero("residue of roulette (zero on average)", flux.roulette_residue);
    const double closure_lm = flux.closure();
    if (std::abs(closure_lm) > 1e-6 * flux.emitted) add("not accounted for", closure_lm);
    add("emitted", flux.emitted);
    return "\nFlux balance of the forward rays\n" + text_table(rows);
}

std::string missed_text(const optics::Result& result) {
    if (result.accuracy_reached) return "";
    const optics::Furthest& furthest = result.furthest;
    std::string text = ", before the accuracy asked for was reached";
    if (std::isfinite(furthest.excess) && furthest.excess > 1.0) {
        text += fmt::format(": {} is {:.2g} times as much",
                            furthest.reading.empty() ? "noise δ" : "U of " + furthest.reading,
                            furthest.excess);
    } else if (std::isinf(furthest.excess) && !furthest.reading.empty()) {
        text += fmt::format(": nothing is known of {} yet", furthest.reading);
    }
    return text;
}

std::string work_text(const optics::Result& result) {
    const optics::RayCounts& rays = result.rays;
    return fmt::format("\nPhases {} in {:.1f} s, stopped by: {}{}\n", result.phases, result.wall_s,
                       result.stopped_by, missed_text(result)) +
           fmt::format("Paths from observers {}, from lights {} caustic and {} secondary\n",
                       rays.backward_rays, rays.caustic_rays, rays.secondary_rays) +
           fmt::format("Memory of a phase: forward map {}, backward map {}, images {}\n",
                       byte_size(static_cast<double>(result.forward_map_bytes)),
                       byte_size(static_cast<double>(result.backward_map_bytes)),
                       byte_size(static_cast<double>(result.image_bytes)));
}

}  // namespace

std::string summary(const optics::Result& result, const std::vector<WrittenFile>& files) {
    std::string text = images_text(result) + quantities_text(result) + inputs_text(result) +
                       flux_text(result.flux_balance_lm) + work_text(result);
    for (const auto& warning : result.warnings) text += "Warning: " + warning + "\n";
    if (!files.empty()) {
        text += "\nWritten\n";
        for (const auto& file : files)
            text += fmt::format("  {}  {}\n", file.path.string(), file.description);
    }
    return text;
}

}  // namespace lucerna::io
