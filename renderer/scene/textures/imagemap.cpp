#include "renderer/scene/textures/imagemap.h"

#include <fmt/core.h>

#include "renderer/base/math.h"
#include "renderer/files/file_io.h"
#include "stopping/base/input_file.h"

namespace lull {

Rgb MeanTexel(const Image& image) {
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    std::visit(
        [&](const auto& texels) {
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x)
                    sum += TexelRgb(image, texels, x, y).template cast<double>();
        },
        image.texels);
    return (sum / (double(image.width) * image.height)).cast<float>();
}

void DecodeBytes(Image* image) {
    const auto* bytes = std::get_if<std::vector<uint8_t>>(&image->texels);
    if (!bytes) return;
    std::vector<float> linear(bytes->size());
    for (size_t i = 0; i < linear.size(); ++i) linear[i] = LinearFromSrgb(ToFloat((*bytes)[i]));
    image->texels = std::move(linear);
}

namespace {

// Returns whether a file of that name holds sRGB unless told otherwise. pbrt-v3 knows .png and
// .tga; the others it cannot read, and they are of the same nature.
bool IsEncodedByDefault(const std::string& filename) {
    const std::string extension = ExtensionOf(filename);
    for (const char* encoded : {".png", ".tga", ".jpg", ".jpeg", ".bmp", ".gif", ".webp"})
        if (extension == encoded) return true;
    return false;
}

// Returns the exponent of the file's texels: 1 where they are linear, kSrgb where they are sRGB.
float GetGamma(const TextureInput& input, const std::string& filename) {
    const Parameters& parameters = input.entity.parameters;
    const bool isEncoded = parameters.GetBool("gamma", IsEncodedByDefault(filename));
    const std::string encoding = parameters.GetString("encoding", "");
    const bool isPng = ExtensionOf(filename) == ".png";
    if (encoding.empty() || encoding == "sRGB" || !isPng) return isEncoded ? kSrgb : 1;
    if (encoding == "linear") return 1;
    float gamma = 0;
    if (encoding.starts_with("gamma ")) gamma = std::strtof(encoding.c_str() + 6, nullptr);
    if (!(gamma > 0) || !std::isfinite(gamma))
        throw Error(input.entity.loc,
                    "the encoding \"{}\" is unknown; sRGB, linear and gamma with a number are",
                    Printable(encoding));
    return gamma;
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

TextureChannels GetChannels(const TextureInput& input, bool isFloat) {
    if (!isFloat) return TextureChannels::Rgb;
    const std::string channel = input.entity.parameters.GetString("channel", "");
    if (channel == "red") return TextureChannels::Red;
    if (channel == "green") return TextureChannels::Green;
    if (channel == "blue") return TextureChannels::Blue;
    if (channel == "alpha") return TextureChannels::Alpha;
    if (channel == "mean or alpha") return TextureChannels::MeanOrAlpha;
    if (!channel.empty())
        input.warnings.Add(input.entity.loc, "unknown channel replaced by luminance",
                           Printable(channel));
    return TextureChannels::Luminance;
}

}  // namespace

template <typename T>
Made<T, ImageMap<T>> MakeImageMap(const TextureInput& input) {
    const TextureEntity& entity = input.entity;
    const Parameters& parameters = entity.parameters;
    const std::string filename = parameters.GetString("filename", "");
    const int embedded = parameters.GetInt("embeddedimage", -1);
    const float gamma = GetGamma(input, filename);
    const TextureChannels channels = GetChannels(input, std::is_same_v<T, float>);
    const Wrap wrap = GetWrap(input, "wrap");
    const Wrap wrapT = parameters.GetString("wrapt", "").empty() ? wrap : GetWrap(input, "wrapt");
    ImageMap<T> map{MakeMapping2D(input),
                    nullptr,
                    parameters.GetFloat("scale", 1),
                    wrap,
                    wrapT,
                    parameters.GetBool("invert", false)};
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
        const float grey = map.scale * (gamma == kSrgb ? LinearFromSrgb(0.5f) : 0.5f);
        return TextureHandle<T>{Filled<T>(grey)};
    }

    if (map.image->notFinite > 0)
        input.warnings.Add(
            entity.loc, "values of a texture that are not finite count as 0",
            fmt::format("{} of \"{}\"", map.image->notFinite, Printable(filename, 200)));
    if (map.image->uniform && map.wrap != Wrap::Black && map.wrapT != Wrap::Black) {
        const Rgb scaled = map.scale * *map.image->uniform;
        const Rgb color = map.inverts ? Inverted(scaled) : scaled;
        if constexpr (std::is_same_v<T, float>)
            return TextureHandle<T>{color.x()};
        else
            return TextureHandle<T>{color};
    }
    return map;
}

template Made<float, ImageMap<float>> MakeImageMap(const TextureInput&);
template Made<Rgb, ImageMap<Rgb>> MakeImageMap(const TextureInput&);

}  // namespace lull
