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

namespace lull {

template <typename T, int Count>
struct Texels {
    static constexpr int kChannels = Count;
    std::vector<T> values;  // rows from the bottom, channels interleaved
};

// An image ready for look-ups. The first row is the lowest, since texture space has (0, 0) at
// the lower left. pbrt-v3 resamples images to powers of two first; here they keep their size and
// the type of their texels: 8-bit ones are decoded by a table, halves by the processor. Only half
// and float texels that have to be linearised are converted beforehand.
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
// never linearised.
enum class TextureChannels { Rgb, Luminance, Red, Green, Blue, Alpha };

// Makes a TextureImage of an image as it was read. `gamma` says that texels are sRGB-encoded.
TextureImage MakeTextureImage(const Image& image, bool gamma, TextureChannels channels);

// Shares images between textures.
class TextureImages {
  public:
    // Read the image unless it has been read already. Throw Error as ReadImage does.
    std::shared_ptr<const TextureImage> Get(const std::string& path, bool gamma,
                                            TextureChannels channels);
    std::shared_ptr<const TextureImage> Get(const EmbeddedImage& image, bool gamma,
                                            TextureChannels channels);

    // Returns the memory taken by images.
    size_t Bytes() const;

  private:
    template <typename Read>
    std::shared_ptr<const TextureImage> Find(const std::string& name, bool gamma,
                                             TextureChannels channels, const Read& read);

    std::map<std::tuple<std::string, bool, TextureChannels>, std::shared_ptr<const TextureImage>>
        images;
    // The last one read, as other channels of it are often asked for next.
    std::string lastName;
    Image last;
};

}  // namespace lull
