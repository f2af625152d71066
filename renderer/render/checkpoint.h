// Keeps interrupted renders: a file with everything that is needed to go on to the same bits.
#pragma once

#include <map>
#include <string>

#include "renderer/render/provenance.h"
#include "renderer/render/render.h"

namespace lull {

// Names everything that decides the pixels and what the criteria see, beside the samples
// themselves: scene, seed, rule, ... A render goes on only if all of it is the same.
using RenderIdentity = std::map<std::string, std::string>;

// Returns what decides the pixels: everything in `provenance` but names of files and the threads,
// and the hash of the scene (SceneHash()).
RenderIdentity IdentityOf(const Provenance& provenance, const std::string& sceneHash);

// Writes film and state to an HDF5 file, whole or not at all, and what was learned, if anything
// (SaveLearning()). A state without blocks stands for a render that is still learning. Throws
// Error.
void WriteCheckpoint(const std::string& path, const RenderIdentity&, const RenderState&,
                     const Film&, std::span<const std::byte> guide = {});

// Fills the film, which has no samples yet, and returns the state; `guide`, if given, receives what
// was learned. Throws Error if the file cannot be read, is damaged, or was written by another
// render: it then says what differs.
RenderState ReadCheckpoint(const std::string& path, const RenderIdentity&, Film*,
                           std::vector<std::byte>* guide = nullptr);

}  // namespace lull
