// The images of imagemap textures, shared by all textures that read the same file.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "renderer/image/image.h"
#include "renderer/input/description.h"
#include "renderer/scene/textures/texture.h"

namespace lull {

template <typename T, int Count>
struct Texels {
    static constexpr int kChannels = Count;
    std::vector<T> values;  // rows from the bottom, channels interleaved
};

// An image ready for look-ups. The first row is the lowest, since texture space has (0, 0) at the
// lower left. pbrt-v3 resamples images to powers of two first; here they keep their size and the
// type of their texels: 8-bit ones are decoded by a table, halves by the processor.
struct TextureImage {
    int width = 0, height = 0;
    std::variant<Texels<uint8_t, 1>, Texels<uint8_t, 3>, Texels<Half, 1>, Texels<Half, 3>,
                 Texels<float, 1>, Texels<float, 3>>
        texels;
    std::array<float, 256> decode{};  // 8-bit texel to linear
    std::optional<Rgb> uniform;       // the value of all texels, if they are equal
    size_t notFinite = 0;             // values that were not; they are 0

    size_t Bytes() const;
    bool IsGrey() const;
};

// Channels to keep of an image. Luminance asks for one channel: grey images as they are, others by
// their luminance; as in pbrt-v3 that is the luminance of the *encoded* colours, linearised
// afterwards. A single channel of a grey image is its grey; Alpha is 1 if there is none, and is
// never linearised. MeanOrAlpha is pbrt-v4's number of an image: its alpha if that is not 1 all
// over, else the mean of its colours, linearised.
enum class TextureChannels { Rgb, Luminance, Red, Green, Blue, Alpha, MeanOrAlpha };

// The exponent that says that texels are sRGB-encoded.
inline constexpr float kSrgb = 0;

// Makes a TextureImage of an image as read, whose texels are to be raised to `gamma`, or kSrgb.
TextureImage MakeTextureImage(const Image& image, float gamma, TextureChannels channels);

// Shares images between textures.
class TextureImages {
  public:
    // Read the image unless it has been read already. Throw Error as ReadImage does.
    std::shared_ptr<const TextureImage> Get(const std::string& path, float gamma,
                                            TextureChannels channels);
    std::shared_ptr<const TextureImage> Get(const EmbeddedImage& image, float gamma,
                                            TextureChannels channels);

    size_t Bytes() const;

  private:
    template <typename Read>
    std::shared_ptr<const TextureImage> Find(const std::string& name, float gamma,
                                             TextureChannels channels, const Read& read);

    std::map<std::tuple<std::string, float, TextureChannels>, std::shared_ptr<const TextureImage>>
        images;
    // The last one read, as other channels of it are often asked for next.
    std::string lastName;
    Image last;
};

// Inputs of the functions that read textures.
struct TextureInput {
    const TextureEntity& entity;
    const Description& description;
    const TextureTable& table;  // holds all textures before this one
    TextureImages& images;
    Warnings& warnings;
};

// The result of a maker: a new texture, or the handle of an equivalent texture or constant.
template <typename T, typename Kind>
using Made = std::variant<TextureHandle<T>, Kind>;

// Reads a texture parameter of type T, float or Rgb.
template <typename T>
TextureHandle<T> GetTexture(const TextureInput& input, const std::string& name, float otherwise) {
    if constexpr (std::is_same_v<T, float>)
        return input.table.GetFloat(input.entity, name, otherwise);
    else
        return input.table.GetSpectrum(input.entity, name, Rgb::Constant(otherwise));
}

// Reads a parameter that is a constant of type T.
template <typename T>
T GetValue(const TextureInput& input, const std::string& name, float otherwise) {
    if constexpr (std::is_same_v<T, float>)
        return input.entity.parameters.GetFloat(name, otherwise);
    else
        return input.entity.parameters.GetSpectrum(name, Rgb::Constant(otherwise));
}

// Returns the number, or the colour whose components it is.
template <typename T>
T Filled(float value) {
    if constexpr (std::is_same_v<T, float>)
        return value;
    else
        return Rgb::Constant(value);
}

// Compare constants of either type.
inline bool AllEqual(float a, float b) { return a == b; }
inline bool AllEqual(const Rgb& a, const Rgb& b) { return (a == b).all(); }
template <typename T>
bool IsConstant(const TextureHandle<T>& t, float value) {
    return t.IsConstant() && AllEqual(t.constant, Filled<T>(value));
}

}  // namespace lull
