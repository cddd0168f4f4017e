#include "io/eulumdat.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lucerna {
namespace {

constexpr double metre_per_mm = 1e-3;
constexpr std::size_t max_planes = 20000;
constexpr std::size_t max_lamp_sets = 100;
constexpr double stated_tolerance = 0.01;  // of LORL, relative, and of DFF, absolute

class EulumdatReader {
public:
    explicit EulumdatReader(const TextFile& file) : file_(file), errors_(file) {}

    PhotometricFile read(int lamp_set);

private:
    void deviates(std::size_t line, std::string text) {
        deviations_.push_back(fmt::format("line {}: {}", line + 1, std::move(text)));
    }
    // Lines count from 1 as in the description of the format.
    std::string text(std::size_t line) const;
    double number(std::size_t line, const std::string& what);
    double size_m(std::size_t line, const std::string& what);
    std::size_t count(std::size_t line, const std::string& what, std::size_t least,
                      std::size_t most);
    std::optional<double> read_number(std::string_view word, std::size_t line);

    void read_header();
    void read_lamp_sets();
    void read_tables();
    void check_angles(const std::vector<double>& angles, std::size_t first_word, const char* name,
                      double limit, double stated_step, std::size_t step_line);
    std::vector<double> numbers(std::size_t n, const std::string& what);
    Opening read_opening();
    std::size_t planes_of_symmetry();
    PlaneTable full_circle();
    void compare_with_stated(PhotometricFile& result, const LampSet& lamps);

    const TextFile& file_;
    ErrorList errors_;
    std::vector<std::string> deviations_, notes_;
    bool comma_seen_ = false;

    std::size_t symmetry_ = 0, planes_ = 0, gammas_ = 0, data_line_ = 0;
    double plane_step_deg_ = 0.0, gamma_step_deg_ = 0.0;
    double downward_fraction_ = 0.0, light_output_ratio_ = 0.0, conversion_ = 1.0, tilt_deg_ = 0.0;
    Opening opening_;
    std::vector<LampSet> lamp_sets_;
    bool absolute_ = false;
    std::vector<Word> words_;
    std::size_t next_ = 0;
    std::vector<double> c_deg_, gamma_deg_;
    std::vector<std::vector<double>> stored_;
};

std::string EulumdatReader::text(std::size_t line) const {
    return std::string(trimmed(file_.lines[line - 1]));
}

std::optional<double> EulumdatReader::read_number(std::string_view word, std::size_t line) {
    std::string copy(word);
    const auto comma = copy.find(',');
    if (comma != std::string::npos) {
        copy[comma] = '.';
        if (!comma_seen_) deviates(line, "a decimal comma; the format has a decimal point");
        comma_seen_ = true;
    }
    return parse_number(copy);
}

double EulumdatReader::number(std::size_t line, const std::string& what) {
    const std::string& raw = file_.lines[line - 1];
    const std::string_view word = trimmed(raw);
    const auto value = read_number(word, line - 1);
    if (value) return *value;
    const auto column = word.empty() ? 0 : static_cast<std::size_t>(word.data() - raw.data());
    errors_.add(line - 1, column,
                word.empty()
                    ? fmt::format("the line is blank; expected {}", what)
                    : fmt::format("{} stands for {}; expected a number", in_quotes(word), what));
    return std::nan("");
}

double EulumdatReader::size_m(std::size_t line, const std::string& what) {
    if (text(line).empty()) {
        deviates(line - 1, fmt::format("{} is blank; read as 0", what));
        return 0.0;
    }
    const double value = number(line, what);
    if (value < 0.0 || value > 1e7) {
        errors_.add(line - 1, 0,
                    fmt::format("{} is {} mm; expected 0 to 10000000 mm", what, value));
    }
    return value * metre_per_mm;
}

std::size_t EulumdatReader::count(std::size_t line, const std::string& what, std::size_t least,
                                  std::size_t most) {
    const double value = number(line, what);
    if (std::isnan(value)) return 0;
    if (value == std::floor(value) && value >= static_cast<double>(least) &&
        value <= static_cast<double>(most)) {
        return static_cast<std::size_t>(value);
    }
    errors_.add(
        line - 1, 0,
        fmt::format("{} is {}; expected a whole number from {} to {}", what, value, least, most));
    return 0;
}

void EulumdatReader::read_header() {
    if (file_.lines.size() < 26) {
        throw InputError(file_.at(file_.lines.size() - 1),
                         fmt::format("the file ends after {} lines; expected the 26 lines of the "
                                     "header of an EULUMDAT file",
                                     file_.lines.size()));
    }
    if (text(1).empty()) deviates(0, "the company is blank");
    const double type = number(2, "the type indicator");
    if (type != 0.0 && type != 1.0 && type != 2.0 && type != 3.0 && !std::isnan(type)) {
        deviates(1, fmt::format("the type indicator is {}; expected 1, 2 or 3", type));
    }
    symmetry_ = count(3, "the symmetry indicator", 0, 4);
    planes_ = count(4, "the number of C planes", 1, max_planes);
    plane_step_deg_ = number(5, "the distance between C planes");
    gammas_ = count(6, "the number of intensities per C plane", 2, max_planes);
    gamma_step_deg_ = number(7, "the distance between intensities");
    opening_ = read_opening();
    downward_fraction_ = 0.01 * number(22, "the downward flux fraction");
    light_output_ratio_ = 0.01 * number(23, "the light output ratio");
    conversion_ = number(24, "the conversion factor");
    if (!std::isnan(conversion_) && !(conversion_ > 0.0)) {
        errors_.add(23, 0,
                    fmt::format("the conversion factor for intensities is {}; expected above 0, "
                                "usually 1",
                                conversion_));
    }
    tilt_deg_ = number(25, "the tilt during measurement");
    if (tilt_deg_ != 0.0 && !std::isnan(tilt_deg_)) {
        notes_.push_back(
            fmt::format("measured at a tilt of {} deg, which is not applied", tilt_deg_));
    }
}

Opening EulumdatReader::read_opening() {
    const double length_m = size_m(16, "the length of the luminous area");
    const double width_m = size_m(17, "the width of the luminous area");
    std::array<double, 4> heights_m{};
    for (std::size_t side = 0; side < 4; ++side) {
        heights_m[side] =
            size_m(18 + side, fmt::format("the height of the luminous area at C{}", 90 * side));
    }
    const double height_m = *std::max_element(heights_m.begin(), heights_m.end());
    const double lowest_m = *std::min_element(heights_m.begin(), heights_m.end());
    if (length_m == 0.0) {
        if (width_m != 0.0 || height_m != 0.0) {
            deviates(15, "the luminous area has no length; read as a point");
        }
        return {};
    }
    // The length runs along C90-C270; see PhotometricFile.
    if (width_m == 0.0) {
        if (height_m == 0.0) return {Opening::Kind::ellipse, {length_m, length_m, 0.0}};
        double mean_m = 0.0;
        for (const double height : heights_m) mean_m += 0.25 * height;
        if (lowest_m != height_m) {
            deviates(17, "a round luminous area with different heights; read with their mean");
        }
        return {Opening::Kind::cylinder, {length_m, length_m, mean_m}};
    }
    if (height_m == 0.0) return {Opening::Kind::rectangle, {width_m, length_m, 0.0}};
    return {Opening::Kind::box, {width_m, length_m, height_m}, Opening::Axis::z, heights_m};
}

void EulumdatReader::read_lamp_sets() {
    const std::size_t sets = count(26, "the number of lamp sets", 1, max_lamp_sets);
    errors_.throw_if_any();  // the counts say where everything else stands
    data_line_ = 27 + 6 * sets + 10;
    if (file_.lines.size() < data_line_) {
        throw InputError(file_.at(file_.lines.size() - 1),
                         fmt::format("the file ends after {} lines; expected {} lines with {} lamp "
                                     "sets before the angles",
                                     file_.lines.size(), data_line_ - 1, sets));
    }
    for (std::size_t set = 0; set < sets; ++set) {
        const std::size_t line = 27 + 6 * set;
        LampSet lamps;
        const double lamp_count = number(line, "the number of lamps");
        if (lamp_count == 0.0) {
            deviates(line - 1, "the number of lamps is 0; read as 1");
        }
        if (set == 0) absolute_ = lamp_count < 0.0;
        lamps.count = lamp_count == 0.0 ? 1.0 : std::abs(lamp_count);
        lamps.type = text(line + 1);
        lamps.flux_lm = number(line + 2, "the luminous flux of the lamps");
        if (!std::isnan(lamps.flux_lm) && !(lamps.flux_lm > 0.0)) {
            errors_.add(line + 1, 0,
                        fmt::format("the luminous flux of the lamps is {} lm; expected "
                                    "above 0, because intensities are in cd/klm",
                                    lamps.flux_lm));
        }
        lamps.colour = text(line + 3);
        lamps.colour_rendering = text(line + 4);
        lamps.power_w = text(line + 5).empty() ? 0.0 : number(line + 5, "the power of the lamps");
        if (text(line + 5).empty())
            deviates(line + 4, "the power of the lamps is blank; read as 0");
        lamp_sets_.push_back(lamps);
    }
    errors_.throw_if_any();
}

std::vector<double> EulumdatReader::numbers(std::size_t n, const std::string& what) {
    if (n > words_.size() - next_) {
        const std::size_t last = file_.lines.size() - 1;
        throw InputError(file_.at(last, file_.lines[last].size()),
                         fmt::format("the file ends after {} of {} values of {}",
                                     words_.size() - next_, n, what));
    }
    std::vector<double> values;
    values.reserve(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Word& word = words_[next_++];
        const auto value = read_number(word.text, word.line);
        if (!value) {
            errors_.add(
                word.line, word.column,
                fmt::format("{} stands for {}; expected a number", in_quotes(word.text), what));
        }
        values.push_back(value.value_or(std::nan("")));
    }
    return values;
}

void EulumdatReader::check_angles(const std::vector<double>& angles, std::size_t first_word,
                                  const char* name, double limit, double stated_step,
                                  std::size_t step_line) {
    for (std::size_t i = 0; i < angles.size(); ++i) {
        const Word& word = words_[first_word + i];
        if (angles[i] < 0.0 || angles[i] > limit) {
            errors_.add(word.line, word.column,
                        fmt::format("the {} angle {} is outside 0 to {}", name, angles[i], limit));
        } else if (i > 0 && angles[i] <= angles[i - 1]) {
            errors_.add(word.line, word.column,
                        fmt::format("{} angles must increase; {} follows {}", name, angles[i],
                                    angles[i - 1]));
        }
    }
    if (stated_step == 0.0 || angles.size() < 2 || std::isnan(stated_step)) return;
    for (std::size_t i = 1; i < angles.size(); ++i) {
        if (std::abs(angles[i] - angles[i - 1] - stated_step) <= 0.01) continue;
        deviates(step_line - 1, fmt::format("states {} angles every {} deg, but {} follows {}; the "
                                            "angles themselves count",
                                            name, stated_step, angles[i], angles[i - 1]));
        return;
    }
}

// How many planes the file should hold for its symmetry.
std::size_t EulumdatReader::planes_of_symmetry() {
    const auto divisible = [&](std::size_t by) {
        if (planes_ % by == 0) return;
        throw InputError(file_.at(3), fmt::format("{} C planes cannot have symmetry {}; expected a "
                                                  "multiple of {}",
                                                  planes_, symmetry_, by));
    };
    switch (symmetry_) {
        case 1:
            return 1;
        case 2:
            divisible(2);
            return planes_ / 2 + 1;
        case 3:
            divisible(4);
            return planes_ / 2 + 1;
        case 4:
            divisible(4);
            return planes_ / 4 + 1;
        default:
            return planes_;
    }
}

void EulumdatReader::read_tables() {
    words_ = split_words(file_, data_line_ - 1, ";");
    const std::size_t first_c = next_;
    c_deg_ = numbers(planes_, "C angle");
    const std::size_t first_gamma = next_;
    gamma_deg_ = numbers(gammas_, "gamma angle");
    errors_.throw_if_any();
    check_angles(c_deg_, first_c, "C", 360.0, plane_step_deg_, 5);
    check_angles(gamma_deg_, first_gamma, "gamma", 180.0, gamma_step_deg_, 7);
    errors_.throw_if_any();
    if (c_deg_.size() > 1 && c_deg_.back() == 360.0) {
        deviates(words_[first_gamma - 1].line, "the plane C360 is listed beside C0");
        if (symmetry_ != 0) {  // counted as a plane, but not stored
            c_deg_.pop_back();
            --planes_;
        }
    }

    std::size_t planes = planes_of_symmetry();
    const std::size_t values = words_.size() - next_;
    if (planes != planes_ && values == planes_ * gammas_) {
        deviates(2, fmt::format("symmetry {} is stated, but all {} planes are stored; read without "
                                "symmetry",
                                symmetry_, planes_));
        symmetry_ = 0;
        planes = planes_;
    }
    const std::size_t first_value = next_;
    if (values < planes * gammas_) numbers(planes * gammas_, "intensity");  // throws
    for (std::size_t plane = 0; plane < planes; ++plane) {
        stored_.push_back(
            numbers(gammas_, fmt::format("an intensity of stored plane {}", plane + 1)));
    }
    for (std::size_t plane = 0; plane < planes; ++plane) {
        for (std::size_t g = 0; g < gammas_; ++g) {
            if (!(stored_[plane][g] < 0.0)) continue;
            const Word& word = words_[first_value + plane * gammas_ + g];
            errors_.add(
                word.line, word.column,
                fmt::format("the intensity {} is negative; expected 0 cd/klm or more", word.text));
        }
    }
    errors_.throw_if_any();
    if (next_ < words_.size()) {
        deviates(words_[next_].line,
                 fmt::format("{} more words follow the last intensity, from {} on",
                             words_.size() - next_, in_quotes(words_[next_].text)));
    }
}

PlaneTable EulumdatReader::full_circle() {
    const auto require = [&](std::size_t index, double angle_deg) {
        if (c_deg_[index] == angle_deg) return;
        throw InputError(file_.at(words_[index].line, words_[index].column),
                         fmt::format("C plane {} is at {}; expected {} for symmetry {}", index + 1,
                                     c_deg_[index], angle_deg, symmetry_));
    };
    if (symmetry_ != 3 && symmetry_ != 1) require(0, 0.0);
    PlaneTable table{{}, gamma_deg_, {}};
    switch (symmetry_) {
        case 1:
            table.add_plane(0.0, stored_.front());
            return table;
        case 2:
        case 4: {
            const std::size_t last = stored_.size() - 1;
            require(last, symmetry_ == 2 ? 180.0 : 90.0);
            for (std::size_t i = 0; i <= last; ++i) table.add_plane(c_deg_[i], stored_[i]);
            const PlaneTable half = mirrored_at_last_plane(table);
            return symmetry_ == 2 ? half : mirrored_at_last_plane(half);
        }
        case 3: {  // stored from C270 over C0 to C90
            const std::size_t first = 3 * planes_ / 4;
            require(first, 270.0);
            require(planes_ / 4, 90.0);
            for (std::size_t i = 0; i < stored_.size(); ++i) {
                const double angle_deg = c_deg_[(first + i) % planes_];
                table.add_plane(angle_deg >= 270.0 ? angle_deg - 360.0 : angle_deg, stored_[i]);
            }
            return mirrored_at_c90(table);
        }
        default:
            break;
    }
    for (std::size_t i = 0; i < stored_.size(); ++i) table.add_plane(c_deg_[i], stored_[i]);
    if (table.c_deg.size() > 1 && table.c_deg.back() < 360.0) {
        table.add_plane(360.0, std::vector<double>(stored_.front()));
    }
    return table;
}

void EulumdatReader::compare_with_stated(PhotometricFile& result, const LampSet& lamps) {
    const double ratio = result.integrated_flux_lm / lamps.flux_lm;
    if (!absolute_) result.light_output_ratio = ratio;
    result.stated_light_output_ratio = light_output_ratio_;
    result.stated_downward_fraction = downward_fraction_;
    if (std::abs(ratio - light_output_ratio_) > stated_tolerance * light_output_ratio_) {
        deviates(22, fmt::format("states a light output ratio of {:.4g} %, but the intensities "
                                 "integrate to {:.4g} %",
                                 100.0 * light_output_ratio_, 100.0 * ratio));
    }
    if (std::abs(result.downward_fraction - downward_fraction_) > stated_tolerance) {
        deviates(21, fmt::format("states a downward flux fraction of {:.4g} %, but the intensities "
                                 "integrate to {:.4g} %",
                                 100.0 * downward_fraction_, 100.0 * result.downward_fraction));
    }
}

PhotometricFile EulumdatReader::read(int lamp_set) {
    read_header();
    read_lamp_sets();
    read_tables();
    if (lamp_set < 1 || static_cast<std::size_t>(lamp_set) > lamp_sets_.size()) {
        throw InputError(file_.at(25),
                         fmt::format("lamp set {} is asked for; the file has sets 1 to {}",
                                     lamp_set, lamp_sets_.size()));
    }
    const LampSet& lamps = lamp_sets_[static_cast<std::size_t>(lamp_set - 1)];
    if (lamp_sets_.size() > 1) {
        notes_.push_back(
            fmt::format("the file has {} alternative lamp sets; set {} applies, with {} lm",
                        lamp_sets_.size(), lamp_set, lamps.flux_lm));
    }
    PlaneTable table = full_circle();
    for (auto& plane : table.values) {
        for (double& value : plane) value *= 1e-3 * lamps.flux_lm * conversion_;  // cd/klm -> cd
    }
    PhotometricFile result = photometric_file(file_, table, data_line_ - 1);
    result.format = "EULUMDAT";
    result.manufacturer = text(1);
    result.report_number = text(8);
    result.luminaire = text(9);
    result.catalogue_number = text(10);
    result.date = text(12);
    constexpr const char* symmetries[] = {"none", "rotational", "C0-C180", "C90-C270",
                                          "C0-C180 and C90-C270"};
    result.symmetry = symmetries[symmetry_];
    result.stored_planes = stored_.size();
    result.absolute = absolute_;
    result.stated_flux_lm = lamps.flux_lm;
    result.input_power_w = lamps.power_w;
    compare_with_stated(result, lamps);
    result.lamp_sets = lamp_sets_;
    result.opening = opening_;
    result.notes = std::move(notes_);
    deviations_.insert(deviations_.end(), result.deviations.begin(), result.deviations.end());
    result.deviations = std::move(deviations_);
    return result;
}

}  // namespace

PhotometricFile read_eulumdat(const TextFile& file, int lamp_set) {
    return EulumdatReader(file).read(lamp_set);
}

}  // namespace lucerna
