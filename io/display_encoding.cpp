#include "io/display_encoding.h"

#include <OpenColorIO/OpenColorIO.h>

#include <algorithm>
#include <sstream>

#include "io/ocio_config.h"

namespace lucerna::io {
namespace {

namespace ocio = OCIO_NAMESPACE;

ocio::ConstCPUProcessorRcPtr make_processor() {
    std::istringstream text(ocio_config);
    const ocio::ConstConfigRcPtr config = ocio::Config::CreateFromStream(text);
    const char* display = config->getDefaultDisplay();
    const auto processor =
        config->getProcessor(ocio::ROLE_SCENE_LINEAR, display, config->getDefaultView(display),
                             ocio::TRANSFORM_DIR_FORWARD);
    return processor->getDefaultCPUProcessor();
}

}  // namespace

std::vector<Rgb8> encode_for_display(std::vector<std::array<float, 3>> xyz) {
    if (xyz.empty()) return {};
    static const ocio::ConstCPUProcessorRcPtr processor = make_processor();
    ocio::PackedImageDesc image(xyz.data(), static_cast<long>(xyz.size()), 1, 3);
    processor->apply(image);

    std::vector<Rgb8> pixels(xyz.size());
    for (std::size_t i = 0; i < xyz.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            const float level =
                xyz[i][c] > 0.0F ? std::min(xyz[i][c], 1.0F) : 0.0F;  // undefined: black
            pixels[i][c] = static_cast<std::uint8_t>(level * 255.0F + 0.5F);
        }
    }
    return pixels;
}

}  // namespace lucerna::io
