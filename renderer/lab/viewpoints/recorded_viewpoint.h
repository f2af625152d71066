// Records a viewpoint: renders its blocks and keeps the data that stopping rules are trained on.
#pragma once

#include <functional>

#include "renderer/lab/viewpoints/picture_folder.h"
#include "renderer/render/session.h"
#include "stopping/lab/recordings/recording.h"

namespace lull {

// Throws Error if there are blocks too small to be recorded.
void CheckRecordable(const std::vector<Block>& blocks, const ScheduleOptions&);

// Returns "" for a valid name of a viewpoint, else the reason why it is not.
std::string CheckViewpointName(const std::string& name);

// Returns the data set of a file; nothing if there is no such file. Throws std::runtime_error.
std::vector<ViewpointRecording> ReadDatasetIfThere(const std::string& path);

// Adds a recording to the data set of a file, or makes it. Concurrent processes wait for each
// other, announced by onWait(). Throws Error and std::runtime_error.
void AddToDatasetFile(const ViewpointRecording&, const std::string& path,
                      const std::function<void()>& onWait);

// Describes a whole recording, without the blocks themselves.
ViewpointRecording MakeViewpoint(const std::string& name, const ScheduleOptions&,
                                 const RenderIdentity&, size_t blockCount);

// Moves the recording of block i into the viewpoint, with a note on its cost.
void AddBlock(size_t i, BlockRecording recording, const BlockResult&, ViewpointRecording*);

// Returns the spp at which each block's recording ends: `cap` for those `chosen` by number, or for
// all if none is chosen; 0 for others. Throws Error for a number that does not exist.
std::vector<int> RecordingLimits(size_t blockCount, const std::vector<int>& chosen, int cap);

// Ends the recording of each block at `past` times its threshold in the file `human`, where that
// is earlier. Throws Error if the file has no such viewpoint, or with other blocks.
void LimitByHuman(const std::string& human, const std::string& viewpoint, double past,
                  std::vector<int>* limits);

// Renders the blocks that have a limit, each to the pass that reaches it, from the start or from
// the film and state of an interrupted recording with the same limits, and adds the records to the
// viewpoint; nothing if it was cancelled. The options have no rule; progress is reported towards
// the limits. Of several ranks, the first has the recordings.
RenderResult RecordBlocks(RenderOptions, const std::vector<int>& limits, ViewpointRecording*);

// Records the pictures of another renderer, for rules to learn from and to be judged on.

struct PictureRecordingOptions {
    int blockSize = 200;           // pixels a side, > 0
    std::vector<int> limits = {};  // spp at which the record of each block ends; empty: none does
    // Called before each picture with the number of pictures read.
    std::function<void(int read, int count)> onPicture = {};
};

// Describes the recording of a folder, without the blocks themselves.
ViewpointRecording DescribePictures(const PictureFolder&, int blockSize);

// Returns the recording of all pictures, a record each, without measurements of half buffers
// (AddPicture()). Blocks with a side below kSmallestVotingSide are left out, and so are those with
// a limit of 0. Throws Error, also if no block is left.
ViewpointRecording RecordPictures(const PictureFolder&, const PictureRecordingOptions&);

}  // namespace lull
