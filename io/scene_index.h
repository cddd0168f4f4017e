// Index of refraction and absorption of media in a scene file.
#pragma once

#include "io/scene_context.h"
#include "spectral/spectrum.h"

namespace lucerna::io {

/// Complex index of refraction n + ik.
struct ComplexIndex {
    spectral::Spectrum n;
    std::optional<spectral::Spectrum> k;  ///< nothing: the file says nothing about it
};

/// Reads {file: ...}, a file of the refractiveindex.info database; nothing after a complaint.
std::optional<ComplexIndex> read_index_file(SceneContext& context, const YamlCursor& cursor);

/// Reads a number, {file: ...}, {file: ..., column: ...} or {points: ...}.
std::optional<ComplexIndex> read_index(SceneContext& context, const YamlCursor& cursor);

/// Reads an absorption coefficient [1/m]: "0.3 1/m", a spectrum, {transmittance, thickness} of the
/// inside of a sample (without the reflection at its faces), or 'from index file'.
std::optional<spectral::Spectrum> read_absorption(SceneContext& context, const YamlCursor& cursor,
                                                  const std::optional<ComplexIndex>& index);

}  // namespace lucerna::io
