#include "renderer/lab/viewpoints/study.h"

#include <fmt/format.h>

#include <cmath>

#include "stopping/signals/lightness.h"

namespace lull {

namespace {

// FNV-1a, 64 bits (Fowler, Noll, Vo).
class Hash {
  public:
    void Add(std::string_view text) {
        for (const char c : text) AddByte(uint8_t(c));
        AddByte(0);
    }
    void Add(int value) {
        for (int i = 0; i < 4; ++i) AddByte(uint8_t(uint32_t(value) >> 8 * i));
    }
    void Add(const DisplayPixels& pixels) {
        for (const uint8_t v : pixels) AddByte(v);
    }
    uint64_t Value() const { return value; }

  private:
    void AddByte(uint8_t byte) { value = (value ^ byte) * 0x100000001b3; }

    uint64_t value = 0xcbf29ce484222325;
};

std::vector<double> LightnessOfCodes(const DisplayPixels& pixels) {
    std::vector<double> lightness(pixels.size() / 3);
    Lightness(pixels, lightness);
    return lightness;
}

}  // namespace

std::string StudyId(const Study& study) {
    Hash hash;
    hash.Add(study.viewpoint);
    for (const int spp : study.levels) hash.Add(spp);
    for (const StudyBlock& block : study.blocks) {
        for (const Vec2i& corner : {block.pixels.min, block.pixels.max}) {
            hash.Add(corner.x());
            hash.Add(corner.y());
        }
        for (const DisplayPixels& picture : block.pictures) hash.Add(picture);
    }
    return fmt::format("{:016x}", hash.Value());
}

double NoiseOf(const StudyBlock& block, size_t level) {
    const std::vector<double> picture = LightnessOfCodes(block.pictures.at(level)),
                              reference = LightnessOfCodes(block.pictures.back());
    double sum = 0;
    for (size_t i = 0; i < picture.size(); ++i)
        sum += (picture[i] - reference[i]) * (picture[i] - reference[i]);
    return picture.empty() ? 0 : std::sqrt(sum / double(picture.size()));
}

}  // namespace lull
