#include "optics/material/klems_basis.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace lucerna::optics {

namespace {

double radians(double degrees) {
    return degrees * pi / 180.0;
}

double sin_squared(double degrees) {
    const double s = std::sin(radians(degrees));
    return s * s;
}

double around_square(double x, double y) {
    const double sum = std::abs(x) + std::abs(y);
    if (!(sum > 0.0)) return 0.0;
    const double above = 0.25 * (1.0 - x / sum);  // 0 at +x, 1/2 at -x
    return y < 0.0 ? 1.0 - above : above;
}

Vec3 direction(double sin_theta, double phi) {
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi),
            std::sqrt(std::max(0.0, 1.0 - sin_theta * sin_theta))};
}

}  // namespace

KlemsDirection::KlemsDirection(const Vec3& direction)
    : sin2(direction.x() * direction.x() + direction.y() * direction.y()),
      around(around_square(direction.x(), direction.y())) {}

KlemsBasis::KlemsBasis(std::vector<Ring> rings) : rings_(std::move(rings)) {
    double upper = 0.0;
    for (const Ring& ring : rings_) {
        if (std::abs(ring.lower_deg - upper) > 1e-6 || !(ring.upper_deg > ring.lower_deg) ||
            ring.sector_count < 1) {
            throw std::invalid_argument("rings must follow each other and have sectors");
        }
        first_patch_.push_back(patch_count_);
        sin2_lower_.push_back(sin_squared(upper));
        std::vector<double>& begin = sectors_begin_.emplace_back();
        for (int sector = 1; sector <= ring.sector_count; ++sector) {
            const double phi = 2.0 * pi * (sector - 0.5) / ring.sector_count;
            begin.push_back(around_square(std::cos(phi), std::sin(phi)));
        }
        begin.push_back(std::numeric_limits<double>::infinity());
        patch_count_ += ring.sector_count;
        upper = ring.upper_deg;
    }
    if (std::abs(upper - 90.0) > 1e-6) throw std::invalid_argument("rings must end at 90 deg");
    sin2_lower_.push_back(1.0);
}

// Polar angles and sectors as WINDOW writes them into the files that it exports.
KlemsBasis KlemsBasis::full() {
    return KlemsBasis({{0, 5, 1},
                       {5, 15, 8},
                       {15, 25, 16},
                       {25, 35, 20},
                       {35, 45, 24},
                       {45, 55, 24},
                       {55, 65, 24},
                       {65, 75, 16},
                       {75, 90, 12}});
}
KlemsBasis KlemsBasis::half() {
    return KlemsBasis({{0, 6.5, 1},
                       {6.5, 19.5, 8},
                       {19.5, 32.5, 12},
                       {32.5, 46.5, 16},
                       {46.5, 61.5, 20},
                       {61.5, 76.5, 12},
                       {76.5, 90, 4}});
}
KlemsBasis KlemsBasis::quarter() {
    return KlemsBasis({{0, 9, 1}, {9, 27, 8}, {27, 46, 12}, {46, 66, 12}, {66, 90, 8}});
}

int KlemsBasis::patch(const KlemsDirection& d) const {
    std::size_t ring = 0;
    while (ring + 1 < rings_.size() && d.sin2 >= sin2_lower_[ring + 1]) ++ring;
    const std::vector<double>& begin = sectors_begin_[ring];
    const auto sectors = begin.size() - 1;
    auto sector = static_cast<std::size_t>(d.around * static_cast<double>(sectors) + 0.5);
    while (sector > 0 && d.around < begin[sector - 1]) --sector;
    while (d.around >= begin[sector]) ++sector;
    return first_patch_[ring] + static_cast<int>(sector == sectors ? 0 : sector);
}

KlemsBasis::Place KlemsBasis::place(int patch) const {
    const auto next = std::upper_bound(first_patch_.begin(), first_patch_.end(), patch);
    const auto ring = static_cast<std::size_t>(next - first_patch_.begin()) - 1;
    return {ring, patch - first_patch_[ring]};
}

double KlemsBasis::projected_solid_angle_sr(int patch) const {
    const std::size_t ring = place(patch).ring;
    return pi * (sin2_lower_[ring + 1] - sin2_lower_[ring]) / rings_[ring].sector_count;
}

Vec3 KlemsBasis::sample(int patch, double u1, double u2) const {
    const auto [ring, sector] = place(patch);
    const double sin2 = std::lerp(sin2_lower_[ring], sin2_lower_[ring + 1], u1);
    return direction(std::sqrt(sin2), 2.0 * pi * (sector + u2 - 0.5) / rings_[ring].sector_count);
}

Vec3 KlemsBasis::centre(int patch) const {
    const auto [ring, sector] = place(patch);
    const Ring& r = rings_[ring];
    if (ring == 0 && r.sector_count == 1) return Vec3::UnitZ();
    return direction(std::sin(radians(0.5 * (r.lower_deg + r.upper_deg))),
                     2.0 * pi * sector / r.sector_count);
}

std::optional<int> KlemsBasis::opposite(int patch) const {
    const auto [ring, sector] = place(patch);
    const int sectors = rings_[ring].sector_count;
    if (sectors == 1) return patch;
    if (sectors % 2 != 0) return std::nullopt;
    return first_patch_[ring] + (sector + sectors / 2) % sectors;
}

bool KlemsBasis::operator==(const KlemsBasis& other) const {
    return std::ranges::equal(rings_, other.rings_, [](const Ring& a, const Ring& b) {
        return a.lower_deg == b.lower_deg && a.upper_deg == b.upper_deg &&
               a.sector_count == b.sector_count;
    });
}

}  // namespace lucerna::optics
