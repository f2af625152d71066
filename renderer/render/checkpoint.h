// Keeps interrupted renders: a file with everything that is needed to go on to the same bits.
#pragma once

#include <span>
#include <string>

#include "renderer/render/provenance.h"
#include "renderer/render/render.h"

namespace lull {

// Writes film, layers and state to an HDF5 file, whole or not at all, and what was learned, if
// anything (GuideLearner::Save()). Throws Error.
void WriteCheckpoint(const std::string& path, const RenderIdentity&, const RenderState&,
                     const Film&, const Layers& = {}, std::span<const std::byte> guide = {});

// What of a render may differ from what wrote its checkpoint: nothing, or when blocks stop,
// which is the rule, with its model, and the cap.
enum class MayDiffer { Nothing, Stops };

// Fills the film, which has no samples yet, and the layers, and returns the state; `guide`, if
// given, receives what was learned. A checkpoint with layers can be read without, but not the other
// way round. Throws Error if the file cannot be read, is damaged, or was written by another render:
// it then says what differs.
//
// With a larger cap blocks that were at the cap go on. With another rule all do; the state then has
// neither criteria nor what they said: each begins anew, at the samples that its block has.
RenderState ReadCheckpoint(const std::string& path, const RenderIdentity&, Film*,
                           const Layers& = {}, std::vector<std::byte>* guide = nullptr,
                           MayDiffer = MayDiffer::Nothing);

}  // namespace lull
