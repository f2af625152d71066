#include "renderer/commands/render_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/render/shortfall.h"
#include "renderer/results/report.h"
#include "renderer/scene/light_groups.h"
#include "renderer/transport/integrator.h"

namespace lull {

namespace {

// Returns which blocks have ended, and how: one that its rule leaves at the cap is not stopped.
std::string EndsOf(const RenderResult& result, RuleTrend::Kind kind) {
    const RenderProgress& p = result.progress;
    if (kind == RuleTrend::Samples)
        return fmt::format("{} of {} blocks done", p.stoppedBlocks, p.blocks);
    std::string text =
        fmt::format("{} of {} blocks clean", p.stoppedBlocks - p.blocksAtCap, p.blocks);
    if (p.blocksAtCap > 0) text += fmt::format(", {} at the cap and not clean", p.blocksAtCap);
    return text;
}

// Returns the savings compared with the highest sample count of a block everywhere, if any.
std::string SavingsOf(const RenderResult& result) {
    int most = 0;
    for (const BlockResult& b : result.blocks) most = std::max(most, b.block.spp);
    const Savings savings = ComputeSavings(result, most);
    constexpr double kLeast = 0.0005;  // is shown as 0.1 %
    if (savings.SampleShare() < kLeast) return "";
    std::string text = fmt::format("; against {} spp everywhere {:.1f}% fewer samples", most,
                                   100 * savings.SampleShare());
    if (savings.SecondShare() >= kLeast)
        text += fmt::format(", {:.1f}% less time", 100 * savings.SecondShare());
    return text;
}

std::string SummaryOf(const RenderResult& result, RuleTrend::Kind kind) {
    return fmt::format("{}{}, median {} spp; {} samples in {}{}\n",
                       result.cancelled ? "interrupted: "
                       : result.timeUp  ? "the time is up: "
                                        : "",
                       EndsOf(result, kind), result.progress.medianSpp,
                       FormatCount(double(result.progress.samples)),
                       FormatDuration(result.progress.seconds),
                       result.cancelled || result.timeUp ? "" : SavingsOf(result));
}

void WarnOfRejected(int64_t rejected, const Messages& messages) {
    if (rejected > 0)
        messages.Warn(
            fmt::format("{} samples were not finite or negative; they count as black", rejected));
}

std::string SharesOf(const std::vector<double>& shares) {
    if (shares.empty()) return "";
    const auto [least, most] = std::ranges::minmax(shares);
    if (most - least < 0.01) return "";
    std::string text = "shares of the ranks at the end, in percent:";
    for (const double share : shares) text += fmt::format(" {:.0f}", 100 * share);
    return text + "\n";
}

std::string CappedOf(const Provenance& provenance, const RenderResult& result) {
    constexpr size_t kShown = 8;
    const std::vector<CappedBlock> capped = FindCapped(result);
    if (capped.empty()) return "";
    const bool isOdds = result.trend.kind == RuleTrend::Probability;
    std::string text = fmt::format("blocks at the cap, with their {}:\n",
                                   isOdds ? "probability of visible noise" : "value of the rule");
    for (size_t i = 0; i < std::min(kShown, capped.size()); ++i) {
        const CappedBlock& c = capped[i];
        const PixelRect& pixels = result.blocks[size_t(c.block)].block.pixels;
        text +=
            fmt::format("  block {} at {},{}: {:.3g}, threshold {:.3g}{}\n", c.block,
                        pixels.min.x(), pixels.min.y(), c.value, c.threshold,
                        c.neededSpp > 0 ? fmt::format("; estimated stop {} spp", c.neededSpp) : "");
    }
    if (capped.size() > kShown) text += fmt::format("  and {} more\n", capped.size() - kShown);
    const int cap = CapFor(capped, provenance.schedule.cap);
    return text +
           (cap > 0 ? fmt::format("estimated sufficient --max-spp: {}\n", cap)
                    : fmt::format("cannot estimate a sufficient --max-spp yet; try --max-spp {}\n",
                                  2 * provenance.schedule.cap));
}

// Returns the shortfall at the deadline. The noise of blocks is not known within their first pass,
// nor before the next one after a render was resumed.
std::string ShortfallOf(const Provenance& provenance, const RenderResult& result) {
    constexpr size_t kShown = 8;
    std::vector<NoisyBlock> noisy = FindShortfall(provenance, result);
    const auto unknown =
        std::erase_if(noisy, [](const NoisyBlock& block) { return !std::isfinite(block.noise); });
    std::string text;
    if (unknown > 0)
        text = fmt::format(
            "{} block{} without a noise estimate: no pass of {} spp ended in this run\n", unknown,
            unknown == 1 ? "" : "s", provenance.schedule.passLength);
    if (noisy.empty()) return text;
    text += "blocks not clean, with their masked noise in L*:\n";
    for (size_t i = 0; i < std::min(kShown, noisy.size()); ++i) {
        const Block& block = result.blocks[size_t(noisy[i].block)].block;
        text += fmt::format(
            "  block {} at {},{}: {:.2f} at {} spp; estimated stop {} spp, after {}\n",
            noisy[i].block, block.pixels.min.x(), block.pixels.min.y(), noisy[i].noise, block.spp,
            noisy[i].neededSpp, FormatDuration(NeededSeconds({noisy[i]}, result)));
    }
    if (noisy.size() > kShown)
        text += fmt::format("  and {} more, at most {:.2f}\n", noisy.size() - kShown,
                            noisy[kShown].noise);
    if (unknown == 0)
        text += fmt::format("estimated missing time: {}\n",
                            FormatDuration(NeededSeconds(noisy, result)));
    return text;
}

template <typename Triple>
std::string Numbers(const Triple& v) {
    return fmt::format("{:.5g} {:.5g} {:.5g}", v[0], v[1], v[2]);
}

std::string PlaceOf(const PathStep& step, const Description& description, const Scene& scene) {
    switch (step.kind) {
        case PathStep::Kind::Sky:
            return "leaves the scene towards " + Numbers(step.position);
        case PathStep::Kind::Medium:
            return fmt::format("in a medium at {}, after {:.5g}", Numbers(step.position),
                               step.distance);
        default:
            return fmt::format("on \"{}\" of \"{}\" at {}, normal {}, after {:.5g}",
                               NameOfObject(step.object, description, scene),
                               NameOfMaterial(step.material, description), Numbers(step.position),
                               Numbers(step.normal), step.distance);
    }
}

std::string WayOf(const PathStep& step) {
    if (!step.goesOn) return "";
    const std::string density = step.isSpecular
                                    ? std::string("as in a mirror or clear glass")
                                    : fmt::format("with density {:.5g} per sr", step.pdf);
    return fmt::format(
        "     {} direction {}, {}\n",
        step.isTransmission && step.kind == PathStep::Kind::Surface ? "transmitted" : "sampled",
        Numbers(step.direction), density);
}

std::string EndOf(const PathLog& log, const Scene& scene) {
    if (log.steps.empty()) return "It meets nothing that emits or scatters.\n";
    const PathStep& last = log.steps.back();
    if (last.kind == PathStep::Kind::Sky) return "";
    if (const int maxDepth = MaxDepth(scene.integrator); int(log.steps.size()) > maxDepth)
        return fmt::format("It ends at the greatest depth, {} bounces.\n", maxDepth);
    return last.goesOn ? "Terminated by Russian roulette.\n"
                       : "It ends here: nothing is scattered.\n";
}

}  // namespace

void PrintResult(const RenderSettings& settings, const Provenance& provenance,
                 const RenderResult& result, int64_t rejected) {
    if (settings.quiet) return;
    WarnOfRejected(rejected, MessagesOf(settings));
    if (settings.jsonProgress) return;
    PrintToStderr("{}{}{}{}", SummaryOf(result, result.trend.kind), SharesOf(result.shares),
                  result.timeUp ? ShortfallOf(provenance, result) : "",
                  CappedOf(provenance, result));
}

ProgressListener WarnOfFirstSamples(int64_t pixels, const Messages& messages,
                                    ProgressListener listener) {
    return [=, hasWarned = false](const RenderProgress& p) mutable {
        listener(p);
        constexpr int64_t kShare = 20;  // of the samples, from which their speed is taken
        if (hasWarned || !p.secondsLeft || p.samples >= pixels || p.samples < pixels / kShare)
            return;
        const double needed = p.seconds / double(p.samples) * double(pixels - p.samples);
        const double left = std::max(*p.secondsLeft, 0.);
        if (needed < 1.1 * left || needed < left + 1) return;
        hasWarned = true;
        messages.Warn(fmt::format(
            "the first sample of every pixel ends in about {}, but {} are left; a smaller "
            "--resolution takes less",
            FormatDuration(needed), FormatDuration(left)));
    };
}

ProgressListener AdviseDenoising(int64_t pixels, const Messages& messages,
                                 ProgressListener listener) {
    return [=, hasAdvised = false](const RenderProgress& p) mutable {
        listener(p);
        constexpr double kLong = 600, kFirstSeconds = 5;
        constexpr int64_t kLeastSpp = 60;  // of three votes; until the end can be predicted
        if (hasAdvised || p.seconds < kFirstSeconds || p.samples == 0) return;
        const double missing = double(std::max<int64_t>(kLeastSpp * pixels - p.samples, 0));
        const double left = p.predictedSeconds.value_or(p.seconds / double(p.samples) * missing);
        if (left < kLong) return;
        hasAdvised = true;
        if (!messages.isJson) PrintToStderr("\n");  // on a terminal there is a line of progress
        messages.Note(
            fmt::format("{} {} left; with --denoise, blocks stop once the denoised image is "
                        "clean, after a fraction of the samples",
                        p.predictedSeconds ? "about" : "at least", FormatDuration(left)));
    };
}

std::function<void(int, const Block&)> StopEvents(RuleTrend::Kind kind) {
    return [kind](int index, const Block& block) {
        const bool atCap = kind != RuleTrend::Samples && block.IsAtCap();
        PrintToStderr(R"({{"event":"stop","block":{},"x":{},"y":{},"spp":{},"end":"{}"}})"
                      "\n",
                      index, block.pixels.min.x(), block.pixels.min.y(), block.spp,
                      atCap ? "cap" : "clean");
    };
}

void SayEnd(const ResultFiles& files, const RenderResult& result, int64_t rejected) {
    for (const std::string& name : files.Names())
        PrintToStderr("{}", JsonEvent("file", name, "path"));
    const RenderProgress& p = result.progress;
    PrintToStderr(R"({{"event":"end","end":"{}","blocks":{},"cleanBlocks":{},"blocksAtCap":{},)"
                  R"("medianSpp":{},"samples":{},"rejectedSamples":{},"seconds":{:.3f}}})"
                  "\n",
                  result.cancelled ? "interrupted"
                  : result.timeUp  ? "time"
                                   : "done",
                  p.blocks, p.stoppedBlocks - p.blocksAtCap, p.blocksAtCap, p.medianSpp, p.samples,
                  rejected, p.seconds);
}

void PrintDenoised(const DenoisedImage& image, double seconds, bool quiet, const Messages& messages,
                   double accepted) {
    if (quiet) return;
    const std::string text =
        fmt::format("denoised in {}; {}", FormatDuration(seconds), TextOf(image.blocks, accepted));
    if (messages.isJson)
        messages.Note(text);
    else
        PrintToStderr("{}\n", text);
}

void PrintPath(const Vec2i& pixel, int index, const RenderSettings& settings,
               const Description& description, const Scene& scene) {
    const Vec2i& size = scene.film.resolution;
    if (pixel.x() >= size.x() || pixel.y() >= size.y())
        throw UsageError("--pixel {},{}: the image is {}x{}", pixel.x(), pixel.y(), size.x(),
                         size.y());
    if (!std::holds_alternative<PathIntegrator>(scene.integrator))
        throw UsageError("--pixel: a sample of \"{}\" is more than one path; add --integrator path",
                         NameOf(scene.integrator, scene.isVolumetric));
    const SamplerKind kind = settings.sampler.value();
    Sampler sampler(kind, settings.seed);
    const PathLog log = LogSample(scene, settings.estimator, sampler, pixel, uint32_t(index));

    fmt::print("Sample {} of pixel {},{} (sampler {}, seed {}, estimator {})\n", index, pixel.x(),
               pixel.y(), NameOf(kind), settings.seed, NameOf(settings.estimator));
    fmt::print("  0  camera at {}, looks along {}\n", Numbers(log.ray.o),
               Numbers(log.ray.d.normalized()));
    int number = 0;
    for (const PathStep& step : log.steps) {
        fmt::print("{:3}  {}\n", ++number, PlaceOf(step, description, scene));
        if (number > 1) fmt::print("     throughput:      {}\n", Numbers(step.throughput));
        if (!IsBlack(step.emitted)) fmt::print("     emitted:       + {}\n", Numbers(step.emitted));
        if (!IsBlack(step.direct)) fmt::print("     direct light:  + {}\n", Numbers(step.direct));
        fmt::print("{}", WayOf(step));
    }
    fmt::print("{}", EndOf(log, scene));
    const float factor = log.filterWeight * log.cameraWeight * log.filmScale;
    fmt::print("Radiance {}, luminance {:.5g}", Numbers(log.sample.radiance),
               Luminance(log.sample.radiance));
    if (factor != 1) fmt::print(", with a factor of {:.5g} by filter, lens and exposure", factor);
    fmt::print("{}\n", log.sample.rejected ? "; it was rejected: not finite, or negative" : "");
}

}  // namespace lull
