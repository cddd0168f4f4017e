#include "io/atomic_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>
#include <atomic>

#include <cerrno>
#include <system_error>

namespace lucerna::io {
namespace {

// A name beside the final one, so that the rename stays within one file system. The process and a
// count make it unique among runs and threads that write the same file.
std::filesystem::path temporary_name(const std::filesystem::path& path) {
    static std::atomic<unsigned> count = 0;
    const std::string name =
        fmt::format(".{}.{}-{}.tmp", path.filename().string(), ::getpid(), count++);
    return path.parent_path() / name;
}

// Makes a rename last through a loss of power. Some file systems cannot, which costs only this.
void sync_folder(const std::filesystem::path& file) {
    const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::fsync(descriptor);
    ::close(descriptor);
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path)
    : path_(std::move(path)), temporary_(temporary_name(path_)) {
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail("create");
}

AtomicFile::~AtomicFile() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    ::unlink(temporary_.c_str());
}

void AtomicFile::write(const void* data, std::size_t size) {
    const char* next = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t written = ::write(descriptor_, next, size);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail("write");
        next += written;
        size -= static_cast<std::size_t>(written);
    }
}

void AtomicFile::seek(std::uint64_t position) {
    if (::lseek(descriptor_, static_cast<off_t>(position), SEEK_SET) < 0) fail("seek in");
}

std::uint64_t AtomicFile::position() {
    const off_t position = ::lseek(descriptor_, 0, SEEK_CUR);
    if (position < 0) fail("seek in");
    return static_cast<std::uint64_t>(position);
}

void AtomicFile::commit() {
    if (first_error_ != 0) {
        errno = first_error_;
        fail("write");
    }
    if (::fsync(descriptor_) != 0) fail("write");
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("create");
    ::close(descriptor_);
    descriptor_ = -1;
    sync_folder(path_);
}

void AtomicFile::fail(const char* what) {
    first_error_ = errno;
    throw std::system_error(first_error_, std::generic_category(),
                            fmt::format("cannot {} {}", what, path_.string()));
}

void write_file(const std::filesystem::path& path, std::string_view bytes) {
    AtomicFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

}  // namespace lucerna::io
