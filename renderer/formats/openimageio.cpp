// The module of all formats but PNG and OpenEXR: OpenImageIO reads them. It is apart from the
// program since OpenImageIO brings some 200 libraries, which take longer to load than many a
// render.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <memory>
#include <stdexcept>

#include "renderer/formats/image_file.h"

namespace {

using lull::ImageShape, lull::TexelType;

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
    }

    ImageShape Shape() const override { return shape; }

    void Read(void* texels) override {
        const OIIO::TypeDesc type = shape.type == TexelType::Byte   ? OIIO::TypeDesc::UINT8
                                    : shape.type == TexelType::Half ? OIIO::TypeDesc::HALF
                                                                    : OIIO::TypeDesc::FLOAT;
        if (!input->read_image(0, 0, 0, shape.channels, type, texels))
            throw std::runtime_error(input->geterror());
    }

  private:
    std::unique_ptr<OIIO::Filesystem::IOMemReader> memory;
    std::unique_ptr<OIIO::ImageInput> input;
    ImageShape shape;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) lull::ImageFile* LullOpenImage(
    const char* path, const std::byte* bytes, size_t size) {
    return new OpenImageIoFile(path, bytes, size);
}
