#include "renderer/film/display/viewer.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>
#include <utility>

namespace lull {

namespace {

int Cells(int pixels) { return (pixels + Snapshot::kCell - 1) / Snapshot::kCell; }

PixelRect Union(const PixelRect& a, const PixelRect& b) {
    if (a.Area() == 0) return b;
    return {a.min.cwiseMin(b.min), a.max.cwiseMax(b.max)};
}

PixelRect Intersection(const PixelRect& a, const PixelRect& b) {
    return {a.min.cwiseMax(b.min), a.max.cwiseMin(b.max)};
}

PixelRect Moved(const PixelRect& r, const Vec2i& by) { return {r.min - by, r.max - by}; }

}  // namespace

Snapshot::Snapshot(const PixelRect& region)
    : region(region),
      width(region.Width()),
      columns(Cells(region.Width())),
      rows(Cells(region.Height())),
      values(size_t(region.Area()) * kChannels),
      denoised(size_t(region.Area())),
      changed(size_t(columns) * size_t(rows)),
      shown(changed.size()) {}

void Snapshot::Mark(const PixelRect& pixels) {
    for (int j = pixels.min.y() / kCell; j < Cells(pixels.max.y()); ++j)
        for (int i = pixels.min.x() / kCell; i < Cells(pixels.max.x()); ++i) {
            const PixelRect cell = {{i * kCell, j * kCell}, {(i + 1) * kCell, (j + 1) * kCell}};
            PixelRect& of = changed[size_t(j) * size_t(columns) + size_t(i)];
            of = Union(of, Intersection(pixels, cell));
        }
}

void Snapshot::Show(const PixelRect& pixels, const Film& film) {
    const PixelRect r = Moved(pixels, region.min);
    std::lock_guard lock(mutex);
    for (int y = r.min.y(); y < r.max.y(); ++y)
        for (int x = r.min.x(); x < r.max.x(); ++x) {
            const Vec2i p = region.min + Vec2i(x, y);
            const Rgb mean = film.MeanAt(p);
            float* to = At(x, y);
            for (int c = 0; c < 3 && !denoised[Index(x, y)]; ++c) to[c] = mean[c];
            to[3] = float(film.At(p).count);
        }
    Mark(r);
}

void Snapshot::ShowDenoised(const PixelRect& pixels, std::span<const float> rgb) {
    const PixelRect r = Moved(pixels, region.min);
    const float* from = rgb.data();
    std::lock_guard lock(mutex);
    for (int y = r.min.y(); y < r.max.y(); ++y)
        for (int x = r.min.x(); x < r.max.x(); ++x, from += 3) {
            std::copy_n(from, 3, At(x, y));
            denoised[Index(x, y)] = true;
        }
    Mark(r);
}

void Snapshot::ShowStop(const PixelRect& block) {
    const PixelRect r = Moved(block, region.min);
    std::lock_guard lock(mutex);
    for (int y = r.min.y(); y < r.max.y(); ++y)
        for (int x = r.min.x(); x < r.max.x(); ++x) At(x, y)[4] = 1;
    Mark(r);
}

void Snapshot::ShowAllAgain() {
    std::lock_guard lock(mutex);
    for (size_t i = 0; i < changed.size(); ++i)
        if (shown[i].Area() > 0) changed[i] = Union(changed[i], shown[i]);
}

bool Snapshot::Take(Update* update) {
    std::lock_guard lock(mutex);
    for (size_t tried = 0; tried < changed.size(); ++tried) {
        const size_t cell = next;
        next = (next + 1) % changed.size();
        if (changed[cell].Area() == 0) continue;
        const PixelRect r = update->pixels = std::exchange(changed[cell], PixelRect());
        shown[cell] = Union(shown[cell], r);
        update->values.clear();
        for (int y = r.min.y(); y < r.max.y(); ++y)
            update->values.insert(update->values.end(), At(r.min.x(), y),
                                  At(r.min.x(), y) + size_t(r.Width()) * kChannels);
        return true;
    }
    return false;
}

namespace {

constexpr int kPatience = 100;  // milliseconds between two questions whether to give up

int WaitToWrite(int socket, const std::function<bool()>& giveUp) {
    for (;;) {
        pollfd wanted{socket, POLLOUT, 0};
        const int ready = poll(&wanted, 1, kPatience);
        if (ready > 0) return 0;
        if (ready < 0 && errno != EINTR) return errno;
        if (giveUp()) return ETIMEDOUT;
    }
}

int Connect(int socket, const addrinfo& address, const std::function<bool()>& giveUp) {
    if (connect(socket, address.ai_addr, address.ai_addrlen) == 0) return 0;
    if (errno != EINPROGRESS) return errno;
    if (const int error = WaitToWrite(socket, giveUp)) return error;
    int error = 0;
    socklen_t size = sizeof error;
    getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size);
    return error;
}

}  // namespace

bool Connection::Open(const DisplayAddress& address, const std::function<bool()>& giveUp,
                      std::string* why) {
    Close();
    addrinfo hints = {}, *addresses = nullptr;
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    if (const int error =
            getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &addresses)) {
        *why = gai_strerror(error);
        return false;
    }
    int error = 0;
    for (const addrinfo* a = addresses; a && !IsOpen(); a = a->ai_next) {
        const int made =
            ::socket(a->ai_family, a->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, a->ai_protocol);
        error = made < 0 ? errno : Connect(made, *a, giveUp);
        if (error == 0)
            socket = made;
        else if (made >= 0)
            ::close(made);
    }
    freeaddrinfo(addresses);
    if (!IsOpen()) *why = std::strerror(error);
    return IsOpen();
}

bool Connection::Send(std::span<const std::byte> bytes, const std::function<bool()>& giveUp,
                      std::string* why) {
    while (!bytes.empty()) {
        const ssize_t sent = send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        int error = 0;
        if (sent >= 0)
            bytes = bytes.subspan(size_t(sent));
        else if (errno == EAGAIN || errno == EWOULDBLOCK)
            error = WaitToWrite(socket, giveUp);
        else if (errno != EINTR)
            error = errno;
        if (error == 0) continue;
        *why = std::strerror(error);
        Close();
        return false;
    }
    return true;
}

bool Connection::IsAlive() {
    char ignored[256];
    for (;;) {
        const ssize_t got = recv(socket, ignored, sizeof ignored, MSG_DONTWAIT);
        if (got > 0) continue;  // viewers have nothing to say
        return got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
    }
}

void Connection::Close() {
    if (socket >= 0) ::close(socket);
    socket = -1;
}

}  // namespace lull

namespace lull::tev {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they are");

enum class Kind : uint8_t { CreateImage = 4, UpdateImageV3 = 6 };

StateWriter Begin(Kind kind) {
    StateWriter message;
    message.Put(uint32_t(0));  // the size
    message.Put(kind);
    return message;
}

void PutText(const std::string& text, StateWriter* message) {
    message->PutAll(std::span<const char>(text.c_str(), std::strlen(text.c_str()) + 1));
}

std::vector<std::byte> Finish(StateWriter message) {
    const uint32_t size = uint32_t(message.bytes.size());
    std::memcpy(message.bytes.data(), &size, sizeof size);
    return std::move(message.bytes);
}

}  // namespace

std::vector<std::byte> CreateImage(const std::string& name, int width, int height,
                                   std::span<const std::string> channels) {
    StateWriter message = Begin(Kind::CreateImage);
    message.Put(uint8_t(1));  // come to the front
    PutText(name, &message);
    message.Put(int32_t(width));
    message.Put(int32_t(height));
    message.Put(int32_t(channels.size()));
    for (const std::string& channel : channels) PutText(channel, &message);
    return Finish(std::move(message));
}

std::vector<std::byte> UpdateImage(const std::string& name, std::span<const std::string> channels,
                                   int x, int y, int width, int height,
                                   std::span<const float> values) {
    StateWriter message = Begin(Kind::UpdateImageV3);
    message.Put(uint8_t(0));  // stay where it is
    PutText(name, &message);
    message.Put(int32_t(channels.size()));
    for (const std::string& channel : channels) PutText(channel, &message);
    for (const int n : {x, y, width, height}) message.Put(int32_t(n));
    // Where each channel begins, and how far apart its values are.
    for (size_t c = 0; c < channels.size(); ++c) message.Put(int64_t(c));
    for (size_t c = 0; c < channels.size(); ++c) message.Put(int64_t(channels.size()));
    message.PutAll(values);
    return Finish(std::move(message));
}

}  // namespace lull::tev
