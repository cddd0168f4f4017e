// What smooth surfaces do to the polarisation of light.
#include "optics/material/polarisation.h"

#include <catch2/catch.hpp>
#include <complex>

#include "core/random.h"
#include "core/sampling.h"
#include "optics/material/fresnel.h"

using namespace lucerna;
using namespace lucerna::optics;
using Catch::Matchers::WithinAbs;

namespace {

double rad(double degrees, double minutes = 0.0) {
    return (degrees + minutes / 60.0) * pi / 180.0;
}

}  // namespace

TEST_CASE("At Brewster's angle reflected light is wholly polarised across the plane", "[unit]") {
    const double n = GENERATE(1.33, 1.5, 2.4);
    const Mueller<double> m = dielectric_reflection(std::cos(std::atan(n)), n);
    CHECK_THAT(m.difference, WithinAbs(m.mean, 1e-14));
    Polarisation light;
    light.refer_to(Vec3::UnitX(), Vec3::UnitZ());
    light.go_through(m);
    CHECK_THAT(light.q()[0], WithinAbs(1.0, 1e-6));
    // A second reflection across it finds nothing to reflect.
    light.refer_to(Vec3::UnitY(), Vec3::UnitZ());
    CHECK_THAT(light.q()[0], WithinAbs(-1.0, 1e-6));
    CHECK_THAT(light.flux_factor(m)[3], WithinAbs(0.0, 1e-7));
}

TEST_CASE("Fresnel's rhomb makes linearly polarised light circular", "[unit]") {
    // Born and Wolf, 7th ed., section 1.5.4: n = 1.51 and 48 deg 37' or 54 deg 37' turn the phases
    // of s and p by 45 deg against each other at each of two total reflections.
    const double angle_rad = GENERATE(rad(48, 37), rad(54, 37));
    const Mueller<double> m = dielectric_reflection(std::cos(angle_rad), 1.0 / 1.51);
    CHECK(m.mean == 1.0);
    CHECK(m.difference == 0.0);
    Polarisation light;
    light.refer_to(Vec3::UnitX(), Vec3::UnitZ());
    light.go_through(Mueller<double>{0.5, 0.5, 0.0, 0.0});  // a polariser along x
    light.refer_to(Vec3(1.0, 1.0, 0.0).normalized(), Vec3::UnitZ());
    CHECK_THAT(std::abs(light.u()[0]), WithinAbs(1.0, 1e-6));
    light.go_through(m);
    light.go_through(m);
    CHECK_THAT(std::abs(light.v()[0]), WithinAbs(1.0, 1e-3));
    CHECK_THAT(light.u()[0], WithinAbs(0.0, 2e-3));
    CHECK_THAT(light.q()[0], WithinAbs(0.0, 2e-3));
    // Twin: at another angle it does not.
    const Mueller<double> other = dielectric_reflection(std::cos(rad(70)), 1.0 / 1.51);
    light.go_through(other);
    CHECK(std::abs(light.v()[0]) < 0.95f);
}

TEST_CASE("The phase between s and p is that of the complex amplitudes", "[unit]") {
    // Born and Wolf, 7th ed., section 1.5.2, eq. 21a, with a complex angle of refraction.
    const auto [n, k] = GENERATE(table<double, double>({{1.5, 0.0},
                                                        {1.0 / 1.5, 0.0},
                                                        {0.3, 0.0},
                                                        {0.2, 3.4},
                                                        {1.1, 2.0},
                                                        {1.5, 0.2},
                                                        {1.0, 0.01}}));
    const double angle_rad = GENERATE(0.0, 1e-4, 0.6, 0.73, 1.0, 1.3, 1.5707);
    const double cosine = std::cos(angle_rad);
    const std::complex<double> index(n, k);
    const std::complex<double> root = std::sqrt(index * index - std::pow(std::sin(angle_rad), 2));
    const std::complex<double> r_s = (cosine - root) / (cosine + root);
    const std::complex<double> r_p =
        (index * index * cosine - root) / (index * index * cosine + root);
    const Mueller<double> metal = conductor_reflection(cosine, n, k);
    INFO("n " << n << " k " << k << " angle " << angle_rad);
    const auto check = [&](const Mueller<double>& m) {
        CHECK_THAT(m.mean, WithinAbs(0.5 * (std::norm(r_s) + std::norm(r_p)), 1e-12));
        CHECK_THAT(m.difference, WithinAbs(0.5 * (std::norm(r_s) - std::norm(r_p)), 1e-12));
        CHECK_THAT(m.real, WithinAbs((r_s * std::conj(r_p)).real(), 1e-12));
        CHECK_THAT(m.imaginary, WithinAbs((r_s * std::conj(r_p)).imag(), 1e-12));
    };
    check(metal);
    if (k == 0.0) check(dielectric_reflection(cosine, n));
}

TEST_CASE("Reflection and refraction share the light between them", "[property]") {
    const double eta = GENERATE(0.66, 1.0, 1.5, 2.4);
    const double angle_rad = GENERATE(0.0, 0.3, 0.7, 1.2, 1.5);
    const Mueller<double> r = dielectric_reflection(std::cos(angle_rad), eta);
    const Mueller<double> t = refraction(r);
    CHECK_THAT(r.mean + t.mean, WithinAbs(1.0, 1e-14));
    CHECK_THAT(r.difference + t.difference, WithinAbs(0.0, 1e-14));
    const double s_p = (r.mean + r.difference) * (r.mean - r.difference);
    CHECK_THAT(r.real * r.real + r.imaginary * r.imaginary, WithinAbs(s_p, 1e-12));
    const FresnelReflectance reference = fresnel_dielectric(std::cos(angle_rad), eta);
    CHECK_THAT(r.mean, WithinAbs(reference.unpolarised(), 1e-15));
}

TEST_CASE("Light takes a chain of surfaces the same way forth and back", "[property]") {
    // The backward paths rest on this: their state stands for the adjoint of the light's.
    RandomStream random(1, 0, RandomPurpose::test, 0);
    for (int chain = 0; chain < 200; ++chain) {
        struct Event {
            Vec3 in, normal, out;
            Mueller<double> mueller;
        };
        std::vector<Event> events;
        Vec3 direction = sample_sphere(random.uniform(), random.uniform());
        for (int i = 0; i < 5; ++i) {
            Vec3 normal = sample_sphere(random.uniform(), random.uniform());
            if (normal.dot(direction) > 0.0) normal = -normal;
            const double cosine = -normal.dot(direction);
            const bool metal = random.uniform() < 0.5;
            const auto m = metal ? conductor_reflection(cosine, 0.8, 2.5)
                                 : dielectric_reflection(cosine, i % 2 == 0 ? 1.5 : 1.0 / 1.5);
            const Vec3 out = (direction + 2.0 * cosine * normal).normalized();
            events.push_back({direction, normal, out, m});
            direction = out;
        }
        const auto share = [&](bool back) {
            Polarisation light;
            double flux = 1.0;
            for (std::size_t i = 0; i < events.size(); ++i) {
                const Event& event = events[back ? events.size() - 1 - i : i];
                const Vec3 in = back ? Vec3(-event.out) : event.in;
                light.refer_to(axis_across_incidence(event.normal, in), in);
                flux *= static_cast<double>(light.flux_factor(event.mueller)[0]);
                light.go_through(event.mueller);
                const Lanes degree = light.q().square() + light.u().square() + light.v().square();
                CHECK(degree.maxCoeff() <= 1.0f + 1e-6f);
            }
            return flux;
        };
        const double forth = share(false);
        CHECK_THAT(share(true), WithinAbs(forth, 1e-5 * std::max(forth, 0.01)));
    }
}
