// What a user may set of a simulation.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace lucerna::optics {

enum class Method { combined, forward, backward, path };

/// Errors of the partition of light that a test can plant, to show that it would notice them.
enum class PlantedError {
    none,
    double_count,  ///< emission behind specular events is counted by ray and by map
    gap            ///< backward photons refuse light that comes straight from a light
};

struct Settings {
    Method method = Method::combined;
    std::uint64_t seed = 1;
    int threads = 0;                        ///< 0: all of the machine
    std::optional<double> image_accuracy;   ///< delta of METHOD eq. 6 to stop at, such as 0.02
    std::optional<double> sensor_accuracy;  ///< relative standard error of each sensor to stop at
    std::optional<double> time_limit_s;     ///< wall time
    std::optional<std::uint32_t> max_phases;
    std::optional<std::uint32_t> forward_rays;  ///< per phase and map; default: see simulate.cpp
    int samples_per_pixel = 1;                  ///< backward rays per pixel and phase
    int spectral_bins = 0;                      ///< bins of the spectral image; 0: none
    PlantedError planted_error = PlantedError::none;  ///< for tests only
};

}  // namespace lucerna::optics
