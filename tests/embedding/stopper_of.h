// Calls the C interface as a program in C++ would.
#pragma once

#include <gtest/gtest.h>
#include <lull/lull.h>

#include <memory>

#include "tests/expect_has.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {

struct DestroyStopper {
    void operator()(lull_stopper* stopper) const { lull_stopper_destroy(stopper); }
};
using StopperHandle = std::unique_ptr<lull_stopper, DestroyStopper>;

inline StopperHandle MakeStopper(const lull_settings& settings) {
    lull_stopper* stopper = nullptr;
    EXPECT_EQ(lull_stopper_create(&settings, &stopper), LULL_OK) << lull_error_message();
    return StopperHandle(stopper);
}

inline lull_settings SettingsOf(int width, int height, const char* rule, int pass = 0) {
    lull_settings settings = {};
    settings.width = width;
    settings.height = height;
    settings.rule = rule;
    settings.pass = pass;
    return settings;
}

inline lull_image PictureOf(const BlockImage& image, bool withHalf = true) {
    lull_image picture = {};
    picture.width = image.width;
    picture.height = image.height;
    picture.mean = image.mean.data();
    picture.half = withHalf ? image.halfMean.data() : nullptr;
    return picture;
}

// Shows the only block of an image; its answer.
inline lull_answer Show(const StopperHandle& stopper, const lull_image& picture, int spp) {
    lull_answer answer = {};
    EXPECT_EQ(lull_stopper_observe(stopper.get(), &picture, spp, &answer), LULL_OK)
        << lull_error_message();
    return answer;
}

// Returns the image at a sample count, equal at each call.
inline BlockImage ImageAt(int spp, int width = 60, int height = 50, double noise = 0.5) {
    return NoisyBlock(width, height, noise, spp, unsigned(spp));
}

inline void ExpectError(lull_status expected, lull_status status, const std::string& part) {
    EXPECT_EQ(status, expected);
    EXPECT_HAS(lull_error_message(), part) << "no '" << part << "' in: " << lull_error_message();
}

inline std::vector<char> SavedState(const StopperHandle& stopper) {
    size_t size = 0;
    EXPECT_EQ(lull_stopper_save(stopper.get(), nullptr, &size), LULL_OK);
    std::vector<char> bytes(size--);
    ExpectError(LULL_BAD_ARGUMENT, lull_stopper_save(stopper.get(), bytes.data(), &size), "room");
    EXPECT_EQ(size, bytes.size());
    EXPECT_EQ(lull_stopper_save(stopper.get(), bytes.data(), &size), LULL_OK);
    return bytes;
}

inline bool SameAnswer(const lull_answer& a, const lull_answer& b) {
    return a.stop == b.stop && a.checked == b.checked && a.spp == b.spp &&
           a.next_spp == b.next_spp && a.votes == b.votes && a.votes_needed == b.votes_needed &&
           a.value == b.value && a.threshold == b.threshold && a.probability == b.probability &&
           a.masked_noise == b.masked_noise;
}

}  // namespace lull
