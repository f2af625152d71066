#include "renderer/scene/lights/emission_profile.h"

#include <numbers>

namespace lull {

Spread Spread::Make(double degrees) {
    constexpr double kLeast = 1e-3;  // below, directions of float are too coarse
    const double h = std::max(degrees * std::numbers::pi / 360, kLeast), tangent = std::tan(h);
    return {float(tangent), float(std::sin(h)), float(std::cos(std::min(h + 1e-3, 1.5707963))),
            float(1 / (tangent - h))};
}

float PowerFraction(const EmissionProfile& profile) {
    const auto* cone = std::get_if<SpotCone>(&profile);
    return cone ? cone->SolidAngle() / (4 * kPi) : 1;
}

}  // namespace lull
