// Frames of `lull render --frames --resume` whose files are there.
#pragma once

#include "renderer/commands/prepared_render.h"

namespace lull::render {

// Returns all that decides the files of a frame, by which --resume knows it; a line each.
std::string SettingsOf(const PreparedRender&);

// Returns whether all files of a frame are there, whole. Throws Error where they are of another
// render.
bool IsFinished(const PreparedRender&);

}  // namespace lull::render
