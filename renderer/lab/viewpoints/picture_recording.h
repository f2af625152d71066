// Records the pictures of another renderer, for rules to learn from and to be judged on.
#pragma once

#include <functional>

#include "renderer/lab/viewpoints/picture_folder.h"
#include "stopping/lab/recordings/dataset.h"

namespace lull {

struct PictureRecordingOptions {
    int blockSize = 200;           // pixels a side, > 0
    std::vector<int> limits = {};  // spp at which the record of each block ends; empty: none does
    // Called before each picture with the number of pictures read.
    std::function<void(int read, int count)> onPicture = {};
};

// Describes the recording of a folder, without the blocks themselves.
ViewpointRecording DescribePictures(const PictureFolder&, int blockSize);

// Returns the recording of all pictures, a record each, without measurements of half buffers
// (AddPicture()). Blocks with a side below kSmallestVotingSide are left out, as rules do not check
// them, and so are those with a limit of 0. Shares the blocks between threads. Throws Error, also
// if no block is left.
ViewpointRecording RecordPictures(const PictureFolder&, const PictureRecordingOptions&);

}  // namespace lull
