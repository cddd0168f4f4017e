// Random damage to the examples: nothing may crash, and what is refused must say where.
#include <map>

#include "core/random.h"
#include "scene_text.h"

using namespace lucerna;
using namespace lucerna::io;

namespace {

std::string content_of(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::size_t below(RandomStream& random, std::size_t count) {
    return static_cast<std::size_t>(random.uniform() * static_cast<double>(count));
}

/// One to four small damages: bytes changed, removed, doubled, or words of other lines put in.
std::string damaged(std::string text, RandomStream& random) {
    static const std::vector<std::string> pieces{
        "-",    "0",    "1e300", "nan",   ".inf",         "[",   "]",     "{",    "}",  ":",
        ": ",   "\n",   "\t",    "  ",    "- ",           "&a ", "*a",    "!!x ", "#",  "|\n",
        "\"",   "'",    ",",     "\xff",  "\xef\xbb\xbf", "%",   "---\n", "? ",   "mm", "lm",
        "-1 m", "none", "~",     "<<: *a"};
    const std::size_t damages = 1 + below(random, 4);
    for (std::size_t i = 0; i < damages && !text.empty(); ++i) {
        const std::size_t at = below(random, text.size());
        const std::size_t length = 1 + below(random, 12);
        switch (below(random, 5)) {
            case 0:
                text[at] = static_cast<char>(below(random, 256));
                break;
            case 1:
                text.erase(at, length);
                break;
            case 2:
                text.insert(at, pieces[below(random, pieces.size())]);
                break;
            case 3:
                text.insert(at, text.substr(below(random, text.size()), length));
                break;
            default:
                text.erase(at);
                break;
        }
    }
    return text;
}

/// Reads a damaged scene; true if it was refused, with a place in each complaint.
bool is_refused_with_place(const std::filesystem::path& scene) {
    try {
        const SceneFile read = read_scene_file(scene);
        CHECK_FALSE(scene_summary(read).empty());
        return false;
    } catch (const InputError& error) {
        CHECK_FALSE(error.diagnostics().empty());
        for (const Diagnostic& diagnostic : error.diagnostics()) {
            CAPTURE(diagnostic.text());
            CHECK_FALSE(diagnostic.where.file.empty());
            CHECK_FALSE(diagnostic.message.empty());
            if (diagnostic.where.file == scene.string() &&
                diagnostic.message.rfind("is empty", 0) != 0)
                CHECK(diagnostic.where.line > 0);
        }
        return true;
    }
}

}  // namespace

TEST_CASE("Damaged scenes are refused with a place or read", "[unit]") {
    const std::string example = GENERATE("good", "cornell_box", "cornell_caustic", "light_guides_1",
                                         "light_guides_2", "light_guides_3", "room2");
    const ScratchFolder folder;
    const std::filesystem::path examples = LUCERNA_EXAMPLES;
    std::filesystem::create_directory_symlink(examples / "data", folder.path() / "data");
    const std::string text =
        example == "good" ? good_scene : content_of(examples / (example + ".yaml"));
    // The room reads megabytes of measured data each time.
    const std::uint32_t rounds = example == "good" ? 1500 : example == "room2" ? 80 : 120;
    std::uint32_t refused = 0;
    for (std::uint32_t i = 0; i < rounds; ++i) {
        RandomStream random(20240611, 0, RandomPurpose::test, i);
        const std::string changed = damaged(text, random);
        CAPTURE(i, changed);
        refused += is_refused_with_place(folder.write("scene.yaml", changed)) ? 1 : 0;
    }
    // Most damage must be noticed; the rest fell into comments or turned one good value into
    // another.
    CHECK(refused > rounds / 2);
    CHECK(refused < rounds);
}
