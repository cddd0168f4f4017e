#include "cli/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace lucerna::cli {

std::string duration_text(double seconds) {
    const long whole = std::lround(seconds);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string progress_text(const optics::Progress& progress) {
    std::string text = fmt::format("phase {}", progress.phase);
    if (std::isfinite(progress.delta)) {
        text += fmt::format(", noise {:.2g} %", 100.0 * progress.delta);
        if (progress.delta_wanted)
            text += fmt::format(" of {:.2g} % wanted", 100.0 * *progress.delta_wanted);
    }
    const optics::Furthest& furthest = progress.furthest;
    if (!furthest.reading.empty()) {
        text += std::isfinite(furthest.excess)
                    ? fmt::format(", U of {} {:.2g} times what is wanted", furthest.reading,
                                  furthest.excess)
                    : fmt::format(", nothing known of {} yet", furthest.reading);
    }
    text += fmt::format(", {:.2f} M rays/s, {}", progress.rays_per_s * 1e-6,
                        duration_text(progress.elapsed_s));
    if (progress.left_s && std::isfinite(*progress.left_s)) {
        text += fmt::format(", {} left", duration_text(*progress.left_s));
    }
    return text;
}

ProgressLine::ProgressLine() : terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
    if (terminal_) std::fputs("\r\x1b[K", stderr);  // to the start of the line, erase it
}

void ProgressLine::show(const optics::Progress& progress) {
    show(progress_text(progress), progress.elapsed_s);
}

void ProgressLine::show(const std::string& text, double elapsed_s) {
    const double interval_s = terminal_ ? 0.1 : 5.0;
    if (elapsed_s - last_shown_s_ < interval_s) return;
    last_shown_s_ = elapsed_s;
    if (terminal_) {
        fmt::print(stderr, "\r{}\x1b[K", text);
    } else {
        fmt::print(stderr, "{}\n", text);
    }
    std::fflush(stderr);
}

}  // namespace lucerna::cli
