#include "renderer/image/grade.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "renderer/base/color.h"

namespace lull {

std::string TextOf(const Grade& grade) {
    std::string text;
    if (grade.view)
        text = fmt::format("OpenColorIO {}", grade.view->Name());
    else if (grade.toneMap == ToneMap::Filmic)
        text = "filmic (Hable 2010)";
    if (grade.exposure == 0) return text;
    return fmt::format("{}{}{:+g} stops", text, text.empty() ? "" : ", ", grade.exposure);
}

bool MapColors(const Grade& grade, std::span<float> rgb) {
    const float scale = std::exp2(grade.exposure);
    for (float& v : rgb) v *= scale;
    if (grade.view)
        grade.view->Apply(rgb.data(), rgb.size() / 3);
    else if (grade.toneMap == ToneMap::Filmic)
        std::ranges::transform(rgb, rgb.begin(), FilmicToneMap);
    return grade.view != nullptr;
}

void ApplyGrade(const Grade& grade, std::span<float> rgb) {
    if (grade.IsPlain()) return;
    const bool isEncoded = MapColors(grade, rgb);
    for (float& v : rgb)
        v = isEncoded ? LinearFromSrgb(v > 0 ? std::min(v, 1.f) : 0)
                      : (v > 0 ? std::min(v, std::numeric_limits<float>::max()) : 0);
}

}  // namespace lull
