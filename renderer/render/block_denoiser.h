// Measures the error of denoised blocks during a render.
#pragma once

#include <functional>
#include <span>

#include "renderer/denoise/denoiser.h"
#include "renderer/film/film.h"
#include "renderer/schedule/schedule.h"
#include "stopping/rules/rule.h"

namespace lull {

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
    DenoiserResult Run(const PixelRect& pixels) const;

    std::vector<Block> blocks;
    const Film* film = nullptr;
    std::vector<Grading> gradings;
    std::function<void(const PixelRect&, std::span<const float> rgb)> showPicture;
};

// Returns the value of the rule `denoised`: the estimate.
SignalMeasure MeasureOf(std::shared_ptr<const BlockDenoiser>);

}  // namespace lull
