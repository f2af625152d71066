// Serialises the messages of ranks (peers.h).
#pragma once

#include "renderer/film/film.h"
#include "renderer/render/light_rounds.h"
#include "stopping/base/block_view.h"
#include "stopping/base/state.h"

namespace lull {

enum class RankWord : uint8_t {
    // From rank 0.
    Start,    // StartMessage; then come the sums of tiles that the rank did not own
    Begin,    // all of them have been sent
    Round,    // LightRound: trace your part of its light, with no tile under way
    Lit,      // it has come, by Splats: begin the passes of the round
    Answer,   // AnswerMessage
    TimeUp,   // no more passes
    Pause,    // finish the tiles under way, and say Quiet
    Collect,  // then send pixels: CollectMessage
    Resume,
    End,
    // To rank 0.
    Part,   // PartMessage
    Quiet,  // all parts have been sent
    Collected,
    Interrupted,  // a signal has come
    Traced,       // all Splats of its part have been sent; whether it is whole
    // Both ways.
    Pixels,  // sums of a block's tiles, of layers as well
    Splats,  // light of a round, of one of its planes
    Ping,    // to be answered at once by
    Alive
};

// Where all blocks are when a rank begins.
struct StartMessage {
    std::vector<int> deal;  // of the tiles, see RankTiles
    std::vector<BlockStart> blocks;
    std::vector<ViewNeed> needs;  // of criterion and clock after each block's next pass
};

// Decision on a block.
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
    // The means of its tiles, then the half means, as far as needed; empty where the sums
    // themselves are, which have been sent before.
    std::vector<float> values;
};

std::vector<std::byte> Pack(RankWord);
std::vector<std::byte> Pack(const StartMessage&);
std::vector<std::byte> Pack(const AnswerMessage&);
std::vector<std::byte> Pack(const PartMessage&);
std::vector<std::byte> PackCollect(bool undo);
std::vector<std::byte> Pack(const LightRound&);
std::vector<std::byte> PackTraced(bool isWhole);
std::vector<std::byte> PackSplats(int plane, const SplatPlane&);
std::vector<std::byte> PackPixels(int block, const std::vector<PixelRect>& tiles, const Film&);

// Read the rest of a message after its word. Throw std::runtime_error for other bytes.
StartMessage GetStart(StateReader&);
AnswerMessage GetAnswer(StateReader&);
PartMessage GetPart(StateReader&);
// Reads the number of a block, below `blocks`.
int GetBlock(StateReader&, size_t blocks);
// Reads sums of these tiles into the film.
void GetPixels(StateReader&, const std::vector<PixelRect>& tiles, Film*);

// Returns the means of tiles, pixel by pixel, then the half means if they are wanted; nothing where
// the sums are to be sent.
std::vector<float> MeansOf(const std::vector<PixelRect>& tiles, ViewNeed, const Film&);
// Puts them where they are in a view of `block`. Throws std::runtime_error if the sizes differ.
void PutMeans(const std::vector<float>& values, const std::vector<PixelRect>& tiles,
              const PixelRect& block, FilmView*);

}  // namespace lull
