#include <png.h>

#include <stdexcept>

#include "io/atomic_file.h"
#include "io/raster.h"

namespace lucerna::io {

void write_png(const std::filesystem::path& path, const Raster& raster) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(raster.width);
    image.height = static_cast<png_uint_32>(raster.height);
    image.format =
        PNG_FORMAT_RGB;  // libpng's 8-bit formats are sRGB and are written with that chunk

    png_alloc_size_t size = 0;
    std::string bytes;
    const auto encode = [&](void* memory) {
        if (!png_image_write_to_memory(&image, memory, &size, 0, raster.pixels.data(), 0,
                                       nullptr)) {
            throw std::runtime_error(
                fmt::format("cannot encode {}: {}", path.string(), image.message));
        }
    };
    encode(nullptr);  // finds the size
    bytes.resize(size);
    encode(bytes.data());
    write_file(path, std::string_view(bytes).substr(0, size));
}

}  // namespace lucerna::io
