// Makes triangle meshes of glTF's primitives.
#pragma once

#include "renderer/input/description.h"
#include "renderer/input/gltf/document.h"

namespace lull {

// A primitive as triangles; all arrays but the indices are flat, with the given numbers per
// vertex.
struct GltfTriangles {
    std::vector<float> positions;  // 3
    std::vector<float> normals;    // 3; none: flat shading
    std::vector<float> tangents;   // 4, or none
    std::vector<float> uvs[2];     // 2, or none; v grows upwards, unlike in glTF
    std::vector<float> colors;     // 4, or none
    std::vector<uint32_t> indices;

    size_t VertexCount() const { return positions.size() / 3; }
};

// Reads a primitive, with its morph targets added by their weights; no weights: as it stands.
// Points and lines have no triangles: they are skipped with a counted warning. Throws Error.
GltfTriangles ReadPrimitive(const GltfDocument&, int mesh, int primitive,
                            const std::vector<double>& weights, Warnings&);

// Makes tangents for normals and texture coordinates, as MikkTSpace does by default: those of the
// triangles around a vertex, weighted by their angles there. A vertex shared by triangles with
// mirrored and with unmirrored texture becomes two.
void MakeTangents(int uvSet, GltfTriangles* triangles);

// Makes a shape of it, without material.
ShapeEntity MakeShapeEntity(GltfTriangles triangles, const FileLoc& loc);

}  // namespace lull
