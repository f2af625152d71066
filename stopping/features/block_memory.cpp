#include "stopping/features/block_memory.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace lull {

BlockMemory::BlockMemory(const ModelSettings& settings) : settings(settings) {
    CheckSettings(settings);
}

void BlockMemory::Add(BlockMeasures measures) {
    if (Complete(&measures))
        AddInputs(measures.spp, InputVector(measures, settings), settings, &inputs);
}

bool BlockMemory::Complete(BlockMeasures* measures) {
    if (std::ranges::none_of(settings.features, IsDrop)) return true;
    const std::vector<double>& h = measures->Of(Feature::H);
    AddEntropies(measures->spp, h, &entropies);
    bool complete = true;
    const auto put = [&](Feature feature, const auto& measure) {
        if (!Needs(settings, feature)) return;
        std::optional<std::vector<double>> drop = measure();
        complete = complete && drop;
        if (drop) measures->Of(feature) = std::move(*drop);
    };
    put(Feature::EntropyDrop,
        [&] { return LatestDrop(entropies, std::vector<double>(h.size(), 1)); });
    put(Feature::VisibleDrop, [&] {
        return LatestVisibleDrop(entropies, measures->lightness,
                                 VisibilityWith(measures->variance, settings.visibility));
    });
    return complete;
}

void BlockMemory::Save(StateWriter* writer) const {
    writer->Put(uint32_t(InputCount(settings)));
    inputs.Save(writer);
    entropies.Save(writer);
}

void BlockMemory::Restore(StateReader* reader) {
    const uint32_t count = uint32_t(InputCount(settings));
    if (reader->Get<uint32_t>() != count)
        throw std::runtime_error("the saved state belongs to a model with other inputs");
    inputs.Restore(reader, count);
    entropies.Restore(reader, size_t(settings.m));
}

}  // namespace lull
