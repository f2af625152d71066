#include "renderer/render/session.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <random>

#include "stopping/base/hdf5_file.h"
#include "stopping/base/input_file.h"
#include "stopping/base/state.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull::checkpoint_test {
namespace {

const PixelRect kRegion = {{0, 0}, {131, 97}};
const RenderIdentity kIdentity = {{"scene", "a"}, {"seed", "0"}};

// Sums up what it has been shown, and stops where the sum is a certain one; so it stops elsewhere
// if it has forgotten anything.
class SummingCriterion final : public Criterion {
  public:
    explicit SummingCriterion(int block) : passes(3 + 2 * block) {}
    ViewNeed Need(int) const override { return ViewNeed::MeanAndHalf; }
    Decision Observe(const BlockView& view) override {
        for (size_t i = 0; i < view.mean.size(); ++i) sum += view.mean[i] - view.halfMean[i];
        return {.stop = --passes == 0, .checked = true, .value = sum, .threshold = 0};
    }
    // Forecasts have it of every second decision.
    std::optional<double> NetworkNoise() const override {
        return passes % 2 == 0 ? std::optional(0.5 * passes) : std::nullopt;
    }
    std::vector<std::byte> Save() const override {
        StateWriter writer;
        writer.Put(sum);
        writer.Put(passes);
        return std::move(writer.bytes);
    }
    void Restore(std::span<const std::byte> state) override {
        StateReader reader(state);
        sum = reader.Get<double>();
        passes = reader.Get<int>();
        reader.Finish();
    }

  private:
    double sum = 0;
    int passes;
};

RenderOptions SmallRender(int threads) {
    RenderOptions options;
    options.schedule = {.blockSize = 50, .passLength = 6, .cap = 60};
    options.sampler = Sampler(SamplerKind::Random, 0);
    options.threads = threads;
    options.makeCriterion = [](const BlockInfo& block) {
        return std::make_unique<SummingCriterion>(block.index);
    };
    return options;
}

void ExpectSame(const RenderResult& a, const RenderResult& b) {
    ASSERT_EQ(a.blocks.size(), b.blocks.size());
    for (size_t i = 0; i < a.blocks.size(); ++i) {
        EXPECT_EQ(a.blocks[i].block.spp, b.blocks[i].block.spp);
        EXPECT_EQ(a.blocks[i].block.stoppedByVote, b.blocks[i].block.stoppedByVote);
        ASSERT_EQ(a.blocks[i].decisions.size(), b.blocks[i].decisions.size());
        for (size_t k = 0; k < a.blocks[i].decisions.size(); ++k) {
            EXPECT_EQ(a.blocks[i].decisions[k].spp, b.blocks[i].decisions[k].spp);
            EXPECT_EQ(a.blocks[i].decisions[k].decision.value,
                      b.blocks[i].decisions[k].decision.value);
            EXPECT_EQ(a.blocks[i].decisions[k].networkNoise, b.blocks[i].decisions[k].networkNoise);
        }
    }
}

TEST(Checkpoint, GoesOnToTheSameBitsWhereverTheRenderWasInterrupted) {
    const TemporaryDirectory directory;
    const std::string path = directory.File("render.checkpoint");
    Film reference(kRegion);
    const RenderResult expected = Render(Onto(&reference, SmallRender(2)));
    EXPECT_LT(reference.SampleCount(), kRegion.Area() * 60);

    for (const int samplesARun : {5000, 12345, 100000, 300000}) {
        Film film(kRegion);
        RenderState state;
        RenderResult result;
        bool begun = false;
        // Each run starts from the file alone, with another number of threads.
        for (int run = 0; run < 1000; ++run) {
            RenderOptions options = SmallRender(1 + run % 3);
            std::atomic<int> samples = 0;
            options.isCancelled = [&] { return samples >= samplesARun; };
            const auto write = [&](const RenderState& s) {
                WriteCheckpoint(path, kIdentity, s, film);
            };
            if (begun) options.interrupted = &state;
            options.checkpoints = {write};
            result = Render(Onto(&film, options, Counted(&samples)));
            if (!result.cancelled) break;
            begun = true;
            film = Film(kRegion);
            state = ReadCheckpoint(path, kIdentity, &film);
        }
        EXPECT_TRUE(begun);
        EXPECT_TRUE(SamePixels(film, reference)) << samplesARun;
        ExpectSame(result, expected);
        EXPECT_EQ(result.progress.samples, reference.SampleCount());
    }
}

TEST(Checkpoint, LeavesOutBlocksThatHadStopped) {
    Film whole(kRegion), part(kRegion);
    const RenderOptions options = SmallRender(2);
    const RenderResult expected = Render(Onto(&whole, options));
    RenderState state;
    for (const Block& block : MakeBlocks(kRegion, options.schedule)) {
        state.blocks.push_back({.block = block, .decisions = {}});
        state.blocks.back().block.stopped = state.blocks.size() != 3;
    }
    state.criteria.resize(state.blocks.size());
    RenderOptions rest = Onto(&part, options);
    rest.interrupted = &state;
    const RenderResult result = Render(rest);
    EXPECT_FALSE(result.cancelled);
    for (size_t i = 0; i < result.blocks.size(); ++i)
        EXPECT_EQ(result.blocks[i].block.spp, i == 2 ? expected.blocks[i].block.spp : 0);
    EXPECT_EQ(part.At({120, 20}).sum, whole.At({120, 20}).sum);
    EXPECT_EQ(part.At({20, 20}).count, 0u);

    state.criteria.pop_back();
    EXPECT_THROW(Render(rest), std::invalid_argument);
}

// The checkpoint of a render that has just begun.
struct SmallCheckpoint {
    TemporaryDirectory directory;
    const std::string path = directory.File("a.checkpoint");

    SmallCheckpoint() {
        Film film(kRegion);
        RenderOptions options = SmallRender(1);
        std::atomic<int> tiles = 0;
        options.isCancelled = [&] { return tiles++ >= 50; };
        const auto write = [&](const RenderState& s) { WriteCheckpoint(path, kIdentity, s, film); };
        options.checkpoints = {write};
        Render(Onto(&film, options));
    }
};

// Returns the message of the Error that reading the file gives.
std::string ReadError(const std::string& path, Film* film,
                      const RenderIdentity& identity = kIdentity) {
    return ErrorOf([&] { ReadCheckpoint(path, identity, film); });
}

TEST(Checkpoint, SaysWhatIsNotTheSame) {
    const SmallCheckpoint begun;
    Film film(kRegion);
    const std::string error = ReadError(begun.path, &film, {{"scene", "a"}, {"seed", "1"}});
    EXPECT_HAS(error, begun.path);
    EXPECT_HAS(error, "another seed (0 there, 1 here)");
    EXPECT_HAS(ReadError(begun.path, &film, {{"scene", "a"}, {"crop", "1"}}),
               "another crop (none there, 1 here)");
}

// Whoever needs the half has to have asked for it from the start.
TEST(Checkpoint, IsReadWithoutTheHalfWhereThatIsNotNeeded) {
    const SmallCheckpoint begun;
    Film film(kRegion, {.withHalf = false}), whole(kRegion);
    const RenderState state = ReadCheckpoint(begun.path, kIdentity, &film);
    ReadCheckpoint(begun.path, kIdentity, &whole);
    EXPECT_EQ(film.MeanImage(), whole.MeanImage());
    EXPECT_GT(film.SampleCount(), 0);

    WriteCheckpoint(begun.path, kIdentity, state, film);
    Film again(kRegion, {.withHalf = false});
    EXPECT_NO_THROW(ReadCheckpoint(begun.path, kIdentity, &again));
    EXPECT_EQ(again.MeanImage(), whole.MeanImage());
    EXPECT_HAS(ReadError(begun.path, &whole), "without the sums of the half");
}

TEST(Checkpoint, KeepsTheSharesOfLightPaths) {
    const SmallCheckpoint begun;
    Film film(kRegion);
    RenderState state = ReadCheckpoint(begun.path, kIdentity, &film);
    EXPECT_FALSE(state.shares);
    const auto takenUp = [&](const BdptShares& shares) {
        state.shares = shares;
        WriteCheckpoint(begun.path, kIdentity, state, film);
        return ReadCheckpoint(begun.path, kIdentity, &film).shares.value();
    };
    const BdptShares same = takenUp({.lightPaths = 0.25f, .connections = 0.125f});
    EXPECT_EQ(same.lightPaths, 0.25f);
    EXPECT_EQ(same.connections, 0.125f);
    for (const BdptShares damaged : {BdptShares{2, 1}, {0, 0}, {std::nanf(""), 1}})
        EXPECT_HAS(ErrorOf([&] { takenUp(damaged); }), "its shares of light paths");
}

TEST(Checkpoint, RefusesThoseOfAnOlderFormat) {
    const TemporaryDirectory directory;
    const auto fileOf = [&](const char* format) {
        Hdf5Group root = Hdf5Group::CreateInMemory();
        root.SetString("format", format);
        const auto content = root.Content();
        std::vector<std::byte> bytes(content.begin(), content.end());
        Seal(&bytes);
        return directory.Write("c.h5", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    };
    Film film(kRegion);
    const std::string path = fileOf("lull checkpoint 5");
    EXPECT_HAS(ReadError(path, &film), path + ": it was written by an older lull; ");
    EXPECT_HAS(ReadError(fileOf("something else"), &film), "it is not a checkpoint");
}

// Sizes are checked before anything is read, whoever has sealed the file.
TEST(Checkpoint, RefusesPlanesOfAnotherSize) {
    const SmallCheckpoint begun;
    Film film(kRegion, {.grid = {.blockSize = 50, .tileSize = 8}});
    const std::string error = ReadError(begun.path, &film);
    EXPECT_HAS(error, begun.path);
    EXPECT_HAS(error, "'tiles': it does not have the shape 392");
}

TEST(Checkpoint, RefusesDamagedFiles) {
    const SmallCheckpoint begun;
    const std::string bytes = ReadBytes(begun.path);
    Film film(kRegion);
    EXPECT_NO_THROW(ReadCheckpoint(begun.path, kIdentity, &film));
    EXPECT_THROW(ReadCheckpoint(begun.directory.File("none"), kIdentity, &film), Error);
    for (const size_t length : {size_t(0), size_t(10), bytes.size() / 2, bytes.size() - 1})
        EXPECT_THROW(
            ReadCheckpoint(begun.directory.Write("cut", bytes.substr(0, length)), kIdentity, &film),
            Error)
            << length;
    std::mt19937 random(1);
    for (int i = 0; i < 300; ++i) {
        std::string flipped = bytes;
        flipped[random() % bytes.size()] ^= char(1 << random() % 8);
        const std::string damaged = begun.directory.Write("flipped", flipped);
        EXPECT_HAS(ReadError(damaged, &film), damaged + ": it is ");
    }
    // Another image's pixels do not fit.
    Film smaller({{0, 0}, {40, 97}});
    EXPECT_THROW(ReadCheckpoint(begun.path, kIdentity, &smaller), Error);
}

}  // namespace
}  // namespace lull::checkpoint_test
