// Klems bases and matrices: solid angles in closed form, the convention of directions, sampling
// both ways.
#include <numeric>

#include "optics/material/klems_bsdf.h"
#include "sampling_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using namespace lucerna::test;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

constexpr std::size_t front = 0, back = 1;

KlemsMatrix random_matrix(const KlemsBasis& in, const KlemsBasis& out, std::uint32_t seed,
                          double scale) {
    RandomStream random(seed, 0, RandomPurpose::test, 0);
    std::vector<float> values(static_cast<std::size_t>(in.patch_count() * out.patch_count()));
    for (float& value : values) {
        const double u = random.uniform();
        value = static_cast<float>(scale * u * u);
    }
    return KlemsMatrix(in, out, std::move(values));
}

/// All four parts, none of them reciprocal, on bases that differ between incidence and exit.
Surface random_surface() {
    const KlemsBasis quarter = KlemsBasis::quarter(), half = KlemsBasis::half();
    MeasuredParts<KlemsMatrix> parts;
    parts.reflection[front] = random_matrix(quarter, half, 1, 0.5);
    parts.reflection[back] = random_matrix(half, quarter, 2, 0.3);
    parts.transmission[front] = random_matrix(quarter, quarter, 3, 0.2);
    parts.transmission[back] = random_matrix(quarter, half, 4, 0.6);
    Surface surface;
    surface.add(Measured{std::make_shared<const MeasuredBsdf>(MeasuredBsdf{KlemsBsdf(parts)})});
    return surface;
}

const KlemsBsdf& klems(const Surface& surface) {
    return std::get<KlemsBsdf>(std::get<Measured>(surface.bsdf()).data->data);
}

}  // namespace

TEST_CASE("The patches of a Klems basis fill the hemisphere", "[unit]") {
    const KlemsBasis fine({{0, 10, 1}, {10, 60, 200}, {60, 90, 6}});
    const auto [basis, count] = GENERATE_REF(table<KlemsBasis, int>({{KlemsBasis::full(), 145},
                                                                     {KlemsBasis::half(), 73},
                                                                     {KlemsBasis::quarter(), 41},
                                                                     {fine, 207}}));
    CHECK(basis.patch_count() == count);
    double sum = 0.0;
    for (int patch = 0; patch < count; ++patch) {
        sum += basis.projected_solid_angle_sr(patch);
        CHECK(basis.patch(basis.centre(patch)) == patch);
        CHECK(basis.patch(basis.sample(patch, 0.01, 0.99)) == patch);
        CHECK(basis.patch(basis.sample(patch, 0.99, 0.01)) == patch);
        const auto opposite = basis.opposite(patch);
        REQUIRE(opposite);
        const Vec3 c = basis.centre(patch);
        CHECK(basis.patch(Vec3(-c.x(), -c.y(), c.z())) == *opposite);
    }
    CHECK_THAT(sum, WithinRel(pi, 1e-12));
}

TEST_CASE("Projected solid angles are integrals of the cosine over the patches", "[unit]") {
    // Lambda of the LBNL full basis, first ring: pi sin^2 5 deg = 0.0238637; second: 0.0238 per
    // patch (WINDOW technical documentation lists 0.02386, 0.02344, 0.02376 ...), here by
    // quadrature.
    const KlemsBasis basis = KlemsBasis::full();
    std::vector<double> sum(145);
    // Parts that end at the edges of rings (5 deg) and sectors (multiples of 0.75 deg).
    over_sphere(36, 480, [&](const Vec3& w, double solid_angle, std::size_t, std::size_t) {
        if (w.z() > 0.0) sum[static_cast<std::size_t>(basis.patch(w))] += w.z() * solid_angle;
    });
    for (int patch = 0; patch < 145; ++patch) {
        CHECK_THAT(sum[static_cast<std::size_t>(patch)],
                   WithinRel(basis.projected_solid_angle_sr(patch), 1e-7));
    }
    CHECK_THAT(basis.projected_solid_angle_sr(0),
               WithinRel(pi * (1.0 - std::cos(pi / 18.0)) / 2.0, 1e-12));
}

TEST_CASE("A basis with gaps is refused", "[unit]") {
    CHECK_THROWS_AS(KlemsBasis({{0, 10, 1}, {20, 90, 4}}), std::invalid_argument);
    CHECK_THROWS_AS(KlemsBasis({{0, 10, 1}, {10, 80, 4}}), std::invalid_argument);
    CHECK_THROWS_AS(KlemsBasis({{0, 90, 0}}), std::invalid_argument);
}

TEST_CASE("Straight transmission and specular reflection lie on the diagonal", "[unit]") {
    const KlemsBasis basis = KlemsBasis::full();
    std::vector<float> values(145 * 145, 0.0f);
    for (std::size_t i = 0; i < 145; ++i) values[i * 145 + i] = 1.0f;
    MeasuredParts<KlemsMatrix> parts;
    parts.reflection = {KlemsMatrix(basis, basis, values), KlemsMatrix(basis, basis, values)};
    parts.transmission = parts.reflection;
    const KlemsBsdf bsdf(parts);
    for (int patch = 0; patch < 145; ++patch) {
        const Vec3 c = basis.centre(patch);
        for (const double side : {1.0, -1.0}) {
            const Vec3 in(c.x(), c.y(), side * c.z());
            CHECK(bsdf.bsdf_per_sr(in, -in) == 1.0);
            CHECK(bsdf.bsdf_per_sr(in, Vec3(-in.x(), -in.y(), in.z())) == 1.0);
            if (patch > 0) CHECK(bsdf.bsdf_per_sr(in, in) == 0.0);
        }
    }
}

TEST_CASE("Azimuth counts as seen from the back, x to the right and y up", "[unit]") {
    // Light that falls from above on the front (y > 0) propagates downward: Klems azimuth 270 deg.
    // Seen from the back, x to the right is our -x.
    const KlemsBasis basis = KlemsBasis::full();
    constexpr int ring = 1 + 8 + 16;  // 25 to 35 deg, 20 sectors
    std::vector<float> values(145 * 145, 0.0f);
    values[(ring + 15) * 145 + (ring + 5)] =
        1.0f;                                      // incident 270 deg, leaves toward 90 deg: upward
    values[(ring + 0) * 145 + (ring + 0)] = 2.0f;  // propagates toward Klems +x
    MeasuredParts<KlemsMatrix> parts;
    parts.transmission[front] = KlemsMatrix(basis, basis, values);
    const KlemsBsdf bsdf(parts);
    const Vec3 from_above(0.0, 0.5, std::sqrt(0.75));
    CHECK(bsdf.bsdf_per_sr(from_above, Vec3(0.0, 0.5, -std::sqrt(0.75))) == 1.0);
    CHECK(bsdf.bsdf_per_sr(from_above, Vec3(0.0, -0.5, -std::sqrt(0.75))) == 0.0);
    const Vec3 in(0.5, 0.0, std::sqrt(0.75));
    CHECK(bsdf.bsdf_per_sr(in, -in) == 2.0);
    CHECK(bsdf.bsdf_per_sr(-in, in) == 0.0);  // the other side was not measured
}

TEST_CASE("A reversed transmission is reciprocal", "[property]") {
    MeasuredParts<KlemsMatrix> parts;
    parts.transmission[front] = random_matrix(KlemsBasis::quarter(), KlemsBasis::half(), 9, 0.5);
    parts.transmission[back] = parts.transmission[front]->reversed();
    REQUIRE(parts.transmission[back]);
    const KlemsBsdf bsdf(parts);
    RandomStream random(1, 0, RandomPurpose::test, 0);
    for (int i = 0; i < 500; ++i) {
        const Vec3 a = direction(90.0 * random.uniform(), 360.0 * random.uniform());
        const Vec3 b = direction(90.0 + 90.0 * random.uniform(), 360.0 * random.uniform());
        REQUIRE(bsdf.bsdf_per_sr(a, b) == bsdf.bsdf_per_sr(b, a));
    }
    const KlemsBasis odd({{0, 10, 1}, {10, 90, 5}});
    CHECK_FALSE(random_matrix(odd, odd, 1, 1.0).reversed());
}

TEST_CASE("Klems patches are sampled in exact proportion, both ways", "[statistical]") {
    // Every weight is the total of the known patch; the counts of patches follow f times solid
    // angle.
    const Surface surface = random_surface();
    const Vec3 known = direction(GENERATE(3.0, 50.0, 120.0), 33.0);
    const Transport transport = GENERATE(Transport::radiance, Transport::flux);
    const bool flux = transport == Transport::flux;
    const KlemsBasis up = KlemsBasis::full();  // cells to count in
    double albedo = 0.0;
    // Parts that end at the edges of all patches, so that the quadrature of the constant f is
    // exact.
    over_sphere(360, 480, [&](const Vec3& w, double solid_angle, std::size_t, std::size_t) {
        albedo +=
            std::abs(w.z()) * solid_angle *
            (flux ? klems(surface).bsdf_per_sr(known, w) : klems(surface).bsdf_per_sr(w, known));
    });
    std::vector<double> count(290), expected(290);
    constexpr int samples = 200'000;
    RandomStream random(21, 0, RandomPurpose::test, 0);
    double weight = 0.0;
    for (int i = 0; i < samples; ++i) {
        const double u_lobe = random.uniform(), u1 = random.uniform(), u2 = random.uniform();
        const auto event = sample(surface.bsdf(), surface.at(), known, u_lobe, u1, u2, transport);
        if (!event) FAIL("no sample");
        weight = static_cast<double>(event->weight[3]);
        if (std::abs(weight - albedo) > 1e-5 * albedo)
            FAIL("weight " << weight << " of " << albedo);
        const Vec3 lifted(event->wi.x(), event->wi.y(), std::abs(event->wi.z()));
        count[static_cast<std::size_t>(up.patch(lifted) + (event->wi.z() < 0.0 ? 145 : 0))] += 1.0;
    }
    RandomStream inner(22, 0, RandomPurpose::test, 0);
    for (int cell = 0; cell < 290; ++cell) {
        constexpr int points = 1024;
        for (int i = 0; i < points; ++i) {
            Vec3 w = up.sample(cell % 145, inner.uniform(), inner.uniform());
            if (cell >= 145) w.z() = -w.z();
            expected[static_cast<std::size_t>(cell)] +=
                samples * up.projected_solid_angle_sr(cell % 145) / points *
                (flux ? klems(surface).bsdf_per_sr(known, w)
                      : klems(surface).bsdf_per_sr(w, known)) /
                weight;
        }
    }
    CHECK_THAT(std::accumulate(expected.begin(), expected.end(), 0.0), WithinRel(samples, 5e-3));
    for (std::size_t cell = 0; cell < 290; ++cell) {
        // 4.9 standard deviations of the count, and 5 % for the points of the expectation.
        CHECK_THAT(count[cell], WithinAbs(expected[cell], 4.9 * std::sqrt(expected[cell] + 1.0) +
                                                              0.05 * expected[cell]));
    }
}

TEST_CASE("Klems data choose the side first, both ways", "[property]") {
    check_sides(random_surface(), direction(GENERATE(3.0, 50.0, 120.0), 33.0),
                GENERATE(Transport::radiance, Transport::flux));
}

TEST_CASE("Light from a single patch is concentrated by pi over its projected solid angle",
          "[unit]") {
    const KlemsBasis basis = KlemsBasis::full();
    std::vector<float> straight(145 * 145, 0.0f), even(145 * 145, 0.2f);
    for (std::size_t i = 0; i < 145; ++i) straight[i * 145 + i] = 3.0f;
    MeasuredParts<KlemsMatrix> parts;
    parts.reflection[front] = KlemsMatrix(basis, basis, even);
    parts.transmission[back] = KlemsMatrix(basis, basis, straight);
    const MeasuredBsdf sheet{KlemsBsdf(parts)};
    const Surface surface = random_surface();
    const auto at = [&](double theta_deg, bool reflection) {
        return concentration(sheet, direction(theta_deg, 3.0), reflection,
                             surface.at().wavelengths);
    };
    CHECK_THAT(at(40.0, true), WithinRel(1.0, 1e-6));
    for (const double theta_deg : {0.0, 40.0, 80.0}) {
        const int patch = basis.patch(direction(theta_deg, 3.0));
        CHECK_THAT(at(theta_deg, false),
                   WithinRel(pi / basis.projected_solid_angle_sr(patch), 0.1));
    }
    CHECK(at(140.0, true) == 0.0);  // the back was not measured
}

TEST_CASE("The density of measured data is f cos over its integral", "[property]") {
    const Surface surface = random_surface();
    const Transport transport = GENERATE(Transport::radiance, Transport::flux);
    const Vec3 wo = direction(GENERATE(0.0, 60.0, 100.0), 77.0);
    RandomStream random(2, 0, RandomPurpose::test, 0);
    for (int i = 0; i < 200; ++i) {
        const double u_lobe = random.uniform(), u1 = random.uniform(), u2 = random.uniform();
        const auto event = sample(surface.bsdf(), surface.at(), wo, u_lobe, u1, u2, transport);
        REQUIRE(event);
        const double pdf = pdf_solid_angle(surface.bsdf(), surface.at(), wo, event->wi, transport);
        CHECK(pdf == event->pdf_solid_angle);
        const Lanes f = evaluate(surface.bsdf(), surface.at(), wo, event->wi, transport);
        CHECK_THAT(static_cast<double>(f[0] / event->weight[0]) * std::abs(event->wi.z()),
                   WithinRel(pdf, 1e-5));
    }
    CHECK_THAT(sphere_integral(density_of(surface, wo, transport)), WithinAbs(1.0, 1e-2));
}

TEST_CASE("Backward and forward tracing see the same light of measured data", "[statistical]") {
    // The bilinear form of light from a toward b, integral of g(a) f(a -> b) h(b) cos cos, once
    // with the light's end known and once with the observer's; the data are not reciprocal.
    const Surface surface = random_surface();
    const auto g = [](const Vec3& w) { return 1.0 + 0.8 * w.x() + (w.z() > 0.0 ? 0.7 : 0.0); };
    const auto h = [](const Vec3& w) {
        return 1.0 - 0.6 * w.y() * w.z() + (w.z() > 0.0 ? 0.0 : 0.9);
    };
    constexpr int samples = 300'000;
    const auto estimate = [&](Transport transport) {
        RandomStream random(31, 0, RandomPurpose::test, transport == Transport::flux ? 1 : 0);
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < samples; ++i) {
            Vec3 known = sample_cosine_hemisphere(random.uniform(), random.uniform());
            if (random.uniform() < 0.5) known.z() = -known.z();
            const double u_lobe = random.uniform(), u1 = random.uniform(), u2 = random.uniform();
            const auto event =
                sample(surface.bsdf(), surface.at(), known, u_lobe, u1, u2, transport);
            if (!event) continue;
            const double value =
                2.0 * pi * static_cast<double>(event->weight[0]) *
                (transport == Transport::flux ? g(known) * h(event->wi) : g(event->wi) * h(known));
            sum += value;
            squares += value * value;
        }
        const double mean = sum / samples;
        return std::pair(mean, std::sqrt((squares / samples - mean * mean) / samples));
    };
    const auto [backward, backward_error] = estimate(Transport::radiance);
    const auto [forward, forward_error] = estimate(Transport::flux);
    check_mean(backward - forward + backward, std::hypot(backward_error, forward_error), backward,
               DetectsRelative{0.02});
    // Twin: the transposed data give another value.
    const double wrong = [&] {
        RandomStream random(32, 0, RandomPurpose::test, 2);
        double sum = 0.0;
        for (int i = 0; i < samples; ++i) {
            Vec3 known = sample_cosine_hemisphere(random.uniform(), random.uniform());
            if (random.uniform() < 0.5) known.z() = -known.z();
            const double u_lobe = random.uniform(), u1 = random.uniform(), u2 = random.uniform();
            const auto event =
                sample(surface.bsdf(), surface.at(), known, u_lobe, u1, u2, Transport::flux);
            if (event)
                sum += 2.0 * pi * static_cast<double>(event->weight[0]) * h(known) * g(event->wi);
        }
        return sum / samples;
    }();
    CHECK(std::abs(wrong - backward) > 8.0 * std::hypot(backward_error, forward_error));
}
