#include "renderer/commands/training_run.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "renderer/base/error.h"
#include "renderer/commands/interrupt.h"
#include "renderer/output/file_io.h"
#include "stopping/base/checksum.h"
#include "stopping/base/state.h"
#include "stopping/learning/simulation.h"

namespace lull {

namespace {

constexpr uint32_t checkpointTag = 0x3143524c;  // "LRC1"

std::string FileText(const std::string& path) {
    return std::filesystem::path(path).filename().string() + " " + FileChecksum(path);
}

template <typename T>
std::string ListText(const std::vector<T>& list) {
    std::string text;
    for (const T& item : list) text += fmt::format("{}{}", text.empty() ? "" : ",", item);
    return text.empty() ? "none" : text;
}

std::string BlocksText(std::span<const JudgedBlock> blocks) {
    std::map<std::string, std::string> viewpoints;
    for (const JudgedBlock& block : blocks)
        viewpoints[block.viewpoint] += fmt::format(" {}", block.block);
    std::string text;
    for (const auto& [name, numbers] : viewpoints)
        text += fmt::format("{}{}:{}", text.empty() ? "" : "\n", name, numbers);
    return text.empty() ? "none" : text;
}

}  // namespace

void TrainingCheckpoint::Read() {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw Error(path + ": there is no checkpoint to resume from");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    StateReader reader(std::as_bytes(std::span(text)));
    reader.Expect(checkpointTag);
    while (reader.Left() > 0) {
        const uint64_t size = reader.Get<uint64_t>();
        if (size > reader.Left()) throw Error(path + ": the checkpoint is cut short");
        reader.GetAll(std::span(states.emplace_back(size)));
    }
}

void TrainingCheckpoint::Set(size_t training, std::vector<std::byte> state) {
    states.resize(std::max(states.size(), training + 1));
    states[training] = std::move(state);
}

const std::vector<std::byte>* TrainingCheckpoint::Find(size_t training) const {
    return training < states.size() ? &states[training] : nullptr;
}

bool TrainingCheckpoint::IsDue() const {
    return !path.empty() && Clock::now() > written + interval;
}

void TrainingCheckpoint::Write() {
    if (path.empty()) return;
    StateWriter writer;
    writer.Put(checkpointTag);
    for (const std::vector<std::byte>& state : states) {
        writer.Put(uint64_t(state.size()));
        writer.PutAll(std::span<const std::byte>(state));
    }
    WriteFileAtomically(path, writer.bytes);
    written = Clock::now();
}

void TrainingCheckpoint::Remove() {
    states.clear();
    if (!path.empty()) std::filesystem::remove(path);
}

std::vector<BlockSplit> MakeSplits(const TrainOptions& options,
                                   std::span<const JudgedBlock> blocks) try {
    std::vector<BlockSplit> splits;
    if (options.crossValidate) splits = LeaveEachOut(blocks);
    for (BlockSplit& split : splits) split.name = "without " + split.name;
    const bool isSearch = !options.search.empty() && !options.crossValidate;
    if (options.output.empty() && !isSearch) return splits;
    BlockSplit split = LeaveOut(blocks, options.leaveOut);
    if (!options.split.empty()) KeepListed(ReadThresholds(options.split), &split);
    split.name = "";
    splits.push_back(std::move(split));
    return splits;
} catch (const std::invalid_argument& error) {
    throw Error(error.what());
}

void CheckSpacing(const ModelSettings& settings, int passSpp) {
    for (const int spp : {settings.n, settings.voteSpacing})
        if (spp % passSpp != 0)
            throw Error(
                fmt::format("--n and --vote-spacing must be multiples of the recordings' "
                            "pass of {} spp, and {} is not",
                            passSpp, spp));
}

std::optional<Network> TrainNetwork(const TrainOptions& options, const BlockSplit& split,
                                    size_t index, TrainingCheckpoint* checkpoint,
                                    const TrainingEvents& events) {
    const TrainingSamples samples = MakeSamples(split.training, options.settings);
    Trainer trainer(samples, options.training);
    if (const std::vector<std::byte>* state = checkpoint->Find(index)) try {
            trainer.Restore(*state);
        } catch (const std::runtime_error& error) {
            throw Error(checkpoint->Path() + ": " + error.what());
        }
    const bool isNew = !trainer.IsDone();
    if (isNew) events.begin(samples, trainer.Progress());
    while (!trainer.IsDone() && !Interrupted()) {
        trainer.Step();
        events.step(trainer);
        if (checkpoint->IsDue()) {
            checkpoint->Set(index, trainer.Save());
            checkpoint->Write();
        }
    }
    if (isNew) events.end(trainer.Progress());
    checkpoint->Set(index, trainer.Save());
    if (!trainer.IsDone()) return {};
    return trainer.Result();
}

void AddOutcomes(const Network& network, const ModelSettings& settings,
                 std::span<const JudgedBlock> blocks, std::vector<ViewpointOutcome>* viewpoints) {
    const Model model{network, settings, ""};
    const auto simulator = [&](const JudgedBlock& block) { return SimulateLearned(block, model); };
    for (ViewpointOutcome& viewpoint : Simulate(blocks, simulator, ""))
        viewpoints->push_back(std::move(viewpoint));
}

std::map<std::string, std::string> MakeRecord(const TrainOptions& options,
                                              const BlockSplit& split) {
    const TrainingOptions& t = options.training;
    std::string files;
    for (const std::string& path : options.datasets)
        files.append(files.empty() ? "" : "\n").append(FileText(path));
    return {{"version", LULL_VERSION},
            {"datasets", files},
            {"human", FileText(options.human)},
            {"training_blocks", BlocksText(split.training)},
            {"test_blocks", BlocksText(split.test)},
            {"units", ListText(t.units)},
            {"dense", ListText(t.dense)},
            {"dropout", fmt::format("{}", t.dropout)},
            {"learning_rate", fmt::format("{}", t.learningRate)},
            {"batch", fmt::format("{}", t.batch)},
            {"epochs", fmt::format("{}", t.epochs)},
            {"noisy_weight", fmt::format("{}", t.noisyWeight)},
            {"seed", fmt::format("{}", t.seed)},
            {"augment", t.augment ? "1" : "0"},
            {"balance_viewpoints", t.balanceViewpoints ? "1" : "0"},
            {"balance_classes", t.balanceClasses ? "1" : "0"}};
}

}  // namespace lull
