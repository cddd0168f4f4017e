#include "optics/transport/backward_map.h"

#include <algorithm>
#include <bit>
#include <mutex>

namespace lucerna::optics {
namespace {

// Cells are as wide as a kernel: it meets few of them, and a look-up needs only one.
constexpr double cell_per_radius = 2.0;

}  // namespace

// Each lock is that of many backward photons, far apart in their order.
struct BackwardMap::Locks {
    std::array<std::mutex, 1 << 12> all;
    std::mutex& operator[](std::uint32_t index) { return all[index % all.size()]; }
};

BackwardMap::BackwardMap(const Phase& phase, const Radii& radii,
                         std::vector<std::vector<BackwardPhoton>> blocks, int threads)
    : phase_(&phase), radii_(&radii), locks_(std::make_shared<Locks>()) {
    block_starts_.push_back(0);
    for (const auto& block : blocks) block_starts_.push_back(block_starts_.back() + block.size());
    const std::size_t count = block_starts_.back();
    photons_ = RawArray<BackwardPhoton>(count);
    sums_ = RawArray<KernelSums>(count);
    touched_ = RawArray<std::uint8_t>(count);
    std::vector<std::uint8_t> accepted(blocks.size());
    for_each_block(blocks.size(), threads, [&](std::size_t block) {
        std::size_t i = block_starts_[block];
        for (const BackwardPhoton& photon : blocks[block]) {
            photons_.construct(i, photon);
            sums_.construct(i, {});
            touched_.construct(i++, 0);
            accepted[block] |= photon.accepts;
        }
        blocks[block] = {};
    });
    for (const std::uint8_t of_block : accepted) accepted_ |= of_block;
    build_grid(threads);
}

void BackwardMap::build_grid(int threads) {
    if (photons_.empty()) return;
    bucket_mask_ = std::bit_ceil(4 * photons_.size()) - 1;
    const Stage& stage = phase_->stage;
    const std::size_t tasks = tasks_for(photons_.size());
    const auto emit = [&](std::size_t task, auto&& put) {
        std::vector<std::size_t> seen;  // of one photon
        const std::size_t end = (task + 1) * photons_.size() / tasks;
        for (std::size_t i = task * photons_.size() / tasks; i < end; ++i) {
            const SurfacePoint& point = photons_[i].point;
            const double radius_m = (*radii_)[kernel_patch(stage, point)];
            const Candidate candidate{point.position.cast<float>(), static_cast<std::uint32_t>(i)};
            seen.clear();
            for_each_cell_of_kernel(stage, point, cell_per_radius * radius_m, radius_m,
                                    [&](std::uint64_t hash) {
                                        const std::size_t bucket = hash & bucket_mask_;
                                        if (std::ranges::find(seen, bucket) != seen.end()) return;
                                        seen.push_back(bucket);
                                        put(bucket, candidate);
                                    });
        }
    };
    grid_.build<Candidate>(bucket_mask_ + 1, tasks, threads, emit,
                           [](std::size_t, const Candidate& candidate) { return candidate; });
}

template <typename Use>
void BackwardMap::for_each_around(const Photon& photon, Use&& use) const {
    if (!(accepted_ & mask(photon.history))) return;
    const Stage& stage = phase_->stage;
    const std::uint32_t patch = kernel_patch(stage, photon.point);
    const double radius_m = (*radii_)[patch];
    // The quick test is in single precision and a little wide; in_kernel() decides.
    const auto square = static_cast<float>(radius_m * radius_m * 1.001);
    const Eigen::Vector3f position = photon.point.position.cast<float>();
    const PatchCells cells(patch, cell_per_radius * radius_m);
    const std::uint64_t hash = cells.hash_at(photon.point.position);
    for (const Candidate& candidate : grid_.bucket(hash & bucket_mask_)) {
        if ((candidate.position - position).squaredNorm() > square) continue;
        const BackwardPhoton& backward = photons_[candidate.index];
        if (!(backward.accepts & mask(photon.history))) continue;
        if (kernel_patch(stage, backward.point) != patch) continue;
        if (!in_kernel(stage, backward.point, photon.point, radius_m)) continue;
        use(candidate.index);
    }
}

void BackwardMap::find(const Photon& photon, Deposits& deposits) const {
    const auto number = static_cast<std::uint32_t>(deposits.photons.size());
    bool used = false;
    for_each_around(photon, [&](std::uint32_t index) {
        deposits.by_part[part_of(index)].push_back({index, number});
        used = true;
    });
    if (used) deposits.photons.push_back(photon);
}

void BackwardMap::add(std::uint32_t index, const Photon& photon) {
    const BackwardPhoton& backward = photons_[index];
    const SurfaceOptics optics = optics_at(*phase_, backward.medium_above, backward.medium_below,
                                           backward.hero_only, backward.hero);
    const Vec3 wi = kernel_direction(bsdf_frame(*phase_, backward.point), photon.point.normal,
                                     photon.direction);
    Lanes f = evaluate(phase_->stage.parts().bsdfs[backward.bsdf], optics, backward.wo, wi,
                       Transport::radiance);
    f *= photon.flux;
    sums_[index].full += f;
    const std::uint32_t patch = kernel_patch(phase_->stage, backward.point);
    if (in_kernel(phase_->stage, backward.point, photon.point,
                  inner_radius_factor * (*radii_)[patch])) {
        sums_[index].narrow += f;
    }
    touched_[index] = 1;
}

std::uint64_t BackwardMap::apply(std::size_t part, std::span<const Deposits> blocks) {
    std::uint64_t count = 0;
    for (const Deposits& block : blocks) {
        count += block.by_part[part].size();
        for (const auto& [index, number] : block.by_part[part]) add(index, block.photons[number]);
    }
    return count;
}

std::uint64_t BackwardMap::deposit_locked(const Photon& photon) {
    std::uint64_t count = 0;
    for_each_around(photon, [&](std::uint32_t index) {
        const std::scoped_lock lock((*locks_)[index]);
        add(index, photon);
        ++count;
    });
    return count;
}

Gathered BackwardMap::radiance(std::size_t i, std::uint64_t rays) const {
    const BackwardPhoton& backward = photons_[i];
    const Stage& stage = phase_->stage;
    const double radius_m = (*radii_)[kernel_patch(stage, backward.point)];
    const KernelAreas areas = kernel_areas(stage, backward.point, radius_m);
    Gathered gathered = sums_[i].over(areas, radius_m, static_cast<double>(rays));
    gathered.radiance *= backward.throughput;
    gathered.bias *= backward.throughput;
    return gathered;
}

std::size_t BackwardMap::bytes() const {
    return photons_.size() * (sizeof(BackwardPhoton) + sizeof(KernelSums) + 1) + grid_.bytes();
}

}  // namespace lucerna::optics
