// Makes recordings whose channels are functions of the spp.
#pragma once

#include <algorithm>
#include <functional>
#include <string_view>

#include "stopping/lab/recordings/recording.h"

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

}  // namespace lull
