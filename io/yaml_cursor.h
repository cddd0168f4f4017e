// A place in a YAML document, from which typed values are read and at which complaints are made.
//
// A complaint never stops the reading, so that all errors of a file are found at once. What could
// not be read is "absent" (a cursor that is false) or NaN; reading from an absent place gives
// absent again, without another complaint, and comparisons with NaN are false, so that nothing
// follows from one error. Nobody uses such values: the reader of the file throws all complaints at
// its end.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "core/diagnostics.h"
#include "core/vector.h"
#include "io/quantity.h"
#include "io/uncertain_inputs.h"
#include "io/yaml_tree.h"

namespace lucerna::io {

class YamlCursor {
public:
    /// An absent place.
    YamlCursor() = default;
    /// The root of a document; `file` and `diagnostics` must outlive all its cursors.
    /// @param uncertain  takes down the numbers that are stated with an uncertainty, and outlives
    ///     the cursors, too; without it such numbers are errors.
    YamlCursor(const YamlNode& root, const std::string& file, Diagnostics& diagnostics,
               UncertainInputs* uncertain = nullptr)
        : node_(&root), file_(&file), diagnostics_(&diagnostics), uncertain_(uncertain) {}

    explicit operator bool() const { return node_ != nullptr; }
    bool is_scalar() const { return node_ && node_->kind == YamlNode::Kind::scalar; }
    bool is_sequence() const { return node_ && node_->kind == YamlNode::Kind::sequence; }
    bool is_map() const { return node_ && node_->kind == YamlNode::Kind::map; }

    SourceLocation where() const;
    /// Keys from the root: "objects[2].shape.radius".
    const std::string& path() const { return path_; }
    /// Adds a complaint about this place; does nothing at an absent one.
    void complain(const std::string& message) const;
    void complain_about_kind(const std::string& expected) const;

    /// Text of a scalar that is not empty.
    std::optional<std::string> word() const;
    /// One of the words; the nearest one is proposed else.
    std::optional<std::string> choice(const std::vector<std::string>& words) const;
    /// Entries of a sequence.
    std::vector<YamlCursor> list() const;

    /// The same place, where numbers with an uncertainty are errors.
    YamlCursor exact() const;
    UncertainInputs* uncertain() const { return uncertain_; }

private:
    friend class YamlMap;
    YamlCursor child(const YamlNode& node, const std::string& step) const;

    const YamlNode* node_ = nullptr;
    const std::string* file_ = nullptr;
    Diagnostics* diagnostics_ = nullptr;
    UncertainInputs* uncertain_ = nullptr;
    std::string path_;
};

/// The entries of a map. Keys that nobody asked for are errors, see no_other_keys().
class YamlMap {
public:
    /// Complains if there is something else than a map.
    explicit YamlMap(const YamlCursor& cursor);

    const YamlCursor& cursor() const { return cursor_; }
    bool has(const std::string& key) const;
    YamlCursor optional(const std::string& key);
    /// Complains if the key is missing. `meaning` says what to write: "a length such as 10 mm".
    YamlCursor required(const std::string& key, const std::string& meaning = "");
    /// The one of the keys that is given; complains if none or several are.
    struct Chosen {
        std::string key;  ///< empty: none
        YamlCursor value;
    };
    Chosen exactly_one(const std::vector<std::string>& keys);
    Chosen at_most_one(const std::vector<std::string>& keys);

    /// All entries, for maps whose keys are names that the user chooses.
    struct Entry {
        std::string key;
        YamlCursor value;
    };
    std::vector<Entry> entries() const;

    /// Complains about every key that was not asked for, with the nearest one that was.
    void no_other_keys() const;

private:
    YamlCursor find(const std::string& key) const;

    YamlCursor cursor_;
    std::vector<std::string> known_;
};

/// "; did you mean 'height'?" with the nearest of the known words, or "" if none is near.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& known);

/// What values of a number are accepted.
enum class Accept { any, not_negative, positive, up_to_one };

/// A number with its unit, in the dimension's base unit; NaN at an absent place or after a
/// complaint. Where an uncertainty is stated, it is noted, and accepted if one end of the interval
/// is.
double read_value(const YamlCursor& cursor, const Dimension& dimension,
                  Accept accept = Accept::any);
/// The same for dimensions of several base units; nothing after a complaint.
std::optional<Quantity> read_quantity(const YamlCursor& cursor, const Dimension& dimension,
                                      Accept accept = Accept::any);
/// Three lengths: a position or an edge [m].
Vec3 read_lengths(const YamlCursor& cursor);
/// A unit vector from three numbers without unit, or one of the words x, -x, y, -y, z, -z, up,
/// down.
Vec3 read_direction(const YamlCursor& cursor);
/// A whole number in [least, most]; `least` after a complaint.
std::uint64_t read_count(const YamlCursor& cursor, std::uint64_t least, std::uint64_t most);

}  // namespace lucerna::io
