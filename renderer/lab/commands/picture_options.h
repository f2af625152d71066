// Lets commands take folders of another renderer's pictures.
#pragma once

#include <CLI/App.hpp>

#include "renderer/commands/talk.h"
#include "renderer/files/outputs.h"
#include "renderer/lab/viewpoints/picture_recording.h"

namespace lull {

// Adds --images, which can be given again, and --block unless the command has it already.
void AddImagesOptions(CLI::App& app, std::vector<std::string>* folders, int* blockSize);
CLI::Option* AddBlockOption(CLI::App& app, int* blockSize);

// Returns the pictures as files that are read.
std::vector<NamedFile> InputsOf(const PictureFolder& folder);

// Records pictures and tells every ten seconds how far it is, and at last how many there were.
ViewpointRecording RecordAndTell(const PictureFolder& folder, PictureRecordingOptions options,
                                 const Talk& talk);

}  // namespace lull
