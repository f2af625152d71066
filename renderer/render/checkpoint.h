// Checkpoint files: the complete state of a render, to continue it to the same bits.
#pragma once

#include <string>

#include "renderer/render/provenance.h"
#include "renderer/render/render.h"

namespace lull {

// Writes film and state to an HDF5 file, whole or not at all. Throws Error.
void WriteCheckpoint(const std::string& path, const RenderIdentity&, const RenderState&,
                     const Film&);

// Settings that may differ from the checkpoint's: none, or the settings that decide when blocks
// stop, which are the rule, with its model, and the cap.
enum class MayDiffer { Nothing, Stops };

// Fills the film, which has no samples yet, and returns the state. Layers that the film has must be
// in the checkpoint; others there are left out. Throws Error if the file cannot be read, is
// damaged, or was written by another render: the message names the difference.
//
// With a larger cap blocks at the old cap continue. With another rule all do; the state then has
// neither criteria nor decisions: each starts again, at the sample count of its block.
RenderState ReadCheckpoint(const std::string& path, const RenderIdentity&, Film*,
                           MayDiffer = MayDiffer::Nothing);

}  // namespace lull
