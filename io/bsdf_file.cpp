#include "io/bsdf_file.h"

#include <algorithm>

#include "io/bsdf_table.h"
#include "io/bsdf_xml.h"

namespace lucerna::io {

std::shared_ptr<const optics::MeasuredBsdf> read_bsdf_file(const std::filesystem::path& path) {
    const TextFile file = read_text_file(path);
    const auto first = std::ranges::find_if(
        file.lines, [](const std::string& line) { return !trimmed(line).empty(); });
    const bool xml = first != file.lines.end() && trimmed(*first).starts_with('<');
    return std::make_shared<const optics::MeasuredBsdf>(xml ? read_bsdf_xml(file)
                                                            : read_bsdf_table(file));
}

}  // namespace lucerna::io
