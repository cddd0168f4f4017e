#include "core/batch_means.h"

#include <algorithm>

namespace lucerna {

void BatchMeans::add(std::span<const double> values) {
    if (phases_ == most_batches * batch_size_) {
        for (std::size_t pair = 0; pair < most_batches / 2; ++pair) {
            for (std::size_t i = 0; i < value_count_; ++i) {
                sums_[pair * value_count_ + i] =
                    sums_[2 * pair * value_count_ + i] + sums_[(2 * pair + 1) * value_count_ + i];
            }
        }
        sums_.resize(most_batches / 2 * value_count_);
        batch_size_ *= 2;
    }
    if (phases_ % batch_size_ == 0) sums_.resize(sums_.size() + value_count_, 0.0);
    double* last = sums_.data() + sums_.size() - value_count_;
    for (std::size_t i = 0; i < value_count_; ++i) last[i] += values[i];
    ++phases_;
    if (phases_ % batch_size_ != 0) return;
    complete_sums_.resize(value_count_, 0.0);
    for (std::size_t i = 0; i < value_count_; ++i) complete_sums_[i] += last[i];
}

double BatchMeans::mean(std::size_t value) const {
    if (phases_ == 0) return 0.0;
    double sum = complete_sums_.empty() ? 0.0 : complete_sums_[value];
    if (phases_ % batch_size_ != 0) sum += sums_[sums_.size() - value_count_ + value];
    return sum / static_cast<double>(phases_);
}

}  // namespace lucerna
