// Options that several laboratories have.
#pragma once

#include <CLI/App.hpp>

#include <span>
#include <string>

#include "renderer/commands/command.h"
#include "renderer/files/outputs.h"
#include "renderer/lab/viewpoints/recorded_viewpoint.h"
#include "renderer/vision/visible_difference.h"

namespace lull {

// Adds --split paper:FILE, which sets `file`: the blocks that a model is trained on, and those that
// it is judged by.
void AddSplitOption(CLI::App& app, std::string* file, const std::string& help);

// Adds an option that can be given again.
CLI::Option* AddList(CLI::App& app, const std::string& name, std::vector<std::string>* list,
                     const std::string& help);

// Adds --viewing, the viewing conditions for visible differences; `display` must outlive the
// parsing.
void AddViewingOption(CLI::App& app, DisplayModel* display);

// Throws CLI::ValidationError if an option was given that is not one of `names`, those that have an
// effect `where`, as "without a SCENE".
void AllowOnly(const CLI::App& app, std::span<const char* const> names, const std::string& where);

// Lets commands take folders of another renderer's pictures.

// Adds --images, which can be given again, and --block unless the command has it already.
void AddImagesOptions(CLI::App& app, std::vector<std::string>* folders, int* blockSize);
CLI::Option* AddBlockOption(CLI::App& app, int* blockSize);

// Returns the pictures as files that are read.
std::vector<NamedFile> InputsOf(const PictureFolder& folder);

// Records pictures and tells every ten seconds how far it is, and at last how many there were.
ViewpointRecording RecordAndTell(const PictureFolder& folder, PictureRecordingOptions options,
                                 const Messages& messages);

// Adds the recording to the data set of a file, or makes it. Tells where it waits for another
// process.
void WriteRecording(const ViewpointRecording&, const std::string& path, const Messages&,
                    ResultFiles*);

}  // namespace lull
