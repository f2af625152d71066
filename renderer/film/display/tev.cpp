#include "renderer/film/display/tev.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>

namespace lull {

namespace {

constexpr int kPatience = 100;  // milliseconds between two questions whether to give up

// Waits until the socket can be written to. Returns an errno, 0 for success.
int WaitToWrite(int socket, const std::function<bool()>& giveUp) {
    for (;;) {
        pollfd wanted{socket, POLLOUT, 0};
        const int ready = poll(&wanted, 1, kPatience);
        if (ready > 0) return 0;
        if (ready < 0 && errno != EINTR) return errno;
        if (giveUp()) return ETIMEDOUT;
    }
}

// Returns an errno, 0 for success.
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

class Message {
  public:
    explicit Message(Kind kind) {
        Put(uint32_t(0));
        Put(kind);
    }
    template <typename T>
    void Put(const T& value) {
        PutAll(std::span(&value, 1));
    }
    template <typename T>
    void PutAll(std::span<T> values) {
        const auto more = std::as_bytes(values);
        bytes.insert(bytes.end(), more.begin(), more.end());
    }
    void Text(const std::string& text) {
        PutAll(std::span<const char>(text.c_str(), std::strlen(text.c_str()) + 1));
    }
    std::vector<std::byte> Finish() {
        const uint32_t size = uint32_t(bytes.size());
        std::memcpy(bytes.data(), &size, sizeof size);
        return std::move(bytes);
    }

  private:
    std::vector<std::byte> bytes;
};

}  // namespace

std::vector<std::byte> CreateImage(const std::string& name, int width, int height,
                                   std::span<const std::string> channels) {
    Message message(Kind::CreateImage);
    message.Put(uint8_t(1));  // come to the front
    message.Text(name);
    message.Put(int32_t(width));
    message.Put(int32_t(height));
    message.Put(int32_t(channels.size()));
    for (const std::string& channel : channels) message.Text(channel);
    return message.Finish();
}

std::vector<std::byte> UpdateImage(const std::string& name, std::span<const std::string> channels,
                                   int x, int y, int width, int height,
                                   std::span<const float> values) {
    Message message(Kind::UpdateImageV3);
    message.Put(uint8_t(0));  // stay where it is
    message.Text(name);
    message.Put(int32_t(channels.size()));
    for (const std::string& channel : channels) message.Text(channel);
    for (const int n : {x, y, width, height}) message.Put(int32_t(n));
    // Where each channel begins, and how far apart its values are.
    for (size_t c = 0; c < channels.size(); ++c) message.Put(int64_t(c));
    for (size_t c = 0; c < channels.size(); ++c) message.Put(int64_t(channels.size()));
    message.PutAll(values);
    return message.Finish();
}

}  // namespace lull::tev
