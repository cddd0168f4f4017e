// Which estimator takes which light: the table of docs/architecture.md, "One phase".
#pragma once

#include <cstdint>

#include "optics/transport/settings.h"

namespace lucerna::optics {

/// Which estimator takes which light: every path of light must be counted exactly once.
///
/// With v counting the scattering events from the observer: visible emission is counted by the ray
/// itself; direct light at v = 1 by MIS; the rest by what is set here, in History values or-ed.
///
/// A glossy surface (Stage::glossy) beyond v = 1, or where rays end at v = 1, does not count:
/// direct light and caustics are collected there as by the next event that counts, indirect light
/// is what the ray finds further on. Kernels would be noisy there, as few photons leave along it.
/// Where only what a surface reflects is glossy, or only what it transmits, that goes for this
/// light at v = 1.
struct Collection {
    std::uint8_t first_gather = 0;          ///< v = 1: gathered from the forward map, on surfaces
    std::uint8_t sensor_gather = 0;         ///< v = 1: the same at illuminance points
    std::uint8_t first_deposit = 0;         ///< v = 1: accepted by a backward photon
    bool second_direct = false;             ///< v = 2: direct light by MIS, too
    std::uint8_t second_deposit = 0;        ///< v = 2: accepted by a backward photon
    bool whole_path = false;                ///< path tracing: direct light at every v, no maps
    bool emission_behind_specular = false;  ///< L S+ D ... E found by the ray itself

    bool deposits() const { return first_deposit || second_deposit; }

    /// Whether its rays go on to a second scattering event, which brings noise to all pixels.
    bool reaches_second_event() const { return second_deposit || whole_path; }

    static Collection of(Method method, PlantedError planted);
    /// Of images under Method::automatic where kernels at seen surfaces have less noise than rays
    /// to a second scattering event: indirect light is gathered where it is seen.
    static Collection merged_where_seen();
};

/// The collections of the two kinds of observers.
struct Collections {
    Collection cameras, sensors;

    bool deposits() const { return cameras.deposits() || sensors.deposits(); }
};

}  // namespace lucerna::optics
