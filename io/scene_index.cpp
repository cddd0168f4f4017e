#include "io/scene_index.h"

#include <cmath>

#include "io/refractive_index.h"
#include "io/scene_spectra.h"

namespace lucerna::io {
namespace {

using spectral::Spectrum;

/// The spectrum with `change` applied at its nodes.
template <typename Change>
Spectrum changed(const Spectrum& spectrum, const Change& change) {
    if (spectrum.is_constant()) return Spectrum(change(0.0, spectrum.at(0.0)));
    std::vector<double> values;
    for (std::size_t i = 0; i < spectrum.values().size(); ++i)
        values.push_back(change(spectrum.wavelengths_nm()[i], spectrum.values()[i]));
    return Spectrum(spectrum.wavelengths_nm(), std::move(values), spectrum.outside());
}

/// alpha = 4 pi k / lambda (Born and Wolf, Principles of Optics, 7th ed., 14.1, eq. 18).
Spectrum absorption_of(const Spectrum& k) {
    return changed(k, [](double wavelength_nm, double value) {
        return 4.0 * pi * value / (wavelength_nm * 1e-9);
    });
}

/// Beer and Lambert: alpha = -ln(T) / d.
std::optional<Spectrum> read_internal_transmittance(SceneContext& context,
                                                    const YamlCursor& cursor) {
    YamlMap map(cursor);
    const YamlCursor transmittance_cursor =
        map.required("transmittance", "a fraction or a spectrum");
    const auto transmittance = read_spectrum(context, transmittance_cursor, SpectrumOf::fraction);
    const double thickness_m = read_value(map.required("thickness", "a length such as 100 mm"),
                                          dimension::length, Accept::positive);
    map.no_other_keys();
    if (!transmittance || !std::isfinite(thickness_m)) return {};
    if (transmittance->min() <= 0.0) {
        transmittance_cursor.complain(
            "is zero at some wavelength, which no absorption coefficient can give");
        return {};
    }
    return changed(*transmittance, [&](double, double value) {
        return value < 1.0 ? -std::log(value) / thickness_m : 0.0;
    });
}

}  // namespace

std::optional<ComplexIndex> read_index_file(SceneContext& context, const YamlCursor& cursor) {
    if (!cursor) return {};
    YamlMap map(cursor);
    const YamlCursor file = map.required("file", "a file of the refractiveindex.info database");
    map.no_other_keys();
    const auto path = context.file(file);
    if (!path) return {};
    const auto index = context.attempt(file, [&] { return read_refractive_index(*path); });
    if (!index) return {};
    for (const std::string& warning : index->warnings) context.warn(file, warning);
    return ComplexIndex{index->n, index->k};
}

std::optional<ComplexIndex> read_index(SceneContext& context, const YamlCursor& cursor) {
    const bool is_file =
        cursor.is_map() && YamlMap(cursor).has("file") && !YamlMap(cursor).has("column");
    auto index = is_file ? read_index_file(context, cursor) : [&]() -> std::optional<ComplexIndex> {
        const auto n = read_spectrum(context, cursor, SpectrumOf::index);
        if (!n) return {};
        return ComplexIndex{*n, {}};
    }();
    if (index && index->n.min() < 1.0)
        cursor.complain(fmt::format("an index of refraction of {:.6g} is below 1", index->n.min()));
    return index;
}

std::optional<Spectrum> read_absorption(SceneContext& context, const YamlCursor& cursor,
                                        const std::optional<ComplexIndex>& index) {
    if (!cursor) return {};
    if (cursor.is_map() &&
        (YamlMap(cursor).has("transmittance") || YamlMap(cursor).has("thickness")))
        return read_internal_transmittance(context, cursor);
    if (!cursor.is_scalar() || cursor.word() != "from index file")
        return read_spectrum(context, cursor, SpectrumOf::absorption);
    if (!index) return {};
    if (index->k) return absorption_of(*index->k);
    cursor.complain(
        "the index holds no extinction coefficient k; state the absorption, such as \"0.3 1/m\"");
    return {};
}

}  // namespace lucerna::io
