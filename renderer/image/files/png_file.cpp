#include "renderer/image/files/png_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>
#include <optional>
#include <stdexcept>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/files/file_io.h"
#include "renderer/image/image_io.h"
#include "stopping/base/parallel.h"

namespace lull {
namespace {

constexpr size_t kPngSignature = 8;

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

namespace {

[[noreturn]] void FailToWritePng(const std::string& path, const std::string& reason) {
    throw Error("cannot write \"{}\": {}", path, reason);
}

using ByteSink = std::function<void(std::span<const std::byte>)>;

// Writes RGB rows of 8 or 16 bits. Errors of the sink are kept: none may pass through libpng.
class PngWriter {
  public:
    PngWriter(const std::string& path, ByteSink sink)
        : path(path),
          sink(std::move(sink)),
          png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, OnPngError, OnPngWarning)),
          info(png ? png_create_info_struct(png) : nullptr) {
        if (!info) {
            png_destroy_write_struct(&png, nullptr);
            throw std::bad_alloc();
        }
        png_set_write_fn(
            png, this,
            [](png_structp png, png_bytep from, size_t size) {
                if (!static_cast<PngWriter*>(png_get_io_ptr(png))->Take(from, size))
                    png_error(png, "");
            },
            [](png_structp) {});
    }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;
    ~PngWriter() { png_destroy_write_struct(&png, &info); }

    // Throw Error.
    void WriteHeader(int width, int height, int bits, int color,
                     const std::map<std::string, std::string>& text, bool isSmallest) {
        if (width < 1 || height < 1)
            FailToWritePng(path, fmt::format("its size of {}x{} is absurd", width, height));
        std::vector<png_text> texts;
        for (const auto& [name, value] : text) {
            png_text& t = texts.emplace_back();
            t.compression = PNG_TEXT_COMPRESSION_NONE;
            t.key = const_cast<char*>(name.c_str());
            t.text = const_cast<char*>(value.c_str());
        }
        Do([&, png = png, info = info, data = texts.data(), count = int(texts.size())] {
            png_set_compression_level(png, isSmallest ? 9 : 6);
            png_set_compression_strategy(png, 0);  // zlib's Z_DEFAULT_STRATEGY
            png_set_filter(png, 0, isSmallest ? PNG_ALL_FILTERS : PNG_NO_FILTERS);
            png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), bits, color,
                         PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
            png_set_oFFs(png, info, 0, 0, PNG_OFFSET_PIXEL);
            png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
            if (count) png_set_text(png, info, data, count);
            png_write_info(png, info);
            if (bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
        });
    }
    void WriteRow(const void* row) {
        Do([png = png, row] { png_write_row(png, static_cast<png_const_bytep>(row)); });
    }
    void End() {
        Do([png = png, info = info] { png_write_end(png, info); });
    }

  private:
    template <typename Call>
    void Do(const Call& call) {
        if (TryPng(png, call)) return;
        if (failure) throw *failure;
        FailToWritePng(path, error.message);
    }

    bool Take(const png_byte* from, size_t size) {
        try {
            sink(std::as_bytes(std::span(from, size)));
            return true;
        } catch (const Error& e) {
            failure = e;
        } catch (const std::exception& e) {
            failure = Error("cannot write \"{}\": {}", path, e.what());
        }
        return false;
    }

    std::string path;  // for messages
    ByteSink sink;
    std::optional<Error> failure;
    PngError error;
    png_structp png;
    png_infop info;
};

template <typename T>
T EncodeSrgb(float linear) {
    constexpr float kMost = std::numeric_limits<T>::max();
    const float v = kMost * SrgbFromLinear(std::max(0.f, linear)) + 0.5f;
    return T(std::min(v, kMost));
}

// Does so without a transfer function, for alpha and encoded colours. NaN is black.
template <typename T>
T EncodeLinear(float value) {
    constexpr float kMost = std::numeric_limits<T>::max();
    return T(kMost * std::clamp(value > 0 ? value : 0, 0.f, 1.f) + 0.5f);
}

void DivideByAlpha(std::span<const float> rgba, std::span<float> rgb) {
    for (size_t i = 0; i < rgb.size(); ++i) {
        const float* pixel = &rgba[i / 3 * 4];
        rgb[i] = pixel[3] > 0 ? pixel[i % 3] / pixel[3] : 0;
    }
}

template <typename T>
void EncodeRow(const PngFormat& format, std::span<float> linear, T* to) {
    const size_t components = format.hasAlpha ? 4 : 3, width = linear.size() / components;
    std::vector<float> divided;
    std::span<float> rgb = linear;
    if (format.hasAlpha) {
        divided.resize(3 * width);
        DivideByAlpha(linear, divided);
        rgb = divided;
    }
    const bool isEncoded = MapColors(format.grade, rgb);
    for (size_t i = 0; i < rgb.size(); ++i)
        to[i / 3 * components + i % 3] =
            isEncoded ? EncodeLinear<T>(rgb[i]) : EncodeSrgb<T>(rgb[i]);
    if (format.hasAlpha)
        for (size_t i = 3; i < linear.size(); i += 4) to[i] = EncodeLinear<T>(linear[i]);
}

template <typename T>
void WriteRows(PngWriter* writer, const RowSource& rows, int width, int height,
               const PngFormat& format) {
    writer->WriteHeader(width, height, 8 * int(sizeof(T)),
                        format.hasAlpha ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
                        format.text, false);
    constexpr int kStrip = 64;
    const size_t stride = size_t(width) * (format.hasAlpha ? 4 : 3);
    std::vector<T> strip(stride * size_t(std::min(kStrip, height)));
    for (int y = 0; y < height; y += kStrip) {
        const int count = std::min(kStrip, height - y);
        ForEachIndex(count, [&](int k) {
            std::vector<float> linear(stride);
            rows(y + k, linear);
            EncodeRow(format, linear, &strip[size_t(k) * stride]);
        });
        for (int k = 0; k < count; ++k) writer->WriteRow(&strip[size_t(k) * stride]);
    }
    writer->End();
}

void WriteRows(PngWriter* writer, std::span<const uint8_t> srgb, int width, int height,
               bool isSmallest) {
    writer->WriteHeader(width, height, 8, PNG_COLOR_TYPE_RGB, {}, isSmallest);
    for (int y = 0; y < height; ++y) writer->WriteRow(&srgb[size_t(y) * size_t(width) * 3]);
    writer->End();
}

template <typename Write>
void WriteFile(const std::string& path, const Write& write) {
    AtomicFile file(path);
    int64_t size = 0;
    PngWriter writer(path, [&](std::span<const std::byte> bytes) {
        file.WriteAt(size, bytes);
        size += int64_t(bytes.size());
    });
    write(&writer);
    file.Commit();
}

constexpr const char* kInMemory = "picture in memory";

template <typename Write>
std::vector<std::byte> Encode(const Write& write) {
    std::vector<std::byte> encoded;
    PngWriter writer(kInMemory, [&](std::span<const std::byte> bytes) {
        encoded.insert(encoded.end(), bytes.begin(), bytes.end());
    });
    write(&writer);
    return encoded;
}

void CheckFits(const std::string& path, size_t values, int width, int height) {
    if (values != size_t(width) * size_t(height) * 3)
        FailToWritePng(path, "the pixels do not fit the size");
}

RowSource RowsOf(std::span<const Rgb> pixels, int width) {
    return [=](int y, std::span<float> row) {
        for (size_t i = 0; i < row.size(); ++i)
            row[i] = pixels[size_t(y) * size_t(width) + i / 3][int(i % 3)];
    };
}

}  // namespace

uint8_t Encode8Bit(float linear) { return EncodeSrgb<uint8_t>(linear); }

std::vector<std::byte> EncodePng(std::span<const Rgb> pixels, int width, int height) {
    CheckFits(kInMemory, pixels.size() * 3, width, height);
    return Encode([&](PngWriter* writer) {
        WriteRows<uint8_t>(writer, RowsOf(pixels, width), width, height, PngFormat());
    });
}

std::vector<std::byte> EncodePng(std::span<const uint8_t> srgb, int width, int height) {
    CheckFits(kInMemory, srgb.size(), width, height);
    return Encode([&](PngWriter* writer) { WriteRows(writer, srgb, width, height, true); });
}

void WritePng(const std::string& path, std::span<const Rgb> pixels, int width, int height,
              const PngFormat& format) {
    CheckFits(path, pixels.size() * 3, width, height);
    WritePng(path, RowsOf(pixels, width), width, height, format);
}

void WritePng(const std::string& path, const RowSource& rows, int width, int height,
              const PngFormat& format) {
    WriteFile(path, [&](PngWriter* writer) {
        if (format.bits == 16)
            WriteRows<uint16_t>(writer, rows, width, height, format);
        else
            WriteRows<uint8_t>(writer, rows, width, height, format);
    });
}

void WritePng(const std::string& path, std::span<const uint8_t> srgb, int width, int height) {
    CheckFits(path, srgb.size(), width, height);
    WriteFile(path, [&](PngWriter* writer) { WriteRows(writer, srgb, width, height, false); });
}

}  // namespace lull
