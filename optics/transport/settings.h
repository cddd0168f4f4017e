// What a user may set of a simulation.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lucerna::optics {

enum class Method {
    automatic,  ///< combined, but images gather indirect light where it is seen if that is less
                ///< noisy in pilot phases
    combined,
    forward,
    backward,
    path
};

/// How the work of a phase is shared among threads (docs/method.md).
enum class Scheduler {
    ordered,      ///< all threads on one phase; deposits are sorted by place before they are added,
                  ///< so that no two threads write to the same: same bits for any threads
    synchronous,  ///< all threads on one phase; deposits are added under locks, in any order
    asynchronous,  ///< each thread on a phase and maps of its own; the same bits as `ordered`, for
                   ///< as many times its memory as there are threads
    two_level      ///< groups of threads, each with the map of its part of the image
};

/// Errors of the partition of light that a test can plant, to show that it would notice them.
enum class PlantedError {
    none,
    double_count,  ///< emission behind specular events is counted by ray and by map
    gap            ///< backward photons refuse light that comes straight from a light
};

/// Coverage of the expanded uncertainties that targets are stated for.
inline constexpr double target_coverage = 0.95;

/// An expanded uncertainty to reach.
struct SensorTarget {
    std::string sensor;     ///< name of a sensor; each of its points has to reach it
    double relative = 0.0;  ///< share of the value, such as 0.01; or
    double absolute = 0.0;  ///< number in the unit of the value, if above 0

    /// The expanded uncertainty asked for of a value, in its unit; 0 if nothing is asked.
    double wanted(double value) const {
        return absolute > 0.0 ? absolute : relative * std::abs(value);
    }
    /// Expanded uncertainty over what is asked of a value: at most 1 if that is reached; 0 if
    /// nothing is asked.
    double excess(double value, double expanded_uncertainty) const {
        if (!(relative > 0.0 || absolute > 0.0)) return 0.0;
        // What is exactly known, such as darkness, is known well enough.
        return expanded_uncertainty > 0.0 ? expanded_uncertainty / wanted(value) : 0.0;
    }
    /// Saves to an archive or loads from one.
    template <typename Archive>
    void serialize(Archive& archive) {
        archive(sensor, relative, absolute);
    }
};

struct Settings {
    Method method = Method::automatic;
    std::uint64_t seed = 1;
    int threads = 0;  ///< 0: all of the machine
    Scheduler scheduler = Scheduler::ordered;
    std::optional<double> image_accuracy;   ///< delta to stop at (docs/method.md eq. 6)
    std::optional<double> sensor_accuracy;  ///< U / value of each sensor to stop at, such as 0.01
    std::vector<SensorTarget> sensor_targets;  ///< of single sensors, in place of sensor_accuracy
    std::optional<double> time_limit_s;        ///< wall time
    std::optional<std::uint32_t> max_phases;
    std::optional<std::uint32_t> forward_rays;  ///< per phase and map; default: see forward_rays.h
    /// Backward rays per pixel and phase; default: see readings.cpp.
    std::optional<int> samples_per_pixel;
    int spectral_bins = 0;  ///< bins of the spectral image; 0: none
    /// Whether paths carry polarisation; without it where the scene has smooth dielectrics or
    /// metals.
    std::optional<bool> polarisation;
    PlantedError planted_error = PlantedError::none;  ///< for tests only

    /// What is asked of a sensor.
    SensorTarget target_of(const std::string& sensor) const {
        for (const SensorTarget& target : sensor_targets) {
            if (target.sensor == sensor) return target;
        }
        return {sensor, sensor_accuracy.value_or(0.0), 0.0};
    }
    /// Saves what phases rest on to an archive or loads it from one.
    template <typename Archive>
    void serialize(Archive& archive) {
        archive(method, seed, scheduler, sensor_accuracy, sensor_targets, forward_rays,
                samples_per_pixel, spectral_bins, polarisation);
    }
};

}  // namespace lucerna::optics
