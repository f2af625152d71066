#include "renderer/image/image_io.h"

#include <dlfcn.h>
#include <fmt/core.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/base/memory.h"
#include "renderer/files/file_io.h"
#include "renderer/image/files/exr_file.h"
#include "renderer/image/files/exr_header.h"
#include "renderer/image/files/png_file.h"
#include "stopping/base/input_file.h"

namespace lull {
namespace {

constexpr int kMaxSide = 1 << 16;
// No format here packs texels tighter than this on average; deflate ends near 1000 to 1.
constexpr size_t kMaxCompression = 4000;
constexpr size_t kAlwaysAllowed = size_t(64) << 20;
constexpr size_t kSignature = 8;  // tells PNG and EXR from the rest

[[noreturn]] void FailToRead(const std::string& path, const std::string& reason) {
    throw Error(OneLine(fmt::format("cannot read image \"{}\": {}", path, reason)));
}

void CheckSize(const std::string& path, size_t fileSize, const ImageShape& shape) {
    const std::string size = fmt::format("{}x{}x{}", shape.width, shape.height, shape.channels);
    if (shape.width < 1 || shape.height < 1 || shape.channels < 1 || shape.width > kMaxSide ||
        shape.height > kMaxSide)
        FailToRead(path, "its size of " + size + " is absurd");
    const size_t bytes =
        size_t(shape.width) * size_t(shape.height) * size_t(shape.channels) * SizeOf(shape.type);
    if (bytes > kAlwaysAllowed && bytes / kMaxCompression > fileSize)
        FailToRead(path, "it is too short for its size of " + size);
    // As read, and once more as a texture keeps it.
    CheckMemory(int64_t(2 * bytes), fmt::format("image \"{}\" of {}", path, size),
                "use a smaller version of it");
}

struct FoundFile {
    std::string path;
    size_t size = 0;
    FileContents contents;

    std::span<const std::byte> Bytes() const { return std::as_bytes(std::span(contents.View())); }

    explicit FoundFile(const std::string& path) : path(path) {
        std::error_code error;
        const auto status = std::filesystem::status(path, error);
        if (!std::filesystem::exists(status)) FailToRead(path, "no such file");
        if (std::filesystem::is_directory(status)) FailToRead(path, "it is a directory");
        if (!std::filesystem::is_regular_file(status)) FailToRead(path, "it is not a regular file");
        size = size_t(std::filesystem::file_size(path, error));
        std::ifstream in(path, std::ios::binary);
        if (error || !in) FailToRead(path, "it cannot be opened");
        char signature[kSignature];
        in.read(signature, kSignature);
        const auto bytes = std::as_bytes(std::span(signature, size_t(in.gcount())));
        if (IsPng(bytes) || IsExr(bytes)) contents = ReadFile(path);
    }
};

// The path from the program to the module is the same in the build tree as where it is installed.
std::string ModulePath() {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    return (program.parent_path().parent_path() / LULL_MODULE_FOLDER / "formats.so").string();
}

// Returns a function of the module by its name. The first call loads the module, which takes 0.2 s.
// Throws std::runtime_error if it cannot be loaded: `purpose` is the beginning of the message.
void* ModuleFunction(const char* name, const char* purpose) {
    const std::string path = ModulePath();
    void* module = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* function = module ? dlsym(module, name) : nullptr;
    if (!function)
        throw std::runtime_error(fmt::format(
            "{} \"{}\", which cannot be loaded ({}); reinstall lull", purpose, path, dlerror()));
    return function;
}

// Opens the file `path` or, if there are bytes, these, whose format is named by the extension of
// `path`. Throws std::runtime_error with the reason, without the path.
std::unique_ptr<ImageFile> OpenOtherFormat(const std::string& path,
                                           std::span<const std::byte> bytes = {}) {
    static auto* const open = reinterpret_cast<OpenImageFunction*>(ModuleFunction(
        "LullOpenImage",
        "it is neither PNG nor OpenEXR, and all other formats are read by the module"));
    return std::unique_ptr<ImageFile>(open(path.c_str(), bytes.data(), bytes.size()));
}

std::unique_ptr<ImageFile> Open(const FoundFile& file) {
    if (IsPng(file.Bytes())) return OpenPng(file.Bytes());
    if (IsExr(file.Bytes())) return OpenExr(file.Bytes());
    return OpenOtherFormat(file.path);
}

std::unique_ptr<ImageFile> Open(const std::string& type, std::span<const std::byte> bytes) {
    if (IsPng(bytes)) return OpenPng(bytes);
    if (IsExr(bytes)) return OpenExr(bytes);
    if (bytes.empty()) throw std::runtime_error("it is empty");
    return OpenOtherFormat("memory." + type, bytes);
}

void ToRec709(const ImageFile& file, Image* image) {
    const float* const xy = file.Chromaticities();
    if (!xy || image->channels < 3) return;
    const Eigen::Matrix3f matrix =
        Rec709From({{xy[0], xy[1]}, {xy[2], xy[3]}, {xy[4], xy[5]}, {xy[6], xy[7]}});
    if (!matrix.allFinite()) throw std::runtime_error("its chromaticities are no primaries");
    std::visit(
        [&](auto& texels) {
            if constexpr (sizeof(texels[0]) > 1)  // bytes are not linear
                Convert(matrix, size_t(image->channels),
                        size_t(image->width) * size_t(image->height), texels.data());
        },
        image->texels);
}

template <typename Open>
Image Read(const std::string& name, size_t fileSize, const Open& open) try {
    const std::unique_ptr<ImageFile> file = open();
    const ImageShape shape = file->Shape();
    CheckSize(name, fileSize, shape);
    Image image{shape.width, shape.height, shape.channels, {}};
    if (shape.type == TexelType::Half) image.texels = std::vector<Half>();
    if (shape.type == TexelType::Float) image.texels = std::vector<float>();
    std::visit(
        [&](auto& texels) {
            texels.resize(size_t(shape.width) * size_t(shape.height) * size_t(shape.channels));
            file->Read(texels.data());
        },
        image.texels);
    ToRec709(*file, &image);
    return image;
} catch (const Error&) {
    throw;
} catch (const std::exception& e) {
    FailToRead(name, e.what());
}

ExrImage ExrOf(const Image& picture) {
    ExrImage image;
    image.width = picture.width;
    image.height = picture.height;
    image.displaySize = {picture.width, picture.height};
    const size_t count = size_t(picture.channels);
    for (size_t c = 0; c < count; ++c) {
        ExrChannel& channel = image.channels.emplace_back();
        channel.name = count < 3 ? std::string(1, "YA"[c]) : std::string(1, "RGBA"[c]);
        std::visit(
            [&](const auto& texels) {
                constexpr bool isBytes = sizeof(texels[0]) == 1;
                for (size_t i = c; i < texels.size(); i += count)
                    channel.values.push_back(float(texels[i]) * (isBytes ? 1 / 255.f : 1.f));
            },
            picture.texels);
    }
    return image;
}

ExrImage ReadExr(const FoundFile& found) try {
    ExrFile file(found.Bytes());
    ExrImage image = file.Header();
    const std::vector<std::string>& names = file.Channels();
    const size_t count = names.size();
    CheckSize(found.path, found.size, {image.width, image.height, int(count), TexelType::Float});
    std::vector<float> interleaved(size_t(image.width) * size_t(image.height) * count);
    file.Read(TexelType::Float, count, interleaved.data());
    for (size_t c = 0; c < count; ++c) {
        ExrChannel& channel = image.channels.emplace_back();
        channel.name = names[c];
        channel.isHalf = file.IsHalf(names[c]);
        channel.values.resize(interleaved.size() / count);
        for (size_t i = 0; i < channel.values.size(); ++i)
            channel.values[i] = interleaved[i * count + c];
    }
    return image;
} catch (const Error&) {
    throw;
} catch (const std::exception& e) {
    FailToRead(found.path, e.what());
}

}  // namespace

Image ReadImage(const std::string& path) {
    const FoundFile file(path);
    return Read(path, file.size, [&] { return Open(file); });
}

Image ReadImage(const std::string& name, const std::string& type,
                std::span<const std::byte> bytes) {
    return Read(name, bytes.size(), [&] { return Open(type, bytes); });
}

const ExrChannel* ExrImage::Find(const std::string& name) const {
    for (const ExrChannel& c : channels)
        if (c.name == name) return &c;
    return nullptr;
}

ExrImage ReadExr(const std::string& path) {
    const FoundFile file(path);
    if (IsExr(file.Bytes())) return ReadExr(file);
    return ExrOf(Read(path, file.size, [&] { return Open(file); }));
}

std::shared_ptr<const ViewTransform> LoadView(const std::string& config,
                                              const std::string& view) try {
    static auto* const open = reinterpret_cast<OpenViewFunction*>(
        ModuleFunction("LullOpenView", "views of OpenColorIO are made by the module"));
    return std::shared_ptr<const ViewTransform>(open(config.c_str(), view.c_str()));
} catch (const std::runtime_error& e) {
    throw Error((config.empty() ? "--view" : config) + ": " + Printable(OneLine(e.what()), 1000));
}

std::string TextOf(const Grade& grade) {
    std::string text;
    if (grade.view)
        text = fmt::format("OpenColorIO {}", grade.view->Name());
    else if (grade.toneMap == ToneMap::Filmic)
        text = "filmic (Hable 2010)";
    if (grade.exposure == 0) return text;
    return fmt::format("{}{}{:+g} stops", text, text.empty() ? "" : ", ", grade.exposure);
}

bool MapColors(const Grade& grade, std::span<float> rgb) {
    const float scale = std::exp2(grade.exposure);
    for (float& v : rgb) v *= scale;
    if (grade.view)
        grade.view->Apply(rgb.data(), rgb.size() / 3);
    else if (grade.toneMap == ToneMap::Filmic)
        std::ranges::transform(rgb, rgb.begin(), FilmicToneMap);
    return grade.view != nullptr;
}

void ApplyGrade(const Grade& grade, std::span<float> rgb) {
    if (grade.IsPlain()) return;
    const bool isEncoded = MapColors(grade, rgb);
    for (float& v : rgb)
        v = isEncoded ? LinearFromSrgb(v > 0 ? std::min(v, 1.f) : 0)
                      : (v > 0 ? std::min(v, std::numeric_limits<float>::max()) : 0);
}

}  // namespace lull
