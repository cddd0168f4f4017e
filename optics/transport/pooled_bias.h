// The bias of kernels that rims and barriers cut, told by all around them that are cut alike.
#pragma once

#include <span>
#include <vector>

#include "optics/transport/readings.h"

namespace lucerna::optics {

/// A kernel of the map of indirect light on a plane patch, of which a part is cut off, as a pixel
/// sees it.
struct CutKernel {
    std::uint32_t bin;         ///< of the pixel
    std::uint32_t side;        ///< 2 for each patch, 1 for the side of its normal
    Eigen::Vector3f position;  ///< of the centre
    Eigen::Vector3f normal;    ///< of the patch
    float whole_m;             ///< radius of kernels of the patch that are whole
    float left;                ///< of the area of the disc
    float weight;              ///< with which the pixel counts the kernel
    float bias;                ///< of its luminance, as it tells itself in a phase [cd/m2]
};

/// Bias of each kernel in the mean over those that are cut alike near to it, by their weights.
///
/// Where half of a disc is cut off, what a kernel tells of its bias has 3.4 times the noise of the
/// light itself. But along an edge the bias changes slowly. What is told in all is told as before:
/// the sum of bias times weight is the same, so that the bias of the mean of an image stays what it
/// was. Each is a mean whose weights do not hang on the photons.
/// @return in the order of the lists, one after the other. How they are split does not count.
std::vector<double> pooled_bias(std::span<const std::vector<CutKernel>> lists, int threads);

/// Adds it to the readings of the pixels.
void add_pooled_bias(std::span<const std::vector<CutKernel>> lists, int threads,
                     PhaseReadings& readings);

}  // namespace lucerna::optics
