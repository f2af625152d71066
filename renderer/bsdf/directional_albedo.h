// Computes how much light a rough interface reflects in total.
#pragma once

namespace lull {

// The albedo of MicrofacetReflection with Schlick's reflectance, split by its two ends: the
// light reflected is f0 * ofF0 + f90 * ofF90.
struct GgxAlbedo {
    float ofF0, ofF90;

    float operator()(float f0, float f90) const { return f0 * ofF0 + f90 * ofF90; }
};

// Returns the albedo towards a direction with this cosine, in [0, 1], for an isotropic alpha in [0,
// 1]: from a table, within 0.01 of the integral.
GgxAlbedo DirectionalAlbedo(float cosine, float alpha);

// Returns its mean over all directions, weighted by the cosine.
GgxAlbedo MeanAlbedo(float alpha);

// Computes how much light the fibres of a cloth reflect in total.

// Returns the albedo of a white CharlieSheen towards a direction with this cosine, for an alpha
// from CharlieSheen::kLeastAlpha to 1: from a table, within 0.04 of the integral. It can exceed 1
// at grazing angles where alpha is below 0.07, as the model does.
float SheenAlbedo(float cosine, float alpha);

}  // namespace lull
