// Converts a film to the inputs of the denoiser.
#pragma once

#include <functional>
#include <span>

#include "renderer/denoise/denoiser.h"
#include "renderer/film/film.h"
#include "renderer/render/render.h"
#include "renderer/schedule/schedule.h"
#include "stopping/rules/rule.h"

namespace lull {

// Samples a pixel needs for both halves to have as many.
inline constexpr uint32_t kLeastDenoisedSpp = 4;

// Returns the pixels of a rectangle inside the film, which keeps its half and features. Where a
// pixel has less than kLeastDenoisedSpp samples, one half of its colours is their mean, and the
// other that of its neighbours. Where it has none, both are the film's first look.
NoisyPicture PictureOf(const Film&, const PixelRect&);

// The same for the light of groups, which keep what tells their noise. The picture reads the film,
// which has to be there; the first look belongs to the last group.
GroupedPicture GroupedPictureOf(const Film&, const PixelRect&);

// Returns a region of the film at a lower resolution: each pixel is the mean of 2^halvings a side.
NoisyPicture ReducedPictureOf(const Film&, const PixelRect& region, int halvings);

// Do the same; of all pixels, they free what the denoiser alone reads of the film, row by row: so
// the picture takes its place. A part, as an eye of a pair, leaves it to the others.
NoisyPicture TakePicture(Film*, const PixelRect&);
GroupedPicture TakeGroups(Film*, const PixelRect&);

Halves ColoursOf(const Film&, const PixelRect&);

// Return the unfiltered features of both halves, and the variance of the mean luminance.
Halves FeatureHalvesOf(const Film&, const PixelRect&);
// Returns NoisyPicture::emission: 0 in pixels without two halves, no channels without such a layer.
Halves EmissionOf(const Film&, const PixelRect&);
Planes VarianceOf(const Film&, const PixelRect&);

// Takes a first look at a picture, so that its first preview shows the whole of it.

// Gives the film a first look: sample 0 of one pixel in each square of 4 x 4, which takes 1/16 of
// the time of one sample per pixel. The samples of the film stay as they are. Without effect where
// all pixels have samples, or if the render is cancelled.
void TakeFirstLook(const SampleSource& source, const RenderOptions& options, Film* film);

// Measures the error of denoised blocks during a render.

// Denoises blocks by themselves, so that the result for one does not depend on others. Can be asked
// by several threads, of different blocks, whose pixels then must not change.
class BlockDenoiser {
  public:
    explicit BlockDenoiser(std::vector<Block> blocks) : blocks(std::move(blocks)) {}

    // Sets whose pixels they are, which have features; it must be there while it is asked. With
    // light groups, each is denoised, and the largest error counts (RunDenoiser()).
    void Show(const Film* pixels) { film = pixels; }

    // Sets how the denoised picture is shown (DenoiserOptions::gradings).
    void Grade(std::vector<Grading> shown) { gradings = std::move(shown); }

    // Shows denoised blocks to a callback: their pixels, and R, G, B of each, row by row.
    void ShowPictures(std::function<void(const PixelRect&, std::span<const float> rgb)> show) {
        showPicture = std::move(show);
    }

    // Of a block of at least kSmallestMeasuredSide.
    VisibleError MeasureBlock(int block) const;

  private:
    DenoisedImage Run(const PixelRect& pixels) const;

    std::vector<Block> blocks;
    const Film* film = nullptr;
    std::vector<Grading> gradings;
    std::function<void(const PixelRect&, std::span<const float> rgb)> showPicture;
};

// Returns the value of the rule `denoised`: the estimate.
SignalMeasure MeasureOf(std::shared_ptr<const BlockDenoiser>);

}  // namespace lull
