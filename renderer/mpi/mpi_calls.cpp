#include "renderer/mpi/mpi_calls.h"

#include <climits>
#include <cmath>
#include <list>
#include <set>

#include "renderer/base/error.h"

#ifdef LULL_MPI
#include <mpi.h>
#endif

namespace lull {

#ifdef LULL_MPI

const bool hasMpi = true;

namespace {

constexpr int kTag = 0x6c;

// Returns false if it takes longer than `patience` seconds.
bool WaitFor(MPI_Request request, double patience = INFINITY) {
    for (Backoff backoff;; backoff.Wait()) {
        int done = 0;
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        if (done) return true;
        if (backoff.Seconds() > patience) return false;
    }
}

// Messages stay here until they have been sent.
class MpiPeers final : public Peers {
  public:
    MpiPeers() {
        MPI_Comm_dup(MPI_COMM_WORLD, &world);
        MPI_Comm_rank(world, &rank);
        MPI_Comm_size(world, &count);
    }
    ~MpiPeers() override {
        Flush();
        if (sent.empty()) MPI_Comm_free(&world);
    }

    int Rank() const override { return rank; }
    int Count() const override { return count; }

    void Send(int to, std::vector<std::byte> message) override {
        if (message.size() > INT_MAX)
            throw Error(
                "a block is too large to be shared by several ranks; --block makes it "
                "smaller");
        while (!sent.empty() && HasLeft(&sent.front())) sent.pop_front();
        Sent& entry = sent.emplace_back();
        entry.to = to;
        entry.message = std::move(message);
        MPI_Isend(entry.message.data(), int(entry.message.size()), MPI_BYTE, to, kTag, world,
                  &entry.request);
    }

    std::optional<PeerMessage> Receive() override {
        int isThere = 0;
        MPI_Status status;
        MPI_Iprobe(MPI_ANY_SOURCE, kTag, world, &isThere, &status);
        if (!isThere) return {};
        int size = 0;
        MPI_Get_count(&status, MPI_BYTE, &size);
        PeerMessage message{status.MPI_SOURCE, std::vector<std::byte>(size_t(size))};
        MPI_Recv(message.bytes.data(), size, MPI_BYTE, status.MPI_SOURCE, kTag, world,
                 MPI_STATUS_IGNORE);
        return message;
    }

    // A message that a rank given up has not taken must stay where it is.
    void Flush() override {
        std::erase_if(sent, [&](Sent& entry) {
            if (!givenUp.contains(entry.to)) WaitFor(entry.request);
            return !givenUp.contains(entry.to);
        });
    }
    void GiveUp(int other) override { givenUp.insert(other); }

  private:
    struct Sent {
        int to = 0;
        std::vector<std::byte> message;
        MPI_Request request = MPI_REQUEST_NULL;
    };

    static bool HasLeft(Sent* entry) {
        int done = 0;
        MPI_Test(&entry->request, &done, MPI_STATUS_IGNORE);
        return done != 0;
    }

    MPI_Comm world = MPI_COMM_NULL;
    int rank = 0, count = 1;
    std::list<Sent> sent;
    std::set<int> givenUp;
};

}  // namespace

MpiWorld StartMpi() {
    int provided = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
    MpiWorld world;
    MPI_Comm_rank(MPI_COMM_WORLD, &world.rank);
    MPI_Comm_size(MPI_COMM_WORLD, &world.count);
    if (provided < MPI_THREAD_FUNNELED) {
        MPI_Finalize();
        throw Error("this MPI does not allow for threads");
    }
    return world;
}

bool EndMpi(double patience) {
    int started = 0, ended = 0, rank = 0;
    MPI_Initialized(&started);
    MPI_Finalized(&ended);
    if (!started || ended) return true;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    // Rank 0 may be writing files for long.
    if (!WaitFor(request, rank == 0 ? patience : INFINITY)) return false;
    MPI_Finalize();
    return true;
}

void AbortMpi(int exitCode) { MPI_Abort(MPI_COMM_WORLD, exitCode); }

std::unique_ptr<Peers> MakeMpiPeers() { return std::make_unique<MpiPeers>(); }

#else

const bool hasMpi = false;

MpiWorld StartMpi() { return {}; }
bool EndMpi(double) { return true; }
void AbortMpi(int) {}
std::unique_ptr<Peers> MakeMpiPeers() { return nullptr; }

#endif

}  // namespace lull
