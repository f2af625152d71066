// Tells linear pictures, in which 1 is the display's white, from others.
#pragma once

#include <cstddef>
#include <string>

namespace lull {

// Counts the pixels of a picture by their values.
struct PictureValues {
    size_t pixels = 0;
    size_t notFinite = 0;  // a value of R, G, B is infinite or not a number
    size_t negative = 0;   // of a luminance below 0
    size_t lit = 0;        // of a luminance above 0
    size_t bright = 0;     // of a luminance above 4

    void Add(float r, float g, float b);
    void Add(const PictureValues&);
};

// Return the fault of a picture, or "": of its values, where more than a tenth of the pixels are
// not finite, or more than a quarter negative; of its exposure, where more than half of the lit
// pixels are brighter than four times white, as in pictures of 0 to 255. The exposure of a part of
// a picture is no fault: a block may show no more than a window.
std::string FaultOfValues(const PictureValues&);
std::string FaultOfExposure(const PictureValues&);

}  // namespace lull
