#include "io/photometry_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "io/photometric_file.h"
#include "optics/light/luminous_faces.h"

namespace lucerna {
namespace {

// "label          value", continued lines under the value.
void row(std::string& text, const char* label, const std::string& value) {
    if (value.empty()) return;
    std::string indented;
    for (const char c : value) {
        indented += c;
        if (c == '\n') indented += std::string(20, ' ');
    }
    fmt::format_to(std::back_inserter(text), "{:<20}{}\n", label, indented);
}

std::string flux_row(const PhotometricFile& file) {
    if (!file.stated_flux_lm) return "none (absolute photometry)";
    return fmt::format("{:.6g} lm of the {}", *file.stated_flux_lm,
                       file.absolute ? "luminaire (absolute photometry)" : "lamps");
}

std::string with_stated(double percent, const std::optional<double>& stated) {
    if (!stated) return fmt::format("{:.2f} %", percent);
    return fmt::format("{:.2f} % (stated: {:.2f} %)", percent, 100.0 * *stated);
}

std::string output_ratio_row(const PhotometricFile& file) {
    if (file.light_output_ratio) {
        return with_stated(100.0 * *file.light_output_ratio, file.stated_light_output_ratio);
    }
    if (!file.stated_flux_lm) return "";
    return with_stated(100.0 * file.integrated_flux_lm / *file.stated_flux_lm,
                       file.stated_light_output_ratio) +
           " of the stated flux";
}

std::string angles_row(const PhotometricFile& file) {
    const auto& gamma = file.intensity.gamma_deg();
    return fmt::format("{} stored, gamma {:g} to {:g} deg in {} angles", file.stored_planes,
                       gamma.front(), gamma.back(), gamma.size());
}

std::string luminance_rows(const PhotometricFile& file) {
    const auto mesh = opening_mesh(file.opening);
    if (!mesh) return "";
    const optics::LuminousFaces faces(*mesh);
    const auto& intensity = file.intensity;
    const auto luminance = [&](const Vec3& direction) {
        const double area_m2 = faces.projected_area_m2(direction);
        return area_m2 > 0.0 ? intensity.intensity_cd(direction) / area_m2 : 0.0;
    };
    double largest = 0.0;
    double largest_c_deg = 0.0;
    double largest_gamma_deg = 0.0;
    for (const double gamma_deg : intensity.gamma_deg()) {
        // At the horizon a flat opening has no projected area, so that no luminance is defined.
        if (gamma_deg > 85.0 && gamma_deg < 95.0) continue;
        for (const double c_deg : intensity.c_deg()) {
            const double value =
                luminance(optics::IntensityDistribution::direction(c_deg, gamma_deg));
            if (value <= largest) continue;
            largest = value;
            largest_c_deg = c_deg;
            largest_gamma_deg = gamma_deg;
        }
    }
    return fmt::format(
        "{:.4g} cd/m2 at nadir\n{:.4g} cd/m2 at most, toward C {:g}, gamma {:g} deg "
        "(beyond 5 deg from the horizon)",
        luminance(-Vec3::UnitZ()), largest, largest_c_deg, largest_gamma_deg);
}

void list(std::string& text, const char* title, const std::vector<std::string>& entries) {
    if (entries.empty()) return;
    fmt::format_to(std::back_inserter(text), "\n{}\n", title);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        fmt::format_to(std::back_inserter(text), "{:>3}. {}\n", i + 1, entries[i]);
    }
}

}  // namespace

std::string photometry_report(const std::filesystem::path& path) {
    const PhotometricFile file = read_photometric_file(path);
    const auto& intensity = file.intensity;
    std::string text;
    row(text, "file", path.string());
    row(text, "format", file.format);
    row(text, "manufacturer", file.manufacturer);
    row(text, "luminaire", file.luminaire);
    row(text, "catalogue number", file.catalogue_number);
    row(text, "report", file.report_number);
    row(text, "date", file.date);
    text += '\n';
    row(text, "stated flux", flux_row(file));
    row(text, "integrated flux", fmt::format("{:.6g} lm", file.integrated_flux_lm));
    row(text, "light output ratio", output_ratio_row(file));
    row(text, "downward share",
        with_stated(100.0 * file.downward_fraction, file.stated_downward_fraction));
    if (file.input_power_w > 0.0) {
        row(text, "power", fmt::format("{:.6g} W", file.input_power_w));
        row(text, "efficacy",
            fmt::format("{:.4g} lm/W", file.integrated_flux_lm / file.input_power_w));
    }
    text += '\n';
    row(text, "photometric type", file.photometric_type);
    row(text, "symmetry", file.symmetry);
    row(text, "planes", angles_row(file));
    row(text, "largest intensity",
        fmt::format("{:.6g} cd toward C {:g}, gamma {:g} deg", intensity.max_intensity_cd(),
                    intensity.max_c_deg(), intensity.max_gamma_deg()));
    row(text, "intensity at nadir",
        fmt::format("{:.6g} cd", intensity.intensity_cd(-Vec3::UnitZ())));
    row(text, "opening", file.opening.description());
    row(text, "luminance", luminance_rows(file));
    list(text, "notes", file.notes);
    list(text, "deviations from the standard", file.deviations);
    if (file.deviations.empty()) text += "\nno deviations from the standard found\n";
    return text;
}

}  // namespace lucerna
