#include "io/ies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/ies_opening.h"
#include "io/ies_planes.h"

namespace lucerna {
namespace {

constexpr double metre_per_foot = 0.3048;
constexpr std::size_t max_angles = 20000;

struct Edition {
    int year;
    const char* identifier;
};
constexpr Edition editions[] = {{1991, "IESNA91"},
                                {1995, "IESNA:LM-63-1995"},
                                {2002, "IESNA:LM-63-2002"},
                                {2019, "IES:LM-63-2019"}};

std::string upper(std::string_view text) {
    std::string result(text);
    for (char& c : result) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    return result;
}

// Index of the TILT= line, or the number of lines.
std::size_t tilt_line(const TextFile& file) {
    std::size_t line = 0;
    while (line < file.lines.size() && !upper(trimmed(file.lines[line])).starts_with("TILT=")) {
        ++line;
    }
    return line;
}

// What the third factor of the second line means since 2019 (LM-63-19, table 2).
std::string file_generation(double value) {
    const auto code = std::lround((value - 1.0) * 1e5);
    if (code == 1) return "undefined";
    if (code == 10) return "computer simulation";
    std::string text = code >= 10000 ? "test in an accredited laboratory"
                                     : "test in a laboratory that is not accredited";
    if (code / 1000 % 10 == 1) text += ", angles interpolated";
    if (code / 100 % 10 == 1) text += ", scaled in flux";
    return text;
}

// Reads the file from top to bottom; numbers that are wrong are reported together.
class IesReader {
public:
    explicit IesReader(const TextFile& file) : file_(file), errors_(file) {}

    PhotometricFile read() {
        read_edition();
        read_labels();
        const double tilt_factor = read_tilt();
        read_data();
        return assemble(tilt_factor);
    }

private:
    void deviates(std::size_t line, std::string text) {
        deviations_.push_back(fmt::format("line {}: {}", line + 1, std::move(text)));
    }
    void read_edition();
    void read_labels();
    double read_tilt();
    double tilt_factor_at_zero();
    void read_data();
    void check_vertical_angles();
    void check_increasing(const std::vector<double>& angles, std::size_t first_word,
                          const char* name);
    Opening read_opening(double width, double length, double height, const Word& place);
    PhotometricFile assemble(double tilt_factor);

    // The next number of the data; `what` names it in the message.
    double number(const std::string& what);
    double number_that(const std::string& what, bool (*holds)(double), const char* accepted);
    std::size_t count(const std::string& what, std::size_t least);
    std::vector<double> numbers(std::size_t n, const std::string& what);

    const TextFile& file_;
    ErrorList errors_;
    int year_ = 1986;
    std::size_t tilt_line_ = 0;
    std::vector<Word> words_;
    std::size_t next_ = 0;

    std::vector<std::pair<std::string, std::string>> keywords_;
    std::vector<std::string> deviations_, notes_;
    double lamps_ = 1.0, lamp_flux_lm_ = 0.0, factor_ = 1.0, power_w_ = 0.0;
    char type_ = 'C';
    std::vector<double> vertical_deg_, horizontal_deg_;
    std::size_t vertical_word_ = 0, horizontal_word_ = 0;
    std::vector<std::vector<double>> table_;  // [horizontal][vertical]
    Opening opening_;
};

void IesReader::read_edition() {
    const std::string& first_line = file_.lines.front();
    const std::string first(trimmed(first_line));
    for (const Edition& edition : editions) {
        if (first_line == edition.identifier) year_ = edition.year;
    }
    if (year_ != 1986) return;
    const std::string shouted = upper(first);
    if (!shouted.starts_with("IES")) return;  // 1986 has no identifier
    for (const Edition& edition : editions) {
        const std::string full = std::to_string(edition.year);
        if (shouted.ends_with(full) || shouted.ends_with(full.substr(2))) {
            year_ = edition.year;
            deviates(0, fmt::format("{} is not the identifier \"{}\", but read as that",
                                    in_quotes(first_line), edition.identifier));
            return;
        }
    }
    if (!shouted.ends_with("86")) {
        deviates(0, in_quotes(first_line) + " is no known edition of LM-63; read as 1986");
    }
}

void IesReader::read_labels() {
    tilt_line_ = tilt_line(file_);
    if (tilt_line_ == file_.lines.size()) {
        throw InputError(file_.at(file_.lines.size() - 1),
                         "the file has no line that begins with TILT=; expected TILT=NONE, "
                         "TILT=INCLUDE or TILT=<file> after the labels of an LM-63 file");
    }
    for (std::size_t line = year_ == 1986 ? 0 : 1; line < tilt_line_; ++line) {
        const std::string_view text = trimmed(file_.lines[line]);
        const std::size_t close = text.find(']');
        if (!text.starts_with('[') || close == std::string_view::npos) {
            if (year_ != 1986) deviates(line, "text without a [KEYWORD]");
            continue;
        }
        const std::string key = upper(text.substr(1, close - 1));
        const std::string value(trimmed(text.substr(close + 1)));
        if (key == "MORE") {
            if (keywords_.empty()) {
                deviates(line, "[MORE] continues nothing");
            } else {
                keywords_.back().second += "\n" + value;
            }
        } else {
            keywords_.emplace_back(key, value);
        }
    }
    const auto require = [&](std::initializer_list<const char*> required) {
        for (const char* key : required) {
            if (std::none_of(keywords_.begin(), keywords_.end(),
                             [&](const auto& entry) { return entry.first == key; })) {
                deviates(0, fmt::format("the required keyword [{}] is missing", key));
            }
        }
    };
    if (year_ == 1991) require({"TEST", "MANUFAC"});
    if (year_ >= 2002) require({"TEST", "TESTLAB", "ISSUEDATE", "MANUFAC"});
}

double IesReader::read_tilt() {
    const std::string_view text = trimmed(file_.lines[tilt_line_]).substr(5);
    const std::string name(trimmed(text));
    words_ = split_words(file_, tilt_line_ + 1, ",");
    if (upper(name) == "NONE") return 1.0;
    if (upper(name) == "INCLUDE") return tilt_factor_at_zero();
    if (name.empty()) {
        throw InputError(file_.at(tilt_line_, 5),
                         "TILT= names nothing; expected NONE, INCLUDE or a "
                         "file beside this one");
    }
    if (year_ >= 2019) deviates(tilt_line_, "TILT=<file> is no longer part of LM-63-2019");
    // Only a file in the same folder: a photometric file must not reach elsewhere.
    const std::string leaf = name.substr(name.find_last_of("/\\") + 1);
    const TextFile tilt_file = read_text_file(file_.path.parent_path() / leaf);
    IesReader tilt(tilt_file);
    tilt.words_ = split_words(tilt_file, 0, ",");
    const double factor = tilt.tilt_factor_at_zero();
    notes_.insert(notes_.end(), tilt.notes_.begin(), tilt.notes_.end());
    return factor;
}

double IesReader::tilt_factor_at_zero() {
    number_that(
        "the lamp-to-luminaire geometry", [](double v) { return v == 1.0 || v == 2.0 || v == 3.0; },
        "1, 2 or 3");
    const std::size_t n = count("the number of tilt angles", 1);
    const std::size_t first_angle = next_;
    const std::vector<double> angles = numbers(n, "tilt angle");
    const std::vector<double> factors = numbers(n, "tilt factor");
    check_increasing(angles, first_angle, "tilt angles");
    errors_.throw_if_any();
    const auto zero = std::find(angles.begin(), angles.end(), 0.0);
    if (zero == angles.end()) {
        throw InputError(file_.at(words_[first_angle].line, words_[first_angle].column),
                         "the tilt data have no factor at 0 deg, the photometric position");
    }
    const double factor = factors[static_cast<std::size_t>(zero - angles.begin())];
    if (!(factor > 0.0)) {
        throw InputError(file_.at(words_[first_angle].line),
                         fmt::format("the tilt factor at 0 deg is {}; expected above 0", factor));
    }
    notes_.push_back(
        fmt::format("the tilt factor at 0 deg, {}, is applied; how the lamp's flux "
                    "changes in other positions of the luminaire is not modelled",
                    factor));
    return factor;
}

double IesReader::number(const std::string& what) {
    if (next_ >= words_.size()) {
        const std::size_t last = file_.lines.size() - 1;
        errors_.add(last, file_.lines[last].size(),
                    fmt::format("the file ends where {} should stand", what));
        errors_.throw_if_any();
    }
    const Word& word = words_[next_++];
    const auto value = parse_number(word.text);
    if (!value) {
        errors_.add(word.line, word.column,
                    fmt::format("{} stands for {}; expected a number", in_quotes(word.text), what));
        return std::nan("");
    }
    return *value;
}

double IesReader::number_that(const std::string& what, bool (*holds)(double),
                              const char* accepted) {
    const double value = number(what);
    if (!std::isnan(value) && !holds(value)) {
        const Word& word = words_[next_ - 1];
        errors_.add(word.line, word.column,
                    fmt::format("{} is {}; expected {}", what, word.text, accepted));
    }
    return value;
}

std::size_t IesReader::count(const std::string& what, std::size_t least) {
    const double value = number(what);
    const bool fits = value >= static_cast<double>(least) &&
                      value <= static_cast<double>(max_angles) && value == std::floor(value);
    if (fits) return static_cast<std::size_t>(value);
    if (!std::isnan(value)) {
        const Word& word = words_[next_ - 1];
        errors_.add(word.line, word.column,
                    fmt::format("{} is {}; expected a whole number from {} to {}", what, word.text,
                                least, max_angles));
    }
    return 0;
}

std::vector<double> IesReader::numbers(std::size_t n, const std::string& what) {
    if (n > words_.size() - next_) {
        const std::size_t last = file_.lines.size() - 1;
        errors_.add(last, file_.lines[last].size(),
                    fmt::format("the file ends after {} of the {} values of {}",
                                words_.size() - next_, n, what));
        errors_.throw_if_any();
    }
    std::vector<double> values;
    values.reserve(n);
    for (std::size_t i = 0; i < n; ++i) values.push_back(number(what));
    return values;
}

void IesReader::check_increasing(const std::vector<double>& angles, std::size_t first_word,
                                 const char* name) {
    for (std::size_t i = 1; i < angles.size(); ++i) {
        if (angles[i - 1] < angles[i] || std::isnan(angles[i - 1]) || std::isnan(angles[i]))
            continue;
        const Word& word = words_[first_word + i];
        errors_.add(word.line, word.column,
                    fmt::format("{} must increase; {} follows {}", name, angles[i], angles[i - 1]));
    }
}

void IesReader::read_data() {
    const auto positive = [](double v) { return v > 0.0; };
    lamps_ = number_that("the number of lamps", positive, "above 0");
    lamp_flux_lm_ = number("the lumens per lamp");
    const std::size_t flux_line = words_[next_ - 1].line;
    factor_ = number_that("the candela multiplier", positive, "above 0");
    const std::size_t verticals = count("the number of vertical angles", 2);
    const std::size_t horizontals = count("the number of horizontal angles", 1);
    const double type = number_that(
        "the photometric type", [](double v) { return v == 1.0 || v == 2.0 || v == 3.0; },
        "1 (type C), 2 (type B) or 3 (type A)");
    const double unit = number_that(
        "the unit of length", [](double v) { return v == 1.0 || v == 2.0; },
        "1 (feet) or 2 (metres)");
    const double metre = unit == 1.0 ? metre_per_foot : 1.0;
    const std::size_t opening_word = next_;
    const auto credible = [](double v) { return std::abs(v) < 1e4; };
    const char* accepted = "a size below 10000";
    const double width = number_that("the width of the luminous opening", credible, accepted);
    const double length = number_that("the length of the luminous opening", credible, accepted);
    const double height = number_that("the height of the luminous opening", credible, accepted);
    factor_ *= number_that("the ballast factor", positive, "above 0");
    const double third = number_that(
        year_ >= 2019 ? "the file generation type" : "the ballast-lamp photometric factor",
        positive, "above 0");
    power_w_ = number_that(
        "the input power", [](double v) { return v >= 0.0; }, "0 or more watts");
    errors_.throw_if_any();  // what follows depends on the counts

    type_ = type == 1.0 ? 'C' : type == 2.0 ? 'B' : 'A';
    opening_ = read_opening(width * metre, length * metre, height * metre, words_[opening_word]);
    if (year_ >= 2019) {
        notes_.push_back("file generation type: " + file_generation(third));
    } else {
        factor_ *= third;
    }
    if (lamp_flux_lm_ <= 0.0 && lamp_flux_lm_ != -1.0) {
        deviates(flux_line,
                 fmt::format("{} lumens per lamp; read as absolute photometry, which is -1",
                             lamp_flux_lm_));
    }

    vertical_word_ = next_;
    vertical_deg_ = numbers(verticals, "vertical angle");
    horizontal_word_ = next_;
    horizontal_deg_ = numbers(horizontals, "horizontal angle");
    check_increasing(vertical_deg_, vertical_word_, "vertical angles");
    check_increasing(horizontal_deg_, horizontal_word_, "horizontal angles");
    if (words_.size() - next_ < horizontals * verticals) {
        numbers(horizontals * verticals, "intensity");  // throws
    }
    for (const double angle_deg : horizontal_deg_) {
        const std::string what =
            std::isnan(angle_deg) ? fmt::format("an intensity of plane {}", table_.size() + 1)
                                  : fmt::format("an intensity at horizontal angle {}", angle_deg);
        std::vector<double>& plane = table_.emplace_back(numbers(verticals, what));
        for (std::size_t i = 0; i < verticals; ++i) {
            if (plane[i] >= 0.0 || std::isnan(plane[i])) continue;
            const Word& word = words_[next_ - verticals + i];
            errors_.add(
                word.line, word.column,
                fmt::format("the intensity {} is negative; expected 0 cd or more", word.text));
        }
    }
    errors_.throw_if_any();
    if (next_ < words_.size()) {
        deviates(words_[next_].line,
                 fmt::format("{} more words follow the last intensity, from {} on",
                             words_.size() - next_, in_quotes(words_[next_].text)));
    }
    if (year_ == 1986 && type_ == 'C' && vertical_deg_.front() < 0.0) {
        type_ = 'A';  // LM-63-1986 has the number 1 for types C and A
    }
    check_vertical_angles();
    errors_.throw_if_any();
}

void IesReader::check_vertical_angles() {
    const double first = vertical_deg_.front();
    const double last = vertical_deg_.back();
    const double lowest = type_ == 'C' ? 0.0 : -180.0;
    for (std::size_t i = 0; i < vertical_deg_.size(); ++i) {
        if (vertical_deg_[i] >= lowest && vertical_deg_[i] <= 180.0) continue;
        const Word& word = words_[vertical_word_ + i];
        errors_.add(
            word.line, word.column,
            fmt::format("the vertical angle {} is outside {} to 180 deg", word.text, lowest));
    }
    const bool regular = type_ == 'C'
                             ? (first == 0.0 || first == 90.0) && (last == 90.0 || last == 180.0)
                             : (first == -90.0 || first == 0.0) && last == 90.0;
    if (!regular) {
        deviates(
            words_[vertical_word_].line,
            fmt::format("vertical angles from {} to {}; expected {}; the luminaire is taken as "
                        "dark outside",
                        first, last, type_ == 'C' ? "0 or 90 to 90 or 180" : "-90 or 0 to 90"));
    }
}

Opening IesReader::read_opening(double width_m, double length_m, double height_m,
                                const Word& place) {
    using namespace ies_opening_tables;
    const auto of_common = ies_opening(common, false, width_m, length_m, height_m);
    if (of_common) return *of_common;
    const auto old = [&](int year) {
        return year < 1995 ? ies_opening(of_1986, true, width_m, length_m, height_m)
                           : ies_opening(of_1995, true, width_m, length_m, height_m);
    };
    const auto recent = ies_opening(of_2002, false, width_m, length_m, height_m);
    const auto own = year_ >= 2002 ? recent : old(year_);
    if (own) return *own;
    const std::string signs =
        fmt::format("the dimensions {:.6g}, {:.6g}, {:.6g} m", width_m, length_m, height_m);
    // Files often follow the table of another edition than the one that they name.
    for (const auto& [other, name] :
         {std::pair{recent, 2002}, std::pair{old(1995), 1995}, std::pair{old(1986), 1986}}) {
        if (!other) continue;
        deviates(place.line,
                 fmt::format("{} name no opening of LM-63-{}; read as a {} after LM-63-{}", signs,
                             year_, other->description(), name));
        return *other;
    }
    const auto upright = ies_opening(extension, false, width_m, length_m, height_m);
    if (upright) {
        deviates(place.line, fmt::format("{} name no opening of LM-63; read as a {}", signs,
                                         upright->description()));
        return *upright;
    }
    const int sizes = (width_m != 0.0) + (length_m != 0.0) + (height_m != 0.0);
    if (sizes == 1) {
        deviates(place.line, signs + " have no area; read as a point");
        return {};
    }
    throw InputError(file_.at(place.line, place.column),
                     signs +
                         " name no luminous opening of any edition of LM-63; expected, for "
                         "instance, width and length above 0 and height 0 for a rectangle");
}

PhotometricFile IesReader::assemble(double tilt_factor) {
    const Word& place = words_[horizontal_word_];
    FullCircle circle = full_circle(type_, {horizontal_deg_, vertical_deg_, table_},
                                    file_.at(place.line, place.column));
    for (std::string& text : circle.deviations) deviates(place.line, std::move(text));
    for (std::string& note : circle.notes) notes_.push_back(std::move(note));
    for (auto& plane : circle.table.values) {
        for (double& value : plane) value *= factor_ * tilt_factor;
    }
    PhotometricFile result = photometric_file(file_, circle.table, place.line);
    result.format = fmt::format("IES LM-63-{}", year_);
    const auto keyword = [&](const char* key) {
        for (const auto& [name, value] : keywords_) {
            if (name == key) return value.substr(0, value.find('\n'));
        }
        return std::string();
    };
    result.manufacturer = keyword("MANUFAC");
    result.luminaire = keyword("LUMINAIRE");
    result.catalogue_number = keyword("LUMCAT");
    result.report_number = keyword("TEST");
    result.date = keyword(year_ >= 2002 ? "ISSUEDATE" : "DATE");
    if (year_ == 1986 && keywords_.empty() && tilt_line_ > 0) {
        result.luminaire = std::string(trimmed(file_.lines.front()));
    }
    result.keywords = std::move(keywords_);
    result.photometric_type = type_;
    result.symmetry = circle.symmetry;
    result.stored_planes = horizontal_deg_.size();
    result.absolute = lamp_flux_lm_ <= 0.0;
    if (!result.absolute) {
        result.stated_flux_lm = lamps_ * lamp_flux_lm_;
        result.light_output_ratio = result.integrated_flux_lm / *result.stated_flux_lm;
        if (*result.light_output_ratio > 1.01) {
            deviates(words_.front().line,
                     fmt::format("the luminaire emits {:.4g} % of the flux of its lamps",
                                 100.0 * *result.light_output_ratio));
        }
    }
    result.input_power_w = power_w_;
    LampSet lamps{lamps_, keyword("LAMP"), result.stated_flux_lm.value_or(0.0), "", "", power_w_};
    result.lamp_sets.push_back(std::move(lamps));
    result.opening = opening_;
    result.notes = std::move(notes_);
    deviations_.insert(deviations_.end(), result.deviations.begin(), result.deviations.end());
    result.deviations = std::move(deviations_);
    return result;
}

}  // namespace

PhotometricFile read_ies(const TextFile& file) {
    return IesReader(file).read();
}

bool looks_like_ies(const TextFile& file) {
    return tilt_line(file) < file.lines.size();
}

}  // namespace lucerna
