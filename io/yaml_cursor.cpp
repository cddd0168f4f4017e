#include "io/yaml_cursor.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace lucerna::io {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string quoted_list(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
        text += "'" + words[i] + "'";
    }
    return text;
}

}  // namespace

std::string did_you_mean(const std::string& word, const std::vector<std::string>& known) {
    const std::string nearest = nearest_word(word, known);
    return nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest);
}

SourceLocation YamlCursor::where() const {
    return node_ ? SourceLocation{*file_, node_->line, node_->column} : SourceLocation{};
}

void YamlCursor::complain(const std::string& message) const {
    if (node_) diagnostics_->add(where(), path_.empty() ? message : path_ + ": " + message);
}

void YamlCursor::complain_about_kind(const std::string& expected) const {
    if (!node_) return;
    switch (node_->kind) {
        case YamlNode::Kind::null:
            return complain("is empty; expected " + expected);
        case YamlNode::Kind::scalar:
            return complain(fmt::format("found a single value; expected {}", expected));
        case YamlNode::Kind::sequence:
            return complain("found a list; expected " + expected);
        case YamlNode::Kind::map:
            return complain("found a map of keys; expected " + expected);
    }
}

std::optional<std::string> YamlCursor::word() const {
    if (!node_) return {};
    if (is_scalar() && !node_->text.empty()) return node_->text;
    if (is_scalar())
        complain("is empty; expected a single value");
    else
        complain_about_kind("a single value");
    return {};
}

std::optional<std::string> YamlCursor::choice(const std::vector<std::string>& words) const {
    const auto found = word();
    if (!found) return {};
    if (std::find(words.begin(), words.end(), *found) != words.end()) return found;
    complain(fmt::format("'{}' is not known; expected {}{}", *found, quoted_list(words),
                         did_you_mean(*found, words)));
    return {};
}

std::vector<YamlCursor> YamlCursor::list() const {
    std::vector<YamlCursor> entries;
    if (!node_) return entries;
    if (!is_sequence()) {
        complain_about_kind("a list");
        return entries;
    }
    for (std::size_t i = 0; i < node_->items.size(); ++i)
        entries.push_back(child(*node_->items[i], fmt::format("[{}]", i)));
    return entries;
}

YamlCursor YamlCursor::child(const YamlNode& node, const std::string& step) const {
    YamlCursor cursor(node, *file_, *diagnostics_, uncertain_);
    cursor.path_ = path_ + step;
    return cursor;
}

YamlCursor YamlCursor::exact() const {
    YamlCursor cursor = *this;
    cursor.uncertain_ = nullptr;
    return cursor;
}

YamlMap::YamlMap(const YamlCursor& cursor) : cursor_(cursor.is_map() ? cursor : YamlCursor()) {
    if (!cursor.is_map()) cursor.complain_about_kind("a map of keys, such as {key: value}");
}

YamlCursor YamlMap::find(const std::string& key) const {
    if (!cursor_) return {};
    const YamlNode& map = *cursor_.node_;
    for (std::size_t i = 0; i < map.keys.size(); ++i)
        if (map.keys[i].text == key)
            return cursor_.child(*map.items[i], (cursor_.path_.empty() ? "" : ".") + key);
    return {};
}

bool YamlMap::has(const std::string& key) const {
    return static_cast<bool>(find(key));
}

YamlCursor YamlMap::optional(const std::string& key) {
    known_.push_back(key);
    return find(key);
}

YamlCursor YamlMap::required(const std::string& key, const std::string& meaning) {
    const YamlCursor found = optional(key);
    if (!found)
        cursor_.complain(fmt::format("the key '{}' is missing{}", key,
                                     meaning.empty() ? "" : "; expected " + meaning));
    return found;
}

YamlMap::Chosen YamlMap::at_most_one(const std::vector<std::string>& keys) {
    Chosen chosen;
    for (const std::string& key : keys) {
        const YamlCursor found = optional(key);
        if (!found) continue;
        if (!chosen.key.empty()) {
            found.complain(fmt::format("cannot stand beside '{}'; expected only one of {}",
                                       chosen.key, quoted_list(keys)));
            continue;
        }
        chosen = {key, found};
    }
    return chosen;
}

YamlMap::Chosen YamlMap::exactly_one(const std::vector<std::string>& keys) {
    Chosen chosen = at_most_one(keys);
    if (chosen.key.empty())
        cursor_.complain(fmt::format("one of the keys {} is missing", quoted_list(keys)));
    return chosen;
}

std::vector<YamlMap::Entry> YamlMap::entries() const {
    std::vector<Entry> result;
    if (!cursor_) return result;
    const YamlNode& map = *cursor_.node_;
    for (std::size_t i = 0; i < map.keys.size(); ++i)
        result.push_back(
            {map.keys[i].text,
             cursor_.child(*map.items[i], (cursor_.path_.empty() ? "" : ".") + map.keys[i].text)});
    return result;
}

void YamlMap::no_other_keys() const {
    if (!cursor_) return;
    for (const YamlNode::Key& key : cursor_.node_->keys) {
        if (std::find(known_.begin(), known_.end(), key.text) != known_.end()) continue;
        const std::string hint = did_you_mean(key.text, known_);
        cursor_.diagnostics_->add(
            {*cursor_.file_, key.line, key.column},
            fmt::format("{}unknown key '{}'{}", cursor_.path_.empty() ? "" : cursor_.path_ + ": ",
                        key.text, hint.empty() ? "; expected " + quoted_list(known_) : hint));
    }
}

std::optional<Quantity> read_quantity(const YamlCursor& cursor, const Dimension& dimension,
                                      Accept accept) {
    if (!cursor) return {};
    if (!cursor.is_scalar()) {
        cursor.complain_about_kind(
            fmt::format("{} such as \"{}\"", dimension.name, dimension.example));
        return {};
    }
    const auto text = cursor.word();
    if (!text) return {};
    const auto accepted = [&](double value) {
        return !(accept != Accept::any && value < 0.0) &&
               !(accept == Accept::positive && value == 0.0) &&
               !(accept == Accept::up_to_one && value > 1.0);
    };
    try {
        const auto [quantity, uncertainty] = parse_uncertain_quantity(*text, dimension);
        const double value = quantity.value;
        if (accept != Accept::any && value < 0.0)
            cursor.complain(fmt::format("'{}' is negative", *text));
        else if (accept == Accept::positive && value == 0.0)
            cursor.complain(fmt::format("'{}' must be more than zero", *text));
        else if (accept == Accept::up_to_one && value > 1.0)
            cursor.complain(fmt::format("'{}' is more than 1 (100 %)", *text));
        else if (!uncertainty)
            return quantity;
        else if (!cursor.uncertain())
            cursor.complain(
                fmt::format("'{}' states an uncertainty, which means nothing here", *text));
        else if (!accepted(value + *uncertainty) && !accepted(value - *uncertainty))
            cursor.complain(fmt::format(
                "'{}' has an uncertainty that leads to what is not accepted, up and down", *text));
        else
            return Quantity{cursor.uncertain()->add(
                                {cursor.path(), cursor.where().line, cursor.where().column, value,
                                 *uncertainty, std::string(quantity.base),
                                 accepted(value + *uncertainty) ? *uncertainty : -*uncertainty}),
                            quantity.base};
    } catch (const std::invalid_argument& error) {
        cursor.complain(error.what());
    }
    return {};
}

double read_value(const YamlCursor& cursor, const Dimension& dimension, Accept accept) {
    const auto quantity = read_quantity(cursor, dimension, accept);
    return quantity ? quantity->value : nan;
}

namespace {

Vec3 read_triple(const YamlCursor& cursor, const Dimension& dimension,
                 const std::string& expected) {
    Vec3 triple = Vec3::Constant(nan);
    if (!cursor) return triple;
    if (!cursor.is_sequence()) {
        cursor.complain_about_kind(expected);
        return triple;
    }
    const auto entries = cursor.list();
    if (entries.size() != 3) {
        cursor.complain(fmt::format("has {} entries; expected {}", entries.size(), expected));
        return triple;
    }
    for (std::size_t i = 0; i < 3; ++i)
        triple[static_cast<Eigen::Index>(i)] = read_value(entries[i], dimension);
    return triple;
}

}  // namespace

Vec3 read_lengths(const YamlCursor& cursor) {
    return read_triple(cursor, dimension::length, "three lengths such as [0 mm, 20 mm, 1 m]");
}

Vec3 read_direction(const YamlCursor& cursor) {
    if (cursor.is_scalar()) {
        const auto word = cursor.choice({"x", "-x", "y", "-y", "z", "-z"});
        if (!word) return Vec3::Constant(nan);
        return (word->front() == '-' ? -1.0 : 1.0) * Vec3::Unit(word->back() - 'x');
    }
    const Vec3 v =
        read_triple(cursor, dimension::number,
                    "a direction of three numbers such as [0, 0, 1], or an axis such as -z");
    if (v.norm() == 0.0) {
        cursor.complain("a direction cannot be [0, 0, 0]");
        return Vec3::Constant(nan);
    }
    return v.stableNormalized();
}

std::uint64_t read_count(const YamlCursor& cursor, std::uint64_t least, std::uint64_t most) {
    const auto text = cursor.word();
    if (!text) return least;
    std::uint64_t count = 0;
    const char* end = text->data() + text->size();
    const auto [stop, error] = std::from_chars(text->data(), end, count);
    if (error == std::errc() && stop == end && count >= least && count <= most) return count;
    cursor.complain(fmt::format("'{}' is not a whole number from {} to {}", *text, least, most));
    return least;
}

}  // namespace lucerna::io
