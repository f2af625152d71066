// The module of all formats but PNG and OpenEXR: OpenImageIO reads them. It is apart since
// OpenImageIO brings some 200 libraries, which take longer to load than many a render.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/formats/formats.h"

namespace {

using lull::ImageShape, lull::TexelType;

// Of some formats the library fails without a word.
std::runtime_error FailureOf(const OIIO::ImageInput& input) {
    const std::string reason = input.geterror();
    return std::runtime_error(reason.empty() ? "it is cut short or damaged" : reason);
}

std::vector<char> ReadBytes(const char* path, size_t most) {
    std::ifstream in(path, std::ios::binary | std::ios::ate);
    std::vector<char> bytes(std::min(most, size_t(std::max<std::streamoff>(in.tellg(), 0))));
    in.seekg(0).read(bytes.data(), std::streamsize(bytes.size()));
    return bytes;
}

// Makes a WebP claim that it has no alpha, so that its colours are decoded as they are: of files
// with alpha, OpenImageIO multiplies them by it, whatever it is asked for.
void HideAlpha(std::vector<char>* webp) {
    constexpr size_t kFileHeader = 12, kChunkHeader = 8;
    constexpr char kAlphaFlag = 0x10;  // of the container, and of lossless data
    for (size_t at = kFileHeader; at + kChunkHeader < webp->size();) {
        char* const chunk = webp->data() + at;
        const std::string_view name(chunk, 4);
        uint32_t size;
        std::memcpy(&size, chunk + 4, sizeof(size));
        char* const data = chunk + kChunkHeader;
        const size_t left = webp->size() - at - kChunkHeader;
        if (name == "VP8X" && left > 0) data[0] = char(data[0] & ~kAlphaFlag);
        if (name == "VP8L" && left > 4) data[4] = char(data[4] & ~kAlphaFlag);
        if (name == "ALPH") std::memcpy(chunk, "none", 4);
        at += kChunkHeader + std::min<size_t>(left, size + (size & 1));
    }
}

std::vector<uint8_t> ReadColors(std::vector<char> bytes, int width, int height) {
    OIIO::Filesystem::IOMemReader memory(bytes.data(), bytes.size());
    OIIO::Filesystem::IOProxy* proxy = &memory;
    OIIO::ImageSpec config;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    const auto input = OIIO::ImageInput::open("memory.webp", &config);
    if (!input) throw std::runtime_error(OIIO::geterror());
    std::vector<uint8_t> colors(size_t(width) * size_t(height) * 3);
    if (input->spec().width != width || input->spec().height != height ||
        !input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, colors.data()))
        throw FailureOf(*input);
    return colors;
}

// Fields of a Radiance picture's header that OpenImageIO ignores or misreads.
struct RadianceHeader {
    float scale[3] = {1, 1, 1};  // of the colours, which have been exposed and corrected
    float gamma = 1;             // then they were raised to 1 / gamma
    // Rows of the file are columns; its rows come from the bottom or the right, its columns too.
    bool turns = false, flipsRows = false, flipsColumns = false;
    std::array<float, 8> chromaticities{};
    bool isRec709 = true;  // else the chromaticities are given

    explicit RadianceHeader(std::string_view text) {
        for (size_t end; (end = text.find('\n')) != text.npos; text.remove_prefix(end + 1)) {
            if (end == 0) {
                ReadOrder(std::string(text.substr(1, 80)));
                return;
            }
            ReadLine(std::string(text.substr(0, end)));
        }
    }
    bool IsPlain() const {
        return !turns && !flipsRows && !flipsColumns && scale[0] == 1 && scale[1] == 1 &&
               scale[2] == 1 && gamma == 1;
    }

  private:
    void ReadLine(const std::string& line) {
        float by[3];
        if (line.find("32-bit_rle_xyze") != line.npos)
            throw std::runtime_error("its colours are X, Y and Z; convert it to RGBE");
        if (std::sscanf(line.c_str(), "EXPOSURE=%f", by) == 1)
            Divide(by[0], by[0], by[0]);
        else if (std::sscanf(line.c_str(), "COLORCORR=%f %f %f", by, by + 1, by + 2) == 3)
            Divide(by[0], by[1], by[2]);
        else if (std::sscanf(line.c_str(), "GAMMA=%f", by) == 1)
            gamma = by[0] > 0 ? by[0] : 1;
        else
            ReadChromaticities(line);
    }
    void ReadChromaticities(const std::string& line) {
        // Radiance's own differ by less from those that its pictures are shown with anywhere.
        constexpr float kSlack = 0.025f;
        constexpr float kRec709[] = {.64f, .33f, .3f, .6f, .15f, .06f, .3127f, .329f};
        auto& c = chromaticities;
        if (std::sscanf(line.c_str(), "PRIMARIES=%f %f %f %f %f %f %f %f", &c[0], &c[1], &c[2],
                        &c[3], &c[4], &c[5], &c[6], &c[7]) != 8)
            return;
        isRec709 = true;
        for (size_t i = 0; i < 8; ++i) isRec709 &= std::abs(c[i] - kRec709[i]) <= kSlack;
    }
    void Divide(float r, float g, float b) {
        if (!(r > 0 && g > 0 && b > 0)) return;
        scale[0] /= r, scale[1] /= g, scale[2] /= b;
    }
    // y grows upwards: "-Y 3 +X 2" is the usual order.
    void ReadOrder(const std::string& size) {
        char rowSign, row, columnSign, column;
        int n;
        if (std::sscanf(size.c_str(), "%c%c %d %c%c", &rowSign, &row, &n, &columnSign, &column) !=
            5)
            return;
        turns = row == 'X';
        flipsRows = (rowSign == '-') == turns;
        flipsColumns = (columnSign == '-') != turns;
    }
};

// Returns whether a TIFF leaves out its bits a pixel: it is one, OpenImageIO takes eight.
bool LacksBitsPerSample(std::string_view tiff) {
    constexpr unsigned kBitsPerSample = 258;
    const bool isBig = tiff.starts_with("MM");
    const auto number = [&](size_t at, size_t bytes) {
        size_t value = 0;
        for (size_t i = 0; i < bytes; ++i)
            value = value << 8 | uint8_t(tiff[at + (isBig ? i : bytes - 1 - i)]);
        return value;
    };
    if (tiff.size() < 8 || number(2, 2) != 42) return false;
    const size_t tags = number(4, 4);
    if (tags + 2 > tiff.size()) return false;
    const size_t count = number(tags, 2);
    if (tags + 2 + 12 * count > tiff.size()) return false;
    for (size_t i = 0; i < count; ++i)
        if (number(tags + 2 + 12 * i, 2) == kBitsPerSample) return false;
    return true;
}

std::vector<float> Upright(const std::vector<float>& stored, int width, int height, int channels,
                           const RadianceHeader& order) {
    const int outWidth = order.turns ? height : width, outHeight = order.turns ? width : height;
    std::vector<float> upright;
    upright.reserve(stored.size());
    for (int y = 0; y < outHeight; ++y)
        for (int x = 0; x < outWidth; ++x) {
            int row = order.turns ? x : y, column = order.turns ? y : x;
            if (order.flipsRows) row = height - 1 - row;
            if (order.flipsColumns) column = width - 1 - column;
            const auto at = stored.begin() + (long(row) * width + column) * channels;
            upright.insert(upright.end(), at, at + channels);
        }
    return upright;
}

class OpenImageIoFile final : public lull::ImageFile {
  public:
    OpenImageIoFile(const char* path, const std::byte* bytes, size_t size) {
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1);  // 8-bit texels come back bit for bit
        if (bytes) {
            memory = std::make_unique<OIIO::Filesystem::IOMemReader>(const_cast<std::byte*>(bytes),
                                                                     size);
            OIIO::Filesystem::IOProxy* proxy = memory.get();
            config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
        }
        const auto contents = [&](size_t most = SIZE_MAX) {
            const char* const begin = reinterpret_cast<const char*>(bytes);
            return bytes ? std::vector<char>(begin, begin + std::min(most, size))
                         : ReadBytes(path, most);
        };
        const auto header = [&] {
            const std::vector<char> beginning = contents(1 << 14);
            return std::string(beginning.begin(), beginning.end());
        };
        input = OIIO::ImageInput::open(path, &config);
        if (header().starts_with("#?") && header().substr(0, 80).find("\r\n") != std::string::npos)
            throw std::runtime_error(
                "the lines of its header end in CR LF, as those of a text; copy it as binary");
        if (!input && header().starts_with("#?")) (void)RadianceHeader(header());
        if (!input) throw std::runtime_error(OIIO::geterror());
        const OIIO::ImageSpec& spec = input->spec();
        if (spec.deep) throw std::runtime_error("deep images are not supported");
        if (spec.depth > 1) throw std::runtime_error("volumes are not supported");
        shape = {spec.width, spec.height, lull::CountChannels(spec.nchannels, spec.alpha_channel),
                 spec.format == OIIO::TypeDesc::UINT8  ? TexelType::Byte
                 : spec.format == OIIO::TypeDesc::HALF ? TexelType::Half
                                                       : TexelType::Float};
        const std::string_view format = input->format_name();
        if (format == "hdr") {
            radiance = RadianceHeader(header());
            if (radiance.turns) std::swap(shape.width, shape.height);
        }
        if (format == "tiff" && spec.nchannels == 1 && shape.type == TexelType::Byte) {
            const std::vector<char> whole = contents();
            if (LacksBitsPerSample({whole.data(), whole.size()}))
                throw std::runtime_error(
                    "it has one bit a pixel without saying so; save it with 8");
        }
        if (format != "webp" || shape.channels != 4) return;
        webp = contents();
        HideAlpha(&webp);
    }

    ImageShape Shape() const override { return shape; }
    const float* Chromaticities() const override {
        return radiance.isRec709 ? nullptr : radiance.chromaticities.data();
    }

    void Read(void* texels) override {
        const OIIO::TypeDesc type = shape.type == TexelType::Byte   ? OIIO::TypeDesc::UINT8
                                    : shape.type == TexelType::Half ? OIIO::TypeDesc::HALF
                                                                    : OIIO::TypeDesc::FLOAT;
        if (!input->read_image(0, 0, 0, shape.channels, type, texels)) {
            if (std::string_view(input->format_name()) == "hdr")
                throw std::runtime_error(
                    FailureOf(*input).what() +
                    std::string("; it is cut short, or has run lengths of the old kind: save it "
                                "with Radiance's new ones, or as OpenEXR"));
            throw FailureOf(*input);
        }
        if (!radiance.IsPlain()) FinishRadiance(static_cast<float*>(texels));
        if (webp.empty()) return;
        const std::vector<uint8_t> colors = ReadColors(std::move(webp), shape.width, shape.height);
        auto* to = static_cast<uint8_t*>(texels);
        for (size_t i = 0; i < colors.size(); ++i) to[i / 3 * 4 + i % 3] = colors[i];
    }

  private:
    void FinishRadiance(float* texels) {
        const size_t values = size_t(shape.width) * size_t(shape.height) * size_t(shape.channels);
        const OIIO::ImageSpec& spec = input->spec();
        const std::vector<float> upright =
            Upright({texels, texels + values}, spec.width, spec.height, shape.channels, radiance);
        for (size_t i = 0; i < values; ++i)
            texels[i] = (radiance.gamma == 1 ? upright[i] : std::pow(upright[i], radiance.gamma)) *
                        radiance.scale[i % size_t(shape.channels)];
    }

    RadianceHeader radiance{""};
    std::vector<char> webp;  // of one with alpha: the file without
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
    std::unique_ptr<OIIO::ImageInput> input;
    ImageShape shape;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) lull::ImageFile* LullOpenImage(
    const char* path, const std::byte* bytes, size_t size) {
    return new OpenImageIoFile(path, bytes, size);
}
