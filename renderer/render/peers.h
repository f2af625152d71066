// Lets several processes share a render.
//
// Each rank has the same scene and the same options. The tiles of every block are dealt out
// (RankTiles in schedule.h), so that the last live block still has all ranks; a pixel's samples are
// summed by the rank that owns it and by nobody else, in the order of their indices. Hence the
// image is the same bits for any number of ranks.
//
//     rank 0                                    rank r
//       Start: where blocks are, who has     ->   renders its tiles of a block's pass
//       which tiles, their sums; Begin
//       asks the criterion when the parts    <-   Part: the means of its pixels; or before
//       of all ranks are there                    it Pixels, their sums, where the rule looks
//                                                 at more than means
//       Answer: stop or continue                ->   begins the block's next pass
//
// No rank waits for another block. To write a checkpoint, to reassign the tiles, or to end,
// rank 0 says
//
//       Pause                                ->   finishes the tiles under way
//       (asks for blocks that are complete)  <-   Quiet
//       Collect                              ->
//       has all pixels, writes the files     <-   Pixels ..., Collected
//       Resume, End, or Start                ->
//
// With Start, tiles go to where there is time: the sums of those that have another owner are sent
// to it, and it adds to them as the one before would have.
//
// Where light is traced in rounds, all pixels go to rank 0 at the end of one, which learns from
// them, and says Round. Each rank traces a part of the light, and has that of all others by Splats
// before the passes of the round begin.
//
// Rank 0 pings ranks that are silent. A rank that does not answer for long is given up: its tiles
// go to the others, which repeat its samples from the sums that rank 0 has.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace lull {

struct PeerMessage {
    int from = 0;
    std::vector<std::byte> bytes;
};

// Carries messages between the ranks. Used by one thread.
class Peers {
  public:
    virtual ~Peers() = default;
    virtual int Rank() const = 0;   // 0 decides
    virtual int Count() const = 0;  // > 0
    // Sends without waiting. Messages from one rank to another arrive in order.
    virtual void Send(int to, std::vector<std::byte> message) = 0;
    // Returns the next message that has arrived; nothing if there is none.
    virtual std::optional<PeerMessage> Receive() = 0;
    // Waits until all messages have left, except those to ranks given up.
    virtual void Flush() = 0;
    // Nothing more is sent to this rank, and nothing waits for it any more.
    virtual void GiveUp(int rank) = 0;
};

}  // namespace lull
