// `lull denoise`: takes the noise out of pictures that are rendered already.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "renderer/base/clocks.h"
#include "renderer/base/error.h"
#include "renderer/commands/command.h"
#include "renderer/commands/render_messages.h"
#include "renderer/denoise/denoiser.h"
#include "renderer/files/outputs.h"
#include "renderer/render/film_picture.h"
#include "renderer/results/channel_names.h"
#include "renderer/results/denoised_image.h"
#include "renderer/results/image_files.h"

namespace lull::denoise {

namespace {

struct Options {
    std::string input, half, output;
    int blockSize = 200;
    bool quiet = false;
};

constexpr const char* kFooter =
    R"(IN.exr is an image of `lull render --denoise-layers`, with both half buffers and their features. For
images of other renderers, give two renders with different seeds and equal sample counts, with R, G, B
(or LAYER.Combined, or Y) and, for sharp results, albedo.R .G .B, N.X .Y .Z and Z (or Blender's passes
Denoising Albedo, Normal and Depth).

OUT.exr has R, G, B denoised, the mean of the samples as noisy.R .G .B, the estimated standard error
of each pixel in L* as error, and the other channels of IN.exr. OUT.png is the same image for displays.

Examples:
  lull render scene.pbrt --spp 128 --denoise-layers -o image.exr
  lull denoise image.exr                                  # writes image.denoised.exr and .png
  lull denoise a.exr --half b.exr -o clean.exr

Exit codes: 0 success, 1 input or environment error, 2 usage error.)";

bool IsReplaced(const std::string& name) {
    return name == "R" || name == "G" || name == "B" || name == "error" ||
           name.starts_with("half") || name.starts_with("noisy.") || name.starts_with("variance.");
}

// Returns R, G, B of all samples or, if absent, of both halves; 0 for values that are not finite.
std::vector<float> MeanOf(const ExrImage& exr, const NoisyPicture& picture, bool isWhole) {
    std::vector<float> mean(picture.colour.a.values.size());
    for (size_t c = 0; c < 3; ++c) {
        const std::string name(1, "RGB"[c]);
        const ExrChannel* channel = exr.Find("noisy." + name);
        if (!channel) channel = exr.Find(name);
        const float *a = picture.colour.a.Plane(int(c)), *b = picture.colour.b.Plane(int(c));
        for (size_t i = 0; i < picture.colour.a.Area(); ++i) {
            const float value = isWhole && channel ? channel->values[i] : (a[i] + b[i]) / 2;
            mean[3 * i + c] = std::isfinite(value) ? value : 0;
        }
    }
    return mean;
}

void CheckHalves(const Options& options, const ExrImage& exr, const NoisyPicture& picture) {
    if (!options.half.empty()) {
        const std::string dependence = DependenceOf(picture.colour);
        if (!dependence.empty())
            throw Error("{} and {}: {} (--seed)", options.input, options.half, dependence);
    }
    const ExrChannel* spp = options.half.empty() ? exr.Find("spp") : nullptr;
    if (spp && std::ranges::min(spp->values) < float(kLeastDenoisedSpp))
        throw Error(
            "{}: some pixels have fewer than {} samples, too few to estimate the noise; render "
            "more",
            options.input, kLeastDenoisedSpp);
}

// Uses the display window where data windows differ: some programs write no black borders.
void UseOneWindow(const Options& options, ExrImage* a, ExrImage* b) {
    if (DataWindow(*a) == DataWindow(*b)) return;
    MoveTo(ShownWindow(*a, options.input), a);
    MoveTo(ShownWindow(*b, options.half), b);
}

void WriteShown(const std::string& png, const PixelRect& shown, const PixelRect& data,
                const RgbImage& image) {
    const RgbImage picture = {shown.Width(), shown.Height(), MovedTo(shown, data, 3, image.values)};
    WritePng(png, MeansOf(picture), picture.width, picture.height);
}

NoisyPicture ReadHalves(const Options& options, ExrImage* exr) {
    if (options.half.empty()) {
        CheckColours(options.input, *exr);
        return ReadPicture(*exr, options.input);
    }
    ExrImage half = ReadExr(options.half);
    UseOneWindow(options, exr, &half);
    UseOwnNames(options.input, exr);
    UseOwnNames(options.half, &half);
    return ReadPicture(*exr, options.input, half, options.half);
}

// Leaves out NaN, and channels that the denoised image replaces: the next steps need the memory.
void KeepOtherChannels(ExrImage* exr) {
    std::erase_if(exr->channels, [](const ExrChannel& c) { return IsReplaced(c.name); });
    for (ExrChannel& channel : exr->channels)  // depths may be infinite
        std::ranges::replace_if(
            channel.values, [](float v) { return std::isnan(v); }, 0.f);
}

ExitCode RunDenoise(Options options) {
    using std::filesystem::path;
    if (options.output.empty())
        options.output = path(options.input).replace_extension(".denoised.exr").string();
    const std::string png = path(options.output).replace_extension(".png").string();
    CheckOutputs(std::vector<NamedFile>{{"-o", options.output}, {"-o", png}},
                 std::vector<NamedFile>{{"IN", options.input}, {"--half", options.half}});
    const std::optional<FileLock> lock = LockOutput(options.output);
    std::error_code missing;
    if (std::filesystem::equivalent(options.input, options.half, missing))
        throw Error("--half " + options.half + ": the same file as " + options.input +
                    "; render once more, with another --seed");
    ExrImage exr = ReadExr(options.input);
    if (exr.views.size() > 1)
        throw Error(
            options.input +
            ": is a pair for two eyes, which lull render --denoise denoises as it renders it");
    NoisyPicture picture = ReadHalves(options, &exr);
    CheckHalves(options, exr, picture);
    const PixelRect shown = ShownWindow(exr, options.input);

    const PixelRect region{{0, 0}, {exr.width, exr.height}};
    ScheduleOptions schedule;
    schedule.blockSize = options.blockSize;
    const std::vector<Block> blocks = MakeBlocks(region, schedule);
    const std::vector<float> noisy = MeanOf(exr, picture, options.half.empty());
    KeepOtherChannels(&exr);
    const auto start = std::chrono::steady_clock::now();
    const DenoisedImage denoised = DenoiseWithReports(std::move(picture), region, blocks,
                                                      StyleOfReports(false, options.quiet));
    PrintDenoised(denoised, SecondsSince(start), options.quiet);

    std::ranges::move(ColourChannels("", denoised.image.values), std::back_inserter(exr.channels));
    std::ranges::move(MakeDenoisedChannels(denoised, noisy), std::back_inserter(exr.channels));
    exr.attributes["denoised"] = kDenoisedNote;
    ResultFiles results;
    results.Write(options.output, [&](const std::string& file) { WriteExr(file, exr); });
    results.Write(png, [&](const std::string& file) {
        WriteShown(file, shown, DataWindow(exr), denoised.image);
    });
    results.PrintAndCheck();
    return kDone;
}

}  // namespace

void AddCommand(CLI::App& app, Command* command) {
    CLI::App* denoise =
        app.add_subcommand("denoise", "Denoises an image and estimates the remaining error.");
    auto options = std::make_shared<Options>();
    denoise->add_option("IN", options->input, "Image to denoise, an EXR")->required();
    AddOption(*denoise, kOptions, "--half", &options->half,
              "Add an EXR with other samples of the same image", "B.exr");
    AddOption(*denoise, kOptions, "-o,--output", &options->output,
              "Write OUT.exr [IN.denoised.exr]", "OUT.exr")
        ->check([](const std::string& file) {
            return file.ends_with(".exr") ? "" : file + " does not end in .exr";
        });
    AddOption(*denoise, kOptions, "--block", &options->blockSize,
              "Set the side of the blocks with an error each, in pixels", "N",
              Between(10, 1 << 16));
    AddOption(*denoise, kOptions, "--quiet", &options->quiet,
              "Print only errors and the names of files");
    denoise->footer(kFooter);
    denoise->callback([=] { *command = [=] { return RunDenoise(*options); }; });
}

}  // namespace lull::denoise
