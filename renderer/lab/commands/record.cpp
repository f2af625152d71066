// `lull record`: records the data set that rules are trained on.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "renderer/commands/command.h"
#include "renderer/commands/render_job.h"
#include "renderer/files/outputs.h"
#include "renderer/lab/commands/lab_options.h"
#include "renderer/lab/viewpoints/recorded_viewpoint.h"
#include "renderer/mpi/job.h"
#include "stopping/base/parallel.h"

namespace lull::record {

namespace {

// Those with an effect on another renderer's pictures.
constexpr const char* kOptionsOfPictures[] = {"--images", "--block",        "--name", "--output",
                                              "--blocks", "--human",        "--past", "--threads",
                                              "--quiet",  "--json-progress"};

struct Options {
    RenderSettings render;
    std::string images;  // the folder of another renderer's pictures; empty: a scene is rendered
    std::string name, output, human;
    std::vector<int> blocks;  // empty: all
    double past = 0;          // 0: every block goes on to the cap
};

constexpr const char* kFooter =
    R"(Renders like the images that observers judged, with pbrt-v3's estimator and random sampler. Records
SVD-entropies, lightness and noise of every block at all passes up to 400 spp and at every second one
after. Thresholds are no part of the file: `lull train` and `lull evaluate` join them by the
viewpoint's name.

With --images the records are made of another renderer's images: all files of a folder, with their
spp in the names (room-40spp.png, or the last number, room_00040.png), at any spp. They contain
entropies, lightness and the 26 attributes, but no measurements of half buffers (noise, dammertz,
cycles, luxtile).

Blocks that the file has already are left out, so that the same command can be given again. An
interrupted one leaves OUT.h5.NAME.checkpoint and continues from there the next time.

Examples:
  lull record scene.pbrt --name kitchen-view0 -o data.h5 --resolution 800x800
  lull record scene.pbrt --name kitchen-view0 -o data.h5 --resolution 800x800 --blocks 0,5,10
  lull record scene.pbrt --name kitchen-view0 -o data.h5 --human human.csv --past 1.5
  lull record --images images/kitchen -o data.h5

Exit codes: 0 success, 1 input or environment error, 2 usage error, 130 interrupted.)";

void AddOptions(CLI::App& app, Options* o) {
    AddSceneOptions(app, &o->render.scene);
    CLI::Option* scene = app.get_option("SCENE")->required(false);
    AddOption(app, kOptions, "--images", &o->images,
              "Images of another renderer, their spp in the file names, not a scene", "DIR")
        ->excludes(scene);
    AddBlockOption(app, &o->render.schedule.blockSize)->group("Stopping");
    app.add_option("--name", o->name,
                   "Name of the viewpoint, as in thresholds files [the name of the folder]")
        ->check(CheckViewpointName);
    AddOption(app, kCommonOptions, "-o,--output", &o->output, "Write or extend this data set",
              "OUT.h5")
        ->required();
    AddOption(app, kOptions, "--blocks", &o->blocks,
              "Record only these blocks, counted row by row from 0", "N,N,...", WholeNumber())
        ->delimiter(',');
    auto* human = AddOption(app, kOptions, "--human", &o->human,
                            "Read the human thresholds for --past", "H.csv", CLI::ExistingFile);
    AddOption(app, kOptions, "--past", &o->past,
              "Record each block up to X times its human threshold", "X", Between(0.1, 100.0))
        ->default_str("")
        ->needs(human);
    AddOption(app, kCommonOptions, kCapOption, &o->render.schedule.cap, "Record up to N spp", "N",
              Between(1, 1 << 24));
    AddEstimatorOption(app, &o->render.estimator);
    AddOption(app, "Sampling", "--seed", &o->render.seed, "Seed the random numbers", "N",
              WholeNumber());
    AddCheckpointInterval(app, &o->render.checkpoint);
    AddOption(app, "Output", "--quiet", &o->render.quiet, "Print only warnings and errors");
    AddOption(app, "Output", "--json-progress", &o->render.jsonProgress,
              "Print events as JSON, one object per line, on stderr");
    app.footer(kFooter);
}

// Returns until which spp each block is to be recorded: 0 for those that the data set has already.
std::vector<int> LimitsOf(const Options& options, size_t blocks,
                          const std::vector<ViewpointRecording>& dataset) {
    std::vector<int> limits = RecordingLimits(blocks, options.blocks, options.render.schedule.cap);
    if (options.past > 0) LimitByHuman(options.human, options.name, options.past, &limits);
    const auto old = std::ranges::find(dataset, options.name, &ViewpointRecording::name);
    if (old != dataset.end())
        for (const auto& [number, block] : old->blocks) limits.at(size_t(number)) = 0;
    return limits;
}

ExitCode Write(const ViewpointRecording& viewpoint, const Options& options) {
    ResultFiles results;
    WriteRecording(viewpoint, options.output, MessagesOf(options.render), &results);
    results.PrintAndCheck();
    return kDone;
}

bool IsAllThere(const std::vector<int>& limits, const Options& options) {
    if (std::ranges::any_of(limits, [](int limit) { return limit > 0; })) return false;
    MessagesOf(options.render)
        .Note(fmt::format("{} has all blocks of '{}' already", options.output, options.name));
    return true;
}

ExitCode RecordFolder(const Options& options) {
    const PictureFolder folder = FindPictures(options.images, options.name);
    CheckOutputs(std::vector<NamedFile>{{"-o", options.output}}, InputsOf(folder));
    const int blockSize = options.render.schedule.blockSize;
    const ViewpointRecording described = DescribePictures(folder, blockSize);
    std::vector<ViewpointRecording> dataset = ReadDatasetIfThere(options.output);
    AddToDataset(described, &dataset);  // says now whether it does not fit
    Options wanted = options;
    wanted.name = folder.name;
    wanted.render.schedule.cap = described.cap;
    const std::vector<int> limits = LimitsOf(wanted, size_t(described.blockCount), dataset);
    if (IsAllThere(limits, wanted)) return kDone;
    ViewpointRecording viewpoint;
    RunWithThreads(options.render.scene.compile.threads, [&] {
        viewpoint = RecordAndTell(folder, {.blockSize = blockSize, .limits = limits},
                                  MessagesOf(options.render));
    });
    return Write(viewpoint, options);
}

ExitCode Run(Options options, MpiJob* ranks) {
    if (!options.images.empty()) return ranks->Rank() == 0 ? RecordFolder(options) : kDone;
    SetWording(options.render, ranks);
    CheckpointOptions& checkpoint = options.render.checkpoint;
    checkpoint = ResumeIfThere(fmt::format("{}.{}.checkpoint", options.output, options.name),
                               checkpoint.interval);
    RenderJob render(options.render, ranks);
    const ScheduleOptions& schedule = render.settings.schedule;
    const std::vector<Block> blocks = MakeBlocks(render.region, schedule);
    render.CheckFiles({{"-o", options.output}}, {{"--human", options.human}});
    CheckRecordable(blocks, schedule);
    std::vector<ViewpointRecording> dataset = ReadDatasetIfThere(options.output);
    const std::vector<int> limits = LimitsOf(options, blocks.size(), dataset);
    if (IsAllThere(limits, options)) {  // there is no render that the ranks could share
        ranks->Begin("nothing");
        ranks->End();
        return kDone;
    }

    render.Compile();
    render.provenance.criterion = fmt::format("record:{}", fmt::join(limits, ","));
    SessionOptions how = render.MakeSessionOptions(false);
    how.identity = render.Identity();
    ViewpointRecording viewpoint =
        MakeViewpoint(options.name, schedule, how.identity, blocks.size());
    AddToDataset(viewpoint, &dataset);  // says now whether it does not fit
    Session session(*render.scene, render.region, how);
    const RenderResult result = render.Run(
        &session, [&](const auto&... how) { return RecordBlocks(how..., limits, &viewpoint); });
    if (const auto code = render.End(result.cancelled)) return *code;

    Write(viewpoint, options);
    render.RemoveCheckpoint();
    return kDone;
}

}  // namespace

void AddCommand(CLI::App& app, Command* command, MpiJob* job) {
    CLI::App* dataset = app.add_subcommand(
        "record", "Records block histories of a viewpoint, to train stopping rules.");
    auto options = std::make_shared<Options>();
    // Observers judged pbrt-v3's own noise.
    options->render.sampler = SamplerKind::Random;
    options->render.estimator = Estimator::PbrtV3;
    AddOptions(*dataset, options.get());
    dataset->callback([=] {
        if (options->images.empty() && options->render.scene.file.empty())
            throw CLI::ValidationError("record", "a SCENE is needed, or --images");
        if (options->images.empty() && options->name.empty())
            throw CLI::ValidationError("--name", "is needed for a SCENE");
        if (!options->images.empty()) AllowOnly(*dataset, kOptionsOfPictures, "with --images");
        *command = [=] { return Run(*options, job); };
    });
}

}  // namespace lull::record
