// Makes recordings of blocks that were never rendered.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <string_view>

#include "stopping/lab/recordings/recording.h"
#include "stopping/rules/thresholds.h"

namespace lull {

// Returns a recording of the passes that recordings have, in passes of 20 spp up to `end`, with all
// values 0.
inline BlockRecording EmptyRecording(int end) {
    BlockRecording recording;
    for (int spp = 20; spp <= end; spp += 20)
        if (spp == end || IsRecorded(spp, 20, 10000)) recording.spp.push_back(spp);
    recording.values.assign(recording.spp.size() * size_t(kRecordLength), 0);
    return recording;
}

// Sets all numbers of a channel to a function of the spp.
inline void SetChannel(BlockRecording* recording, std::string_view channel,
                       const std::function<double(int spp)>& value) {
    for (int i = 0; i < recording->Count(); ++i)
        std::fill_n(&recording->values[size_t(i) * kRecordLength + size_t(ChannelOffset(channel))],
                    ChannelCount(channel), float(value(recording->spp[size_t(i)])));
}

// Returns a recording whose noise in lightness is `noise` / sqrt(spp) and whose entropies exceed
// 0.3 by a tenth of that, both with some spread over sub-blocks and time.
inline BlockRecording MakeRecording(double noise, int end, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> gauss;
    BlockRecording recording;
    for (int spp = 20; spp <= end; spp += 20) {
        if (!IsRecorded(spp, 20, end)) continue;
        recording.spp.push_back(spp);
        for (const Channel& channel : kChannels)
            for (int i = 0; i < channel.count; ++i) {
                const double level = noise / std::sqrt(spp) * std::exp(0.1 * gauss(generator));
                const bool isEntropy = channel.name[0] == 'h' && channel.name != "half_noise";
                const bool isFixed = channel.name == "lightness" || channel.name == "deviation" ||
                                     channel.name == "texture";
                recording.values.push_back(float(isEntropy ? std::min(0.3 + level / 10, 1.0)
                                                 : isFixed ? 10 + i % 7
                                                           : level));
            }
    }
    return recording;
}

// Returns a viewpoint of 16 blocks in which people see noise where it is above 1: block i has the
// human threshold (20 + 2 i)^2. Only `recorded` blocks are there.
inline ViewpointRecording MakeViewpoint(const std::string& name, int recorded, int end = 4000) {
    ViewpointRecording viewpoint{.name = name,
                                 .blockCount = 16,
                                 .cap = end,
                                 .passSpp = 20,
                                 .provenance = {{"scene", "made up"}},
                                 .blocks = {},
                                 .blockNotes = {}};
    for (int i = 0; i < recorded; ++i)
        viewpoint.blocks[i] = MakeRecording(20 + 2 * i, end, unsigned(i + 100 * int(name.back())));
    return viewpoint;
}

inline ThresholdsRow MakeHumanRow(const std::string& name) {
    ThresholdsRow row{name, {}};
    for (int i = 0; i < 16; ++i) row.spp.push_back((20 + 2 * i) * (20 + 2 * i));
    return row;
}

}  // namespace lull
