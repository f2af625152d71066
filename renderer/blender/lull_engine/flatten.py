"""Makes a scene of plain meshes, one for each that a render shows, however it came about: modifiers, instances, particles,
metaballs and text. Copies share their mesh."""
import functools

import bpy
from mathutils import Matrix

import generated
import matrices
import normals
import strands

_MESHES = {'MESH', 'CURVE', 'SURFACE', 'META', 'FONT'}
_CURVES = {'CURVE', 'SURFACE', 'FONT'}
_UNSEEN = {'CAMERA', 'LIGHT', 'EMPTY', 'ARMATURE', 'LATTICE', 'SPEAKER', 'LIGHT_PROBE',
           'GPENCIL'}  # which Blender draws over pictures of all engines
_PARENT = "lull parent"
_BOUNCES = "diffuse", "glossy", "transmission"
SEEING_RAYS = "camera", "volume_scatter", *_BOUNCES


def flatten(flat, wanted, override, moving, notes):
    """Fills an empty scene with the meshes of the objects `wanted`, all of the material `override` if there is one, and marks
    those that are `moving`.

    Returns: its objects. Lights and cameras are left to others.
    """
    made, meshes, shown, copied = [], {}, set(), {}
    undeformed = generated.undeformed()
    graph, layer = bpy.context.evaluated_depsgraph_get(), bpy.context.view_layer
    # Of curves and texts, Blender lists the mesh as an instance beside the object itself.
    listed = {i.parent.original for i in graph.object_instances if i.is_instance}
    for instance in graph.object_instances:
        o = instance.object
        source = instance.parent.original if instance.is_instance else o.original
        if source not in wanted or not is_seen(o.original, ("shadow", *SEEING_RAYS)):
            continue
        if not instance.is_instance and not shows_itself(instance, listed):
            continue
        before = len(made)
        if o.original.particle_systems and layer.use_strand:
            _place_hair(flat, instance, graph, override, meshes, made)
            _mark(made[before:], moving, instance, layer)
        if o.type == 'CURVES' and not layer.use_strand or o.type in _MESHES and not layer.use_solid:
            continue
        if o.type == 'CURVES' and (mesh := strands.of_curves(o)):
            if override:
                mesh.materials[0] = override
            made.append(_place(flat, o.original, mesh, instance.matrix_world.copy()))
            _mark(made[-1:], moving, instance, layer)
            continue
        if o.type not in _MESHES:
            if o.type not in _UNSEEN:
                notes.add("left out, as glTF has nothing alike", o.original.name)
            continue
        key = _key(o)
        if key not in meshes:
            mesh = meshes[key] = _mesh(o, instance.is_instance, graph, override)
            is_mesh = mesh is not None and o.original.type == 'MESH'  # a text lists a mesh, too
            if is_mesh and normals.lean_from_faces(mesh):
                notes.add("lit otherwise along edges, where smooth normals lean far from faces", o.original.name)
            if is_mesh:
                generated.settle(mesh, o, undeformed, notes)
        if meshes[key] is not None:
            if instance.is_instance:
                copied[key] = copied.get(key, 0) + 1
            made.append(_place(flat, o.original, meshes[key], instance.matrix_world.copy()))
            _mark(made[-1:], moving, instance, layer)
            shown.add(o.original)
    if override is None:
        _note_copies({name for key, n in copied.items() if n > 1 for name in key[2] if name}, notes)
    for original in shown:
        _note_of(original, notes)
    return made


def _mark(placed, moving, instance, layer):
    those = [instance.object.original] + ([instance.parent.original] if instance.is_instance else [])
    is_hidden = not all(o.visible_camera for o in those) or those[0].indirect_only_get(view_layer=layer)
    is_shadowless = not all(o.visible_shadow for o in those)
    for o in placed:
        moving.mark(o, instance)
        if is_hidden:
            o["lull_hidden"] = True
        if is_shadowless:
            o["lull_shadowless"] = True


def is_seen(o, rays):
    """Returns whether any of these kinds of rays see an object."""
    return any(getattr(o, "visible_" + ray) for ray in rays)


def shows_itself(instance, listed):
    """Returns whether an object is shown where it stands; `listed`: the objects whose meshes are instances, too."""
    o = instance.object.original
    is_copied = o.parent is not None and o.parent.instance_type in ('VERTS', 'FACES')
    return instance.show_self and not is_copied and not (o.type in _CURVES and o in listed)


def _place_hair(flat, instance, graph, override, meshes, made):
    original = instance.object.original
    key = "hair of " + original.name_full
    if key not in meshes:
        meshes[key] = strands.of_particles(original, graph)
    away = instance.matrix_world @ original.evaluated_get(graph).matrix_world.inverted()
    for mesh in meshes[key]:
        if override:
            mesh.materials[0] = override
        made.append(_place(flat, original, mesh, away))


def _key(o):
    materials = [slot.material for slot in o.material_slots]
    # Materials that ask who they are on, or where, are baked for each object.
    asks = any(m and m.use_nodes and _asks(m.node_tree, False) for m in materials)
    return (o.data.as_pointer() if o.data else 0, o.type, tuple(m.name if m else "" for m in materials),
            o.original.name if asks else "")


def _mesh(o, is_instance, graph, override):
    """Returns a mesh with the materials of an evaluated object; None where there are no faces."""
    if is_instance and o.type == 'MESH':  # which may have no object of its own
        mesh = o.data.copy()
    else:
        mesh = bpy.data.meshes.new_from_object(o, preserve_all_data_layers=True, depsgraph=graph)
    if mesh is None or not mesh.polygons:
        return None
    materials = [slot.material.original if slot.material else None for slot in o.material_slots]
    last = max(len(materials) - 1, 0)
    indices = [min(p.material_index, last) for p in mesh.polygons]
    mesh.materials.clear()  # and the indices
    for material in materials or [None]:
        mesh.materials.append(override or material)
    mesh.polygons.foreach_set("material_index", indices)
    return mesh


def is_sheared(matrix):
    """Returns whether a matrix is no rotation and scale, as glTF's nodes are."""
    apart = Matrix.LocRotScale(*matrix.decompose()) - matrix
    size = max(abs(v) for row in matrix.to_3x3() for v in row)
    return max(abs(v) for row in apart for v in row) > 1e-5 * max(size, 1e-9)


def _place(flat, original, mesh, matrix):
    """Adds an object. Where it is sheared it has a parent until move_sheared(), as textures are baked over its own coordinates."""
    o = bpy.data.objects.new(original.name, mesh)
    if is_sheared(matrix):
        o.parent = bpy.data.objects.get(_PARENT) or bpy.data.objects.new(_PARENT, None)
        o.matrix_parent_inverse = matrix
        o["lull_matrix"] = matrices.packed(matrix)
    o.matrix_world = matrix
    o["lull_source"], o["lull_group"] = original.name, original.lightgroup
    o.color, o.pass_index = original.color, original.pass_index
    for name in _properties() & set(original.keys()):
        o[name] = original[name]
    flat.collection.objects.link(o)
    return o


@functools.cache
def _properties():
    """Returns the names of properties of objects that materials ask for."""
    trees = [m.node_tree for m in bpy.data.materials if m.use_nodes] + list(bpy.data.node_groups)
    return {n.attribute_name for tree in trees for n in tree.nodes if n.type == 'ATTRIBUTE' and n.attribute_type == 'OBJECT'}


def move_sheared(made):
    """Moves the vertices of objects that are sheared: nodes of glTF cannot be so."""
    for o in made:
        values = o.get("lull_matrix")
        if values is None:
            continue
        del o["lull_matrix"]
        matrix, = matrices.unpacked(values)
        o.data = o.data.copy()
        o.data.transform(matrix)
        if matrix.determinant() < 0:
            o.data.flip_normals()
        o.parent = None
        o.matrix_world = Matrix.Identity(4)
        if moves := o.get("lull_moves"):
            o["lull_moves"] = matrices.packed(*(place @ matrix.inverted() for place in matrices.unpacked(moves)))


def leave_copies(flat):
    """Leaves of the objects that share a mesh one, and of the others their places: empties that name it as "lull_mesh".

    Blender's exporter validates the mesh of each object: 300 copies of 405,000 triangles take minutes.
    """
    first = {}
    for o in list(flat.collection.objects):
        if o.type != 'MESH' or first.setdefault(o.data, o) is o:
            continue
        place = bpy.data.objects.new(o.name, None)
        place.matrix_world = o.matrix_world
        for name, value in o.items():
            place[name] = value
        place["lull_mesh"] = first[o.data].name
        flat.collection.objects.unlink(o)
        flat.collection.objects.link(place)


def undress_others(flat):
    """Removes the materials of all meshes but those of a scene: where a material uses a UV map by its name, Blender's exporter
    asks all meshes for their materials, and fails at an empty slot."""
    used = {o.data for o in flat.collection.objects}
    for mesh in bpy.data.meshes:
        if mesh not in used:
            mesh.materials.clear()


def _note_copies(names, notes):
    """Notes those of the materials of copies that ask which copy they are on."""
    for name in names:
        material = bpy.data.materials[name]
        if material.use_nodes and _asks(material.node_tree, True):
            notes.add("the same on all copies", name, "materials")


def _asks(tree, is_copy):
    """Returns whether nodes tell objects apart, or copies of one."""
    for node in tree.nodes:
        used = {o.name for o in node.outputs if o.links}
        is_placed = node.type == 'NEW_GEOMETRY' and 'Position' in used or \
            node.type == 'TEX_COORD' and node.object and 'Object' in used
        is_named = node.type == 'OBJECT_INFO' and bool(used & ({'Location', 'Random'} if is_copy else used))
        is_named |= not is_copy and node.type == 'ATTRIBUTE' and node.attribute_type == 'OBJECT'
        is_copied = is_copy and (node.type == 'PARTICLE_INFO' and used or
                                 node.type == 'ATTRIBUTE' and node.attribute_type == 'INSTANCER' or
                                 getattr(node, "from_instancer", False) and used)
        if is_placed or is_named or is_copied or node.type == 'GROUP' and node.node_tree and _asks(node.node_tree, is_copy):
            return True
    return False


def _note_of(original, notes):
    for system in original.particle_systems:
        settings = system.settings
        if settings.render_type in ('LINE', 'HALO') or settings.type != 'HAIR' and settings.render_type == 'PATH':
            notes.add("without particles that are lines or points", original.name)
    if getattr(original.cycles, "use_adaptive_subdivision", False):
        notes.add("subdivided as its modifier says, not adaptively", original.name)
    if original.is_shadow_catcher or original.is_holdout:
        notes.add("shown as surfaces, not as shadow catchers or holdouts", original.name)
    if not all(is_seen(original, (ray,)) for ray in _BOUNCES):
        notes.add("seen by light that other surfaces reflect, whatever its visibility", original.name)
    if original.cycles.shadow_terminator_offset > 0 and any(p.use_smooth for p in getattr(original.data, "polygons", ())):
        notes.add("brighter near the edge of its own shadow, without its Shading Offset", original.name)
