#include "stopping/lab/training/training_plan.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>

#include "stopping/base/checksum.h"

namespace lull {

namespace {

std::string FileText(const std::string& path) {
    return std::filesystem::path(path).filename().string() + " " + FileChecksum(path);
}

template <typename T>
std::string ListText(const std::vector<T>& list) {
    std::string text;
    for (const T& item : list) text += fmt::format("{}{}", text.empty() ? "" : ",", item);
    return text.empty() ? "none" : text;
}

std::string BlocksText(std::span<const LabelledBlock> blocks) {
    std::map<std::string, std::string> viewpoints;
    for (const LabelledBlock& block : blocks)
        viewpoints[block.viewpoint] += fmt::format(" {}", block.block);
    std::string text;
    for (const auto& [name, numbers] : viewpoints)
        text += fmt::format("{}{}:{}", text.empty() ? "" : "\n", name, numbers);
    return text.empty() ? "none" : text;
}

}  // namespace

std::vector<BlockSplit> MakeSplits(const TrainingPlan& plan,
                                   std::span<const LabelledBlock> blocks) try {
    std::vector<BlockSplit> splits;
    if (plan.crossValidate) splits = LeaveEachOut(blocks, plan.together);
    for (BlockSplit& split : splits) split.name = "without " + split.name;
    if (!plan.withLast) return splits;
    BlockSplit split = LeaveOut(blocks, plan.leaveOut);
    if (!plan.split.empty()) try {
            KeepListed(ReadThresholds(plan.split), &split);
        } catch (const std::invalid_argument& error) {
            throw std::runtime_error(plan.split + ": " + error.what());
        }
    split.name = "";
    splits.push_back(std::move(split));
    return splits;
} catch (const std::invalid_argument& error) {
    throw std::runtime_error(error.what());
}

void CheckSpacing(const ModelSettings& settings, int passSpp) {
    for (const int spp : {settings.n, settings.voteSpacing})
        if (passSpp > 0 && spp % passSpp != 0)
            throw std::runtime_error(
                fmt::format("--n and --vote-spacing must be multiples of the recordings' "
                            "pass of {} spp, and {} is not",
                            passSpp, spp));
}

std::map<std::string, std::string> MakeRecord(const TrainingPlan& plan, const BlockSplit& split) {
    const TrainingOptions& t = plan.training;
    std::string files;
    for (const std::string& path : plan.datasets)
        files.append(files.empty() ? "" : "\n").append(FileText(path));
    return {{"version", plan.version},
            {"datasets", files},
            {"human", FileText(plan.human)},
            {"training_blocks", BlocksText(split.training)},
            {"test_blocks", BlocksText(split.test)},
            {"units", ListText(t.units)},
            {"dropout", fmt::format("{}", t.dropout)},
            {"learning_rate", fmt::format("{}", t.learningRate)},
            {"batch", fmt::format("{}", t.batch)},
            {"epochs", fmt::format("{}", t.epochs)},
            {"seed", fmt::format("{}", t.seed)},
            {"balance_viewpoints", t.balanceViewpoints ? "1" : "0"},
            {"balance_classes", t.balanceClasses ? "1" : "0"}};
}

}  // namespace lull
