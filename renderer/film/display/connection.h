// Talks to a server by TCP, and never waits for it longer than it is told to.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

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
