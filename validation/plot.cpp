#include "validation/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lucerna::validation::plot {
namespace {

constexpr double width = 560.0;
constexpr double bottom = 46.0;  // room for numbers and the name of the axis
constexpr double top = 30.0;     // room for the title
constexpr const char* ink = "#333";
constexpr const char* measured = "#1664a5";
constexpr const char* reference = "#c2410c";

struct Range {
    double from, to;
    double share(double value) const { return (value - from) / (to - from); }
};

// The round number of 1, 2 or 5 times a power of ten at which about `count` steps fill the range.
double round_step(const Range& range, int count) {
    const double raw = (range.to - range.from) / count;
    const double power = std::pow(10.0, std::floor(std::log10(raw)));
    for (const double factor : {1.0, 2.0, 5.0}) {
        if (raw <= factor * power) return factor * power;
    }
    return 10.0 * power;
}

// An SVG picture with axes; y grows upward.
class Canvas {
public:
    Canvas(const std::string& title, double height, double left, Range x, Range y)
        : height_(height), left_(left), x_(x), y_(y) {
        text_ = fmt::format(
            "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
            "font-size=\"12\" fill=\"{2}\"><title>{3}</title><text x=\"{4}\" y=\"18\" "
            "font-weight=\"bold\">{3}</text>",
            width, height, ink, escaped(title), left);
    }

    double x(double value) const { return left_ + x_.share(value) * (width - left_ - 16.0); }
    double y(double value) const {
        return height_ - bottom - y_.share(value) * (height_ - bottom - top);
    }

    void line(double x1, double y1, double x2, double y2, const char* colour,
              double thickness = 1.0) {
        text_ += fmt::format(
            "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
            "stroke-width=\"{}\"/>",
            x1, y1, x2, y2, colour, thickness);
    }
    void dot(double at_x, double at_y, const char* colour) {
        text_ += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>", at_x,
                             at_y, colour);
    }
    void bar(double x1, double x2, double value) {
        text_ += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"{}\" "
            "fill-opacity=\"0.6\"/>",
            x(x1) + 0.5, y(value), x(x2) - x(x1) - 1.0, y(0.0) - y(value), measured);
    }
    void path(const std::vector<std::pair<double, double>>& points, const char* colour) {
        text_ += "<polyline fill=\"none\" stroke-width=\"1.5\" stroke=\"";
        text_ += colour;
        text_ += "\" points=\"";
        for (const auto& [at_x, at_y] : points)
            text_ += fmt::format("{:.1f},{:.1f} ", x(at_x), y(at_y));
        text_ += "\"/>";
    }
    void label(double at_x, double at_y, const std::string& words, const char* anchor) {
        text_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>", at_x,
                             at_y, anchor, escaped(words));
    }
    void x_axis(const std::string& name) {
        const double base = height_ - bottom;
        line(left_, base, width - 16.0, base, ink);
        const double step = round_step(x_, 6);
        for (double at = std::ceil(x_.from / step) * step; at <= x_.to + 0.01 * step; at += step) {
            line(x(at), base, x(at), base + 4.0, ink);
            label(x(at), base + 17.0, fmt::format("{:.6g}", std::abs(at) < 1e-9 * step ? 0 : at),
                  "middle");
        }
        label(0.5 * (left_ + width), height_ - 8.0, name, "middle");
    }
    void y_axis(const std::string& name) {
        line(left_, height_ - bottom, left_, top, ink);
        const double step = round_step(y_, 5);
        for (double at = std::ceil(y_.from / step) * step; at <= y_.to; at += step) {
            line(left_ - 4.0, y(at), left_, y(at), ink);
            label(left_ - 7.0, y(at) + 4.0,
                  fmt::format("{:.6g}", std::abs(at) < 1e-9 * step ? 0 : at), "end");
        }
        text_ += fmt::format(
            "<text transform=\"translate(13 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
            0.5 * (height_ - bottom + top), escaped(name));
    }
    std::string done() { return text_ + "</svg>\n"; }

private:
    double height_, left_;
    Range x_, y_;
    std::string text_;
};

constexpr double left_of_numbers = 64.0;
constexpr double left_of_names = 210.0;
constexpr double row_height = 17.0;

double row_y(std::size_t row) {
    return top + (static_cast<double>(row) + 0.5) * row_height;
}

}  // namespace

std::string escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

std::string svg(const Histogram& histogram) {
    const double step = (histogram.to - histogram.from) / histogram.bins;
    std::vector<double> counts(static_cast<std::size_t>(histogram.bins));
    for (const double value : histogram.values) {
        if (!(std::abs(value) < 1e300)) continue;  // not a number: the table shows it
        const double bin =
            std::clamp(std::floor((value - histogram.from) / step), 0.0, histogram.bins - 1.0);
        counts[static_cast<std::size_t>(bin)] += 1.0;
    }
    const double scale = static_cast<double>(histogram.values.size()) * step;
    const auto normal = [&](double z) {
        return scale * std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    };
    double highest = std::max(1.0, *std::max_element(counts.begin(), counts.end()));
    if (histogram.normal_curve) highest = std::max(highest, normal(0.0));
    Canvas canvas(histogram.title, 260.0, left_of_numbers, {histogram.from, histogram.to},
                  {0.0, 1.05 * highest});
    for (int i = 0; i < histogram.bins; ++i) {
        canvas.bar(histogram.from + i * step, histogram.from + (i + 1) * step,
                   counts[static_cast<std::size_t>(i)]);
    }
    if (histogram.normal_curve) {
        std::vector<std::pair<double, double>> points;
        for (int i = 0; i <= 120; ++i) {
            const double z = histogram.from + (histogram.to - histogram.from) * i / 120;
            points.emplace_back(z, normal(z));
        }
        canvas.path(points, reference);
    }
    canvas.x_axis(histogram.axis);
    canvas.y_axis("checks");
    return canvas.done();
}

std::string svg(const Curve& curve) {
    std::vector<Curve::Point> points = curve.points;
    std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
    Range x{points.front().x, points.back().x};
    Range y{1e300, -1e300};
    for (const Curve::Point& point : points) {
        y.from = std::min({y.from, point.truth, point.value - point.half_width});
        y.to = std::max({y.to, point.truth, point.value + point.half_width});
    }
    const auto widen = [](Range& range) {
        double margin = 0.06 * (range.to - range.from);
        if (margin <= 0.0) margin = std::max(1e-9, 0.1 * std::abs(range.to));
        range = {range.from - margin, range.to + margin};
    };
    widen(x);
    widen(y);
    Canvas canvas(curve.title, 300.0, left_of_numbers, x, y);
    std::vector<std::pair<double, double>> truth;
    for (const Curve::Point& point : points) truth.emplace_back(point.x, point.truth);
    canvas.path(truth, reference);
    for (const Curve::Point& point : points) {
        const double at = canvas.x(point.x);
        const double low = canvas.y(point.value - point.half_width);
        const double high = canvas.y(point.value + point.half_width);
        canvas.line(at, low, at, high, measured, 1.5);
        canvas.line(at - 4.0, low, at + 4.0, low, measured, 1.5);
        canvas.line(at - 4.0, high, at + 4.0, high, measured, 1.5);
        canvas.dot(at, canvas.y(point.value), measured);
    }
    canvas.x_axis(curve.x_axis);
    canvas.y_axis(curve.y_axis);
    return canvas.done();
}

std::string svg(const Rows& rows) {
    const double height = top + bottom + row_height * static_cast<double>(rows.rows.size());
    Canvas canvas(rows.title, height, left_of_names, {0.0, rows.to}, {0.0, 1.0});
    canvas.line(canvas.x(rows.mark), top, canvas.x(rows.mark), height - bottom, reference, 1.5);
    for (std::size_t i = 0; i < rows.rows.size(); ++i) {
        canvas.label(left_of_names - 8.0, row_y(i) + 4.0, rows.rows[i].name, "end");
        for (const double value : rows.rows[i].values) {
            canvas.dot(canvas.x(std::min(value, rows.to)), row_y(i),
                       value > rows.mark ? reference : measured);
        }
    }
    canvas.x_axis(rows.axis);
    return canvas.done();
}

std::string svg(const Intervals& intervals) {
    const double height = top + bottom + row_height * static_cast<double>(intervals.rows.size());
    const Range range{intervals.from, intervals.to};
    Canvas canvas(intervals.title, height, left_of_names, range, {0.0, 1.0});
    const auto x = [&](double value) {
        return canvas.x(std::clamp(value, intervals.from, intervals.to));
    };
    canvas.line(x(intervals.mark), top, x(intervals.mark), height - bottom, reference, 1.5);
    for (std::size_t i = 0; i < intervals.rows.size(); ++i) {
        const Intervals::Row& row = intervals.rows[i];
        canvas.label(left_of_names - 8.0, row_y(i) + 4.0, row.name, "end");
        canvas.line(x(row.lower), row_y(i), x(row.upper), row_y(i), measured, 2.0);
        canvas.dot(x(row.value), row_y(i), measured);
    }
    canvas.x_axis(intervals.axis);
    return canvas.done();
}

}  // namespace lucerna::validation::plot
