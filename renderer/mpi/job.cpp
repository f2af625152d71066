#include "renderer/mpi/job.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "renderer/base/error.h"
#include "renderer/mpi/mpi_calls.h"

namespace lull {

namespace {

// Returns how many processes mpirun or srun has started, from what they tell each.
int LaunchedProcesses() {
    for (const char* name :
         {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS"})
        if (const char* value = std::getenv(name)) return std::max(1, std::atoi(value));
    return 1;
}

// FNV-1a.
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

Job::Job() {
    const int launched = LaunchedProcesses();
    if (launched == 1) return;
    if (!hasMpi)
        throw Error(
            fmt::format("this is one of {} processes, which would all do the same: lull "
                        "was built without MPI",
                        launched));
    const MpiWorld world = StartMpi();
    rank = world.rank;
    count = world.count;
    if (count > 1) peers = MakeMpiPeers();
    if (rank == 0) return;
    errorOutput = dup(2);
    Silence(1);
    Silence(2);
}

Job::~Job() {
    peers.reset();
    EndMpi();
}

void Job::Begin(const std::string& what) {
    if (count == 1) return;
    if (givenUp >= 0) {
        phase = Phase::Working;
        throw Error(fmt::format("rank {} gives no sign of life; start again without it", givenUp));
    }
    const MpiAgreement all = AgreeByMpi(false, HashOf(what));
    if (all.failed >= 0) throw OtherRankFailed();
    phase = Phase::Working;
    if (all.different < 0) return;
    phase = Phase::After;  // all find the same, and end
    if (rank > 0) throw OtherRankFailed();
    throw Error(
        fmt::format("rank {} is about to render something else: the version of lull, the "
                    "scene and what it refers to have to be the same everywhere",
                    all.different));
}

void Job::EndWithout(int exitCode) {
    if (givenUp < 0) return;
    std::fflush(nullptr);
    AbortMpi(exitCode);
}

void Job::Warn(const std::string& message) const {
    const std::string line = "lull: warning: " + message + "\n";
    if (write(errorOutput, line.data(), line.size()) < 0) return;
}

void Job::Fail(const std::string& message) {
    const bool isFirst = count == 1 || phase != Phase::Before || AgreeByMpi(true, 0).failed == rank;
    if (isFirst) {
        const std::string who =
            rank > 0 ? fmt::format("rank {} on {}: ", rank, HostName()) : std::string();
        const std::string line = fmt::format("lull: error: {}{}\n", who, message);
        if (write(errorOutput, line.data(), line.size()) < 0) return;
    }
    if (phase == Phase::Working) AbortMpi(1);
}

}  // namespace lull
