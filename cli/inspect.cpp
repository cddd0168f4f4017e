// The commands that only read: check, compare, photometry.
#include <fmt/format.h>

#include "cli/commands.h"
#include "io/compare.h"
#include "io/photometry_report.h"
#include "io/scene_file.h"
#include "optics/transport/stage.h"

namespace lucerna::cli {

ExitCode check(const std::filesystem::path& scene) {
    const io::SceneFile file = io::read_scene_file(scene);
    const optics::Stage stage(file.parts);  // throws where parts contradict each other
    fmt::print("{}", io::scene_summary(file));
    return done;
}

ExitCode compare(const CompareOptions& options) {
    const io::LuminanceImage reference = io::read_image(options.reference);
    const io::LuminanceImage image = io::read_image(options.image);
    std::optional<io::LuminanceImage> mask;
    if (options.mask) mask = io::read_image(*options.mask);
    fmt::print("{}", io::comparison_text(io::compare_images(reference, image, options.scale,
                                                            mask ? &*mask : nullptr)));
    return done;
}

ExitCode photometry(const std::filesystem::path& file) {
    fmt::print("{}", photometry_report(file));
    return done;
}

}  // namespace lucerna::cli
