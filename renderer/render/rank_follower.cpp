// All ranks but the first: render their tiles, and do as they are told.
#include <thread>

#include "renderer/render/rank_executor_internal.h"

namespace lull {

namespace {

class Follower final : public RankExecutor {
  public:
    Follower(const SampleSource& source, const RenderOptions& options, Film* film,
             const StartMessage& start, tbb::task_arena* arena)
        : RankExecutor(source, options, film, nullptr, start.blocks, arena),
          needs(start.needs),
          touched(start.needs.size()) {
        samples = 0;  // rank 0 knows of those before
    }

    RenderResult Follow() {
        EnqueueTiles();
        bool told = false;
        while (!ended) {
            Exchange();
            if (told || !IsCancelled()) continue;
            Post(0, Pack(RankWord::Interrupted));
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
        } else if (word == RankWord::TimeUp) {
            CallTime();
        } else if (word == RankWord::Pause) {
            Quiesce();
            Post(0, Pack(RankWord::Quiet));
        } else if (word == RankWord::Collect) {
            if (reader.Get<uint8_t>()) UndoPasses();
            SendPixels();
        } else if (word == RankWord::Resume) {
            pausing = false;
            EnqueueTiles();
        } else if (word == RankWord::End) {
            ended = true;
        }
    }

    void OnPassEnd(int block) override {
        const std::vector<PixelRect> tiles = TilesOfRank(block, share.rank);
        PartMessage part{block, 0, 0, MeansOf(tiles, needs[size_t(block)], *film)};
        {
            std::lock_guard lock(mutex);
            part.samples = std::exchange(samples, 0);
            part.seconds = std::exchange(results[size_t(block)].seconds, 0);
        }
        touched[size_t(block)] = true;
        Post(0, Pack(part));
    }

    void UndoPasses() {
        for (const int block : undo.UndoAll(film)) touched[size_t(block)] = true;
    }

    // Sends what has changed since the last time, or may have.
    void SendPixels() {
        for (int i = 0; i < int(touched.size()); ++i) {
            const bool isUnderWay = !schedule.Blocks()[size_t(i)].stopped;
            if (!touched[size_t(i)] && !isUnderWay) continue;
            touched[size_t(i)] = false;
            const std::vector<PixelRect> tiles = TilesOfRank(i, share.rank);
            if (!tiles.empty()) Post(0, PackPixels(i, tiles, *film));
        }
        Post(0, Pack(RankWord::Collected));
    }

    std::vector<ViewNeed> needs;
    std::vector<char> touched;  // blocks that had a pass since their pixels were sent
    bool ended = false;
};

// Returns the next message, when it comes.
PeerMessage WaitForMessage(Peers& peers) {
    for (;;) {
        if (std::optional<PeerMessage> message = peers.Receive()) return std::move(*message);
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
}

}  // namespace

RenderResult FollowRanks(const SampleSource& source, const RenderOptions& given, Film* film,
                         tbb::task_arena* arena) {
    RenderOptions options = given;
    options.makeCriterion = nullptr;
    options.onProgress = nullptr;
    options.onCheckpoint = nullptr;
    const std::vector<Block> blocks = MakeBlocks(film->Region(), options.schedule);
    const TileShare share{options.peers->Rank(), options.peers->Count()};
    StartMessage start;
    for (;;) {
        const PeerMessage message = WaitForMessage(*options.peers);
        StateReader reader(message.bytes);
        const RankWord word = reader.Get<RankWord>();
        if (word == RankWord::Begin) break;
        if (word == RankWord::Start) start = GetStart(reader);
        if (word != RankWord::Pixels) continue;
        const int block = GetBlock(reader, blocks.size());
        GetPixels(reader,
                  TilesOf(blocks[size_t(block)].pixels, block, options.schedule.tileSize, share),
                  film);
    }
    if (start.blocks.size() != blocks.size())
        throw std::runtime_error("the ranks have different blocks");
    Follower follower(source, options, film, start, arena);
    return follower.Guarded([&] { return follower.Follow(); });
}

}  // namespace lull
