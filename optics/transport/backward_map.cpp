#include "optics/transport/backward_map.h"

#include <algorithm>
#include <bit>

namespace lucerna::optics {
namespace {

// Cells are as wide as a kernel: it meets few of them, and a look-up needs only one.
constexpr double cell_per_radius = 2.0;

}  // namespace

BackwardMap::BackwardMap(const Phase& phase, const Radii& radii,
                         std::vector<std::vector<BackwardPhoton>> blocks)
    : phase_(&phase), radii_(&radii) {
    block_starts_.push_back(0);
    for (const auto& block : blocks) block_starts_.push_back(block_starts_.back() + block.size());
    photons_.reserve(block_starts_.back());
    for (auto& block : blocks) {
        photons_.insert(photons_.end(), block.begin(), block.end());
        block = {};
    }
    sums_.resize(photons_.size());
    touched_.resize(photons_.size());

    build_grid();
}

void BackwardMap::build_grid() {
    if (photons_.empty()) return;
    // Counted and then filled in two equal walks over all cells that the kernels meet.
    bucket_mask_ = std::bit_ceil(4 * photons_.size()) - 1;
    bucket_starts_.assign(bucket_mask_ + 2, 0);
    std::vector<std::size_t> seen;  // of one photon
    const auto for_each_bucket = [&](auto&& visit) {
        for (std::uint32_t i = 0; i < photons_.size(); ++i) {
            const Vec3& position = photons_[i].point.position;
            const std::uint32_t patch = kernel_patch(phase_->stage, photons_[i].point);
            const double radius_m = (*radii_)[patch];
            const Vec3 reach = Vec3::Constant(radius_m);
            const CellKey low = CellKey::at(patch, position - reach, cell_per_radius * radius_m);
            const CellKey high = CellKey::at(patch, position + reach, cell_per_radius * radius_m);
            seen.clear();
            for (std::int32_t x = low.x; x <= high.x; ++x) {
                for (std::int32_t y = low.y; y <= high.y; ++y) {
                    for (std::int32_t z = low.z; z <= high.z; ++z) {
                        const std::size_t bucket = CellKey{patch, x, y, z}.hash() & bucket_mask_;
                        if (std::find(seen.begin(), seen.end(), bucket) != seen.end()) continue;
                        seen.push_back(bucket);
                        visit(bucket, i);
                    }
                }
            }
        }
    };
    for_each_bucket([&](std::size_t bucket, std::uint32_t) { ++bucket_starts_[bucket + 1]; });
    for (std::size_t i = 1; i < bucket_starts_.size(); ++i) {
        bucket_starts_[i] += bucket_starts_[i - 1];
    }
    candidates_.resize(bucket_starts_.back());
    std::vector<std::uint32_t> next(bucket_starts_.begin(), bucket_starts_.end() - 1);
    for_each_bucket([&](std::size_t bucket, std::uint32_t i) {
        candidates_[next[bucket]++] = {photons_[i].point.position.cast<float>(), i};
    });
}

void BackwardMap::find(const Photon& photon, Deposits& deposits) const {
    if (photons_.empty()) return;
    const Stage& stage = phase_->stage;
    const std::uint32_t patch = kernel_patch(stage, photon.point);
    const double radius_m = (*radii_)[patch];
    // The quick test is in single precision and a little wide; in_kernel() decides.
    const auto square = static_cast<float>(radius_m * radius_m * 1.001);
    const Eigen::Vector3f position = photon.point.position.cast<float>();
    const auto number = static_cast<std::uint32_t>(deposits.photons.size());
    bool used = false;
    const CellKey key = CellKey::at(patch, photon.point.position, cell_per_radius * radius_m);
    const std::size_t bucket = key.hash() & bucket_mask_;
    for (std::uint32_t k = bucket_starts_[bucket]; k < bucket_starts_[bucket + 1]; ++k) {
        const Candidate& candidate = candidates_[k];
        if ((candidate.position - position).squaredNorm() > square) continue;
        const BackwardPhoton& backward = photons_[candidate.index];
        if (!(backward.accepts & static_cast<std::uint8_t>(photon.history))) continue;
        if (kernel_patch(stage, backward.point) != patch) continue;
        if (!in_kernel(stage, backward.point, photon.point, radius_m)) continue;
        deposits.by_part[part_of(candidate.index)].push_back({candidate.index, number});
        used = true;
    }
    if (used) deposits.photons.push_back(photon);
}

std::uint64_t BackwardMap::apply(std::size_t part, std::span<const Deposits> blocks) {
    std::uint64_t count = 0;
    for (const Deposits& block : blocks) {
        for (const auto& [index, number] : block.by_part[part]) {
            const BackwardPhoton& backward = photons_[index];
            const Photon& photon = block.photons[number];
            const SurfaceOptics optics =
                optics_at(*phase_, backward.medium_above, backward.medium_below, backward.hero_only,
                          phase_->wavelengths.hero);
            const Vec3 wi = kernel_direction(bsdf_frame(*phase_, backward.point), photon);
            Lanes f = evaluate(phase_->stage.parts().bsdfs[backward.bsdf], optics, backward.wo, wi,
                               Transport::radiance);
            f *= photon.flux;
            sums_[index].radiance += f;
            const std::uint32_t patch = kernel_patch(phase_->stage, backward.point);
            if (in_kernel(phase_->stage, backward.point, photon.point,
                          inner_radius_factor * (*radii_)[patch])) {
                sums_[index].radiance_inner += f;
            }
            touched_[index] = 1;
            ++count;
        }
    }
    return count;
}

Gathered BackwardMap::radiance(std::size_t i, std::uint64_t rays) const {
    const BackwardPhoton& backward = photons_[i];
    const Stage& stage = phase_->stage;
    const double radius_m = (*radii_)[kernel_patch(stage, backward.point)];
    const KernelAreas areas = kernel_areas(stage, backward.point, radius_m);
    const double per_ray = 1.0 / static_cast<double>(rays);
    // L = throughput / (A N) sum f dPhi                                            METHOD eq. (3)
    return {
        backward.throughput * sums_[i].radiance * static_cast<float>(per_ray / areas.full),
        backward.throughput * sums_[i].radiance_inner * static_cast<float>(per_ray / areas.inner)};
}

std::size_t BackwardMap::bytes() const {
    return photons_.size() * (sizeof(BackwardPhoton) + sizeof(Gathered) + 1) +
           bucket_starts_.size() * sizeof(std::uint32_t) + candidates_.size() * sizeof(Candidate);
}

}  // namespace lucerna::optics
