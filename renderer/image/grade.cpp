#include "renderer/image/grade.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "renderer/base/color.h"
#include "renderer/base/error.h"
#include "renderer/image/files/other_formats.h"
#include "stopping/base/input_file.h"

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

std::shared_ptr<const ViewTransform> LoadView(const std::string& config,
                                              const std::string& view) try {
    static auto* const open = reinterpret_cast<OpenViewFunction*>(
        ModuleFunction("LullOpenView", "views of OpenColorIO are made by the module"));
    return std::shared_ptr<const ViewTransform>(open(config.c_str(), view.c_str()));
} catch (const std::runtime_error& e) {
    throw Error((config.empty() ? "--view" : config) + ": " + Printable(OneLine(e.what()), 1000));
}

}  // namespace lull
