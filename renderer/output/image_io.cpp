#include "renderer/output/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <optional>

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

// Takes what OpenImageIO writes. What goes wrong there is kept, as no exception may pass through
// the libraries of the formats.
class FileProxy final : public OIIO::Filesystem::IOProxy {
  public:
    explicit FileProxy(const std::string& path)
        : OIIO::Filesystem::IOProxy(path, Write), file(path) {}
    const char* proxytype() const override { return "lull"; }
    size_t write(const void* from, size_t size) override {
        const size_t written = pwrite(from, size, m_pos);
        m_pos += int64_t(written);
        return written;
    }
    size_t pwrite(const void* from, size_t size, int64_t offset) override {
        try {
            if (!failure) file.WriteAt(offset, {static_cast<const std::byte*>(from), size});
        } catch (const Error& e) {
            failure = e;
        }
        end = std::max(end, offset + int64_t(size));
        return failure ? 0 : size;
    }
    size_t size() const override { return size_t(end); }

    AtomicFile file;
    std::optional<Error> failure;

  private:
    int64_t end = 0;
};

// Writes a file through `write(output)`. The path is for messages.
template <typename Write>
void WriteThrough(const std::string& path, const char* format, const OIIO::ImageSpec& spec,
                  OIIO::Filesystem::IOProxy* proxy, const Write& write) {
    auto output = OIIO::ImageOutput::create(format);
    if (!output) FailToWrite(path, OIIO::geterror());
    if (!output->set_ioproxy(proxy) || !output->open(path, spec) || !write(output.get()) ||
        !output->close())
        FailToWrite(path, output->geterror());
}

template <typename Write>
std::vector<std::byte> Encode(const std::string& path, const char* format,
                              const OIIO::ImageSpec& spec, const Write& write) {
    OIIO::Filesystem::IOVecOutput bytes;
    WriteThrough(path, format, spec, &bytes, write);
    const auto encoded = std::as_bytes(std::span(bytes.buffer()));
    return {encoded.begin(), encoded.end()};
}

template <typename Write>
void WriteFile(const std::string& path, const char* format, const OIIO::ImageSpec& spec,
               const Write& write) {
    FileProxy proxy(path);
    try {
        WriteThrough(path, format, spec, &proxy, write);
    } catch (const Error&) {
        if (!proxy.failure) throw;
    }
    if (proxy.failure) throw *proxy.failure;
    proxy.file.Commit();
}

// Writes rows a strip at a time; EXR compresses 16 rows together, and several such on all threads.
constexpr int kStrip = 64;

template <typename T, typename Fill>
bool WriteRows(OIIO::ImageOutput* output, OIIO::TypeDesc type, const Fill& fill) {
    const OIIO::ImageSpec& spec = output->spec();
    const size_t row = size_t(spec.width) * size_t(spec.nchannels);
    std::vector<T> strip(row * size_t(std::min(kStrip, spec.height)));
    for (int y = 0; y < spec.height; y += kStrip) {
        const int end = std::min(y + kStrip, spec.height);
        for (int k = y; k < end; ++k) fill(k, std::span(strip).subspan(row * size_t(k - y), row));
        if (!output->write_scanlines(spec.y + y, spec.y + end, spec.z, type, strip.data()))
            return false;
    }
    return true;
}

template <typename T>
OIIO::ImageSpec PngSpec(int width, int height,
                        const std::map<std::string, std::string>& text = {}) {
    OIIO::ImageSpec spec(width, height, 3, OIIO::BaseTypeFromC<T>::value);
    for (const auto& [name, value] : text) spec.attribute(name, value);
    spec.attribute("oiio:ColorSpace", "sRGB");
    return spec;
}

// Returns the component as an integer of all bits of T.
template <typename T>
T EncodeSrgb(float linear) {
    constexpr float most = std::numeric_limits<T>::max();
    const float v = most * SrgbFromLinear(std::max(0.f, linear)) + 0.5f;
    return T(std::min(v, most));
}

// Returns what writes linear RGB as a PNG.
template <typename T>
auto PngWriter(const RowSource& rows, ToneMap toneMap) {
    return [&rows, toneMap](OIIO::ImageOutput* output) {
        std::vector<float> linear(size_t(output->spec().width) * 3);
        return WriteRows<T>(output, output->spec().format, [&](int y, std::span<T> row) {
            rows(y, linear);
            if (toneMap == ToneMap::Filmic)
                std::ranges::transform(linear, linear.begin(), FilmicToneMap);
            std::ranges::transform(linear, row.begin(), EncodeSrgb<T>);
        });
    };
}

template <typename T>
void WritePng(const std::string& path, const RowSource& rows, int width, int height,
              const PngFormat& format) {
    WriteFile(path, "png", PngSpec<T>(width, height, format.text),
              PngWriter<T>(rows, format.toneMap));
}

auto PngWriter(std::span<const uint8_t> srgb) {
    return [srgb](OIIO::ImageOutput* output) {
        return output->write_image(OIIO::TypeDesc::UINT8, srgb.data());
    };
}

void CheckFits(const std::string& path, size_t values, int width, int height) {
    if (values != size_t(width) * size_t(height) * 3)
        FailToWrite(path, "the pixels do not fit the size");
}

RowSource RowsOf(std::span<const Rgb> pixels, int width) {
    return [=](int y, std::span<float> row) {
        for (size_t i = 0; i < row.size(); ++i)
            row[i] = pixels[size_t(y) * size_t(width) + i / 3][int(i % 3)];
    };
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
    for (const ExrChannel& c : image.channels)
        if (c.values.size() != pixels)
            FailToWrite(path, fmt::format("channel {} does not fit the size", c.name));
    WriteExr(path, image, [&](int y, std::span<float> row) {
        const size_t count = image.channels.size();
        for (size_t i = 0; i < row.size(); ++i)
            row[i] = image.channels[i % count].values[size_t(y) * size_t(image.width) + i / count];
    });
}

void WriteExr(const std::string& path, const ExrImage& image, const RowSource& rows) {
    OIIO::ImageSpec spec(image.width, image.height, int(image.channels.size()),
                         OIIO::TypeDesc::FLOAT);
    spec.x = image.origin.x();
    spec.y = image.origin.y();
    const bool hasDisplay = image.displaySize.x() > 0 && image.displaySize.y() > 0;
    spec.full_x = hasDisplay ? 0 : spec.x;
    spec.full_y = hasDisplay ? 0 : spec.y;
    spec.full_width = hasDisplay ? image.displaySize.x() : image.width;
    spec.full_height = hasDisplay ? image.displaySize.y() : image.height;
    spec.channelnames.clear();
    for (const ExrChannel& c : image.channels) {
        spec.channelnames.push_back(c.name);
        spec.channelformats.push_back(c.isHalf ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT);
    }
    spec.attribute("compression", "zip");
    for (const auto& [name, value] : image.attributes) SetAttribute(&spec, name, value);
    WriteFile(path, "openexr", spec, [&](OIIO::ImageOutput* output) {
        return WriteRows<float>(output, OIIO::TypeDesc::FLOAT, rows);
    });
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

uint8_t Encode8Bit(float linear) { return EncodeSrgb<uint8_t>(linear); }

std::vector<std::byte> EncodePng(std::span<const Rgb> pixels, int width, int height) {
    const char* name = "picture in memory";
    CheckFits(name, pixels.size() * 3, width, height);
    return Encode(name, "png", PngSpec<uint8_t>(width, height),
                  PngWriter<uint8_t>(RowsOf(pixels, width), ToneMap::None));
}

std::vector<std::byte> EncodePng(std::span<const uint8_t> srgb, int width, int height) {
    const char* name = "picture in memory";
    CheckFits(name, srgb.size(), width, height);
    OIIO::ImageSpec spec = PngSpec<uint8_t>(width, height);
    spec.attribute("png:compressionLevel", 9);
    spec.attribute("png:filter", 0xf8);  // libpng's PNG_ALL_FILTERS
    return Encode(name, "png", spec, PngWriter(srgb));
}

void WritePng(const std::string& path, std::span<const Rgb> pixels, int width, int height) {
    WritePng(path, pixels, width, height, PngFormat());
}

void WritePng(const std::string& path, std::span<const Rgb> pixels, int width, int height,
              const PngFormat& format) {
    CheckFits(path, pixels.size() * 3, width, height);
    WritePng(path, RowsOf(pixels, width), width, height, format);
}

void WritePng(const std::string& path, const RowSource& rows, int width, int height) {
    WritePng(path, rows, width, height, PngFormat());
}

void WritePng(const std::string& path, const RowSource& rows, int width, int height,
              const PngFormat& format) {
    if (format.bits == 16)
        WritePng<uint16_t>(path, rows, width, height, format);
    else
        WritePng<uint8_t>(path, rows, width, height, format);
}

void WritePng(const std::string& path, std::span<const uint8_t> srgb, int width, int height) {
    CheckFits(path, srgb.size(), width, height);
    WriteFile(path, "png", PngSpec<uint8_t>(width, height), PngWriter(srgb));
}

}  // namespace lull
