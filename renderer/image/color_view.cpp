#include "renderer/image/color_view.h"

#include <stdexcept>

#include "renderer/base/error.h"
#include "renderer/image/files/formats_module.h"
#include "stopping/base/input_file.h"

namespace lull {

std::shared_ptr<const ViewTransform> LoadView(const std::string& config,
                                              const std::string& view) try {
    static auto* const open = reinterpret_cast<OpenViewFunction*>(
        ModuleFunction("LullOpenView", "views of OpenColorIO are made by the module"));
    return std::shared_ptr<const ViewTransform>(open(config.c_str(), view.c_str()));
} catch (const std::runtime_error& e) {
    throw Error((config.empty() ? "--view" : config) + ": " + Printable(OneLine(e.what()), 1000));
}

}  // namespace lull
