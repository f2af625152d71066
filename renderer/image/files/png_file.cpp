#include "renderer/image/files/png_file.h"

#include <bit>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>
#include <vector>

#include "renderer/image/files/png_library.h"

namespace lull {

namespace {

constexpr size_t kPngSignature = 8;

// Owns libpng's state of a file, and the read position.
struct Reading {
    std::span<const std::byte> bytes;  // that are left
    PngError error;
    png_structp png = nullptr;
    png_infop info = nullptr;

    explicit Reading(std::span<const std::byte> bytes)
        : bytes(bytes),
          png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &error, OnPngError, OnPngWarning)),
          info(png ? png_create_info_struct(png) : nullptr) {
        if (!info) {
            png_destroy_read_struct(&png, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png, this, [](png_structp png, png_bytep into, size_t size) {
            auto* self = static_cast<Reading*>(png_get_io_ptr(png));
            if (size > self->bytes.size()) png_error(png, "it is cut short");
            std::memcpy(into, self->bytes.data(), size);
            self->bytes = self->bytes.subspan(size);
        });
    }
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;
    ~Reading() { png_destroy_read_struct(&png, &info, nullptr); }

    template <typename Call>
    void Do(const Call& call) {
        if (!TryPng(png, call)) throw std::runtime_error(error.message);
    }
};

class PngFile final : public ImageFile {
  public:
    explicit PngFile(std::span<const std::byte> bytes) : reading(bytes) {
        png_structp png = reading.png;
        png_infop info = reading.info;
        reading.Do([=] {
            png_read_info(png, info);
            png_set_expand(png);
            if (std::endian::native == std::endian::little) png_set_swap(png);
            png_set_interlace_handling(png);
            png_read_update_info(png, info);
        });
        is16Bit = png_get_bit_depth(png, info) == 16;
        // Four channels of a PNG are RGB and alpha.
        shape = {int(png_get_image_width(png, info)), int(png_get_image_height(png, info)),
                 png_get_channels(png, info), is16Bit ? TexelType::Float : TexelType::Byte};
    }

    ImageShape Shape() const override { return shape; }

    void Read(void* texels) override {
        if (!is16Bit) return ReadRows(static_cast<png_bytep>(texels));
        std::vector<uint16_t> integers(Row() * size_t(shape.height));
        ReadRows(reinterpret_cast<png_bytep>(integers.data()));
        auto* floats = static_cast<float*>(texels);
        for (size_t i = 0; i < integers.size(); ++i) floats[i] = integers[i] * (1 / 65535.f);
    }

  private:
    size_t Row() const { return size_t(shape.width) * size_t(shape.channels); }

    // Reads rows of all channels, 8 or 16 bits each, one under the other.
    void ReadRows(png_bytep rows) {
        png_structp png = reading.png;
        const int height = shape.height;
        const size_t stride = Row() * (is16Bit ? 2 : 1);
        // Each pass of an interlaced file adds pixels to all rows.
        const int passes = png_get_interlace_type(png, reading.info) == PNG_INTERLACE_NONE ? 1 : 7;
        reading.Do([=] {
            for (int pass = 0; pass < passes; ++pass)
                for (int y = 0; y < height; ++y)
                    png_read_row(png, rows + size_t(y) * stride, nullptr);
        });
    }

    Reading reading;
    bool is16Bit = false;
    ImageShape shape;
};

}  // namespace

bool IsPng(std::span<const std::byte> bytes) {
    return bytes.size() >= kPngSignature &&
           png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, kPngSignature) == 0;
}

std::unique_ptr<ImageFile> OpenPng(std::span<const std::byte> bytes) {
    return std::make_unique<PngFile>(bytes);
}

}  // namespace lull
