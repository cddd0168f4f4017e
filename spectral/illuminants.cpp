#include "spectral/illuminants.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "spectral/cie_tables.h"
#include "spectral/integral.h"

namespace lucerna::spectral {
namespace {

template <typename Function>
Spectrum tabulated(double from_nm, double to_nm, double step_nm, const Function& value) {
    std::vector<double> wavelengths_nm;
    std::vector<double> values;
    for (double wavelength_nm = from_nm; wavelength_nm <= to_nm; wavelength_nm += step_nm) {
        wavelengths_nm.push_back(wavelength_nm);
        values.push_back(value(wavelength_nm));
    }
    return {std::move(wavelengths_nm), std::move(values), Outside::zero};
}

// Standard illuminant A by its definition (ISO/CIE 11664-2:2022), in which c2 has its value of 1931
// so that no later value changes it.
Spectrum illuminant_a() {
    return tabulated(300.0, 830.0, 1.0, [](double wavelength_nm) {
        const double c2_nm_k = 1.435e7;
        const double temperature_k = 2848.0;
        return 100.0 * std::pow(560.0 / wavelength_nm, 5) *
               std::expm1(c2_nm_k / (temperature_k * 560.0)) /
               std::expm1(c2_nm_k / (temperature_k * wavelength_nm));
    });
}

struct Entry {
    std::string name;
    std::string_view table;
};

// Every tabulated illuminant with the file it stands in.
const std::vector<Entry>& tabulated_illuminants() {
    static const std::vector<Entry> entries = [] {
        std::vector<Entry> list;
        for (const char* name : {"C", "D50", "D55", "D65", "D75"}) {
            list.push_back({name, "cie_illuminants_standard"});
        }
        for (const char* table :
             {"cie_illuminants_FL1-12", "cie_illuminants_FL3", "cie_illuminants_HP",
              "cie_illuminants_LED", "cie_illuminants_ID"}) {
            for (const std::string_view column : cie_columns(table)) {
                list.push_back({std::string(column), table});
            }
        }
        return list;
    }();
    return entries;
}

// "cie-f11" -> "FL11"
std::string canonical(std::string_view name) {
    std::string result(name);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    if (result.starts_with("CIE-")) result.erase(0, 4);
    if (result.size() > 1 && result[0] == 'F' &&
        std::isdigit(static_cast<unsigned char>(result[1]))) {
        result.insert(result.begin() + 1, 'L');
    }
    return result;
}

}  // namespace

std::optional<Spectrum> illuminant(std::string_view name) {
    const std::string wanted = canonical(name);
    if (wanted == "A") return illuminant_a();
    if (wanted == "E") {
        return Spectrum({min_wavelength_nm, max_wavelength_nm}, {100.0, 100.0}, Outside::zero);
    }
    for (const Entry& entry : tabulated_illuminants()) {
        if (entry.name == wanted) return cie_column(entry.table, entry.name, Outside::zero);
    }
    return std::nullopt;
}

std::vector<std::string> illuminant_names() {
    std::vector<std::string> names = {"A", "E"};
    for (const Entry& entry : tabulated_illuminants()) names.push_back(entry.name);
    return names;
}

Spectrum daylight(double cct_k) {
    if (!(cct_k >= min_daylight_cct_k && cct_k <= max_daylight_cct_k)) {
        throw std::invalid_argument("daylight is defined from 4000 K to 25000 K");
    }
    // CIE 15:2018: chromaticity from temperature, then the weights of the components
    const double t = 1e3 / cct_k;
    const double x = cct_k <= 7000.0 ? ((-4.6070 * t + 2.9678) * t + 0.09911) * t + 0.244063
                                     : ((-2.0064 * t + 1.9018) * t + 0.24748) * t + 0.237040;
    const double y = (-3.000 * x + 2.870) * x - 0.275;
    const double m = 0.0241 + 0.2562 * x - 0.7341 * y;
    const double m1 = (-1.3515 - 1.7703 * x + 5.9114 * y) / m;
    const double m2 = (0.0300 - 31.4424 * x + 30.0717 * y) / m;

    const char* table = "cie_daylight_S0S1S2";
    static const Spectrum s0 = cie_column(table, "S0", Outside::zero);
    static const Spectrum s1 = cie_column(table, "S1", Outside::zero);
    static const Spectrum s2 = cie_column(table, "S2", Outside::zero);
    std::vector<double> values;
    for (std::size_t i = 0; i < s0.values().size(); ++i) {
        values.push_back(s0.values()[i] + m1 * s1.values()[i] + m2 * s2.values()[i]);
    }
    return {s0.wavelengths_nm(), std::move(values), Outside::zero};
}

Spectrum planck(double temperature_k) {
    if (!(temperature_k > 0.0) || std::isinf(temperature_k)) {
        throw std::invalid_argument("temperature of a black body must be positive");
    }
    constexpr double planck_constant_j_s = 6.62607015e-34;
    constexpr double speed_of_light_m_per_s = 299792458.0;
    constexpr double boltzmann_constant_j_per_k = 1.380649e-23;
    constexpr double c1_w_m2 =
        2.0 * planck_constant_j_s * speed_of_light_m_per_s * speed_of_light_m_per_s;
    constexpr double c2_m_k =
        planck_constant_j_s * speed_of_light_m_per_s / boltzmann_constant_j_per_k;
    return tabulated(min_wavelength_nm, max_wavelength_nm, 1.0, [&](double wavelength_nm) {
        const double wavelength_m = wavelength_nm * 1e-9;
        return 1e-9 * c1_w_m2 / std::pow(wavelength_m, 5) /
               std::expm1(c2_m_k / (wavelength_m * temperature_k));
    });
}

}  // namespace lucerna::spectral
