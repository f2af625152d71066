// Talks to a server by TCP, and never waits for it longer than it is told to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "renderer/film/display.h"

namespace lull {

class Connection {
  public:
    Connection() = default;
    ~Connection() { Close(); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    bool IsOpen() const { return socket >= 0; }
    // Connects, or says in `why` why not. Looking up a name can take as long as the system allows;
    // during the rest, `giveUp` is polled every tenth of a second.
    bool Open(const DisplayAddress&, const std::function<bool()>& giveUp, std::string* why);
    // Sends all bytes. Returns false if the connection is lost or `giveUp` returns true; it is then
    // closed.
    bool Send(std::span<const std::byte> bytes, const std::function<bool()>& giveUp,
              std::string* why);
    // Returns whether the server is still there.
    bool IsAlive();
    void Close();

  private:
    int socket = -1;
};

}  // namespace lull

namespace lull::tev {

// Writes the messages of tev's protocol (https://github.com/Tom94/tev, Ipc.h): a length of 32 bits
// that includes itself, a byte with the type, and the fields; texts end with a zero byte, and
// everything is little-endian.

// Creates an image in the viewer and shows it; one of the same name is replaced.
std::vector<std::byte> CreateImage(const std::string& name, int width, int height,
                                   std::span<const std::string> channels);

// Changes a rectangle of it, whose upper left corner is (x, y). `values` are row-major, the
// adjacent channels of a pixel.
std::vector<std::byte> UpdateImage(const std::string& name, std::span<const std::string> channels,
                                   int x, int y, int width, int height,
                                   std::span<const float> values);

}  // namespace lull::tev
