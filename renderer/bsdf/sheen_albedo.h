// Computes how much light the fibres of a cloth reflect in total.
#pragma once

namespace lull {

// Returns the albedo of a white CharlieSheen towards a direction with this cosine, for an alpha
// from CharlieSheen::kLeastAlpha to 1: from a table, within 0.04 of the integral. It can exceed 1
// at grazing angles where alpha is below 0.07, as the model does.
float SheenAlbedo(float cosine, float alpha);

}  // namespace lull
