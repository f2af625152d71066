// Puts the recordings of a render into data sets.
#pragma once

#include "renderer/commands/render_settings.h"
#include "stopping/learning/dataset.h"

namespace lull {

// Throws Error if there are blocks too small to be recorded.
void CheckRecordable(const std::vector<Block>& blocks, const ScheduleOptions&);

// Returns the data set of a file; nothing if there is no such file. Throws std::runtime_error.
std::vector<ViewpointRecording> ReadDatasetIfThere(const std::string& path);

// Describes a whole recording but for the blocks themselves.
ViewpointRecording MakeViewpoint(const std::string& name, const ScheduleOptions&,
                                 const RenderIdentity&, size_t blockCount);

// Moves the recording of block i into the viewpoint, with a note on what it cost.
void AddBlock(size_t i, BlockRecording recording, const BlockResult&, ViewpointRecording*);

// Returns "" for a name that viewpoints can have, else what is wrong with it.
std::string CheckViewpointName(const std::string& name);

}  // namespace lull
