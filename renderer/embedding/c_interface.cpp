// The functions of lull/lull.h: no exception leaves them, and every pointer is looked at first.
#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include "renderer/embedding/picture.h"
#include "renderer/embedding/stopper.h"
#include "stopping/signals/attributes26.h"
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

lull_status lull_stopper_observe(lull_stopper* stopper, const lull_picture* picture, int spp,
                                 lull_answer* answers) {
    return Guarded([&] {
        lull::Stopper& blocks = NotNull(stopper, "stopper")->blocks;
        const auto all = blocks.Observe(*NotNull(picture, "picture"), spp);
        if (answers) std::ranges::copy(all, answers);
    });
}

lull_status lull_stopper_observe_block(lull_stopper* stopper, int block,
                                       const lull_picture* picture, int spp, lull_answer* answer) {
    return Guarded([&] {
        lull::Stopper& blocks = NotNull(stopper, "stopper")->blocks;
        const lull_answer now = blocks.ObserveBlock(block, *NotNull(picture, "picture"), spp);
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

lull_status lull_svd_entropy(const lull_picture* picture, int sub_blocks, lull_entropy* entropies) {
    return Guarded([&] {
        NotNull(entropies, "entropies");
        const std::vector<double> lightness = lull::LightnessOf(*NotNull(picture, "picture"));
        const auto all =
            lull::SubBlockEntropies(lightness, picture->width, picture->height, sub_blocks);
        std::ranges::transform(all, entropies, [](const lull::SvdEntropy& e) {
            return lull_entropy{e.h, e.h1, e.h2};
        });
    });
}

lull_status lull_attributes26(const lull_picture* picture, double* attributes) {
    return Guarded([&] {
        NotNull(attributes, "attributes");
        const std::vector<double> lightness = lull::LightnessOf(*NotNull(picture, "picture"));
        std::ranges::copy(lull::ComputeAttributes(lightness, picture->width, picture->height),
                          attributes);
    });
}

lull_status lull_denoise(const lull_noisy_picture* noisy, lull_denoised_picture* clean) {
    return Guarded([&] { lull::Denoise(*NotNull(noisy, "noisy"), NotNull(clean, "clean")); });
}

const char* lull_error_message(void) { return lull::lastError.data(); }

const char* lull_version(void) { return LULL_VERSION; }

}  // extern "C"
