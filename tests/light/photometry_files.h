// Photometric files for the tests: those of tests/data/light, and text written on the spot.
#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/diagnostics.h"
#include "io/photometric_file.h"
#include "tests/support/scratch_folder.h"

namespace lucerna::test {

inline std::filesystem::path data_file(const std::string& name) {
    return std::filesystem::path(LUCERNA_TEST_DATA) / "light" / name;
}

inline PhotometricFile read_text(const std::string& name, const std::string& bytes,
                                 int lamp_set = 1) {
    const ScratchFolder folder;
    return read_photometric_file(folder.write(name, bytes), lamp_set);
}

/// The complaints about a text, without the folder: "file.ies:3:5: ...", one per line.
inline std::string complaints(const std::string& name, const std::string& bytes) {
    const ScratchFolder folder;
    const auto path = folder.write(name, bytes);
    try {
        read_photometric_file(path);
    } catch (const InputError& error) {
        std::string text;
        for (Diagnostic diagnostic : error.diagnostics()) {
            diagnostic.where.file = std::filesystem::path(diagnostic.where.file).filename();
            text += diagnostic.text() + "\n";
        }
        return text;
    }
    return "nothing";
}

/// True if one of the entries contains the text.
inline bool mentions(const std::vector<std::string>& entries, const std::string& text) {
    for (const std::string& entry : entries) {
        if (entry.find(text) != std::string::npos) return true;
    }
    return false;
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

inline double intensity_cd(const PhotometricFile& file, double c_deg, double gamma_deg) {
    return file.intensity.intensity_cd(optics::IntensityDistribution::direction(c_deg, gamma_deg));
}

}  // namespace lucerna::test
