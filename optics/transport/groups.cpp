#include "optics/transport/groups.h"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <mutex>
#include <thread>

#include "core/stopwatch.h"

namespace lucerna::optics {
namespace {

/// A backward map while it takes deposits.
class OpenMap {
public:
    /// From now on it takes this number of batches of rays.
    void open(BackwardMap map, std::uint32_t batches) {
        map_ = std::move(map);
        batches_ = batches;
        users_.store(1);
    }

    /// Whether the next batch of rays may deposit here; if so, leave() must follow. It is asked
    /// before the batch is traced, so that what its rays hit has no say.
    bool enter() {
        std::uint32_t users = users_.load();
        do {
            if (users == 0) return false;
        } while (!users_.compare_exchange_weak(users, users + 1));
        if (admitted_.fetch_add(1) < batches_) return true;
        admitted_.fetch_sub(1);
        users_.fetch_sub(1);
        return false;
    }

    /// Hands over what a batch found.
    void leave(std::uint32_t batch, BackwardMap::Deposits deposits) {
        {
            const std::scoped_lock lock(mutex_);
            found_.push_back({batch, std::move(deposits)});
        }
        users_.fetch_sub(1);
    }

    /// By the owner: closes the map if it has all of its batches and nobody is inside.
    bool try_to_close() {
        {
            const std::scoped_lock lock(mutex_);
            if (found_.size() < batches_) return false;
        }
        std::uint32_t only_owner = 1;
        return users_.compare_exchange_strong(only_owner, 0);
    }

    const BackwardMap& map() const { return map_; }
    BackwardMap& closed_map() { return map_; }

    /// The deposits, in the order of the rays; of the closed map.
    std::vector<BackwardMap::Deposits> take() {
        std::sort(found_.begin(), found_.end(),
                  [](const Found& a, const Found& b) { return a.batch < b.batch; });
        std::vector<BackwardMap::Deposits> deposits;
        deposits.reserve(found_.size());
        for (Found& found : found_) deposits.push_back(std::move(found.deposits));
        found_.clear();
        return deposits;
    }

private:
    struct Found {
        std::uint32_t batch;
        BackwardMap::Deposits deposits;
    };
    std::atomic<std::uint32_t> users_{0};  // 0: closed; the owner counts as one
    std::atomic<std::uint32_t> admitted_{0};
    std::uint32_t batches_ = 0;
    BackwardMap map_;
    std::mutex mutex_;
    std::vector<Found> found_;
};

/// Threads that share a map, and what they share of their work.
struct Group {
    explicit Group(int threads) : meeting(threads) {}

    std::vector<BinBlock> blocks;  // its part of the image
    std::vector<std::vector<BackwardPhoton>> stored;
    std::vector<BackwardTally> tallies;
    OpenMap open_map;
    std::vector<BackwardMap::Deposits> deposits;
    std::atomic<std::size_t> next_block{0}, next_part{0}, next_read{0};
    std::atomic<std::uint64_t> deposited{0};
    std::atomic<bool> closed{false};
    std::barrier<> meeting;
};

// As many groups as threads in each, about, and at least two.
int group_count(int threads) {
    if (threads < 2) return 1;
    return std::max(2, static_cast<int>(std::sqrt(static_cast<double>(threads))));
}

class Groups {
public:
    Groups(const Phase& phase, const TraceContext& context, const Plan& plan,
           std::span<const BinBlock> blocks, const ForwardMaps& maps, const Radii& hidden_radii,
           PhaseTrace& trace)
        : phase_(phase),
          context_(context),
          plan_(plan),
          maps_(maps),
          hidden_radii_(hidden_radii),
          trace_(trace),
          emission_(phase, RandomPurpose::secondary),
          batches_((plan.secondary_rays + forward_rays_per_block - 1) / forward_rays_per_block) {
        const int count = group_count(context.threads);
        for (int i = 0; i < count; ++i) {
            threads_of_.push_back(context.threads / count + (i < context.threads % count ? 1 : 0));
            groups_.push_back(std::make_unique<Group>(threads_of_.back()));
        }
        share_out(blocks);
    }

    void run() {
        std::vector<std::thread> threads;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            for (int i = 0; i < threads_of_[g]; ++i) {
                threads.emplace_back([this, g, i] { work(*groups_[g], i == 0); });
            }
        }
        for (std::thread& thread : threads) thread.join();
        trace_.backward_map_bytes = 0;
        std::vector<std::vector<CutKernel>> cut_kernels;
        for (const auto& group : groups_) {
            trace_.counts.deposits += group->deposited;
            trace_.counts.backward_photons += group->open_map.map().size();
            trace_.backward_map_bytes += group->open_map.map().bytes();
            for (BackwardTally& tally : group->tallies) {
                cut_kernels.push_back(std::move(tally.cut_kernels));
                trace_.counts.backward_segments += tally.segments;
                trace_.counts.shadow_segments += tally.shadow_segments;
            }
        }
        add_pooled_bias(cut_kernels, context_.threads, trace_.readings);
        trace_.balance_rays = std::uint64_t{batches_} * forward_rays_per_block;
        trace_.counts.secondary_rays += std::uint64_t{next_batch_} * forward_rays_per_block;
    }

private:
    // A random part of the blocks for each group, as large as its share of the threads.
    void share_out(std::span<const BinBlock> blocks) {
        std::vector<BinBlock> shuffled(blocks.begin(), blocks.end());
        RandomStream random(phase_.seed, phase_.number, RandomPurpose::masks, 0);
        for (std::size_t i = shuffled.size(); i > 1; --i) {
            const auto j = static_cast<std::size_t>(random.uniform() * static_cast<double>(i));
            std::swap(shuffled[i - 1], shuffled[j]);
        }
        std::size_t threads = 0;
        auto first = shuffled.begin();
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            threads += static_cast<std::size_t>(threads_of_[g]);
            const std::size_t end =
                shuffled.size() * threads / static_cast<std::size_t>(context_.threads);
            const auto last = shuffled.begin() + static_cast<std::ptrdiff_t>(end);
            groups_[g]->blocks.assign(first, last);
            groups_[g]->stored.resize(groups_[g]->blocks.size());
            groups_[g]->tallies.resize(groups_[g]->blocks.size());
            first = last;
        }
    }

    void work(Group& group, bool owner) {
        for (std::size_t i; (i = group.next_block++) < group.blocks.size();) {
            const BinBlock& block = group.blocks[i];
            group.stored[i] = trace_backward(
                phase_, plan_.collections, context_.readings.observers()[block.observer_bins],
                plan_.rays, block, context_.planes, maps_, trace_.readings, group.tallies[i]);
        }
        group.meeting.arrive_and_wait();
        if (owner) {
            group.open_map.open({phase_, hidden_radii_, std::move(group.stored), 1}, batches_);
        }
        // The others of the group go on with forward rays for the maps that are open by now.
        ForwardTally tally(context_.stage.parts());
        std::uint64_t hits = 0, segments = 0;
        const auto trace_batch = [&] { this->trace_batch(tally, hits, segments); };
        while (!group.closed) {
            trace_batch();
            if (owner && group.open_map.try_to_close()) {
                group.deposits = group.open_map.take();
                group.closed = true;
            }
        }
        group.meeting.arrive_and_wait();
        for (std::size_t part; (part = group.next_part++) < BackwardMap::parts;) {
            group.deposited += group.open_map.closed_map().apply(part, group.deposits);
        }
        group.meeting.arrive_and_wait();
        const std::uint64_t rays = std::uint64_t{batches_} * forward_rays_per_block;
        for (std::size_t i; (i = group.next_read++) < group.blocks.size();) {
            group.open_map.map().read(
                i, rays, [&](std::uint32_t bin, const Lanes& radiance, const Lanes& bias) {
                    trace_.readings.add(phase_, bin, radiance, bias);
                });
        }
        if (owner) ++closed_maps_;
        while (closed_maps_ < groups_.size()) trace_batch();
        const std::scoped_lock lock(mutex_);
        trace_.tally += tally;
        trace_.counts.scattering_hits += hits;
        trace_.counts.forward_segments += segments;
    }

    // Traces the next rays and deposits them in all maps that take them.
    void trace_batch(ForwardTally& tally, std::uint64_t& hits, std::uint64_t& segments) {
        std::vector<std::size_t> entered;
        for (std::size_t g = 0; g < groups_.size(); ++g) {
            if (groups_[g]->open_map.enter()) entered.push_back(g);
        }
        if (entered.empty() && next_batch_ >= batches_) {
            std::this_thread::yield();
            return;
        }
        const std::uint32_t batch = next_batch_++;
        // The flux balance takes the first rays, so that their number is fixed as well.
        const bool counts = batch < batches_;
        std::vector<BackwardMap::Deposits> deposits(entered.size());
        ForwardTally of_batch(context_.stage.parts());
        for (std::uint32_t i = 0; i < forward_rays_per_block; ++i) {
            trace_forward(phase_, emission_, batch * forward_rays_per_block + i, Reach::whole_path,
                          nullptr, of_batch, [&](const Photon& photon) {
                              ++hits;
                              for (std::size_t k = 0; k < entered.size(); ++k) {
                                  groups_[entered[k]]->open_map.map().find(photon, deposits[k]);
                              }
                          });
        }
        for (std::size_t k = 0; k < entered.size(); ++k) {
            groups_[entered[k]]->open_map.leave(batch, std::move(deposits[k]));
        }
        segments += of_batch.segments;
        if (counts) tally += of_batch;
    }

    const Phase& phase_;
    const TraceContext& context_;
    const Plan& plan_;
    const ForwardMaps& maps_;
    const Radii& hidden_radii_;
    PhaseTrace& trace_;
    Emission emission_;
    std::uint32_t batches_;  // that each map takes
    std::vector<int> threads_of_;
    std::vector<std::unique_ptr<Group>> groups_;
    std::atomic<std::uint32_t> next_batch_{0};
    std::atomic<std::size_t> closed_maps_{0};
    std::mutex mutex_;
};

}  // namespace

void trace_in_groups(const Phase& phase, const TraceContext& context, const Plan& plan,
                     std::span<const BinBlock> blocks, const ForwardMaps& maps,
                     const Radii& hidden_radii, PhaseTrace& trace) {
    const Stopwatch watch;
    Groups(phase, context, plan, blocks, maps, hidden_radii, trace).run();
    trace.counts.secondary_s += watch.seconds();
}

}  // namespace lucerna::optics
