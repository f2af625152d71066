// The functions of lull/lull.h: no exception leaves them, and every pointer is looked at first.
#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "renderer/denoise/denoiser.h"
#include "renderer/embedding/picture.h"
#include "renderer/embedding/stopper.h"
#include "stopping/signals/attributes26.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/svd_entropy.h"

struct lull_stopper {
    lull::Stopper blocks;
};

namespace lull {

namespace {

// Of fixed length, so that running out of memory can be said too.
thread_local std::array<char, 1024> lastError = {};

lull_status Fail(lull_status status, const char* message) {
    const size_t length = std::min(std::strlen(message), lastError.size() - 1);
    std::memcpy(lastError.data(), message, length);
    lastError[length] = 0;
    return status;
}

template <typename Body>
lull_status Guarded(const Body& body) noexcept {
    try {
        body();
        return LULL_OK;
    } catch (const std::bad_alloc&) {
        return Fail(LULL_OUT_OF_MEMORY, "out of memory");
    } catch (const std::invalid_argument& e) {
        return Fail(LULL_BAD_ARGUMENT, e.what());
    } catch (const std::runtime_error& e) {
        return Fail(LULL_BAD_FILE, e.what());
    } catch (const std::exception& e) {
        return Fail(LULL_INTERNAL, e.what());
    } catch (...) {
        return Fail(LULL_INTERNAL, "something unknown went wrong");
    }
}

template <typename T>
T* NotNull(T* pointer, const char* what) {
    if (!pointer) throw std::invalid_argument(std::string(what) + " is null");
    return pointer;
}

}  // namespace

}  // namespace lull

using lull::Guarded;
using lull::NotNull;

extern "C" {

lull_status lull_stopper_create(const lull_settings* settings, lull_stopper** stopper) {
    return Guarded([&] {
        *NotNull(stopper, "stopper") = nullptr;
        *stopper = new lull_stopper{lull::Stopper(*NotNull(settings, "settings"))};
    });
}

void lull_stopper_destroy(lull_stopper* stopper) { delete stopper; }

int lull_stopper_block_count(const lull_stopper* stopper) {
    return stopper ? int(stopper->blocks.Grid().blocks.size()) : 0;
}

int lull_stopper_column_count(const lull_stopper* stopper) {
    return stopper ? stopper->blocks.Grid().columns : 0;
}

lull_status lull_stopper_block_rect(const lull_stopper* stopper, int block, lull_rect* rect) {
    return Guarded([&] {
        NotNull(rect, "rect");
        *rect = NotNull(stopper, "stopper")->blocks.RectOf(block);
    });
}

int lull_stopper_needs_half(const lull_stopper* stopper) {
    return stopper && stopper->blocks.NeedsHalf() ? 1 : 0;
}

lull_status lull_stopper_observe(lull_stopper* stopper, const lull_image* picture, int spp,
                                 lull_answer* answers) {
    return Guarded([&] {
        lull::Stopper& blocks = NotNull(stopper, "stopper")->blocks;
        const auto all = blocks.Observe(*NotNull(picture, "image"), spp);
        if (answers) std::ranges::copy(all, answers);
    });
}

lull_status lull_stopper_observe_block(lull_stopper* stopper, int block, const lull_image* picture,
                                       int spp, lull_answer* answer) {
    return Guarded([&] {
        lull::Stopper& blocks = NotNull(stopper, "stopper")->blocks;
        const lull_answer now = blocks.ObserveBlock(block, *NotNull(picture, "image"), spp);
        if (answer) *answer = now;
    });
}

lull_status lull_stopper_answer(const lull_stopper* stopper, int block, lull_answer* answer) {
    return Guarded([&] {
        NotNull(answer, "answer");
        *answer = NotNull(stopper, "stopper")->blocks.Answer(block);
    });
}

int lull_stopper_done(const lull_stopper* stopper) {
    int done = 1;
    if (stopper) Guarded([&] { done = stopper->blocks.Done() ? 1 : 0; });
    return done;
}

const char* lull_stopper_warning(const lull_stopper* stopper) {
    const char* warning = "";
    if (stopper) Guarded([&] { warning = stopper->blocks.Warning(); });
    return warning;
}

lull_status lull_stopper_save(const lull_stopper* stopper, void* bytes, size_t* size) {
    return Guarded([&] {
        const std::vector<std::byte> state = NotNull(stopper, "stopper")->blocks.Save();
        const size_t room = std::exchange(*NotNull(size, "size"), state.size());
        if (bytes && room < state.size())
            throw std::invalid_argument("the state of the stopper has " +
                                        std::to_string(state.size()) +
                                        " bytes, and there is room for " + std::to_string(room));
        if (bytes) std::memcpy(bytes, state.data(), state.size());
    });
}

lull_status lull_stopper_restore(lull_stopper* stopper, const void* bytes, size_t size) {
    return Guarded([&] {
        lull::Stopper& blocks = NotNull(stopper, "stopper")->blocks;
        NotNull(bytes, "bytes");
        blocks.Restore({static_cast<const std::byte*>(bytes), size});
    });
}

lull_status lull_svd_entropy(const lull_image* picture, int sub_blocks, lull_entropy* entropies) {
    return Guarded([&] {
        NotNull(entropies, "entropies");
        const std::vector<double> lightness = lull::LightnessOf(*NotNull(picture, "image"));
        const auto all =
            lull::SubBlockEntropies(lightness, picture->width, picture->height, sub_blocks);
        std::ranges::transform(all, entropies, [](const lull::SvdEntropy& e) {
            return lull_entropy{e.h, e.h1, e.h2};
        });
    });
}

lull_status lull_attributes26(const lull_image* picture, double* attributes) {
    return Guarded([&] {
        NotNull(attributes, "attributes");
        const std::vector<double> lightness = lull::LightnessOf(*NotNull(picture, "image"));
        std::ranges::copy(lull::ComputeAttributes(lightness, picture->width, picture->height),
                          attributes);
    });
}

lull_status lull_denoise(const lull_noisy_image* noisy, lull_denoised_image* clean) {
    return Guarded([&] { lull::Denoise(*NotNull(noisy, "noisy"), NotNull(clean, "clean")); });
}

const char* lull_error_message(void) { return lull::lastError.data(); }

const char* lull_version(void) { return LULL_VERSION; }

}  // extern "C"

namespace lull {

namespace {

// Copies rows from y0 on to planes from number `first` on. Values need not be aligned.
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

Halves ReadFeatures(const lull_noisy_image& noisy, int y0, int y1) {
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

// Throws for colours that no image has, and for half buffers that cannot judge each other.
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

NoisyPicture Read(const lull_noisy_image& noisy) {
    Require(std::min(noisy.width, noisy.height) >= 1 &&
                std::max(noisy.width, noisy.height) <= kLargestSide,
            "an image of " + std::to_string(noisy.width) + "x" + std::to_string(noisy.height) +
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

void CheckOutput(const lull_noisy_image& noisy, const lull_denoised_image& clean) {
    Require(clean.colour, "there is no room for the colours");
    Require(clean.block_count >= 0 && (clean.blocks || clean.block_count == 0),
            std::to_string(clean.block_count) + " blocks, of which there are none");
    for (int i = 0; i < clean.block_count; ++i) {
        const lull_block_error& block = clean.blocks[i];
        Require(block.x >= 0 && block.y >= 0 && block.width >= kSmallestMeasuredSide &&
                    block.height >= kSmallestMeasuredSide && block.x <= noisy.width - block.width &&
                    block.y <= noisy.height - block.height,
                "block " + std::to_string(i) +
                    " must lie within the image, and have at least 10 pixels a side");
    }
}

void DenoiseInto(NoisyPicture picture, lull_denoised_image* clean) {
    const std::span<lull_block_error> blocks(clean->blocks, size_t(clean->block_count));
    std::vector<PixelRect> measured;
    for (const lull_block_error& block : blocks)
        measured.push_back({{block.x, block.y}, {block.x + block.width, block.y + block.height}});
    const DenoisedImage result =
        RunDenoiser(std::move(picture), measured, {.withDeviation = clean->error != nullptr});
    for (size_t i = 0; i < blocks.size(); ++i) {
        blocks[i].estimate = result.blocks[i]->estimate;
        blocks[i].upper = result.blocks[i]->upper;
    }
    std::ranges::copy(result.error, clean->error);
    std::ranges::copy(result.image.values, clean->colour);
}

}  // namespace

void Denoise(const lull_noisy_image& noisy, lull_denoised_image* clean) {
    NoisyPicture picture = Read(noisy);
    CheckOutput(noisy, *clean);
    DenoiseInto(std::move(picture), clean);
}

}  // namespace lull
