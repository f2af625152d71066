#include "renderer/film/display.h"

#include <fmt/format.h>

#include <atomic>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <thread>

#include "renderer/base/clocks.h"
#include "renderer/base/error.h"
#include "renderer/film/display/viewer.h"

namespace lull {

namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

const std::vector<std::string> kChannelNames = {"R", "G", "B", "spp", "stop"};
constexpr Seconds kShortestRest{0.1}, kTimeToConnect{5}, kTimeBetweenTries{3};
constexpr double kRestPerWork = 200;

}  // namespace

DisplayAddress ParseDisplayAddress(const std::string& text) {
    const size_t colon = text.rfind(':');
    if (colon == std::string::npos) throw Error(text + " is not HOST:PORT");
    DisplayAddress address{text.substr(0, colon), text.substr(colon + 1)};
    std::string& host = address.host;
    if (host.size() >= 2 && host.front() == '[' && host.back() == ']')
        host = host.substr(1, host.size() - 2);
    else if (host.find(':') != std::string::npos)
        throw Error(text + " is not HOST:PORT; put an address with colons in brackets");
    int port = 0;
    const char* const end = address.port.data() + address.port.size();
    const auto [at, error] = std::from_chars(address.port.data(), end, port);
    if (host.empty() || error != std::errc() || at != end || port < 1 || port > 65535)
        throw Error(text + " is not HOST:PORT, with a port from 1 to 65535");
    return address;
}

// Shared by the thread, so that a slow look-up of a name does not block.
struct Display::State {
    State(const DisplayAddress& address, const std::string& name, const PixelRect& region,
          std::function<void(const std::string&)> warn)
        : address(address), name(name), region(region), warn(std::move(warn)), snapshot(region) {}

    void Run() {
        Connection connection;
        while (!GivesUp()) {
            if (!connection.IsOpen() && !Connect(&connection)) {
                if (Rest(kTimeBetweenTries)) break;
                continue;
            }
            const bool wasEnded = ended;
            const double start = ThreadSeconds();
            SendChanges(&connection);
            const double worked = ThreadSeconds() - start;
            if (wasEnded) break;
            Rest(std::max(kShortestRest, Seconds(kRestPerWork * worked)));
        }
        std::lock_guard lock(mutex);
        over = true;
        changed.notify_all();
    }

    bool Connect(Connection* connection) {
        const Clock::time_point begin = Clock::now();
        std::string why;
        const bool isThere = connection->Open(
            address, [&] { return ended || Clock::now() - begin > kTimeToConnect; }, &why);
        if (!isThere) return Warn(why);
        snapshot.ShowAllAgain();
        return Send(connection,
                    tev::CreateImage(name, region.Width(), region.Height(), kChannelNames));
    }

    void SendChanges(Connection* connection) {
        if (!connection->IsAlive()) {
            connection->Close();
            Warn("the viewer has gone");
            return;
        }
        while (snapshot.Take(&update)) {
            const PixelRect& r = update.pixels;
            if (!Send(connection, tev::UpdateImage(name, kChannelNames, r.min.x(), r.min.y(),
                                                   r.Width(), r.Height(), update.values)))
                return;
        }
    }

    bool Send(Connection* connection, const std::vector<std::byte>& message) {
        std::string why;
        return connection->Send(
                   message, [&] { return GivesUp(); }, &why) ||
               Warn(why);
    }

    // Returns false.
    bool Warn(const std::string& why) {
        if (!hasWarned && !ended)
            warn(
                fmt::format("no viewer at {}:{}: {}; the render continues and retries now and "
                            "then",
                            address.host, address.port, why));
        hasWarned = true;
        return false;
    }

    bool GivesUp() {
        std::lock_guard lock(mutex);
        return ended && Clock::now() >= deadline;
    }

    bool Rest(Seconds time) {
        std::unique_lock lock(mutex);
        changed.wait_for(lock, time, [&] { return bool(ended); });
        return ended;
    }

    void End(Seconds time) {
        std::unique_lock lock(mutex);
        if (ended) return;
        deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
        ended = true;
        changed.notify_all();
        // Beyond it, for a transfer under way.
        changed.wait_for(lock, time + Seconds(0.5), [&] { return over; });
    }

    const DisplayAddress address;
    const std::string name;
    const PixelRect region;
    const std::function<void(const std::string&)> warn;
    Snapshot snapshot;
    Snapshot::Update update;
    bool hasWarned = false;

    std::mutex mutex;  // guards the members below
    std::condition_variable changed;
    std::atomic<bool> ended = false;
    bool over = false;
    Clock::time_point deadline;
};

Display::Display(const DisplayAddress& address, const std::string& name, const PixelRect& region,
                 std::function<void(const std::string&)> warn)
    : state(std::make_shared<State>(address, name, region, std::move(warn))) {
    std::thread([state = state] {
        try {
            state->Run();
        } catch (const std::exception&) {
            // Out of memory even for this: the render will report that itself.
        }
    }).detach();
}

Display::~Display() { state->End(Seconds(0)); }

void Display::Show(const PixelRect& pixels, const Film& film) {
    state->snapshot.Show(pixels, film);
}

void Display::ShowDenoised(const PixelRect& pixels, std::span<const float> rgb) {
    state->snapshot.ShowDenoised(pixels, rgb);
}

void Display::ShowStop(const PixelRect& block) { state->snapshot.ShowStop(block); }

void Display::Finish(double seconds) { state->End(Seconds(seconds)); }

}  // namespace lull
