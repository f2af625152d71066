#include "renderer/render/ranks/messages.h"

#include <algorithm>
#include <utility>

namespace lull {

namespace {

// Pause between looks for messages: an eighth of the time for which none has come, which bounds the
// delay, within limits that cost nothing.
constexpr std::chrono::microseconds kShortestNap{50}, kLongestNap{10000};

constexpr std::chrono::milliseconds kPatience{500};  // with ranks, to answer a Ping

}  // namespace

void RankChannel::Post(int to, std::vector<std::byte> message) {
    {
        std::lock_guard lock(mutex);
        outbox.emplace_back(to, std::move(message));
    }
    changed.notify_one();
}

void RankChannel::PostToAll(const std::vector<std::byte>& message) {
    for (int to = 0; to < Count(); ++to)
        if (to != Rank()) Post(to, message);
}

void RankChannel::Fail(std::exception_ptr exception) {
    std::lock_guard lock(mutex);
    if (!failure) failure = exception;
}

void RankChannel::AskForLife(const std::vector<int>& ranks) {
    silent.insert(ranks.begin(), ranks.end());
    silentSince = Clock::now();
    for (const int rank : ranks) Post(rank, Pack(RankWord::Ping));
}

void RankChannel::CheckLife() {
    if (silent.empty() || Clock::now() < silentSince + kPatience) return;
    if (onSilence) onSilence({silent.begin(), silent.end()});
    silent.clear();
}

std::vector<int> RankChannel::FindSilent(double quiet, double patience) {
    const auto now = Clock::now();
    const auto unseen = now - std::exchange(lastLook, now);
    const bool wasAway = unseen > std::chrono::duration<double>(quiet);
    std::vector<int> found;
    for (int rank = 0; rank < Count(); ++rank) {
        Life& life = lives[size_t(rank)];
        if (rank == Rank() || life.givenUp) continue;
        if (!life.asked && now - life.heard > std::chrono::duration<double>(quiet)) {
            life.asked = now;
            Post(rank, Pack(RankWord::Ping));
        }
        if (wasAway && life.asked) *life.asked += unseen;
        if (life.asked && now - *life.asked > std::chrono::duration<double>(patience))
            found.push_back(rank);
    }
    return found;
}

void RankChannel::GiveUp(int rank) {
    lives[size_t(rank)].givenUp = true;
    peers.GiveUp(rank);
}

void RankChannel::Exchange(const Handler& handle) {
    const bool hasSent = Send(), hasReceived = Receive(handle);
    CheckLife();
    if (hasSent || hasReceived)
        lastMessage = Clock::now();
    else
        Wait();
}

// Returns whether there was anything.
bool RankChannel::Send() {
    std::vector<std::pair<int, std::vector<std::byte>>> posted;
    {
        std::lock_guard lock(mutex);
        if (failure) std::rethrow_exception(failure);
        posted.swap(outbox);
    }
    for (auto& [to, message] : posted)
        if (!HasGivenUp(to)) peers.Send(to, std::move(message));
    return !posted.empty();
}

bool RankChannel::Receive(const Handler& handle) {
    bool any = false;
    while (const std::optional<PeerMessage> message = peers.Receive()) {
        Life& life = lives[size_t(message->from)];
        if (life.givenUp) continue;
        life.heard = Clock::now();
        life.asked.reset();
        StateReader reader(message->bytes, "a message of a rank");
        const RankWord word = reader.Get<RankWord>();
        if (word == RankWord::Ping)
            peers.Send(message->from, Pack(RankWord::Alive));
        else if (word == RankWord::Alive)
            silent.erase(message->from);
        else
            handle(message->from, word, reader);
        any = true;
    }
    return any;
}

void RankChannel::Wait() {
    const auto silence =
        std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - lastMessage);
    std::unique_lock lock(mutex);
    changed.wait_for(lock, std::clamp(silence / 8, kShortestNap, kLongestNap),
                     [&] { return !outbox.empty() || failure; });
}

namespace {

// Copies a row-major tile to its place in a row-major block.
const float* PutTile(const float* from, const PixelRect& tile, const PixelRect& block, float* to) {
    for (int y = tile.min.y(); y < tile.max.y(); ++y, from += 3 * tile.Width())
        std::copy_n(from, 3 * tile.Width(),
                    to + 3 * (size_t(y - block.min.y()) * size_t(block.Width()) +
                              size_t(tile.min.x() - block.min.x())));
    return from;
}

}  // namespace

std::vector<std::byte> PackSplats(int plane, const SplatPlane& splats) {
    return Pack(RankWord::Splats, plane,
                [&](StateWriter* writer) { splats.Put(splats.Region(), writer); });
}

std::vector<std::byte> PackPixels(int block, const std::vector<PixelRect>& tiles,
                                  const Film& film) {
    return Pack(RankWord::Pixels, block, [&](StateWriter* writer) {
        for (const PixelRect& tile : tiles) PutPlanes(film, tile, writer);
    });
}

int GetBlock(StateReader& reader, size_t blocks) {
    const int block = reader.Get<int>();
    if (block < 0 || size_t(block) >= blocks)
        throw std::runtime_error("a message of a rank is about a block that there is not");
    return block;
}

void GetPixels(StateReader& reader, const std::vector<PixelRect>& tiles, Film* film) {
    for (const PixelRect& tile : tiles) GetPlanes(&reader, tile, film);
    reader.Finish();
}

std::vector<float> MeansOf(const std::vector<PixelRect>& tiles, ViewNeed need, const Film& film) {
    std::vector<float> values;
    if (need == ViewNeed::Nothing || need == ViewNeed::Measured) return values;
    const bool withHalf = need == ViewNeed::MeanAndHalf;
    std::vector<float> halves;
    FilmView view;
    for (const PixelRect& tile : tiles) {
        film.Extract(tile, withHalf, &view);
        values.insert(values.end(), view.mean.begin(), view.mean.end());
        halves.insert(halves.end(), view.halfMean.begin(), view.halfMean.end());
    }
    values.insert(values.end(), halves.begin(), halves.end());
    return values;
}

void PutMeans(const std::vector<float>& values, const std::vector<PixelRect>& tiles,
              const PixelRect& block, FilmView* view) {
    size_t size = 0;
    for (const PixelRect& tile : tiles) size += 3 * size_t(tile.Area());
    if (values.size() != size * (view->halfMean.empty() ? 1 : 2))
        throw std::runtime_error("a rank has sent another part of a block than was asked for");
    const float* from = values.data();
    for (std::vector<float>* to : {&view->mean, &view->halfMean})
        for (const PixelRect& tile : tiles)
            if (!to->empty()) from = PutTile(from, tile, block, to->data());
}

}  // namespace lull
