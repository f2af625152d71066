#include "renderer/mpi/agreement.h"

#include <map>
#include <optional>
#include <utility>

#include "renderer/mpi/backoff.h"
#include "stopping/base/state.h"

namespace lull {

namespace {

// Comes first, so that a render ignores the message: it can be in the middle of one.
constexpr uint8_t kMark = 0xff;

struct Report {
    int32_t round;
    int32_t failed;
    uint64_t value;
};

struct Reply {
    Agreement all;
    uint64_t value;  // of rank 0
};

template <typename T>
std::vector<std::byte> Pack(const T& what) {
    StateWriter writer;
    writer.Put(kMark);
    writer.Put(what);
    return std::move(writer.bytes);
}

// Returns the next value of this type and its sender; nothing if none has arrived.
template <typename T>
std::optional<std::pair<int, T>> Receive(Peers* peers) {
    while (const std::optional<PeerMessage> message = peers->Receive()) {
        StateReader reader(message->bytes, "a message of a rank");
        if (reader.Get<uint8_t>() == kMark) return std::pair(message->from, reader.Get<T>());
    }
    return {};
}

Agreement Lead(Peers* peers, const Report& mine, double patience) {
    std::map<int, Report> reports = {{0, mine}};
    for (Backoff backoff; int(reports.size()) < peers->Count() && backoff.Seconds() < patience;) {
        const auto report = Receive<Report>(peers);
        if (!report)
            backoff.Wait();
        else if (report->second.round == mine.round)
            reports.insert(*report);
    }
    Agreement all;
    for (const auto& [rank, report] : reports) {
        if (all.failed < 0 && report.failed) all.failed = rank;
        if (all.different < 0 && report.value != mine.value) all.different = rank;
    }
    for (int rank = 1; rank < peers->Count(); ++rank) {
        Agreement heard = all;
        heard.isLate = !reports.contains(rank);
        peers->Send(rank, Pack(Reply{heard, mine.value}));
    }
    return all;
}

Agreement Follow(Peers* peers, const Report& mine) {
    peers->Send(0, Pack(mine));
    for (Backoff backoff;; backoff.Wait()) {
        const auto reply = Receive<Reply>(peers);
        if (!reply) continue;
        Agreement all = reply->second.all;
        if (all.isLate) {
            if (all.failed < 0 && mine.failed) all.failed = peers->Rank();
            if (all.different < 0 && mine.value != reply->second.value)
                all.different = peers->Rank();
        }
        return all;
    }
}

}  // namespace

Agreement Agree(Peers* peers, int round, bool failed, uint64_t value, double patience) {
    const Report mine{round, failed, value};
    return peers->Rank() == 0 ? Lead(peers, mine, patience) : Follow(peers, mine);
}

}  // namespace lull
