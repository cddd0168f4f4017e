// A measured sheet between two rooms: what it reflects and what it transmits are followed, weighed
// and gathered apart.
#include "tests/support/truth_checks.h"
#include "validation/truth/polygon_light.h"

using namespace lucerna;
using namespace lucerna::optics;
using validation::SceneBuilder;

namespace {

enum class Transmission { diffuse, straight };

/// On both sides: reflects diffusely; transmits diffusely, or into the patch that light comes from.
BsdfId sheet(SceneBuilder& scene, double reflectance, double transmittance, Transmission kind) {
    const KlemsBasis basis = KlemsBasis::full();
    const auto patches = static_cast<std::size_t>(basis.patch_count());
    const auto even = [&](double share) {
        return KlemsMatrix(basis, basis,
                           std::vector<float>(patches * patches, static_cast<float>(share / pi)));
    };
    std::vector<float> straight(patches * patches, 0.0f);
    for (std::size_t i = 0; i < patches; ++i) {
        straight[i * patches + i] =
            static_cast<float>(transmittance / basis.projected_solid_angle_sr(static_cast<int>(i)));
    }
    const KlemsMatrix transmission =
        kind == Transmission::straight ? KlemsMatrix(basis, basis, straight) : even(transmittance);
    MeasuredParts<KlemsMatrix> parts;
    parts.reflection = {even(reflectance), even(reflectance)};
    parts.transmission = {transmission, transmission};
    return scene.parts.add(
        Bsdf{Measured{std::make_shared<const MeasuredBsdf>(MeasuredBsdf{KlemsBsdf(parts)})}});
}

}  // namespace

TEST_CASE("Direct light: a measured sheet with a lamp on either side", "[analytic]") {
    const auto method = GENERATE(Method::combined, Method::forward, Method::path);
    const auto kind = GENERATE(Transmission::diffuse, Transmission::straight);
    const double reflectance = 0.55, transmittance = 0.08;
    const double behind_cd_m2 = 1000.0, before_cd_m2 = 2000.0;
    const Vec3 ex = Vec3::UnitX(), ey = Vec3::UnitY(), ez = Vec3::UnitZ();
    SceneBuilder scene;
    scene.object("sheet", Rectangle{{-1, -1, 0}, 2 * ex, 2 * ey},
                 sheet(scene, reflectance, transmittance, kind));
    const Vec3 behind(-1.0, -1.0, -0.3), before(0.4, -0.3, 0.8);
    scene.area_light(scene.object("panel behind", Rectangle{behind, 2 * ex, 2 * ey}, scene.black()),
                     behind_cd_m2);
    scene.area_light(
        scene.object("lamp before", Rectangle{before, 0.6 * ey, 0.5 * ex}, scene.black()),
        before_cd_m2);
    scene.meter({0, 0, 1}, Vec3::Zero(), 0.01);

    const double reflected = reflectance / pi *
                             truth::polygon_illuminance(truth::corners(before, 0.6 * ey, 0.5 * ex),
                                                        before_cd_m2, Vec3::Zero(), ez);
    // The panel fills the patch around the normal.
    const double transmitted =
        kind == Transmission::straight
            ? transmittance * behind_cd_m2
            : transmittance / pi *
                  truth::polygon_illuminance(truth::corners(behind, 2 * ex, 2 * ey), behind_cd_m2,
                                             Vec3::Zero(), -ez);
    const Result result = test::run(scene, method, {64, 100});
    INFO("method " << static_cast<int>(method) << ", straight "
                   << (kind == Transmission::straight));
    const Estimate& estimate = result.quantities.front().estimate;
    test::check_truth(estimate, reflected + transmitted);
    test::check_refutes(estimate, reflected + 1.05 * transmitted);
    test::check_refutes(estimate, 1.05 * reflected + transmitted);
}

TEST_CASE("A map and path tracing agree on a measured sheet between two rooms", "[statistical]") {
    SceneBuilder scene;
    const BsdfId paint = scene.diffuse(0.6);
    for (const Shape& wall : SceneBuilder::room(2.0, 1.0, 1.0)) scene.object("wall", wall, paint);
    const Vec3 ex = Vec3::UnitX(), ey = Vec3::UnitY(), ez = Vec3::UnitZ();
    scene.object("sheet", Rectangle{ex, ey, ez}, sheet(scene, 0.4, 0.3, Transmission::straight));
    // Throws a caustic on the sheet.
    scene.object("mirror", Rectangle{{0.01, 0.1, 0.1}, 0.8 * ey, 0.8 * ez}, scene.mirror(0.9));
    scene.area_light(
        scene.object("lamp", Rectangle{{0.3, 0.3, 0.99}, 0.4 * ey, 0.4 * ex}, scene.black()),
        1000.0);
    // The sheet from the dark room, where the lamp shows through it in the mirror.
    scene.meter({1.9, 0.5, 0.1}, {1.0, 0.5, 0.45}, 0.1);
    scene.meter({1.9, 0.5, 0.4}, {1.0, 0.4, 0.5}, 0.1);  // where the bright walls show
    scene.meter({0.1, 0.5, 0.4}, {1.0, 0.4, 0.5}, 0.1);  // the sheet from the bright room
    const auto read = [&](Method method) {
        const std::uint64_t seed = 100 + static_cast<std::uint64_t>(method);
        return test::run(scene, method, {10, 20000}, seed, hardware_threads()).quantities;
    };
    const std::vector<Quantity> referee = read(Method::path);
    const std::vector<Quantity> gathered = read(Method::forward);
    for (std::size_t i = 0; i < referee.size(); ++i) {
        const Estimate &a = gathered[i].estimate, &b = referee[i].estimate;
        const double error = std::hypot(a.standard_error(), b.standard_error());
        INFO("meter " << i << ": " << a.value() << " +- " << a.standard_error() << ", " << b.value()
                      << " +- " << b.standard_error());
        CHECK(std::abs(a.value() - b.value()) < test::level_1e6 * error);
        CHECK(error < 0.04 * b.value());
    }
}
