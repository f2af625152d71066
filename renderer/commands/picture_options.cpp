#include "renderer/commands/picture_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <set>

#include "renderer/base/memory.h"
#include "renderer/base/say.h"
#include "renderer/commands/choice_option.h"

namespace lull {

template <>
struct EnumNames<ToneMap> {
    static constexpr std::pair<ToneMap, const char*> all[] = {{ToneMap::None, "none"},
                                                              {ToneMap::Filmic, "filmic"}};
};

void AddPictureOptions(CLI::App& app, PictureOptions* options) {
    AddChoiceOption(
        app, "--tone-map", &options->format.toneMap,
        "Fit the PNG to the display: filmic darkens and keeps what is up to 5.6 times white;\n"
        "rules judge the picture without it");
    app.add_option("--png-bits", options->format.pngBits, "Bits of each colour of the PNG")
        ->check(OneOf(std::set{8, 16}))
        ->type_name("8|16")
        ->capture_default_str();
    app.add_flag("--exr-half", options->format.exrHalf,
                 "Colours and normals of the EXR take 16 bits, up to 65504, instead of 32");
    app.add_option(
           "--display", options->display,
           "Show the render in a viewer with tev's protocol at this address, while it runs;\n"
           "with --denoise, blocks as they were last denoised")
        ->check([](const std::string& text) -> std::string {
            try {
                ParseDisplayAddress(text);
                return "";
            } catch (const Error& e) {
                return e.what();
            }
        })
        ->type_name("HOST:PORT");
    app.add_option("--preview", options->preview,
                   "Write the current image to OUT.exr and OUT.png every SECONDS")
        ->check(CLI::Range(0.1, 1e6))
        ->type_name("SECONDS");
}

std::unique_ptr<Display> MakeDisplay(const PictureOptions& options, const std::string& name,
                                     const PixelRect& region, int ranks, const Talk& talk) {
    if (options.display.empty()) return nullptr;
    if (ranks > 1)
        throw Error(
            "--display: no rank has the whole picture before the end; render it by one "
            "process");
    CheckMemory(region.Area() * int64_t(5 * sizeof(float) + 1),
                fmt::format("--display of {}x{} pixels", region.Width(), region.Height()),
                "leave it out");
    return std::make_unique<Display>(ParseDisplayAddress(options.display), name, region,
                                     [talk](const std::string& message) { talk.Warn(message); });
}

}  // namespace lull
