// PLY, text and binary of either byte order (Turk, "The PLY polygon file format", 1994): the
// elements vertex (x, y, z) and face (vertex_indices); all other elements and properties are read
// past.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>

#include "io/mesh_source.h"

namespace lucerna::io {

namespace {

enum class Encoding { text, little_endian, big_endian };

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct ScalarName {
    std::string_view name, older_name;
    Scalar type;
    std::size_t bytes;
};
constexpr std::array<ScalarName, 8> scalar_names{{{"int8", "char", Scalar::int8, 1},
                                                  {"uint8", "uchar", Scalar::uint8, 1},
                                                  {"int16", "short", Scalar::int16, 2},
                                                  {"uint16", "ushort", Scalar::uint16, 2},
                                                  {"int32", "int", Scalar::int32, 4},
                                                  {"uint32", "uint", Scalar::uint32, 4},
                                                  {"float32", "float", Scalar::float32, 4},
                                                  {"float64", "double", Scalar::float64, 8}}};

std::size_t bytes_of(Scalar type) {
    return scalar_names[static_cast<std::size_t>(type)].bytes;
}

struct Property {
    std::string name;
    Scalar type = Scalar::float32;
    std::optional<Scalar> count_type;  ///< of a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
    std::size_t place = 0;

    /// Number of the property, or of none.
    std::optional<std::size_t> find(std::string_view property) const {
        for (std::size_t i = 0; i < properties.size(); ++i)
            if (properties[i].name == property) return i;
        return std::nullopt;
    }
    /// The fewest bytes that an entry can take.
    std::size_t least_bytes(Encoding encoding) const {
        std::size_t sum = 0;
        for (const Property& property : properties)
            sum += encoding == Encoding::text
                       ? 2
                       : bytes_of(property.count_type.value_or(property.type));
        return sum;
    }
};

struct Header {
    Encoding encoding = Encoding::text;
    std::vector<Element> elements;
    std::size_t end = 0;
};

// ---- header ----

class HeaderReader {
public:
    explicit HeaderReader(MeshSource& source) : source_(source), words_(source.bytes(), 0) {}

    Header read() {
        const MeshWord magic = words_.next_in_line();
        if (magic.text != "ply") {
            fail(magic, "a PLY file, which begins with \"ply\"");
        }
        bool has_format = false;
        while (words_.next_line()) {
            const MeshWord keyword = words_.next_in_line();
            if (keyword.text == "comment" || keyword.text == "obj_info" || keyword.empty())
                continue;
            if (keyword.text == "end_header") {
                if (!has_format) fail(keyword, "a line \"format\" before it");
                words_.next_line();
                header_.end = words_.offset();
                return header_;
            }
            if (keyword.text == "format") {
                read_format();
                has_format = true;
            } else if (keyword.text == "element") {
                read_element();
            } else if (keyword.text == "property" && !header_.elements.empty()) {
                read_property();
            } else {
                fail(keyword, "format, element, property, comment, obj_info or end_header");
            }
        }
        fail({{}, words_.offset()}, "end_header");
    }

private:
    [[noreturn]] void fail(const MeshWord& word, const std::string& expected) {
        source_.complain(
            word.offset,
            fmt::format("{}; expected {}",
                        word.empty() ? "nothing here" : "found " + shown(word.text), expected));
        source_.throw_if_any();
        std::abort();
    }

    void read_format() {
        const MeshWord name = words_.next_in_line();
        if (name.text == "ascii")
            header_.encoding = Encoding::text;
        else if (name.text == "binary_little_endian")
            header_.encoding = Encoding::little_endian;
        else if (name.text == "binary_big_endian")
            header_.encoding = Encoding::big_endian;
        else
            fail(name, "ascii, binary_little_endian or binary_big_endian");
        const MeshWord version = words_.next_in_line();
        if (version.text != "1.0") fail(version, "version 1.0");
    }

    void read_element() {
        const MeshWord name = words_.next_in_line();
        if (name.empty()) fail(name, "the name of an element");
        const MeshWord count = words_.next_in_line();
        const auto number = parse_index(count.text);
        if (!number || *number < 0) fail(count, "the number of entries of the element");
        header_.elements.push_back(
            {std::string(name.text), static_cast<std::uint64_t>(*number), {}, count.offset});
    }

    Scalar read_type() {
        const MeshWord word = words_.next_in_line();
        for (const ScalarName& name : scalar_names)
            if (word.text == name.name || word.text == name.older_name) return name.type;
        fail(word,
             "a type: char, uchar, short, ushort, int, uint, float, double, int8, uint8, "
             "int16, uint16, int32, uint32, float32 or float64");
    }

    void read_property() {
        Property property;
        WordReader ahead = words_;
        if (ahead.next_in_line().text == "list") {
            words_ = ahead;
            property.count_type = read_type();
        }
        property.type = read_type();
        const MeshWord name = words_.next_in_line();
        if (name.empty()) fail(name, "the name of the property");
        property.name = name.text;
        header_.elements.back().properties.push_back(property);
    }

    MeshSource& source_;
    WordReader words_;
    Header header_;
};

// ---- entries ----

/// Reads one number after the other, in any encoding. All numbers of PLY are exact as a double.
class ValueReader {
public:
    ValueReader(const MeshSource& source, const Header& header)
        : bytes_(source.bytes()),
          encoding_(header.encoding),
          words_(bytes_, header.end),
          offset_(header.end) {}

    /// Where the value read last began.
    std::size_t place() const { return place_; }
    /// Where the next value begins.
    std::size_t next_place() const {
        if (encoding_ != Encoding::text) return offset_;
        WordReader ahead = words_;
        return ahead.next().offset;
    }
    std::size_t rest() const {
        return bytes_.size() - (encoding_ == Encoding::text ? words_.offset() : offset_);
    }
    bool at_end() const { return at_end_; }
    std::string_view word() const { return word_; }

    /// The value, or nothing at the end of the file or if the text is no number.
    std::optional<double> next(Scalar type) {
        if (encoding_ == Encoding::text) {
            const MeshWord word = words_.next();
            place_ = word.offset;
            word_ = word.text;
            at_end_ = word.empty();
            return parse_coordinate(word.text);
        }
        place_ = offset_;
        if (rest() < bytes_of(type)) {
            at_end_ = true;
            return std::nullopt;
        }
        switch (type) {
            case Scalar::int8:
                return integer<std::int8_t, std::uint8_t>();
            case Scalar::uint8:
                return integer<std::uint8_t, std::uint8_t>();
            case Scalar::int16:
                return integer<std::int16_t, std::uint16_t>();
            case Scalar::uint16:
                return integer<std::uint16_t, std::uint16_t>();
            case Scalar::int32:
                return integer<std::int32_t, std::uint32_t>();
            case Scalar::uint32:
                return integer<std::uint32_t, std::uint32_t>();
            case Scalar::float32:
                return static_cast<double>(std::bit_cast<float>(raw<std::uint32_t>()));
            case Scalar::float64:
                return std::bit_cast<double>(raw<std::uint64_t>());
        }
        return std::nullopt;
    }

private:
    template <std::unsigned_integral Bits>
    Bits raw() {
        Bits value = 0;
        for (std::size_t i = 0; i < sizeof(Bits); ++i) {
            const std::size_t shift =
                8 * (encoding_ == Encoding::little_endian ? i : sizeof(Bits) - 1 - i);
            const auto byte = static_cast<unsigned char>(bytes_[offset_ + i]);
            value = static_cast<Bits>(value | static_cast<Bits>(Bits{byte} << shift));
        }
        offset_ += sizeof(Bits);
        return value;
    }
    template <typename Integer, typename Bits>
    double integer() {
        return static_cast<double>(static_cast<Integer>(raw<Bits>()));
    }

    std::string_view bytes_;
    Encoding encoding_;
    WordReader words_;
    std::size_t offset_;
    std::size_t place_ = 0;
    std::string_view word_;
    bool at_end_ = false;
};

class BodyReader {
public:
    BodyReader(MeshSource& source, const Header& header)
        : source_(source), header_(header), values_(source, header) {}

    MeshParts read() {
        for (const Element& element : header_.elements) {
            check_size(element);
            if (element.name == "vertex")
                read_vertices(element);
            else if (element.name == "face")
                read_faces(element);
            else
                for (std::uint64_t i = 0; i < element.count; ++i) read_entry(element, i, {});
        }
        // Faces may come before vertices, so they are put together last.
        for (const Face& face : faces_) add_face(face);
        return std::move(parts_);
    }

private:
    struct Face {
        std::size_t first, count, place;
    };

    [[noreturn]] void fail(std::size_t place, const std::string& message) {
        source_.complain(place, message);
        source_.throw_if_any();
        std::abort();
    }

    /// Before memory is taken for entries that the file cannot hold.
    void check_size(const Element& element) {
        const std::size_t least = std::max<std::size_t>(element.least_bytes(header_.encoding), 1);
        if (element.count > values_.rest() / least + 1)
            fail(element.place,
                 fmt::format("{} entries of \"{}\" do not fit into the {} bytes that "
                             "are left of the file",
                             element.count, element.name, values_.rest()));
    }

    double next(const Element& element, std::uint64_t entry, const Property& property,
                Scalar type) {
        const auto value = values_.next(type);
        if (value) return *value;
        if (values_.at_end())
            fail(values_.place(), fmt::format("the file ends within {} {} of {}", element.name,
                                              entry + 1, element.count));
        fail(values_.place(), fmt::format("found {}; expected {} of {} {}", shown(values_.word()),
                                          property.name, element.name, entry + 1));
    }

    /// Reads all properties of an entry and hands take(property number, value, place) each number.
    template <typename Take>
    void read_properties(const Element& element, std::uint64_t entry, Take&& take) {
        for (std::size_t i = 0; i < element.properties.size(); ++i) {
            const Property& property = element.properties[i];
            double count = 1.0;
            if (i == 0) entry_place_ = values_.next_place();
            if (property.count_type) {
                count = next(element, entry, property, *property.count_type);
                if (!(count >= 0.0) || count != std::floor(count))
                    fail(values_.place(),
                         fmt::format("{} is no length of the list {}", count, property.name));
                if (count > static_cast<double>(values_.rest()))
                    fail(values_.place(),
                         fmt::format("a list {} of {} numbers does not fit into the {} bytes that "
                                     "are left of the file",
                                     property.name, count, values_.rest()));
            }
            for (double k = 0.0; k < count; ++k)
                take(i, next(element, entry, property, property.type));
        }
    }

    struct Ignore {
        void operator()(std::size_t, double) const {}
    };
    void read_entry(const Element& element, std::uint64_t entry, Ignore ignore) {
        read_properties(element, entry, ignore);
    }

    void read_vertices(const Element& element) {
        std::array<std::size_t, 3> axes;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::string name(1, "xyz"[axis]);
            const auto found = element.find(name);
            if (!found || element.properties[*found].count_type)
                fail(element.place, "the vertices have no property " + name);
            axes[axis] = *found;
        }
        parts_.vertices.reserve(element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            Vec3 p = Vec3::Zero();
            read_properties(element, i, [&](std::size_t property, double value) {
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    if (property != axes[axis]) continue;
                    if (!std::isfinite(value))
                        source_.complain(values_.place(),
                                         fmt::format("coordinate {} of vertex {} is not finite",
                                                     "xyz"[axis], i + 1));
                    p[static_cast<Eigen::Index>(axis)] = value;
                }
            });
            parts_.vertices.push_back(p);
        }
    }

    void read_faces(const Element& element) {
        auto indices = element.find("vertex_indices");
        if (!indices) indices = element.find("vertex_index");
        if (!indices || !element.properties[*indices].count_type)
            fail(element.place, "the faces have no list vertex_indices or vertex_index");
        faces_.reserve(element.count);
        for (std::uint64_t i = 0; i < element.count; ++i) {
            Face face{corners_.size(), 0, 0};
            read_properties(element, i, [&](std::size_t property, double value) {
                if (property != *indices) return;
                corners_.push_back(value);
                ++face.count;
            });
            face.place = entry_place_;
            faces_.push_back(face);
        }
    }

    void add_face(const Face& face) {
        if (face.count < 3) {
            source_.complain(face.place,
                             fmt::format("a face has {} corners; expected 3 or more", face.count));
            return;
        }
        std::vector<std::uint32_t> polygon;
        for (std::size_t i = face.first; i < face.first + face.count; ++i) {
            const double index = corners_[i];
            const bool exists = index >= 0.0 && index == std::floor(index) &&
                                index < static_cast<double>(parts_.vertices.size());
            if (!exists) {
                source_.complain(face.place,
                                 fmt::format("this face refers to vertex {}; the file has {}, "
                                             "counted from 0",
                                             index, parts_.vertices.size()));
                return;
            }
            polygon.push_back(static_cast<std::uint32_t>(index));
        }
        parts_.add_polygon(polygon, face.place, source_);
    }

    MeshSource& source_;
    const Header& header_;
    ValueReader values_;
    std::size_t entry_place_ = 0;
    MeshParts parts_;
    std::vector<double> corners_;
    std::vector<Face> faces_;
};

}  // namespace

MeshParts read_ply(MeshSource& source) {
    const Header header = HeaderReader(source).read();
    for (const std::string_view needed : {"vertex", "face"})
        if (std::none_of(header.elements.begin(), header.elements.end(),
                         [&](const Element& element) { return element.name == needed; }))
            source.complain(0, fmt::format("has no element \"{}\"", needed));
    source.throw_if_any();
    if (header.encoding != Encoding::text) source.set_binary();
    return BodyReader(source, header).read();
}

}  // namespace lucerna::io
