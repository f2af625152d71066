// Renders with several ranks.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "renderer/render/light_rounds.h"
#include "renderer/render/peers.h"
#include "renderer/render/ranks/rank.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull::ranks_test {

// Ranks that are threads here and speak through queues.

struct Habits {
    // How long rank 0 sleeps when it has sent a mere word, so that the others answer meanwhile.
    std::chrono::milliseconds nap{0};
    // The rank that neither sends nor receives after so many messages of its own; -1: none.
    int sleeper = -1, messagesBefore = 0;
};

struct Mailboxes {
    Habits how;
    std::mutex mutex;
    std::vector<std::deque<PeerMessage>> boxes;
    bool isOver = false;  // for the sleeper too
};

class QueuePeers final : public Peers {
  public:
    QueuePeers(Mailboxes* mail, int rank) : mail(mail), rank(rank) {}
    int Rank() const override { return rank; }
    int Count() const override { return int(mail->boxes.size()); }
    void Send(int to, std::vector<std::byte> message) override {
        const bool isWord = message.size() == 1;
        {
            std::lock_guard lock(mail->mutex);
            if (Sleeps()) return;
            ++messages;
            mail->boxes[size_t(to)].push_back({rank, std::move(message)});
        }
        if (rank == 0 && isWord) std::this_thread::sleep_for(mail->how.nap);
    }
    std::optional<PeerMessage> Receive() override {
        std::lock_guard lock(mail->mutex);
        std::deque<PeerMessage>& box = mail->boxes[size_t(rank)];
        if (Sleeps() && mail->isOver && !std::exchange(hasEnded, true))
            return PeerMessage{0, Pack(RankWord::End)};
        if (box.empty() || Sleeps()) return {};
        PeerMessage message = std::move(box.front());
        box.pop_front();
        return message;
    }
    void Flush() override {}
    void GiveUp(int) override {}

  private:
    bool Sleeps() const {
        return rank == mail->how.sleeper && messages >= mail->how.messagesBefore;
    }

    Mailboxes* mail;
    int rank;
    int messages = 0;  // that were sent
    bool hasEnded = false;
};

// A render as rank 0 has it in the end.
struct Shared {
    std::unique_ptr<Film> film;
    RenderResult result;
    RenderState state;  // the last that a checkpoint was shown
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

using Change = std::function<void(RenderOptions*, int rank)>;
using SourceOfRank = std::function<SampleSource(int rank)>;

inline SampleSource SameForAll(int) { return SyntheticSample; }

// Renders with `ranks` ranks; 0: without peers.
inline Shared RenderShared(int ranks, const Change& change = {}, const Shared* before = nullptr,
                           const SourceOfRank& sourceOf = SameForAll, const Habits& how = {}) {
    Shared shared;
    Mailboxes mail;
    mail.how = how;
    mail.boxes.resize(size_t(std::max(1, ranks)));
    const auto runRank = [&](int rank) {
        QueuePeers peers(&mail, rank);
        RenderOptions options = SharedOptions();
        if (ranks > 0) options.peers = &peers;
        // The least that any of them allows is what this process has for all.
        options.threads = ranks + 1;
        if (rank == 0) options.checkpoints.write = [&](const RenderState& s) { shared.state = s; };
        if (change) change(&options, rank);
        auto film = std::make_unique<Film>(
            kImage, FilmOptions{.grid = GridOf(options.schedule),
                                .withSpreads = options.lightRounds != nullptr,
                                .layers = {.aovs = {.depth = true, .object = true}}});
        if (before && rank == 0) {
            *film = *before->film;
            options.interrupted = &before->state;
        }
        options.source = sourceOf(rank);
        options.film = film.get();
        RenderResult result = Render(options);
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
    return shared;
}

}  // namespace lull::ranks_test
