#include "renderer/mpi/job.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/mpi/mpi_calls.h"
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

namespace {

// Seconds that ranks are waited for.
constexpr double kLeastPatience = 5, kMostPatience = 60;

int LaunchedProcesses() {
    for (const char* name :
         {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS"})
        if (const char* value = std::getenv(name)) return std::max(1, std::atoi(value));
    return 1;
}

uint64_t HashOf(const std::string& text) {
    uint64_t hash = 0xcbf29ce484222325;
    for (const char c : text) hash = (hash ^ uint8_t(c)) * 0x100000001b3;
    return hash;
}

void Silence(int stream) {
    const int nowhere = open("/dev/null", O_WRONLY);
    if (nowhere < 0) return;
    dup2(nowhere, stream);
    close(nowhere);
}

std::string HostName() {
    char name[256] = {};
    gethostname(name, sizeof name - 1);
    return name;
}

}  // namespace

MpiJob::MpiJob() {
    const int launched = LaunchedProcesses();
    if (launched == 1) return;
    if (!hasMpi)
        throw Error(
            "this is one of {} processes, which would all do the same: lull was built without MPI",
            launched);
    const MpiWorld world = StartMpi();
    rank = world.rank;
    count = world.count;
    if (count > 1) peers = MakeMpiPeers();
    if (rank == 0) return;
    errorOutput = dup(2);
    Silence(1);
    Silence(2);
}

// A rank that has left is not waited for again.
MpiJob::~MpiJob() {
    peers.reset();
    EndMpi(kLeastPatience);
}

double MpiJob::Patience() const {
    const std::chrono::duration<double> busy = std::chrono::steady_clock::now() - start;
    const double patience =
        clock ? std::clamp(clock() / 10, kLeastPatience, kMostPatience) : kMostPatience;
    return std::max(patience, busy.count());
}

Agreement MpiJob::AgreeWithOthers(bool failed, uint64_t value) {
    return Agree(peers.get(), ++rounds, failed, value, Patience());
}

void MpiJob::Begin(const std::string& what) {
    if (count == 1) return;
    if (givenUp >= 0) {
        phase = Phase::Working;
        throw Error("rank {} gives no sign of life; start again without it", givenUp);
    }
    const Agreement all = AgreeWithOthers(false, HashOf(what));
    if (all.failed >= 0) throw OtherRankFailed();
    phase = Phase::Working;
    if (all.different < 0) return;
    if (!all.isLate) {
        phase = Phase::After;  // all find the same, and end
        if (rank > 0) throw OtherRankFailed();
    }
    throw Error(
        "rank {} is about to render something else: the version of lull, the scene and its files "
        "have to be the same everywhere",
        all.different);
}

void MpiJob::End() {
    phase = Phase::After;
    start = std::chrono::steady_clock::now();
}

void MpiJob::Leave(int exitCode) {
    std::fflush(nullptr);  // an abort would not
    if (givenUp < 0) {
        peers.reset();
        if (EndMpi(kMostPatience)) return;
    }
    AbortMpi(exitCode);
}

void MpiJob::Warn(const std::string& message) const {
    const std::string line = wording("warning", message);
    if (write(errorOutput, line.data(), line.size()) < 0) return;
}

void MpiJob::Fail(const std::string& message) {
    bool isFirst = true;
    if (count > 1 && phase == Phase::Before) {
        const Agreement all = AgreeWithOthers(true, 0);
        isFirst = all.failed == rank;
        if (all.isLate) phase = Phase::Working;
    }
    if (isFirst) {
        const std::string who =
            rank > 0 ? fmt::format("rank {} on {}: ", rank, HostName()) : std::string();
        std::string lines, line;
        for (std::istringstream rest(message); std::getline(rest, line);)
            lines += wording("error", who + line);
        if (write(errorOutput, lines.data(), lines.size()) < 0) return;
    }
    if (phase == Phase::Working) AbortMpi(1);
}

}  // namespace lull
