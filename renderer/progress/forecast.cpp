#include "renderer/progress/forecast.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace lull {

namespace {

constexpr double kMostLevel = 12;  // of numbers that are 0, infinite or certain
// Above this share of the highest level of all blocks, a network counts as sure as it can be: the
// layers of an LSTM are bounded, and so are its odds.
constexpr double kCertain = 0.85;
// A slope that this many points show counts as much as that of the other blocks.
constexpr double kPointsOfOthers = 4;

double Level(const RuleTrend& rule, const Decision& d, std::optional<double> noise) {
    double level = 0;
    if (rule.undecided > 0) {
        level = std::log(*noise / rule.undecided);
    } else {
        level = std::log(d.value / d.threshold);
        if (rule.kind == RuleTrend::Probability)
            level += std::log((1 - d.threshold) / (1 - d.value));
    }
    return std::isnan(level) ? kMostLevel : std::clamp(level, -kMostLevel, kMostLevel);
}

template <typename T>
T MedianOf(std::vector<T>* values) {
    const auto middle = values->begin() + ptrdiff_t(values->size() / 2);
    std::nth_element(values->begin(), middle, values->end());
    return *middle;
}

// Bounds a slope to the plausible; probabilities fall as fast as a network likes.
double Bounded(const StopTrend& trend, double slope) {
    return trend.IsOfOdds() ? std::clamp(slope, -40.0, -0.2) : std::clamp(slope, -2.0, -0.1);
}

// Returns the level above which a number says no more.
double CertainLevel(std::span<const StopTrend> trends) {
    double highest = 0;
    for (const StopTrend& trend : trends)
        if (trend.IsOfOdds()) highest = std::max(highest, trend.HighestLevel());
    return highest > 0 ? kCertain * highest : std::numeric_limits<double>::infinity();
}

// Returns the median of the slopes that the blocks show; 0 if there is none.
double UsualSlope(std::span<const StopTrend> trends, double certain) {
    std::vector<double> slopes;
    bool isPower = false;
    for (const StopTrend& trend : trends) {
        const StopTrend::Line line = trend.Fit(certain);
        isPower |=
            trend.LastSpp() > 0 && trend.Rule().kind != RuleTrend::Samples && !trend.IsOfOdds();
        if (line.slope != 0) slopes.push_back(Bounded(trend, line.slope));
    }
    if (slopes.empty()) return isPower ? -0.5 : 0;
    return MedianOf(&slopes);
}

// Returns 1/N, and 0 where there is no picture at N spp that noise is compared with.
double InverseOf(double reference) { return reference > 0 ? 1.0 / reference : 0; }

// At which spp a block stops, without regard to the cap.
struct Stop {
    double spp = 0;
    bool isLeast = true;  // more than that is not to be told
};

Stop PredictStop(const StopTrend& trend, double usualSlope, double certain) {
    if (trend.LastSpp() == 0) return {};
    if (trend.Rule().kind == RuleTrend::Samples) return {trend.Threshold(), false};
    const StopTrend::Line line = trend.Fit(certain);
    double stop = trend.LastSpp();
    if (line.level > 0) {
        if (usualSlope == 0) return {stop, true};
        const double own = line.slope == 0 ? 0 : line.points / (line.points + kPointsOfOthers);
        double slope = Bounded(trend, std::lerp(usualSlope, line.slope, own));
        // Before the asymptote: the mean of the observed slope and the final one.
        if (trend.Rule().saturates) slope = (slope - 0.5) / 2;
        stop = trend.SppAt(trend.Abscissa(stop) +
                           std::min(std::min(line.level, certain) / -slope, 50.0));
    }
    return {stop + trend.VotesLeft(), line.level > certain};
}

}  // namespace

double StopTrend::Abscissa(double spp) const {
    return -std::log(std::max(1 / spp - InverseOf(rule.reference), 1e-9));
}

double StopTrend::SppAt(double abscissa) const {
    return 1 / (std::exp(-abscissa) + InverseOf(rule.reference));
}

void StopTrend::Add(int spp, const Decision& decision, std::optional<double> noise) {
    if (rule.undecided > 0 && !noise) return;
    const double level = Level(rule, decision, noise);
    Bin& bin = bins[size_t(PlaceOf(spp))];
    bin.abscissa += float(Abscissa(spp));
    bin.level += float(level);
    bin.count += 1;
    highest = std::max(highest, level);
    spacing = spp - lastSpp;
    lastSpp = spp;
    votes = decision.votes;
    threshold = decision.threshold;
}

int StopTrend::PlaceOf(int spp) {
    return std::clamp(int(std::log2(double(spp)) * kBinsPerOctave), 0, kBins - 1);
}

int StopTrend::VotesLeft() const { return std::max(0, rule.votes - 1 - votes) * spacing; }

StopTrend::Line StopTrend::Fit(double certain) const {
    struct Point {
        double x, y;
    };
    std::vector<Point> points;  // the last first
    const int last = PlaceOf(std::max(1, lastSpp));
    std::optional<double> latest;
    for (int i = last; i >= std::max(0, last - 2 * kBinsPerOctave + 1); --i) {
        const Bin& bin = bins[size_t(i)];
        if (bin.count == 0) continue;
        const Point point{double(bin.abscissa / bin.count), double(bin.level / bin.count)};
        if (!latest) latest = point.y;
        if (point.y <= certain) points.push_back(point);
    }
    Line line{.level = latest.value_or(0), .slope = 0, .points = int(points.size())};
    if (points.size() < 3) return line;
    std::vector<double> slopes, levels;
    for (size_t i = 0; i < points.size(); ++i)
        for (size_t j = i + 1; j < points.size(); ++j)
            slopes.push_back((points[i].y - points[j].y) / (points[i].x - points[j].x));
    line.slope = MedianOf(&slopes);
    for (size_t i = 0; i < std::min(points.size(), size_t(kBinsPerOctave)); ++i)
        levels.push_back(points[i].y + line.slope * (Abscissa(lastSpp) - points[i].x));
    line.level = MedianOf(&levels);
    return line;
}

std::optional<std::vector<double>> PredictStops(std::span<const StopTrend> trends,
                                                std::span<const Block> blocks, int cap) {
    const double certain = CertainLevel(trends), usualSlope = UsualSlope(trends, certain);
    std::vector<Stop> found(blocks.size());
    std::vector<double> known;
    for (size_t i = 0; i < blocks.size(); ++i) {
        if (!blocks[i].votes) continue;
        found[i] = blocks[i].stopped ? Stop{double(blocks[i].spp), false}
                                     : PredictStop(trends[i], usualSlope, certain);
        if (!found[i].isLeast) known.push_back(found[i].spp);
    }
    if (known.empty()) return {};
    const double usual = MedianOf(&known);
    std::vector<double> stops(blocks.size());
    const auto bounded = [&](size_t i, double stop) {
        const double spp = blocks[i].spp;
        return blocks[i].stopped ? spp : std::clamp(stop, spp, std::max(spp, double(cap)));
    };
    for (size_t i = 0; i < blocks.size(); ++i)
        if (blocks[i].votes)
            stops[i] = bounded(i, found[i].isLeast ? std::max(found[i].spp, usual) : found[i].spp);
    for (size_t i = 0; i < blocks.size(); ++i)
        if (const int leader = blocks[i].leader; !blocks[i].votes)
            stops[i] = bounded(i, leader < 0 ? double(cap) : stops[size_t(leader)]);
    return stops;
}

namespace {

// Takes a unit off the text and returns it in seconds; 0 for none.
double TakeUnit(std::string_view* text) {
    constexpr std::pair<std::string_view, double> kUnits[] = {
        {"ms", 1e-3}, {"h", 3600}, {"m", 60}, {"s", 1}};
    for (const auto& [name, seconds] : kUnits)
        if (text->starts_with(name)) {
            text->remove_prefix(name.size());
            return seconds;
        }
    return 0;
}

// Takes two digits below `limit`, and `end` after them, off the text. Returns -1 for others.
int TakeTwoDigits(std::string_view* text, int limit) {
    int value = 0;
    if (text->size() < 2) return -1;
    const auto [rest, error] = std::from_chars(text->data(), text->data() + 2, value);
    if (error != std::errc() || rest != text->data() + 2 || value < 0 || value >= limit) return -1;
    text->remove_prefix(2);
    return value;
}

}  // namespace

double ParseDuration(const std::string& text) {
    const auto refuse = [&] {
        throw std::invalid_argument(
            fmt::format("invalid duration '{}'; use e.g. 90s, 10m or 1h30m", text));
    };
    double seconds = 0, largerUnit = INFINITY;
    for (std::string_view left = text; !left.empty();) {
        double value = 0;
        const auto [rest, error] = std::from_chars(left.data(), left.data() + left.size(), value,
                                                   std::chars_format::fixed);
        if (error != std::errc()) refuse();
        left.remove_prefix(size_t(rest - left.data()));
        const bool isNumberAlone = left.empty() && largerUnit == INFINITY;
        const double unit = isNumberAlone ? 1 : TakeUnit(&left);
        if (unit == 0 || unit >= largerUnit || !(value >= 0)) refuse();
        seconds += value * unit;
        largerUnit = unit;
    }
    if (!(seconds > 0) || seconds > 1e9) refuse();
    return seconds;
}

std::time_t NextTimeOfDay(const std::string& text, std::time_t now) {
    std::string_view left = text;
    const int hour = TakeTwoDigits(&left, 24);
    int minute = -1, second = 0;
    if (hour >= 0 && left.starts_with(':')) {
        left.remove_prefix(1);
        minute = TakeTwoDigits(&left, 60);
    }
    if (minute >= 0 && left.starts_with(':')) {
        left.remove_prefix(1);
        second = TakeTwoDigits(&left, 60);
    }
    if (minute < 0 || second < 0 || !left.empty())
        throw std::invalid_argument(fmt::format("invalid time of day '{}'; use e.g. 09:00", text));

    std::tm today = {};
    localtime_r(&now, &today);
    // A day more until it is in the future; mktime() knows of the ends of months, and finds out
    // about summer time.
    for (int day = 0;; ++day) {
        std::tm then = today;
        then.tm_mday += day;
        then.tm_hour = hour;
        then.tm_min = minute;
        then.tm_sec = second;
        then.tm_isdst = -1;
        const std::time_t time = std::mktime(&then);
        if (time > now) return time;
    }
}

double SecondsToWrite(int64_t pixels) { return 0.1 + 1e-6 * double(pixels); }

double SecondsToDenoise(int64_t pixels, int threads) { return 25e-6 * double(pixels) / threads; }

}  // namespace lull
