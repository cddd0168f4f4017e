#include "io/colour_map.h"

namespace lucerna::io {
namespace {

// Oklab to XYZ (D65), the inverses of M1 and M2 of B. Ottosson, "A perceptual color space for image
// processing", 2020.
Vec3 oklab_to_xyz(const Vec3& lab) {
    static const Eigen::Matrix3d cone_to_xyz = [] {
        Eigen::Matrix3d m1;
        m1 << 0.8189330101, 0.3618667424, -0.1288597137,  //
            0.0329845436, 0.9293118715, 0.0361456387,     //
            0.0482003018, 0.2643662691, 0.6338517070;
        return m1.inverse().eval();
    }();
    static const Eigen::Matrix3d lab_to_root_cone = [] {
        Eigen::Matrix3d m2;
        m2 << 0.2104542553, 0.7936177850, -0.0040720468,  //
            1.9779984951, -2.4285922050, 0.4505937099,    //
            0.0259040371, 0.7827717662, -0.8086757660;
        return m2.inverse().eval();
    }();
    const Vec3 root = lab_to_root_cone * lab;
    return cone_to_xyz * root.cwiseProduct(root).cwiseProduct(root);
}

}  // namespace

Vec3 false_colour_xyz(double t) {
    const double lightness = 0.22 + 0.73 * t;
    const double hue_rad = (275.0 + 190.0 * t) * pi / 180.0;
    const double chroma =
        0.11 + 0.22 * t * (1.0 - t);  // follows the border of sRGB along this path
    return oklab_to_xyz({lightness, chroma * std::cos(hue_rad), chroma * std::sin(hue_rad)});
}

}  // namespace lucerna::io
