#include "renderer/scene/textures/texture_image.h"

#include <algorithm>
#include <set>

#include "renderer/base/math.h"
#include "renderer/image/image_io.h"

namespace lull {

namespace {

// Returns the value of a stored one before any linearisation.
float Encoded(uint8_t v) { return float(v) / 255; }
float Encoded(Half v) { return float(v); }
float Encoded(float v) { return v; }

template <typename T>
bool AllGrey(const std::vector<T>& texels, int channels) {
    for (size_t i = 0; i < texels.size(); i += size_t(channels))
        if (!(texels[i] == texels[i + 1] && texels[i] == texels[i + 2])) return false;
    return true;
}

template <typename Out, int Count, typename T, typename Convert>
Texels<Out, Count> Flip(const Image& image, const std::vector<T>& texels, const Convert& convert) {
    Texels<Out, Count> out;
    out.values.resize(size_t(image.width) * size_t(image.height) * Count);
    Out* to = out.values.data();
    for (int y = image.height - 1; y >= 0; --y) {
        const T* from = texels.data() + size_t(y) * size_t(image.width) * size_t(image.channels);
        for (int x = 0; x < image.width; ++x, from += image.channels, to += Count)
            convert(from, to);
    }
    return out;
}

template <typename T, int Count>
std::optional<Rgb> FindUniform(const Texels<T, Count>& texels,
                               const std::array<float, 256>& decode) {
    const auto& v = texels.values;
    for (size_t i = Count; i < v.size(); ++i)
        if (!(v[i] == v[i - Count])) return std::nullopt;
    const auto value = [&](int c) {
        if constexpr (std::is_same_v<T, uint8_t>)
            return decode[v[size_t(c)]];
        else
            return float(v[size_t(c)]);
    };
    return Rgb(value(0), value(Count > 1 ? 1 : 0), value(Count > 1 ? 2 : 0));
}

// Sets values that are not finite to 0, as filters would spread them. Returns how many.
size_t ReplaceNonFinite(TextureImage* image) {
    size_t count = 0;
    std::visit(
        [&](auto& texels) {
            for (auto& v : texels.values) {
                if (std::isfinite(float(v))) continue;
                v = std::decay_t<decltype(v)>();
                ++count;
            }
        },
        image->texels);
    return count;
}

Image ExtractChannel(const Image& image, TextureChannels wanted) {
    const bool hasColor = image.channels >= 3, hasAlpha = image.channels % 2 == 0;
    const bool wantsAlpha =
        wanted == TextureChannels::Alpha || wanted == TextureChannels::MeanOrAlpha;
    const int channel = wantsAlpha                         ? image.channels - 1
                        : !hasColor                        ? 0
                        : wanted == TextureChannels::Red   ? 0
                        : wanted == TextureChannels::Green ? 1
                                                           : 2;
    Image grey{image.width, image.height, 1, {}};
    if (wantsAlpha && !hasAlpha) {
        grey.texels =
            std::vector<uint8_t>(size_t(image.width) * size_t(image.height), uint8_t(255));
        return grey;
    }
    std::visit(
        [&](const auto& texels) {
            std::decay_t<decltype(texels)> one;
            one.reserve(texels.size() / size_t(image.channels));
            for (size_t i = size_t(channel); i < texels.size(); i += size_t(image.channels))
                one.push_back(texels[i]);
            grey.texels = std::move(one);
        },
        image.texels);
    return grey;
}

bool HasAlpha(const Image& image) {
    if (image.channels % 2 != 0) return false;
    return std::visit(
        [&](const auto& texels) {
            for (size_t i = size_t(image.channels) - 1; i < texels.size();
                 i += size_t(image.channels))
                if (Encoded(texels[i]) != 1) return true;
            return false;
        },
        image.texels);
}

template <typename Linear>
Image MeanOf(const Image& image, const Linear& linear) {
    std::vector<float> means;
    std::visit(
        [&](const auto& texels) {
            const size_t stride = size_t(image.channels), colors = stride < 3 ? 1 : 3;
            means.reserve(texels.size() / stride);
            for (size_t i = 0; i < texels.size(); i += stride) {
                float sum = 0;
                for (size_t c = 0; c < colors; ++c) sum += linear(Encoded(texels[i + c]));
                means.push_back(sum / float(colors));
            }
        },
        image.texels);
    return {image.width, image.height, 1, std::move(means)};
}

}  // namespace

size_t TextureImage::Bytes() const {
    return std::visit([](const auto& t) { return t.values.size() * sizeof(t.values[0]); }, texels);
}

bool TextureImage::IsGrey() const {
    return std::visit([](const auto& t) { return t.kChannels == 1; }, texels);
}

TextureImage MakeTextureImage(const Image& image, float gamma, TextureChannels wanted) {
    const auto linear = [gamma](float v) {
        if (gamma == 1) return v;
        return gamma == kSrgb ? LinearFromSrgb(v) : std::pow(std::max(v, 0.f), gamma);
    };
    if (wanted == TextureChannels::MeanOrAlpha && !HasAlpha(image))
        return MakeTextureImage(MeanOf(image, linear), 1, TextureChannels::Luminance);
    if (wanted > TextureChannels::Luminance) {
        const bool isAlpha = wanted == TextureChannels::Alpha;
        return MakeTextureImage(ExtractChannel(image, wanted), isAlpha ? 1 : gamma,
                                TextureChannels::Luminance);
    }
    const bool luminance = wanted == TextureChannels::Luminance;
    TextureImage result;
    result.width = image.width;
    result.height = image.height;
    for (int i = 0; i < 256; ++i) result.decode[size_t(i)] = linear(Encoded(uint8_t(i)));

    const auto convert = [&](const auto& texels) {
        using T = typename std::decay_t<decltype(texels)>::value_type;
        const bool keep = std::is_same_v<T, uint8_t> || gamma == 1;
        if (image.channels < 3 || AllGrey(texels, image.channels)) {
            if (keep)
                result.texels =
                    Flip<T, 1>(image, texels, [](const T* from, T* to) { *to = *from; });
            else
                result.texels = Flip<float, 1>(
                    image, texels, [&](const T* from, float* to) { *to = linear(Encoded(*from)); });
        } else if (luminance) {
            result.texels = Flip<float, 1>(image, texels, [&](const T* from, float* to) {
                *to = linear(Luminance(Rgb(Encoded(from[0]), Encoded(from[1]), Encoded(from[2]))));
            });
        } else if (keep) {
            result.texels =
                Flip<T, 3>(image, texels, [](const T* from, T* to) { std::copy_n(from, 3, to); });
        } else {
            result.texels = Flip<float, 3>(image, texels, [&](const T* from, float* to) {
                for (int c = 0; c < 3; ++c) to[c] = linear(Encoded(from[c]));
            });
        }
    };
    std::visit(convert, image.texels);
    if (!std::holds_alternative<std::vector<uint8_t>>(image.texels))
        result.notFinite = ReplaceNonFinite(&result);
    result.uniform =
        std::visit([&](const auto& t) { return FindUniform(t, result.decode); }, result.texels);
    return result;
}

template <typename Read>
std::shared_ptr<const TextureImage> TextureImages::Find(const std::string& name, float gamma,
                                                        TextureChannels channels,
                                                        const Read& read) {
    const auto found = images.find({name, gamma, channels});
    if (found != images.end()) return found->second;
    if (lastName != name) {
        last = read();
        lastName = name;
    }
    auto image = std::make_shared<const TextureImage>(MakeTextureImage(last, gamma, channels));
    images[{name, gamma, channels}] = image;
    // A grey file serves float and spectrum textures alike.
    if (channels == TextureChannels::Rgb && image->IsGrey())
        images[{name, gamma, TextureChannels::Luminance}] = image;
    return image;
}

std::shared_ptr<const TextureImage> TextureImages::Get(const std::string& path, float gamma,
                                                       TextureChannels channels) {
    return Find(path, gamma, channels, [&] { return ReadImage(path); });
}

std::shared_ptr<const TextureImage> TextureImages::Get(const EmbeddedImage& image, float gamma,
                                                       TextureChannels channels) {
    return Find(image.name, gamma, channels,
                [&] { return ReadImage(image.name, image.type, image.bytes); });
}

size_t TextureImages::Bytes() const {
    size_t bytes = 0;
    std::set<const TextureImage*> counted;
    for (const auto& [key, image] : images)
        if (counted.insert(image.get()).second) bytes += image->Bytes();
    return bytes;
}

}  // namespace lull
