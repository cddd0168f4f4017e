#include "validation/truth/room_radiosity.h"

#include "validation/truth/polygon_light.h"
#include "validation/truth/quadrature.h"

namespace lucerna::truth {
namespace {

// Antiderivatives of the exchange of two rectangles, to be summed over their corners with
// alternating signs (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-13 for
// parallel and C-15 for perpendicular rectangles; Ehlert and Smith, J. Thermophys. Heat Transfer 7,
// 1993).
double parallel_term(double x, double y, double z) {
    const double over_x = std::hypot(x, z);
    const double over_y = std::hypot(y, z);
    return y * over_x * std::atan(y / over_x) + x * over_y * std::atan(x / over_y) -
           0.5 * z * z * std::log(x * x + y * y + z * z);
}

double perpendicular_term(double along, double distance2) {
    const double square = along * along + distance2;
    if (square == 0.0) return 0.0;
    const double distance = std::sqrt(distance2);
    const double angle = distance > 0.0 ? std::atan(along / distance) : 0.0;
    return along * distance * angle - 0.25 * (distance2 - along * along) * std::log(square);
}

const std::array<double, 2>& span(const Panel& panel, int axis) {
    return axis == (panel.axis + 1) % 3 ? panel.span_u_m : panel.span_v_m;
}

double area(const Panel& panel) {
    return (panel.span_u_m[1] - panel.span_u_m[0]) * (panel.span_v_m[1] - panel.span_v_m[0]);
}

std::vector<Vec3> corners_of(const Panel& panel) {
    const int u = (panel.axis + 1) % 3;
    const int v = (panel.axis + 2) % 3;
    Vec3 corner = Vec3::Zero();
    corner[panel.axis] = panel.plane_m;
    corner[u] = panel.span_u_m[0];
    corner[v] = panel.span_v_m[0];
    return corners(corner, (panel.span_u_m[1] - panel.span_u_m[0]) * Vec3::Unit(u),
                   (panel.span_v_m[1] - panel.span_v_m[0]) * Vec3::Unit(v));
}

template <typename Term>
double alternating_sum(const Term& term) {
    double sum = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t j = 0; j < 2; ++j) {
            for (std::size_t k = 0; k < 2; ++k) {
                for (std::size_t l = 0; l < 2; ++l) {
                    sum += ((i + j + k + l) % 2 ? -1.0 : 1.0) * term(i, j, k, l);
                }
            }
        }
    }
    return std::abs(sum) / (2.0 * pi);
}

// Lets the luminance vary linearly across each piece, with the slope that the neighbours show,
// where the factor of a row of the matrix varies linearly, too: the mean of the product of two
// linear functions over a piece exceeds the product of their means by one twelfth of the product of
// their differences across it.
void add_slopes(std::vector<double>& factors, std::size_t cells) {
    const std::size_t per_panel = cells * cells;
    const std::size_t count = static_cast<std::size_t>(std::sqrt(factors.size()));
    std::vector<double> plain(count);
    for (std::size_t i = 0; i < count; ++i) {
        double* row = &factors[i * count];
        std::copy(row, row + count, plain.begin());
        for (std::size_t j = 0; j < count; ++j) {
            const std::size_t place = j % per_panel;
            for (const auto& [index, stride] :
                 {std::pair(place / cells, cells), std::pair(place % cells, std::size_t{1})}) {
                const std::size_t before = index > 0 ? j - stride : j;
                const std::size_t after = index + 1 < cells ? j + stride : j;
                const double span = static_cast<double>((after - before) / stride);
                const double share = (plain[after] - plain[before]) / (12.0 * span * span);
                row[after] += share;
                row[before] -= share;
            }
        }
    }
}

}  // namespace

double exchange_area_m2(const Panel& a, const Panel& b) {
    if (a.axis == b.axis) {
        const double z = std::abs(a.plane_m - b.plane_m);
        if (z == 0.0) return 0.0;
        return alternating_sum([&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
            return parallel_term(a.span_u_m[i] - b.span_u_m[j], a.span_v_m[k] - b.span_v_m[l], z);
        });
    }
    const int common = 3 - a.axis - b.axis;
    const auto& reach_a = span(a, b.axis);  // distances of a's edges from the plane of b
    const auto& reach_b = span(b, a.axis);
    const auto& along_a = span(a, common);
    const auto& along_b = span(b, common);
    return alternating_sum([&](std::size_t i, std::size_t j, std::size_t k, std::size_t l) {
        const double x = reach_a[i] - b.plane_m;
        const double y = reach_b[j] - a.plane_m;
        return perpendicular_term(along_a[k] - along_b[l], x * x + y * y);
    });
}

RoomRadiosity::RoomRadiosity(std::vector<Panel> panels, int cells) : panels_(std::move(panels)) {
    for (std::size_t number = 0; number < panels_.size(); ++number) {
        const Panel& panel = panels_[number];
        const auto part = [&](const std::array<double, 2>& whole, int i) {
            const double step = (whole[1] - whole[0]) / cells;
            return std::array{whole[0] + i * step, whole[0] + (i + 1) * step};
        };
        for (int i = 0; i < cells; ++i) {
            for (int j = 0; j < cells; ++j) {
                Panel own = panel;
                own.span_u_m = part(panel.span_u_m, i);
                own.span_v_m = part(panel.span_v_m, j);
                pieces_.push_back({own, number, area(own), panel.emitted_luminance, 0.0});
            }
        }
    }
    const std::size_t count = pieces_.size();
    std::vector<double> factors(count * count);
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i; j < count; ++j) {
            const double exchange = exchange_area_m2(pieces_[i].panel, pieces_[j].panel);
            factors[i * count + j] = exchange / pieces_[i].area_m2;
            factors[j * count + i] = exchange / pieces_[j].area_m2;
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        double sum = 0.0;
        for (std::size_t j = 0; j < count; ++j) sum += factors[i * count + j];
        closure_error_ = std::max(closure_error_, std::abs(sum - 1.0));
    }
    add_slopes(factors, static_cast<std::size_t>(cells));
    // Gauss-Seidel: L_i = L_e + rho_i / pi E_i, E_i = pi sum F_ij L_j.
    double change = 1.0;
    while (change > 1e-10) {
        change = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            Piece& piece = pieces_[i];
            double sum = 0.0;
            for (std::size_t j = 0; j < count; ++j)
                sum += factors[i * count + j] * pieces_[j].luminance;
            piece.illuminance = pi * sum;
            const double luminance = piece.panel.emitted_luminance + piece.panel.reflectance * sum;
            change = std::max(change, std::abs(luminance - piece.luminance) / luminance);
            piece.luminance = luminance;
        }
    }
}

double RoomRadiosity::mean_illuminance(std::size_t panel) const {
    double flux = 0.0;
    for (const Piece& piece : pieces_) {
        if (piece.of == panel) flux += piece.illuminance * piece.area_m2;
    }
    return flux / area(panels_[panel]);
}

double RoomRadiosity::illuminance(const Vec3& x, const Vec3& normal) const {
    double sum = 0.0;
    for (const Piece& piece : pieces_) {
        // A plane does not light itself.
        if (std::abs(x[piece.panel.axis] - piece.panel.plane_m) < 1e-9) continue;
        sum += polygon_illuminance(corners_of(piece.panel), piece.luminance, x, normal);
    }
    return sum;
}

double RoomRadiosity::luminance(std::size_t panel, const Vec3& x, const Vec3& normal) const {
    return panels_[panel].emitted_luminance +
           panels_[panel].reflectance * illuminance(x, normal) / pi;
}

double RoomRadiosity::cone_luminance(std::size_t panel, const Vec3& normal, const Vec3& position,
                                     const Vec3& direction, double half_angle_rad) const {
    const Frame frame(direction);
    constexpr int around = 12;
    const double solid_angle_sr = 2.0 * pi * (1.0 - std::cos(half_angle_rad));
    const double sum = integral(
        [&](double cosine) {
            const double sine = std::sqrt(1.0 - cosine * cosine);
            double ring = 0.0;
            for (int i = 0; i < around; ++i) {
                const double azimuth = 2.0 * pi * (i + 0.5) / around;
                const Vec3 ray =
                    frame.to_world({sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
                const int axis = panels_[panel].axis;
                const double t = (panels_[panel].plane_m - position[axis]) / ray[axis];
                ring += luminance(panel, position + t * ray, normal);
            }
            return ring * 2.0 * pi / around;
        },
        std::cos(half_angle_rad), 1.0, 1);
    return sum / solid_angle_sr;
}

}  // namespace lucerna::truth
