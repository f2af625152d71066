// One of several ranks of a render (peers.h).
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include "renderer/film/film.h"
#include "renderer/render/executor_internal.h"
#include "renderer/render/light_rounds.h"
#include "renderer/render/peers.h"
#include "stopping/base/block_view.h"
#include "stopping/base/state.h"

namespace lull {

// Serialises the messages of ranks (peers.h).

enum class RankWord : uint8_t {
    // From rank 0.
    // The deal (RankTiles), the BlockStart of each block, and the ViewNeed of criterion and clock
    // after its next pass; then come the sums of tiles that the rank did not own.
    Start,
    Begin,    // all of them have been sent
    Round,    // LightRound: trace your part of its light, with no tile under way
    Lit,      // it has come, by Splats: begin the passes of the round
    Answer,   // AnswerMessage
    TimeUp,   // no more passes
    Pause,    // finish the tiles under way, and say Quiet
    Collect,  // then send pixels; whether passes under way are undone before
    Resume,
    End,
    // To rank 0.
    // PartMessage; the means of its tiles, then the half means, as far as needed; none where the
    // sums themselves are, which have been sent before.
    Part,
    Quiet,  // all parts have been sent
    Collected,
    Interrupted,  // a signal has come
    Traced,       // all Splats of its part have been sent; whether it is whole
    // Both ways.
    Pixels,  // a block, and the sums of its tiles, of layers as well
    Splats,  // one of the planes of a round's light, and its sums
    Ping,    // to be answered at once by
    Alive
};

struct AnswerMessage {
    int block;
    bool stop;
    double noise;
    ViewNeed need;  // after its next pass
};

// The part of a block that a rank has rendered, after a pass.
struct PartMessage {
    int block;
    int64_t samples;     // taken since the last part
    double seconds;      // of processors, for this block
    double busySeconds;  // of the rank's threads, on the average, since the last part
};

inline constexpr const char* kDamagedMessage = "a message of a rank is damaged";

// Returns a message of the word and these values; functions append bytes themselves.
template <typename... Values>
std::vector<std::byte> Pack(RankWord word, const Values&... values) {
    StateWriter writer;
    const auto put = [&](const auto& value) {
        if constexpr (requires { value(&writer); })
            value(&writer);
        else if constexpr (requires { value.size(); })
            writer.PutVector(value);
        else
            writer.Put(value);
    };
    (put(word), ..., put(values));
    return std::move(writer.bytes);
}
std::vector<std::byte> PackSplats(int plane, const SplatPlane&);
std::vector<std::byte> PackPixels(int block, const std::vector<PixelRect>& tiles, const Film&);

// Read the number of a block, below `blocks`, and sums of tiles. Throw std::runtime_error.
int GetBlock(StateReader&, size_t blocks);
void GetPixels(StateReader&, const std::vector<PixelRect>& tiles, Film*);

// Returns the means of tiles, then the half means if wanted; nothing where sums are to be sent.
std::vector<float> MeansOf(const std::vector<PixelRect>& tiles, ViewNeed, const Film&);
// Puts them where they are in a view of `block`. Throws std::runtime_error if the sizes differ.
void PutMeans(const std::vector<float>& values, const std::vector<PixelRect>& tiles,
              const PixelRect& block, FilmView*);

// Transports the messages of the ranks of a render (peers.h).

// Takes messages from any thread; the one that made it sends and receives them.
class RankChannel {
  public:
    // `onSilence` is told of ranks that do not answer; it can be empty.
    RankChannel(Peers* peers, std::function<void(const std::vector<int>&)> onSilence)
        : peers(*peers), onSilence(std::move(onSilence)), lives(size_t(peers->Count())) {}

    int Rank() const { return peers.Rank(); }
    int Count() const { return peers.Count(); }

    // Leave a message to be sent. From any thread.
    void Post(int to, std::vector<std::byte> message);
    void PostToAll(const std::vector<std::byte>& message);
    // Makes Exchange() throw the first exception given. From any thread.
    void Fail(std::exception_ptr);

    // Sends posted messages and calls handle(from, word, rest of the message) for each that has
    // arrived, or waits a little if there is neither. Throws the exception of Fail().
    using Handler = std::function<void(int from, RankWord, StateReader&)>;
    void Exchange(const Handler& handle);
    void Flush() { peers.Flush(); }

    // Pings the ranks, and reports those that do not answer to `onSilence`.
    void AskForLife(const std::vector<int>& ranks);

    // Pings ranks that have been silent for `quiet` seconds, and returns those that have not
    // answered for `patience` seconds since. To be called often: the time between two calls that
    // are far apart counts as silence of no rank.
    std::vector<int> FindSilent(double quiet, double patience);
    // Sends nothing more to the rank, and discards its messages.
    void GiveUp(int rank);
    bool HasGivenUp(int rank) const { return lives[size_t(rank)].givenUp; }
    bool HasGivenUpAny() const { return std::ranges::any_of(lives, &Life::givenUp); }

  private:
    using Clock = std::chrono::steady_clock;

    struct Life {
        Clock::time_point heard = Clock::now();
        std::optional<Clock::time_point> asked;  // since it was heard
        bool givenUp = false;
    };

    bool Send();
    bool Receive(const Handler& handle);
    void CheckLife();
    void Wait();

    Peers& peers;
    const std::function<void(const std::vector<int>&)> onSilence;

    std::mutex mutex;  // guards `outbox` and `failure`
    std::condition_variable changed;
    std::vector<std::pair<int, std::vector<std::byte>>> outbox;
    std::exception_ptr failure;

    Clock::time_point lastMessage = Clock::now();
    std::set<int> silent;  // have been asked, and have not answered
    Clock::time_point silentSince;
    std::vector<Life> lives;  // of the ranks
    Clock::time_point lastLook = Clock::now();
};

// Decides which tiles each of several ranks renders, by how fast they are. Pure, without pixels.

// Returns the ranks in turn, each once.
std::vector<int> EvenDeal(int ranks);

// Returns a sequence in which each rank is as often as its speed asks for, but at least once, and
// evenly spread. Speeds are > 0, in any unit.
std::vector<int> DealBySpeed(const std::vector<double>& speeds);

// Records the work of ranks since the tiles were distributed.
class RankSpeeds {
  public:
    explicit RankSpeeds(int ranks) : efforts(size_t(ranks)) {}

    // `seconds` are those that the rank's threads took for their tiles, by the number of threads.
    void Add(int rank, int64_t samples, double seconds);
    void Forget();

    // Returns samples a second of each rank; empty while one has done nothing, or the busiest has
    // not taken `leastSeconds`.
    std::vector<double> Speeds(double leastSeconds) const;

  private:
    struct Effort {
        int64_t samples = 0;
        double seconds = 0;
    };
    std::vector<Effort> efforts;
};

// Returns how many times as fast all ranks together would be if the tiles were dealt out by their
// speeds rather than by `deal`, which goes at the pace of the slowest. At least 1.
double GainOfDealing(const std::vector<double>& speeds, const std::vector<int>& deal);

// Has an executor, whose tasks are done by the threads of the arena, and a channel, by which the
// calling thread speaks with the other ranks.
class Rank {
  public:
    Rank(const RenderOptions&, tbb::task_arena*, RankHooks);

    // Runs `work` on a thread of the arena; its exceptions are thrown by the channel's Exchange().
    void Enqueue(std::function<void()> work) { executor.tasks.Enqueue(arena, std::move(work)); }
    void EnqueueReady() {
        Enqueue([this] { executor.SpawnReady(); });
    }
    // Returns the cost of the tiles here since the last call, in samples and seconds a thread.
    TileEffort TakeEffort();
    // Returns the tiles of a block that a rank has by this deal and did not have by the one before;
    // all where that is empty.
    std::vector<PixelRect> NewTiles(int block, int rank, const std::vector<int>& before) const;

    Executor executor;
    RankChannel channel;

  private:
    const int tileSize;
    tbb::task_arena* arena;
};

// Run a render as rank 0, which decides, and as another; the arena has no place for the caller.
RenderResult LeadRanks(const RenderOptions&, tbb::task_arena*);
RenderResult FollowRanks(const RenderOptions&, tbb::task_arena*);

}  // namespace lull
