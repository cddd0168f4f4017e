// The bound that room_case() states for its truths holds in the rooms of the cases.
#include <catch2/catch.hpp>

#include "validation/truth/room_radiosity.h"

using namespace lucerna;
using namespace lucerna::truth;

TEST_CASE("The change from 4 and 8 to 6 and 12 cells bounds the error of radiosity", "[unit]") {
    // The Cornell room, with the steepest light of all: a strip in the ceiling.
    const std::vector<Panel> panels{{0, 0.0, {0.0, 1.0}, {0.0, 1.0}, 0.5, 0.0},
                                    {0, 1.0, {0.0, 1.0}, {0.0, 1.0}, 0.25, 0.0},
                                    {1, 0.0, {0.0, 1.0}, {0.0, 1.0}, 0.0, 0.0},
                                    {1, 1.0, {0.0, 1.0}, {0.0, 1.0}, 0.75, 0.0},
                                    {2, 0.0, {0.0, 1.0}, {0.0, 1.0}, 0.75, 0.0},
                                    {2, 1.0, {0.0, 1.0}, {0.0, 0.35}, 0.75, 0.0},
                                    {2, 1.0, {0.0, 1.0}, {0.35, 0.65}, 0.75, 100.0},
                                    {2, 1.0, {0.0, 1.0}, {0.65, 1.0}, 0.75, 0.0}};
    const RoomRadiosity room_4(panels, 4), room_6(panels, 6), room_8(panels, 8),
        room_12(panels, 12), room_16(panels, 16);
    const auto check = [&](const auto& functional) {
        const double coarse = extrapolated(room_4, room_8, functional);
        const double value = extrapolated(room_6, room_12, functional);
        const double fine = extrapolated(room_8, room_16, functional);
        CHECK(std::abs(fine - value) <= std::max(std::abs(value - coarse), 1e-4 * value));
        CHECK(std::abs(value - coarse) <= 2e-3 * value);
    };
    for (std::size_t panel = 0; panel < panels.size(); ++panel) {
        check([&](const RoomRadiosity& room) { return room.mean_illuminance(panel); });
    }
    for (const double x : {0.1, 0.5, 0.9}) {
        check([&](const RoomRadiosity& room) {
            return room.illuminance({x, 0.4, 1e-4}, Vec3::UnitZ());
        });
    }
    check([](const RoomRadiosity& room) {
        return room.illuminance({0.25, 1.0 - 1e-4, 0.4}, -Vec3::UnitY());
    });
}
