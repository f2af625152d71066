#include "renderer/lab/comparison/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "renderer/base/clocks.h"
#include "renderer/render/film_picture.h"
#include "renderer/results/denoised_image.h"
#include "stopping/base/parallel.h"
#include "stopping/lab/evaluation/evaluated_rules.h"
#include "stopping/rules/baselines.h"
#include "stopping/signals/lightness.h"
#include "stopping/signals/lightness_noise.h"

namespace lull {

namespace {

std::vector<float> LightnessErrorMap(const RgbImage& image, const RgbImage& reference) {
    const std::vector<double> a = LightnessOf(image.values), b = LightnessOf(reference.values);
    std::vector<float> error(a.size());
    for (size_t i = 0; i < a.size(); ++i) error[i] = float(a[i] - b[i]);
    return error;
}

void Paste(std::span<const float> block, const PixelRect& rect, int channels, int imageWidth,
           std::vector<float>* image) {
    const size_t row = size_t(rect.Width()) * channels;
    for (int y = 0; y < rect.Height(); ++y)
        std::copy_n(&block[size_t(y) * row], row,
                    &(*image)[(size_t(rect.min.y() + y) * imageWidth + rect.min.x()) * channels]);
}

Snapshot SnapshotOf(const Film& film, const PixelRect& rect, int spp) {
    FilmView view;
    film.Extract(rect, true, &view);
    const BlockView block{.width = view.width,
                          .height = view.height,
                          .spp = spp,
                          .mean = view.mean,
                          .halfMean = view.halfMean};
    return {.mean = view.mean, .noise = ComputeLightnessNoise(block).noise};
}

void RenderBlocks(const MonitoredRender& render, const std::vector<int>& spp, Film* film) {
    RenderState state;
    RenderOptions options;
    options.source = render.options.source;
    options.film = film;
    options.interrupted = &state;
    options.schedule = render.options.schedule;
    options.schedule.smallestSide = 0;
    options.sampler = render.options.sampler;
    options.threads = render.options.threads;
    options.makeCriterion = [&](const BlockInfo& info) {
        return MakeCriterion(FixedRule(spp[size_t(info.index)]));
    };
    state.criteria.resize(spp.size());
    for (size_t i = 0; i < spp.size(); ++i) {
        Block& block = state.blocks.emplace_back().block;
        block.pixels = render.result.blocks[i].block.pixels;
        block.stopped = spp[i] == 0;
    }
    Render(options);
}

ComparedImage EmptyImage(const PixelRect& region, const std::string& name,
                         const std::string& rule) {
    ComparedImage image;
    image.name = name;
    image.rule = rule;
    image.image = {region.Width(), region.Height(), std::vector<float>(size_t(region.Area()) * 3)};
    image.noise.resize(size_t(region.Area()));
    return image;
}

void PasteSnapshot(const Snapshot& snapshot, const PixelRect& rect, const PixelRect& region,
                   ComparedImage* image) {
    const PixelRect local{rect.min - region.min, rect.max - region.min};
    Paste(snapshot.mean, local, 3, region.Width(), &image->image.values);
    if (snapshot.noise.empty())
        image->noise.clear();
    else if (!image->noise.empty())
        Paste(snapshot.noise, local, 1, region.Width(), &image->noise);
}

void DenoiseSamples(const MonitoredRender& render, const std::vector<Block>& blocks,
                    ComparedImage* image) {
    const PixelRect& region = render.options.film->Region();
    std::vector<int> spp;
    for (const BlockCost& cost : image->costs) spp.push_back(cost.spp);
    Film film(region, {.layers = {.features = true}});
    RenderBlocks(render, spp, &film);
    const double start = ProcessSeconds();
    const auto denoise = [&](const PixelRect& part, const std::vector<Block>& inPart) {
        return DenoiseImage(TakePicture(&film, part), part, inPart);
    };
    image->image = DenoiseEyes(region, blocks, render.options.schedule.eyeWidth, denoise).image;
    const double seconds = ProcessSeconds() - start;
    for (size_t i = 0; i < blocks.size(); ++i)
        image->costs[i].ruleSeconds +=
            seconds * double(blocks[i].pixels.Area()) / double(region.Area());
    image->noise.clear();
}

void ForgetLinear(ComparedImage* image) {
    const auto forget = [](ErrorFigures* figures) {
        figures->rmse = figures->relMse = std::numeric_limits<double>::quiet_NaN();
    };
    forget(&*image->figures);
    for (ErrorFigures& figures : image->blockFigures) forget(&figures);
    for (ErrorFigures& figures : image->eyes) forget(&figures);
}

ScheduleOptions ScheduleFor(const MonitoredRule& rule, ScheduleOptions schedule) {
    schedule.smallestSide = rule.smallestSide;
    return schedule;
}

}  // namespace

const ComparedImage* Comparison::Find(const std::string& name) const {
    for (const ComparedImage& image : images)
        if (image.name == name) return &image;
    return nullptr;
}

PixelRect Comparison::Local(size_t block) const {
    return {blocks[block].min - region.min, blocks[block].max - region.min};
}

Comparison BeginComparison(const PixelRect& region, const ScheduleOptions& schedule) {
    Comparison comparison;
    comparison.region = region;
    comparison.eyeWidth = schedule.eyeWidth;
    for (const Block& block : MakeBlocks(region, schedule))
        comparison.blocks.push_back(block.pixels);
    comparison.hasReference = true;
    return comparison;
}

namespace {

std::vector<ErrorMaps> CompareEyes(const Comparison& comparison, const RgbImage& image) {
    const RgbImage& reference = comparison.images.back().image;
    if (comparison.eyeWidth == 0) return {CompareImages(image, reference, comparison.display)};
    std::vector<ErrorMaps> maps;
    for (const PixelRect& eye :
         EyesOf({{0, 0}, {image.width, image.height}}, comparison.eyeWidth)) {
        const auto cut = [&](const RgbImage& both) -> RgbImage {
            return {eye.Width(), eye.Height(), CutPixels(both.values, both.width, eye)};
        };
        maps.push_back(CompareImages(cut(image), cut(reference), comparison.display));
    }
    return maps;
}

ErrorFigures FiguresOf(const std::vector<ErrorMaps>& maps) {
    const ErrorFigures a = Average(maps[0]);
    if (maps.size() == 1) return a;
    const ErrorFigures b = Average(maps[1]);
    const auto mean = [&](double ErrorFigures::*figure) { return (a.*figure + b.*figure) / 2; };
    const auto root = [&](double ErrorFigures::*figure) {
        return std::sqrt((Sqr(a.*figure) + Sqr(b.*figure)) / 2);
    };
    return {.rmse = root(&ErrorFigures::rmse),
            .relMse = mean(&ErrorFigures::relMse),
            .rmseLightness = root(&ErrorFigures::rmseLightness),
            .psnr = -10 * std::log10((std::pow(10, -a.psnr / 10) + std::pow(10, -b.psnr / 10)) / 2),
            .ssim = mean(&ErrorFigures::ssim),
            .flip = mean(&ErrorFigures::flip),
            .visibleDifference = std::max(a.visibleDifference, b.visibleDifference)};
}

void SetFigures(const Comparison& comparison, ComparedImage* image) {
    const std::vector<ErrorMaps> maps = CompareEyes(comparison, image->image);
    image->figures = FiguresOf(maps);
    const size_t perEye = comparison.blocks.size() / maps.size();
    for (size_t i = 0; i < comparison.blocks.size(); ++i) {
        const PixelRect block = comparison.Local(i);
        const Vec2i across(int(i / perEye) * comparison.eyeWidth, 0);
        image->blockFigures.push_back(
            Average(maps[i / perEye], {block.min - across, block.max - across}));
    }
    image->flip = maps[0].flip;
    image->visibleDifference = VisibleMap(maps[0].visibleDifference);
    if (maps.size() > 1) {
        for (const ErrorMaps& eye : maps) image->eyes.push_back(Average(eye));
        const auto join = [&](std::vector<float>* left, const std::vector<float>& right) {
            *left = RowsBeside(*left, right, size_t(comparison.eyeWidth));
        };
        join(&image->flip, maps[1].flip);
        join(&image->visibleDifference, VisibleMap(maps[1].visibleDifference));
    }
    if (image->isDisplay || comparison.images.back().isDisplay) ForgetLinear(image);
}

// There is no seam between eyes.
Seams SeamsOf(const Comparison& comparison, const ComparedImage& image) {
    std::vector<PixelRect> blocks;
    for (size_t i = 0; i < comparison.blocks.size(); ++i) blocks.push_back(comparison.Local(i));
    const auto measure = [&](std::span<const PixelRect> those) {
        return MeasureSeams(image.noise, image.image.width, those);
    };
    if (comparison.eyeWidth == 0) return measure(blocks);
    const std::span all(blocks);
    const Seams left = measure(all.first(all.size() / 2)),
                right = measure(all.last(all.size() / 2));
    return {(left.border + right.border) / 2, (left.inside + right.inside) / 2};
}

}  // namespace

void Measure(Comparison* comparison) {
    const bool hasReference = comparison->hasReference;
    const RgbImage* reference = hasReference ? &comparison->images.back().image : nullptr;
    for (ComparedImage& image : comparison->images) {
        if (reference && &image.image != reference) {
            SetFigures(*comparison, &image);
            if (image.noise.empty()) image.noise = LightnessErrorMap(image.image, *reference);
        }
        if (!image.noise.empty()) image.seams = SeamsOf(*comparison, image);
    }
}

int CountVisibleBlocks(const ComparedImage& image) {
    return int(std::ranges::count_if(image.blockFigures, [](const ErrorFigures& figures) {
        return figures.visibleDifference > kVisibilityThreshold;
    }));
}

TotalCost SumCosts(const Comparison& comparison, const ComparedImage& image) {
    TotalCost total;
    for (size_t i = 0; i < image.costs.size(); ++i) {
        const BlockCost& cost = image.costs[i];
        total.samples += cost.spp * comparison.blocks[i].Area();
        total.seconds += cost.seconds;
        total.ruleSeconds += cost.ruleSeconds;
        total.isEstimated |= cost.isEstimated;
    }
    return total;
}

CriterionMaker MakeMonitors(const std::vector<MonitoredRule>& rules, const PixelRect& region,
                            const ScheduleOptions& schedule, const MonitorOptions& options,
                            std::vector<BlockHistory>* histories) {
    std::vector<std::vector<Block>> blocks;  // by rule
    for (const MonitoredRule& rule : rules)
        blocks.push_back(MakeBlocks(region, ScheduleFor(rule, schedule)));
    return [&rules, blocks, options, histories](const BlockInfo& info) {
        std::vector<std::unique_ptr<Criterion>> criteria;
        for (size_t r = 0; r < rules.size(); ++r)
            criteria.push_back(blocks[r][size_t(info.index)].votes ? rules[r].make(info) : nullptr);
        return std::make_unique<BlockMonitor>(std::move(criteria), options,
                                              &(*histories)[size_t(info.index)]);
    };
}

ComparedImage TakeImage(const MonitoredRender& render, const std::vector<MonitoredRule>& rules,
                        size_t index) {
    const MonitoredRule& rule = rules[index];
    const PixelRect& region = render.options.film->Region();
    const int cap = render.options.schedule.cap;
    const std::vector<Block> blocks =
        MakeBlocks(region, ScheduleFor(rule, render.options.schedule));
    ComparedImage image = EmptyImage(region, rule.name, rule.text);

    const auto stopOf = [&](size_t i) {
        const int voter = blocks[i].votes ? int(i) : blocks[i].leader;
        return voter < 0 ? RuleStop() : render.histories[size_t(voter)].stops[index];
    };

    // Find the samples of each block, of a pair's later; images not kept are rendered again.
    std::vector<int> again(blocks.size(), 0);
    for (size_t i = 0; i < blocks.size(); ++i) {
        const BlockResult& whole = render.result.blocks[i];
        const RuleStop stop = stopOf(i);
        const int other = blocks[i].partner < 0 ? stop.spp : stopOf(size_t(blocks[i].partner)).spp;
        BlockCost cost{.spp = std::min(stop.spp, other) > 0 ? std::max(stop.spp, other) : cap};
        if (blocks[i].votes && stop.spp == cost.spp) {
            cost.seconds = stop.seconds;
        } else {
            cost.seconds = whole.seconds / whole.block.spp * cost.spp;
            cost.isEstimated = whole.block.spp != cost.spp;
        }
        if (blocks[i].votes) cost.ruleSeconds = stop.ruleSeconds;
        image.costs.push_back(cost);
        if (rule.isDenoised) continue;

        const auto& kept = render.histories[i].snapshots;
        if (const auto snapshot = kept.find(cost.spp); snapshot != kept.end())
            PasteSnapshot(snapshot->second, blocks[i].pixels, region, &image);
        else if (whole.block.spp == cost.spp)
            PasteSnapshot(SnapshotOf(*render.options.film, blocks[i].pixels, cost.spp),
                          blocks[i].pixels, region, &image);
        else
            again[i] = cost.spp;
    }
    if (rule.isDenoised) DenoiseSamples(render, blocks, &image);
    if (std::ranges::none_of(again, [](int spp) { return spp > 0; })) return image;
    for (size_t i = 0; i < blocks.size(); ++i)  // which go on together
        if (again[i] > 0 && blocks[i].partner >= 0) again[size_t(blocks[i].partner)] = again[i];
    Film film(region);
    RenderBlocks(render, again, &film);
    for (size_t i = 0; i < blocks.size(); ++i)
        if (again[i] > 0)
            PasteSnapshot(SnapshotOf(film, blocks[i].pixels, again[i]), blocks[i].pixels, region,
                          &image);
    return image;
}

ComparedImage TakeWholeImage(const MonitoredRender& render) {
    const PixelRect& region = render.options.film->Region();
    ComparedImage image = EmptyImage(region, "reference", "");
    for (const BlockResult& result : render.result.blocks) {
        PasteSnapshot(SnapshotOf(*render.options.film, result.block.pixels, result.block.spp),
                      result.block.pixels, region, &image);
        image.costs.push_back({.spp = result.block.spp, .seconds = result.seconds});
    }
    return image;
}

EstimateError CompareEstimates(const ComparedImage& image, const ComparedImage& atCap) {
    EstimateError error;
    double estimated = 0, measured = 0;
    for (size_t i = 0; i < image.costs.size(); ++i) {
        const BlockCost &part = image.costs[i], &whole = atCap.costs[i];
        if (part.isEstimated || part.spp >= whole.spp || whole.seconds <= 0) continue;
        const double estimate = part.seconds / part.spp * whole.spp;
        ++error.blocks;
        estimated += estimate;
        measured += whole.seconds;
        const double relative = estimate / whole.seconds - 1;
        if (std::abs(relative) > std::abs(error.worst)) error.worst = relative;
    }
    if (measured > 0) error.total = estimated / measured - 1;
    return error;
}

Verification VerificationOf(const RenderResult& result, const Film& film,
                            const ComparedImage& taken) {
    Verification v{.threads = result.threads, .wallSeconds = result.progress.seconds};
    for (const BlockResult& block : result.blocks) {
        v.seconds += block.seconds;
        v.ruleSeconds += block.criterionSeconds;
    }
    v.samePixels = film.MeanImage() == taken.image.values;
    return v;
}

namespace {

CurvePoint PointOf(const Comparison& comparison, const ComparedImage& image,
                   const ErrorFigures& figures, int threads) {
    const size_t colon = std::min(image.rule.find(':'), image.rule.size());
    const TotalCost cost = SumCosts(comparison, image);
    return {.rule = image.rule.substr(0, colon),
            .setting = image.rule.substr(std::min(colon + 1, image.rule.size())),
            .spp = double(cost.samples) / double(comparison.region.Area()),
            .seconds = (cost.seconds + cost.ruleSeconds) / threads,
            .ruleSeconds = cost.ruleSeconds,
            .figures = figures};
}

}  // namespace

std::vector<int> FixedLadder(int passLength, int cap) {
    std::vector<int> ladder;
    for (int passes = 1; passes * passLength < cap; passes += (passes + 1) / 2)
        ladder.push_back(passes * passLength);
    ladder.push_back(cap);
    return ladder;
}

std::vector<std::string> CurveRules(int passLength, int cap) {
    std::vector<std::string> rules;
    for (const int spp : FixedLadder(passLength, cap))
        rules.push_back(fmt::format("fixed:{}", spp));
    for (const RecordedRule& rule : RecordedRules())
        for (const double setting : rule.curve)
            rules.push_back(fmt::format("{}:{}", rule.name, setting));
    return rules;
}

std::vector<CurvePoint> MeasureCurves(const MonitoredRender& render,
                                      const std::vector<MonitoredRule>& rules, size_t imageCount,
                                      const Comparison& comparison) {
    std::vector<CurvePoint> points(rules.size());
    const int threads = render.result.threads;
    const ComparedImage& reference = comparison.images.back();
    for (size_t i = 0; i < imageCount; ++i)
        points[i] =
            PointOf(comparison, comparison.images[i], *comparison.images[i].figures, threads);
    ForEachIndex(int(rules.size() - imageCount), [&](int i) {
        const size_t index = imageCount + size_t(i);
        const ComparedImage image = TakeImage(render, rules, index);
        ErrorFigures figures = FiguresOf(CompareEyes(comparison, image.image));
        if (reference.isDisplay)
            figures.rmse = figures.relMse = std::numeric_limits<double>::quiet_NaN();
        points[index] = PointOf(comparison, image, figures, threads);
    });
    return points;
}

}  // namespace lull
