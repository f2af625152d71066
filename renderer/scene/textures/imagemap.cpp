#include "renderer/scene/textures/imagemap.h"

#include <fmt/core.h>

#include <filesystem>

#include "renderer/base/color.h"
#include "stopping/base/input_file.h"

namespace lull {

namespace {

// Returns whether a file of that name holds sRGB unless told otherwise. pbrt-v3 knows .png and
// .tga; the others it cannot read, and they are of the same nature.
bool IsEncodedByDefault(const std::string& filename) {
    std::string extension = std::filesystem::path(filename).extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    for (const char* encoded : {".png", ".tga", ".jpg", ".jpeg", ".bmp", ".gif", ".webp"})
        if (extension == encoded) return true;
    return false;
}

Wrap GetWrap(const TextureInput& input, const char* parameter) {
    const std::string wrap = input.entity.parameters.GetString(parameter, "repeat");
    if (wrap == "black") return Wrap::Black;
    if (wrap == "clamp") return Wrap::Clamp;
    if (wrap == "mirrored") return Wrap::Mirror;
    if (wrap != "repeat")
        input.warnings.Add(input.entity.loc, "unknown wrap mode replaced by repeat",
                           Printable(wrap));
    return Wrap::Repeat;
}

// Reads which channels the texture is made of.
TextureChannels GetChannels(const TextureInput& input, bool isFloat) {
    if (!isFloat) return TextureChannels::Rgb;
    const std::string channel = input.entity.parameters.GetString("channel", "");
    if (channel == "red") return TextureChannels::Red;
    if (channel == "green") return TextureChannels::Green;
    if (channel == "blue") return TextureChannels::Blue;
    if (channel == "alpha") return TextureChannels::Alpha;
    if (!channel.empty())
        input.warnings.Add(input.entity.loc, "unknown channel replaced by luminance",
                           Printable(channel));
    return TextureChannels::Luminance;
}

template <typename T>
T FromRgb(const Rgb& c) {
    if constexpr (std::is_same_v<T, float>)
        return c.x();
    else
        return c;
}

}  // namespace

template <typename T>
Made<T, ImageMap<T>> MakeImageMap(const TextureInput& input) {
    const TextureEntity& entity = input.entity;
    const Parameters& parameters = entity.parameters;
    const std::string filename = parameters.GetString("filename", "");
    const int embedded = parameters.GetInt("embeddedimage", -1);
    const bool gamma = parameters.GetBool("gamma", IsEncodedByDefault(filename));
    const TextureChannels channels = GetChannels(input, std::is_same_v<T, float>);
    const Wrap wrap = GetWrap(input, "wrap");
    const Wrap wrapT = parameters.GetString("wrapt", "").empty() ? wrap : GetWrap(input, "wrapt");
    ImageMap<T> map{MakeMapping2D(input), nullptr, parameters.GetFloat("scale", 1), wrap, wrapT};
    parameters.GetBool("trilinear", false);  // known, without effect
    parameters.GetFloat("maxanisotropy", 8);

    try {
        const std::vector<EmbeddedImage>& images = input.description.images;
        if (embedded >= 0 && size_t(embedded) < images.size()) {
            map.image = input.images.Get(images[size_t(embedded)], gamma, channels);
        } else {
            if (filename.empty()) throw Error("imagemap without \"string filename\"");
            map.image = input.images.Get(ResolvePath(input.description, filename), gamma, channels);
        }
    } catch (const Error& error) {
        const std::string what =
            fmt::format("texture \"{}\": {}", Printable(entity.textureName), error.what());
        input.warnings.Substitute(entity.loc, what, "grey stands in");
        const float grey = map.scale * (gamma ? LinearFromSrgb(0.5f) : 0.5f);
        return ConstantTexture<T>(grey);
    }

    if (map.image->notFinite > 0)
        input.warnings.Add(
            entity.loc, "values of a texture that are not finite count as 0",
            fmt::format("{} of \"{}\"", map.image->notFinite, Printable(filename, 200)));
    if (map.image->uniform && map.wrap != Wrap::Black && map.wrapT != Wrap::Black)
        return TextureHandle<T>{FromRgb<T>(map.scale * *map.image->uniform)};
    return map;
}

template Made<float, ImageMap<float>> MakeImageMap(const TextureInput&);
template Made<Rgb, ImageMap<Rgb>> MakeImageMap(const TextureInput&);

}  // namespace lull
