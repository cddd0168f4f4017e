#include "validation/cases.h"

#include <array>

namespace lucerna::validation {
namespace {

constexpr std::array list{
    Family{"furnace", "interreflection loses and gains nothing, on all shapes", furnace_cases,
           drawn_furnace},
    Family{"integrating_sphere", "direct and reflected light of a source in a diffuse sphere",
           integrating_sphere_cases, drawn_integrating_sphere},
    Family{"slab", "refraction, multiple reflection and absorption, polarised", slab_cases,
           drawn_slab},
    Family{"ball_lens", "caustics with curvature in two directions", ball_lens_cases,
           drawn_ball_lens},
    Family{"cylinder_lens", "caustics with curvature in one direction", cylinder_lens_cases,
           drawn_cylinder_lens},
    Family{"rod_guide", "many total reflections, skew rays, end faces", rod_guide_cases,
           drawn_rod_guide},
    Family{"prism", "dispersion and the directions of refracted light", prism_cases},
    Family{"pane_shadow", "kernels beside a sharp shadow behind glass", pane_shadow_cases,
           drawn_pane_shadow},
    Family{"beer_lambert", "absorption over wavelength", beer_lambert_cases},
    Family{"invariance", "luminance behind and within glass", invariance_cases, drawn_invariance},
    Family{"colour", "colour of CIE illuminants through the engine", colour_cases},
    Family{"polygon_light", "direct light of Lambertian surfaces", polygon_light_cases,
           drawn_polygon_light},
    Family{"closed_box", "interreflection between six different walls", closed_box_cases,
           drawn_closed_box},
    Family{"grids", "what follows from a grid of points: mean, extremes, uniformity", grid_cases,
           drawn_grid},
    Family{"cornell_room", "interreflection in a room that loses light", cornell_room_cases},
    Family{"pixels", "single pixels by the default method, up to edges and feet", pixel_cases},
    Family{"point_source", "inverse square and cosine law, C-gamma tables and their rotations",
           point_source_cases, drawn_point_source},
    Family{"mirrors", "specular reflection, once and many times", mirrors_cases, drawn_mirrors},
    Family{"sky_window", "daylight of a uniform sky through an opening", sky_window_cases,
           drawn_sky_window},
    Family{"cie171", "cases after CIE 171:2006, with truths of our own", cie171_cases},
};

}  // namespace

std::span<const Family> families() {
    return list;
}

}  // namespace lucerna::validation
