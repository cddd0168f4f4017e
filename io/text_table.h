// Tables for the terminal.
#pragma once

#include <string>
#include <vector>

namespace lucerna::io {

/// Rows of cells in UTF-8, indented by two blanks: the first column left-aligned, the others
/// right-aligned. Rows may have different numbers of cells.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace lucerna::io
