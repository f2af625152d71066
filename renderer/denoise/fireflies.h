// Takes out of pixels what one rare path has brought, and gives it back to the region as a whole.
#pragma once

#include "renderer/denoise/planes.h"

namespace lull {

// Holds the colours of both halves of the samples (R, G, B), and what was taken out of their mean.
struct CalmedHalves {
    Planes a, b;
    Planes excess;  // R, G, B, not negative: mean of `a` and `b` as they were, less as they are
};

// Scales down each pixel of a half that is brighter than the same pixel of the other half by more
// than `limit` times the standard deviation of such differences around, and brighter than all of
// its neighbours are there, to that limit. So what is bright in both halves stays as it is, and as
// the samples grow, what is taken vanishes as their noise does. Values are finite and not negative.
CalmedHalves TakeFireflies(const Planes& a, const Planes& b, float limit);

// Adds the excess to a picture: of each pixel over some 60 pixels around, in proportion to their
// brightness (up to white), where it is seen least. The sum over the picture grows by that of the
// excess.
void GiveBack(const Planes& excess, Planes* picture);

}  // namespace lull
