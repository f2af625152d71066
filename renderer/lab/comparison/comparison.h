// Compares the images that stopping rules give with each other and with a reference: error, seams,
// samples and seconds.
#pragma once

#include <optional>
#include <string>

#include "renderer/lab/metrics/image_error.h"
#include "renderer/render/block_monitor.h"
#include "renderer/render/render.h"

namespace lull {

// Cost of a block, in CPU time.
struct BlockCost {
    int spp = 0;
    double seconds = 0;
    double ruleSeconds = 0;
    bool isEstimated = false;  // from the block's seconds per sample, as not all of it was rendered
};

struct ComparedImage {
    std::string name;  // automatic, human, reference, or as the user calls it
    std::string rule;  // empty: not known
    RgbImage image;
    bool isDisplay = false;    // was a picture for displays, so that its linear values are rounded
    std::vector<float> noise;  // of the lightness, with its sign; empty: not known
    std::vector<BlockCost> costs;       // of each block; empty: not known
    std::optional<double> wallSeconds;  // as the header of its file says

    // Set by Measure(); the reference has no figures.
    std::optional<ErrorFigures> figures;
    std::vector<ErrorFigures> eyes;  // of a pair: of the left and the right eye
    std::vector<ErrorFigures> blockFigures;
    std::vector<float> flip, visibleDifference;  // at each pixel
    std::optional<Seams> seams;
};

struct Comparison {
    PixelRect region;
    std::vector<PixelRect> blocks;      // in pixels of the whole image
    int cap = 0;                        // 0: not known
    int eyeWidth = 0;                   // as in ScheduleOptions
    std::vector<ComparedImage> images;  // the last is the reference, if there is one
    bool hasReference = false;
    DisplayModel display;  // for visible differences

    const ComparedImage* Find(const std::string& name) const;
    // Returns a block's place within the images.
    PixelRect Local(size_t block) const;
};

// Returns the pixels of a part of a picture of that width, R, G, B, row by row.
template <typename Value>
std::vector<Value> CutPixels(const std::vector<Value>& rgb, int width, const PixelRect& rect) {
    std::vector<Value> pixels;
    pixels.reserve(size_t(rect.Area()) * 3);
    for (int y = rect.min.y(); y < rect.max.y(); ++y) {
        const auto row = rgb.begin() + (ptrdiff_t(y) * width) * 3;
        pixels.insert(pixels.end(), row + rect.min.x() * 3, row + rect.max.x() * 3);
    }
    return pixels;
}

// Returns a comparison with a reference, in the blocks of a schedule, that has no images yet.
Comparison BeginComparison(const PixelRect& region, const ScheduleOptions&);

// Fills in figures by the reference, and seams. Those of a pair are means over both eyes, which are
// measured one by one, and the visible difference is that of the eye where it is larger. If the
// noise of an image is not known, its error in lightness stands for it. Throws Error if images
// differ in size.
void Measure(Comparison*);

// Returns how many blocks have a visible difference above kVisibilityThreshold; needs figures.
int CountVisibleBlocks(const ComparedImage&);

struct TotalCost {
    int64_t samples = 0;
    double seconds = 0, ruleSeconds = 0;
    bool isEstimated = false;
};
TotalCost SumCosts(const Comparison&, const ComparedImage&);

// Names a rule that monitors have run over all blocks of a render.
struct MonitoredRule {
    std::string name, text;
    int smallestSide = 0;  // pixels; smaller blocks follow a neighbour
    CriterionMaker make;
    bool isDenoised = false;  // its image is to be denoised
};

// Makes the monitors of a render, for RenderOptions::makeCriterion; its schedule's smallestSide
// must be 0. `rules` and `histories`, one per block, must outlive the render.
CriterionMaker MakeMonitors(const std::vector<MonitoredRule>& rules, const PixelRect& region,
                            const ScheduleOptions&, const MonitorOptions&,
                            std::vector<BlockHistory>* histories);

// A monitored render that is complete.
struct MonitoredRender {
    const RenderOptions& options;
    const RenderResult& result;
    const std::vector<BlockHistory>& histories;
};

// Returns the image that rule number `index` would have rendered by itself, bit for bit. Blocks too
// small to be judged are rendered again, as only their neighbour determined how far. So are all of
// an image to be denoised, for which the render must have collected features; it has no `noise`,
// and denoising it is among the rule's seconds, of which the work of other threads must be no part.
ComparedImage TakeImage(const MonitoredRender&, const std::vector<MonitoredRule>& rules,
                        size_t index);
// Returns the image of all samples that were taken.
ComparedImage TakeWholeImage(const MonitoredRender&);

// Compares the CPU time to the cap, estimated from the cost of the blocks until the rule stopped
// them, with the measured time: estimated / measured - 1, over all blocks and for the worst one.
// Blocks that had not stopped before the cap are left out.
struct EstimateError {
    int blocks = 0;
    double total = 0, worst = 0;
};
EstimateError CompareEstimates(const ComparedImage& image, const ComparedImage& atCap);

// One render of a rule's image by itself, to measure the rule's cost and savings on some threads.
struct Verification {
    int threads = 0;
    double wallSeconds = 0;  // of the render
    double seconds = 0;      // of processors, spent on samples
    double ruleSeconds = 0;  // of processors, spent on the rule
    bool samePixels = false;
};

// Returns the cost of a render of a rule alone, to `film`, and whether TakeImage() gave the same.
Verification VerificationOf(const RenderResult&, const Film& film, const ComparedImage& taken);

// Measures error against effort: of fixed sample counts, and of rules over a range of settings.

struct CurvePoint {
    std::string rule, setting;  // "dammertz", "0.02"; "fixed", "64"
    double spp = 0;             // mean samples per pixel
    double seconds = 0;         // wall-clock time, if all threads were always busy
    double ruleSeconds = 0;     // CPU time
    ErrorFigures figures;
};

// Returns the numbers of samples per pixel at which fixed rendering is measured: from the first
// pass to the cap, each about 1.5 times the last, all ends of passes.
std::vector<int> FixedLadder(int passLength, int cap);

// Returns the measured rules: "fixed:N" for the ladder, and rules with one setting over its range.
std::vector<std::string> CurveRules(int passLength, int cap);

// Returns a point for each rule: for the first of them, whose images the comparison begins with, by
// the figures that Measure() gave these, for the others by their images, which are not kept.
std::vector<CurvePoint> MeasureCurves(const MonitoredRender&,
                                      const std::vector<MonitoredRule>& rules, size_t imageCount,
                                      const Comparison&);

}  // namespace lull
