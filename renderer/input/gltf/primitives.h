// Makes triangle meshes of glTF's primitives, and poses them.
#pragma once

#include <functional>
#include <vector>

#include "renderer/input/description.h"
#include "renderer/input/gltf/accessors.h"
#include "renderer/input/gltf/document.h"
#include "renderer/input/gltf/nodes.h"

namespace lull {

// A primitive as triangles; arrays have the given numbers per vertex.
struct GltfTriangles {
    std::vector<float> positions;  // 3
    std::vector<float> normals;    // 3; none: flat shading
    std::vector<float> tangents;   // 4, or none
    std::vector<float> uvs[2];     // 2, or none; v grows upwards, unlike in glTF
    std::vector<float> colors;     // 4, or none
    std::vector<uint32_t> indices;

    size_t VertexCount() const { return positions.size() / 3; }
};

// Calls report(vertex) for each vertex of a triangle that has a value which is not finite, and
// makes its values 0; where it throws, they stay. Vertices of no triangle get those of another.
void ClearNonFinite(const std::vector<uint32_t>& indices, GltfArray* values,
                    const std::function<void(uint32_t vertex)>& report);

// Reads a primitive, with its morph targets added by their weights; no weights: as it stands.
// Points and lines have no triangles: they are skipped with a counted warning. Throws Error, also
// for a position that is not finite; other values then count as 0, with a counted warning.
GltfTriangles ReadPrimitive(const GltfDocument&, int mesh, int primitive,
                            const std::vector<double>& weights, Warnings&);

// Makes tangents for normals and texture coordinates, as MikkTSpace does by default: those of the
// triangles around a vertex, weighted by their angles there. A vertex shared by triangles with
// mirrored and with unmirrored texture becomes two.
void MakeTangents(int uvSet, GltfTriangles* triangles);

// Makes a shape of it, without material.
ShapeEntity MakeShapeEntity(GltfTriangles triangles, const FileLoc& loc);

// Poses meshes by the joints of their skins (3.7.3 of glTF's specification).

// Returns for each joint of a skin the transform of vertices from the bind pose to the world.
// Throws Error for a joint that is not in the scene, or too few inverse bind matrices.
std::vector<Mat4d> JointMatrices(const GltfDocument&, const std::vector<GltfNode>&, int skin);

// Moves the vertices of a primitive, their normals and tangents by their joints into the world.
// Weights are normalised by their sum; vertices without any are moved by the first joint. Throws
// Error for a primitive without joints, and for joints that the skin does not have.
void Skin(const GltfDocument&, int mesh, int primitive, const std::vector<Mat4d>& joints,
          GltfTriangles* triangles);

}  // namespace lull
