// A fingerprint of the files that a result rests on.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace lucerna::io {

/// SHA-256 (FIPS 180-4) as 64 hexadecimal digits.
std::string sha256(std::string_view bytes);

/// One hash for a scene and the files it refers to, in the order given; names and folders do not
/// count. It is what the shell says to   sha256sum FILES... | cut -c-64 | sha256sum Throws
/// InputError if a file cannot be read.
std::string content_hash(std::span<const std::filesystem::path> files);

}  // namespace lucerna::io
