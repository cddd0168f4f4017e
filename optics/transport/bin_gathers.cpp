#include "optics/transport/bin_gathers.h"

#include <algorithm>

namespace lucerna::optics {

BinGathers::BinGathers(const Phase& phase, const ObserverBins& bins, const ForwardMaps& maps,
                       PhaseReadings& readings)
    : phase_(phase),
      maps_(maps),
      readings_(readings),
      meter_(std::holds_alternative<LuminanceMeter>(phase.stage.parts().observers[bins.observer])) {
    if (const auto* camera = std::get_if<Camera>(&phase.stage.parts().observers[bins.observer])) {
        camera_.emplace(*camera);
    }
}

void BinGathers::start(std::uint32_t bin, const BinRays& rays) {
    bin_ = bin;
    rays_ = rays;
    seen_.clear();
}

void BinGathers::next_ray(std::uint32_t ray) {
    const std::uint32_t gathers = rays_.count / rays_.per_gather;
    specular_weight_ =
        ray < gathers ? static_cast<float>(rays_.count) / static_cast<float>(gathers) : 0.0f;
    kernel_bias_ = kernel_bias_variance_ = 0.0;
    cut_by_barriers_ = 0;
    caustic_summed_ = indirect_summed_ = 0.0f;
}

// What a ray of a bin finds on a patch stands for the next ones as well that come to the patch
// straight and with the same weight. Behind other events the rays of a bin spread widely and
// their weights differ: there a share of them gathers, chosen beforehand.
void BinGathers::where_seen(const GatherPoint& at, std::uint8_t histories, const Path& path,
                            bool straight) {
    const Lanes& weight = path.weight;
    if (!path.hero_only && !straight) {
        if (specular_weight_ > 0.0f) {
            add(gathered(at, histories, weight), specular_weight_ * weight);
        }
        return;
    }
    if (!path.hero_only && meter_ && std::holds_alternative<Diffuse>(at.bsdf)) {
        return by_meter(at, histories, weight);
    }
    GatherPoint shared = at;
    if (straight && camera_) {
        shared.seen_m2 = camera_->seen_by_pixel_m2(at.point.position, at.point.normal) *
                         rays_.pixels * rays_.per_gather / rays_.count;
    }
    if (path.hero_only || rays_.per_gather == 1) {
        const auto found = gathered(shared, histories, weight);
        return straight ? add_straight(found, at, at.point.position, weight) : add(found, weight);
    }
    const std::uint32_t patch = kernel_patch(phase_.stage, at.point);
    const bool above = at.wo.z() > 0.0;
    auto seen = std::find_if(seen_.begin(), seen_.end(), [&](const Seen& s) {
        return s.patch == patch && s.above == above && (s.weight == weight).all();
    });
    if (seen == seen_.end()) {
        seen_.push_back({patch, above, 0, at.point.position, weight, {}});
        seen = seen_.end() - 1;
    }
    if (seen->rays_left == 0) {
        seen->rays_left = rays_.per_gather;
        seen->position = at.point.position;
        seen->found = gathered(shared, histories, weight);
    }
    --seen->rays_left;
    add_straight(seen->found, at, seen->position, weight);
}

// Many rays of a meter see nearly the same points: what one finds stands for all that come close to
// it, by a twentieth of the narrowest kernel. That adds a few thousandths to a bias which is small
// there.
void BinGathers::by_meter(const GatherPoint& at, std::uint8_t histories, const Lanes& weight) {
    constexpr double near = 0.05;
    // A meter that sees more than so many such places gathers at the others anew: to look through
    // long lists would take longer.
    constexpr std::size_t most_seen = 256;
    const std::uint32_t patch = kernel_patch(phase_.stage, at.point);
    const bool above = at.wo.z() > 0.0;
    const auto radius_m = [&](const ForwardMap& map, const Radii& radii) {
        return map.empty() ? infinity : radii[patch];
    };
    const double near_m = near * std::min(radius_m(maps_.caustic, maps_.caustic_radii),
                                          radius_m(maps_.indirect, maps_.indirect_radii));
    const auto close = std::find_if(seen_.begin(), seen_.end(), [&](const Seen& s) {
        return s.patch == patch && s.above == above &&
               (s.position - at.point.position).squaredNorm() <= near_m * near_m;
    });
    if (close != seen_.end()) return add(close->found, weight);
    const ForwardMaps::Found found = gathered(at, histories, weight);
    if (seen_.size() < most_seen) {
        seen_.push_back({patch, above, 0, at.point.position, weight, found});
    }
    add(found, weight);
}

void BinGathers::at_sensor(const GatherPoint& at, std::uint8_t histories) {
    const Gathered found = gathered(at, histories, Lanes::Ones()).light;
    constexpr auto weight = static_cast<float>(pi);
    readings_.add_tristimulus(bin_, weight * found.radiance, weight * found.bias);
    const auto luminous = [&](const PerAxis& moment) {
        return Vec3(pi * Vec3(moment[0][1], moment[1][1], moment[2][1]));
    };
    readings_.add_steps(bin_, luminous(found.slope), luminous(found.step));
}

ForwardMaps::Found BinGathers::gathered(const GatherPoint& at, std::uint8_t histories,
                                        const Lanes& weight) {
    GatherPoint own = at;
    own.tells_steps = !camera_;
    const ForwardMaps::Found found =
        maps_.gather(phase_, own, histories, rays_.kernel_scale, rays_.barriers);
    if (found.cut) ++cut_by_barriers_;
    caustic_summed_ += found.caustic_summed;
    indirect_summed_ += found.indirect_summed;
    if (camera_ && found.indirect_photons > 0) {
        kernel_bias_ += phase_.luminous(weight * found.indirect_bias);
        kernel_bias_variance_ += variance_of_bias *
                                 square(phase_.luminous(weight * found.indirect)) /
                                 found.indirect_photons;
    }
    return found;
}

void BinGathers::add(const ForwardMaps::Found& found, const Lanes& weight) {
    const Gathered& light = found.light;
    readings_.add(phase_, bin_, weight * light.radiance, weight * light.bias);
    if (camera_) return;
    const auto luminous = [&](const PerAxis& moment) {
        return Vec3(phase_.luminous(weight * moment[0]), phase_.luminous(weight * moment[1]),
                    phase_.luminous(weight * moment[2]));
    };
    readings_.add_steps(bin_, luminous(light.slope), luminous(light.step));
}

void BinGathers::add_straight(const ForwardMaps::Found& found, const GatherPoint& at,
                              const Vec3& centre, const Lanes& weight) {
    const float mean_weight = weight.mean();
    if (!camera_ || found.indirect_left == 1.0f || !(mean_weight > 0.0f)) return add(found, weight);
    readings_.add(phase_, bin_, weight * found.light.radiance,
                  weight * (found.light.bias - found.indirect_bias));
    const Eigen::Vector3f position = centre.cast<float>();
    if (!cut_kernels_.empty() && cut_kernels_.back().bin == bin_ &&
        cut_kernels_.back().position == position) {
        cut_kernels_.back().weight += mean_weight;  // another ray for which the same kernel stands
        return;
    }
    const std::uint32_t patch = kernel_patch(phase_.stage, at.point);
    cut_kernels_.push_back(
        {.bin = bin_,
         .side = 2 * patch + (at.wo.z() > 0.0 ? 1 : 0),
         .position = position,
         .normal = at.point.normal.cast<float>(),
         .whole_m = static_cast<float>(maps_.indirect_radii[patch]),
         .left = found.indirect_left,
         .weight = mean_weight,
         .bias = static_cast<float>(phase_.luminous(weight * found.indirect_bias)) / mean_weight});
}

}  // namespace lucerna::optics
