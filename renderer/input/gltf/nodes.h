// Walks the node hierarchy of a glTF file, and converts what stands there.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/input/description.h"
#include "renderer/input/gltf/document.h"
#include "renderer/input/gltf_loader.h"

namespace lull {

struct GltfNode {
    int index = -1;  // into the file's nodes
    Mat4d worldFromNode = Mat4d::Identity();
    std::optional<Mat4d> atClose = {};  // of one that moves: the same when the shutter closes
    bool isVisible = true;              // its mesh and light are (KHR_node_visibility)
};

// Lists the nodes of the file's scene (of its first one if it names none; all roots if it has
// none), parents before their children. Throws Error if a node has two parents, as in a cycle, or
// its transform is not finite.
std::vector<GltfNode> ListNodes(const GltfDocument&);

// Lists the nodes as the options pose them: by an animation while the shutter is open, or as in the
// file, with a warning if there are animations. Joints and weights have their values at the opening
// of the shutter, with a warning. Throws Error for animations that are not
// there or whose keys are wrong, and as ListNodes() does.
std::vector<GltfNode> PoseNodes(const GltfOptions&, GltfDocument*, Warnings&);

// Returns the transforms of the copies of a node's mesh that EXT_mesh_gpu_instancing asks for, in
// the space of the node; a single identity without it. Throws Error.
std::vector<Mat4d> ReadCopies(const GltfDocument&, int node);

// Makes a matrix of a translation, a rotation (a quaternion x, y, z, w of any length) and a scale.
Mat4d MatrixOf(const Eigen::Vector3d& translation, const Eigen::Vector4d& rotation,
               const Eigen::Vector3d& scale);

// Finds the materials that a glTF file has under other names (KHR_materials_variants).

std::vector<std::string> VariantNames(const GltfDocument&);

// Gives all primitives the materials that they have in the variant of that name or number, from 0;
// those that it does not name keep their own. Throws Error if there is none such.
void UseVariant(const std::string& wanted, GltfDocument*);

// Reads our own properties of nodes and materials that say which rays do not see them.

// Rays that pass the mesh of a node, the sphere of its light, or a surface.
struct GltfVisibility {
    bool hiddenFromCamera = false, castsNoShadow = false;

    auto operator<=>(const GltfVisibility&) const = default;
};

// Reads the `extras` of the node or material at the JSON pointer `path`. Throws Error.
GltfVisibility VisibilityOf(const GltfDocument&, const tinygltf::Value& extras,
                            const std::string& path);
GltfVisibility VisibilityOf(const GltfDocument&, int node);

// Adds parameters of a shape.
void Hide(const GltfVisibility&, Parameters*);

// Converts punctual lights of glTF (KHR_lights_punctual) to lights of a Description.

// Lumens per watt at 555 nm (CIE), which convert photometric units to radiometric ones.
inline constexpr double kLumensPerWatt = 683;

// Adds the light of a node, if it has one. The specification's lux and candela are divided by
// kLumensPerWatt, as exporters multiply by it. Throws Error.
void AddLight(const GltfDocument&, const GltfNode&, Description*, Warnings&);

}  // namespace lull
