// Luminaire photometry from files: IES LM-63 and EULUMDAT.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "optics/light/intensity_distribution.h"
#include "optics/light/opening.h"

namespace lucerna {

using optics::Opening;
using optics::opening_mesh;

/// A set of lamps with which the luminaire may be equipped.
struct LampSet {
    double count = 1.0;
    std::string type;
    double flux_lm =
        0.0;  ///< of all lamps of the set; of the luminaire if the photometry is absolute
    std::string colour, colour_rendering;
    double power_w = 0.0;  ///< with ballast or driver
};

/// What a photometric file says, in SI units and in the frame of IntensityDistribution.
///
/// C planes. LM-63, type C: the luminaire's length runs along C0-C180 (our x) and its width along
/// C90-C270 (our y): C0 is the photometric horizontal, along which LM-63-2002, table of luminous
/// openings, lays "horizontal cylinders along photometric horizontal". EULUMDAT: C0-C180 is the
/// transverse plane, so that the length runs along C90-C270 (our y) and the width along C0-C180
/// (our x) (Stockmar 1990; confirmed by the luminances of an independent program, see the tests).
/// The same linear luminaire is thus turned by 90 deg between the two formats; nothing is turned
/// here.
struct PhotometricFile {
    explicit PhotometricFile(optics::IntensityDistribution intensity_)
        : intensity(std::move(intensity_)) {}

    std::string format;  ///< "IES LM-63-2002", "EULUMDAT"
    std::string manufacturer, luminaire, catalogue_number, report_number, date;
    std::vector<std::pair<std::string, std::string>> keywords;  ///< of LM-63, in the file's order

    /// Of the whole luminaire, all factors of the file applied [cd].
    optics::IntensityDistribution intensity;
    std::string photometric_type = "C";  ///< "A" and "B" have been resampled
    std::string symmetry;                ///< as stored: "rotational", "C0-C180", ...
    std::size_t stored_planes = 0;       ///< C planes in the file
    double integrated_flux_lm = 0.0;     ///< of `intensity`
    double downward_fraction = 0.0;      ///< share of it below the horizontal

    bool absolute = false;  ///< absolute photometry: no lamp flux applies
    /// Stated by the file: of the lamps; of the luminaire if absolute (EULUMDAT; LM-63 has none).
    std::optional<double> stated_flux_lm;
    /// Flux of the luminaire by that of its lamps, from the integral; none if absolute.
    std::optional<double> light_output_ratio;
    std::optional<double> stated_light_output_ratio;  ///< LORL of EULUMDAT
    std::optional<double> stated_downward_fraction;   ///< DFF of EULUMDAT
    std::vector<LampSet> lamp_sets;
    double input_power_w = 0.0;

    Opening opening;
    std::vector<std::string> notes;       ///< choices that the reader made, such as the lamp set
    std::vector<std::string> deviations;  ///< from the standard: "line 12: ..."
};

/// Reads an IES LM-63 (1986 to 2019) or EULUMDAT file; decides by its content.
///
/// @param lamp_set  which set of lamps of an EULUMDAT file the intensities are scaled to, from 1.
/// Throws InputError with all that is wrong; tolerable deviations are listed in the result.
PhotometricFile read_photometric_file(const std::filesystem::path& path, int lamp_set = 1);

}  // namespace lucerna
