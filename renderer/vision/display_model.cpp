#include "renderer/vision/display_model.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>

#include "renderer/base/error.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

struct Unit {
    std::string_view name;
    double DisplayModel::*value;
    double least, most;
};

constexpr Unit kUnits[] = {{"cd", &DisplayModel::peak, 1, 10000},
                           {"ppd", &DisplayModel::pixelsPerDegree, 5, 500},
                           {"lux", &DisplayModel::ambient, 0, 100000}};

[[noreturn]] void Fail(std::string_view text) {
    throw Error(
        fmt::format("display '{}': a peak luminance from 1 to 10000 cd/m2, 5 to 500 pixels "
                    "per degree and 0 to 100000 lux are needed, as in 100cd,40ppd,250lux",
                    text));
}

}  // namespace

DisplayModel ParseDisplay(std::string_view text) {
    DisplayModel display;
    bool isSet[std::size(kUnits)] = {};
    for (std::string_view rest = text;;) {
        const size_t comma = rest.find(',');
        const std::string_view part = rest.substr(0, comma);
        double value = 0;
        const char* end = part.data() + part.size();
        const auto [after, error] = std::from_chars(part.data(), end, value);
        const std::string_view name(after, size_t(end - after));
        size_t i = 0;
        while (i < std::size(kUnits) && kUnits[i].name != name) ++i;
        if (error != std::errc() || i == std::size(kUnits) || isSet[i]) Fail(text);
        if (!(value >= kUnits[i].least && value <= kUnits[i].most)) Fail(text);
        isSet[i] = true;
        display.*kUnits[i].value = value;
        if (comma == std::string_view::npos) return display;
        rest.remove_prefix(comma + 1);
    }
}

std::string NameOf(const DisplayModel& display) {
    return fmt::format("{}cd,{}ppd,{}lux", display.peak, display.pixelsPerDegree, display.ambient);
}

std::vector<float> DisplayedLight(std::span<const float> linear, const DisplayModel& display) {
    const double black = display.peak / display.contrast;
    const double veil = black + display.ambient * display.reflectance / std::numbers::pi;
    std::vector<float> light;
    light.reserve(linear.size());
    for (const float v : linear)
        light.push_back(float((display.peak - black) * double(Displayed(v)) + veil));
    return light;
}

}  // namespace lull
