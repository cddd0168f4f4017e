#include "io/bsdf_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <pugixml.hpp>

namespace lucerna::io {

namespace {

using optics::KlemsBasis;
using optics::KlemsBsdf;
using optics::KlemsMatrix;
using optics::MeasuredBsdf;
using optics::MeasuredParts;
using optics::Side;

bool same_word(std::string_view a, std::string_view b) {
    return std::ranges::equal(
        a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

std::string_view text_of(const pugi::xml_node& node) {
    return trimmed(std::string_view(node.text().get()));
}

/// One of the four matrices that a file may have.
struct PartName {
    const char* name;
    bool transmission;
    Side light;
};
constexpr std::array<PartName, 4> xml_part_names{{{"Transmission Front", true, Side::front},
                                                  {"Transmission Back", true, Side::back},
                                                  {"Reflection Front", false, Side::front},
                                                  {"Reflection Back", false, Side::back}}};

auto& part_of(auto& parts, const PartName& name) {
    return (name.transmission ? parts.transmission
                              : parts.reflection)[static_cast<std::size_t>(name.light)];
}

class XmlReader {
public:
    explicit XmlReader(const TextFile& file) : file_(file) {
        for (const std::string& line : file.lines) {
            line_starts_.push_back(text_.size());
            text_ += line;
            text_ += '\n';
        }
    }

    MeasuredBsdf read() {
        pugi::xml_document document;
        // Without translation of line ends, so that offsets in the text stay those of the file.
        const auto parsed =
            document.load_buffer(text_.data(), text_.size(), pugi::parse_default & ~pugi::parse_eol,
                                 pugi::encoding_utf8);
        if (!parsed) {
            throw InputError(at_offset(parsed.offset),
                             fmt::format("is not well-formed XML: {}", parsed.description()));
        }
        const pugi::xml_node layer = layer_of(document);
        const pugi::xml_node definition = layer.child("DataDefinition");
        const bool incident_in_columns = read_data_structure(layer, definition);
        read_bases(definition);
        for (const pugi::xml_node data : layer.children("WavelengthData")) {
            const std::string_view wavelength = text_of(data.child("Wavelength"));
            if (!same_word(wavelength, "Visible") && !same_word(wavelength, "CIE-Y")) {
                other_wavelengths_.emplace_back(wavelength);
                continue;
            }
            for (const pugi::xml_node block : data.children("WavelengthDataBlock")) {
                read_block(block, incident_in_columns);
            }
        }
        if (errors_.empty() && first_block_.empty()) {
            complain(layer,
                     fmt::format("has no matrix for the wavelength \"Visible\" (found: {}); "
                                 "expected a WavelengthData with that Wavelength",
                                 other_wavelengths_.empty()
                                     ? "none"
                                     : fmt::format("{}", fmt::join(other_wavelengths_, ", "))));
        }
        errors_.throw_if_any();
        complete_parts(layer);
        MeasuredBsdf measured{KlemsBsdf(std::move(parts_)), {}};
        check_energy(std::get<KlemsBsdf>(measured.data));
        errors_.throw_if_any();
        measured.warnings = std::move(warnings_);
        return measured;
    }

private:
    SourceLocation at_offset(std::ptrdiff_t offset) const {
        const auto place = static_cast<std::size_t>(std::max<std::ptrdiff_t>(offset, 0));
        const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), place);
        const auto line = static_cast<std::size_t>(next - line_starts_.begin()) - 1;
        return file_.at(line, place - line_starts_[line]);
    }
    void complain_at(std::ptrdiff_t offset, std::string message) {
        errors_.add(at_offset(offset), std::move(message));
    }
    void complain(const pugi::xml_node& node, std::string message) {
        complain_at(node.offset_debug(), std::move(message));
    }

    pugi::xml_node layer_of(const pugi::xml_document& document) {
        const pugi::xml_node root = document.document_element();
        const pugi::xml_node optical = root.child("Optical");
        const pugi::xml_node layer = optical.child("Layer");
        if (std::strcmp(root.name(), "WindowElement") != 0 || !layer) {
            throw InputError(at_offset(root.offset_debug()),
                             fmt::format("begins with <{}>; expected the LBNL BSDF format, "
                                         "<WindowElement><Optical><Layer>",
                                         root.name()));
        }
        if (const pugi::xml_node second = layer.next_sibling("Layer")) {
            throw InputError(at_offset(second.offset_debug()),
                             "is a second <Layer>; expected a single layer or system");
        }
        return layer;
    }

    bool read_data_structure(const pugi::xml_node& layer, const pugi::xml_node& definition) {
        const pugi::xml_node node = definition.child("IncidentDataStructure");
        const std::string_view structure = text_of(node);
        if (structure.starts_with("TensorTree")) {
            throw InputError(
                at_offset(node.offset_debug()),
                fmt::format("\"{}\": tensor trees are not supported; expected matrices on "
                            "a Klems basis (genBSDF without -t3 and -t4)",
                            structure));
        }
        if (same_word(structure, "Rows")) return false;
        if (!same_word(structure, "Columns")) {
            complain(
                node ? node : layer,
                fmt::format("IncidentDataStructure is \"{}\"; expected \"Columns\" or \"Rows\"",
                            structure));
        }
        return true;
    }

    void read_bases(const pugi::xml_node& definition) {
        bases_ = {{"LBNL/Klems Full", KlemsBasis::full()},
                  {"LBNL/Klems Half", KlemsBasis::half()},
                  {"LBNL/Klems Quarter", KlemsBasis::quarter()}};
        for (const pugi::xml_node basis : definition.children("AngleBasis")) {
            std::vector<KlemsBasis::Ring> rings;
            double lower_deg = 0.0;
            bool readable = true;
            for (const pugi::xml_node block : basis.children("AngleBasisBlock")) {
                const pugi::xml_node bounds = block.child("ThetaBounds");
                const auto lower =
                    read_number(bounds.child("LowerTheta"), block, "LowerTheta", 0, 90);
                const auto upper =
                    read_number(bounds.child("UpperTheta"), block, "UpperTheta", 0, 90);
                const auto sectors = read_number(block.child("nPhis"), block, "nPhis", 1, 1000);
                if (!lower || !upper || !sectors) {
                    readable = false;
                    continue;
                }
                if (std::abs(*lower - lower_deg) > 1e-6 || !(*upper > *lower) ||
                    *sectors != std::floor(*sectors)) {
                    complain(block,
                             fmt::format("ring from {} to {} deg with {} sectors does not follow "
                                         "the one before, which ends at {} deg",
                                         *lower, *upper, *sectors, lower_deg));
                    readable = false;
                }
                lower_deg = *upper;
                rings.push_back({*lower, *upper, static_cast<int>(*sectors)});
            }
            if (!readable) continue;
            if (rings.empty() || std::abs(lower_deg - 90.0) > 1e-6) {
                complain(basis, fmt::format("rings end at {} deg; expected 90", lower_deg));
                continue;
            }
            bases_.insert_or_assign(std::string(text_of(basis.child("AngleBasisName"))),
                                    KlemsBasis(std::move(rings)));
        }
    }

    std::optional<double> read_number(const pugi::xml_node& node, const pugi::xml_node& parent,
                                      const char* name, double least, double most) {
        const auto value = parse_number(text_of(node));
        if (value && *value >= least && *value <= most) return value;
        complain(node ? node : parent, fmt::format("{} is \"{}\"; expected a number from {} to {}",
                                                   name, text_of(node), least, most));
        return std::nullopt;
    }

    const KlemsBasis* basis(const pugi::xml_node& block, const char* key) {
        const pugi::xml_node node = block.child(key);
        const auto found = bases_.find(std::string(text_of(node)));
        if (found != bases_.end()) return &found->second;
        std::vector<std::string> known;
        for (const auto& [name, unused] : bases_) known.push_back(name);
        complain(node ? node : block, fmt::format("{} is \"{}\"; expected one of: {}", key,
                                                  text_of(node), fmt::join(known, ", ")));
        return nullptr;
    }

    void read_block(const pugi::xml_node& block, bool incident_in_columns) {
        const pugi::xml_node direction = block.child("WavelengthDataDirection");
        const auto name = std::ranges::find_if(xml_part_names, [&](const PartName& part) {
            return same_word(part.name, text_of(direction));
        });
        if (name == xml_part_names.end()) {
            complain(direction ? direction : block,
                     fmt::format("WavelengthDataDirection is \"{}\"; expected Transmission Front, "
                                 "Transmission Back, Reflection Front or Reflection Back",
                                 text_of(direction)));
            return;
        }
        if (!first_block_.emplace(name->name, block.offset_debug()).second) {
            complain(block, fmt::format("is a second matrix for {}", name->name));
            return;
        }
        const KlemsBasis* columns = basis(block, "ColumnAngleBasis");
        const KlemsBasis* rows = basis(block, "RowAngleBasis");
        if (!columns || !rows) return;
        const auto column_count = static_cast<std::size_t>(columns->patch_count());
        const auto row_count = static_cast<std::size_t>(rows->patch_count());
        auto values = read_matrix(block, row_count, column_count);
        if (!values) return;
        if (incident_in_columns) {  // stored by incident patch first
            std::vector<float> transposed(values->size());
            for (std::size_t row = 0; row < row_count; ++row) {
                for (std::size_t column = 0; column < column_count; ++column) {
                    transposed[column * row_count + row] = (*values)[row * column_count + column];
                }
            }
            *values = std::move(transposed);
        }
        part_of(parts_, *name) = incident_in_columns
                                     ? KlemsMatrix(*columns, *rows, std::move(*values))
                                     : KlemsMatrix(*rows, *columns, std::move(*values));
    }

    std::optional<std::vector<float>> read_matrix(const pugi::xml_node& block,
                                                  std::size_t row_count, std::size_t column_count) {
        const pugi::xml_node node = block.child("ScatteringData");
        const pugi::xml_node content = node.first_child();
        const std::string_view text = content.value();
        std::vector<float> values;
        // The bases may ask for any number of values; the file has at most one per two characters.
        values.reserve(std::min(row_count * column_count, text.size() / 2 + 1));
        std::size_t begin = 0, bad = 0;
        constexpr std::string_view separators = " \t\r\n,;";
        while ((begin = text.find_first_not_of(separators, begin)) != std::string_view::npos) {
            const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
            const std::string_view word = text.substr(begin, end - begin);
            const auto value = parse_number(word);
            if (!value || *value < 0.0 || *value > 1e30) {
                if (++bad <= 3) {
                    complain_at(
                        content.offset_debug() + static_cast<std::ptrdiff_t>(begin),
                        fmt::format("\"{}\" is no BSDF value; expected a number >= 0 in 1/sr",
                                    word));
                }
            }
            values.push_back(static_cast<float>(value.value_or(0.0)));
            begin = end;
        }
        if (values.size() != row_count * column_count) {
            complain(node ? node : block,
                     fmt::format("ScatteringData has {} values; expected {} rows x {} columns = {}",
                                 values.size(), row_count, column_count, row_count * column_count));
            return std::nullopt;
        }
        if (bad > 0) return std::nullopt;
        return values;
    }

    /// What is missing, and what takes its place.
    void complete_parts(const pugi::xml_node& layer) {
        for (const Side light : {Side::front, Side::back}) {
            auto& missing = parts_.transmission[static_cast<std::size_t>(light)];
            const auto& given = parts_.transmission[static_cast<std::size_t>(other(light))];
            if (missing || !given) continue;
            const char* from = light == Side::front ? "Transmission Back" : "Transmission Front";
            missing = given->reversed();
            if (!missing) {
                complain(layer,
                         fmt::format("has no transmission from the other side, and it does not "
                                     "follow from {} because the basis has rings with an odd "
                                     "number of sectors; expected both",
                                     from));
                return;
            }
            warn(fmt::format("{} is not in the file; it follows from {} by reciprocity",
                             light == Side::front ? "Transmission Front" : "Transmission Back",
                             from));
            break;
        }
        for (const PartName& name : xml_part_names) {
            if (!part_of(parts_, name)) {
                warn(fmt::format("{} is not in the file; it is black", name.name));
            }
        }
    }

    void check_energy(const KlemsBsdf& bsdf) {
        for (const Side light : {Side::front, Side::back}) {
            double most = 0.0;
            const char* block = nullptr;
            for (const PartName& name : xml_part_names) {
                const auto& part = part_of(bsdf.parts(), name);
                if (name.light != light || !part) continue;
                if (first_block_.contains(name.name)) block = name.name;
                for (int patch = 0; patch < part->incident().patch_count(); ++patch) {
                    const Vec3 c = part->incident().centre(patch);
                    const Vec3 in(c.x(), -c.y(), light == Side::front ? c.z() : -c.z());
                    most = std::max(most, bsdf.directional_hemispherical(in));
                }
            }
            if (most <= 1.0) continue;
            const std::string found =
                fmt::format("light from the {} is scattered to {:.4f} of itself in one direction",
                            light == Side::front ? "front" : "back", most);
            if (most <= max_directional_hemispherical) {
                warn(found);
            } else {
                complain_at(block ? first_block_.at(block) : 0,
                            fmt::format("{}; expected at most {} for reflection and transmission "
                                        "together",
                                        found, max_directional_hemispherical));
            }
        }
    }

    void warn(const std::string& what) {
        warnings_.push_back(fmt::format("{}: {}", file_.path.string(), what));
    }

    const TextFile& file_;
    std::string text_;
    std::vector<std::size_t> line_starts_;
    Diagnostics errors_;
    std::vector<std::string> warnings_;
    std::map<std::string, KlemsBasis> bases_;
    std::map<std::string, std::ptrdiff_t> first_block_;  // where each part is
    std::vector<std::string> other_wavelengths_;
    MeasuredParts<KlemsMatrix> parts_;
};

}  // namespace

optics::MeasuredBsdf read_bsdf_xml(const TextFile& file) {
    return XmlReader(file).read();
}

}  // namespace lucerna::io
