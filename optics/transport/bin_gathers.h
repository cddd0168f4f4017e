// What the rays of a bin gather from the forward maps, each by itself or one for some.
#pragma once

#include <optional>
#include <vector>

#include "optics/transport/backward_rays.h"
#include "optics/transport/forward_maps.h"
#include "optics/transport/pooled_bias.h"
#include "optics/transport/readings.h"

namespace lucerna::optics {

/// Adds to the readings what the rays of one observer gather, bin after bin.
class BinGathers {
public:
    BinGathers(const Phase& phase, const ObserverBins& bins, const ForwardMaps& maps,
               PhaseReadings& readings);

    /// @param bin  among the bins of all observers.
    void start(std::uint32_t bin, const BinRays& rays);
    /// @param ray  from 0 to the number of rays of the bin.
    void next_ray(std::uint32_t ray);

    /// Where a ray meets its first scattering event.
    /// @param histories  of the photons, or-ed.
    /// @param straight   whether the ray has come without any event.
    void where_seen(const GatherPoint& at, std::uint8_t histories, const Path& path, bool straight);
    /// At an illuminance point, for all of its rays; photons there carry X, Y, Z: see Photon.
    void at_sensor(const GatherPoint& at, std::uint8_t histories);

    /// Of the luminance that the ray gathered from the map of indirect light; of cameras only.
    double kernel_bias() const { return kernel_bias_; }
    /// That bias varies at least so much, as photons are counted [of its unit squared].
    double kernel_bias_variance() const { return kernel_bias_variance_; }
    /// Of the ray: number of kernels that barriers cut.
    int cut_by_barriers() const { return cut_by_barriers_; }
    /// Of the ray: photons summed from each map, shares of them where gathers are shared.
    float caustic_summed() const { return caustic_summed_; }
    float indirect_summed() const { return indirect_summed_; }
    /// Of all rays so far: kernels whose bias is left to add_pooled_bias().
    std::vector<CutKernel> take_cut_kernels() { return std::move(cut_kernels_); }

private:
    struct Seen {
        std::uint32_t patch;
        bool above;
        std::uint32_t rays_left;
        Vec3 position;
        Lanes weight;
        ForwardMaps::Found found;
    };
    void by_meter(const GatherPoint& at, std::uint8_t histories, const Lanes& weight);
    ForwardMaps::Found gathered(const GatherPoint& at, std::uint8_t histories, const Lanes& weight);
    void add(const ForwardMaps::Found& found, const Lanes& weight);
    /// The same, but the bias of a cut kernel that a camera sees straight.
    /// @param centre  of the kernel.
    void add_straight(const ForwardMaps::Found& found, const GatherPoint& at, const Vec3& centre,
                      const Lanes& weight);

    const Phase& phase_;
    const ForwardMaps& maps_;
    PhaseReadings& readings_;
    std::optional<CameraRays> camera_;  // of a camera
    bool meter_;

    std::uint32_t bin_ = 0;
    BinRays rays_{};                                          // of the bin
    std::vector<Seen, Eigen::aligned_allocator<Seen>> seen_;  // by the rays of the bin
    float specular_weight_ = 1.0f;  // 0: the ray does not gather behind specular events
    int cut_by_barriers_ = 0;
    float caustic_summed_ = 0.0f, indirect_summed_ = 0.0f;
    double kernel_bias_ = 0.0, kernel_bias_variance_ = 0.0;
    std::vector<CutKernel> cut_kernels_;
};

}  // namespace lucerna::optics
