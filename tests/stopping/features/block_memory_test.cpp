#include "stopping/features/block_memory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/stopping/cut_states.h"

namespace lull {
namespace {

ModelSettings Geometric(int k, double ratio) {
    return {.k = k,
            .n = 40,
            .features = {Feature::H},
            .takesMean = true,
            .snorm = false,
            .spacing = Spacing::Geometric,
            .ratio = ratio};
}

// Measures whose entropies of 100 sub-blocks are above 0.2 by 1 / spp.
BlockMeasures At(int spp) {
    BlockMeasures measures{.spp = spp};
    measures.Of(Feature::H).assign(100, 0.2 + 1.0 / spp);
    measures.lightness.mean.assign(100, 60);
    measures.lightness.deviation.assign(100, 0);
    return measures;
}

double SppOf(double input) { return 1 / (input - 0.2); }

TEST(BlockMemory, StepsGeometrically) {
    BlockMemory memory(Geometric(4, 2));
    for (int spp = 20; spp <= 10000; spp += 40) {
        memory.Add(At(spp));
        const auto window = memory.WindowAt(spp);
        EXPECT_TRUE(window || spp < 340) << spp;
        EXPECT_FALSE(window && spp < 140) << spp;
        if (!window) continue;
        EXPECT_NEAR(SppOf((*window)(0, 3)), spp, 1e-2 * spp);
        for (int step = 0; step < 3; ++step) {
            const double wanted = spp / std::pow(2, 3 - step);
            EXPECT_NEAR(SppOf((*window)(0, step)), wanted, 21 + 0.05 * wanted) << spp;
        }
        for (int step = 1; step < 4; ++step) EXPECT_LT((*window)(0, step), (*window)(0, step - 1));
    }
    EXPECT_FALSE(memory.WindowAt(9000));  // the last one only
}

TEST(BlockMemory, KeepsLittle) {
    BlockMemory memory(Geometric(4, 2));
    for (int spp = 20; spp <= 200000; spp += 40) memory.Add(At(spp));
    StateWriter writer;
    memory.Save(&writer);
    EXPECT_LE(writer.bytes.size(), 12 + 26 * (4 + sizeof(double)));
}

TEST(BlockMemory, CompletesFallsOfEntropies) {
    const ModelSettings settings{
        .k = 1,
        .features = {Feature::VisibleDrop},
        .takesMean = true,
        .visibility = {.mask = 24, .flare = 0, .reference = 10000, .nearness = 0.5}};
    BlockMemory memory(settings);
    memory.Add(At(20));
    EXPECT_FALSE(memory.WindowAt(20));  // there is nothing to compare with
    for (int spp = 60; spp <= 4020; spp += 40) memory.Add(At(spp));
    const Eigen::MatrixXf window = *memory.WindowAt(4020);
    const double left = std::sqrt(1 / 4020.0);
    EXPECT_NEAR(std::exp(window(0, 0)) - 0.1, left * 60 * std::sqrt(1 - 0.402), 1e-3);
}

TEST(BlockMemory, ScalesNoiseByCaution) {
    ModelSettings settings{
        .k = 1, .features = {Feature::VisibleDrop, Feature::H}, .takesMean = true, .snorm = false};
    auto inputs = [&] {
        BlockMemory memory(settings);
        for (int spp = 20; spp <= 420; spp += 40) memory.Add(At(spp));
        return *memory.WindowAt(420);
    };
    const Eigen::MatrixXf once = inputs();
    settings.caution = 2;
    const Eigen::MatrixXf twice = inputs();
    EXPECT_NEAR(std::exp(twice(0, 0)) - 0.1, 2 * (std::exp(once(0, 0)) - 0.1), 1e-4);
    EXPECT_EQ(twice(1, 0), once(1, 0));
}

TEST(BlockMemory, GoesOnAfterARestart) {
    ModelSettings settings = Geometric(3, 1.5);
    settings.features = {Feature::VisibleDrop};
    BlockMemory first(settings), second(settings);
    for (int spp = 20; spp <= 1020; spp += 40) first.Add(At(spp));
    StateWriter writer;
    first.Save(&writer);
    StateReader reader(writer.bytes);
    second.Restore(&reader);
    reader.Finish();
    for (int spp = 1060; spp <= 3000; spp += 40) {
        first.Add(At(spp));
        second.Add(At(spp));
        EXPECT_EQ(*first.WindowAt(spp), *second.WindowAt(spp)) << spp;
    }
    ExpectRefusesCut(writer.bytes, 101, [&](auto bytes) {
        StateReader cut(bytes);
        BlockMemory(settings).Restore(&cut);
    });
}

TEST(BlockMemory, RefusesSettingsOfNoSense) {
    auto refuses = [](auto change) {
        ModelSettings settings;
        settings.features = {Feature::VisibleDrop};
        change(&settings);
        EXPECT_THROW(BlockMemory{settings}, std::invalid_argument);
    };
    refuses([](ModelSettings* s) { s->m = 25; });
    refuses([](ModelSettings* s) { s->visibility.mask = 0; });
    refuses([](ModelSettings* s) { s->visibility.flare = -1; });
    refuses([](ModelSettings* s) { s->visibility.nearness = std::nan(""); });
    refuses([](ModelSettings* s) { s->visibility.reference = 0; });
    refuses([](ModelSettings* s) { s->caution = 0; });
    refuses([](ModelSettings* s) { *s = Geometric(2, 1); });
    refuses([](ModelSettings* s) { *s = Geometric(100, 2); });
}

}  // namespace
}  // namespace lull
