// Tables of isotropic data: interpolation, integrals in closed form, sampling both ways.
#include "optics/material/tabulated_bsdf.h"
#include "sampling_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using namespace lucerna::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

std::vector<double> steps(double last, int count) {
    std::vector<double> axis;
    for (int i = 0; i < count; ++i) axis.push_back(last * i / (count - 1));
    return axis;
}

/// Values of a function of (theta_in, theta_out, delta_phi, wavelength) on a grid.
template <typename Function>
BsdfGrid grid(std::vector<double> in, std::vector<double> out, std::vector<double> phi,
              std::vector<double> nm, Function f) {
    BsdfGrid result{std::move(in), std::move(out), std::move(phi), std::move(nm), {}};
    for (const double i : result.theta_in_rad) {
        for (const double o : result.theta_out_rad) {
            for (const double p : result.delta_phi_rad) {
                for (const double w : result.wavelength_nm)
                    result.bsdf_per_sr.push_back(f(i, o, p, w));
            }
        }
    }
    return result;
}

/// A broad lobe toward the specular direction, not reciprocal and not mirror symmetric.
double lobe(double in, double out, double phi, double nm) {
    return (0.05 + 0.1 * std::exp(-4.0 * (in - out) * (in - out)) * (1.0 - std::cos(phi)) +
            0.02 * std::sin(phi) + 0.03 * in) *
           (0.5 + nm / 1000.0);
}

Surface lobe_surface() {
    // Grid lines at multiples of 18 deg, as the cells of the chi-square test.
    MeasuredParts<BsdfTable> parts;
    const auto in = steps(pi / 2, 6), out = steps(pi / 2, 11), phi = steps(2 * pi, 21);
    parts.reflection[0] = BsdfTable(grid(in, out, phi, {400, 700}, lobe));
    parts.transmission[0] =
        BsdfTable(grid(out, in, phi, {550}, [](double i, double o, double p, double) {
            return 0.5 * lobe(o, i, p, 550);
        }));
    parts.transmission[1] =
        BsdfTable(grid(in, out, steps(pi, 11), {550}, [](double i, double o, double p, double) {
            return 0.3 * lobe(i, o, p, 0) + 0.01;
        }));
    Surface surface;
    surface.add(Measured{std::make_shared<const MeasuredBsdf>(MeasuredBsdf{TabulatedBsdf(parts)})});
    return surface;
}

}  // namespace

TEST_CASE("A table chooses the side first, both ways", "[property]") {
    check_sides(lobe_surface(), direction(GENERATE(20.0, 130.0), 33.0),
                GENERATE(Transport::radiance, Transport::flux));
}

TEST_CASE("A table returns its values at the grid points and the mean between them", "[unit]") {
    const Surface surface = lobe_surface();
    const auto value = [&](double theta_in, double theta_out, double phi, int lane) {
        return static_cast<double>(evaluate(surface.bsdf(), surface.at(), direction(theta_in, 10.0),
                                            direction(theta_out, 10.0 + phi),
                                            Transport::flux)[lane]);
    };
    const auto rad = [](double deg) { return deg * pi / 180.0; };
    // Lane 0 is 400 nm, lane 15 is 700 nm, lane 5 is 500 nm.
    CHECK_THAT(value(36, 45, 90, 0), WithinRel(lobe(rad(36), rad(45), rad(90), 400), 1e-5));
    CHECK_THAT(value(36, 45, 270, 15), WithinRel(lobe(rad(36), rad(45), rad(270), 700), 1e-5));
    CHECK_THAT(value(36, 45, 90, 5), WithinRel(lobe(rad(36), rad(45), rad(90), 500), 1e-5));
    CHECK_THAT(value(45, 45, 90, 0), WithinRel(0.5 * (lobe(rad(36), rad(45), rad(90), 400) +
                                                      lobe(rad(54), rad(45), rad(90), 400)),
                                               1e-5));
    CHECK_THAT(value(36, 45, 99, 0), WithinRel(0.5 * (lobe(rad(36), rad(45), rad(90), 400) +
                                                      lobe(rad(36), rad(45), rad(108), 400)),
                                               1e-5));
}

TEST_CASE("Short axes are held to their ends", "[unit]") {
    MeasuredParts<BsdfTable> parts;
    parts.reflection[0] =
        BsdfTable(grid({0.5}, {0.2, 0.8}, {0.0}, {450, 650},
                       [](double, double o, double, double nm) { return o * nm; }));
    Surface surface;
    surface.add(Measured{std::make_shared<const MeasuredBsdf>(MeasuredBsdf{TabulatedBsdf(parts)})});
    const auto f = [&](double theta_in, double theta_out) {
        return evaluate(surface.bsdf(), surface.at(), direction(theta_in, 0),
                        direction(theta_out, 70), Transport::flux);
    };
    CHECK_THAT(static_cast<double>(f(0, 0)[0]), WithinRel(0.2 * 450, 1e-6));
    CHECK_THAT(static_cast<double>(f(89, 89)[15]), WithinRel(0.8 * 650, 1e-6));
    CHECK(f(30, 150)[0] == 0.0f);
}

TEST_CASE("The integral of a table is exact", "[unit]") {
    SECTION("a constant f scatters pi f") {
        const BsdfTable table(grid({0.0}, {0.3, 1.0}, {0.0}, {550},
                                   [](double, double, double, double) { return 0.25; }));
        CHECK_THAT(table.directional_hemispherical(0.7, 550), WithinRel(0.25 * pi, 1e-12));
    }
    SECTION("against quadrature") {
        const Surface surface = lobe_surface();
        const auto& data = std::get<TabulatedBsdf>(std::get<Measured>(surface.bsdf()).data->data);
        const double theta_deg = GENERATE(0.0, 25.0, 90.0);
        CHECK_THAT(
            quadrature_albedo(surface, direction(theta_deg, 40.0), Transport::flux)[7],
            WithinRel(data.directional_hemispherical(Side::front, theta_deg * pi / 180.0, 540.0),
                      1e-5));
    }
}

TEST_CASE("Tables are sampled as their density says", "[statistical]") {
    const Vec3 wo = direction(GENERATE(0.0, 40.0, 83.0, 150.0), 18.0);
    check_sampler(lobe_surface(), wo, GENERATE(Transport::radiance, Transport::flux));
}

TEST_CASE("Either way of tracing reads the same row of a table", "[property]") {
    const Surface surface = lobe_surface();
    RandomStream random(8, 0, RandomPurpose::test, 0);
    for (int i = 0; i < 200; ++i) {
        const Vec3 a = direction(180.0 * random.uniform(), 360.0 * random.uniform());
        const Vec3 b = direction(180.0 * random.uniform(), 360.0 * random.uniform());
        CHECK((evaluate(surface.bsdf(), surface.at(), a, b, Transport::flux) ==
               evaluate(surface.bsdf(), surface.at(), b, a, Transport::radiance))
                  .all());
    }
}

TEST_CASE("Axes that do not increase or close are refused", "[unit]") {
    const auto one = [](double, double, double, double) { return 0.1; };
    CHECK_THROWS_AS(BsdfTable(grid({0.2, 0.1}, {0.0}, {0.0}, {550}, one)), std::invalid_argument);
    CHECK_THROWS_AS(BsdfTable(grid({0.1}, {0.0}, {0.0, 1.0}, {550}, one)), std::invalid_argument);
    CHECK_THROWS_AS(BsdfTable(grid({0.1}, {}, {0.0}, {550}, one)), std::invalid_argument);
}
