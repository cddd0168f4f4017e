#include "io/legend.h"

#include <array>
#include <cmath>
#include <cstdlib>

namespace lucerna::io {
namespace {

constexpr int glyph_height = 7;
constexpr int advance = 6;  // columns from one character to the next

struct Glyph {
    char32_t character;
    std::array<const char*, glyph_height> rows;
};

// Drawn for this project.
constexpr std::array<Glyph, 19> font = {{
    {U'0', {" ### ", "#   #", "#   #", "#   #", "#   #", "#   #", " ### "}},
    {U'1', {"  #  ", " ##  ", "# #  ", "  #  ", "  #  ", "  #  ", "#####"}},
    {U'2', {" ### ", "#   #", "    #", "   # ", "  #  ", " #   ", "#####"}},
    {U'3', {" ### ", "#   #", "    #", "  ## ", "    #", "#   #", " ### "}},
    {U'4', {"   # ", "  ## ", " # # ", "#  # ", "#####", "   # ", "   # "}},
    {U'5', {"#####", "#    ", "#### ", "    #", "    #", "#   #", " ### "}},
    {U'6', {"  ## ", " #   ", "#    ", "#### ", "#   #", "#   #", " ### "}},
    {U'7', {"#####", "    #", "   # ", "   # ", "  #  ", "  #  ", "  #  "}},
    {U'8', {" ### ", "#   #", "#   #", " ### ", "#   #", "#   #", " ### "}},
    {U'9', {" ### ", "#   #", "#   #", " ####", "    #", "   # ", " ##  "}},
    {U'.', {"     ", "     ", "     ", "     ", "     ", " ##  ", " ##  "}},
    {U'+', {"     ", "  #  ", "  #  ", "#####", "  #  ", "  #  ", "     "}},
    {U'-', {"     ", "     ", "     ", "#####", "     ", "     ", "     "}},
    {U'e', {"     ", "     ", " ### ", "#   #", "#####", "#    ", " ### "}},
    {U'c', {"     ", "     ", " ### ", "#   #", "#    ", "#   #", " ### "}},
    {U'd', {"    #", "    #", " ####", "#   #", "#   #", "#   #", " ####"}},
    {U'm', {"     ", "     ", "## # ", "# # #", "# # #", "# # #", "# # #"}},
    {U'/', {"    #", "    #", "   # ", "  #  ", " #   ", "#    ", "#    "}},
    {U'²', {" ##  ", "#  # ", "  #  ", " #   ", "#### ", "     ", "     "}},
}};

const Glyph* find_glyph(char32_t character) {
    for (const Glyph& glyph : font) {
        if (glyph.character == character) return &glyph;
    }
    return nullptr;
}

void fill(Raster& raster, int left, int top, int width, int height, Rgb8 colour) {
    for (int y = std::max(top, 0); y < std::min(top + height, raster.height); ++y) {
        for (int x = std::max(left, 0); x < std::min(left + width, raster.width); ++x)
            raster.at(x, y) = colour;
    }
}

std::u32string tick_label(double value) {
    const std::string text = fmt::format("{:g}", value);
    return {text.begin(), text.end()};  // ASCII
}

constexpr Rgb8 ink = {230, 230, 230};

// Of the parts of a legend, in blocks.
constexpr int margin = 4, bar_width = 10, tick_length = 3, label_columns = 7 * advance;

}  // namespace

std::vector<double> log_ticks(double min, double max) {
    std::vector<double> ticks;
    const double slack = 1e-9;  // a tick at the very end counts
    for (int decade = static_cast<int>(std::floor(std::log10(min))) - 1;
         std::pow(10.0, decade) <= max * 2.0; ++decade) {
        for (const double digit : {1.0, 2.0, 5.0}) {
            // Division keeps 0.01 and the like the nearest doubles, so that they print as such.
            const double tick =
                decade < 0 ? digit / std::pow(10.0, -decade) : digit * std::pow(10.0, decade);
            if (tick >= min * (1.0 - slack) && tick <= max * (1.0 + slack)) ticks.push_back(tick);
        }
    }
    return ticks;
}

void draw_text(Raster& raster, int x, int y, std::u32string_view text, int block, Rgb8 colour) {
    for (const char32_t character : text) {
        if (const Glyph* glyph = find_glyph(character)) {
            for (int row = 0; row < glyph_height; ++row) {
                for (int column = 0; column < advance - 1; ++column) {
                    if (glyph->rows[static_cast<std::size_t>(row)][column] != '#') continue;
                    fill(raster, x + column * block, y + row * block, block, block, colour);
                }
            }
        }
        x += advance * block;
    }
}

int legend_width(int block) {
    return (margin + bar_width + tick_length + 2 + label_columns + margin) * block;
}

void draw_legend(Raster& raster, int x, int block, double min, double max,
                 const std::function<Rgb8(double)>& colour_of) {
    const int left = x + margin * block;
    draw_text(raster, left, margin * block, U"cd/m²", block, ink);

    const int top = (margin + 2 * glyph_height) * block;
    const int height = raster.height - top - (margin + glyph_height / 2) * block;
    for (int y = 0; y < height; ++y) {
        fill(raster, left, top + y, bar_width * block, 1, colour_of(1.0 - (y + 0.5) / height));
    }

    int last_label_y = raster.height + height;
    for (const double tick : log_ticks(min, max)) {
        const double position = std::log(tick / min) / std::log(max / min);
        const int y = top + static_cast<int>(std::lround((1.0 - position) * (height - 1)));
        if (std::abs(last_label_y - y) < (glyph_height + 2) * block)
            continue;  // no room for the label
        last_label_y = y;
        fill(raster, left + bar_width * block, y, tick_length * block, 1, ink);
        draw_text(raster, left + (bar_width + tick_length + 2) * block,
                  y - glyph_height / 2 * block, tick_label(tick), block, ink);
    }
}

}  // namespace lucerna::io
