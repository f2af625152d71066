// Keeps what a viewer is to show, and sends it.
#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "renderer/film/display.h"

namespace lull {

// The latest state of an image, and its parts that have not been sent yet.

// Used by all threads of a render and by the one that sends. The image is cut into cells; the
// changes of a cell are one rectangle, however often it changes before it is sent.
class Snapshot {
  public:
    static constexpr int kChannels = 5;  // R, G, B, spp, stop
    static constexpr int kCell = 64;     // pixels a side

    explicit Snapshot(const PixelRect& region);

    void Show(const PixelRect& pixels, const Film& film);
    // Shows these colours, R, G, B of each pixel, from now on in place of the film's.
    void ShowDenoised(const PixelRect& pixels, std::span<const float> rgb);
    void ShowStop(const PixelRect& block);
    // Marks everything that was ever shown as not sent.
    void ShowAllAgain();

    struct Update {
        PixelRect pixels;           // from the region's corner
        std::vector<float> values;  // row-major, kChannels a pixel
    };
    // Takes a rectangle that has changed and marks it as sent; false if there is none. Cells take
    // turns row by row. The memory of `values` is reused.
    bool Take(Update* update);

  private:
    float* At(int x, int y) { return &values[Index(x, y) * kChannels]; }
    size_t Index(int x, int y) const { return size_t(y) * size_t(width) + size_t(x); }
    void Mark(const PixelRect& pixels);

    std::mutex mutex;
    const PixelRect region;
    const int width, columns, rows;
    std::vector<float> values;
    std::vector<char> denoised;      // whether a pixel is shown so
    std::vector<PixelRect> changed;  // of each cell, from the region's corner
    std::vector<PixelRect> shown;    // the same, of all that was ever shown
    size_t next = 0;                 // the cell whose turn it is
};

// Talks to a server by TCP, and never waits for it longer than it is told to.
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
    // Sends all bytes. Returns false, and closes, if the connection is lost or giveUp() is true.
    bool Send(std::span<const std::byte> bytes, const std::function<bool()>& giveUp,
              std::string* why);
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

// Changes a rectangle of it from (x, y) on. `values` are row-major, channels side by side.
std::vector<std::byte> UpdateImage(const std::string& name, std::span<const std::string> channels,
                                   int x, int y, int width, int height,
                                   std::span<const float> values);

}  // namespace lull::tev
