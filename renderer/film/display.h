// Shows a running render in the viewer tev, or another that speaks its protocol.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>

#include "renderer/film/film.h"

namespace lull {

struct DisplayAddress {
    std::string host, port;
};

// Reads HOST:PORT or [HOST]:PORT. Throws Error for anything else.
DisplayAddress ParseDisplayAddress(const std::string& text);

// Sends the changed parts, from a thread of its own: the mean of each pixel in channels R, G, B,
// its samples in `spp`, and in `stop` 1 where a block has stopped. The sent state is always the
// latest state, so that nothing piles up for a slow viewer, and the thread rests 200 times as long
// as it has worked. If there is no viewer, or it goes away, there is one warning; the thread
// retries every few seconds, and sends everything to a viewer that appears later.
class Display {
  public:
    // `name` is the image's in the viewer; `warn` is called at most once, from any thread.
    Display(const DisplayAddress&, const std::string& name, const PixelRect& region,
            std::function<void(const std::string&)> warn);
    // Ends without waiting for the viewer.
    ~Display();
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;

    // Copies pixels of the region, which must not change meanwhile. Can be called from any
    // thread; takes about a nanosecond per number, whatever the viewer does.
    void Show(const PixelRect& pixels, const Film& film);
    // Shows colours, R, G, B of each pixel, row by row, from now on in place of the film's means.
    void ShowDenoised(const PixelRect& pixels, std::span<const float> rgb);
    void ShowStop(const PixelRect& block);

    // Sends the remaining parts, if there is a viewer, for at most this many seconds.
    void Finish(double seconds = 2);

  private:
    struct State;
    std::shared_ptr<State> state;  // shared with the thread, which can outlive this by a look-up
};

}  // namespace lull
