// The bound of 3e-4 that room_case() states for its truths: a finer solution, itself within 7e-5 of
// one with 12 and 24 cells, is within 2.5e-4.
#include <catch2/catch.hpp>

#include "validation/truth/chebyshev.h"
#include "validation/truth/room_radiosity.h"
#include "validation/truth/root.h"

using namespace lucerna;
using namespace lucerna::truth;
using Catch::Matchers::WithinAbs;

namespace {

// Of large panels and points; narrow panels beside bright ones are not used.
void check_converged(const std::vector<Panel>& panels, const std::vector<std::size_t>& large,
                     const std::vector<std::pair<Vec3, Vec3>>& points) {
    const RoomRadiosity room_6(panels, 6), room_12(panels, 12), room_8(panels, 8),
        room_16(panels, 16);
    const auto check = [&](const auto& functional) {
        CHECK_THAT(extrapolated(room_6, room_12, functional),
                   Catch::Matchers::WithinRel(extrapolated(room_8, room_16, functional), 2.5e-4));
    };
    for (const std::size_t panel : large) {
        check([&](const RoomRadiosity& room) { return room.mean_illuminance(panel); });
    }
    for (const auto& [position, normal] : points) {
        check([&, x = position, n = normal](const RoomRadiosity& room) {
            return room.illuminance(x, n);
        });
    }
}

}  // namespace

TEST_CASE("Radiosity of the Cornell room has converged", "[unit]") {
    check_converged({{0, 0.0, {0.0, 1.0}, {0.0, 1.0}, 0.5, 0.0},
                     {0, 1.0, {0.0, 1.0}, {0.0, 1.0}, 0.25, 0.0},
                     {1, 0.0, {0.0, 1.0}, {0.0, 1.0}, 0.0, 0.0},
                     {1, 1.0, {0.0, 1.0}, {0.0, 1.0}, 0.75, 0.0},
                     {2, 0.0, {0.0, 1.0}, {0.0, 1.0}, 0.75, 0.0},
                     {2, 1.0, {0.0, 1.0}, {0.0, 0.35}, 0.75, 0.0},
                     {2, 1.0, {0.0, 1.0}, {0.35, 0.65}, 0.75, 100.0},
                     {2, 1.0, {0.0, 1.0}, {0.65, 1.0}, 0.75, 0.0}},
                    {0, 1, 3, 4},
                    {{{0.1, 0.4, 1e-4}, {0, 0, 1}},
                     {{0.5, 0.4, 1e-4}, {0, 0, 1}},
                     {{0.25, 1.0 - 1e-4, 0.4}, {0, -1, 0}}});
}

TEST_CASE("Radiosity of the room with a window has converged", "[unit]") {
    const double rho = 0.6;
    check_converged({{0, 0.0, {0.0, 4.0}, {0.0, 2.5}, rho, 0.0},
                     {0, 3.0, {0.0, 4.0}, {0.0, 2.5}, rho, 0.0},
                     {1, 0.0, {0.0, 0.9}, {0.0, 3.0}, rho, 0.0},
                     {1, 0.0, {0.9, 2.1}, {0.0, 3.0}, 0.0, 5000.0},
                     {1, 0.0, {2.1, 2.5}, {0.0, 3.0}, rho, 0.0},
                     {1, 4.0, {0.0, 2.5}, {0.0, 3.0}, rho, 0.0},
                     {2, 0.0, {0.0, 3.0}, {0.0, 4.0}, rho, 0.0},
                     {2, 2.5, {0.0, 3.0}, {0.0, 4.0}, rho, 0.0}},
                    {0, 1, 5, 6, 7},
                    {{{1.2, 1.0, 0.8}, {0, 0, 1}},
                     {{1.2, 3.0, 0.8}, {0, 0, 1}},
                     {{1.2, 4.0 - 1e-4, 1.3}, {0, -1, 0}}});
}

TEST_CASE("Chebyshev: exact for polynomials, and quick for analytic functions", "[unit]") {
    const auto cubic = [](double x) { return 2.0 - x + 0.5 * x * x * x; };
    const truth::Chebyshev through(cubic, -1.0, 3.0, 4);
    for (const double x : {-1.0, -0.2, 1.0, 2.7, 3.0}) {
        CHECK_THAT(through(x), WithinAbs(cubic(x), 1e-12));
    }
    const auto smooth = [](double x) { return 1.0 / (x + 2.0); };
    const auto worst = [&](int nodes) {
        const truth::Chebyshev polynomial(smooth, 0.0, 2.0, nodes);
        double error = 0.0;
        for (double x = 0.0; x <= 2.0; x += 0.01) {
            error = std::max(error, std::abs(polynomial(x) - smooth(x)));
        }
        return error;
    };
    // The pole at -2 is at 3 half widths from the middle: 3 + sqrt(8) = 5.83 per node.
    CHECK(worst(6) < 1e-4);
    CHECK(worst(12) < worst(6) / std::pow(5.0, 6));
}

TEST_CASE("Root: of rising and of falling functions", "[unit]") {
    CHECK_THAT(truth::root([](double x) { return std::exp(x) - 2.0; }, 0.0, 5.0),
               WithinAbs(std::log(2.0), 1e-14));
    CHECK_THAT(truth::root([](double x) { return std::cos(x); }, 0.0, 3.0),
               WithinAbs(std::acos(0.0), 1e-14));
}
