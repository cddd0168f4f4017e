#include "io/state_file.h"

#include <fmt/format.h>

#include <cereal/archives/portable_binary.hpp>
#include <cereal/types/optional.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <fstream>
#include <sstream>

#include "core/diagnostics.h"
#include "io/atomic_file.h"
#include "io/content_hash.h"

namespace lucerna::io {
namespace {

constexpr std::string_view first_line = "lucerna state 1\n";
constexpr std::size_t hash_digits = 64;

template <typename... Parts>
std::string saved(const Parts&... parts) {
    std::ostringstream stream;
    {
        cereal::PortableBinaryOutputArchive archive(stream);
        archive(parts...);
    }
    return std::move(stream).str();
}

}  // namespace

void write_state(const std::filesystem::path& path, const optics::RunState& state,
                 const ReportSource& source) {
    const std::string bytes =
        saved(std::string(LUCERNA_VERSION), source.scene, source.scene_hash, state.settings, state);
    AtomicFile file(path);
    const auto write = [&](std::string_view text) { file.write(text.data(), text.size()); };
    write(first_line);
    write(sha256(bytes));
    write("\n");
    write(bytes);
    file.commit();
}

StateFile::StateFile(const std::filesystem::path& path) : path_(path) {
    const auto reject = [&](const std::string& why) { throw InputError({path.string()}, why); };
    std::ifstream stream(path, std::ios::binary);
    if (!stream) reject("cannot be read; a run that may be continued leaves it in its results");
    bytes_.assign(std::istreambuf_iterator<char>(stream), {});
    const std::size_t header = first_line.size() + hash_digits + 1;
    if (bytes_.size() < header || !bytes_.starts_with(first_line)) {
        reject("is not the state of a run");
    }
    const std::string hash = bytes_.substr(first_line.size(), hash_digits);
    bytes_.erase(0, header);
    if (sha256(bytes_) != hash) {
        reject("is damaged: its content does not have the hash of its second line");
    }
    std::istringstream content(bytes_);
    cereal::PortableBinaryInputArchive archive(content);
    std::string version;
    archive(version);
    if (version != LUCERNA_VERSION) {
        reject(
            fmt::format("is of version {} of the program, this is {}: other versions may trace "
                        "other phases",
                        version, LUCERNA_VERSION));
    }
    archive(source_.scene, source_.scene_hash, settings_);
}

optics::RunState StateFile::state(const optics::SceneParts& parts) const {
    optics::RunState state(parts, settings_);
    std::istringstream content(bytes_);
    cereal::PortableBinaryInputArchive archive(content);
    std::string version;
    ReportSource source;
    try {
        archive(version, source.scene, source.scene_hash, state.settings, state);
    } catch (const cereal::Exception&) {
        throw InputError({path_.string()}, "does not fit its scene");
    }
    return state;
}

}  // namespace lucerna::io
