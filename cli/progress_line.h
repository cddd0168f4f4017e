// One line that says how far a run is.
#pragma once

#include <string>

#include "optics/transport/simulate.h"

namespace lucerna::cli {

/// "phase 12, noise 3.1 % of 2 % wanted, 4.2 M rays/s, 12 s, 20 s left", and "U of desk[3,1] 1.4
/// times what is wanted" where that is furthest, or "nothing known of desk[3,1] yet"
std::string progress_text(const optics::Progress& progress);

/// "12 s", "3 min 05 s", "2 h 07 min"
std::string duration_text(double seconds);

/// Keeps the line up to date on stderr: in place on a terminal, else as a line every few seconds.
class ProgressLine {
public:
    ProgressLine();
    /// Removes the line from the terminal.
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const optics::Progress& progress);
    /// @param elapsed_s  since the start.
    void show(const std::string& text, double elapsed_s);

private:
    bool terminal_;
    double last_shown_s_ = 0.0;
};

}  // namespace lucerna::cli
