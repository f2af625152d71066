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
    if (!Needs(settings, Feature::VisibleDrop)) return true;
    AddEntropies(measures->spp, measures->Of(Feature::H), &entropies);
    std::optional<std::vector<double>> drop =
        LatestVisibleDrop(entropies, measures->lightness, settings.visibility);
    if (drop) measures->Of(Feature::VisibleDrop) = std::move(*drop);
    return drop.has_value();
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
