// Files that appear complete or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

namespace lucerna::io {

/// A file that is written under a temporary name in its folder and gets its final name by commit().
/// A full disk, an exception or a killed run leaves whatever had the final name before, untouched.
/// Errors of the system are thrown as std::system_error with the final name in the text.
class AtomicFile {
public:
    explicit AtomicFile(std::filesystem::path path);
    /// Removes the temporary file if the file was not committed.
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* data, std::size_t size);
    void seek(std::uint64_t position);
    std::uint64_t position();
    /// Brings the data to the disk and gives the file its name. Nothing may be written afterwards.
    /// Fails as well if an earlier write failed and a library swallowed the exception.
    void commit();

    const std::filesystem::path& path() const { return path_; }

private:
    [[noreturn]] void fail(const char* what);

    std::filesystem::path path_;
    std::filesystem::path temporary_;
    int descriptor_ = -1;
    int first_error_ = 0;  // errno, 0: none
};

/// Writes a whole file at once, as above.
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace lucerna::io
