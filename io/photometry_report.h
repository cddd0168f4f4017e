// The text of `lucerna photometry FILE`.
#pragma once

#include <filesystem>
#include <string>

namespace lucerna {

/// What an IES or EULUMDAT file says and whether it agrees with itself, for reading.
/// Throws InputError as read_photometric_file() does.
std::string photometry_report(const std::filesystem::path& path);

}  // namespace lucerna
