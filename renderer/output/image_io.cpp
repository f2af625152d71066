#include "renderer/output/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>

#include <filesystem>

#include "renderer/base/color.h"
#include "renderer/base/error.h"
#include "renderer/base/memory.h"
#include "renderer/output/file_io.h"
#include "renderer/output/png_format.h"

namespace lull {

namespace {

constexpr int kMaxSide = 1 << 16;
// No format here packs texels tighter than this on average; deflate ends near 1000 to 1.
constexpr size_t kMaxCompression = 4000;
constexpr size_t kAlwaysAllowed = size_t(64) << 20;

[[noreturn]] void FailToRead(const std::string& path, const std::string& reason) {
    throw Error(fmt::format("cannot read image \"{}\": {}", path, reason));
}

// Opens with alpha left unassociated, so that 8-bit texels come back bit for bit.
std::unique_ptr<OIIO::ImageInput> Open(const std::string& path) {
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) FailToRead(path, "no such file");
    if (std::filesystem::is_directory(status)) FailToRead(path, "it is a directory");
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    auto input = OIIO::ImageInput::open(path, &config);
    if (!input) FailToRead(path, OIIO::geterror());
    return input;
}

// Refuses what no honest file holds before any memory is taken for it.
void CheckSize(const std::string& path, size_t fileSize, const OIIO::ImageSpec& spec,
               int channels) {
    if (spec.deep) FailToRead(path, "deep images are not modelled");
    if (spec.depth > 1) FailToRead(path, "volumes are not modelled");
    const std::string size = fmt::format("{}x{}x{}", spec.width, spec.height, channels);
    if (spec.width < 1 || spec.height < 1 || channels < 1 || spec.width > kMaxSide ||
        spec.height > kMaxSide)
        FailToRead(path, "its size of " + size + " is absurd");
    const size_t bytes =
        size_t(spec.width) * size_t(spec.height) * size_t(channels) * spec.format.size();
    if (bytes > kAlwaysAllowed && bytes / kMaxCompression > fileSize)
        FailToRead(path, "it is too short for its size of " + size);
    // As read, and once more as a texture keeps it.
    CheckMemory(int64_t(2 * bytes), fmt::format("image \"{}\" of {}", path, size),
                "use a smaller version of it");
}

void CheckSize(const std::string& path, const OIIO::ImageSpec& spec, int channels) {
    std::error_code error;
    const auto fileSize = std::filesystem::file_size(path, error);
    CheckSize(path, error ? std::numeric_limits<size_t>::max() : size_t(fileSize), spec, channels);
}

int CountChannels(const OIIO::ImageSpec& spec) {
    if (spec.nchannels < 4) return spec.nchannels;
    return spec.alpha_channel == 3 ? 4 : 3;
}

[[noreturn]] void FailToWrite(const std::string& path, const std::string& reason) {
    throw Error(fmt::format("cannot write \"{}\": {}", path, reason));
}

template <typename T>
std::vector<T> ReadTexels(const std::string& path, OIIO::ImageInput* input,
                          const OIIO::ImageSpec& spec, int channels, OIIO::TypeDesc type) {
    std::vector<T> texels(size_t(spec.width) * size_t(spec.height) * size_t(channels));
    if (!input->read_image(0, 0, 0, channels, type, texels.data()))
        FailToRead(path, input->geterror());
    return texels;
}

// Reads an image whose size has been checked.
Image ReadTexels(const std::string& path, OIIO::ImageInput* input, int channels) {
    const OIIO::ImageSpec& spec = input->spec();
    Image image{spec.width, spec.height, channels, {}};
    if (spec.format == OIIO::TypeDesc::UINT8)
        image.texels = ReadTexels<uint8_t>(path, input, spec, channels, OIIO::TypeDesc::UINT8);
    else if (spec.format == OIIO::TypeDesc::HALF)
        image.texels = ReadTexels<Half>(path, input, spec, channels, OIIO::TypeDesc::HALF);
    else
        image.texels = ReadTexels<float>(path, input, spec, channels, OIIO::TypeDesc::FLOAT);
    return image;
}

// Encodes in memory, so that every error of the disk meets the one place that handles them. The
// path is for messages.
template <typename Write>
std::vector<std::byte> Encode(const std::string& path, const char* format,
                              const OIIO::ImageSpec& spec, const Write& write) {
    OIIO::Filesystem::IOVecOutput bytes;
    auto output = OIIO::ImageOutput::create(format);
    if (!output) FailToWrite(path, OIIO::geterror());
    if (!output->set_ioproxy(&bytes) || !output->open(path, spec) || !write(output.get()) ||
        !output->close())
        FailToWrite(path, output->geterror());
    output.reset();
    const auto encoded = std::as_bytes(std::span(bytes.buffer()));
    return {encoded.begin(), encoded.end()};
}

// Returns the component as an integer of all bits of T.
template <typename T>
T EncodeSrgb(float linear) {
    constexpr float most = std::numeric_limits<T>::max();
    const float v = most * SrgbFromLinear(std::max(0.f, linear)) + 0.5f;
    return T(std::min(v, most));
}

template <typename T>
std::vector<std::byte> EncodePng(const std::string& path, OIIO::ImageSpec spec,
                                 std::span<const T> components) {
    if (components.size() != size_t(spec.width) * size_t(spec.height) * 3)
        FailToWrite(path, "the pixels do not fit the size");
    spec.attribute("oiio:ColorSpace", "sRGB");
    return Encode(path, "png", spec, [&](OIIO::ImageOutput* output) {
        return output->write_image(spec.format, components.data());
    });
}

template <typename T>
std::vector<std::byte> EncodePng(const std::string& path, std::span<const Rgb> pixels, int width,
                                 int height, const PngFormat& format) {
    std::vector<T> components;
    components.reserve(pixels.size() * 3);
    for (const Rgb& p : pixels)
        for (const float c : p)
            components.push_back(
                EncodeSrgb<T>(format.toneMap == ToneMap::Filmic ? FilmicToneMap(c) : c));
    OIIO::ImageSpec spec(width, height, 3, OIIO::BaseTypeFromC<T>::value);
    for (const auto& [name, value] : format.text) spec.attribute(name, value);
    return EncodePng<T>(path, spec, components);
}

void SetAttribute(OIIO::ImageSpec* spec, const std::string& name, const ExrAttribute& value) {
    if (const auto* s = std::get_if<std::string>(&value)) {
        spec->attribute(name, *s);
    } else if (const auto* i = std::get_if<int>(&value)) {
        spec->attribute(name, *i);
    } else if (const auto* f = std::get_if<float>(&value)) {
        spec->attribute(name, *f);
    } else {
        const Eigen::Matrix<float, 4, 4, Eigen::RowMajor> m = std::get<Mat4d>(value).cast<float>();
        spec->attribute(name, OIIO::TypeMatrix, m.data());
    }
}

std::map<std::string, ExrAttribute> GetAttributes(const OIIO::ImageSpec& spec) {
    std::map<std::string, ExrAttribute> attributes;
    for (const auto& a : spec.extra_attribs) {
        const std::string name = a.name().string();
        if (a.type() == OIIO::TypeString) {
            attributes[name] = a.get_string();
        } else if (a.type() == OIIO::TypeInt) {
            attributes[name] = a.get_int();
        } else if (a.type() == OIIO::TypeFloat) {
            attributes[name] = a.get_float();
        } else if (a.type() == OIIO::TypeMatrix) {
            using RowMajor = Eigen::Matrix<float, 4, 4, Eigen::RowMajor>;
            const Mat4d m =
                Eigen::Map<const RowMajor>(static_cast<const float*>(a.data())).cast<double>();
            attributes[name] = m;
        }
    }
    return attributes;
}

}  // namespace

Image ReadImage(const std::string& path) {
    const auto input = Open(path);
    const int channels = CountChannels(input->spec());
    CheckSize(path, input->spec(), channels);
    return ReadTexels(path, input.get(), channels);
}

Image ReadImage(const std::string& name, const std::string& type,
                std::span<const std::byte> bytes) {
    OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
    OIIO::Filesystem::IOProxy* proxy = &memory;
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto input = OIIO::ImageInput::open("memory." + type, &config);
    if (!input) FailToRead(name, OIIO::geterror());
    const int channels = CountChannels(input->spec());
    CheckSize(name, bytes.size(), input->spec(), channels);
    return ReadTexels(name, input.get(), channels);
}

const ExrChannel* ExrImage::Find(const std::string& name) const {
    for (const ExrChannel& c : channels)
        if (c.name == name) return &c;
    return nullptr;
}

void WriteExr(const std::string& path, const ExrImage& image) {
    const size_t pixels = size_t(image.width) * size_t(image.height);
    const size_t count = image.channels.size();
    OIIO::ImageSpec spec(image.width, image.height, int(count), OIIO::TypeDesc::FLOAT);
    spec.x = image.origin.x();
    spec.y = image.origin.y();
    const bool hasDisplay = image.displaySize.x() > 0 && image.displaySize.y() > 0;
    spec.full_x = hasDisplay ? 0 : spec.x;
    spec.full_y = hasDisplay ? 0 : spec.y;
    spec.full_width = hasDisplay ? image.displaySize.x() : image.width;
    spec.full_height = hasDisplay ? image.displaySize.y() : image.height;
    spec.channelnames.clear();
    for (const ExrChannel& c : image.channels) {
        if (c.values.size() != pixels)
            FailToWrite(path, fmt::format("channel {} does not fit the size", c.name));
        spec.channelnames.push_back(c.name);
        spec.channelformats.push_back(c.isHalf ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
    }
    spec.attribute("compression", "zip");
    for (const auto& [name, value] : image.attributes) SetAttribute(&spec, name, value);

    std::vector<float> interleaved(pixels * count);
    for (size_t c = 0; c < count; ++c)
        for (size_t i = 0; i < pixels; ++i)
            interleaved[i * count + c] = image.channels[c].values[i];
    WriteFileAtomically(path, Encode(path, "openexr", spec, [&](OIIO::ImageOutput* output) {
                            return output->write_image(OIIO::TypeDesc::FLOAT, interleaved.data());
                        }));
}

ExrImage ReadExr(const std::string& path) {
    const auto input = Open(path);
    const OIIO::ImageSpec& spec = input->spec();
    CheckSize(path, spec, spec.nchannels);
    const std::vector<float> interleaved =
        ReadTexels<float>(path, input.get(), spec, spec.nchannels, OIIO::TypeDesc::FLOAT);

    ExrImage image;
    image.width = spec.width;
    image.height = spec.height;
    image.origin = {spec.x - spec.full_x, spec.y - spec.full_y};
    image.displaySize = {spec.full_width, spec.full_height};
    image.attributes = GetAttributes(spec);
    const size_t count = size_t(spec.nchannels);
    for (size_t c = 0; c < count; ++c) {
        ExrChannel& channel = image.channels.emplace_back();
        channel.name = spec.channelnames[c];
        channel.isHalf = spec.channelformat(int(c)) == OIIO::TypeDesc::HALF;
        channel.values.resize(interleaved.size() / count);
        for (size_t i = 0; i < channel.values.size(); ++i)
            channel.values[i] = interleaved[i * count + c];
    }
    return image;
}

std::vector<std::byte> EncodePng(std::span<const Rgb> pixels, int width, int height) {
    return EncodePng<uint8_t>("picture in memory", pixels, width, height, {});
}

std::vector<std::byte> EncodePng(std::span<const uint8_t> srgb, int width, int height) {
    OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
    spec.attribute("png:compressionLevel", 9);
    spec.attribute("png:filter", 0xf8);  // libpng's PNG_ALL_FILTERS
    return EncodePng<uint8_t>("picture in memory", spec, srgb);
}

void WritePng(const std::string& path, std::span<const Rgb> pixels, int width, int height) {
    WritePng(path, pixels, width, height, {});
}

void WritePng(const std::string& path, std::span<const Rgb> pixels, int width, int height,
              const PngFormat& format) {
    WriteFileAtomically(path, format.bits == 16
                                  ? EncodePng<uint16_t>(path, pixels, width, height, format)
                                  : EncodePng<uint8_t>(path, pixels, width, height, format));
}

}  // namespace lull
