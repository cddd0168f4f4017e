// A file that exists as long as a test needs it.
#pragma once

#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

class TextFile {
public:
    explicit TextFile(std::string_view text) {
        static std::atomic<int> counter = 0;
        path_ = std::filesystem::temp_directory_path() /
                ("lucerna_test_" + std::to_string(::getpid()) + "_" + std::to_string(counter++));
        std::ofstream(path_, std::ios::binary) << text;
    }
    ~TextFile() { std::filesystem::remove(path_); }
    TextFile(const TextFile&) = delete;
    TextFile& operator=(const TextFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};
