#include <fmt/format.h>

#include <map>

#include "io/scene_file.h"

namespace lucerna::io {
namespace {

using namespace optics;

std::size_t triangle_count(const SceneParts& parts) {
    std::size_t count = 0;
    for (const Object& object : parts.objects)
        if (const auto* mesh = std::get_if<MeshInstance>(&object.shape))
            count += mesh->mesh->triangles.size();
    return count;
}

std::string range(const spectral::Spectrum& spectrum) {
    return spectrum.min() == spectrum.max()
               ? fmt::format("{:.6g}", spectrum.min())
               : fmt::format("{:.6g} to {:.6g}", spectrum.min(), spectrum.max());
}

std::string described(const LightSource& source) {
    struct Describe {
        std::string operator()(const AreaLight& light) const { return light.sky ? "sky" : "area"; }
        std::string operator()(const PointLight&) const { return "point"; }
        std::string operator()(const BeamLight&) const { return "beam"; }
        std::string operator()(const Luminaire&) const { return "luminaire"; }
    };
    return std::visit(Describe{}, source);
}

std::string described(const Observer& observer) {
    struct Describe {
        std::string operator()(const Camera& c) const {
            return fmt::format("camera '{}', {} x {} pixels", c.name, c.width, c.height);
        }
        std::string operator()(const IlluminancePoints& p) const {
            if (p.columns > 0)
                return fmt::format("illuminance grid '{}', {} x {} points", p.name, p.columns,
                                   p.rows);
            return fmt::format("illuminance '{}', {} point{}", p.name, p.positions.size(),
                               p.positions.size() == 1 ? "" : "s");
        }
        std::string operator()(const LuminanceMeter& m) const {
            return fmt::format("luminance meter '{}', {:.4g} deg", m.name,
                               2.0 * m.acceptance_half_angle_rad * 180.0 / pi);
        }
    };
    return std::visit(Describe{}, observer);
}

}  // namespace

std::string scene_summary(const SceneFile& scene) {
    const SceneParts& parts = scene.parts;
    std::string text;
    const auto line = [&](const std::string& entry) { text += entry + '\n'; };

    line(fmt::format("files      {}", scene.files.size()));
    for (const auto& file : scene.files) line("  " + file.string());
    line(fmt::format("objects    {}, with {} triangles in meshes", parts.objects.size(),
                     triangle_count(parts)));
    line(fmt::format("media      {}", parts.media.size()));
    for (const Medium& medium : parts.media)
        line(fmt::format("  {}: index {}{}, absorption {} 1/m, priority {}", medium.name,
                         range(parts.spectra[medium.index]),
                         medium.dispersive ? " (dispersive)" : "",
                         range(parts.spectra[medium.absorption_per_m]), medium.priority));
    double total_lm = 0.0;
    for (const Light& light : parts.lights) total_lm += light.luminous_flux_lm;
    line(fmt::format("lights     {}, {:.6g} lm together", parts.lights.size(), total_lm));
    for (const Light& light : parts.lights)
        line(fmt::format("  {} ({}): {:.6g} lm", light.name, described(light.source),
                         light.luminous_flux_lm));
    line(fmt::format("observers  {}", parts.observers.size()));
    for (const Observer& observer : parts.observers) line("  " + described(observer));
    line(fmt::format("receivers  {}", parts.receivers.size()));
    for (const FluxReceiver& receiver : parts.receivers)
        line(
            fmt::format("  flux '{}' on '{}'", receiver.name, parts.objects[receiver.object].name));
    if (!scene.uncertain_inputs.empty())
        line(fmt::format("uncertain  {}", scene.uncertain_inputs.size()));
    for (const UncertainInput& input : scene.uncertain_inputs) line("  " + text_of(input));
    line(fmt::format("warnings   {}", scene.warnings.size()));
    for (const std::string& warning : scene.warnings) line("  " + warning);
    return text;
}

}  // namespace lucerna::io
