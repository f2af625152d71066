#include "renderer/commands/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace lull {

namespace {

// The one global variable: a signal handler can reach nothing else. Lock-free, hence safe in a
// handler, and visible to all threads, as a plain sig_atomic_t would not be.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void OnSignal(int signal) {
    if (interrupted.exchange(true) && signal != SIGHUP) _exit(130);
}

}  // namespace

void CatchInterrupts() {
    struct sigaction action = {};
    action.sa_handler = OnSignal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    struct sigaction before = {};
    sigaction(SIGHUP, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

bool Interrupted() { return interrupted.load(std::memory_order_relaxed); }

}  // namespace lull
