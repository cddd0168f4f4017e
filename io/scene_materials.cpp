#include "io/scene_materials.h"

#include <cmath>

#include "io/bsdf_file.h"
#include "io/scene_index.h"
#include "io/scene_spectra.h"

namespace lucerna::io {
namespace {

using namespace optics;
using spectral::Spectrum;

/// GGX alpha: nothing where the key is absent, and the surface is smooth.
std::optional<double> read_roughness(const YamlCursor& cursor) {
    const auto roughness = read_quantity(cursor, dimension::number, Accept::positive);
    if (roughness && roughness->value > 1.0) {
        cursor.complain("the GGX roughness alpha must be at most 1");
        return {};
    }
    return roughness ? std::optional(roughness->value) : std::nullopt;
}

}  // namespace

int read_priority(const YamlCursor& cursor) {
    return static_cast<int>(read_count(cursor, 0, 1000));
}

SceneMaterials::SceneMaterials(SceneContext& context, const YamlCursor& section)
    : context_(context) {
    if (!section) return;
    for (auto& [name, cursor] : YamlMap(section).entries()) {
        if (name == "none")
            cursor.complain("'none' is the name for surfaces that light passes unchanged");
        entries_[name].cursor = cursor;
    }
    for (auto& [name, entry] : entries_) read(name, entry);
}

void SceneMaterials::read(const std::string& name, Entry& entry) {
    if (entry.state != Entry::State::unread) return;
    entry.state = Entry::State::reading;
    entry.material = read_material(name, entry.cursor);
    entry.state = Entry::State::read;
}

const Material* SceneMaterials::find(const YamlCursor& cursor) {
    const auto name = cursor.word();
    if (!name) return nullptr;
    if (*name == "none") return &none_;
    const auto found = entries_.find(*name);
    if (found == entries_.end()) {
        std::vector<std::string> known{"none"};
        for (const auto& [key, entry] : entries_) known.push_back(key);
        cursor.complain(
            fmt::format("there is no material '{}'{}", *name, did_you_mean(*name, known)));
        return nullptr;
    }
    if (found->second.state == Entry::State::reading) {
        cursor.complain(fmt::format("the material '{}' is made of itself", *name));
        return nullptr;
    }
    read(*name, found->second);
    return found->second.material ? &*found->second.material : nullptr;
}

std::optional<SpectrumId> SceneMaterials::add(std::optional<Spectrum> spectrum) {
    if (!spectrum) return {};
    return context_.scene.parts.add(std::move(*spectrum));
}

std::optional<Material> SceneMaterials::read_material(const std::string& name,
                                                      const YamlCursor& cursor) {
    YamlMap map(cursor);
    const auto type = map.required("type", "the type of the material")
                          .choice({"diffuse", "mirror", "black", "dielectric", "conductor",
                                   "measured", "mixture", "two_sided"});
    if (!type) return {};
    std::optional<Material> material;
    if (*type == "dielectric") {
        material = read_dielectric(name, map);
    } else if (*type == "two_sided") {
        material = read_two_sided(name, map);
    } else {
        bool needs_up = false;
        if (auto bsdf = read_opaque(*type, map, needs_up)) {
            const BsdfId id = context_.scene.parts.add(std::move(*bsdf));
            material = Material{name, id, id, {}, needs_up};
        }
    }
    map.no_other_keys();
    return material;
}

std::optional<Bsdf> SceneMaterials::read_opaque(const std::string& type, YamlMap& map,
                                                bool& needs_up) {
    if (type == "black") return Black{};
    if (type == "diffuse") return read_diffuse(map);
    if (type == "conductor") return read_conductor(map);
    if (type == "mixture") return read_mixture(map, needs_up);
    if (type == "mirror") {
        const auto reflectance =
            add(read_spectrum(context_, map.required("reflectance", "a fraction or a spectrum"),
                              SpectrumOf::fraction));
        if (!reflectance) return {};
        return Mirror{*reflectance};
    }
    const YamlCursor file = map.required("file", "a file of measured scattering data");
    const auto path = context_.file(file);
    if (!path) return {};
    const auto data = context_.attempt(file, [&] { return read_bsdf_file(*path); });
    if (!data) return {};
    needs_up = true;
    return Measured{*data};
}

std::optional<Bsdf> SceneMaterials::read_diffuse(YamlMap& map) {
    const YamlCursor reflectance_cursor = map.required("reflectance", "a fraction or a spectrum");
    const auto reflectance = read_spectrum(context_, reflectance_cursor, SpectrumOf::fraction);
    const YamlCursor transmittance_cursor = map.optional("transmittance");
    const auto transmittance =
        transmittance_cursor ? read_spectrum(context_, transmittance_cursor, SpectrumOf::fraction)
                             : std::optional(Spectrum(0.0));
    if (!reflectance || !transmittance) return {};
    // 1e-12: 0.3 + 0.7 need not be 1 in binary.
    if (const double sum = max_of_sum(*reflectance, *transmittance); sum > 1.0 + 1e-12) {
        transmittance_cursor.complain(fmt::format(
            "reflectance and transmittance add up to {:.6g} at some wavelength, more than 1", sum));
        return {};
    }
    return Diffuse{*add(reflectance), *add(transmittance)};
}

std::optional<Bsdf> SceneMaterials::read_conductor(YamlMap& map) {
    std::optional<SpectrumId> n, k;
    const auto form = map.exactly_one({"index", "n"});
    if (form.key == "index") {
        const auto index = read_index_file(context_, form.value);
        if (index && !index->k)
            form.value.complain("the file holds no extinction coefficient k, which a metal needs");
        if (index && index->k) {
            n = add(index->n);
            k = add(index->k);
        }
    } else if (form.key == "n") {
        n = add(read_spectrum(context_, form.value, SpectrumOf::index));
        k = add(read_spectrum(context_, map.required("k", "the extinction coefficient"),
                              SpectrumOf::index));
    }
    const YamlCursor roughness_cursor = map.optional("roughness");
    const auto roughness = read_roughness(roughness_cursor);
    if (!n || !k) return {};
    if (roughness) return RoughConductor{*n, *k, *roughness};
    return SmoothConductor{*n, *k};
}

std::optional<Bsdf> SceneMaterials::read_mixture(YamlMap& map, bool& needs_up) {
    Mixture mixture;
    bool complete = true;
    double sum = 0.0;
    const YamlCursor components =
        map.required("components", "a list such as [{weight: 0.9, material: paint}, ...]");
    for (const YamlCursor& entry : components.list()) {
        YamlMap component(entry);
        const double weight = read_value(component.required("weight", "a fraction"),
                                         dimension::fraction, Accept::up_to_one);
        const YamlCursor name = component.required("material", "the name of a material");
        const Material* material = find(name);
        component.no_other_keys();
        sum += weight;
        complete = complete && material;
        if (!material) continue;
        if (material->medium || material->front != material->back ||
            material->front == pass_through) {
            name.complain(fmt::format(
                "'{}' cannot be part of a mixture: neither a dielectric, nor a two-sided material, "
                "nor none is one scattering surface",
                material->name));
            complete = false;
            continue;
        }
        needs_up = needs_up || material->needs_up;
        mixture.components.push_back({weight, material->front});
    }
    // 1e-12: 0.3 + 0.7 need not be 1 in binary.
    if (sum > 1.0 + 1e-12)
        components.complain(fmt::format("the weights add up to {:.6g}, more than 1", sum));
    if (components.is_sequence() && components.list().empty())
        components.complain("expected at least one component");
    if (!complete || mixture.components.empty()) return {};
    // In this order rays can follow scattering and specular events apart: see event_split().
    const std::vector<Bsdf>& bsdfs = context_.scene.parts.bsdfs;
    std::ranges::stable_partition(mixture.components, [&](const Mixture::Component& component) {
        return has_scattering_lobe(bsdfs[component.bsdf], bsdfs);
    });
    return mixture;
}

std::optional<Material> SceneMaterials::read_dielectric(const std::string& name, YamlMap& map) {
    const YamlCursor index_cursor = map.required(
        "index", "a number such as 1.49, a spectrum, or {file: ...} of refractiveindex.info");
    const auto index = read_index(context_, index_cursor);
    const auto absorption = read_absorption(
        context_,
        map.required("absorption",
                     "a coefficient such as \"0.3 1/m\", {transmittance: ..., thickness: ...}, a "
                     "spectrum in 1/m, or 'from index file'; write \"0 1/m\" for a clear medium"),
        index);
    const YamlCursor roughness_cursor = map.optional("roughness");
    const auto roughness = read_roughness(roughness_cursor);
    const YamlCursor priority = map.optional("priority");
    const int rank = priority ? read_priority(priority) : 0;
    if (!index || !absorption) return {};

    SceneParts& parts = context_.scene.parts;
    Medium medium{name, parts.add(index->n), parts.add(*absorption)};
    medium.dispersive = index->n.max() != index->n.min();
    medium.absorbing = absorption->max() > 0.0;
    medium.priority = rank;
    const BsdfId bsdf =
        parts.add(roughness ? Bsdf(RoughDielectric{*roughness}) : Bsdf(SmoothDielectric{}));
    return Material{name, bsdf, bsdf, parts.add(std::move(medium)), false};
}

std::optional<Material> SceneMaterials::read_two_sided(const std::string& name, YamlMap& map) {
    const auto side = [&](const std::string& key) -> const Material* {
        const YamlCursor cursor = map.required(key, "the name of a material");
        const Material* material = find(cursor);
        if (!material) return nullptr;
        if (!material->medium && material->front == material->back &&
            material->front != pass_through)
            return material;
        cursor.complain(fmt::format(
            "'{}' cannot be one side of a surface: neither a dielectric, nor a two-sided material, "
            "nor none is one scattering surface",
            material->name));
        return nullptr;
    };
    const Material* front = side("front");
    const Material* back = side("back");
    if (!front || !back) return {};
    return Material{name, front->front, back->front, {}, front->needs_up || back->needs_up};
}

}  // namespace lucerna::io
