// What the observers read: phase values of all bins, folded into estimates over phases.
#pragma once

#include <vector>

#include "core/batch_means.h"
#include "core/statistics.h"
#include "optics/transport/phase.h"
#include "optics/transport/result.h"

namespace lucerna::optics {

class Calibration;

/// The bins of one observer: pixels, points, or the one reading of a meter. Those of all sensors
/// come before those of cameras.
struct ObserverBins {
    std::size_t observer;
    std::size_t first_bin;
    std::size_t count;
};

inline bool is_camera(const SceneParts& parts, const ObserverBins& bins) {
    return std::holds_alternative<Camera>(parts.observers[bins.observer]);
}

/// What all bins read in one phase; different bins may be written by different threads at the same
/// time.
class PhaseReadings {
public:
    /// The first bins are those of sensors.
    PhaseReadings(std::size_t bins, std::size_t sensor_bins, std::size_t spectral_bins);

    /// Adds to the value of a bin a radiance, or an irradiance [W/(m2 (sr) nm)].
    void add(const Phase& phase, std::size_t bin, const Lanes& radiance);
    /// Adds what a kernel collected, with its bias as measured in this phase, to a bin.
    void add(const Phase& phase, std::size_t bin, const Lanes& radiance, const Lanes& bias);

    /// Adds to the bias of a pixel [cd/m2].
    void add_bias(std::size_t bin, double bias) { values_[bin].y_bias += bias; }

    /// The same of X, Y and Z in the first three lanes.
    void add_tristimulus(std::size_t bin, const Lanes& xyz, const Lanes& bias);

    /// Adds to a bin of a sensor what tells of steps of light in a kernel: see Gathered.
    void add_steps(std::size_t bin, const Vec3& slope, const Vec3& step) {
        steps_[bin].slope += slope;
        steps_[bin].step += step;
    }

    /// Of a camera or meter, by now [cd/m2]; illuminance of points [lx].
    double luminance(std::size_t bin) const { return values_[bin].y; }

private:
    friend class Readings;
    struct Value {
        double x = 0.0, y = 0.0, z = 0.0;
        double x_bias = 0.0, y_bias = 0.0, z_bias = 0.0;
    };
    std::vector<Value> values_;
    struct Step {
        Vec3 slope = Vec3::Zero(), step = Vec3::Zero();
    };
    std::vector<Step> steps_;  // of the bins of sensors
    std::size_t spectral_bins_;
    std::vector<double> spectral_;  // [bin][spectral bin], W/(m2 sr)
};

/// The estimates over phases.
class Readings {
public:
    Readings(const SceneParts& parts, const Settings& settings);

    const std::vector<ObserverBins>& observers() const { return observers_; }
    std::size_t bin_count() const { return luminance_.size(); }

    /// Readings of a phase, all of them zero.
    PhaseReadings new_phase() const { return {luminance_.size(), steps_.size(), spectral_bins_}; }
    /// Ends a phase: its values enter the estimates and are set back to zero.
    void fold(const Phase& phase, PhaseReadings& values, int threads);
    /// Joins the phases of an independent run of the same scene and settings.
    void merge(const Readings& other);
    /// Saves what was folded to an archive, or loads it in readings of the same scene and settings.
    template <typename Archive>
    void serialize(Archive& archive) {
        for (ImageMeans& means : means_) {
            for (Estimate& tile : means.tiles) archive(tile);
            archive(means.whole);
        }
        for (Estimate& estimate : luminance_) archive(estimate);
        for (std::vector<double>* sums : {&x_sum_, &z_sum_, &spectral_sum_}) {
            for (double& sum : *sums) archive(sum);
        }
        archive(sensors_);
        for (StepBias& step : steps_) archive(step);
    }

    std::vector<Image> images(const SceneParts& parts, int threads) const;
    std::vector<Quantity> quantities(const SceneParts& parts) const;
    std::vector<DerivedQuantity> derived(const SceneParts& parts) const;
    /// Sum over the pixels of all cameras of the variance over phases.
    double image_variance() const;
    /// delta of docs/method.md eq. 6 over the pixels of all cameras; 0 without a camera.
    double delta(int threads) const;
    Furthest furthest_sensor(const SceneParts& parts, const Settings& targets) const;
    std::size_t bytes() const;

private:
    // Means over parts of an image, empty for sensors.
    struct ImageMeans {
        std::size_t width = 0, height = 0;
        std::vector<Estimate> tiles;
        Estimate whole;
    };
    // Sums over the pixels of an image: of squared luminances, of squared standard errors, and of
    // squared kernel biases without their noise.
    struct Squares {
        double luminance = 0.0, noise = 0.0, bias = 0.0;
        void operator+=(const Squares& other);
    };

    static void fold_means(const PhaseReadings& values, const ObserverBins& bins, int threads,
                           ImageMeans& means);
    void fold_sensors(const Phase& phase, PhaseReadings& readings);
    template <typename Function>
    Squares sum_over_pixels(const ObserverBins& bins, int threads, const Function& of_pixel) const;
    double relative_bias(const ObserverBins& bins, int threads) const;
    Squares of_corrected(const ObserverBins& bins, double relative_bias, int threads) const;
    Uncertain result_of_sensor(const Calibration& calibration, std::size_t bin) const;
    std::optional<Colour> colour(const Calibration& calibration, std::size_t sensor_bin) const;

    std::vector<ObserverBins> observers_;
    std::vector<bool> is_camera_;    // per ObserverBins
    std::vector<ImageMeans> means_;  // per ObserverBins
    std::vector<Estimate> luminance_;
    std::vector<double> x_sum_, z_sum_;  // kernel bias included
    std::vector<StepBias> steps_;        // per bin of a sensor
    // X, Y, Z of each bin of a sensor, the kernel bias taken off, and last those of the emission of
    // all lights on the wavelengths of the phases.
    BatchMeans sensors_;
    Vec3 emission_ = Vec3::Zero();  // X, Y, Z of all lights, exact
    std::size_t spectral_bins_ = 0;
    std::vector<double> spectral_sum_;  // [bin][spectral bin], W/(m2 sr) over all phases
};

}  // namespace lucerna::optics
