// Rank 0: asks the criteria, writes checkpoints, and says when to end.
#include "renderer/render/rank_executor_internal.h"

namespace lull {

namespace {

class Leader final : public RankExecutor {
  public:
    Leader(const SampleSource& source, const RenderOptions& options, Film* film,
           const RenderState* interrupted, tbb::task_arena* arena)
        : RankExecutor(source, options, film, interrupted,
                       StartsOf(interrupted, bool(options.secondsLeft), *film), arena),
          parts(schedule.Blocks().size()) {
        for (int i = 0; i < int(parts.size()); ++i) missing.push_back(PartCount(i));
    }

    RenderResult Lead() {
        SendStart();
        bool over = false;
        while (!over) {
            pausing = false;
            nextCheckpoint = Seconds() + options.checkpointInterval;
            EnqueueTiles();
            RunUntilPause();
            over = IsOver();
            Gather(timeCalled && over && !IsCancelled());
            if (options.onCheckpoint && (!schedule.Done() || options.checkpointAtEnd))
                options.onCheckpoint(State());
            over |= IsOver();
            PostToAll(Pack(over ? RankWord::End : RankWord::Resume));
        }
        Exchange();  // sends the last word
        peers.Flush();
        return Result();
    }

  private:
    // Tells the others where the blocks are and, of an interrupted render, gives them their sums.
    void SendStart() {
        StartMessage message;
        const std::span<const Block> blocks = schedule.Blocks();
        for (int i = 0; i < int(blocks.size()); ++i) {
            const Block& block = blocks[size_t(i)];
            message.blocks.push_back({block.spp, block.stopped, block.stoppedByVote, block.noise,
                                      hasClock && schedule.MustEnd(i)});
            message.needs.push_back(block.stopped ? ViewNeed::Nothing
                                                  : NeedAt(i, NextSpp(block.spp)));
        }
        PostToAll(Pack(message));
        for (int rank = 1; rank < share.ranks && samples > 0; ++rank)
            for (int i = 0; i < int(blocks.size()); ++i)
                Post(rank, PackPixels(i, TilesOfRank(i, rank), *film));
        PostToAll(Pack(RankWord::Begin));
    }

    int NextSpp(int spp) const {
        return std::min(spp + options.schedule.passLength, options.schedule.cap);
    }

    int PartCount(int block) const {
        int count = 0;
        for (int rank = 0; rank < share.ranks; ++rank) count += !TilesOfRank(block, rank).empty();
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
        PostToAll(Pack(RankWord::Pause));
        Quiesce();
        quiet = collected = 0;
        while (quiet < share.ranks - 1) Exchange();
        Quiesce();  // decisions on what has arrived
        if (undo) Undo();
        PostToAll(PackCollect(undo));
        while (collected < share.ranks - 1) Exchange();
        samples = samplesGathered = film->SampleCount();
    }

    void Handle(int from, RankWord word, StateReader& reader) override {
        if (word == RankWord::Part) {
            TakePart(from, GetPart(reader));
        } else if (word == RankWord::Pixels) {
            const int block = GetBlock(reader, parts.size());
            GetPixels(reader, TilesOfRank(block, from), film);
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

    std::mutex partsMutex;
    // Of each block, what other ranks have sent of its pass, and how many ranks have still to end
    // theirs.
    std::vector<std::vector<std::pair<int, std::vector<float>>>> parts;
    std::vector<int> missing;
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
