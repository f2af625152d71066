#include "stopping/lab/recordings/training_samples.h"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>

#include "stopping/features/block_memory.h"

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
            blocks.push_back({name, number, row->spp.at(size_t(number)), viewpoint.cap,
                              viewpoint.passSpp, &recording});
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

}  // namespace lull
