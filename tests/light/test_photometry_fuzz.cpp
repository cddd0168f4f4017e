// Mutated files: each is either read with sensible results or refused with a place (rule S6).
#include <sstream>

#include "light_checks.h"
#include "photometry_files.h"

using namespace lucerna;
using namespace lucerna::test;

namespace {

class Mutator {
public:
    explicit Mutator(std::uint32_t path) : random_(20, 0, RandomPurpose::test, path) {}

    std::string operator()(std::string text) {
        const std::size_t changes = 1 + below(4);
        for (std::size_t i = 0; i < changes && !text.empty(); ++i) change(text);
        return text;
    }

private:
    std::size_t below(std::size_t n) {
        return static_cast<std::size_t>(random_.uniform() * static_cast<double>(n));
    }

    void change(std::string& text) {
        static const std::vector<std::string> words = {
            "-1",      "0",           "nan",        "inf",  "1e308",
            "-1e-308", "99999999999", "3.7",        ",",    "TILT=INCLUDE\n",
            "\n",      "\r",          "[MORE] x\n", "\xFF", "TILT=NONE\n",
            "360",     "180",         "1e5",        "-",    "+-1",
            "0x10"};
        const std::size_t at = below(text.size());
        switch (below(6)) {
            case 0:
                text[at] = static_cast<char>(below(256));
                return;
            case 1:
                text.erase(at, 1 + below(20));
                return;
            case 2:
                text.insert(at, words[below(words.size())]);
                return;
            case 3:
                text.resize(at);
                return;
            case 4:
                text.insert(at, text.substr(below(text.size()), below(200)));
                return;
            default:
                replace_word(text, at, words[below(words.size())]);
        }
    }

    static void replace_word(std::string& text, std::size_t at, const std::string& word) {
        const char* blanks = " \t\r\n,";
        const std::size_t start = text.find_first_not_of(blanks, at);
        if (start == std::string::npos) return;
        const std::size_t end = std::min(text.find_first_of(blanks, start), text.size());
        text.replace(start, end - start, word);
    }

    RandomStream random_;
};

std::string contents(const std::filesystem::path& path) {
    std::stringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    return text.str();
}

bool is_sensible(const PhotometricFile& file) {
    const double flux = file.integrated_flux_lm;
    bool sizes = file.opening.size_m.allFinite() && file.opening.size_m.minCoeff() >= 0.0;
    for (const double height : file.opening.side_heights_m) {
        sizes = sizes && height >= 0.0 && height <= file.opening.size_m.z();
    }
    const Vec3 w = file.intensity.sample(0.3, 0.7);
    return std::isfinite(flux) && flux > 0.0 && sizes && std::abs(w.norm() - 1.0) < 1e-12 &&
           file.intensity.pdf_solid_angle(w) >= 0.0 && file.downward_fraction >= 0.0 &&
           file.downward_fraction < 1.0 + 1e-9;
}

bool has_place(const InputError& error) {
    for (const Diagnostic& diagnostic : error.diagnostics()) {
        if (!diagnostic.where.file.empty() && !diagnostic.message.empty()) return true;
    }
    return false;
}

}  // namespace

TEST_CASE("Mutated files are read sensibly or refused with a place", "[light][fuzz]") {
    const ScratchFolder folder;
    int read = 0;
    int refused = 0;
    std::uint32_t path = 0;
    for (const char* name :
         {"sample_01.ldt", "sample_03.ldt", "sample_04.ldt", "viewer_multiple_lamp_sets.ldt",
          "ledalite_pendant.ies", "bollard.ies", "soft_display.ies", "viewer_sphere_opening.ies"}) {
        const std::string original = contents(data_file(name));
        const std::string extension = std::filesystem::path(name).extension();
        for (int i = 0; i < 250; ++i) {
            const std::string mutant = Mutator(path++)(original);
            const auto file = folder.write("mutant" + extension, mutant);
            INFO(name << ", mutation " << path - 1);
            try {
                const bool sensible = is_sensible(read_photometric_file(file));
                CHECK(sensible);
                ++read;
            } catch (const InputError& error) {
                CHECK(has_place(error));
                ++refused;
            }
        }
    }
    CHECK(read > 100);
    CHECK(refused > 100);
}
