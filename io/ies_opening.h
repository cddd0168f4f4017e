// How LM-63 encodes the shape of the luminous opening in the signs of its dimensions.
#pragma once

#include <cmath>
#include <optional>

#include "optics/light/opening.h"

namespace lucerna {

/// One row of the tables of openings: signs of width, length and height, and what they mean.
struct IesOpeningRow {
    int width, length, height;
    optics::Opening::Kind kind;
    optics::Opening::Axis axis = optics::Opening::Axis::z;
};

namespace ies_opening_tables {

using Kind = optics::Opening::Kind;
using Axis = optics::Opening::Axis;

// The same in all editions.
inline constexpr IesOpeningRow common[] = {
    {0, 0, 0, Kind::point}, {1, 1, 0, Kind::rectangle}, {1, 1, 1, Kind::box}};

// LM-63-1986 and 1991: a negative width is a diameter or minor axis.
inline constexpr IesOpeningRow of_1986[] = {{-1, 0, 0, Kind::ellipse},
                                            {-1, 0, 1, Kind::cylinder},
                                            {-1, 1, 0, Kind::ellipse},
                                            {-1, 1, 1, Kind::ellipsoid}};

// LM-63-1995: the same diameter is not repeated.
inline constexpr IesOpeningRow of_1995[] = {
    {-1, 0, 0, Kind::ellipse},           {-1, 0, -1, Kind::ellipsoid},
    {-1, 0, 1, Kind::cylinder},          {0, 1, -1, Kind::cylinder, Axis::x},
    {1, 0, -1, Kind::cylinder, Axis::y}, {-1, 1, 0, Kind::ellipse},
    {1, -1, 0, Kind::ellipse},           {-1, 1, 1, Kind::cylinder},
    {1, -1, 1, Kind::cylinder},          {-1, 1, -1, Kind::ellipsoid},
    {1, -1, -1, Kind::ellipsoid}};

// LM-63-2002 and 2019: a dimension is negative where the outline is round.
inline constexpr IesOpeningRow of_2002[] = {
    {-1, -1, 0, Kind::ellipse},           {-1, -1, 1, Kind::cylinder},
    {-1, -1, -1, Kind::ellipsoid},        {-1, 1, -1, Kind::cylinder, Axis::x},
    {1, -1, -1, Kind::cylinder, Axis::y}, {-1, 0, -1, Kind::ellipse, Axis::x}};

// In no edition, but found in files of wall luminaires: an upright rectangle.
inline constexpr IesOpeningRow extension[] = {{1, 0, 1, Kind::rectangle, Axis::x},
                                              {0, 1, 1, Kind::rectangle, Axis::y}};

}  // namespace ies_opening_tables

/// The opening that one of the tables gives for the dimensions, or nothing.
///
/// The length runs along the photometric horizontal C0-C180 (x), the width across it (y).
/// @param repeat_diameter  whether a zero stands for the other diameter (before 2002).
template <std::size_t N>
std::optional<optics::Opening> ies_opening(const IesOpeningRow (&table)[N], bool repeat_diameter,
                                           double width_m, double length_m, double height_m) {
    const auto sign = [](double value) { return (value > 0.0) - (value < 0.0); };
    for (const IesOpeningRow& row : table) {
        if (row.width != sign(width_m) || row.length != sign(length_m) ||
            row.height != sign(height_m)) {
            continue;
        }
        optics::Opening opening{
            row.kind, {std::abs(length_m), std::abs(width_m), std::abs(height_m)}, row.axis, {}};
        if (repeat_diameter && row.kind != optics::Opening::Kind::point) {
            double& x = opening.size_m.x();
            double& y = opening.size_m.y();
            if (x == 0.0) x = width_m < 0.0 ? y : opening.size_m.z();
            if (y == 0.0) y = opening.size_m.z();
        }
        if (row.kind == optics::Opening::Kind::box) {
            opening.side_heights_m.fill(opening.size_m.z());
        }
        return opening;
    }
    return std::nullopt;
}

}  // namespace lucerna
