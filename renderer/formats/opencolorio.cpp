// The module's views of OpenColorIO configurations, by way of OpenImageIO.
#include <OpenImageIO/color.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "renderer/formats/formats.h"

namespace {

// Names of linear sRGB in the configurations of ACES, Blender and OpenColorIO. A configuration
// without any of them renders in this space, or would need another renderer.
constexpr std::array kLinearSrgb = {"Linear Rec.709 (sRGB)",   "lin_rec709_srgb", "lin_srgb",
                                    "Utility - Linear - sRGB", "Linear Rec.709",  "lin_rec709"};

std::string Listed(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

class OcioView final : public lull::ViewTransform {
  public:
    OcioView(const std::string& path, std::string view) {
        const char* variable = std::getenv("OCIO");
        const std::string file = !path.empty() ? path : variable ? variable : "";
        if (file.empty()) throw std::runtime_error("there is no configuration: $OCIO is not set");
        if (!std::filesystem::is_regular_file(file))
            throw std::runtime_error("\"" + file + "\" is not a file");
        OIIO::ColorConfig config(file);
        if (config.has_error()) throw std::runtime_error(config.geterror());
        const std::string display = config.getDefaultDisplayName();
        const std::vector<std::string> views = config.getViewNames(display);
        if (view.empty()) view = config.getDefaultViewName(display);
        if (std::ranges::find(views, view) == views.end())
            throw std::runtime_error("the display " + display + " has no view \"" + view +
                                     "\", but: " + Listed(views));
        const std::vector<std::string> spaces = config.getColorSpaceNames();
        std::string from = "scene_linear";
        for (const char* name : kLinearSrgb)
            if (std::ranges::find(spaces, name) != spaces.end()) {
                from = name;
                break;
            }
        processor = config.createDisplayTransform(display, view, from);
        if (!processor) throw std::runtime_error(config.geterror());
        name = display + "/" + view;
    }

    void Apply(float* rgb, size_t pixels) const override {
        processor->apply(rgb, int(pixels), 1, 3, sizeof(float), 3 * sizeof(float),
                         OIIO::stride_t(3 * sizeof(float) * pixels));
    }
    const char* Name() const override { return name.c_str(); }

  private:
    OIIO::ColorProcessorHandle processor;
    std::string name;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) lull::ViewTransform* LullOpenView(
    const char* path, const char* view) {
    return new OcioView(path, view);
}
