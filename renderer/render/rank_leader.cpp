// Rank 0: asks the criteria, writes checkpoints, deals out tiles, and says when to end.
#include <algorithm>
#include <numeric>

#include "renderer/render/rank_deal.h"
#include "renderer/render/rank_executor_internal.h"

namespace lull {

namespace {

constexpr double leastGain = 1.1;    // of dealing out tiles anew, so that it is worth a pause
constexpr double longestPause = 20;  // times as long as a pause was is it until the next

class Leader final : public RankExecutor {
  public:
    Leader(const SampleSource& source, const RenderOptions& options, Film* film,
           const RenderState* interrupted, tbb::task_arena* arena)
        : RankExecutor(source, options, film, interrupted,
                       StartsOf(interrupted, bool(options.secondsLeft), *film), arena),
          speeds(options.peers->Count()),
          nextDeal(secondsBefore + options.dealInterval) {
        ForgetParts();
    }

    RenderResult Lead() {
        SendStart({});
        nextCheckpoint = Seconds() + options.checkpointInterval;
        for (;;) {
            pausing = false;
            EnqueueTiles();
            RunUntilPause();
            const double pause = Seconds();
            const bool undo = timeCalled && IsOver() && !IsCancelled();
            Gather(undo);
            const bool over = IsOver() && (undo || !timeCalled || IsCancelled());
            if (over || Seconds() >= nextCheckpoint) WriteCheckpoint();
            if (over) break;
            if (deal.empty() || timeCalled)
                PostToAll(Pack(RankWord::Resume));
            else
                Deal();
            nextDeal =
                Seconds() + std::max(options.dealInterval, longestPause * (Seconds() - pause));
        }
        PostToAll(Pack(RankWord::End));
        Exchange();  // sends the last word
        peers.Flush();
        RenderResult result = Result();
        for (int rank = 0; rank < ranks; ++rank)
            result.shares.push_back(double(std::ranges::count(share.deal, rank)) /
                                    double(share.deal.size()));
        return result;
    }

  private:
    void WriteCheckpoint() {
        if (options.onCheckpoint && (!schedule.Done() || options.checkpointAtEnd))
            options.onCheckpoint(State());
        nextCheckpoint = Seconds() + options.checkpointInterval;
    }

    // Deals out the tiles by `deal`, with all pixels here and nobody at work.
    void Deal() {
        const std::vector<int> before = share.deal;
        Restart(Starts(), {0, std::exchange(deal, {})});
        ForgetParts();
        SendStart(before);
        speeds.Forget();
    }

    void ForgetParts() {
        parts.assign(schedule.Blocks().size(), {});
        missing.clear();
        for (int i = 0; i < int(parts.size()); ++i) missing.push_back(PartCount(i));
    }

    // Decides on another deal, where it gains enough.
    void ThinkOfDeal() {
        if (Seconds() < nextDeal || timeCalled) return;
        std::lock_guard lock(partsMutex);
        const std::vector<double> known = speeds.Speeds(options.dealInterval / 10);
        if (known.empty()) return;
        if (GainOfDealing(known, share.deal) >= leastGain) {
            deal = DealBySpeed(known);
            pausing = true;
        }
        speeds.Forget();
        nextDeal = Seconds() + options.dealInterval;
    }

    // Tells the others where the blocks are and who has which tiles, and gives them the sums of
    // those that they did not have by the deal before.
    void SendStart(const std::vector<int>& before) {
        StartMessage message;
        message.deal = share.deal;
        const std::span<const Block> blocks = schedule.Blocks();
        for (int i = 0; i < int(blocks.size()); ++i) {
            const Block& block = blocks[size_t(i)];
            message.blocks.push_back({block.spp, block.stopped, block.stoppedByVote, block.noise,
                                      hasClock && schedule.MustEnd(i)});
            message.needs.push_back(block.stopped ? ViewNeed::Nothing
                                                  : NeedAt(i, NextSpp(block.spp)));
        }
        PostToAll(Pack(message));
        for (int rank = 1; rank < ranks && samples > 0; ++rank)
            for (int i = 0; i < int(blocks.size()); ++i) {
                const std::vector<PixelRect> tiles = NewTilesOfRank(i, rank, before);
                if (!tiles.empty()) Post(rank, PackPixels(i, tiles, *film, options.layers));
            }
        PostToAll(Pack(RankWord::Begin));
    }

    int NextSpp(int spp) const {
        return std::min(spp + options.schedule.passLength, options.schedule.cap);
    }

    int PartCount(int block) const {
        int count = 0;
        for (int rank = 0; rank < ranks; ++rank) count += !TilesOfRank(block, rank).empty();
        return count;
    }

    bool IsOver() {
        std::lock_guard lock(mutex);
        return schedule.Done() || IsCancelled() || (timeCalled && !schedule.MustGoOn());
    }

    void RunUntilPause() {
        while (!pausing && !IsOver()) {
            Exchange();
            if (hasClock && !timeCalled && !(options.secondsLeft() > 0)) {
                CallTime();
                PostToAll(Pack(RankWord::TimeUp));
            }
            if (options.onCheckpoint && Seconds() >= nextCheckpoint && HasGoneOn()) pausing = true;
            ThinkOfDeal();
            ReportProgress();
        }
    }

    // Says whether there are new samples, so that the shortest interval leads to an end.
    bool HasGoneOn() {
        std::lock_guard lock(mutex);
        return samples > samplesGathered;
    }

    // Brings everything to rest, and all pixels here.
    void Gather(bool undo) {
        quiet = collected = 0;  // now: a rank that is idle answers before Exchange() returns
        PostToAll(Pack(RankWord::Pause));
        Exchange();  // sends it
        Quiesce();
        Await(quiet);
        Quiesce();  // decisions on what has arrived
        if (undo) Undo();
        PostToAll(PackCollect(undo));
        Await(collected);
        samples = samplesGathered = film->SampleCount();
    }

    // Waits until all others have said a word. Who cancels a render may do so because one of them
    // has died, so that it is asked then.
    void Await(const int& heard) {
        while (heard < ranks - 1) {
            if (IsCancelled() && !std::exchange(hasAsked, true)) {
                std::vector<int> others(size_t(ranks) - 1);
                std::iota(others.begin(), others.end(), 1);
                AskForLife(others);
            }
            Exchange();
        }
    }

    void Handle(int from, RankWord word, StateReader& reader) override {
        if (word == RankWord::Part) {
            TakePart(from, GetPart(reader));
        } else if (word == RankWord::Pixels) {
            const int block = GetBlock(reader, parts.size());
            GetPixels(reader, TilesOfRank(block, from), film, options.layers);
        } else if (word == RankWord::Quiet) {
            ++quiet;
        } else if (word == RankWord::Collected) {
            ++collected;
        } else if (word == RankWord::Interrupted) {
            peerInterrupted = true;
        }
    }

    void TakePart(int from, PartMessage part) {
        {
            std::lock_guard lock(mutex);
            results[size_t(part.block)].seconds += part.seconds;
            samples += part.samples;
        }
        {
            std::lock_guard lock(partsMutex);
            speeds.Add(from, part.samples, part.busySeconds);
            parts[size_t(part.block)].emplace_back(from, std::move(part.values));
        }
        if (IsLastPart(part.block))
            Enqueue([this, block = part.block] { Spawn(DecideBlock(block)); });
    }

    bool IsLastPart(int block) {
        std::lock_guard lock(partsMutex);
        if (--missing[size_t(block)] > 0) return false;
        missing[size_t(block)] = PartCount(block);
        return true;
    }

    void OnPassEnd(int block) override {
        const Effort own = TakeEffort();
        {
            std::lock_guard lock(partsMutex);
            speeds.Add(0, own.samples, own.seconds);
        }
        if (IsLastPart(block)) Spawn(DecideBlock(block));
    }

    void CompleteView(int block, FilmView* view) override {
        for (const auto& [rank, values] : parts[size_t(block)])
            PutMeans(values, TilesOfRank(block, rank), schedule.Blocks()[size_t(block)].pixels,
                     view);
    }

    void OnDecided(int block, const Judgement& judgement) override {
        parts[size_t(block)].clear();
        const ViewNeed need =
            judgement.stop ? ViewNeed::Nothing : NeedAt(block, NextSpp(schedule.PassEnd(block)));
        PostToAll(Pack(AnswerMessage{block, judgement.stop, judgement.noise, need}));
    }

    std::mutex partsMutex;  // guards what follows, but for decisions, which have a block's parts
    // Of each block, what other ranks have sent of its pass, and how many ranks have still to end
    // theirs.
    std::vector<std::vector<std::pair<int, std::vector<float>>>> parts;
    std::vector<int> missing;
    RankSpeeds speeds;

    double nextDeal;               // seconds, before which nobody thinks of it
    std::vector<int> deal;         // that is to come; empty: none
    bool hasAsked = false;         // whether the others are there
    int quiet = 0, collected = 0;  // ranks that have said so
    int64_t samplesGathered = 0;   // at the last checkpoint
};

}  // namespace

RenderResult LeadRanks(const SampleSource& source, const RenderOptions& options, Film* film,
                       const RenderState* interrupted, tbb::task_arena* arena) {
    Leader leader(source, options, film, interrupted, arena);
    return leader.Guarded([&] { return leader.Lead(); });
}

}  // namespace lull
