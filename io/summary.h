// The result of a run for people, on a terminal.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "optics/transport/result.h"

namespace lucerna::io {

/// A file that a run has written, and what a reader should know of it: "false colour, 2 to 900
/// cd/m2".
struct WrittenFile {
    std::filesystem::path path;
    std::string description;
};

/// Images, quantities with their 95 % uncertainties, flux balance, work done, warnings and files.
std::string summary(const optics::Result& result, const std::vector<WrittenFile>& files);

}  // namespace lucerna::io
