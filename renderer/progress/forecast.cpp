#include "renderer/progress/forecast.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <stdexcept>
#include <utility>

namespace lull {

namespace {

constexpr double kMostLevel = 12;  // of numbers that are 0, infinite or certain
// Above this share of the highest level of all blocks, a network counts as sure as it can be: the
// layers of an LSTM are bounded, and so are its odds.
constexpr double kCertain = 0.85;
// Of numbers that saturate, before there is a slope to be seen: the mean of this and -0.5 is that
// of recordings from 60 to 140 spp on.
constexpr double kFirstSlope = -0.36;
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

double CertainLevel(std::span<const StopTrend> trends) {
    double highest = 0;
    for (const StopTrend& trend : trends)
        if (trend.IsOfOdds()) highest = std::max(highest, trend.HighestLevel());
    return highest > 0 ? kCertain * highest : std::numeric_limits<double>::infinity();
}

double UsualSlope(std::span<const StopTrend> trends, double certain) {
    std::vector<double> slopes;
    bool isPower = false, saturates = false;
    for (const StopTrend& trend : trends) {
        const StopTrend::Line line = trend.Fit(certain);
        isPower |=
            trend.LastSpp() > 0 && trend.Rule().kind != RuleTrend::Samples && !trend.IsOfOdds();
        saturates |= trend.Rule().saturates;
        if (line.slope != 0) slopes.push_back(Bounded(trend, line.slope));
    }
    if (slopes.empty()) return saturates ? kFirstSlope : isPower ? -0.5 : 0;
    return MedianOf(&slopes);
}

struct Stop {
    double spp = 0;
    bool isLeast = true;  // more than that is not to be told
};

// Returns the slope from a block's last level on, where `usual` is that of the others.
double SlopeAhead(const StopTrend& trend, const StopTrend::Line& line, double usual) {
    if (trend.Rule().power != 0) return trend.Rule().power;
    const double own = line.slope == 0 ? 0 : line.points / (line.points + kPointsOfOthers);
    const double slope = Bounded(trend, std::lerp(usual, line.slope, own));
    // Before the asymptote: the mean of the observed slope and the final one.
    return trend.Rule().saturates ? (slope - 0.5) / 2 : slope;
}

Stop PredictStop(const StopTrend& trend, double usualSlope, double certain) {
    if (trend.LastSpp() == 0) return {};
    if (trend.Rule().kind == RuleTrend::Samples) return {trend.Threshold(), false};
    const StopTrend::Line line = trend.Fit(certain);
    double stop = trend.LastSpp();
    if (line.level > 0) {
        if (usualSlope == 0) return {stop, true};
        const double slope = SlopeAhead(trend, line, usualSlope);
        stop = trend.SppAt(trend.Abscissa(stop) +
                           std::min(std::min(line.level, certain) / -slope, 50.0));
    }
    return {stop + trend.VotesLeft(), line.level > certain};
}

}  // namespace

double StopTrend::Abscissa(double spp) const {
    if (rule.reference == 0) return std::log(spp);
    return std::log(spp) - 2 * rule.nearness * std::log(std::max(1 - spp / rule.reference, 1e-6));
}

double StopTrend::SppAt(double abscissa) const {
    if (rule.reference == 0) return std::exp(abscissa);
    double below = 0, above = rule.reference;
    for (int i = 0; i < 50; ++i) {
        const double middle = (below + above) / 2;
        (Abscissa(middle) < abscissa ? below : above) = middle;
    }
    return above;
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

std::array<double, 2> RangeOfRest(double taken, double left,
                                  const std::array<double, 2>& exponents) {
    const auto rest = [=](double exponent) {
        return taken * (std::pow(1 + left / taken, exponent) - 1);
    };
    return {rest(exponents[0]), rest(exponents[1])};
}

double ParseDuration(const std::string& text) {
    const std::string number = R"((\d{1,15}\.?\d{0,15}|\.\d{1,15}))";
    const std::regex seconds(number),
        sum(fmt::format("(?:{0}h)?(?:{0}m)?(?:{0}s)?(?:{0}ms)?", number));
    std::smatch parts;
    double duration = 0;
    if (std::regex_match(text, parts, seconds))
        duration = std::stod(parts[1]);
    else if (std::regex_match(text, parts, sum))
        for (const auto& [part, unit] : {std::pair(1, 3600.0), {2, 60}, {3, 1}, {4, 1e-3}})
            if (parts[size_t(part)].matched) duration += std::stod(parts[size_t(part)]) * unit;
    if (!(duration > 0) || duration > 1e9)
        throw std::invalid_argument(
            fmt::format("invalid duration '{}'; use e.g. 90s, 10m or 1h30m", text));
    return duration;
}

std::time_t NextTimeOfDay(const std::string& text, std::time_t now) {
    const std::regex time(R"(([01]\d|2[0-3]):([0-5]\d)(?::([0-5]\d))?)");
    std::smatch parts;
    if (!std::regex_match(text, parts, time))
        throw std::invalid_argument(fmt::format("invalid time of day '{}'; use e.g. 09:00", text));
    const auto number = [&](size_t part) {
        return parts[part].matched ? std::stoi(parts[part]) : 0;
    };

    std::tm today = {};
    localtime_r(&now, &today);
    // A day more until it is in the future; mktime() knows of months and of summer time.
    for (int day = 0;; ++day) {
        std::tm then = today;
        then.tm_mday += day;
        then.tm_hour = number(1);
        then.tm_min = number(2);
        then.tm_sec = number(3);
        then.tm_isdst = -1;
        const std::time_t next = std::mktime(&then);
        if (next > now) return next;
    }
}

double SecondsToWrite(int64_t pixels) { return 0.1 + 1e-6 * double(pixels); }

double SecondsToDenoise(int64_t pixels, int threads) { return 25e-6 * double(pixels) / threads; }

}  // namespace lull
