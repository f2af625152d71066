#include <ImfChannelList.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <optional>

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"
#include "renderer/image/files/exr_file.h"
#include "renderer/image/image.h"
#include "renderer/image/image_io.h"
#include "stopping/base/parallel.h"

namespace lull {
namespace {

[[noreturn]] void FailToWriteExr(const std::string& path, const std::string& reason) {
    throw Error("cannot write \"{}\": {}", path, reason);
}

// Output stream of OpenEXR. The last bytes come when its file is destroyed, where exceptions are
// lost: the first one is kept.
class FileStream final : public Imf::OStream {
  public:
    explicit FileStream(const std::string& path) : Imf::OStream(path.c_str()), file(path) {}

    void write(const char from[], int size) override {
        try {
            file.WriteAt(int64_t(position), std::as_bytes(std::span(from, size_t(size))));
        } catch (const Error& e) {
            failure = e;
            throw;
        }
        position += uint64_t(size);
    }
    uint64_t tellp() override { return position; }
    void seekp(uint64_t to) override { position = to; }

    AtomicFile file;
    std::optional<Error> failure;

  private:
    uint64_t position = 0;
};

Imath::Box2i Box(const Vec2i& min, const Vec2i& size) {
    return {{min.x(), min.y()}, {min.x() + size.x() - 1, min.y() + size.y() - 1}};
}

std::string LocalTime() {
    const std::time_t now = std::time(nullptr);
    std::tm local;
    localtime_r(&now, &local);
    char text[32];
    return {text, std::strftime(text, sizeof(text), "%Y:%m:%d %H:%M:%S", &local)};
}

void SetAttribute(Imf::Header* header, const std::string& name, const ExrAttribute& value) {
    if (const auto* s = std::get_if<std::string>(&value)) {
        header->insert(name, Imf::StringAttribute(*s));
    } else if (const auto* i = std::get_if<int>(&value)) {
        header->insert(name, Imf::IntAttribute(*i));
    } else if (const auto* f = std::get_if<float>(&value)) {
        header->insert(name, Imf::FloatAttribute(*f));
    } else {
        Imath::M44f matrix;
        Eigen::Map<Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(matrix.getValue()) =
            std::get<Mat4d>(value).cast<float>();
        header->insert(name, Imf::M44fAttribute(matrix));
    }
}

Imf::Header MakeHeader(const ExrImage& image) {
    const Vec2i size(image.width, image.height);
    const bool hasDisplay = image.displaySize.x() > 0 && image.displaySize.y() > 0;
    const Imath::Box2i window = Box(image.origin, size);
    Imf::Header header(hasDisplay ? Box(Vec2i::Zero(), image.displaySize) : window, window);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.zipCompressionLevel() = 4;
    for (const ExrChannel& c : image.channels)
        header.channels().insert(c.name, Imf::Channel(c.isHalf ? Imf::HALF : Imf::FLOAT));
    header.insert("capDate", Imf::StringAttribute(LocalTime()));
    for (const auto& [name, value] : image.attributes) SetAttribute(&header, name, value);
    return header;
}

// 16 rows are compressed together, and several such on all threads.
constexpr int kStrip = 64;

Half Clamped(float v, int64_t* clamped) {
    if (std::abs(v) <= kLargestHalf) return Half(v);
    ++*clamped;
    return Half(std::isnan(v) ? 0 : std::copysign(kLargestHalf, v));
}

template <typename File>
int64_t WriteRows(const ExrImage& image, const RowSource& rows, File* file) {
    const size_t count = image.channels.size(), row = size_t(image.width) * count;
    std::vector<float> strip(row * size_t(std::min(kStrip, image.height)));
    std::vector<Half> halves(std::ranges::any_of(image.channels, &ExrChannel::isHalf) ? strip.size()
                                                                                      : 0);
    int64_t clamped = 0;
    for (int y = 0; y < image.height; y += kStrip) {
        const int height = std::min(kStrip, image.height - y);
        ForEachIndex(height,
                     [&](int k) { rows(y + k, std::span(strip).subspan(row * size_t(k), row)); });
        for (size_t i = 0; i < std::min(halves.size(), row * size_t(height)); ++i)
            if (image.channels[i % count].isHalf) halves[i] = Clamped(strip[i], &clamped);
        const Imath::Box2i window = Box(image.origin + Vec2i(0, y), Vec2i(image.width, height));
        Imf::FrameBuffer frame;
        for (size_t c = 0; c < count; ++c)
            frame.insert(image.channels[c].name,
                         image.channels[c].isHalf
                             ? Imf::Slice::Make(Imf::HALF, &halves[c], window, sizeof(Half) * count,
                                                sizeof(Half) * row)
                             : Imf::Slice::Make(Imf::FLOAT, &strip[c], window,
                                                sizeof(float) * count, sizeof(float) * row));
        file->setFrameBuffer(frame);
        file->writePixels(height);
    }
    return clamped;
}

}  // namespace

int64_t WriteExr(const std::string& path, const ExrImage& image) {
    const size_t pixels = size_t(image.width) * size_t(image.height);
    for (const ExrChannel& c : image.channels)
        if (c.values.size() != pixels)
            FailToWriteExr(path, fmt::format("channel {} does not fit the size", c.name));
    return WriteExr(path, image, [&](int y, std::span<float> row) {
        const size_t count = image.channels.size();
        for (size_t i = 0; i < row.size(); ++i)
            row[i] = image.channels[i % count].values[size_t(y) * size_t(image.width) + i / count];
    });
}

namespace {

void CheckSize(const std::string& path, const ExrImage& image) {
    if (image.width < 1 || image.height < 1 || image.channels.empty())
        FailToWriteExr(path, fmt::format("its size of {}x{}x{} is absurd", image.width,
                                         image.height, image.channels.size()));
}

template <typename Write>
int64_t WriteStream(const std::string& path, const Write& write) {
    FileStream stream(path);
    int64_t clamped = 0;
    try {
        clamped = write(stream);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        if (!stream.failure) FailToWriteExr(path, e.what());
    }
    if (stream.failure) throw *stream.failure;
    stream.file.Commit();
    return clamped;
}

}  // namespace

int64_t WriteExr(const std::string& path, const ExrImage& image, const RowSource& rows) {
    CheckSize(path, image);
    return WriteStream(path, [&](FileStream& stream) {
        Imf::OutputFile file(stream, MakeHeader(image), UseExrThreads());
        return WriteRows(image, rows, &file);
    });
}

int64_t WriteExr(const std::string& path, std::span<const ExrImage> parts,
                 std::span<const RowSource> rows) {
    std::vector<Imf::Header> headers;
    for (const ExrImage& part : parts) {
        CheckSize(path, part);
        const std::string view = std::get<std::string>(part.attributes.at("view"));
        headers.push_back(MakeHeader(part));
        headers.back().setName(view);
        headers.back().setView(view);
        headers.back().setType(Imf::SCANLINEIMAGE);
    }
    return WriteStream(path, [&](FileStream& stream) {
        Imf::MultiPartOutputFile file(stream, headers.data(), int(headers.size()), false,
                                      UseExrThreads());
        int64_t clamped = 0;
        for (size_t i = 0; i < parts.size(); ++i) {
            Imf::OutputPart part(file, int(i));
            clamped += WriteRows(parts[i], rows[i], &part);
        }
        return clamped;
    });
}

}  // namespace lull
