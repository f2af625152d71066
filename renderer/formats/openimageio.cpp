// The module of all formats but PNG and OpenEXR: OpenImageIO reads them. It is apart from the
// program since OpenImageIO brings some 200 libraries, which take longer to load than many a
// render.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/formats/image_file.h"

namespace {

using lull::ImageShape, lull::TexelType;

std::vector<char> ReadBytes(const char* path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
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

// An image of 4 channels, read from bytes.
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
        throw std::runtime_error(input->geterror());
    return colors;
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
        input = OIIO::ImageInput::open(path, &config);
        if (!input) throw std::runtime_error(OIIO::geterror());
        const OIIO::ImageSpec& spec = input->spec();
        if (spec.deep) throw std::runtime_error("deep images are not supported");
        if (spec.depth > 1) throw std::runtime_error("volumes are not supported");
        shape = {spec.width, spec.height, lull::CountChannels(spec.nchannels, spec.alpha_channel),
                 spec.format == OIIO::TypeDesc::UINT8  ? TexelType::Byte
                 : spec.format == OIIO::TypeDesc::HALF ? TexelType::Half
                                                       : TexelType::Float};
        if (std::strcmp(input->format_name(), "webp") != 0 || shape.channels != 4) return;
        webp = bytes ? std::vector<char>(reinterpret_cast<const char*>(bytes),
                                         reinterpret_cast<const char*>(bytes) + size)
                     : ReadBytes(path);
        HideAlpha(&webp);
    }

    ImageShape Shape() const override { return shape; }

    void Read(void* texels) override {
        const OIIO::TypeDesc type = shape.type == TexelType::Byte   ? OIIO::TypeDesc::UINT8
                                    : shape.type == TexelType::Half ? OIIO::TypeDesc::HALF
                                                                    : OIIO::TypeDesc::FLOAT;
        if (!input->read_image(0, 0, 0, shape.channels, type, texels))
            throw std::runtime_error(input->geterror());
        if (webp.empty()) return;
        const std::vector<uint8_t> colors = ReadColors(std::move(webp), shape.width, shape.height);
        auto* to = static_cast<uint8_t*>(texels);
        for (size_t i = 0; i < colors.size(); ++i) to[i / 3 * 4 + i % 3] = colors[i];
    }

  private:
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
