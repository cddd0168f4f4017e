// A reader of the CIE tables for tests, independent of the library.
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

/// The columns of a file of data/colorimetry by name, each from wavelength [nm] to value.
inline std::map<std::string, std::map<int, double>> reference_table(const std::string& file) {
    std::ifstream input(LUCERNA_DATA_DIR "/colorimetry/" + file);
    std::map<std::string, std::map<int, double>> columns;
    std::vector<std::string> header;
    for (std::string line; std::getline(input, line);) {
        std::vector<std::string> cells;
        std::stringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
        if (header.empty()) {
            header = cells;
            continue;
        }
        for (std::size_t i = 1; i < cells.size(); ++i) {
            if (!cells[i].empty()) columns[header[i]][std::stoi(cells[0])] = std::stod(cells[i]);
        }
    }
    return columns;
}
