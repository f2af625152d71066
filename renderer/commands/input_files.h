// Names the files that a command reads, so that its results do not replace them.
#pragma once

#include <vector>

#include "renderer/commands/scene_options.h"
#include "renderer/files/outputs.h"

namespace lull {

// Returns the files of a scene that has been read, with the one that --environment names; for
// CheckOutputs().
std::vector<NamedFile> InputsOf(const SceneOptions&, const Description&);

// Adds the file that a stopping rule names, "learned:M.h5" or "thresholds:F.csv:NAME", if it does.
void AddFileOfRule(const std::string& rule, std::vector<NamedFile>* inputs);

}  // namespace lull
