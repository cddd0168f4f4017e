// Two surfaces in different planes of incidence: what the second does to light depends on what the
// first made of it.
#include <complex>

#include "tests/support/truth_checks.h"

using namespace lucerna;
using namespace lucerna::optics;
using validation::SceneBuilder;

namespace {

using Complex = std::complex<double>;
using Field = Eigen::Matrix<Complex, 3, 1>;

constexpr double incidence_rad = 60.0 * pi / 180.0;
const Complex metal_index(1.1, 2.0);
constexpr double beam_flux_lm = 100.0;
constexpr double emitter_luminance = 1000.0;

// A mirror that light along `in` meets at the angle of incidence, in the plane of `in` and `side`.
struct Station {
    Vec3 in, normal, out;
};

Station station(const Vec3& in, const Vec3& side) {
    const Vec3 normal = -std::cos(incidence_rad) * in + std::sin(incidence_rad) * side;
    return {in, normal, in - 2.0 * in.dot(normal) * normal};
}

// The light's first plane of incidence is x-z; the second is turned by an angle about the ray.
std::array<Station, 2> stations(double turn_rad) {
    const Station first = station(Vec3::UnitX(), Vec3::UnitZ());
    const Vec3 across = Vec3::UnitY();  // perpendicular to both rays of the first
    const Vec3 along = across.cross(first.out);
    return {first, station(first.out, std::cos(turn_rad) * along + std::sin(turn_rad) * across)};
}

// The electric field after a reflection, as a vector in space (Born and Wolf, Principles of Optics,
// 7th ed., section 1.5.2, eq. 21a, for a complex index).
Field reflected(const Station& at, const Field& field) {
    const double cosine = -at.in.dot(at.normal);
    const Complex root = std::sqrt(metal_index * metal_index - (1.0 - cosine * cosine));
    const Complex r_s = (cosine - root) / (cosine + root);
    const Complex r_p =
        (metal_index * metal_index * cosine - root) / (metal_index * metal_index * cosine + root);
    const Vec3 s = at.in.cross(at.normal).normalized();
    const Vec3 p_in = s.cross(at.in);
    const Vec3 p_out = s.cross(at.out);
    const auto along = [&](const Vec3& axis) { return axis.cast<Complex>().dot(field); };
    return r_s * along(s) * s.cast<Complex>() + r_p * along(p_in) * p_out.cast<Complex>();
}

// Share of unpolarised light that both mirrors reflect: the mean over two polarisations.
double reflectance(double turn_rad) {
    const auto both = stations(turn_rad);
    double sum = 0.0;
    for (const Vec3 axis : {Vec3::UnitY(), Vec3::UnitZ()}) {
        sum += reflected(both[1], reflected(both[0], axis.cast<Complex>())).squaredNorm();
    }
    return 0.5 * sum;
}

// The same for light that is unpolarised at each mirror.
double mean_reflectance_squared() {
    const auto first = stations(0.0)[0];
    double sum = 0.0;
    for (const Vec3 axis : {Vec3::UnitY(), Vec3::UnitZ()}) {
        sum += reflected(first, axis.cast<Complex>()).squaredNorm();
    }
    return 0.25 * sum * sum;
}

}  // namespace

TEST_CASE("Two mirrors in turned planes of incidence act as polariser and analyser", "[analytic]") {
    const double turn_deg = GENERATE(0.0, 35.0, 60.0, 90.0);
    const auto [first, second] = stations(turn_deg * pi / 180.0);
    SceneBuilder scene;
    const SpectrumId n = scene.parts.add(spectral::Spectrum(metal_index.real()));
    const SpectrumId k = scene.parts.add(spectral::Spectrum(metal_index.imag()));
    const BsdfId metal = scene.parts.add(Bsdf(SmoothConductor{n, k}));
    const Vec3 place_2 = first.out;
    const Vec3 place_3 = place_2 + second.out;
    scene.object("first", Disk{Vec3::Zero(), first.normal, 0.2}, metal);
    scene.object("second", Disk{place_2, second.normal, 0.2}, metal);
    const ObjectId emitter =
        scene.object("emitter", Disk{-Vec3::UnitX(), Vec3::UnitX(), 0.05}, scene.black());
    const bool forward = GENERATE(true, false);
    INFO("turned by " << turn_deg << " deg, " << (forward ? "forward" : "backward"));
    if (forward) {
        scene.light("beam", BeamLight{Disk{{-0.9, 0, 0}, Vec3::UnitX(), 0.01}, Vec3::UnitX()},
                    beam_flux_lm);
        scene.receiver(scene.object("receiver", Disk{place_3, -second.out, 0.05}, scene.black()));
    } else {
        scene.area_light(emitter, emitter_luminance);
        scene.meter(place_3, place_2, 0.004);
    }
    const Result result = test::run(scene, Method::combined,
                                    forward ? test::Effort{130, 8000} : test::Effort{280, 100});
    const double whole = forward ? beam_flux_lm : emitter_luminance;
    const Estimate& estimate = result.quantities[0].estimate;
    test::check_truth(estimate, whole * reflectance(turn_deg * pi / 180.0));
    test::check_refutes(estimate, whole * mean_reflectance_squared());
}
