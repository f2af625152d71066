#include "stopping/lab/recordings/labelled_blocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "stopping/base/input_file.h"
#include "stopping/features/model_inputs.h"

namespace lull {

namespace {

constexpr const char* kNeeded =
    ": recordings have H for m = 4, 25, 100 and 400, H1 and H2 for m = 100";

std::string EntropyChannel(Feature feature, int m) {
    if (feature == Feature::H && (m == 4 || m == 25 || m == 100 || m == 400))
        return std::string("h").append(std::to_string(m));
    if (feature == Feature::H1 && m == 100) return "h1";
    if (feature == Feature::H2 && m == 100) return "h2";
    throw std::invalid_argument(FeatureNames({&feature, 1}) + " with m = " + std::to_string(m) +
                                kNeeded);
}

std::string PassText(int passSpp) {
    return passSpp > 0 ? "in passes of " + std::to_string(passSpp) + " spp" : "at any spp";
}

// Walks over the records at which a model votes, or a step of a window lies.
class VoteGrid {
  public:
    VoteGrid(const LabelledBlock& block, const ModelSettings& settings)
        : block(block),
          n(settings.n),
          isAny(block.passSpp == 0 && settings.spacing == Spacing::Geometric),
          next(block.passSpp > 0 ? block.passSpp
               : isAny           ? 1
                                 : n) {}

    // Returns whether record i is one of them. Throws std::invalid_argument if one is missing.
    bool Takes(int i) {
        const int spp = block.recording->spp[size_t(i)];
        if (spp < next) return false;
        if (isAny) {
            next = spp + n;
            return true;
        }
        // The last pass of a recording may be off the grid.
        const bool isLast = i + 1 == block.recording->Count();
        if (spp > next && !isLast)
            throw std::invalid_argument("block " + std::to_string(block.block) + " of " +
                                        block.viewpoint + " is not recorded at " +
                                        std::to_string(next) + " spp; n = " + std::to_string(n) +
                                        " does not fit");
        if (spp > next) return false;
        next += n;
        return true;
    }

  private:
    const LabelledBlock& block;
    int n;
    bool isAny;
    int next;  // the least spp of the next one
};

}  // namespace

BlockMeasures MeasuresOf(const BlockRecording& recording, int i, const ModelSettings& settings) {
    BlockMeasures measures{.spp = recording.spp[size_t(i)]};
    const auto put = [&](std::vector<double>* numbers, std::string_view channel) {
        const std::span<const float> values = recording.Values(i, channel);
        numbers->assign(values.begin(), values.end());
    };
    for (const Feature feature : settings.features) {
        std::vector<double>* numbers = &measures.Of(feature);
        if (feature == Feature::VisibleDrop) {
            put(&measures.Of(Feature::H), EntropyChannel(Feature::H, settings.m));
            const auto mean = recording.Values(i, "lightness"),
                       deviation = recording.Values(i, "deviation");
            measures.lightness = {.mean = {mean.begin(), mean.end()},
                                  .deviation = {deviation.begin(), deviation.end()}};
        } else if (IsEntropy(feature)) {
            put(numbers, EntropyChannel(feature, settings.m));
        } else {
            put(numbers, FeatureNames({&feature, 1}));  // which is that of its channel
        }
    }
    return measures;
}

std::vector<LabelledBlock> JoinHuman(std::span<const ViewpointRecording> viewpoints,
                                     std::span<const ThresholdsRow> human,
                                     std::vector<std::string>* unknown) {
    std::vector<LabelledBlock> blocks;
    std::set<std::string> names;
    for (const ViewpointRecording& viewpoint : viewpoints) {
        const std::string& name = viewpoint.name;
        if (!names.insert(name).second)
            throw std::invalid_argument("the viewpoint " + name + " comes twice");
        const auto row = std::find_if(human.begin(), human.end(),
                                      [&](const ThresholdsRow& r) { return r.name == name; });
        if (row == human.end()) {
            if (unknown) unknown->push_back(name);
            continue;
        }
        if (row->spp.size() != size_t(viewpoint.blockCount))
            throw std::invalid_argument("the viewpoint " + name + " has " +
                                        std::to_string(viewpoint.blockCount) + " blocks and " +
                                        std::to_string(row->spp.size()) + " human thresholds");
        for (const auto& [number, recording] : viewpoint.blocks)
            blocks.push_back(
                {name, number, row->spp.at(size_t(number)), viewpoint.passSpp, &recording});
        if (!blocks.empty() && blocks.front().passSpp != viewpoint.passSpp)
            throw std::invalid_argument(
                "the viewpoint " + name + " was recorded " + PassText(viewpoint.passSpp) + ", '" +
                blocks.front().viewpoint + "' " + PassText(blocks.front().passSpp) +
                "; give viewpoints of one kind, or --without NAME");
    }
    return blocks;
}

TrainingSamples MakeSamples(std::span<const LabelledBlock> blocks, const ModelSettings& settings) {
    CheckSettings(settings);
    TrainingSamples samples{.settings = settings, .windowSize = settings.k * InputCount(settings)};
    std::map<std::string, int> viewpoints;
    for (const LabelledBlock& block : blocks) {
        const int viewpoint =
            viewpoints.try_emplace(block.viewpoint, int(viewpoints.size())).first->second;
        const BlockRecording& recording = *block.recording;
        BlockMemory memory(settings);
        VoteGrid grid(block, settings);
        for (int i = 0; i < recording.Count(); ++i) {
            if (!grid.Takes(i)) continue;
            const int spp = recording.spp[size_t(i)];
            memory.Add(MeasuresOf(recording, i, settings));
            const std::optional<Eigen::MatrixXf> window = memory.WindowAt(spp);
            if (!window) continue;
            samples.windows.insert(samples.windows.end(), window->data(),
                                   window->data() + window->size());
            samples.noisy.push_back(block.human > spp);
            samples.viewpoint.push_back(viewpoint);
        }
    }
    return samples;
}

std::vector<ViewpointRecording> ReadDatasets(const std::vector<std::string>& paths) {
    std::vector<ViewpointRecording> all;
    for (const std::string& path : paths)
        for (const ViewpointRecording& viewpoint : ReadDataset(path)) try {
                AddToDataset(viewpoint, &all);
            } catch (const std::runtime_error& error) {
                throw std::runtime_error(path + ": " + error.what());
            }
    return all;
}

std::vector<LabelledBlock> ReadLabelledBlocks(const std::vector<ViewpointRecording>& viewpoints,
                                              const std::string& human,
                                              const std::vector<std::string>& without,
                                              const WarningSink& warn) try {
    std::vector<ThresholdsRow> rows = ReadThresholds(human);
    for (const std::string& name : without)
        if (std::erase_if(rows, [&](const ThresholdsRow& row) { return row.name == name; }) == 0 &&
            std::ranges::find(viewpoints, name, &ViewpointRecording::name) == viewpoints.end())
            throw std::runtime_error(
                fmt::format("--without: there is no viewpoint '{}'", Printable(name)));
    std::vector<std::string> unknown;
    std::vector<LabelledBlock> blocks = JoinHuman(viewpoints, rows, &unknown);
    for (const std::string& name : unknown)
        if (std::ranges::find(without, name) == without.end())
            warn(fmt::format("{} has no thresholds for '{}'", human, Printable(name)));
    if (blocks.empty())
        throw std::runtime_error(human + ": has thresholds for none of the recorded blocks");
    return blocks;
} catch (const std::invalid_argument& error) {
    throw std::runtime_error(human + ": " + error.what());
}

std::vector<LabelledBlock> KeepRecorded(const std::vector<LabelledBlock>& judged,
                                        const ModelSettings& settings, const WarningSink& warn) {
    if (!Needs(settings, Feature::Attributes26)) return judged;
    std::vector<LabelledBlock> blocks;
    for (const LabelledBlock& block : judged)
        if (!block.recording->absent[ChannelIndex("attributes26")]) blocks.push_back(block);
    if (blocks.empty()) throw std::runtime_error("no block was recorded with attributes26");
    if (blocks.size() < judged.size())
        warn(fmt::format("{} of {} blocks were recorded without attributes26",
                         judged.size() - blocks.size(), judged.size()));
    return blocks;
}

BlockSplit LeaveOut(std::span<const LabelledBlock> blocks, std::span<const std::string> names) {
    BlockSplit split;
    for (const std::string& name : names) {
        if (std::ranges::find(blocks, name, &LabelledBlock::viewpoint) == blocks.end())
            throw std::invalid_argument("--leave-out: there is no viewpoint '" + Printable(name) +
                                        "'");
        split.name.append(split.name.empty() ? "" : ", ").append(name);
    }
    for (const LabelledBlock& block : blocks) {
        const bool isOut = std::ranges::find(names, block.viewpoint) != names.end();
        (isOut ? split.test : split.training).push_back(block);
    }
    return split;
}

std::vector<BlockSplit> LeaveEachOut(std::span<const LabelledBlock> blocks,
                                     std::span<const std::string> together) {
    // Of each part that is left out, the names of its viewpoints; `together` first.
    std::vector<std::vector<std::string>> parts(together.size());
    for (const LabelledBlock& block : blocks) {
        const auto group = std::ranges::find_if(together, [&](const std::string& beginning) {
            return block.viewpoint.starts_with(beginning);
        });
        if (group == together.end() &&
            (parts.size() == together.size() || parts.back().front() != block.viewpoint))
            parts.emplace_back();
        std::vector<std::string>& part =
            group == together.end() ? parts.back() : parts[size_t(group - together.begin())];
        if (part.empty() || part.back() != block.viewpoint) part.push_back(block.viewpoint);
    }
    std::vector<BlockSplit> splits;
    for (size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].empty())
            throw std::invalid_argument("--together: no viewpoint's name begins with '" +
                                        Printable(together[i]) + "'");
        splits.push_back(LeaveOut(blocks, parts[i]));
    }
    if (splits.size() < 2)
        throw std::invalid_argument(
            "--cross-validate: two viewpoints are needed, to leave each out in turn");
    return splits;
}

void KeepListed(std::span<const ThresholdsRow> rows, BlockSplit* split) {
    std::vector<LabelledBlock> kept;
    for (const LabelledBlock& block : split->training) {
        const auto row = std::ranges::find(rows, block.viewpoint, &ThresholdsRow::name);
        if (row == rows.end())
            throw std::invalid_argument("has no row '" + Printable(block.viewpoint) + "'");
        const bool isListed = std::ranges::find(row->spp, block.block) != row->spp.end();
        (isListed ? kept : split->test).push_back(block);
    }
    split->training = std::move(kept);
}

std::vector<LabelledBlock> TestBlocks(std::span<const LabelledBlock> blocks,
                                      std::span<const ThresholdsRow> rows) {
    BlockSplit split{.training = {blocks.begin(), blocks.end()}};
    KeepListed(rows, &split);
    if (split.test.empty())
        throw std::invalid_argument("lists all blocks, so that none is left to judge by");
    return std::move(split.test);
}

}  // namespace lull
