#include "stopping/signals/drop_history.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "stopping/signals/ladder.h"

namespace lull {

namespace {

constexpr double kDepth = 4;        // states are kept down to this part of the spp
constexpr double kTolerance = 1.6;  // of half and a quarter of the spp

bool AreFinite(std::span<const float> values) {
    return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
}

}  // namespace

std::optional<std::vector<double>> DropHistory::Add(int spp, std::span<const double> entropies,
                                                    std::span<const double> weights) {
    EntropyState now{.spp = spp, .values = {entropies.begin(), entropies.end()}};
    if (spp < 1 || (!states.empty() && spp <= states.back().spp))
        throw std::invalid_argument("entropies must come with increasing spp");
    if (!AreFinite(now.values) || weights.size() != entropies.size() ||
        (!states.empty() && states.back().values.size() != now.values.size()))
        throw std::invalid_argument("the entropies of a block are not finite or not as many");
    AddToLadder(std::move(now), kDepth, &states);

    const EntropyState* before = FindInLadder(states, spp / 2.0, kTolerance, true);
    if (!before) return {};
    const EntropyState* oldest = FindInLadder(states, before->spp / 2.0, kTolerance, true);
    const bool three = oldest && oldest->spp < before->spp;
    const double rate = three ? RateOfFall(*oldest, *before, states.back(), weights) : 1;
    return EntropyDrop(*before, states.back(), rate);
}

void DropHistory::Save(StateWriter* writer) const {
    writer->Put(uint32_t(states.size()));
    for (const EntropyState& state : states) {
        writer->Put(int32_t(state.spp));
        writer->PutAll(std::span(state.values));
    }
}

void DropHistory::Restore(StateReader* reader, size_t subBlocks) {
    states.clear();
    for (uint32_t count = reader->Get<uint32_t>(); count > 0; --count) {
        EntropyState state{.spp = reader->Get<int32_t>(), .values = std::vector<float>(subBlocks)};
        reader->GetAll(std::span(state.values));
        if (state.spp <= (states.empty() ? 0 : states.back().spp) || !AreFinite(state.values))
            throw std::runtime_error("the saved entropies of a block are damaged");
        states.push_back(std::move(state));
    }
}

std::optional<std::vector<double>> AddVisible(int spp, std::span<const double> entropies,
                                              const SubBlockLightness& lightness,
                                              const NoiseVisibility& visibility,
                                              DropHistory* history) {
    std::vector<double> weights;
    for (const float l : lightness.mean) weights.push_back(l * FlareFactor(l, visibility.flare));
    const auto drop = history->Add(spp, entropies, weights);
    if (!drop) return {};
    return VisibleDrop(*drop, lightness, spp, visibility);
}

}  // namespace lull
