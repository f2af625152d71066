#include "renderer/progress/time_limit.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lull {

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
