// Compiles a description into a scene that can be rendered.
#pragma once

#include "renderer/scene/scene.h"

namespace lull {

struct CompileOptions {
    FilmOverrides film;
    int maxDepth = -1;  // -1: as the scene says
    // Choose and sample lights as pbrt-v3 does, for its estimator: by tables, however many there
    // are, and environment maps by their whole brightness.
    bool lightsAsPbrtV3 = false;
    int threads = 0;  // for all that is made in parallel; 0: one per core
};

// Throws Error, with file and line, for anything wrong or unsupported, and the errors that parsing
// left in `warnings`: for all of it, as Warnings::ThrowErrors() has it.
std::unique_ptr<const Scene> Compile(const Description&, const CompileOptions&, Warnings&);

// Finds flat slabs in meshes, such as window panes that are modelled with a thickness.

struct Mesh;

// Returns the number of closed parts of a mesh that are flat, and at least 20 times as wide, in
// both directions, as they are thick. Vertices at the same place are the same.
int CountSlabs(const Mesh&);

}  // namespace lull
