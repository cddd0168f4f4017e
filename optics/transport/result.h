// What a simulation leaves behind.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/statistics.h"
#include "optics/transport/settings.h"

namespace lucerna::optics {

/// Image of a camera; row 0 is the top row.
struct Image {
    std::string name;
    int width = 0, height = 0;
    std::vector<Estimate> luminance;  ///< per pixel [cd/m2]
    /// Root mean square of the kernel bias of all pixels, without its noise, over that of their
    /// luminance.
    double relative_bias = 0.0;
    std::vector<float> x, z;  ///< tristimulus values X, Z on the scale of Y = pixel(i).value
    std::vector<double> bin_edges_nm;      ///< spectral_bins + 1 edges, or empty
    std::vector<float> spectral_radiance;  ///< [pixel * bins + bin], mean in the bin [W/(m2 sr nm)]
    /// Mean luminance of tiles of tile_size x tile_size pixels (smaller at the right and lower rim)
    /// and of the whole image. Taken per phase: the errors of pixels are correlated by shared
    /// photons, so the error of a mean does not follow from those of its pixels.
    static constexpr int tile_size = 16;
    std::vector<Estimate> tiles;
    Estimate mean;
    double delta = 0.0;       ///< docs/method.md eq. 6, of the corrected pixels
    double delta_bias = 0.0;  ///< the same norm of the measured kernel bias that is left in them

    /// Share of its measured kernel bias that is taken off a pixel: see
    /// Estimate::corrected_share().
    double corrected_share(std::size_t i) const;
    /// Luminance of a pixel with its uncertainty: noise over phases, and what the correction leaves
    /// of the measured bias.
    Uncertain pixel(std::size_t i) const;
};

/// Colour of a quantity (CIE 1931, 2 degrees).
struct Colour {
    Uncertain x, y;                       ///< chromaticity
    std::optional<Uncertain> cct_k, duv;  ///< correlated colour temperature, where it is defined
};

/// How a value follows uncertain inputs.
struct InputChanges {
    /// Change of the value when one input is shifted by its expanded uncertainty, for each of
    /// Result::uncertain_inputs.
    std::vector<double> changes;

    /// Half width of the interval for which inputs are responsible: independent inputs, to first
    /// order (JCGM 100:2008, 5.1.2).
    double expanded_uncertainty() const;
};

/// One reported number.
struct Quantity {
    std::string name;      ///< of the sensor or receiver, with its point: "desk plane[3,1]"
    std::string quantity;  ///< term of CIE S 017: "illuminance", "luminance", "luminous flux"
    std::string unit;      ///< "lx", "cd/m2", "lm"
    Estimate estimate;
    std::optional<Colour> colour{};  ///< where it has a meaning
    /// Of a sensor: the estimate with what the known emission and steps of light tell of its error.
    std::optional<Uncertain> reading{};
    InputChanges inputs{};

    Uncertain result() const { return reading ? *reading : estimate.corrected(); }
};

/// A number that follows from several quantities of one sensor, such as a uniformity.
struct DerivedQuantity {
    std::string name;      ///< "desk plane: uniformity U0 (minimum / mean)"
    std::string quantity;  ///< term of CIE S 017 or of EN 12464-1
    std::string unit;      ///< "1" for ratios
    Uncertain result;
    InputChanges inputs{};
};

/// Where the light of the secondary forward rays went [lm]; closes to the sum of emitted.
struct FluxBalance {
    double emitted = 0.0;
    std::map<std::string, double> absorbed;  ///< per material or medium
    double escaped = 0.0;                    ///< left the scene
    double trapped = 0.0;                    ///< held for ever by a lossless solid
    double inconsistent_medium = 0.0;  ///< lost where the geometry of solids contradicts itself
    double numerical = 0.0;            ///< lost to undefined numbers
    double roulette_residue = 0.0;     ///< of Russian roulette, zero on average
    double closure() const;            ///< emitted minus all of the above [lm]
};

struct RayCounts {
    std::uint64_t backward_rays = 0;   ///< paths from observers
    std::uint64_t caustic_rays = 0;    ///< paths from lights, caustic step
    std::uint64_t secondary_rays = 0;  ///< paths from lights, secondary step
    std::uint64_t backward_segments = 0, forward_segments = 0, shadow_segments = 0;
    std::uint64_t forward_photons = 0;   ///< stored in forward maps
    std::uint64_t backward_photons = 0;  ///< stored in backward maps
    std::uint64_t scattering_hits = 0;   ///< hits of secondary rays on scattering surfaces
    std::uint64_t deposits = 0;
    // Wall time by stage; of phases that are traced at the same time the sum.
    double setup_s = 0.0;      ///< scene made ready for tracing, memory for the readings
    double pilot_s = 0.0;      ///< radii, numbers of rays and collection chosen by pilot phases
    double caustic_s = 0.0;    ///< forward traces for the forward maps, caustic and indirect
    double maps_s = 0.0;       ///< maps built
    double backward_s = 0.0;   ///< backward trace with its gathers
    double secondary_s = 0.0;  ///< secondary forward trace with its deposits
    double readings_s = 0.0;   ///< backward map read, phase folded into the estimates

    void operator+=(const RayCounts& other);
    /// Saves to an archive or loads from one.
    template <typename Archive>
    void serialize(Archive& archive) {
        archive(backward_rays, caustic_rays, secondary_rays, backward_segments, forward_segments,
                shadow_segments, forward_photons, backward_photons, scattering_hits, deposits,
                setup_s, pilot_s, caustic_s, maps_s, backward_s, secondary_s, readings_s);
    }
};

/// What is furthest from the accuracy that is asked for.
struct Furthest {
    std::string reading;  ///< such as "desk plane[3,1]"; empty for the noise of the images
    double excess = 0.0;  ///< its uncertainty over what is asked for; 0 if nothing is
};

struct Result {
    std::vector<Image> images;
    std::vector<Quantity> quantities;
    std::vector<DerivedQuantity> derived;
    std::vector<std::string> uncertain_inputs;  ///< as stated, of those that were looked into
    FluxBalance flux_balance_lm;
    RayCounts rays;
    std::uint64_t forward_map_bytes = 0, backward_map_bytes = 0, image_bytes = 0;  ///< largest seen
    Settings settings;
    std::vector<std::uint64_t> seeds;  ///< of the runs that were joined in it; else that of the run
    std::uint32_t phases = 0;
    double wall_s = 0.0;
    std::string stopped_by;  ///< "accuracy", "time limit", "phases", "interruption", "merge"
    bool accuracy_reached = true;
    Furthest furthest{};  ///< where the accuracy was not reached
    std::vector<std::string> warnings;
};

/// Notes what a shift of one more input by its uncertainty has changed.
/// @param input    the input as stated: "materials.wall.reflectance: 0.7 ± 0.02"
/// @param shifted  of the same scene but for that, by the same seed and as many phases, so that
/// much
///     of the noise of both is the same.
void add_input_change(Result& result, const std::string& input, const Result& shifted);

}  // namespace lucerna::optics
