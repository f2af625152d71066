// The windows of an EXR: its data can be a part of the picture, and reach beyond.
#pragma once

#include <string>
#include <vector>

#include "renderer/base/pixel_rect.h"
#include "renderer/image/image_io.h"

namespace lull {

PixelRect DataWindow(const ExrImage&);

// Returns the window of the picture that a file shows: of our own renders the part that was
// rendered (--crop), of other programs' the display window. Throws Error with `file` where that
// needs more memory than there is.
PixelRect ShownWindow(const ExrImage&, const std::string& file);

// Returns interleaved channels of the data window, moved to another window; 0 where data lack.
std::vector<float> MovedTo(const PixelRect& window, const PixelRect& data, int channels,
                           const std::vector<float>& values);

// Moves all channels so; the display window stays.
void MoveTo(const PixelRect& window, ExrImage*);

}  // namespace lull
