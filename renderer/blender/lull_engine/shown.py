"""All that a render shows: objects, instances, particles, metaballs and text, as places of meshes. Copies share
their mesh."""
from dataclasses import dataclass

from mathutils import Matrix

from . import meshes, normals, strands
from .nodes import all_nodes

_MESHES = {'MESH', 'CURVE', 'SURFACE', 'META', 'FONT'}
_CURVES = {'CURVE', 'SURFACE', 'FONT'}
_UNSEEN = {'CAMERA', 'LIGHT', 'EMPTY', 'ARMATURE', 'LATTICE', 'SPEAKER', 'LIGHT_PROBE',
           'GPENCIL', 'GREASEPENCIL'}  # which Blender draws over pictures of all engines
BOUNCES = "diffuse", "glossy", "transmission"
SEEING_RAYS = "camera", "volume_scatter", *BOUNCES
_TEXTURES = {'TEX_NOISE', 'TEX_MUSGRAVE', 'TEX_VORONOI', 'TEX_WAVE', 'TEX_MAGIC', 'TEX_CHECKER', 'TEX_BRICK', 'TEX_GRADIENT'}


@dataclass(eq=False)
class Shown:
    """A place of a mesh. `original` is the object that has it, `moves` are its places when the shutter opens and closes, or None."""
    name: str
    mesh: object
    matrix: Matrix
    group: str
    original: object
    is_hidden: bool = False
    is_shadowless: bool = False
    moves: tuple = None


@dataclass
class Lamp:
    """A light: its evaluated data, where it is, and the object that has it."""
    data: object
    matrix: Matrix
    original: object


class Collector:
    """Reads the depsgraph of a render: `shown` and `lamps`. `override` is the material of all, or None."""

    def __init__(self, graph, layer, moving, notes):
        self.shown, self.lamps = [], []
        self._graph, self._layer, self._moving, self._notes = graph, layer, moving, notes
        self._override = graph.view_layer_eval.material_override
        self._meshes, self._copied, self._asked, self._keys = {}, {}, {}, {}
        # Of curves and texts, Blender lists the mesh as an instance beside the object itself.
        listed = {i.parent.original for i in graph.object_instances if i.is_instance}
        for instance in graph.object_instances:
            with notes.of(instance.object.name):
                self._add(instance, listed)
        if self._override is None:
            self._note_copies()
        for original in {s.original: None for s in self.shown}:
            with notes.of(original.name):
                _note_of(original, notes)

    def _add(self, instance, listed):
        o, original = instance.object, instance.object.original
        if not is_seen(original, ("shadow", *SEEING_RAYS)):
            return
        if o.type == 'LIGHT':
            if not _is_portal(o.data) and (instance.is_instance or _shows_itself(instance, ())):
                self.lamps.append(Lamp(o.data, instance.matrix_world.copy(), original))
            return
        if not instance.is_instance and not _shows_itself(instance, listed):
            return
        if original.particle_systems and self._layer.use_strand and instance.show_particles:
            self._add_hair(instance)
        if not (self._layer.use_strand if o.type == 'CURVES' else self._layer.use_solid):
            return
        if o.type not in _MESHES and o.type != 'CURVES':
            if o.type not in _UNSEEN:
                self._notes.add("left out, as glTF has nothing alike", original.name)
            return
        key = self._key(o)
        if key not in self._meshes:
            self._meshes[key] = self._read(o, original)
        if self._meshes[key] is not None:
            if instance.is_instance:
                self._copied[key] = self._copied.get(key, 0) + 1
            self._place(instance, self._meshes[key], instance.matrix_world.copy())

    def _place(self, instance, mesh, matrix):
        original = instance.object.original
        if not all(abs(v) < meshes.FAR for row in matrix for v in row):
            self._notes.add("left out, as it is nowhere", original.name)
            return
        those = [original, instance.parent.original] if instance.is_instance else [original]
        self.shown.append(Shown(
            original.name, mesh, matrix, original.lightgroup, original,
            not all(o.visible_camera for o in those) or original.indirect_only_get(view_layer=self._layer),
            not all(o.visible_shadow for o in those), self._moving.of(instance, matrix)))

    def _add_hair(self, instance):
        original = instance.object.original
        key = "hair of " + original.name_full
        seen = original.evaluated_get(self._graph)
        if key not in self._meshes:
            self._meshes[key] = strands.of_particles(seen, self._notes)
            for mesh in self._meshes[key]:
                self._override_in(mesh)
        away = instance.matrix_world @ seen.matrix_world.inverted_safe()
        for mesh in self._meshes[key]:
            self._place(instance, mesh, away)

    def _key(self, o):
        """Returns the key that copies of a mesh share: data and materials, and the object if they ask for it."""
        data, original = o.data, o.original
        known = data.as_pointer() if data else 0, original
        if known not in self._keys:
            materials = [slot.material for slot in o.material_slots]
            asks = any(self._asks(m, False) for m in materials)
            self._keys[known] = known[0], o.type, tuple(m.name_full if m else "" for m in materials), original.name_full if asks else ""
        return self._keys[known]

    def _read(self, o, original):
        if o.type == 'CURVES':
            mesh = strands.of_curves(o, self._notes)
        else:
            is_mesh = o.type == 'MESH' and not o.data.is_editmode
            data = o.data if is_mesh else o.to_mesh()
            materials = [slot.material for slot in o.material_slots]
            asks = any(n.type == 'TEX_COORD' and n.outputs['Generated'].is_linked or reads_generated(n)
                       for m in [*materials, self._override] if m and m.use_nodes for n in all_nodes(m.node_tree))
            mesh = meshes.of_blender(data, original.name, asks) if data else None
            if mesh is not None:
                mesh.materials = materials or [None]
                mesh.slots = mesh.slots.clip(0, len(mesh.materials) - 1)
            if not is_mesh:
                o.to_mesh_clear()
        if mesh is None:
            return None
        self._override_in(mesh)
        if original.type == 'MESH' and normals.lean_from_faces(mesh):  # a text lists a mesh, too
            self._notes.add("lit otherwise along edges, where smooth normals lean far from faces", original.name)
        return mesh

    def _override_in(self, mesh):
        if self._override is not None:
            mesh.materials = [self._override] * len(mesh.materials)

    def _asks(self, material, is_copy):
        if material is None or not material.use_nodes:
            return False
        key = material.name_full, is_copy
        if key not in self._asked:
            self._asked[key] = _asks(material.node_tree, is_copy)
        return self._asked[key]

    def _note_copies(self):
        """Notes materials of copies that depend on the copy."""
        copied = {m.name_full: m for key, n in self._copied.items() if n > 1 for m in self._meshes[key].materials if m}
        for material in copied.values():
            if self._asks(material, True):
                self._notes.add("the same on all copies", material.name, "materials")


def is_seen(o, rays):
    """Returns whether any of these kinds of rays see an object."""
    return any(getattr(o, "visible_" + ray) for ray in rays)


def _is_portal(light):
    """Returns whether a light only tells Cycles where the sky comes from."""
    return light.type == 'AREA' and getattr(getattr(light, "cycles", None), "is_portal", False)


def _shows_itself(instance, listed):
    """Returns whether an object is shown where it stands; `listed`: the objects whose meshes are instances, too."""
    o = instance.object.original
    is_copied = o.parent is not None and o.parent.instance_type in ('VERTS', 'FACES')
    return instance.show_self and not is_copied and not (o.type in _CURVES and o in listed)


def is_sheared(matrix):
    """Returns whether a matrix is no rotation and scale."""
    apart = Matrix.LocRotScale(*matrix.decompose()) - matrix
    size = max(abs(v) for row in matrix.to_3x3() for v in row)
    return max(abs(v) for row in apart for v in row) > 1e-5 * max(size, 1e-9)


def is_flat(matrix):
    """Returns whether a matrix leaves no volume."""
    return abs(matrix.to_3x3().determinant()) <= 1e-12 * max(column.length for column in matrix.to_3x3().col) ** 3


def _asks(tree, is_copy):
    """Returns whether nodes tell objects apart, or copies of one."""
    for node in all_nodes(tree):
        used = {o.name for o in node.outputs if o.is_linked}
        is_placed = node.type == 'NEW_GEOMETRY' and 'Position' in used or \
            node.type == 'TEX_COORD' and (node.object and 'Object' in used or used & {'Camera', 'Window'}) or node.type == 'CAMERA'
        is_named = node.type == 'OBJECT_INFO' and bool(used & ({'Location', 'Random'} if is_copy else used))
        is_named |= not is_copy and node.type == 'ATTRIBUTE' and node.attribute_type == 'OBJECT'
        is_copied = is_copy and (node.type == 'PARTICLE_INFO' and used or
                                 node.type == 'ATTRIBUTE' and node.attribute_type == 'INSTANCER' or
                                 getattr(node, "from_instancer", False) and used)
        if is_placed or is_named or is_copied:
            return True
    return False


def reads_generated(node):
    """Returns whether a texture has the generated coordinates without a link."""
    return node.type in _TEXTURES and not node.inputs['Vector'].is_linked


def _note_of(original, notes):
    offset = getattr(original, "shadow_terminator_shading_offset", 0) or getattr(original.cycles, "shadow_terminator_offset", 0)
    notes.add_true({
        "without particles that are lines or points": any(
            s.render_type in ('LINE', 'HALO') or s.type != 'HAIR' and s.render_type == 'PATH'
            for s in (system.settings for system in original.particle_systems)),
        "subdivided as its modifier says, not adaptively": getattr(original.cycles, "use_adaptive_subdivision", False),
        "shown as surfaces, not as shadow catchers or holdouts": original.is_shadow_catcher or original.is_holdout,
        "seen by light that other surfaces reflect, whatever its visibility": not all(is_seen(original, (ray,)) for ray in BOUNCES),
        "brighter near the edge of its own shadow, without its Shading Offset":
            offset > 0 and any(p.use_smooth for p in getattr(original.data, "polygons", ())),
    }, original.name)
    note_linking(original, notes)


def note_linking(original, notes):
    linking = getattr(original, "light_linking", None)  # from 4.0 on
    if linking is not None and (linking.receiver_collection or linking.blocker_collection):
        notes.add("lighting and shadowing all objects, without light linking", original.name)
