#include "io/ies_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "optics/light/goniometer.h"

namespace lucerna {
namespace {

FullCircle of_type_c(PlaneTable table, const SourceLocation& place) {
    FullCircle circle;
    const auto complete = [&](const char* symmetry, PlaneTable planes) {
        circle.symmetry = symmetry;
        circle.table = std::move(planes);
        return circle;
    };
    const double first = table.c_deg.front();
    double last = table.c_deg.back();
    if (table.c_deg.size() == 1) {
        if (first != 0.0)
            circle.deviations.push_back(fmt::format("the single plane is at {}, not at 0", first));
        table.c_deg = {0.0};
        return complete("rotational", std::move(table));
    }
    if (first == 90.0 && last == 270.0) {
        return complete("C90-C270", mirrored_at_c90(table));
    }
    if (first == 0.0 && last > 180.0 && last < 360.0) {
        double widest = 0.0;
        for (std::size_t i = 1; i < table.c_deg.size(); ++i) {
            widest = std::max(widest, table.c_deg[i] - table.c_deg[i - 1]);
        }
        if (360.0 - last <= 1.01 * widest) {
            circle.deviations.push_back(
                fmt::format("the last plane is at {}; the plane at 0 is taken for "
                            "the missing one at 360",
                            last));
            table.add_plane(360.0, std::vector<double>(table.values.front()));
            last = 360.0;
        }
    }
    if (first == 0.0 && last == 360.0) {
        return complete("none", std::move(table));
    }
    if (first == 0.0 && last == 180.0) {
        return complete("C0-C180", mirrored_at_last_plane(table));
    }
    if (first == 0.0 && last == 90.0) {
        return complete("C0-C180 and C90-C270",
                        mirrored_at_last_plane(mirrored_at_last_plane(table)));
    }
    throw InputError(
        place,
        fmt::format(
            "horizontal angles from {} to {}; expected 0 alone, or from 0 to 90, 180 or 360, "
            "or from 90 to 270",
            first, last));
}

// Bilinear in the goniometer's own angles, evaluated on C planes at half the spacing of the file.
FullCircle of_type_a_or_b(char type, const PlaneTable& stored, const SourceLocation& place) {
    const std::vector<double>& horizontal_deg = stored.c_deg;
    const bool mirrored = horizontal_deg.front() == 0.0;
    const double reach = horizontal_deg.back();
    if (horizontal_deg.size() < 2 || !(reach > 0.0) || reach > 180.0 ||
        (!mirrored && horizontal_deg.front() != -reach)) {
        throw InputError(
            place, fmt::format("horizontal angles from {} to {}; expected -90 to 90, or 0 to 90 "
                               "for photometric type {}",
                               horizontal_deg.front(), reach, type));
    }
    FullCircle circle;
    if (reach != 90.0) {
        circle.deviations.push_back(
            fmt::format("the last horizontal angle is {}, not 90; the luminaire is "
                        "taken as dark outside",
                        reach));
    }
    circle.symmetry = mirrored ? "H" : "none";

    const optics::GoniometerTable source(
        type == 'A' ? optics::GoniometerType::a : optics::GoniometerType::b, mirrored,
        horizontal_deg, stored.gamma_deg, stored.values);
    const int steps_per_degree =
        std::clamp(static_cast<int>(std::ceil(2.0 / source.finest_spacing_deg())), 1, 4);
    PlaneTable& table = circle.table;
    for (int g = 0; g <= 180 * steps_per_degree; ++g) {
        table.gamma_deg.push_back(static_cast<double>(g) / steps_per_degree);
    }
    for (int c = 0; c <= 360 * steps_per_degree; ++c) {
        const double c_deg = static_cast<double>(c) / steps_per_degree;
        std::vector<double> plane;
        for (const double gamma_deg : table.gamma_deg) {
            plane.push_back(source.at(optics::IntensityDistribution::direction(c_deg, gamma_deg)));
        }
        table.add_plane(c_deg, plane);
    }
    circle.notes.push_back(
        fmt::format("photometric type {}, resampled onto C planes every {:g} deg", type,
                    1.0 / steps_per_degree));
    return circle;
}

}  // namespace

FullCircle full_circle(char type, const PlaneTable& stored, const SourceLocation& place) {
    return type == 'C' ? of_type_c(stored, place) : of_type_a_or_b(type, stored, place);
}

}  // namespace lucerna
