#include "io/report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "io/setting_names.h"

namespace lucerna::io {
namespace {

using Json = nlohmann::ordered_json;

// Turns numbers into JSON and remembers those that JSON cannot hold.
class Numbers {
public:
    Json operator()(double value, const std::string& name) {
        if (std::isfinite(value)) return value;
        not_finite_.push_back(name);
        return nullptr;
    }

    /// One warning for all of them: the first few by name.
    std::optional<std::string> warning() const {
        if (not_finite_.empty()) return std::nullopt;
        constexpr std::size_t named = 5;
        const std::vector<std::string> first(
            not_finite_.begin(),
            not_finite_.begin() + static_cast<std::ptrdiff_t>(std::min(named, not_finite_.size())));
        std::string text =
            fmt::format("not finite and written as null: {}", fmt::join(first, ", "));
        if (not_finite_.size() > named)
            text += fmt::format(" and {} more", not_finite_.size() - named);
        return text;
    }

private:
    std::vector<std::string> not_finite_;
};

// The parts of an uncertain number, as keys of a JSON object.
void add_uncertain(Json& json, const Uncertain& result, const std::string& name, Numbers& number) {
    json["value"] = number(result.value, name + " value");
    json["standard_error"] = number(result.standard_error, name + " standard_error");
    json["degrees_of_freedom"] = result.degrees_of_freedom;
    json["expanded_uncertainty"] =
        number(result.expanded_uncertainty(report_coverage), name + " expanded_uncertainty");
    json["coverage"] = report_coverage;
}

// What uncertain inputs add to a number, if there are any.
void add_inputs(Json& json, const optics::InputChanges& inputs,
                const std::vector<std::string>& names, double expanded_uncertainty,
                const std::string& name, Numbers& number) {
    if (names.empty()) return;
    const double of_inputs = inputs.expanded_uncertainty();
    json["input_uncertainty"] = number(of_inputs, name + " input_uncertainty");
    json["combined_uncertainty"] =
        number(std::hypot(expanded_uncertainty, of_inputs), name + " combined_uncertainty");
    json["input_changes"] = Json::array();
    for (std::size_t i = 0; i < names.size(); ++i) {
        json["input_changes"].push_back(
            {{"input", names[i]}, {"change", number(inputs.changes[i], name + " change")}});
    }
}

Json image_json(const optics::Image& image, Numbers& number) {
    const Uncertain mean = image.mean.corrected();
    return {{"name", image.name},
            {"width", image.width},
            {"height", image.height},
            {"delta", number(image.delta, image.name + " delta")},
            {"delta_bias", number(image.delta_bias, image.name + " delta_bias")},
            {"relative_bias", image.relative_bias},
            {"mean_luminance", number(mean.value, image.name + " mean_luminance")},
            {"mean_luminance_expanded_uncertainty",
             number(mean.expanded_uncertainty(report_coverage),
                    image.name + " mean_luminance_expanded_uncertainty")}};
}

Json quantity_json(const optics::Quantity& quantity, const std::vector<std::string>& inputs,
                   Numbers& number) {
    const Estimate& estimate = quantity.estimate;
    Json json = {{"name", quantity.name}, {"quantity", quantity.quantity}, {"unit", quantity.unit}};
    add_uncertain(json, quantity.result(), quantity.name, number);
    add_inputs(json, quantity.inputs, inputs,
               quantity.result().expanded_uncertainty(report_coverage), quantity.name, number);
    json["bias"] = number(estimate.bias(), quantity.name + " bias");
    json["bias_standard_error"] =
        number(estimate.bias_standard_error(), quantity.name + " bias_standard_error");
    json["bias_left"] = quantity.result().bias_left;
    json["uncorrected"] = {
        {"value", estimate.mean()},
        {"standard_error",
         number(estimate.mean_standard_error(), quantity.name + " uncorrected standard_error")}};
    json["phases"] = estimate.count();
    if (!quantity.colour) return json;
    const optics::Colour& colour = *quantity.colour;
    const auto add = [&](const char* key, const Uncertain& result) {
        json[key] = number(result.value, quantity.name + " " + key);
        json[std::string(key) + "_expanded_uncertainty"] =
            number(result.expanded_uncertainty(report_coverage),
                   quantity.name + " " + key + " expanded_uncertainty");
    };
    add("x", colour.x);
    add("y", colour.y);
    if (colour.cct_k) add("correlated_colour_temperature_k", *colour.cct_k);
    if (colour.duv) add("duv", *colour.duv);
    return json;
}

Json derived_json(const optics::DerivedQuantity& derived, const std::vector<std::string>& inputs,
                  Numbers& number) {
    Json json = {{"name", derived.name}, {"quantity", derived.quantity}, {"unit", derived.unit}};
    add_uncertain(json, derived.result, derived.name, number);
    add_inputs(json, derived.inputs, inputs, derived.result.expanded_uncertainty(report_coverage),
               derived.name, number);
    return json;
}

Json flux_json(const optics::FluxBalance& flux, Numbers& number) {
    Json absorbed = Json::object();
    for (const auto& [material, flux_lm] : flux.absorbed) {
        absorbed[material] = number(flux_lm, "flux absorbed by " + material);
    }
    return {{"emitted", number(flux.emitted, "flux emitted")},
            {"absorbed", absorbed},
            {"escaped", number(flux.escaped, "flux escaped")},
            {"trapped", number(flux.trapped, "flux trapped")},
            {"inconsistent_medium", number(flux.inconsistent_medium, "flux inconsistent_medium")},
            {"numerical", number(flux.numerical, "flux numerical")},
            {"roulette_residue", number(flux.roulette_residue, "flux roulette_residue")},
            {"closure", number(flux.closure(), "flux closure")}};
}

Json rays_json(const optics::RayCounts& rays, Numbers& number) {
    return {{"backward_rays", rays.backward_rays},
            {"caustic_rays", rays.caustic_rays},
            {"secondary_rays", rays.secondary_rays},
            {"backward_segments", rays.backward_segments},
            {"forward_segments", rays.forward_segments},
            {"shadow_segments", rays.shadow_segments},
            {"forward_photons", rays.forward_photons},
            {"backward_photons", rays.backward_photons},
            {"scattering_hits", rays.scattering_hits},
            {"deposits", rays.deposits},
            {"setup_s", number(rays.setup_s, "rays setup_s")},
            {"pilot_s", number(rays.pilot_s, "rays pilot_s")},
            {"caustic_s", number(rays.caustic_s, "rays caustic_s")},
            {"maps_s", number(rays.maps_s, "rays maps_s")},
            {"backward_s", number(rays.backward_s, "rays backward_s")},
            {"secondary_s", number(rays.secondary_s, "rays secondary_s")},
            {"readings_s", number(rays.readings_s, "rays readings_s")}};
}

}  // namespace

std::string report_json(const optics::Result& result, const ReportSource& source) {
    Numbers number;
    const int threads = result.settings.threads > 0 ? result.settings.threads : hardware_threads();
    Json json = {{"program", "lucerna"},
                 {"version", LUCERNA_VERSION},
                 {"scene", source.scene},
                 {"scene_hash", source.scene_hash},
                 {"seed", result.settings.seed},
                 {"seeds", result.seeds},
                 {"method", name_of(result.settings.method)},
                 {"scheduler", name_of(result.settings.scheduler)},
                 {"polarisation", result.settings.polarisation.value_or(false)},
                 {"threads", threads},
                 {"phases", result.phases},
                 {"wall_s", number(result.wall_s, "wall_s")},
                 {"stopped_by", result.stopped_by},
                 {"accuracy_reached", result.accuracy_reached}};
    if (!result.accuracy_reached) {
        json["furthest"] = {{"reading", result.furthest.reading},
                            {"excess", number(result.furthest.excess, "furthest excess")}};
    }
    json["uncertain_inputs"] = result.uncertain_inputs;
    // The image that decides when to stop is the worst of all cameras.
    const auto worst =
        std::max_element(result.images.begin(), result.images.end(),
                         [](const auto& a, const auto& b) { return a.delta < b.delta; });
    json["image"] = worst == result.images.end() ? Json(nullptr) : image_json(*worst, number);
    json["images"] = Json::array();
    for (const auto& image : result.images) json["images"].push_back(image_json(image, number));
    json["quantities"] = Json::array();
    for (const auto& quantity : result.quantities) {
        json["quantities"].push_back(quantity_json(quantity, result.uncertain_inputs, number));
    }
    json["derived_quantities"] = Json::array();
    for (const auto& derived : result.derived) {
        json["derived_quantities"].push_back(
            derived_json(derived, result.uncertain_inputs, number));
    }
    json["flux_balance_lm"] = flux_json(result.flux_balance_lm, number);
    json["rays"] = rays_json(result.rays, number);
    json["memory"] = {{"forward_map_bytes", result.forward_map_bytes},
                      {"backward_map_bytes", result.backward_map_bytes},
                      {"image_bytes", result.image_bytes}};
    json["warnings"] = result.warnings;
    if (const auto warning = number.warning()) json["warnings"].push_back(*warning);
    // Text that is not UTF-8 (a file name can be anything) must not cost the report.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lucerna::io
