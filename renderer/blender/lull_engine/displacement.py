"""Moves the vertices of meshes as the displacement of their materials does."""
import numpy as np

import groups
from versions import displacement_method

_RAISED = 10  # metres, since negative light might not be baked


def moves(material):
    """Returns whether a material moves vertices; others only change normals."""
    return displacement_method(material) != 'BUMP'


def _source(material):
    output = material.node_tree.get_output_node('CYCLES') if material and material.use_nodes else None
    links = output.inputs['Displacement'].links if output else ()
    return links[0].from_socket if links else None


def apply(made, baker):
    """Displaces the meshes of flattened objects, each once."""
    done = set()
    for o in made:
        if o.data in done:
            continue
        done.add(o.data)
        wanted = [m for m in dict.fromkeys(o.data.materials) if _source(m) and moves(m)]
        if wanted:
            _displace(o, wanted, baker)


def _displace(o, materials, baker):
    mesh = o.data
    sums, counts = np.zeros((len(mesh.vertices), 3)), np.zeros(len(mesh.vertices))
    vertex_of_loop = np.empty(len(mesh.loops), int)
    mesh.loops.foreach_get("vertex_index", vertex_of_loop)
    for material in materials:
        pixels = baker.over_mesh(*_raised(material), o, material)[:, :, :3] - _RAISED
        loops = np.concatenate([list(p.loop_indices) for p in mesh.polygons if mesh.materials[p.material_index] == material])
        uvs = np.empty(2 * len(mesh.loops))
        mesh.uv_layers["lull"].data.foreach_get("uv", uvs)
        found = _sampled(pixels, uvs.reshape(-1, 2)[loops])
        np.add.at(sums, vertex_of_loop[loops], found)
        np.add.at(counts, vertex_of_loop[loops], 1)
    away = sums / np.maximum(counts, 1)[:, None] @ np.linalg.inv(np.array(o.matrix_world.to_3x3())).T
    points = np.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", points)
    mesh.vertices.foreach_set("co", points + away.ravel())
    mesh.update()


def _raised(material):
    """Returns a copy of a material and the output of its displacement, moved up."""
    copy = material.copy()
    groups.inline(copy.node_tree)
    add = copy.node_tree.nodes.new('ShaderNodeVectorMath')
    add.inputs[1].default_value = [_RAISED] * 3
    copy.node_tree.links.new(_source(copy), add.inputs[0])
    return copy, add.outputs[0]


def _sampled(pixels, uvs):
    """Returns the bilinear values at UVs."""
    size = len(pixels)
    at = np.clip(uvs * size - 0.5, 0, size - 1.001)
    x, y = at.astype(int).T
    u, v = (at - at.astype(int)).T[..., None]
    return ((1 - u) * (1 - v) * pixels[y, x] + u * (1 - v) * pixels[y, x + 1] +
            (1 - u) * v * pixels[y + 1, x] + u * v * pixels[y + 1, x + 1])
