"""Materials as parameters of a surface: plain values, or outputs of nodes."""
from . import displacement, images, values
from .bsdfs import BLACK, DEFAULTS, READERS, bounced
from .mixtures import added, mixed
from .nodes import Constant, Tree, is_output, upstream, value_of
from .versions import HAS_ADDED_INTERFACE, displacement_method

EVEN = ('IOR', 'Specular', 'Clearcoat', 'Clearcoat Roughness', 'Transmission', 'Sheen Roughness')  # of one number for a whole material
_READERS = {**READERS, 'MIX_SHADER': mixed, 'ADD_SHADER': added}


class Surface:
    """`parameters` have the names of bsdfs.DEFAULTS, and perhaps Normal; None for an unknown surface. `own` are lull's own
    properties of the material."""

    def __init__(self, material, view, solid, notes, side=None):
        """`view` is a camera.View. `solid()` returns whether faces of the material form a closed body. `side`: the input of a node that
        mixes the sides."""
        self.name, self.material, self.is_solid, self._notes = material.name, material, solid, notes
        self._view = view
        self.own, self.is_thin, self.is_air, self._numbers = {}, False, False, {}
        tree = Tree(material, self._replaced)
        surface = tree.output.inputs['Surface']
        self.root = surface.source.node if surface.source is not None else None
        self.has_sides = side is None and self.root is not None and _mixes_sides(self.root)
        if self.has_sides:
            return
        if side:
            surface = self.root.inputs[side]
        self.parameters = dict(BLACK) if surface.source is None else self.closure(surface)
        self.absorbs = self._absorption(tree.output.inputs['Volume'].source)
        self.kind = 'NORMAL'  # the kind of bake for the parameter Normal
        if self.parameters is None:
            self.note("in the viewport colour, as nothing is known of the surface")
            return
        self._mark()
        moves = tree.output.inputs['Displacement'].source
        if moves is not None and not displacement.moves(material):
            self.parameters['Normal'], self.kind = moves, 'BUMP'
        self._note_what_holds_of_the_whole(moves)

    def _replaced(self, node, name):
        """Replaces outputs that depend on strands, on the camera or on images without a file; see nodes.Tree."""
        path = images.missing(node.image) if node.type == 'TEX_IMAGE' else None
        if path is None:
            return values.strand(node, name) or values.of_camera(node, name, self._view)
        if path:
            self._notes.add("magenta, as in Cycles, as there is no such file", f"{node.image.name} ({path})", "images")
        return Constant((1., 0., 1.)).output(0, 'RGBA') if name == 'Color' else Constant(1.).output()

    def note(self, consequence):
        self._notes.add(consequence, self.name, "materials")

    def number_of(self, name, value):
        """Returns the number that a parameter makes of an output of a colour or vector: always the same object."""
        if isinstance(DEFAULTS.get(name), tuple) or value.type in ('VALUE', 'INT', 'BOOLEAN'):
            return value
        return self._numbers.setdefault(name, values.number(value))

    def closure(self, socket):
        """Returns the parameters of a surface; None where nothing is known of it."""
        if socket.source is None:
            return None
        node = socket.source.node
        if socket.source.type != 'SHADER':  # Cycles lets colours shine
            return dict(BLACK, Radiance=value_of(socket))
        read = _READERS.get(node.type)
        return read(self, node) if read else None

    def _mark(self):
        p, further = self.parameters, bounced(self.parameters)
        is_even, keeps_all = p.pop('Even', False), p.pop('Multi', False)
        if p.pop('Added', False) or HAS_ADDED_INTERFACE and is_even and not keeps_all:
            self.own["addedInterface"] = True
        if is_even:
            self.own["evenInterface"] = True
        if max(further) > 0.001:
            p.update({'Metallic': 0, 'Shine': 1, 'Shine Color': p['Base Color'], 'Base Color': further})
        if p['Alpha'] == 0 and (p['Tint'] != (1, 1, 1) or p['Radiance'] != (0, 0, 0)):
            p.update({'Alpha': 1, 'Base Color': p['Tint'], 'Transmission': 1, 'Roughness': 0})
            self.is_air = self.is_thin = True

    def _note_what_holds_of_the_whole(self, moves):
        p = self.parameters
        shades = getattr(self.material, "use_transparent_shadow", None)  # Cycles' own until 4.1
        if shades is None:
            shades = getattr(self.material.cycles, "use_transparent_shadow", True)
        nodes = {n for v in p.values() if is_output(v) for n in upstream(v)}
        self._notes.add_true({
            "displaced as finely as meshes are, without bump": moves is not None and displacement_method(self.material) == 'BOTH',
            "letting light through where transparent": not shades and (p['Alpha'] != 1 or self.is_thin),
            "without the length, width and direction of hair": any(n.type == 'HAIR_INFO' for n in nodes),
            "without the points of Point Density": any(n.type == 'TEX_POINTDENSITY' for n in nodes),
            "without properties of the view layer": any(n.type == 'ATTRIBUTE' and n.attribute_type == 'VIEW_LAYER' for n in nodes),
            "occluded by the same object alone": any(n.type == 'AMBIENT_OCCLUSION' and not n.only_local for n in nodes),
        }, self.name, "materials")

    def _absorption(self, source):
        """Returns the absorption coefficient of a homogeneous volume, per metre; None without one."""
        if source is None:
            return None
        node = source.node
        if node.type != 'VOLUME_ABSORPTION' or any(i.source is not None for i in node.inputs):
            self.note("without volume")
            return None
        density = node.inputs['Density'].default_value
        return [density * max(0, 1 - c) for c in node.inputs['Color'].default_value[:3]]


def _mixes_sides(node):
    """Returns whether a node is a Mix Shader by Backfacing."""
    factor = node.inputs[0].source if node.type == 'MIX_SHADER' else None
    return factor is not None and factor.node.type == 'NEW_GEOMETRY' and factor.name == 'Backfacing'


def state_of(material):
    """Returns 'viewport' for a material without nodes, 'volume' for one that has a volume and nothing on its surface, 'black' for
    nothing at all, else 'nodes'."""
    if not material.use_nodes:
        return 'viewport'
    output = material.node_tree.get_output_node('CYCLES')
    if output is None:
        return 'black'
    inputs = Tree(material).output.inputs
    if inputs['Surface'].source is None:
        return 'volume' if inputs['Volume'].source is not None else 'black'
    return 'nodes'
