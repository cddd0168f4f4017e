// Small results made by hand for the tests of what is written from them.
#pragma once

#include <filesystem>
#include <string>

#include "optics/transport/result.h"
#include "tests/support/scratch_folder.h"

namespace lucerna::io {

using test::ScratchFolder;

/// Estimate of two phases with this mean and standard error: mean -+ error has the deviation of the
/// mean sqrt(2 error^2 / (2 * 1)) = error.
Estimate estimate(double mean, double standard_error, double bias = 0.0);

/// 24 x 20 pixels; luminance (1 + x + 100 y) cd/m2 with 1 % error and bias -0.5, chromaticity of
/// D65, and three bins of spectra, 400 to 700 nm, with 0.001 * (1 + pixel) * (1 + bin).
optics::Image example_image();

/// With the image, a sensor of 512.34 lx and a balance of 1000 lm that closes.
optics::Result example_result();

std::string read_text(const std::filesystem::path& path);

}  // namespace lucerna::io
