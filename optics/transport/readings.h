// What the observers read: phase values of all bins, folded into estimates over phases.
#pragma once

#include <vector>

#include "core/statistics.h"
#include "optics/transport/phase.h"
#include "optics/transport/result.h"

namespace lucerna::optics {

/// The bins of one observer: pixels, points, or the one reading of a meter.
struct ObserverBins {
    std::size_t observer;
    std::size_t first_bin;
    std::size_t count;
    std::uint32_t samples_per_bin;  ///< backward rays per phase
    std::uint32_t first_path;       ///< number of the first of them
};

/// Bins whose samples one task traces.
struct BinBlock {
    std::size_t observer_bins;  ///< index of the ObserverBins
    std::size_t first, last;    ///< bins within the observer, last excluded
};

/// Different bins may be written by different threads at the same time.
class Readings {
public:
    Readings(const SceneParts& parts, const Settings& settings);

    const std::vector<ObserverBins>& observers() const { return observers_; }
    const std::vector<BinBlock>& blocks() const { return blocks_; }
    std::size_t bin_count() const { return luminance_.size(); }
    std::uint64_t samples_per_phase() const { return samples_; }

    /// Adds to the phase value of a bin a radiance, or an irradiance [W/(m2 (sr) nm)].
    void add(const Phase& phase, std::size_t bin, const Lanes& radiance);
    /// Adds to the kernel bias of the phase value: luminance or illuminance.
    void add_bias(std::size_t bin, double bias) { phase_[bin].bias += bias; }

    /// Ends a phase: its values enter the estimates and are set back to zero.
    void fold(int threads);

    std::vector<Image> images(const SceneParts& parts) const;
    std::vector<Quantity> quantities(const SceneParts& parts) const;
    /// delta of METHOD eq. (6) over the pixels of all cameras; 0 without a camera.
    double delta() const;
    /// Largest relative standard error among the sensors; 0 without sensors.
    double worst_sensor_error() const;
    std::size_t bytes() const;

private:
    struct PhaseValue {
        double x = 0.0, y = 0.0, z = 0.0, bias = 0.0;
    };

    // Means over parts of an image, empty for sensors.
    struct ImageMeans {
        std::size_t width = 0, height = 0;
        std::vector<Estimate> tiles;
        Estimate whole;
    };
    void fold_means(const ObserverBins& bins, ImageMeans& means);

    std::vector<ObserverBins> observers_;
    std::vector<BinBlock> blocks_;
    std::vector<bool> is_camera_;    // per ObserverBins
    std::vector<ImageMeans> means_;  // per ObserverBins
    std::uint64_t samples_ = 0;
    std::vector<PhaseValue> phase_;
    std::vector<Estimate> luminance_;
    std::vector<double> x_sum_, z_sum_;
    std::size_t spectral_bins_ = 0;
    std::vector<double> spectral_sum_;  // [bin][spectral bin], W/(m2 sr) over all phases
};

}  // namespace lucerna::optics
