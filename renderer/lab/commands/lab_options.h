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

// Adds --split paper:FILE, which sets `file`: the blocks that a model is trained on.
void AddSplitOption(CLI::App& app, std::string* file, const std::string& help);

CLI::Option* AddList(CLI::App& app, const std::string& name, std::vector<std::string>* list,
                     const std::string& help);

// Adds --viewing, for visible differences; `display` must outlive the parsing.
void AddViewingOption(CLI::App& app, DisplayModel* display);

// Throws CLI::ValidationError for an option not of `names`, which have an effect `where`.
void AllowOnly(const CLI::App& app, std::span<const char* const> names, const std::string& where);

// Lets commands take folders of another renderer's pictures.

// Adds --images, which can be given again, and --block unless the command has it already.
void AddImagesOptions(CLI::App& app, std::vector<std::string>* folders, int* blockSize);
CLI::Option* AddBlockOption(CLI::App& app, int* blockSize);

std::vector<NamedFile> InputsOf(const PictureFolder& folder);

// Records pictures and tells every ten seconds how far it is, and at last how many there were.
ViewpointRecording RecordAndTell(const PictureFolder& folder, PictureRecordingOptions options,
                                 const Messages& messages);

// Adds the recording to a file's data set, or makes it. Tells where it waits for others.
void WriteRecording(const ViewpointRecording&, const std::string& path, const Messages&,
                    ResultFiles*);

}  // namespace lull
