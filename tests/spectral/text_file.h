// A file that exists as long as a test needs it.
#pragma once

#include <string>
#include <string_view>

#include "tests/support/scratch_folder.h"

class TextFile {
public:
    explicit TextFile(std::string_view text) : path_(folder_.write("text", std::string(text))) {}

    const std::filesystem::path& path() const { return path_; }

private:
    lucerna::test::ScratchFolder folder_;
    std::filesystem::path path_;
};
