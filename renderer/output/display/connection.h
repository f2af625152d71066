// Speaks to a server by TCP, without ever waiting for it longer than it is told to.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>

#include "renderer/output/display.h"

namespace lull {

class Connection {
  public:
    Connection() = default;
    ~Connection() { Close(); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    bool IsOpen() const { return socket >= 0; }
    // Connects, or says in `why` why not. Looking up a name can take as long as the system lets
    // it; of the rest, `giveUp` is asked about every tenth of a second.
    bool Open(const DisplayAddress&, const std::function<bool()>& giveUp, std::string* why);
    // Sends all bytes. Returns false where the connection is lost, or `giveUp` has said so; it is
    // then closed.
    bool Send(std::span<const std::byte> bytes, const std::function<bool()>& giveUp,
              std::string* why);
    // Says whether the server is still there.
    bool IsAlive();
    void Close();

  private:
    int socket = -1;
};

}  // namespace lull
