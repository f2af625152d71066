#include "stopping/features/block_memory.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lull {

BlockMemory::BlockMemory(const ModelSettings& settings) : settings(settings), inputs(settings) {}

void BlockMemory::Add(BlockMeasures measures) {
    if (Complete(&measures)) inputs.Add(measures.spp, InputVector(measures, settings));
}

bool BlockMemory::Complete(BlockMeasures* measures) {
    bool complete = true;
    for (size_t i = 0; i < kDrops.size(); ++i) {
        if (!Needs(settings, kDrops[i])) continue;
        const std::vector<double>& entropies = measures->Of(EntropyOf(kDrops[i]));
        auto drop =
            kDrops[i] == Feature::VisibleDrop
                ? AddVisible(measures->spp, entropies, measures->lightness,
                             VisibilityWith(measures->variance, settings.visibility), &drops[i])
                : drops[i].Add(measures->spp, entropies, std::vector<double>(entropies.size(), 1));
        complete = complete && drop;
        if (drop) measures->Of(kDrops[i]) = std::move(*drop);
    }
    return complete;
}

void BlockMemory::Save(StateWriter* writer) const {
    writer->Put(uint32_t(InputCount(settings)));
    writer->Put(uint32_t(inputs.Entries().size()));
    for (const FeatureHistory::Entry& entry : inputs.Entries()) {
        writer->Put(int32_t(entry.spp));
        writer->PutAll(std::span(entry.feature));
    }
    for (size_t i = 0; i < kDrops.size(); ++i)
        if (Needs(settings, kDrops[i])) drops[i].Save(writer);
}

void BlockMemory::Restore(StateReader* reader) {
    const uint32_t count = uint32_t(InputCount(settings));
    if (reader->Get<uint32_t>() != count)
        throw std::runtime_error("the saved state belongs to a model with other inputs");
    inputs.Clear();
    std::vector<double> feature(count);
    for (uint32_t entries = reader->Get<uint32_t>(); entries > 0; --entries) {
        const int spp = reader->Get<int32_t>();
        reader->GetAll(std::span(feature));
        try {
            inputs.Add(spp, feature);
        } catch (const std::invalid_argument& error) {
            throw std::runtime_error(std::string("the saved state of a learned rule is damaged: ") +
                                     error.what());
        }
    }
    const auto subBlocks = [&](Feature f) {
        return size_t(f == Feature::VisibleDrop ? kMeasuredSubBlocks : settings.m);
    };
    for (size_t i = 0; i < kDrops.size(); ++i)
        if (Needs(settings, kDrops[i])) drops[i].Restore(reader, subBlocks(kDrops[i]));
}

}  // namespace lull
