// All ranks but the first: render their tiles, and do as they are told.
#include "renderer/render/rank_executor_internal.h"

namespace lull {

namespace {

class Follower final : public RankExecutor {
  public:
    Follower(const SampleSource& source, const RenderOptions& options, Film* film,
             tbb::task_arena* arena)
        : RankExecutor(source, options, film, nullptr, {}, arena) {
        pausing = true;  // until rank 0 has said where blocks are
    }

    RenderResult Follow() {
        bool told = false;
        while (!ended) {
            Exchange();
            if (told || !IsCancelled()) continue;
            Post(0, Pack(RankWord::Interrupted));
            if (share.rank == 1) AskForLife({0});  // one is enough to say so
            told = true;
        }
        Quiesce();
        return Result();
    }

  private:
    void Handle(int, RankWord word, StateReader& reader) override {
        if (word == RankWord::Answer) {
            const AnswerMessage answer = GetAnswer(reader);
            needs.at(size_t(answer.block)) = answer.need;
            const int ready = Decide(answer.block, {answer.stop, answer.noise});
            if (!pausing) Enqueue([this, ready] { Spawn(ready); });
        } else if (word == RankWord::Start) {
            Begin(GetStart(reader));
        } else if (word == RankWord::Pixels) {
            const int block = GetBlock(reader, needs.size());
            GetPixels(reader, NewTilesOfRank(block, share.rank, before), film, options.layers);
        } else if (word == RankWord::TimeUp) {
            CallTime();
        } else if (word == RankWord::Pause) {
            Quiesce();
            Post(0, Pack(RankWord::Quiet));
        } else if (word == RankWord::Collect) {
            if (reader.Get<uint8_t>()) UndoPasses();
            SendPixels();
        } else if (word == RankWord::Resume || word == RankWord::Begin) {
            pausing = false;
            EnqueueTiles();
        } else if (word == RankWord::End) {
            ended = true;
        }
    }

    // Goes on from where rank 0 says, as soon as the sums have come. It has those of all pixels.
    void Begin(StartMessage start) {
        if (start.blocks.size() != schedule.Blocks().size())
            throw std::runtime_error("the ranks have different blocks");
        before = begun ? share.deal : std::vector<int>();
        begun = true;
        Restart(start.blocks, {share.rank, std::move(start.deal)});
        needs = std::move(start.needs);
        touched.assign(needs.size(), false);
    }

    void OnPassEnd(int block) override {
        const std::vector<PixelRect> tiles = TilesOfRank(block, share.rank);
        const Effort taken = TakeEffort();
        PartMessage part{block, taken.samples, 0, taken.seconds,
                         MeansOf(tiles, needs[size_t(block)], *film)};
        {
            std::lock_guard lock(mutex);
            part.seconds = std::exchange(results[size_t(block)].seconds, 0);
        }
        touched[size_t(block)] = true;
        Post(0, Pack(part));
    }

    void UndoPasses() {
        for (const int block : undo.UndoAll(film, options.layers)) touched[size_t(block)] = true;
    }

    // Sends what has changed since the last time, or may have.
    void SendPixels() {
        for (int i = 0; i < int(touched.size()); ++i) {
            const bool isUnderWay = !schedule.Blocks()[size_t(i)].stopped;
            if (!touched[size_t(i)] && !isUnderWay) continue;
            touched[size_t(i)] = false;
            const std::vector<PixelRect> tiles = TilesOfRank(i, share.rank);
            if (!tiles.empty()) Post(0, PackPixels(i, tiles, *film, options.layers));
        }
        Post(0, Pack(RankWord::Collected));
    }

    std::vector<ViewNeed> needs;
    std::vector<char> touched;  // blocks that had a pass since their pixels were sent
    std::vector<int> before;    // the deal before this one
    bool begun = false, ended = false;
};

}  // namespace

RenderResult FollowRanks(const SampleSource& source, const RenderOptions& given, Film* film,
                         tbb::task_arena* arena) {
    RenderOptions options = given;
    options.makeCriterion = nullptr;
    options.onProgress = nullptr;
    options.onCheckpoint = nullptr;
    Follower follower(source, options, film, arena);
    return follower.Guarded([&] { return follower.Follow(); });
}

}  // namespace lull
