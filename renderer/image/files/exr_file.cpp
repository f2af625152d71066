#include "renderer/image/files/exr_file.h"

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "renderer/image/files/exr_header.h"

namespace lull {
namespace {

// OpenEXR's messages begin with the name of the file, which is not known here.
constexpr const char* kName = "the file";

std::runtime_error WithoutName(const std::exception& e) {
    const std::string message = e.what(), name = std::string("\"") + kName + "\". ";
    const size_t at = message.find(name);
    return std::runtime_error(at == std::string::npos ? message : message.substr(at + name.size()));
}

Vec2i ExtentOf(const Imath::Box2i& box) {
    // As 64 bits, since a file may say anything.
    const auto side = [](int64_t min, int64_t max) {
        return int(std::clamp<int64_t>(max - min + 1, 0, std::numeric_limits<int>::max()));
    };
    return {side(box.min.x, box.max.x), side(box.min.y, box.max.y)};
}

std::vector<std::string> NamesOf(const Imf::Header& header) {
    std::vector<std::string> names;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        names.push_back(c.name());
    return names;
}

std::string ProblemOf(const Imf::Header& header) {
    if (header.hasType() && Imf::isDeepData(header.type())) return "deep images are not supported";
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            return std::string("subsampled channels are not supported (") + c.name() + ")";
    return "";
}

std::string OtherPrimaries(const Imf::Chromaticities& given) {
    constexpr float kSlack = 0.005f;  // usual figures have two to four digits
    const Imf::Chromaticities usual;
    std::string text;
    bool isOther = false;
    for (const auto part : {&Imf::Chromaticities::red, &Imf::Chromaticities::green,
                            &Imf::Chromaticities::blue, &Imf::Chromaticities::white}) {
        const Imath::V2f xy = given.*part;
        isOther |= !((xy - usual.*part).length() <= kSlack);
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", xy.x, xy.y);
    }
    return isOther ? text : "";
}

std::map<std::string, ExrAttribute> AttributesOf(const Imf::Header& header) {
    std::map<std::string, ExrAttribute> attributes;
    for (auto a = header.begin(); a != header.end(); ++a) {
        const Imf::Attribute* value = &a.attribute();
        if (const auto* s = dynamic_cast<const Imf::StringAttribute*>(value)) {
            attributes[a.name()] = s->value();
        } else if (const auto* i = dynamic_cast<const Imf::IntAttribute*>(value)) {
            attributes[a.name()] = i->value();
        } else if (const auto* f = dynamic_cast<const Imf::FloatAttribute*>(value)) {
            attributes[a.name()] = f->value();
        } else if (const auto* c = dynamic_cast<const Imf::ChromaticitiesAttribute*>(value)) {
            if (const std::string text = OtherPrimaries(c->value()); !text.empty())
                attributes[a.name()] = text;
        } else if (const auto* m = dynamic_cast<const Imf::M44fAttribute*>(value)) {
            using RowMajor = Eigen::Matrix<float, 4, 4, Eigen::RowMajor>;
            attributes[a.name()] =
                Mat4d(Eigen::Map<const RowMajor>(m->value().getValue()).cast<double>());
        }
    }
    return attributes;
}

}  // namespace

struct ExrFile::Parts {
    class MemoryStream final : public Imf::IStream {
      public:
        explicit MemoryStream(std::span<const std::byte> bytes)
            : Imf::IStream(kName), bytes(bytes) {}

        bool read(char into[], int size) override {
            if (position > bytes.size() || size < 0 || size_t(size) > bytes.size() - position)
                throw std::runtime_error("it is cut short");
            std::memcpy(into, bytes.data() + position, size_t(size));
            position += size_t(size);
            return position < bytes.size();
        }
        uint64_t tellg() override { return position; }
        void seekg(uint64_t to) override { position = to; }

      private:
        std::span<const std::byte> bytes;
        uint64_t position = 0;
    };

    struct Place {
        int part;
        std::string name;
    };

    MemoryStream stream;
    Imf::MultiPartInputFile file;
    std::map<std::string, Place> places;
    int part = 0;  // of the picture

    // Of a header that was checked.
    explicit Parts(std::span<const std::byte> bytes)
        : stream(bytes), file(stream, UseExrThreads()) {
        std::vector<int> order(size_t(file.parts()));
        std::iota(order.begin(), order.end(), 0);
        std::ranges::stable_sort(order, std::greater(),
                                 [&](int i) { return HasPlainColours(NamesOf(file.header(i))); });
        std::string problem = "it has no channels";
        for (const int i : order) {
            const Imf::Header& header = file.header(i);
            const std::vector<std::string> names = NamesOf(header);
            const std::string reason = ProblemOf(header);
            if (!reason.empty()) problem = reason;
            std::string prefix;
            const auto isTaken = [&] {
                return std::ranges::any_of(
                    names, [&](const std::string& name) { return places.contains(prefix + name); });
            };
            if (isTaken() && header.hasView()) prefix = header.view() + ".";
            if (isTaken()) prefix = header.name() + ".";
            for (size_t k = 0; reason.empty() && k < names.size(); ++k)
                places.try_emplace(prefix + names[k], Place{i, names[k]});
        }
        if (places.empty()) throw std::runtime_error(problem);
        part = PicturePart();
        std::erase_if(places, [&](const auto& place) {  // all have the same display window
            return file.header(place.second.part).dataWindow() != Header().dataWindow();
        });
    }
    const Imf::Header& Header() const { return file.header(part); }
    std::vector<std::string> Views() const {
        std::vector<std::string> views;
        if (Imf::hasMultiView(Header())) views = Imf::multiView(Header());
        const auto add = [&](const Imf::Header& header) {
            if (header.hasView() && std::ranges::count(views, header.view()) == 0)
                views.push_back(header.view());
        };
        add(Header());
        for (int i = 0; i < file.parts(); ++i) add(file.header(i));
        return views;
    }
    std::vector<std::string> SortedNames() const {
        std::vector<std::string> names;
        for (const auto& [name, place] : places) names.push_back(name);
        SortChannels(&names);
        return names;
    }
    int PicturePart() const {
        std::vector<std::string> names = SortedNames();
        try {
            names = PictureChannels(names);
        } catch (const std::runtime_error&) {  // those who want a picture will be told
        }
        return PlaceOf(*std::ranges::find_if(
                           names, [&](const std::string& name) { return places.contains(name); }))
            .part;
    }
    Place PlaceOf(const std::string& channel) const {
        const auto found = places.find(channel);
        return found == places.end() ? Place{part, channel} : found->second;
    }
    bool Has(const std::string& name, Imf::PixelType type) const {
        const auto found = places.find(name);
        return found != places.end() && file.header(found->second.part)
                                                .channels()
                                                .findChannel(found->second.name.c_str())
                                                ->type == type;
    }
};

ExrFile::ExrFile(std::span<const std::byte> bytes) try {
    CheckExrHeader(bytes);
    parts = std::make_unique<Parts>(bytes);
    channels = parts->SortedNames();
} catch (const std::exception& e) {
    throw WithoutName(e);
}

ExrFile::~ExrFile() = default;

ExrImage ExrFile::Header() const {
    const Imf::Header& header = parts->Header();
    const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
    ExrImage image;
    const Vec2i size = ExtentOf(data);
    image.width = size.x();
    image.height = size.y();
    image.origin = {data.min.x - display.min.x, data.min.y - display.min.y};
    image.displaySize = ExtentOf(display);
    image.attributes = AttributesOf(header);
    image.views = parts->Views();
    return image;
}

bool ExrFile::IsHalf(const std::string& channel) const { return parts->Has(channel, Imf::HALF); }

std::optional<std::array<float, 8>> ExrFile::Chromaticities() const {
    const Imf::Header& header = parts->Header();
    if (!Imf::hasChromaticities(header)) return {};
    const Imf::Chromaticities& c = Imf::chromaticities(header);
    if (OtherPrimaries(c).empty()) return {};
    return std::array{c.red.x,  c.red.y,  c.green.x, c.green.y,
                      c.blue.x, c.blue.y, c.white.x, c.white.y};
}

void ExrFile::ReadRows(TexelType type, size_t count, int first, int last, char* texels) {
    Imath::Box2i window = parts->Header().dataWindow();
    window.min.y = first;
    window.max.y = last;
    const Vec2i size = ExtentOf(window);
    const size_t bytes = SizeOf(type), pixel = bytes * count, row = pixel * size_t(size.x());
    const auto isInteger = [&](size_t c) { return parts->Has(channels[c], Imf::UINT); };
    std::map<int, Imf::FrameBuffer> frames;
    for (size_t c = 0; c < count; ++c) {
        const auto [part, name] = parts->PlaceOf(channels[c]);
        frames[part].insert(name, Imf::Slice::Make(type == TexelType::Half ? Imf::HALF
                                                   : isInteger(c)          ? Imf::UINT
                                                                           : Imf::FLOAT,
                                                   texels + bytes * c, window, pixel, row));
    }
    for (const auto& [number, frame] : frames) {
        Imf::InputPart part(parts->file, number);
        part.setFrameBuffer(frame);
        part.readPixels(first, last);
    }

    for (size_t c = 0; c < count; ++c) {
        if (!isInteger(c)) continue;
        for (size_t i = 0; i < size_t(size.x()) * size_t(size.y()); ++i) {
            char* at = texels + i * pixel + bytes * c;
            uint32_t integer;
            std::memcpy(&integer, at, sizeof(integer));
            const float value = float(integer) * 0x1p-32f;
            std::memcpy(at, &value, sizeof(value));
        }
    }
}

void ExrFile::Read(TexelType type, size_t count, void* texels) try {
    const Imath::Box2i window = parts->Header().dataWindow();
    ReadRows(type, count, window.min.y, window.max.y, static_cast<char*>(texels));
} catch (const std::exception& e) {
    throw WithoutName(e);
}

void ExrFile::ReadDisplayed(TexelType type, size_t count, void* texels) try {
    const Imath::Box2i data = parts->Header().dataWindow(),
                       display = parts->Header().displayWindow();
    if (data == display) return Read(type, count, texels);
    constexpr int kStrip = 256, kWidest = 1 << 16;  // rows, pixels
    const Vec2i size = ExtentOf(display), stored = ExtentOf(data);
    if (stored.maxCoeff() > kWidest) throw std::runtime_error("its data window is absurd");
    const size_t pixel = SizeOf(type) * count;
    std::memset(texels, 0, pixel * size_t(size.x()) * size_t(size.y()));
    const Imath::Box2i both(
        Imath::V2i(std::max(data.min.x, display.min.x), std::max(data.min.y, display.min.y)),
        Imath::V2i(std::min(data.max.x, display.max.x), std::min(data.max.y, display.max.y)));
    if (both.isEmpty()) return;
    const size_t width = size_t(both.max.x - both.min.x + 1);
    std::vector<char> strip(pixel * size_t(stored.x()) * size_t(std::min(kStrip, stored.y())));
    for (int y = both.min.y; y <= both.max.y; y += kStrip) {
        const int last = std::min(y + kStrip - 1, both.max.y);
        ReadRows(type, count, y, last, strip.data());
        for (int row = y; row <= last; ++row)
            std::memcpy(static_cast<char*>(texels) +
                            pixel * (size_t(row - display.min.y) * size_t(size.x()) +
                                     size_t(both.min.x - display.min.x)),
                        strip.data() + pixel * (size_t(row - y) * size_t(stored.x()) +
                                                size_t(both.min.x - data.min.x)),
                        pixel * width);
    }
} catch (const std::exception& e) {
    throw WithoutName(e);
}

namespace {

class ExrPicture final : public ImageFile {
  public:
    explicit ExrPicture(std::span<const std::byte> bytes) : file(bytes) {
        const std::vector<std::string> names = PictureChannels(file.Channels());
        const bool isHalf = std::ranges::all_of(names, [&](const std::string& name) {
            return file.IsHalf(name) || std::ranges::count(file.Channels(), name) == 0;
        });
        const ExrImage header = file.Header();
        shape = {header.displaySize.x(), header.displaySize.y(), int(names.size()),
                 isHalf ? TexelType::Half : TexelType::Float};
        chromaticities = file.Chromaticities();
        file.Choose(names);
    }
    ImageShape Shape() const override { return shape; }
    void Read(void* texels) override {
        file.ReadDisplayed(shape.type, size_t(shape.channels), texels);
    }
    const float* Chromaticities() const override {
        return chromaticities ? chromaticities->data() : nullptr;
    }

  private:
    ExrFile file;
    ImageShape shape;
    std::optional<std::array<float, 8>> chromaticities;
};

}  // namespace

bool IsExr(std::span<const std::byte> bytes) {
    return bytes.size() >= 4 && Imf::isImfMagic(reinterpret_cast<const char*>(bytes.data()));
}

std::unique_ptr<ImageFile> OpenExr(std::span<const std::byte> bytes) {
    return std::make_unique<ExrPicture>(bytes);
}

int UseExrThreads() {
    static const int threads = [] {
        Imf::setGlobalThreadCount(int(std::thread::hardware_concurrency()));
        return Imf::globalThreadCount();
    }();
    return threads;
}

}  // namespace lull
