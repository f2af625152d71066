// Transports the messages of the ranks of a render (peers.h).
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <set>

#include "renderer/render/peers.h"
#include "renderer/render/ranks/messages.h"

namespace lull {

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
    // Waits until all messages have left.
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

    // State of another rank.
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

}  // namespace lull
