#include "core/batch_means.h"

namespace lucerna {
namespace {

void add_to(std::span<double> sums, std::span<const double> values) {
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += values[i];
}

}  // namespace

void BatchMeans::add(std::span<const double> values) {
    if (complete_batches_ == most_batches) join_pairs();
    add_to(open_, values);
    ++phases_;
    if (++open_phases_ < batch_size_) return;
    add_to(complete_, open_);
    batches_.insert(batches_.end(), open_.begin(), open_.end());
    ++complete_batches_;
    open_.assign(value_count_, 0.0);
    open_phases_ = 0;
}

// Batches twice as large. One that has no partner is left outside.
void BatchMeans::join_pairs() {
    const std::size_t pairs = complete_batches_ / 2;
    if (complete_batches_ % 2 == 1) {
        const auto last = batch(complete_batches_ - 1);
        add_to(outside_, last);
        for (std::size_t i = 0; i < value_count_; ++i) complete_[i] -= last[i];
    }
    for (std::size_t pair = 0; pair < pairs; ++pair) {
        for (std::size_t i = 0; i < value_count_; ++i) {
            batches_[pair * value_count_ + i] = batch(2 * pair)[i] + batch(2 * pair + 1)[i];
        }
    }
    batches_.resize(pairs * value_count_);
    complete_batches_ = pairs;
    batch_size_ *= 2;
}

void BatchMeans::merge(const BatchMeans& other) {
    BatchMeans same_size = other;
    while (batch_size_ < same_size.batch_size_) join_pairs();
    while (same_size.batch_size_ < batch_size_) same_size.join_pairs();
    add_to(outside_, same_size.outside_);
    add_to(outside_, same_size.open_);
    add_to(complete_, same_size.complete_);
    batches_.insert(batches_.end(), same_size.batches_.begin(), same_size.batches_.end());
    complete_batches_ += same_size.complete_batches_;
    phases_ += same_size.phases_;
    while (complete_batches_ > most_batches) join_pairs();
}

BatchMeans::Covariation BatchMeans::covariation(std::size_t value, std::size_t other) const {
    const double mean_of_value = complete_[value] / static_cast<double>(complete_batches_);
    const double mean_of_other = complete_[other] / static_cast<double>(complete_batches_);
    Covariation together{0.0, 0.0};
    for (std::size_t i = 0; i < complete_batches_; ++i) {
        const double deviation = batch(i)[other] - mean_of_other;
        together.product += deviation * (batch(i)[value] - mean_of_value);
        together.square += deviation * deviation;
    }
    return together;
}

double BatchMeans::Means::relative_slope(std::size_t value, std::size_t other,
                                         const Covariation& together) const {
    auto [product, square] = together;
    double sum_of_value = all_.complete_[value], sum_of_other = all_.complete_[other];
    if (left_out_ != none) {
        // Without a batch its deviations from the means of the others are gone, which are larger
        // by n / (n - 1) than those from the means of all.
        const auto batches = static_cast<double>(all_.complete_batches_);
        const auto batch = all_.batch(left_out_);
        const double of_value = batch[value] - sum_of_value / batches;
        const double of_other = batch[other] - sum_of_other / batches;
        product -= batches / (batches - 1.0) * of_other * of_value;
        square -= batches / (batches - 1.0) * of_other * of_other;
        sum_of_value -= batch[value];
        sum_of_other -= batch[other];
    }
    if (!(square > 0.0) || sum_of_value == 0.0) return 0.0;
    return product / square * sum_of_other / sum_of_value;
}

double BatchMeans::mean(std::size_t value) const {
    if (phases_ == 0) return 0.0;
    return (complete_[value] + open_[value] + outside_[value]) / static_cast<double>(phases_);
}

}  // namespace lucerna
