// Finds flat slabs in meshes, such as window panes that are modelled with a thickness.
#pragma once

namespace lull {

struct Mesh;

// Returns the number of closed parts of a mesh that are flat, and at least 20 times as wide, in
// both directions, as they are thick. Vertices at the same place are the same.
int CountSlabs(const Mesh&);

}  // namespace lull
