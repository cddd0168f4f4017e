#include "io/scene_spectra.h"

#include <algorithm>
#include <cmath>

#include "io/spectrum_csv.h"
#include "spectral/illuminants.h"
#include "spectral/photometry.h"

namespace lucerna::io {
namespace {

using spectral::Outside;
using spectral::Spectrum;

/// The range that CIE 15:2018 asks measurements to cover at least.
constexpr double visible_from_nm = 380.0, visible_to_nm = 780.0;

const Dimension& dimension_of(SpectrumOf quantity) {
    switch (quantity) {
        case SpectrumOf::fraction:
            return dimension::fraction;
        case SpectrumOf::absorption:
            return dimension::absorption;
        case SpectrumOf::index:
        case SpectrumOf::emission:
            return dimension::number;
    }
    return dimension::number;
}

Accept accepted(SpectrumOf quantity) {
    return quantity == SpectrumOf::fraction ? Accept::up_to_one : Accept::not_negative;
}

/// Checks what a file says; numbers in the scene file itself are checked where they stand.
bool in_range(const YamlCursor& cursor, const Spectrum& spectrum, SpectrumOf quantity) {
    const auto [least, most] =
        std::minmax_element(spectrum.values().begin(), spectrum.values().end());
    if (*least < 0.0)
        cursor.complain(fmt::format("holds the negative value {}", *least));
    else if (quantity == SpectrumOf::fraction && *most > 1.0)
        cursor.complain(fmt::format("holds the value {}, which is more than 1", *most));
    else
        return true;
    return false;
}

std::optional<Spectrum> read_points(SceneContext& context, const YamlCursor& cursor,
                                    SpectrumOf quantity, Outside outside) {
    const std::size_t complaints = context.diagnostics.list().size();
    std::vector<double> wavelengths_nm, values;
    for (const YamlCursor& point : cursor.list()) {
        const auto pair = point.list();
        if (pair.size() != 2) {
            if (point.is_sequence())
                point.complain("expected a wavelength and a value such as [400 nm, 0.1]");
            continue;
        }
        const double wavelength_nm = read_value(pair[0], dimension::wavelength, Accept::positive);
        if (!wavelengths_nm.empty() && wavelength_nm <= wavelengths_nm.back())
            pair[0].complain("wavelengths must increase");
        wavelengths_nm.push_back(wavelength_nm);
        values.push_back(read_value(pair[1], dimension_of(quantity), accepted(quantity)));
    }
    if (context.diagnostics.list().size() != complaints) return {};
    if (values.size() < 2) {
        cursor.complain("expected at least two points such as [[400 nm, 0.1], [700 nm, 0.5]]");
        return {};
    }
    return Spectrum(std::move(wavelengths_nm), std::move(values), outside);
}

std::optional<Spectrum> read_illuminant(const YamlCursor& cursor) {
    const auto name = cursor.word();
    if (!name) return {};
    if (const auto found = spectral::illuminant(*name)) return found;
    cursor.complain(fmt::format(
        "'{}' is not an illuminant that is known; expected a name such as D65, A, E or LED-B3, or "
        "{{planck: 2856 K}}, {{daylight: 6500 K}}, {{file: ..., column: ...}} or {{points: ...}}{}",
        *name, did_you_mean(*name, spectral::illuminant_names())));
    return {};
}

std::optional<Spectrum> read_tabulated(SceneContext& context, const YamlCursor& cursor,
                                       SpectrumOf quantity) {
    const bool emission = quantity == SpectrumOf::emission;
    const Outside outside = emission ? Outside::zero : Outside::hold;
    YamlMap map(cursor);
    const auto form =
        map.exactly_one(emission ? std::vector<std::string>{"file", "points", "planck", "daylight"}
                                 : std::vector<std::string>{"file", "points"});
    std::optional<Spectrum> spectrum;
    if (form.key == "file") {
        const auto column = map.required("column", "the name of a column of the file").word();
        const auto path = context.file(form.value);
        if (path && column)
            spectrum = context.attempt(form.value,
                                       [&] { return read_spectrum_csv(*path, *column, outside); });
        if (spectrum && !in_range(form.value, *spectrum, quantity)) spectrum.reset();
    } else if (form.key == "points") {
        spectrum = read_points(context, form.value, quantity, outside);
    } else if (!form.key.empty()) {
        const double temperature_k =
            read_value(form.value, dimension::temperature, Accept::positive);
        if (std::isfinite(temperature_k))
            spectrum = context.attempt(form.value, [&] {
                return form.key == "planck" ? spectral::planck(temperature_k)
                                            : spectral::daylight(temperature_k);
            });
    }
    map.no_other_keys();
    if (spectrum && !emission) warn_if_held(context, form.value, *spectrum);
    return spectrum;
}

}  // namespace

void warn_if_held(SceneContext& context, const YamlCursor& at, const Spectrum& spectrum) {
    if (spectrum.is_constant()) return;
    const double from_nm = spectrum.wavelengths_nm().front();
    const double to_nm = spectrum.wavelengths_nm().back();
    if (from_nm > visible_from_nm || to_nm < visible_to_nm)
        context.warn(at,
                     fmt::format("the data cover {:.6g} to {:.6g} nm; the values at the ends are "
                                 "held outside",
                                 from_nm, to_nm));
}

std::optional<Spectrum> read_spectrum(SceneContext& context, const YamlCursor& cursor,
                                      SpectrumOf quantity) {
    if (!cursor) return {};
    std::optional<Spectrum> spectrum;
    if (cursor.is_map()) {
        spectrum = read_tabulated(context, cursor, quantity);
    } else if (quantity == SpectrumOf::emission) {
        spectrum = read_illuminant(cursor);
    } else {
        const auto flat = read_quantity(cursor, dimension_of(quantity), accepted(quantity));
        if (flat) spectrum = Spectrum(flat->value);
    }
    if (!spectrum || quantity != SpectrumOf::emission) return spectrum;
    const double visible = spectral::luminous(*spectrum);
    if (std::isfinite(visible) && visible > 0.0) return spectrum;
    cursor.complain("holds no visible light, from which a flux could be scaled");
    return {};
}

double max_of_sum(const Spectrum& a, const Spectrum& b) {
    double most = 0.0;
    const auto look = [&](double nm) { most = std::max(most, a.at(nm) + b.at(nm)); };
    look(spectral::min_wavelength_nm);
    look(spectral::max_wavelength_nm);
    for (const Spectrum* spectrum : {&a, &b})
        for (const double nm : spectrum->wavelengths_nm())
            if (nm > spectral::min_wavelength_nm && nm < spectral::max_wavelength_nm) look(nm);
    return most;
}

}  // namespace lucerna::io
