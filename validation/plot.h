// Plots as inline SVG.
#pragma once

#include <string>
#include <vector>

namespace lucerna::validation::plot {

/// Text as it may stand in HTML and SVG.
std::string escaped(const std::string& text);

/// Counts of values in bins of equal width; what lies beyond goes to the first and the last bin.
struct Histogram {
    std::string title, axis;
    double from, to;
    int bins;
    std::vector<double> values;
    bool normal_curve = false;  ///< draws the standard normal density, scaled to the counts
};
std::string svg(const Histogram& histogram);

/// A truth as a line, and measured points with their error bars.
struct Curve {
    std::string title, x_axis, y_axis;
    struct Point {
        double x, truth, value, half_width;
    };
    std::vector<Point> points;
};
std::string svg(const Curve& curve);

/// Named rows of dots on a common axis from 0, with a line at `mark`; a dot beyond the end of the
/// axis is drawn at its end.
struct Rows {
    std::string title, axis;
    double to;
    double mark;
    struct Row {
        std::string name;
        std::vector<double> values;
    };
    std::vector<Row> rows;
};
std::string svg(const Rows& rows);

/// Named shares with intervals on a common axis, and a line at `mark`.
struct Intervals {
    std::string title, axis;
    double from, to;
    double mark;
    struct Row {
        std::string name;
        double lower, value, upper;
    };
    std::vector<Row> rows;
};
std::string svg(const Intervals& intervals);

}  // namespace lucerna::validation::plot
