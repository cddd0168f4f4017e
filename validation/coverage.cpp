#include "validation/coverage.h"

#include <algorithm>
#include <cmath>

namespace lucerna::validation {
namespace {

constexpr std::size_t seeds_for_width = 10;
// A truth whose error is a larger share of U says nothing about U: published digits of colours.
constexpr double largest_truth_error = 0.25;

double probability(std::size_t hits, std::size_t trials, double p) {
    if (p <= 0.0) return hits == 0 ? 1.0 : 0.0;
    if (p >= 1.0) return hits == trials ? 1.0 : 0.0;
    const auto n = static_cast<double>(trials);
    const auto k = static_cast<double>(hits);
    return std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                    k * std::log(p) + (n - k) * std::log1p(-p));
}

// P(at most `hits` of `trials`).
double at_most(std::size_t hits, std::size_t trials, double p) {
    double sum = 0.0;
    for (std::size_t k = 0; k <= hits; ++k) sum += probability(k, trials, p);
    return sum;
}

// Where a function that falls with p is as given.
template <typename Function>
double solve(const Function& falling, double value) {
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (low + high);
        (falling(middle) > value ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

struct Gathered {
    Coverage coverage;
    double z_sum = 0.0;
    std::vector<double> widths;

    void add(const CaseOutcome& outcome, std::size_t check) {
        const double truth = outcome.of->checks[check].truth;
        std::vector<double> expanded, values;
        for (const Run& run : outcome.runs) {
            const CheckOutcome& own = run.checks[check];
            const Reading& reading = own.reading;
            if (outcome.of->checks[check].truth_error >
                largest_truth_error * reading.expanded_uncertainty) {
                continue;
            }
            ++coverage.stated.trials;
            ++coverage.noise_only.trials;
            if (own.within_u) ++coverage.stated.hits;
            if (std::abs(reading.uncorrected_value - truth) <=
                1.96 * reading.uncorrected_standard_error) {
                ++coverage.noise_only.hits;
            }
            z_sum += own.z;
            expanded.push_back(reading.expanded_uncertainty);
            values.push_back(reading.value);
        }
        if (values.size() < seeds_for_width) return;
        const auto n = static_cast<double>(values.size());
        double mean = 0.0;
        for (const double value : values) mean += value / n;
        double variance = 0.0;
        for (const double value : values) variance += (value - mean) * (value - mean) / (n - 1.0);
        if (variance > 0.0) widths.push_back(median(expanded) / (1.96 * std::sqrt(variance)));
    }

    Coverage result() {
        coverage.mean_z = z_sum / static_cast<double>(coverage.stated.trials);
        if (!widths.empty()) coverage.relative_width = median(widths);
        return coverage;
    }
};

}  // namespace

double Share::fraction() const {
    return static_cast<double>(hits) / static_cast<double>(trials);
}

double Share::lower() const {
    if (hits == 0) return 0.0;
    return solve([&](double p) { return at_most(hits - 1, trials, p); }, 0.975);
}

double Share::upper() const {
    if (hits == trials) return 1.0;
    return solve([&](double p) { return at_most(hits, trials, p); }, 0.025);
}

std::array<std::size_t, 2> binomial_bounds(std::size_t trials, double p) {
    std::size_t low = 0;
    double below = probability(0, trials, p);  // P(at most low)
    while (below <= 0.025) below += probability(++low, trials, p);
    std::size_t high = low;
    while (below < 0.975 && high < trials) below += probability(++high, trials, p);
    return {low, high};
}

std::vector<Coverage> coverage(const std::vector<CaseOutcome>& outcomes) {
    std::vector<Gathered> rows;
    Gathered all;
    all.coverage.quantity = "all";
    for (const CaseOutcome& outcome : outcomes) {
        for (std::size_t check = 0; check < outcome.of->checks.size(); ++check) {
            const std::string& quantity = outcome.of->checks[check].quantity;
            auto row = std::find_if(rows.begin(), rows.end(), [&](const Gathered& r) {
                return r.coverage.quantity == quantity;
            });
            if (row == rows.end()) {
                rows.emplace_back().coverage.quantity = quantity;
                row = std::prev(rows.end());
            }
            row->add(outcome, check);
            all.add(outcome, check);
        }
    }
    std::vector<Coverage> result;
    for (Gathered& row : rows) {
        if (row.coverage.stated.trials > 0) result.push_back(row.result());
    }
    if (all.coverage.stated.trials > 0) result.push_back(all.result());
    return result;
}

}  // namespace lucerna::validation
