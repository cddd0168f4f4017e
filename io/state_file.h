// The state of a run as a file, from which the run goes on or is joined with others.
#pragma once

#include <filesystem>
#include <string>

#include "io/report.h"
#include "optics/transport/run_state.h"

namespace lucerna::io {

/// Its name in a folder of results.
inline constexpr const char* state_file_name = "run.state";

/// Two lines of text, "lucerna state 1" and the SHA-256 of all that follows; then, in the portable
/// binary layout of cereal, version of the program, source, settings and state. Takes 64 bytes a
/// pixel, and 8 for each bin of its spectrum. Appears complete or not at all.
void write_state(const std::filesystem::path& path, const optics::RunState& state,
                 const ReportSource& source);

/// A state file that was read, without the scene that gives it a meaning.
class StateFile {
public:
    /// Throws InputError if the file cannot be read, is damaged or comes from another version.
    explicit StateFile(const std::filesystem::path& path);

    const std::filesystem::path& path() const { return path_; }
    /// Of the run that wrote it.
    const ReportSource& source() const { return source_; }
    const optics::Settings& settings() const { return settings_; }
    /// @param parts  of a scene with the hash of source(). Throws InputError if the state does not
    ///     fit it.
    optics::RunState state(const optics::SceneParts& parts) const;

private:
    std::filesystem::path path_;
    ReportSource source_;
    optics::Settings settings_;
    std::string bytes_;  // all that is behind the hash
};

}  // namespace lucerna::io
