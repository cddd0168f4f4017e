// Runs of the simulation against truths that were derived without it.
#pragma once

#include "core/parallel.h"
#include "optics/transport/simulate.h"
#include "tests/support/check_mean.h"
#include "validation/scene_builder.h"

namespace lucerna::test {

using validation::SceneBuilder;

/// What a run costs.
struct Effort {
    std::uint32_t phases;
    std::uint32_t forward_rays;  ///< per phase and map
    int samples_per_pixel = 1;
    std::optional<bool> polarisation = std::nullopt;
};

inline optics::Settings settings_of(optics::Method method, const Effort& effort) {
    optics::Settings settings;
    settings.method = method;
    settings.seed = 7;
    settings.threads = 1;
    settings.max_phases = effort.phases;
    settings.forward_rays = effort.forward_rays;
    settings.samples_per_pixel = effort.samples_per_pixel;
    settings.polarisation = effort.polarisation;
    return settings;
}

inline optics::Result run(const SceneBuilder& scene, optics::Method method, const Effort& effort,
                          std::uint64_t seed = 7, int threads = 1) {
    optics::Settings settings = settings_of(method, effort);
    settings.seed = seed;
    settings.threads = threads;
    return optics::simulate(scene.parts, settings);
}

/// A truth test is worth its name with a standard error of at most this share of the truth ...
inline constexpr double truth_standard_error = 0.002;
/// ... and if it then finds errors of this share, the measured kernel bias included.
inline constexpr DetectsRelative truth_detects{0.02};

/// Fails if the estimate is too weak, or its corrected value differs from the truth.
inline void check_truth(const Estimate& estimate, double truth) {
    INFO("bias " << estimate.bias() << " +/- " << estimate.bias_standard_error() << ", "
                 << estimate.count() << " phases");
    CHECK(estimate.standard_error() <= truth_standard_error * std::abs(truth));
    check_mean(estimate.value(), estimate.standard_error(), truth, truth_detects);
}

/// The twin of check_truth(): a wrong truth must not pass.
inline void check_refutes(const Estimate& estimate, double wrong_truth) {
    INFO("value " << estimate.value() << " +/- " << estimate.standard_error() << ", wrong truth "
                  << wrong_truth);
    CHECK_FALSE(agrees(estimate.value(), estimate.standard_error(), wrong_truth));
}

/// A functional of a result that has no error of its own, such as a mean over points or a
/// chromaticity, with the spread that it shows over independent runs.
class Replicates {
public:
    struct Value {
        double value;
        double bias = 0.0;  ///< the kernel's
    };

    /// @param read  the values of one Result, as a std::vector<Value>.
    template <typename Read>
    Replicates(const SceneBuilder& scene, optics::Method method, const Effort& effort,
               std::size_t runs, Read&& read) {
        std::vector<std::vector<Value>> values(runs);
        for_each_block(runs, hardware_threads(), [&](std::size_t i) {
            values[i] = read(run(scene, method, effort, i + 1, 1));
        });
        estimates_.resize(values.front().size());
        for (const auto& of_run : values) {
            for (std::size_t i = 0; i < of_run.size(); ++i) {
                estimates_[i].add(of_run[i].value, of_run[i].bias);
            }
        }
    }

    const Estimate& operator[](std::size_t number) const { return estimates_.at(number); }

private:
    std::vector<Estimate> estimates_;
};

/// As Replicates, for values that are means over phases: those of batches of phases of one run,
/// whose pilot is the same.
/// @param effort  of a batch.
template <typename Read>
std::vector<Estimate> over_batches(const SceneBuilder& scene, optics::Method method,
                                   const Effort& effort, std::uint32_t batches, Read&& read) {
    optics::Settings settings = settings_of(method, effort);
    settings.threads = hardware_threads();
    settings.max_phases = batches * effort.phases;
    std::vector<Replicates::Value> sums;  // over batches
    std::vector<Estimate> estimates;
    optics::Watch watch;
    watch.on_phase = [&](const optics::RunState& state) {
        if (state.phases % effort.phases != 0) return;
        const double count = state.phases / effort.phases;
        const std::vector<Replicates::Value> means = read(state.result(scene.parts));
        sums.resize(means.size());
        estimates.resize(means.size());
        for (std::size_t i = 0; i < means.size(); ++i) {
            const Replicates::Value sum{count * means[i].value, count * means[i].bias};
            estimates[i].add(sum.value - sums[i].value, sum.bias - sums[i].bias);
            sums[i] = sum;
        }
    };
    optics::simulate(scene.parts, settings, watch);
    return estimates;
}

/// The mean over all sensors.
inline Replicates::Value mean_of_sensors(const optics::Result& result) {
    Replicates::Value mean{0.0, 0.0};
    const auto count = static_cast<double>(result.quantities.size());
    for (const optics::Quantity& quantity : result.quantities) {
        mean.value += quantity.estimate.mean() / count;
        mean.bias += quantity.estimate.bias() / count;
    }
    return mean;
}

inline Replicates::Value mean_of_image(const optics::Image& image) {
    return {image.mean.mean(), image.mean.bias()};
}

/// As agrees(), with Student's t for the few runs.
inline bool agrees_over_runs(const Estimate& runs, double truth) {
    const double t = student_t(1.0 - 1e-6, static_cast<double>(runs.count() - 1));
    return std::abs(runs.value() - truth) <= t * runs.standard_error();
}

/// As check_truth(), for a value of which `runs` holds one per independent run.
/// @param demand  largest standard error in shares of the truth.
inline void check_truth_over_runs(const Estimate& runs, double truth,
                                  double demand = truth_standard_error) {
    INFO("value " << runs.value() << " +/- " << runs.standard_error() << ", truth " << truth
                  << ", z = " << (runs.value() - truth) / runs.standard_error() << ", bias "
                  << runs.bias() << ", " << runs.count() << " runs");
    CHECK(runs.standard_error() <= demand * std::abs(truth));
    CHECK(std::abs(runs.bias()) <= 0.5 * truth_detects.fraction * std::abs(truth));
    CHECK(agrees_over_runs(runs, truth));
}

inline void check_refutes_over_runs(const Estimate& runs, double wrong_truth) {
    INFO("value " << runs.value() << " +/- " << runs.standard_error() << ", wrong truth "
                  << wrong_truth);
    CHECK_FALSE(agrees_over_runs(runs, wrong_truth));
}

}  // namespace lucerna::test
