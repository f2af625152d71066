"""Generated coordinates of meshes as Cycles has them: of the shape before anything deforms it, in the box of the mesh without
modifiers."""
import bpy
import numpy as np

import groups

_ATTRIBUTE = "lull generated"
_DEFORM = {'ARMATURE', 'CAST', 'CURVE', 'DISPLACE', 'HOOK', 'LAPLACIANDEFORM', 'LATTICE', 'MESH_DEFORM', 'SHRINKWRAP', 'SIMPLE_DEFORM',
           'SMOOTH', 'CORRECTIVE_SMOOTH', 'LAPLACIANSMOOTH', 'SURFACE_DEFORM', 'WARP', 'WAVE', 'MESH_CACHE', 'CLOTH', 'SOFT_BODY'}
_SIMULATE = {'CLOTH', 'SOFT_BODY', 'PARTICLE_SYSTEM', 'DYNAMIC_PAINT', 'FLUID', 'EXPLODE'}  # whose caches another shape clears
_TEXTURES = {'TEX_NOISE', 'TEX_MUSGRAVE', 'TEX_VORONOI', 'TEX_WAVE', 'TEX_MAGIC', 'TEX_CHECKER', 'TEX_BRICK', 'TEX_GRADIENT'}


def undeformed():
    """Returns the vertices, before anything deforms them, of evaluated meshes with materials that ask for them, by the names of
    objects; None for those that are simulated."""
    wanted, before = [o for o in bpy.data.objects if _is_deformed(o) and _asks_any(o)], []
    found = {o.name_full: None for o in wanted}
    wanted = [o for o in wanted if not any(m.type in _SIMULATE for m in o.modifiers)]
    for o in wanted:
        if o.data.shape_keys:
            before += [(o, "active_shape_key_index", o.active_shape_key_index), (o, "show_only_shape_key", o.show_only_shape_key)]
            o.active_shape_key_index, o.show_only_shape_key = 0, True
        for modifier in o.modifiers:
            if modifier.type in _DEFORM and modifier.show_viewport:
                before.append((modifier, "show_viewport", True))
                modifier.show_viewport = False
    if wanted:
        graph = bpy.context.evaluated_depsgraph_get()
        for o in wanted:
            vertices = o.evaluated_get(graph).data.vertices
            found[o.name_full] = np.empty(3 * len(vertices), np.float32)
            vertices.foreach_get("co", found[o.name_full])
    for owner, name, value in before:
        setattr(owner, name, value)
    return found


def _is_deformed(o):
    return o.type == 'MESH' and (o.data.shape_keys or any(m.show_viewport and m.type in _DEFORM for m in o.modifiers))


def _asks_any(o):
    return any(s.material and s.material.use_nodes and _asks(s.material.node_tree) for s in o.material_slots)


def _asks(tree):
    return any(n.type == 'TEX_COORD' and n.outputs['Generated'].links or _is_texture(n) or
               n.type == 'GROUP' and n.node_tree and _asks(n.node_tree) for n in tree.nodes)


def _is_texture(node):
    """Returns whether a node has the generated coordinates without a link."""
    return node.type in _TEXTURES and not node.inputs['Vector'].links


def settle(mesh, o, vertices, notes):
    """Gives a flattened mesh of an object the box, and the vertices of undeformed()."""
    original = o.original.data
    if original.name != o.data.name:  # of geometry nodes
        return
    mesh.use_auto_texspace = False
    mesh.texspace_location, mesh.texspace_size = original.texspace_location, original.texspace_size
    if o.original.name_full not in vertices:
        return
    found = vertices[o.original.name_full]
    if found is None or found.size != 3 * len(mesh.vertices):
        notes.add("with generated coordinates of its deformed shape", o.original.name)
        return
    size = np.array(mesh.texspace_size)
    values = 0.5 + (found.reshape(-1, 3) - np.array(mesh.texspace_location)) * np.where(size, 0.5 / np.where(size, size, 1), 0)
    mesh.attributes.new(_ATTRIBUTE, 'FLOAT_VECTOR', 'POINT').data.foreach_set("vector", values.astype(np.float32).ravel())


def take(tree, mesh):
    """Lets the nodes of a material read the coordinates that settle() gave a mesh."""
    if _ATTRIBUTE not in mesh.attributes:
        return
    source = tree.nodes.new('ShaderNodeAttribute')
    source.attribute_name = _ATTRIBUTE
    for node in tree.nodes:
        if _is_texture(node):
            tree.links.new(source.outputs['Vector'], node.inputs['Vector'])
        elif node.type == 'TEX_COORD' and not node.from_instancer:
            groups.replace(tree, node.outputs['Generated'], source.outputs['Vector'])
