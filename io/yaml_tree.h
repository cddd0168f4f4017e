// A YAML document as a tree in which every node knows where it stands.
//
// The tree is built from the events of yaml-cpp's parser, not from YAML::Node, because that keeps
// duplicate keys silently, hides aliases, and can be made to unfold without bound.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/diagnostics.h"

namespace lucerna::io {

/// A node of the document. Aliases share the node of their anchor.
struct YamlNode {
    enum class Kind { null, scalar, sequence, map };
    /// A key of a map, with its place.
    struct Key {
        std::string text;
        int line = 0, column = 0;
    };

    Kind kind = Kind::null;
    int line = 0, column = 0;                            ///< from 1
    std::string text;                                    ///< of a scalar
    std::vector<Key> keys;                               ///< of a map, in the order of the file
    std::vector<std::shared_ptr<const YamlNode>> items;  ///< of a sequence, or the values of a map
    std::size_t size = 1;  ///< nodes of this subtree with all aliases unfolded
};

/// What a document may grow to; a document of a user is far below.
struct YamlLimits {
    std::size_t bytes = 64u << 20;
    std::size_t nodes = 1u << 20;  ///< with all aliases unfolded
    std::size_t depth = 64;
};

/// Parses the only document of `text`.
///
/// Duplicate keys and tags go to `diagnostics` and the first entry counts. Throws InputError where
/// the text is not YAML, holds no or a second document, or exceeds the limits.
/// @param file  name used in the places of complaints.
std::shared_ptr<const YamlNode> parse_yaml(const std::string& text, const std::string& file,
                                           Diagnostics& diagnostics, const YamlLimits& limits = {});

/// Reads a file of limited size and parses it.
std::shared_ptr<const YamlNode> read_yaml_file(const std::filesystem::path& path,
                                               Diagnostics& diagnostics,
                                               const YamlLimits& limits = {});

}  // namespace lucerna::io
