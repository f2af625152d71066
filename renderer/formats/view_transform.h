// Common part of the colour management of images, shared by the module and the program.
#pragma once

#include <cstddef>

namespace lull {

// Maps colours to a display, as a view of an OpenColorIO configuration does.
class ViewTransform {
  public:
    virtual ~ViewTransform() = default;
    // Replaces linear R, G, B with the primaries of sRGB by encoded values, of which a display
    // shows 0 to 1. Infinite and NaN values are for the configuration to map.
    virtual void Apply(float* rgb, size_t pixels) const = 0;
    // Returns the names of display and view, as DISPLAY/VIEW.
    virtual const char* Name() const = 0;
};

// The type of the module's function LullOpenView: reads the configuration `path`, or $OCIO if that
// is empty, and takes the view of its default display, the default one if `view` is empty. The
// result belongs to the caller. Throws std::runtime_error with the reason.
using OpenViewFunction = ViewTransform*(const char* path, const char* view);

}  // namespace lull
