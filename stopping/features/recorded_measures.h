// Reads the inputs of a network from block histories; renders measure them (model_inputs.h).
#pragma once

#include <functional>
#include <span>
#include <string_view>

#include "stopping/features/model_inputs.h"

namespace lull {

// Returns the numbers that were recorded of a block at some spp under a name, one of kChannels
// (lab/recordings/recording.h). Throws std::invalid_argument for what was not recorded.
using RecordedValues = std::function<std::span<const float>(std::string_view channel)>;

// Returns what was recorded of the lightness of the sub-blocks.
SubBlockLightness RecordedLightness(const RecordedValues& values);

// Returns what MeasureBlock() would, but for the rounding of recordings. Throws
// std::invalid_argument if they do not have what the settings ask for: entropies are recorded for
// m = 4, 25, 100 and 400, H1 and H2 for m = 100 only, and older blocks have no attributes.
BlockMeasures RecordedMeasures(int spp, const RecordedValues& values,
                               const ModelSettings& settings);

}  // namespace lull
