// Shapes and their places.
#pragma once

#include "io/scene_context.h"
#include "optics/geometry/shape.h"

namespace lucerna::io {

/// Reads `place: {rotate: ..., move: ...}`; absent: where the shape says. Rotations come first, in
/// the order of their list, about the origin.
Placement read_placement(const YamlCursor& place);

/// Reads a shape and puts it in its place; nothing after a complaint.
/// @param types  the types that are accepted; empty: all.
std::optional<optics::Shape> read_shape(SceneContext& context, const YamlCursor& shape,
                                        const Placement& placement,
                                        const std::vector<std::string>& types = {});

/// Reads the keys of a rectangle from a map that may hold others: corner, edge_u, edge_v, or
/// center, size, normal, up.
optics::Rectangle read_rectangle(YamlMap& map);

}  // namespace lucerna::io
