#include "renderer/commands/finished_frame.h"

#include <fmt/format.h>

#include <sstream>

#include "stopping/base/input_file.h"

namespace lull::render {

namespace {

// Returns the first line of a text that another has not, for a message.
std::string FirstDifference(const std::string& text, const std::string& other) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);)
        if (("\n" + other).find("\n" + line + "\n") == std::string::npos) return line;
    return "";
}

}  // namespace

std::string SettingsOf(const PreparedRender& p) {
    const RenderRequest& request = p.request;
    const PictureFormat& format = request.pictures.format;
    RenderIdentity identity = p.render.Identity();
    identity["aov"] = TextOf(request.aovs);
    identity["light groups"] = NameOf(p.film.layers.groups);
    identity["denoise"] = request.denoise ? "yes" : "no";
    identity["denoise-layers"] = request.denoiseLayers ? "yes" : "no";
    identity["png-bits"] = std::to_string(format.pngBits);
    identity["tone-map"] = TextOf(format.grade);
    identity["transparent"] = format.isTransparent ? "yes" : "no";
    identity["exr-half"] = format.exrHalf ? "yes" : "no";
    return TextOf(identity);
}

bool IsFinished(const PreparedRender& p) {
    const RenderFiles& files = p.files;
    if (!IsThere(files.exr) || !AreWhole(files)) return false;
    std::string found;
    try {
        const ExrImage image = ReadExr(files.exr);
        const auto at = image.attributes.find(kSettingsAttribute);
        if (at == image.attributes.end()) return false;  // it was interrupted
        if (const auto* text = std::get_if<std::string>(&at->second)) found = *text;
    } catch (const Error&) {
        return false;
    }
    const std::string wanted = SettingsOf(p);
    if (found == wanted) return true;
    throw Error(
        fmt::format("{}: was rendered with other settings ({} there, {} here); remove the "
                    "frames to render them again, or name others by -o",
                    files.exr, Printable(FirstDifference(found, wanted)),
                    Printable(FirstDifference(wanted, found))));
}

}  // namespace lull::render
