// Renders with several ranks.
#pragma once

#include <memory>

#include "renderer/render/light_rounds.h"
#include "tests/renderer/render/queue_peers.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull::ranks_test {

// A render as rank 0 has it in the end.
struct Shared {
    std::unique_ptr<Film> film;
    RenderResult result;
    RenderState state;  // the last that a checkpoint was shown
    int64_t bytes = 0;
};

inline const PixelRect kImage = {{3, 2}, {74, 59}};

inline RenderOptions SharedOptions() {
    RenderOptions options;
    options.schedule = {.blockSize = 25, .passLength = 20, .cap = 90, .smallestSide = 20};
    options.sampler = Sampler(SamplerKind::Random, 0);
    options.threads = 1;
    options.makeCriterion = [](const BlockInfo& block) {
        return std::make_unique<ScriptedCriterion>(40 + 20 * block.index);
    };
    return options;
}

using Change = std::function<void(RenderSetup*, int rank)>;
using SourceOfRank = std::function<SampleSource(int rank)>;

inline SampleSource SameForAll(int) { return SyntheticSample; }

// Renders with `ranks` ranks; 0: without peers.
inline Shared RenderShared(int ranks, const Change& change = {}, const Shared* before = nullptr,
                           const SourceOfRank& sourceOf = SameForAll, const Habits& how = {},
                           bool withLayers = false) {
    Shared shared;
    Mailboxes mail;
    mail.how = how;
    mail.boxes.resize(size_t(std::max(1, ranks)));
    const auto runRank = [&](int rank) {
        QueuePeers peers(&mail, rank);
        RenderSetup options{{}, SharedOptions()};
        if (ranks > 0) options.peers = &peers;
        // The least that any of them allows is what this process has for all.
        options.threads = ranks + 1;
        if (rank == 0) options.checkpoints.write = [&](const RenderState& s) { shared.state = s; };
        if (change) change(&options, rank);
        auto film = std::make_unique<Film>(
            kImage, FilmOptions{.grid = GridOf(options.schedule),
                                .withSpreads = options.lightRounds != nullptr,
                                .layers = {.aovs = {.depth = withLayers, .object = withLayers}}});
        if (before && rank == 0) {
            *film = *before->film;
            options.interrupted = &before->state;
        }
        options.source = sourceOf(rank);
        options.film = film.get();
        RenderResult result = Render(options, options);
        if (rank > 0) return;
        shared.film = std::move(film);
        shared.result = std::move(result);
    };
    std::vector<std::thread> others;
    for (int rank = 1; rank < ranks; ++rank) others.emplace_back(runRank, rank);
    runRank(0);
    {
        std::lock_guard lock(mail.mutex);
        mail.isOver = true;
    }
    for (std::thread& thread : others) thread.join();
    shared.bytes = mail.bytes;
    return shared;
}

}  // namespace lull::ranks_test
