// Reads the inputs of a network from block histories; renders measure them (model_inputs.h).
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "stopping/features/model_inputs.h"

namespace lull {

// Returns the numbers of a channel that were recorded of a block at some spp. Throws
// std::invalid_argument for channels that were not.
using RecordedValues = std::function<std::span<const float>(std::string_view channel)>;

// Returns the recorded lightness of the sub-blocks.
SubBlockLightness RecordedLightness(const RecordedValues& values);

// Returns the result of MeasureBlock(), up to the rounding of recordings. Throws
// std::invalid_argument if features of the settings were not recorded: entropies are recorded for m
// = 4, 25, 100 and 400, H1 and H2 for m = 100 only, and older blocks have no attributes.
BlockMeasures RecordedMeasures(int spp, const RecordedValues& values,
                               const ModelSettings& settings);

}  // namespace lull
