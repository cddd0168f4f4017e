#include "spectral/illuminants.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "spectral/colorimetry.h"
#include "tests/spectral/reference_table.h"

using namespace lucerna::spectral;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

struct Published {
    const char* name;
    double x;
    double y;
    double cct_k;  // 0: not printed
};

// Chromaticity for the 2 deg observer and correlated colour temperature as CIE 15:2004 and, for
// LED, CIE 15:2018 print them; checked against the collection of chromaticities in
// colour-science/colour (colour/colorimetry/datasets/illuminants/chromaticity_coordinates.py).
const std::vector<Published> published = {
    {"A", 0.44758, 0.40745, 2856},     {"C", 0.31006, 0.31616, 6774},
    {"D50", 0.34567, 0.35851, 5003},   {"D55", 0.33243, 0.34744, 5503},
    {"D65", 0.31272, 0.32903, 6504},   {"D75", 0.29903, 0.31488, 7504},
    {"E", 1.0 / 3.0, 1.0 / 3.0, 0},    {"FL1", 0.3131, 0.3371, 6430},
    {"FL2", 0.3721, 0.3751, 4230},     {"FL3", 0.4091, 0.3941, 3450},
    {"FL4", 0.4402, 0.4031, 2940},     {"FL5", 0.3138, 0.3452, 6350},
    {"FL6", 0.3779, 0.3882, 4150},     {"FL7", 0.3129, 0.3292, 6500},
    {"FL8", 0.3458, 0.3586, 5000},     {"FL9", 0.3741, 0.3727, 4150},
    {"FL10", 0.3458, 0.3588, 5000},    {"FL11", 0.3805, 0.3769, 4000},
    {"FL12", 0.4370, 0.4042, 3000},    {"FL3.1", 0.4407, 0.4033, 2932},
    {"FL3.2", 0.3808, 0.3734, 3965},   {"FL3.3", 0.3153, 0.3439, 6280},
    {"FL3.4", 0.4429, 0.4043, 2904},   {"FL3.5", 0.3749, 0.3672, 4086},
    {"FL3.6", 0.3488, 0.3600, 4894},   {"FL3.7", 0.4384, 0.4045, 2979},
    {"FL3.8", 0.3820, 0.3832, 4006},   {"FL3.9", 0.3499, 0.3591, 4853},
    {"FL3.10", 0.3455, 0.3560, 5000},  {"FL3.11", 0.3245, 0.3434, 5854},
    {"FL3.12", 0.4377, 0.4037, 2984},  {"FL3.13", 0.3830, 0.3724, 3896},
    {"FL3.14", 0.3447, 0.3609, 5045},  {"FL3.15", 0.3127, 0.3288, 6509},
    {"HP1", 0.5330, 0.4150, 1959},     {"HP2", 0.4778, 0.4158, 2506},
    {"HP3", 0.4302, 0.4075, 3144},     {"HP4", 0.3812, 0.3797, 4002},
    {"HP5", 0.3776, 0.3713, 4039},     {"LED-B1", 0.4560, 0.4078, 2733},
    {"LED-B2", 0.4357, 0.4012, 2998},  {"LED-B3", 0.3756, 0.3723, 4103},
    {"LED-B4", 0.3422, 0.3502, 5109},  {"LED-B5", 0.3118, 0.3236, 6598},
    {"LED-BH1", 0.4474, 0.4066, 2851}, {"LED-RGB1", 0.4557, 0.4211, 2840},
    {"LED-V1", 0.4548, 0.4044, 2724},  {"LED-V2", 0.3781, 0.3775, 4070},
    {"ID65", 0.310657, 0.330663, 0},   {"ID50", 0.343211, 0.360208, 0},
};

// Tristimulus values as the CIE computes them for its tables: a sum at 5 nm from 380 to 780 nm.
Xyz sum_at_5_nm(const Spectrum& spectrum) {
    static const auto observer = reference_table("cie1931_2deg_cmf_1nm.csv");
    Xyz sum;
    for (int nm = 380; nm <= 780; nm += 5) {
        sum.x += spectrum.at(nm) * observer.at("xbar").at(nm);
        sum.y += spectrum.at(nm) * observer.at("ybar").at(nm);
        sum.z += spectrum.at(nm) * observer.at("zbar").at(nm);
    }
    return sum;
}

}  // namespace

TEST_CASE("Illuminants have the chromaticity that the CIE prints", "[unit]") {
    const Published expected = GENERATE(from_range(published));
    INFO(expected.name);
    const std::optional<Spectrum> spectrum = illuminant(expected.name);
    REQUIRE(spectrum);

    // By the CIE's own sum: to the last printed digit.
    const Xyz sum = sum_at_5_nm(*spectrum);
    CHECK_THAT(chromaticity(sum)->x, WithinAbs(expected.x, 1.0e-4));
    CHECK_THAT(chromaticity(sum)->y, WithinAbs(expected.y, 1.0e-4));
    if (expected.cct_k > 0.0) {
        // FL1 to FL12 are printed in steps of 10 K
        const std::string name = expected.name;
        const bool tens = name.starts_with("FL") && name.find('.') == name.npos;
        const auto temperature = correlated_colour_temperature(sum);
        REQUIRE(temperature);
        CHECK_THAT(temperature->cct_k, WithinAbs(expected.cct_k, tens ? 6.0 : 2.0));
    }

    // By the integral: the step of the table shows.
    const Xyz integral = tristimulus(*spectrum);
    CHECK_THAT(chromaticity(integral)->x, WithinAbs(expected.x, 4e-4));
    CHECK_THAT(chromaticity(integral)->y, WithinAbs(expected.y, 4e-4));
}

TEST_CASE("Every illuminant is known by each of its names", "[unit]") {
    for (const std::string& name : illuminant_names()) {
        INFO(name);
        CHECK(std::any_of(published.begin(), published.end(),
                          [&](const Published& row) { return row.name == name; }));
        REQUIRE(illuminant(name));
        CHECK(illuminant(name)->outside() == Outside::zero);
        CHECK(illuminant(name)->min() >= 0.0);
        CHECK(illuminant("CIE-" + name)->values() == illuminant(name)->values());
    }
    CHECK(illuminant_names().size() == published.size());
    CHECK(illuminant("cie-led-b3")->values() == illuminant("LED-B3")->values());
    CHECK(illuminant("F11")->values() == illuminant("FL11")->values());
    CHECK(illuminant("f3.1")->values() == illuminant("FL3.1")->values());
    CHECK_FALSE(illuminant("FL13"));
    CHECK_FALSE(illuminant("B"));
    CHECK_FALSE(illuminant("D6"));
    CHECK_FALSE(illuminant(""));
    CHECK_FALSE(illuminant("CIE-"));
}

TEST_CASE("Illuminant A follows its table", "[unit]") {
    const auto table = reference_table("cie_illuminants_standard.csv").at("A");
    const Spectrum a = *illuminant("A");
    for (const auto& [nm, value] : table) CHECK_THAT(a.at(nm), WithinRel(value, 1e-5));
    CHECK_THAT(a.at(560.0), WithinRel(100.0, 1e-14));
}

TEST_CASE("Daylight of 6503.6 K is D65", "[unit]") {
    const double remark = 1.4388 / 1.4380;  // CIE 15:2018, note on the change of c2
    for (const auto& [name, nominal_k] :
         {std::pair{"D50", 5000.0}, {"D55", 5500.0}, {"D65", 6500.0}, {"D75", 7500.0}}) {
        const Spectrum formula = lucerna::spectral::daylight(nominal_k * remark);
        const auto table = reference_table("cie_illuminants_standard.csv").at(name);
        for (const auto& [nm, value] : table) {
            INFO(name << " at " << nm << " nm");
            // The tables are made with M1 and M2 of three decimals: 0.0005 * S1 < 0.025.
            CHECK_THAT(formula.at(nm), WithinAbs(value, 0.03));
        }
        // Without the remark it is another spectrum.
        const Spectrum nominal = lucerna::spectral::daylight(nominal_k);
        CHECK(std::abs(nominal.at(400.0) - illuminant(name)->at(400.0)) > 0.03);
    }
    CHECK_THROWS_AS(lucerna::spectral::daylight(3999.0), std::invalid_argument);
    CHECK_THROWS_AS(lucerna::spectral::daylight(25001.0), std::invalid_argument);
}

TEST_CASE("Daylight has the correlated colour temperature it is made for", "[property]") {
    const double cct_k = GENERATE(4000.0, 5000.0, 6500.0, 7000.0, 10000.0, 25000.0);
    const auto found =
        correlated_colour_temperature(tristimulus(lucerna::spectral::daylight(cct_k)));
    REQUIRE(found);
    // The polynomials of the CIE are a fit; D65 of 6503.6 K comes out at 6502.6 K.
    CHECK_THAT(found->cct_k, WithinRel(cct_k, 2e-3));
    CHECK(found->duv > 0.001);
    CHECK(found->duv < 0.005);
}

TEST_CASE("A black body obeys Wien's displacement and known radiances", "[analytic]") {
    // Wien: the maximum of L_lambda lies at b / T, b = 2897.771955 um K (CODATA 2018).
    const Spectrum body = planck(5000.0);
    const auto peak = std::max_element(body.values().begin(), body.values().end());
    const double peak_nm =
        body.wavelengths_nm()[static_cast<std::size_t>(peak - body.values().begin())];
    CHECK_THAT(peak_nm, WithinAbs(2897771.955 / 5000.0, 0.5));
    // Its value there: c1L / (b/T)^5 / (exp(4.965114231744276) - 1), c1L = 1.191042972e-16 W m2.
    const double peak_m = 2.897771955e-3 / 5000.0;
    CHECK_THAT(*peak, WithinRel(1e-9 * 1.191042972e-16 / std::pow(peak_m, 5) /
                                    (std::exp(4.965114231744276) - 1.0),
                                1e-5));
    CHECK(planck(1.0).max() == 0.0);  // below what a double can hold
    CHECK_THROWS_AS(planck(0.0), std::invalid_argument);
    CHECK_THROWS_AS(planck(-300.0), std::invalid_argument);
}
