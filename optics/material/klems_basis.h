// Division of the hemisphere into patches, rings of polar angle cut into equal sectors of azimuth,
// after J. H. Klems, ASHRAE Transactions 100(1), 1994.
#pragma once

#include <optional>
#include <vector>

#include "core/vector.h"

namespace lucerna::optics {

/// A unit direction with z >= 0 as patches are found by it, which serves several bases.
struct KlemsDirection {
    double sin2;  ///< squared sine of the polar angle
    /// Share of the way around the square |x| + |y| = 1, from +x toward +y, in [0, 1]: it grows
    /// with the azimuth, takes no function of angles, and is within 0.012 of the azimuth over 2 pi.
    double around;

    KlemsDirection(const Vec3& direction);  // NOLINT: any direction is one
};

/// Patches are numbered ring by ring from the pole; the first sector of a ring is centred on
/// azimuth 0
/// (+x), the others follow toward +y.
class KlemsBasis {
public:
    struct Ring {
        double lower_deg, upper_deg;  ///< polar angle
        int sector_count;
    };

    /// Rings from 0 to 90 deg without gap; throws std::invalid_argument else.
    explicit KlemsBasis(std::vector<Ring> rings);

    /// The bases that LBNL WINDOW names "LBNL/Klems Full" (145 patches), "Half" (73), "Quarter"
    /// (41).
    static KlemsBasis full();
    static KlemsBasis half();
    static KlemsBasis quarter();

    int patch_count() const { return patch_count_; }
    int patch(const KlemsDirection& direction) const;
    /// Integral of cos(theta) over the patch: pi (sin^2 upper - sin^2 lower) / sectors [sr].
    double projected_solid_angle_sr(int patch) const;
    /// Direction in the patch, uniform per projected solid angle.
    Vec3 sample(int patch, double u1, double u2) const;
    /// Middle of the patch in polar angle and azimuth (the pole for a single sector there).
    Vec3 centre(int patch) const;
    /// The patch turned by 180 deg of azimuth; nothing if the sectors do not fall on each other.
    std::optional<int> opposite(int patch) const;

    bool operator==(const KlemsBasis& other) const;

private:
    struct Place {
        std::size_t ring;
        int sector;
    };
    Place place(int patch) const;

    std::vector<Ring> rings_;
    std::vector<int> first_patch_;  // of each ring
    // Of each ring, where along KlemsDirection::around the sectors begin, the first one, which
    // begins below +x, aside; then infinity.
    std::vector<std::vector<double>> sectors_begin_;
    std::vector<double> sin2_lower_;  // of each ring, and 1 at the end
    int patch_count_ = 0;
};

}  // namespace lucerna::optics
