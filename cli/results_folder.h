// The folder in which a run leaves its files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/report.h"
#include "io/state_file.h"
#include "io/summary.h"
#include "optics/transport/result.h"

namespace lucerna::cli {

/// room.yaml -> room-results, in the same folder.
std::filesystem::path default_results_folder(const std::filesystem::path& scene);

/// File names for images: letters, digits, '-', '_' and what is not ASCII stay, all else becomes
/// '_'; names that would coincide are numbered.
std::vector<std::string> file_names(const std::vector<optics::Image>& images);

/// Makes a folder unless it is there. Throws InputError if it cannot be written to.
void make_folder(const std::filesystem::path& path);

class ResultsFolder {
public:
    /// Makes the folder, so that a run does not find out at its end. Throws InputError if it cannot
    /// be written to.
    explicit ResultsFolder(std::filesystem::path path);

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path state_file() const { return path_ / io::state_file_name; }

    /// report.json, and of each image NAME.exr, NAME.png, NAME.false_colour.png, and
    /// NAME.spectral.exr if it has spectra.
    std::vector<io::WrittenFile> write(const optics::Result& result,
                                       const io::ReportSource& source) const;

private:
    std::filesystem::path path_;
};

}  // namespace lucerna::cli
