#include "io/yaml_tree.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <fstream>
#include <map>
#include <optional>
#include <sstream>

namespace lucerna::io {
namespace {

/// Builds the tree from the parser's events.
class TreeBuilder : public YAML::EventHandler {
public:
    TreeBuilder(const std::string& file, Diagnostics& diagnostics, const YamlLimits& limits)
        : file_(file), diagnostics_(diagnostics), limits_(limits) {}

    std::shared_ptr<const YamlNode> root() const { return root_; }

    void OnDocumentStart(const YAML::Mark&) override {}
    void OnDocumentEnd() override {}

    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        attach(new_node(YamlNode::Kind::null, mark), anchor);
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        refuse_tag(mark, tag);
        auto node = new_node(YamlNode::Kind::scalar, mark);
        node->text = value;
        attach(std::move(node), anchor);
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        const auto found = anchors_.find(anchor);
        if (found == anchors_.end())
            throw InputError(place(mark), "an alias cannot stand inside its own anchor");
        const auto& node = found->second;
        // Shared, so that it costs no memory; but whoever walks the tree sees it unfolded.
        count(node->size, mark);
        add_to_parent(node, mark.line + 1, mark.column + 1);
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value) override {
        open(YamlNode::Kind::sequence, mark, tag, anchor);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value) override {
        open(YamlNode::Kind::map, mark, tag, anchor);
    }
    void OnMapEnd() override { close(); }

private:
    struct Open {
        std::shared_ptr<YamlNode> node;
        YAML::anchor_t anchor;
        std::optional<YamlNode::Key> key;  ///< of a map: read, and its value not yet
        bool drop_value = false;           ///< the key is a duplicate or not a word
        std::map<std::string, int> lines;  ///< of a map: where each key stands
    };

    SourceLocation place(const YAML::Mark& mark) const {
        return {file_, mark.line + 1, mark.column + 1};
    }

    void count(std::size_t nodes, const YAML::Mark& mark) {
        node_count_ += nodes;
        if (node_count_ > limits_.nodes)
            throw InputError(place(mark),
                             fmt::format("the document has more than {} entries", limits_.nodes));
    }

    std::shared_ptr<YamlNode> new_node(YamlNode::Kind kind, const YAML::Mark& mark) {
        count(1, mark);
        auto node = std::make_shared<YamlNode>();
        node->kind = kind;
        node->line = mark.line + 1;
        node->column = mark.column + 1;
        return node;
    }

    // "?" is what yaml-cpp calls a plain scalar, "!" a quoted one.
    void refuse_tag(const YAML::Mark& mark, const std::string& tag) {
        if (!tag.empty() && tag != "?" && tag != "!")
            diagnostics_.add(place(mark),
                             fmt::format("the YAML tag '{}' has no meaning here", tag));
    }

    void open(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag,
              YAML::anchor_t anchor) {
        refuse_tag(mark, tag);
        if (open_.size() >= limits_.depth)
            throw InputError(place(mark),
                             fmt::format("nested deeper than {} levels", limits_.depth));
        open_.push_back({new_node(kind, mark), anchor, {}, false, {}});
    }

    void close() {
        const Open done = std::move(open_.back());
        open_.pop_back();
        attach(done.node, done.anchor);
    }

    void attach(std::shared_ptr<YamlNode> node, YAML::anchor_t anchor) {
        if (anchor != 0) anchors_[anchor] = node;
        const int line = node->line, column = node->column;
        add_to_parent(std::move(node), line, column);
    }

    void add_to_parent(std::shared_ptr<const YamlNode> node, int line, int column) {
        if (open_.empty()) {
            root_ = std::move(node);
            return;
        }
        Open& parent = open_.back();
        if (parent.node->kind == YamlNode::Kind::map && !parent.key) {
            begin_entry(parent, *node, line, column);
            return;
        }
        if (!parent.drop_value) {
            if (parent.key) parent.node->keys.push_back(std::move(*parent.key));
            parent.node->size += node->size;
            parent.node->items.push_back(std::move(node));
        }
        parent.key.reset();
        parent.drop_value = false;
    }

    void begin_entry(Open& parent, const YamlNode& key, int line, int column) {
        parent.key = YamlNode::Key{key.text, line, column};
        parent.drop_value = true;
        if (key.kind != YamlNode::Kind::scalar) {
            diagnostics_.add({file_, line, column}, "a key must be a word");
            return;
        }
        const auto [earlier, is_new] = parent.lines.emplace(key.text, line);
        if (!is_new)
            diagnostics_.add({file_, line, column},
                             fmt::format("duplicate key '{}', first given in line {}", key.text,
                                         earlier->second));
        parent.drop_value = !is_new;
    }

    std::string file_;
    Diagnostics& diagnostics_;
    YamlLimits limits_;
    std::size_t node_count_ = 0;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, std::shared_ptr<const YamlNode>> anchors_;
    std::shared_ptr<const YamlNode> root_;
};

}  // namespace

std::shared_ptr<const YamlNode> parse_yaml(const std::string& text, const std::string& file,
                                           Diagnostics& diagnostics, const YamlLimits& limits) {
    if (text.size() > limits.bytes)
        throw InputError(
            {file}, fmt::format("has {} bytes; at most {} are read", text.size(), limits.bytes));
    TreeBuilder builder(file, diagnostics, limits);
    try {
        std::istringstream stream(text);
        YAML::Parser parser(stream);
        if (!parser.HandleNextDocument(builder) || !builder.root())
            throw InputError({file}, "is empty; expected a YAML document");
        const auto root = builder.root();
        TreeBuilder second(file, diagnostics, limits);
        if (parser.HandleNextDocument(second))
            throw InputError({file, second.root() ? second.root()->line : 0, 1},
                             "a second YAML document; a file holds one");
        return root;
    } catch (const YAML::Exception& error) {
        const bool placed = !error.mark.is_null();
        throw InputError(
            {file, placed ? error.mark.line + 1 : 1, placed ? error.mark.column + 1 : 1},
            "not valid YAML: " + error.msg);
    }
}

std::shared_ptr<const YamlNode> read_yaml_file(const std::filesystem::path& path,
                                               Diagnostics& diagnostics, const YamlLimits& limits) {
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path, failure))
        throw InputError({path.string()}, "no such file");
    const auto bytes = std::filesystem::file_size(path, failure);
    if (failure) throw InputError({path.string()}, "cannot be read: " + failure.message());
    if (bytes > limits.bytes)
        throw InputError({path.string()},
                         fmt::format("has {} bytes; at most {} are read", bytes, limits.bytes));
    std::ifstream stream(path, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
    if (!stream) throw InputError({path.string()}, "cannot be read");
    return parse_yaml(text, path.string(), diagnostics, limits);
}

}  // namespace lucerna::io
