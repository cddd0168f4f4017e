#include "cli/results_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "core/diagnostics.h"
#include "io/atomic_file.h"
#include "io/exr.h"
#include "io/preview.h"

namespace lucerna::cli {
namespace {

std::string file_name(const std::string& name) {
    std::string result;
    for (const char c : name) {
        const bool letter =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        const bool kept = letter || c == '-' || c == '_' || static_cast<unsigned char>(c) >= 0x80;
        result += kept ? c : '_';
    }
    return result.empty() ? "image" : result;
}

}  // namespace

std::filesystem::path default_results_folder(const std::filesystem::path& scene) {
    return scene.parent_path() / (scene.stem().string() + "-results");
}

std::vector<std::string> file_names(const std::vector<optics::Image>& images) {
    std::vector<std::string> names;
    const auto taken = [&](const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (const auto& image : images) {
        const std::string base = file_name(image.name);
        std::string name = base;
        for (int number = 2; taken(name); ++number) name = fmt::format("{}-{}", base, number);
        names.push_back(name);
    }
    return names;
}

void make_folder(const std::filesystem::path& path) {
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error)
        throw InputError({path.string()}, fmt::format("cannot be made: {}", error.message()));
    if (::access(path.c_str(), W_OK | X_OK) != 0) {
        throw InputError({path.string()}, "cannot be written to; choose another folder with -o");
    }
}

ResultsFolder::ResultsFolder(std::filesystem::path path) : path_(std::move(path)) {
    make_folder(path_);
}

std::vector<io::WrittenFile> ResultsFolder::write(const optics::Result& result,
                                                  const io::ReportSource& source) const {
    std::vector<io::WrittenFile> files;
    const io::Provenance provenance{result.phases, result.seeds, source.scene_hash};
    const std::vector<std::string> names = file_names(result.images);
    for (std::size_t i = 0; i < names.size(); ++i) {
        const optics::Image& image = result.images[i];
        const auto path = [&](const char* ending) { return path_ / (names[i] + ending); };

        io::write_exr(path(".exr"), image, provenance);
        files.push_back({path(".exr"), "luminance with its error [cd/m2], colour"});
        if (!image.bin_edges_nm.empty()) {
            io::write_spectral_exr(path(".spectral.exr"), image, provenance);
            files.push_back({path(".spectral.exr"), "radiance per bin of wavelength [W/(m2 sr)]"});
        }
        const io::NaturalPreview natural = io::natural_preview(image);
        io::write_png(path(".png"), natural.raster);
        files.push_back(
            {path(".png"), fmt::format("picture, white is {:.3g} cd/m2", natural.white_luminance)});
        const io::FalseColourPreview colours = io::false_colour_preview(image);
        io::write_png(path(".false_colour.png"), colours.raster);
        files.push_back(
            {path(".false_colour.png"), fmt::format("luminance, {:g} to {:g} cd/m2",
                                                    colours.min_luminance, colours.max_luminance)});
    }
    io::write_file(path_ / "report.json", io::report_json(result, source));
    files.push_back({path_ / "report.json", "all numbers with their uncertainty"});
    return files;
}

}  // namespace lucerna::cli
