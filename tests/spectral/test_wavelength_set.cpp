#include "spectral/wavelength_set.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <stdexcept>

#include "core/random.h"
#include "core/statistics.h"
#include "spectral/illuminants.h"
#include "tests/spectral/reference_table.h"
#include "tests/support/chi_square.h"

using namespace lucerna;
using namespace lucerna::spectral;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr double k_m = 683.002;

// Another one for each number, all as likely.
int random_lane(std::uint32_t number) {
    return static_cast<int>(RandomStream(3, number, RandomPurpose::test, 0).uniform() * lane_count);
}

struct Colour {
    double luminance = 0.0;
    double x = 0.0;
    double z = 0.0;
};

// Direct quadrature: midpoint rule at 0.01 nm with the tables read by the test.
Colour by_quadrature(const Spectrum& spectrum) {
    static const auto cmf = reference_table("cie1931_2deg_cmf_1nm.csv");
    static const auto v = reference_table("cie1924_V_1nm.csv").at("V");
    Colour sum;
    for (int nm = 360; nm < 830; ++nm) {
        for (int i = 0; i < 100; ++i) {
            const double t = (i + 0.5) / 100.0;
            const auto at = [&](const std::map<int, double>& table) {
                return table.at(nm) * (1.0 - t) + table.at(nm + 1) * t;
            };
            const double value = spectrum.at(nm + t) * k_m / 100.0;
            sum.luminance += value * at(v);
            sum.x += value * at(cmf.at("xbar"));
            sum.z += value * at(cmf.at("zbar"));
        }
    }
    return sum;
}

Colour by_phase(const WavelengthSet& set, const Spectrum& spectrum) {
    const Lanes radiance = set.at(spectrum);
    return {static_cast<double>((radiance * set.luminance).sum()),
            static_cast<double>((radiance * set.x).sum()),
            static_cast<double>((radiance * set.z).sum())};
}

// Probability below a wavelength, from the density by counting up.
class Probability {
public:
    explicit Probability(const WavelengthSampler& sampler) {
        for (int i = 0; i < 47000; ++i) {
            below_.push_back(below_.back() + step_nm * sampler.pdf_per_nm(at_nm(i + 0.5)));
        }
    }
    double below(double wavelength_nm) const {
        const double place = (wavelength_nm - 360.0) / step_nm;
        const auto node = std::min(static_cast<std::size_t>(place), below_.size() - 2);
        return std::lerp(below_[node], below_[node + 1], place - static_cast<double>(node));
    }

private:
    static constexpr double step_nm = 0.01;
    static double at_nm(double step) { return 360.0 + step * step_nm; }
    std::vector<double> below_{0.0};
};

// A function on the circle [0, 1), known at random places: its mean and its standard deviation
// over a uniform place by the trapezoid rule between them, far more exactly than their average.
class OverPlaces {
public:
    void add(double place, double value) { points_.emplace_back(place, value); }
    double mean() {
        return integral([](double value) { return value; });
    }
    // Relative to the mean.
    double spread() {
        const double centre = mean();
        return std::sqrt(integral([&](double v) { return (v - centre) * (v - centre); })) / centre;
    }

private:
    template <typename Of>
    double integral(const Of& of) {
        std::ranges::sort(points_);
        double sum = 0.0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            const auto& [place, value] = points_[i];
            const bool last = i + 1 == points_.size();
            const auto& [next_place, next_value] = points_[last ? 0 : i + 1];
            const double gap = next_place - place + (last ? 1.0 : 0.0);
            sum += 0.5 * gap * (of(value) + of(next_value));
        }
        return sum;
    }
    std::vector<std::pair<double, double>> points_;
};

const Spectrum red_paint({360.0, 560.0, 620.0, 830.0}, {0.05, 0.08, 0.75, 0.85}, Outside::hold);
const Spectrum laser_line({531.8, 532.0, 532.2}, {0.0, 1.0, 0.0}, Outside::zero);

}  // namespace

TEST_CASE("The density is normalised and positive", "[property]") {
    const auto dispersion = GENERATE(Dispersion::none, Dispersion::present);
    const char* name = GENERATE("E", "A", "FL11", "LED-RGB1", "HP1");
    const WavelengthSampler sampler(*illuminant(name), dispersion);
    double area = 0.0;
    double least = 1.0;
    for (int i = 0; i < 47000; ++i) {
        const double pdf = sampler.pdf_per_nm(360.0 + (i + 0.5) * 0.01);
        area += pdf * 0.01;
        least = std::min(least, pdf);
    }
    CHECK_THAT(area, WithinAbs(1.0, 1e-9));
    CHECK(least > 0.019 / 470.0);
    CHECK(sampler.pdf_per_nm(359.9) == 0.0);
    CHECK(sampler.pdf_per_nm(830.1) == 0.0);
}

TEST_CASE("The wavelengths of a phase lie one in each stratum, at one shift", "[property]") {
    const WavelengthSampler sampler(*illuminant("LED-B3"));
    for (std::uint32_t phase = 0; phase < 40; ++phase) {
        const WavelengthSet set = sampler.sample(7, phase);
        double first_shift = -1.0;
        double probability = 0.0;
        double from_nm = 360.0;
        for (int k = 0; k < lane_count; ++k) {
            const double to_nm = set.wavelength_nm[static_cast<std::size_t>(k)];
            REQUIRE(to_nm >= from_nm);
            const int steps = 4000;  // midpoint rule for the probability below the wavelength
            for (int i = 0; i < steps; ++i) {
                const double width_nm = (to_nm - from_nm) / steps;
                probability += sampler.pdf_per_nm(from_nm + (i + 0.5) * width_nm) * width_nm;
            }
            from_nm = to_nm;
            const double shift = probability * lane_count - k;
            if (k == 0) first_shift = shift;
            CHECK(shift > -1e-4);
            CHECK(shift < 1.0 + 1e-4);
            CHECK_THAT(shift, WithinAbs(first_shift, 1e-4));
            CHECK_THAT(static_cast<double>(set.interval_nm[k]),
                       WithinRel(1.0 / (16.0 * sampler.pdf_per_nm(to_nm)), 1e-6));
        }
    }
}

TEST_CASE("Luminance and colour are unbiased and steady from phase to phase", "[statistical]") {
    struct Case {
        const char* name;
        double luminance_spread;
        double x_spread;
        double z_spread;
    };
    // Spreads by quadrature over the shift, rounded up (see wavelength_set.h).
    const Case row = GENERATE(Case{"E", 0.007, 0.03, 0.06}, Case{"A", 0.006, 0.02, 0.22},
                              Case{"LED-B3", 0.006, 0.03, 0.14},
                              Case{"LED-RGB1", 0.014, 0.03, 0.21}, Case{"FL11", 0.017, 0.04, 0.08});
    INFO(row.name);
    const Spectrum emission = *illuminant(row.name);
    const WavelengthSampler sampler(emission);
    const Colour truth = by_quadrature(emission);

    const Probability probability(sampler);
    OverPlaces luminance;
    OverPlaces x;
    OverPlaces z;
    for (std::uint32_t phase = 0; phase < 4000; ++phase) {
        const WavelengthSet set = sampler.sample(11, phase);
        const double shift = lane_count * probability.below(set.wavelength_nm[0]);
        const Colour found = by_phase(set, emission);
        luminance.add(shift, found.luminance);
        x.add(shift, found.x);
        z.add(shift, found.z);
    }
    CHECK(luminance.spread() < row.luminance_spread);
    CHECK(x.spread() < row.x_spread);
    CHECK(z.spread() < row.z_spread);
    CHECK_THAT(luminance.mean(), WithinRel(truth.luminance, 1e-4));
    CHECK_THAT(x.mean(), WithinRel(truth.x, 2e-4));
    CHECK_THAT(z.mean(), WithinRel(truth.z, 5e-4));
    // The twin that must fail: the uniform weight instead of 1 / (N p).
    Estimate wrong;
    for (std::uint32_t phase = 0; phase < 100; ++phase) {
        WavelengthSet set = sampler.sample(11, phase);
        set.luminance *= 470.0f / 16.0f / set.interval_nm;
        wrong.add(by_phase(set, emission).luminance);
    }
    CHECK(std::abs(wrong.mean() / truth.luminance - 1.0) > 0.1);
}

TEST_CASE("Light that is not the sum of all lights is unbiased too", "[statistical]") {
    const WavelengthSampler sampler(*illuminant("LED-RGB1"));
    const Spectrum& reflected = GENERATE(true, false) ? red_paint : laser_line;
    const Colour truth = by_quadrature(reflected);
    const Probability probability(sampler);
    OverPlaces luminance;
    for (std::uint32_t phase = 0; phase < 20000; ++phase) {
        const WavelengthSet set = sampler.sample(3, phase);
        luminance.add(lane_count * probability.below(set.wavelength_nm[0]),
                      by_phase(set, reflected).luminance);
    }
    CHECK_THAT(luminance.mean(), WithinRel(truth.luminance, 0.01));
}

TEST_CASE("A single line of emission is found", "[statistical]") {
    const Spectrum between_nodes({500.2, 500.4}, {1.0, 1.0}, Outside::zero);
    const Spectrum& emission = GENERATE(true, false) ? laser_line : between_nodes;
    const WavelengthSampler sampler(emission);
    const Colour truth = by_quadrature(emission);
    const Probability probability(sampler);
    OverPlaces luminance;
    for (std::uint32_t phase = 0; phase < 4000; ++phase) {
        const WavelengthSet set = sampler.sample(5, phase);
        luminance.add(lane_count * probability.below(set.wavelength_nm[0]),
                      by_phase(set, emission).luminance);
    }
    // The 1 nm grid of the density spreads the line over 2 nm, which costs some noise only.
    CHECK(luminance.spread() < 0.4);
    CHECK_THAT(luminance.mean(), WithinRel(truth.luminance, 0.01));
}

TEST_CASE("A lane chosen at random estimates luminance without bias", "[statistical]") {
    const auto dispersion = GENERATE(Dispersion::none, Dispersion::present);
    const Spectrum emission = *illuminant(GENERATE("E", "LED-B3"));
    const WavelengthSampler sampler(emission, dispersion);
    const Colour truth = by_quadrature(emission);
    const Probability probability(sampler);
    OverPlaces luminance;
    for (std::uint32_t phase = 0; phase < 4096; ++phase) {
        const WavelengthSet set = sampler.sample(17, phase);
        const Lanes contribution = set.at(emission) * set.luminance;
        const int hero = random_lane(phase);
        luminance.add(probability.below(set.wavelength_nm[static_cast<std::size_t>(hero)]),
                      static_cast<double>(lane_count * contribution[hero]));
    }
    CHECK_THAT(luminance.mean(), WithinRel(truth.luminance, 2e-3));
    CHECK(luminance.spread() < (dispersion == Dispersion::present ? 0.30 : 0.65));
}

TEST_CASE("Shift and common lanes are uniform and independent over phases and seeds",
          "[statistical]") {
    const WavelengthSampler sampler(Spectrum(1.0));
    std::vector<double> counts(64);  // 2 sets of lanes x 32 parts of the shift
    const bool over_seeds = GENERATE(false, true);
    const std::uint32_t of_phase = GENERATE(0u, 7u);
    for (std::uint32_t i = 0; i < 6400; ++i) {
        const WavelengthSet set =
            over_seeds ? sampler.sample(i, 5, of_phase) : sampler.sample(5, i, of_phase);
        double probability = 0.0;  // below the first wavelength: shift / 16
        const double width_nm = (set.wavelength_nm[0] - 360.0) / 200.0;
        for (int k = 0; k < 200; ++k) {
            probability += sampler.pdf_per_nm(360.0 + (k + 0.5) * width_nm) * width_nm;
        }
        const int part = std::clamp(static_cast<int>(probability * 16.0 * 32.0), 0, 31);
        counts[static_cast<std::size_t>(set.first_common * 32 + part)] += 1.0;
    }
    test::check_follows(counts, std::vector<double>(64, 100.0));
}

TEST_CASE("Wavelengths follow the density that the header states", "[statistical]") {
    // Over seeds these are independent. For equal energy the density is
    // a V + b (x + y + z) + (c + d) / 470 nm, each of area 1, here from the tables read by the
    // test.
    const auto [dispersion, a, b] = GENERATE(table<Dispersion, double, double>(
        {{Dispersion::none, 0.40, 0.40}, {Dispersion::present, 0.80, 0.10}}));
    const auto cmf = reference_table("cie1931_2deg_cmf_1nm.csv");
    const auto v = reference_table("cie1924_V_1nm.csv").at("V");
    constexpr int cells = 94, nm_per_cell = 5, seeds = 100'000;
    const auto expected = [&](double of_v, double of_colour) {
        std::vector<double> eye(cells), colour(cells), counts(cells);
        double eye_area = 0.0, colour_area = 0.0;
        for (int nm = 360; nm < 830; ++nm) {
            const auto cell = static_cast<std::size_t>((nm - 360) / nm_per_cell);
            for (const int node : {nm, nm + 1}) {  // trapezoid
                const double all =
                    cmf.at("xbar").at(node) + cmf.at("ybar").at(node) + cmf.at("zbar").at(node);
                eye[cell] += 0.5 * v.at(node);
                eye_area += 0.5 * v.at(node);
                colour[cell] += 0.5 * all;
                colour_area += 0.5 * all;
            }
        }
        for (std::size_t i = 0; i < counts.size(); ++i) {
            counts[i] = seeds * (of_v * eye[i] / eye_area + of_colour * colour[i] / colour_area +
                                 (1.0 - of_v - of_colour) / cells);
        }
        return counts;
    };
    const WavelengthSampler sampler(Spectrum(1.0), dispersion);
    std::vector<double> counts(cells);
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const WavelengthSet set = sampler.sample(seed, 3);
        const double nm = set.wavelength_nm[static_cast<std::size_t>(
            random_lane(static_cast<std::uint32_t>(seed)))];
        counts[std::min<std::size_t>(cells - 1,
                                     static_cast<std::size_t>((nm - 360.0) / nm_per_cell))] += 1.0;
    }
    test::check_follows(counts, expected(a, b));
    test::check_refutes(counts, expected(a, b), expected(a + 0.06, b - 0.06));  // the twin
}

TEST_CASE("A set depends on seed and phase only", "[property]") {
    const WavelengthSampler one(*illuminant("D65"));
    const WavelengthSampler two(*illuminant("D65"));
    CHECK(one.sample(4, 1000).wavelength_nm == two.sample(4, 1000).wavelength_nm);
    CHECK(one.sample(4, 1000).wavelength_nm != one.sample(4, 1001).wavelength_nm);
    CHECK(one.sample(4, 1000).wavelength_nm != one.sample(5, 1000).wavelength_nm);
    CHECK(one.sample(4, 4294967295u).wavelength_nm[0] >= 360.0);
}

TEST_CASE("Parts of a phase fill the gaps between each other's wavelengths", "[property]") {
    const WavelengthSampler sampler(Spectrum(1.0), Dispersion::present);
    const Probability probability(sampler);
    constexpr std::uint32_t parts = 64;
    const auto widest_gap = [&](const auto& set_of) {
        std::vector<double> shifts{0.0, 1.0};
        for (std::uint32_t part = 0; part < parts; ++part) {
            shifts.push_back(lane_count * probability.below(set_of(part).wavelength_nm[0]));
        }
        std::ranges::sort(shifts);
        double widest = 0.0;
        for (std::size_t i = 1; i < shifts.size(); ++i) {
            widest = std::max(widest, shifts[i] - shifts[i - 1]);
        }
        return widest;
    };
    for (std::uint32_t phase = 0; phase < 10; ++phase) {
        CHECK(widest_gap([&](std::uint32_t part) { return sampler.sample(1, phase, 1 + part); }) <
              3.0 / parts);
        int first_common = 0;
        for (std::uint32_t part = 0; part < parts; ++part) {
            first_common += sampler.sample(1, phase, 1 + part).first_common;
        }
        CHECK(std::abs(first_common - static_cast<int>(parts) / 2) <= 3);
        // The twin: independent sets leave gaps of about ln(64) / 64.
        CHECK(widest_gap([&](std::uint32_t part) {
                  return sampler.sample(2, phase * parts + part);
              }) > 3.0 / parts);
    }
    CHECK(sampler.sample(1, 3).wavelength_nm == sampler.sample(1, 3, 0).wavelength_nm);
}

TEST_CASE("The scale of the emission does not matter", "[property]") {
    const Spectrum emission = *illuminant("D65");
    const WavelengthSampler one(emission);
    const WavelengthSampler two(emission.scaled(1e-9));
    CHECK_THAT(one.pdf_per_nm(500.0), WithinRel(two.pdf_per_nm(500.0), 1e-12));
}

TEST_CASE("An emission without visible light is refused", "[unit]") {
    CHECK_THROWS_AS(WavelengthSampler(Spectrum(0.0)), std::invalid_argument);
    CHECK_THROWS_AS(WavelengthSampler(Spectrum({850.0, 900.0}, {1.0, 1.0}, Outside::zero)),
                    std::invalid_argument);
    CHECK_THROWS_AS(WavelengthSampler(Spectrum({400.0, 500.0}, {1.0, -1.0}, Outside::hold)),
                    std::invalid_argument);
}
