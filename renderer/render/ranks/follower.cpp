// All ranks but the first: render their tiles, and do as they are told.
#include <atomic>

#include "renderer/render/light_rounds.h"
#include "renderer/render/ranks/rank.h"

namespace lull {

namespace {

class Follower {
  public:
    Follower(const RenderOptions& options, tbb::task_arena* arena)
        : options(options),
          rank(options, arena,
               {.onPassEnd = [this](int block) { SendPart(block); },
                .completeView = {},
                .onDecided = {},
                .onException = {}}) {
        executor.pausing = true;  // until rank 0 has said where blocks are
    }

    // After an exception no task is at work.
    RenderResult Follow() try {
        bool told = false;
        while (!ended) {
            channel.Exchange(
                [this](int, RankWord word, StateReader& reader) { Handle(word, reader); });
            if (isAskedToPause && executor.tasks.IsIdle()) SayQuiet();
            if (isTraced.exchange(false)) SendSplats();
            if (told || !executor.IsCancelled()) continue;
            channel.Post(0, Pack(RankWord::Interrupted));
            if (channel.Rank() == 1) channel.AskForLife({0});  // one is enough to say so
            told = true;
        }
        executor.Quiesce();
        return executor.Result();
    } catch (...) {
        executor.Quiesce();
        throw;
    }

  private:
    void Handle(RankWord word, StateReader& reader) {
        if (word == RankWord::Answer) {
            const auto answer = reader.Get<AnswerMessage>();
            needs.at(size_t(answer.block)) = answer.need;
            const int ready = schedule.Decide(answer.block, {answer.stop, answer.noise});
            if (!executor.pausing) rank.Enqueue([this, ready] { executor.tasks.Spawn(ready); });
        } else if (word == RankWord::Round) {
            TracePart(reader.Get<LightRound>());
        } else if (word == RankWord::Splats) {
            SplatPlane& plane = options.lightRounds->Planes().at(size_t(reader.Get<int>()));
            plane.Get(plane.Region(), &reader);
        } else if (word == RankWord::Lit) {
            schedule.BeginRound(options.lightRounds->End());
            executor.pausing = false;
            rank.EnqueueReady();
        } else if (word == RankWord::Start) {
            Begin(&reader);
        } else if (word == RankWord::Pixels) {
            const int block = GetBlock(reader, needs.size());
            GetPixels(reader, rank.NewTiles(block, channel.Rank(), before), options.film);
        } else if (word == RankWord::TimeUp) {
            schedule.CallTime();
        } else if (word == RankWord::Pause) {
            executor.pausing = isAskedToPause = true;
        } else if (word == RankWord::Collect) {
            if (reader.Get<bool>())
                for (const int block : executor.Undo()) touched[size_t(block)] = true;
            SendPixels();
        } else if (word == RankWord::Resume || word == RankWord::Begin) {
            executor.pausing = false;
            rank.EnqueueReady();
        } else if (word == RankWord::End) {
            ended = true;
        }
    }

    // Not before the tiles under way are done, until which it still gives signs of life.
    void SayQuiet() {
        isAskedToPause = false;
        executor.Quiesce();
        channel.Post(0, Pack(RankWord::Quiet));
    }

    // Goes on from where rank 0 says, as soon as the sums have come. It has those of all pixels.
    void Begin(StateReader* reader) {
        auto deal = reader->GetVector<int>(kDamagedMessage);
        const auto starts = reader->GetVector<BlockStart>(kDamagedMessage);
        needs = reader->GetVector<ViewNeed>(kDamagedMessage);
        if (deal.empty() || needs.size() != starts.size())
            throw std::runtime_error(kDamagedMessage);
        if (starts.size() != schedule.Unlocked().Blocks().size())
            throw std::runtime_error("the ranks have different blocks");
        before = begun ? schedule.Share().deal : std::vector<int>();
        begun = true;
        schedule.Restart(starts, {channel.Rank(), std::move(deal)});
        executor.ledger.TakeEffort();
        touched.assign(needs.size(), false);
    }

    void TracePart(const LightRound& round) {
        // Those of a round that was interrupted go on.
        if (options.lightRounds->End() > 0) options.film->ForgetSpreads();
        options.lightRounds->Begin(round);
        rank.Enqueue([this] {
            isWhole = options.lightRounds->Trace([this] { return executor.IsCancelled(); },
                                                 channel.Rank(), channel.Count());
            isTraced = true;
        });
    }

    void SendSplats() {
        for (size_t i = 0; i < options.lightRounds->Planes().size(); ++i)
            channel.Post(0, PackSplats(int(i), options.lightRounds->Planes()[i]));
        channel.Post(0, Pack(RankWord::Traced, isWhole));
    }

    void SendPart(int block) {
        const std::vector<PixelRect> tiles = schedule.TilesOfRank(block, channel.Rank());
        const TileEffort taken = rank.TakeEffort();
        const PartMessage part{block, taken.samples, executor.ledger.TakeSeconds(block),
                               taken.seconds};
        touched[size_t(block)] = true;
        if (needs[size_t(block)] == ViewNeed::Measured)
            channel.Post(0, PackPixels(block, tiles, *options.film));
        channel.Post(
            0, Pack(RankWord::Part, part, MeansOf(tiles, needs[size_t(block)], *options.film)));
    }

    void SendPixels() {
        for (int i = 0; i < int(touched.size()); ++i) {
            const bool isUnderWay = !schedule.BlockAt(i).stopped;
            if (!touched[size_t(i)] && !isUnderWay) continue;
            touched[size_t(i)] = false;
            const std::vector<PixelRect> tiles = schedule.TilesOfRank(i, channel.Rank());
            if (!tiles.empty()) channel.Post(0, PackPixels(i, tiles, *options.film));
        }
        channel.Post(0, Pack(RankWord::Collected));
    }

    const RenderOptions& options;
    Rank rank;
    Executor& executor = rank.executor;
    LiveSchedule& schedule = executor.schedule;
    RankChannel& channel = rank.channel;

    std::vector<ViewNeed> needs;
    std::vector<char> touched;  // blocks that had a pass since their pixels were sent
    std::vector<int> before;    // the deal before this one
    bool begun = false, isAskedToPause = false, ended = false;
    std::atomic<bool> isTraced = false;  // its part of the round's light, and not yet sent
    bool isWhole = false;                // that was not interrupted
};

}  // namespace

RenderResult FollowRanks(const RenderOptions& asked, tbb::task_arena* arena) {
    RenderOptions options = asked;
    options.interrupted = nullptr;
    options.checkpoints = {};
    options.makeCriterion = nullptr;
    options.events = {};
    options.events.onSilence = asked.events.onSilence;
    return Follower(options, arena).Follow();
}

}  // namespace lull
