#include "renderer/embedding/picture.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "renderer/denoise/denoiser.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

// Copies the rows of an image from y0 on to planes from number `first` on. Values need not be
// aligned.
void Copy(const float* from, const lull_halves& layout, int y0, int channels, int first,
          Planes* to) {
    const ptrdiff_t channel = layout.channel_stride ? layout.channel_stride : sizeof(float);
    const ptrdiff_t pixel = layout.pixel_stride ? layout.pixel_stride : channels * channel;
    const ptrdiff_t row = layout.row_stride ? layout.row_stride : to->width * pixel;
    const auto* bytes = reinterpret_cast<const std::byte*>(from);
    for (int c = 0; c < channels; ++c)
        for (int y = 0; y < to->height; ++y)
            for (int x = 0; x < to->width; ++x)
                std::memcpy(to->Row(first + c, y) + x,
                            bytes + (y0 + y) * row + x * pixel + c * channel, sizeof(float));
}

void CheckFeature(const char* name, const lull_halves& feature) {
    Require(feature.a || !feature.b, std::string(name) + " has a second half, but no first");
}

// Copies rows of both halves, where they are known.
void CopyFeature(const lull_halves& feature, int y0, int channels, int first, Halves* to) {
    if (!feature.a) return;
    Copy(feature.a, feature, y0, channels, first, &to->a);
    Copy(feature.b ? feature.b : feature.a, feature, y0, channels, first, &to->b);
}

Halves ReadFeatures(const lull_noisy_picture& noisy, int y0, int y1) {
    const Planes none(noisy.width, y1 - y0, kFeatures);
    Halves rows{none, none};
    CopyFeature(noisy.albedo, y0, 3, 0, &rows);
    CopyFeature(noisy.normal, y0, 3, 3, &rows);
    CopyFeature(noisy.depth, y0, 1, kFeatures - 1, &rows);
    for (Planes* half : {&rows.a, &rows.b})
        for (size_t i = 0; i < half->Area(); ++i) {
            float& depth = half->Plane(kFeatures - 1)[i];
            depth = DisparityOf(depth);
        }
    return rows;
}

// Throws where colours cannot be those of a picture, or its halves not judge each other.
void CheckColours(const Halves& colour) {
    for (const Planes* half : {&colour.a, &colour.b}) {
        PictureValues values;
        for (size_t i = 0; i < half->Area(); ++i)
            values.Add(half->Plane(0)[i], half->Plane(1)[i], half->Plane(2)[i]);
        const std::string name = half == &colour.a ? "the first half: " : "the second half: ";
        for (const std::string& fault : {FaultOfValues(values), FaultOfExposure(values)})
            Require(fault.empty(), name + fault);
    }
    const std::string dependence = DependenceOf(colour);
    Require(dependence.empty(), dependence);
}

NoisyPicture Read(const lull_noisy_picture& noisy) {
    Require(std::min(noisy.width, noisy.height) >= 1 &&
                std::max(noisy.width, noisy.height) <= kLargestSide,
            "a picture of " + std::to_string(noisy.width) + "x" + std::to_string(noisy.height) +
                " pixels; 1 to 65,536 are possible");
    Require(noisy.colour.a && noisy.colour.b,
            "the colours of both halves of the samples are needed");
    CheckFeature("albedo", noisy.albedo);
    CheckFeature("normal", noisy.normal);
    CheckFeature("depth", noisy.depth);
    NoisyPicture picture;
    picture.colour.a = picture.colour.b = Planes(noisy.width, noisy.height, kColours);
    Copy(noisy.colour.a, noisy.colour, 0, kColours, 0, &picture.colour.a);
    Copy(noisy.colour.b, noisy.colour, 0, kColours, 0, &picture.colour.b);
    CheckColours(picture.colour);
    const auto read = [&](int y0, int y1) { return ReadFeatures(noisy, y0, y1); };
    picture.features = FilterFeatures(noisy.width, noisy.height, read);
    return picture;
}

void CheckOutput(const lull_noisy_picture& noisy, const lull_denoised_picture& clean) {
    Require(clean.colour, "there is no room for the colours");
    Require(clean.block_count >= 0 && (clean.blocks || clean.block_count == 0),
            std::to_string(clean.block_count) + " blocks, of which there are none");
    for (int i = 0; i < clean.block_count; ++i) {
        const lull_block_error& block = clean.blocks[i];
        Require(block.x >= 0 && block.y >= 0 && block.width >= kSmallestMeasuredSide &&
                    block.height >= kSmallestMeasuredSide && block.x <= noisy.width - block.width &&
                    block.y <= noisy.height - block.height,
                "block " + std::to_string(i) +
                    " must lie within the picture, and have at least 10 pixels a side");
    }
}

void DenoiseInto(NoisyPicture picture, lull_denoised_picture* clean) {
    const std::span<lull_block_error> blocks(clean->blocks, size_t(clean->block_count));
    std::vector<PixelRect> measured;
    for (const lull_block_error& block : blocks)
        measured.push_back({{block.x, block.y}, {block.x + block.width, block.y + block.height}});
    const DenoiserResult result =
        RunDenoiser(std::move(picture), measured, {.withDeviation = clean->error != nullptr});
    for (size_t i = 0; i < blocks.size(); ++i) {
        blocks[i].estimate = result.blocks[i]->estimate;
        blocks[i].upper = result.blocks[i]->upper;
    }
    std::ranges::copy(result.deviation, clean->error);
    std::ranges::copy(result.rgb, clean->colour);
}

}  // namespace

void Denoise(const lull_noisy_picture& noisy, lull_denoised_picture* clean) {
    NoisyPicture picture = Read(noisy);
    CheckOutput(noisy, *clean);
    DenoiseInto(std::move(picture), clean);
}

}  // namespace lull
