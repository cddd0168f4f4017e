// The program as the shell sees it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lucerna::cli {

struct Outcome {
    int exit_code = -1;  ///< -1: ended by a signal
    std::string out, err;
};

/// Runs lucerna with these arguments to its end.
Outcome run_program(const std::vector<std::string>& arguments);

/// The same, and sends SIGINT once the program has written to stderr.
Outcome run_program_and_interrupt(const std::vector<std::string>& arguments);

}  // namespace lucerna::cli
