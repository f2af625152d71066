// Removes the noise of an image, and estimates the remaining error.
//
// Colours are fitted to features (RegressTile()) twice: each half of the samples by weights from
// the other half. Each filtered half is compared with the samples of the other, which measures blur
// as well as noise.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "renderer/denoise/planes.h"

namespace lull {

// Takes the noise out of features before colours are fitted to them.

inline constexpr int kFeatures = 7;  // albedo R, G, B, normal X, Y, Z, 1 / depth

// Returns the feature of a depth: its reciprocal, and 0 where there is nothing.
inline float DisparityOf(float depth) { return depth > 0 ? 1 / std::max(depth, 1e-12f) : 0; }

// Returns the rows [y0, y1) of kFeatures means of both halves of the samples. So that these, which
// are large, need not be in memory a second time, they are asked for rows as they are needed.
using FeatureReader = std::function<Halves(int y0, int y1)>;

// Returns the mean of both halves, each filtered by non-local means with weights from the other
// half, and scaled to [-1, 1]. Without noise, nothing is changed. NaN counts as 0. Calls
// forget(end), if there is such, when the rows above `end` will not be read again.
Planes FilterFeatures(int width, int height, const FeatureReader&,
                      const std::function<void(int end)>& forget = {});

// Filters noisy colours: fits in windows of some pixels, the choice among them, and the same at
// half of the size for wider structure (denoise.h).

enum class Effort {
    Full,
    Quick  // a little worse, in 60 % of the time: for a look at how far a render is
};

// Called with the share of the work that is done, in [0, 1] and never less than before, on the
// thread that waits for the result; may be empty.
using ShareListener = std::function<void(double share)>;

// Returns both halves of the samples, R, G, B, filtered. `variance` is of a pixel of either.
// Processes bands of rows, so that the candidates of few rows are in memory at a time, and the
// result takes the place of the features. The same bits for any number of threads.
Halves FilterColours(const Halves& noisy, Planes features, const Planes& variance, Effort,
                     const ShareListener& onShare = {});

// Fits the colours around each pixel as a linear function of features, and lets every fit speak for
// all pixels that it was made from: first-order regression as in Bitterli et al., "Nonlinearly
// weighted first-order regression for denoising Monte Carlo renderings" (EGSR 2016).

// Image to fit, its features and options. All images are of one size, and finite.
struct RegressionInput {
    const Planes& colour;
    const Planes& features;
    // The other half, from which weights come, so that they do not depend on the noise of `colour`.
    PatchGuide guide;
    PatchOptions patches;
    std::span<const float> bandwidths;
    // A row of fits speaks for the rows around it too: with fits in each second row pictures are a
    // few per cent worse, in half of the time.
    int rowsPerFit = 1;
};

// Returns for each bandwidth the fit of the colours of a tile, within the image, to its features.
std::vector<Planes> RegressTile(const RegressionInput&, const ImageTile&);

// Chooses, place by place, which of several pictures is nearest to the truth.

inline constexpr int kChoiceReach = 11;  // pixels, from which a choice depends on others

// Returns for each half a mixture of the candidates, R, G, B; the last of them are the unfiltered
// samples, `noisy`, with this variance of a pixel. The squared error of a candidate is that of the
// other half, filtered, against the samples of this one, less the part explained by their noise:
// unbiased, but noisy, so that it is averaged. The half that judges the result (visible_error.h) so
// has no part in the choice, which would underestimate the error. The samples themselves are chosen
// only where all others are worse beyond chance.
Halves ChooseCandidates(std::vector<Halves> candidates, const Halves& noisy,
                        const Planes& variance);

// Removes the excess of rare paths from pixels, and returns it to their region.

// The energy removed from the mean of both half buffers.
struct Firefly {
    size_t pixel;  // several fireflies may share it
    Rgb excess;    // not negative
};

// Scales down each pixel of a half (R, G, B) that is brighter than the same pixel of the other half
// by more than `limit` times the standard deviation of such differences around, and brighter than
// all of its neighbours are there, to that limit. The lesser half may be exceeded by as much more
// as it is above the darkest neighbour: so a pixel bright in both halves stays unchanged. Values
// are finite and not negative.
std::vector<Firefly> TakeFireflies(float limit, Halves*);

// Adds them to a picture: each over the 81 x 81 pixels around, in proportion to their brightness
// (up to white), where it is seen least. The sum over the picture grows by theirs, unless a few of
// them would change it too much: a pixel gets at most a 20th of its brightness from one, and more
// of as many more. Returns the standard deviation of what they brought, in luminance and at most
// that of the pixel, with that of what was not added: one event says as little of how many there
// are.
Planes GiveBack(const std::vector<Firefly>&, Planes* picture);

// Keeps fits from overshooting.

// The least and the largest values that samples allow.
struct SampleRange {
    Planes least, most;

    void Clamp(Planes* picture) const;
};

// Returns, for the pixels of a tile within the image and channel by channel, the least sample of
// the 5 x 5 pixels around and the largest of the 15 x 15 pixels around. The latter are as many as a
// fit has: where few pixels have most of the light, those between them must be able to get it.
SampleRange RangeOfSamples(const Planes& noisy, const ImageTile&);

// Clamps each pixel of a picture as large as `noisy` to that range, tile by tile on all threads.
void ClampToSamples(const Planes& noisy, Planes* picture);

// Inputs of the denoiser. All images have one size.
struct NoisyPicture {
    Halves colour;    // R, G, B: means of two halves of the samples, independent of each other
    Planes features;  // albedo, normal and 1 / depth, as FilterFeatures() has made them
    // Variance of the luminance of the mean of all samples, from their squares; no channel where it
    // is not known: then the halves alone tell.
    Planes variance;
    // The part of `colour`, R, G, B, that comes from lamps seen directly; no channels where it is
    // not known. That of lamps of few pixels is not filtered.
    Halves emission = {};
};

struct DenoisedPicture {
    Planes picture;   // R, G, B; finite and not negative
    Halves halves;    // each half denoised; their mean is the picture without fireflies
    Halves noisy;     // the halves of the samples without fireflies, which judge them
    Planes variance;  // of a pixel of these, R, G, B
    Planes returned;  // the standard deviation of the fireflies' light in the picture, luminance
    std::vector<Firefly> fireflies;  // what was taken from the samples; Crop() leaves it out
};

// Estimates the variance of a pixel of either half, R, G, B, > 0, from that of the mean (see
// NoisyPicture), if it is known, and the difference of the halves, whose values are Sane().
Planes EstimateVariance(const Halves& colour, const Planes& ofMean);

// Lowers the variance of the mean, where it is known, of pixels from which fireflies were taken to
// that of the halves without them. A single rare path would hide the error of all pixels around.
void ForgetFireflies(const std::vector<Firefly>&, const Halves& without, Planes* ofMean);

// Denoises a picture of at least one pixel, whose memory it uses. Values that are not finite or
// negative count as 0. The same bits for any number of threads. Takes some 7.5 us of
// CPU time a pixel, or 5.5 if it is quick.
DenoisedPicture Denoise(NoisyPicture, Effort = Effort::Full, const ShareListener& = {});

// Shows pictures at half of their size, where noise is less and neighbourhoods are wider.

// Returns the means of 2 x 2 pixels each; at an odd border, of those that are there.
Planes Halved(const Planes&);

// Returns an image of this size, half of which, rounded up, the given one has.
Planes Doubled(const Planes&, int width, int height);

// Returns `fine` with its coarse part, Halved(fine), replaced by `coarse`.
Planes WithCoarsePart(Planes fine, const Planes& coarse);

// Finds structure in the residual of a filter, the samples less the picture, which should be noise.
//
// The residual in lightness is summed over squares of 3 and 9 pixels a side and, in 12 directions,
// lines of 11 pixels and bars of 3 x 15 pixels around each pixel. A sum is structure where it is
// more than 4.5 times as large as its standard deviation: by the variance of its pixels, by the
// difference of the halves in them, or by that in the 7 x 7 pixels around each, whichever is
// largest.

inline constexpr int kStructureReach = 10;  // pixels that decide on one, to each side

// Adds to the middle of each square, line and bar the mean of its residual where that is structure,
// round by round. Each half gets the mean of its own samples, and stays within their range
// (SampleRange). `variance` is of a pixel of either half. The same bits for any number of
// threads.
void RestoreStructure(const Halves& noisy, const Planes& variance, Halves* picture);

// Returns that mean in lightness, which the picture lacks, where it is structure; elsewhere 0.
// Where that is uncertain, its square counts in part.
Planes StructureLeft(const Halves& noisy, const Planes& variance, const Halves& picture);

}  // namespace lull
