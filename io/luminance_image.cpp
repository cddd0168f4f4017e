#include "io/luminance_image.h"

#include <fstream>

#include "core/diagnostics.h"
#include "io/exr.h"
#include "io/pfm.h"
#include "spectral/colorimetry.h"

namespace lucerna::io {

Vec3 luminance_of_rgb() {
    return spectral::linear_srgb_from_xyz().inverse().row(1);
}

LuminanceImage read_image(const std::filesystem::path& path) {
    char start[4] = {};
    std::ifstream file(path, std::ios::binary);
    if (!file.read(start, sizeof start)) {
        throw InputError({path.string()},
                         "cannot be read as an image; expected an OpenEXR or PFM file");
    }
    const std::string_view magic(start, sizeof start);
    if (magic == "\x76\x2f\x31\x01") return read_exr(path);  // 20000630 in little endian
    if (magic.starts_with("Pf") || magic.starts_with("PF")) return read_pfm(path);
    throw InputError({path.string()}, "is neither an OpenEXR nor a PFM image");
}

}  // namespace lucerna::io
