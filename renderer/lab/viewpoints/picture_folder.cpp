// Reads the pictures of another renderer.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <filesystem>

#include "renderer/base/error.h"
#include "renderer/image/image_io.h"
#include "renderer/lab/viewpoints/study.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

struct Picture {
    int width = 0, height = 0;
    DisplayPixels pixels;
};

// Reads the number whose digits begin at `at`; 0 if it is none that an spp can be.
int NumberAt(const std::string& text, size_t at) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
    return error == std::errc() && value > 0 ? value : 0;
}

size_t BeginOfDigits(const std::string& text, size_t end) {
    while (end > 0 && std::isdigit(uint8_t(text[end - 1]))) --end;
    return end;
}

Picture ReadPicture(const std::string& path) {
    const Image image = ReadImage(path);
    Picture picture{image.width, image.height, {}};
    const size_t pixels = size_t(image.width) * size_t(image.height);
    const size_t channels = size_t(image.channels);
    const size_t green = channels >= 3 ? 1 : 0, blue = channels >= 3 ? 2 : 0;
    std::visit(
        [&](const auto& texels) {
            if constexpr (std::is_same_v<decltype(texels[0]), const uint8_t&>) {
                for (size_t i = 0; i < pixels; ++i)
                    for (const size_t c : {size_t(0), green, blue})
                        picture.pixels.push_back(texels[i * channels + c]);
            } else {
                std::vector<float> linear;
                for (size_t i = 0; i < pixels; ++i)
                    for (const size_t c : {size_t(0), green, blue})
                        linear.push_back(float(texels[i * channels + c]));
                picture.pixels.resize(linear.size());
                EncodeSrgb8(linear, picture.pixels);
            }
        },
        image.texels);
    return picture;
}

std::map<int, std::string> FindPictures(const std::string& folder) {
    std::error_code error;
    std::filesystem::directory_iterator files(folder, error);
    if (error) throw Error(fmt::format("--images {}: {}", folder, error.message()));
    std::map<int, std::string> found;
    for (const auto& entry : files) {
        const std::string name = entry.path().filename().string();
        if (!entry.is_regular_file() || name.starts_with(".")) continue;
        const int spp = SppInName(name);
        if (spp == 0)
            throw Error(fmt::format("{}: has no spp in its name, such as room-40spp.png",
                                    entry.path().string()));
        const auto [other, isNew] = found.emplace(spp, entry.path().string());
        if (!isNew)
            throw Error(fmt::format("{} and {} are both of {} spp", other->second,
                                    entry.path().string(), spp));
    }
    if (found.size() < 2)
        throw Error(fmt::format("--images {}: has {} pictures; a study needs two at least", folder,
                                found.size()));
    return found;
}

// Returns those of `available` that are nearest to the levels of a ladder.
std::vector<int> ChooseLevels(const std::vector<int>& available, int count, double ratio) {
    const int low = available.front(), cap = available.back();
    std::vector<double> wanted;
    const double span = std::log(double(cap) / low);
    const int steps = count > 0 ? count - 1 : std::max(1, int(std::round(span / std::log(ratio))));
    for (int i = 0; i <= steps; ++i) wanted.push_back(std::log(low) + span * i / steps);
    std::vector<int> levels;
    for (const double w : wanted) {
        const int nearest = *std::ranges::min_element(
            available, {}, [&](int spp) { return std::abs(std::log(double(spp)) - w); });
        if (levels.empty() || levels.back() < nearest) levels.push_back(nearest);
    }
    return levels;
}

DisplayPixels Cut(const Picture& picture, const PixelRect& rect) {
    DisplayPixels pixels;
    for (int y = rect.min.y(); y < rect.max.y(); ++y) {
        const auto row = picture.pixels.begin() + (ptrdiff_t(y) * picture.width) * 3;
        pixels.insert(pixels.end(), row + rect.min.x() * 3, row + rect.max.x() * 3);
    }
    return pixels;
}

}  // namespace

int SppInName(const std::string& name) {
    const std::string stem = std::filesystem::path(name).stem().string();
    std::string lower = stem;
    for (char& c : lower) c = char(std::tolower(uint8_t(c)));
    if (const size_t at = lower.rfind("spp"); at != std::string::npos) {
        const auto isSeparator = [](char c) {
            return c == '-' || c == '_' || c == '.' || c == ' ';
        };
        size_t end = at;
        while (end > 0 && isSeparator(lower[end - 1])) --end;
        if (const size_t begin = BeginOfDigits(lower, end); begin < end)
            return NumberAt(lower, begin);
        size_t begin = at + 3;
        while (begin < lower.size() && isSeparator(lower[begin])) ++begin;
        if (begin < lower.size()) return NumberAt(lower, begin);
        return 0;
    }
    const size_t last = stem.find_last_of("0123456789");
    return last == std::string::npos ? 0 : NumberAt(stem, BeginOfDigits(stem, last + 1));
}

Study ReadStudy(const std::string& folder, const std::string& viewpoint, int blockSize, int count,
                double ratio) {
    const std::map<int, std::string> files = FindPictures(folder);
    std::vector<int> available;
    for (const auto& [spp, file] : files) available.push_back(spp);

    Study study;
    study.viewpoint = viewpoint;
    study.levels = ChooseLevels(available, count, ratio);
    study.provenance["renderer"] = "another";
    std::string first;
    for (const int spp : study.levels) {
        const std::string& file = files.at(spp);
        const Picture picture = ReadPicture(file);
        if (first.empty()) {
            first = file;
            study.width = picture.width;
            study.height = picture.height;
            const PixelRect whole{{0, 0}, {picture.width, picture.height}};
            for (const Block& block : MakeBlocks(whole, {.blockSize = blockSize}))
                study.blocks.push_back({block.pixels, {}});
        }
        if (picture.width != study.width || picture.height != study.height)
            throw Error(fmt::format("{}: has {}x{} pixels, {} has {}x{}", file, picture.width,
                                    picture.height, first, study.width, study.height));
        for (StudyBlock& block : study.blocks) block.pictures.push_back(Cut(picture, block.pixels));
    }
    return study;
}

}  // namespace lull
