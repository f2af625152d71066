"""Converts materials to ones that Blender's exporter writes: a Principled BSDF of plain values and images.

A surface is a set of parameters. Those of mixed surfaces are mixed, with the same factor. Parameters that the exporter knows are
left as they are, all others are baked.
"""
import bpy
import numpy as np

import displacement
import groups
import images
import normals
import sides
import solids
import uvs
from versions import HAS_ADDED_INTERFACE, displacement_method, principled_input

# The marks of surfaces that the rays of an output pass.
_HIDING_RAYS = {'Is Camera Ray': "lull_hidden", 'Is Shadow Ray': "lull_shadowless"}
# What depends on the direction from which a surface is seen, or on who asks.
_BY_VIEW = {'FRESNEL', 'LAYER_WEIGHT', 'LIGHT_PATH', 'CAMERA', 'LIGHT_FALLOFF', 'TEX_IES'}
_OUTPUTS_BY_VIEW = {'NEW_GEOMETRY': ('Backfacing', 'Incoming'), 'TEX_COORD': ('Camera', 'Window', 'Reflection')}
_BY_PLACE = {'NEW_GEOMETRY', 'OBJECT_INFO', 'PARTICLE_INFO', 'HAIR_INFO', 'POINT_INFO', 'TANGENT', 'AMBIENT_OCCLUSION', 'BEVEL',
             'WIREFRAME', 'VERTEX_COLOR', 'ATTRIBUTE', 'TEX_NOISE', 'TEX_MUSGRAVE', 'TEX_VORONOI', 'TEX_WAVE', 'TEX_MAGIC',
             'TEX_CHECKER', 'TEX_BRICK', 'TEX_GRADIENT', 'TEX_WHITE_NOISE', 'TEX_ENVIRONMENT', 'TEX_SKY', 'TEX_POINTDENSITY',
             'BUMP', 'NORMAL', 'VECT_TRANSFORM', 'SCRIPT'}

# Parameters that are inputs of a Principled BSDF.
_INPUTS = ('Base Color', 'Metallic', 'Roughness', 'Specular', 'Transmission', 'IOR', 'Alpha', 'Clearcoat', 'Clearcoat Roughness')
_DEFAULTS = {'Base Color': (0.8, 0.8, 0.8), 'Metallic': 0, 'Roughness': 1, 'Specular': 0, 'Transmission': 0, 'IOR': 1.45,
             'Alpha': 1, 'Clearcoat': 0, 'Clearcoat Roughness': 0.03, 'Radiance': (0, 0, 0), 'Through': (0, 0, 0),
             'Tint': (1, 1, 1), 'Shine': 0, 'Shine Color': (1, 1, 1)}  # the latter are of a Glossy surface that is added to the base
# Values of Specular, and the differences of albedos.
_MORE_THAN_SCHLICK = (0, 0.1, 0.25, 0.5, 0.75, 1), (0, -0.0116, -0.0008, 0.0061, 0.0084, 0.0087)
_FINE = 0.005  # difference of neighbouring pixels, on average, from which an image has details of their size
# Of one number for a whole material.
_EVEN = ('IOR', 'Specular', 'Clearcoat', 'Clearcoat Roughness', 'Transmission')
# Plain values of these are left out by glTF, or by its exporter.
_UNSAID = ('Subsurface', 'Anisotropic', 'Sheen', 'Specular Tint', 'Transmission Roughness', 'Thin Film Thickness', 'Diffuse Roughness')


def prepare(made, baker, notes):
    """Converts the materials of flattened objects. Returns those objects that have no surface, with their volume alone."""
    users, empty = {}, []
    for mesh in dict.fromkeys(o.data for o in made):
        uvs.complete(mesh)
    displacement.apply(made, baker)
    for o in made:
        for i, material in enumerate(o.data.materials):
            users.setdefault(material, {}).setdefault(o.data, (o, i))
    converted = {}
    for i, (material, meshes) in enumerate(users.items()):
        print(f"lull: material {i + 1} of {len(users)}", flush=True)
        converted[material] = _convert(material, meshes, baker, notes)
    done = set()
    for o in made:
        if all(_is_empty(m) for m in o.data.materials):
            empty.append(o)
        if o.data in done:
            continue
        done.add(o.data)
        pairs = {}
        for i, material in enumerate(o.data.materials):
            found = converted[material]
            if isinstance(found, sides.Pair):
                pairs[i] = found.of(o.data)
            else:
                o.data.materials[i] = found if not isinstance(found, dict) else found[o.data]
        if pairs:
            sides.divide(o.data, pairs)
        _keep_used_colours(o.data)
    return empty


def _is_empty(material):
    """Returns whether a material has a volume and nothing on its surface, as fog has."""
    if material is None or not material.use_nodes:
        return False
    output = material.node_tree.get_output_node('CYCLES')
    return output is not None and not output.inputs['Surface'].links and bool(output.inputs['Volume'].links)


def _convert(material, meshes, baker, notes, side=None):
    """Returns a new material, or one for each mesh; a sides.Pair of these if the sides differ. Of one `side`, a number of an input of
    the node that mixes them, also None for nothing."""
    if material is None:
        return _of_colour('plain', (0.8, 0.8, 0.8))
    if not material.use_nodes:
        return _of_viewport(material)
    if _is_empty(material):
        return material
    output = material.node_tree.get_output_node('CYCLES')
    if output is None or source_of(output.inputs['Surface']) is None:
        return _of_colour(material.name, (0, 0, 0))
    surface = _Surface(material, meshes, notes, side)
    if surface.has_sides:
        return sides.Pair(*(sides.open_behind(_convert(material, meshes, baker, notes, side)) for side in (1, 2)))
    if surface.parameters is None:
        return _of_viewport(material)
    if side and surface.parameters['Alpha'] == 0:
        return None
    if not surface.needs_mesh and not surface.differs_by_mesh():
        return surface.write(baker, None)
    return {mesh: _Surface(material, meshes, notes, side).write(baker, o) for mesh, (o, _) in meshes.items()}


def principled(material):
    """Returns the node of the surface of a converted material; None for other materials."""
    if material is None or not material.use_nodes:
        return None
    return next((n for n in material.node_tree.nodes if n.type == 'BSDF_PRINCIPLED'), None)


def _of_colour(name, colour):
    material = bpy.data.materials.new(name)
    material["lull_name"] = name
    material.use_nodes = True
    node = principled(material)
    principled_input(node, 'Base Color').default_value = (*colour, 1)
    principled_input(node, 'Roughness').default_value = 1
    principled_input(node, 'Specular').default_value = 0
    return material


def _of_viewport(material):
    return _of_colour(material.name, material.diffuse_color[:3])


def source_of(socket):
    """Returns the output that an input comes from, None for none."""
    while socket.links:
        link = socket.links[0]
        node = link.from_node
        if node.type == 'REROUTE':
            socket = node.inputs[0]
        elif node.mute:
            inner = next((l for l in node.internal_links if l.to_socket == link.from_socket), None)
            if inner is None:
                return None
            socket = inner.from_socket
        else:
            return link.from_socket
    return None


def value_of(socket):
    """Returns an input's source, or its plain value: a number, or three."""
    output = source_of(socket)
    if output is not None and output.node.type not in ('RGB', 'VALUE'):
        return output
    value = (output or socket).default_value
    if isinstance(value, (int, float)):
        return value
    return grey(*value[:3]) if socket.type == 'VALUE' else tuple(value)[:3]


def grey(red, green, blue):
    """Returns the number that nodes make of a colour."""
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def is_even(output):
    """Returns whether an output is the same everywhere, from all sides and for all rays."""
    return not _is_by_view(output) and _place_of(output) == 'all'


def upstream(socket):
    """Returns the nodes that an output depends on."""
    found, todo = [], [socket.node]
    while todo:
        node = todo.pop()
        if node not in found:
            found.append(node)
            todo += [link.from_node for s in node.inputs for link in s.links]
    return found


def _is_by_view(socket):
    """Returns whether an output depends on the direction from which a surface is seen, or on who asks."""
    return any(n.type in _BY_VIEW or any(o.links for o in n.outputs if o.name in _OUTPUTS_BY_VIEW.get(n.type, ())) or
               n.type == 'VECT_TRANSFORM' and 'CAMERA' in (n.convert_from, n.convert_to) for n in upstream(socket))


def _is_whole(value):
    return abs(value - round(value)) < 1e-6


def _place_of(socket):
    """Returns 'all' for a value that is the same everywhere, 'uv' for one that the UVs decide, which repeats, else 'mesh'."""
    place = 'all'
    for node in upstream(socket):
        if node.type in _BY_PLACE:
            return 'mesh'
        if node.type == 'TEX_COORD':
            used = [o.name for o in node.outputs if o.links]
            if used != ['UV'] or node.from_instancer:
                return 'mesh'
        if node.type == 'TEX_IMAGE':
            if node.projection != 'FLAT' or node.extension != 'REPEAT' or node.image and node.image.source == 'TILED' or \
                    _has_own_mapping(node):
                return 'mesh'
            place = 'uv'
        if node.type == 'MAPPING':
            scale, turn = node.inputs['Scale'], node.inputs['Rotation']
            if scale.links or turn.links or max(abs(v) for v in turn.default_value) > 1e-6 or \
                    not all(_is_whole(v) for v in scale.default_value[:2]):
                return 'mesh'
        if node.type == 'UVMAP':
            place = 'uv'
    return place


def _layers(value):
    """Returns the names of the UV maps that an output depends on; "" is that of the render."""
    nodes = upstream(value)
    return {n.uv_map for n in nodes if n.type == 'UVMAP'} | {
        "" for n in nodes if n.type == 'TEX_COORD' or n.type == 'TEX_IMAGE' and not n.inputs['Vector'].links}


class _Surface:
    """A material as parameters: plain values, or outputs of nodes of a copy of its tree."""

    def __init__(self, material, meshes, notes, side):
        """`meshes` has an object and a slot for each mesh with the material."""
        self.name, self.original, self.meshes, self.notes = material.name, material, meshes, notes
        self.copy = material.copy()
        self.copy["lull_name"] = material.name
        self.tree = self.copy.node_tree
        groups.inline(self.tree)
        images.prepare(self.tree, self.name, notes)
        if uvs.tell_strands(self.tree):
            notes.add("without the length, width and direction of hair", self.name, "materials")
        output = self.tree.get_output_node('CYCLES')
        root = source_of(output.inputs['Surface'])
        self.root = root and root.node
        self.has_sides = side is None and root is not None and sides.are_of(root.node, source_of)
        if self.has_sides:
            return
        if side:
            root = source_of(root.node.inputs[side])
            if root is None:
                root = self.tree.nodes.new('ShaderNodeBsdfDiffuse').outputs[0]
                root.node.inputs['Color'].default_value = (0, 0, 0, 1)
            self.tree.links.new(root, output.inputs['Surface'])
        self.absorbs = self._absorption(output)
        self.parameters = self._closure(output.inputs['Surface'])
        self.needs_mesh, baked = False, []  # of a mesh, all that is baked is over the same UVs
        if self.parameters is None:
            notes.add("in the viewport colour, as nothing is known of the surface", self.name, "materials")
            return
        if self.parameters.pop('Added', False):
            self.copy["lull_adds"] = True
        self._take_numbers()
        self._mark(source_of(output.inputs['Surface']).node)
        if source_of(output.inputs['Displacement']) and not displacement.moves(material):
            self.parameters['Normal'] = source_of(output.inputs['Displacement'])  # with which the normals are baked
        self._note_what_holds_of_the_whole(output)
        for name, value in self.parameters.items():
            if name == 'Normal':
                self.needs_mesh |= not self._is_known_normal(value)
            elif self._is_output(value) and not self._is_known(name, value):
                baked.append(value)
        self.layers = set().union(*map(_layers, baked))
        self.needs_mesh |= len(self.layers) > 1 or any(_place_of(v) == 'mesh' for v in baked)

    def _take_numbers(self):
        """Lets nodes make numbers of the colours and vectors of parameters that are numbers, where the exporter does not know them."""
        for name, value in self.parameters.items():
            if self._is_output(value) and value.type != 'VALUE' and not isinstance(_DEFAULTS.get(name, ()), tuple) and \
                    not self._is_known(name, value):
                number = self.tree.nodes.new('ShaderNodeMath')
                number.operation, number.inputs[1].default_value = 'ADD', 0
                self.tree.links.new(value, number.inputs[0])
                self.parameters[name] = number.outputs[0]

    def differs_by_mesh(self):
        """Returns whether meshes have UV maps that it names in other places: materials of glTF have their numbers."""
        names = {n.uv_map for v in self.parameters.values() if self._is_output(v) for n in upstream(v)
                 if n.type in ('UVMAP', 'NORMAL_MAP') and n.uv_map}
        return len({tuple(mesh.uv_layers.find(n) for n in sorted(names)) for mesh in self.meshes}) > 1

    def _note_what_holds_of_the_whole(self, output):
        p, notes = self.parameters, self.notes
        if source_of(output.inputs['Displacement']) and displacement_method(self.original) == 'BOTH':
            notes.add("displaced as finely as meshes are, without bump", self.name, "materials")
        if not getattr(self.original.cycles, "use_transparent_shadow", True) and (p['Alpha'] != 1 or self.copy.get("lull_thin")):
            notes.add("letting light through where transparent", self.name, "materials")
        nodes = [n for v in p.values() if self._is_output(v) for n in upstream(v)]
        if any(n.type == 'ATTRIBUTE' and n.attribute_type == 'VIEW_LAYER' for n in nodes):
            notes.add("without properties of the view layer", self.name, "materials")
        if any(n.type == 'AMBIENT_OCCLUSION' and not n.only_local for n in nodes):
            notes.add("occluded by the same object alone", self.name, "materials")

    def _mark(self, node):
        """Leaves to the written file the values that the exporter cannot write."""
        p = self.parameters
        plain = {n: v for n, v in p.items() if not self._is_output(v)}
        if p['Alpha'] == 0 and (p['Tint'] != (1, 1, 1) or p['Radiance'] != (0, 0, 0)):
            p.update({'Alpha': 1, 'Base Color': p['Tint'], 'Transmission': 1, 'Roughness': 0})
            self.copy["lull_air"] = True
        elif HAS_ADDED_INTERFACE and node.type == 'BSDF_PRINCIPLED' and 'Specular' in plain and \
                plain.get('Metallic') == 0 and plain.get('Transmission') == 0:
            # Under even light, the reflectance of a smooth interface by Fresnel's formula less that by Schlick's.
            self.copy["lull_brightens"] = float(np.interp(plain['Specular'], *_MORE_THAN_SCHLICK))

    # Surfaces

    def _closure(self, socket):
        """Returns the parameters of a surface; None where nothing is known of it."""
        source = source_of(socket)
        if source is None:
            return None
        node = source.node
        read = getattr(self, "_" + node.type.lower(), None)
        return read(node) if read else None

    def _made(self, node, **parameters):
        found = dict(_DEFAULTS, **{k.replace('_', ' '): v for k, v in parameters.items()})
        normal = node.inputs.get('Normal')
        if normal is not None and source_of(normal) is not None:
            found['Normal'] = source_of(normal)
        return found

    def _bsdf_principled(self, node):
        found = self._made(node)
        for name in _INPUTS:
            found[name] = value_of(principled_input(node, name))
        if HAS_ADDED_INTERFACE:
            found['Clearcoat'] = self._times(0.25, found['Clearcoat'])
            found['Added'] = True
        if found['Clearcoat'] != 0 and principled_input(node, 'Clearcoat Normal').links:
            self.notes.add("with the normals of the surface on its clear coat", self.name, "materials")
        emission = principled_input(node, 'Emission')
        found['Radiance'] = self._times(value_of(emission), value_of(node.inputs['Emission Strength']))
        for name in _UNSAID:
            unsaid = principled_input(node, name)
            if unsaid is not None and (unsaid.links or not _is_neutral(unsaid)):
                self.notes.add(f"without {name.lower()}", self.name, "materials")
        return found

    def _bsdf_diffuse(self, node):
        if 'Roughness' in node.inputs and (node.inputs['Roughness'].links or node.inputs['Roughness'].default_value > 0):
            self.notes.add("without diffuse roughness", self.name, "materials")
        return self._made(node, Base_Color=value_of(node.inputs['Color']))

    def _bsdf_translucent(self, node):
        return self._made(node, Base_Color=(0, 0, 0), Through=value_of(node.inputs['Color']))

    def _as_diffuse(self, node):
        self.notes.add("shown as diffuse ones", self.name, "materials")
        return self._bsdf_diffuse(node)

    _bsdf_velvet = _bsdf_sheen = _bsdf_toon = _subsurface_scattering = _bsdf_hair = _as_diffuse

    def _bsdf_glossy(self, node):
        return self._made(node, Base_Color=value_of(node.inputs['Color']), Metallic=1, Roughness=self._roughness(node))

    def _bsdf_anisotropic(self, node):
        if node.inputs['Anisotropy'].links or node.inputs['Anisotropy'].default_value != 0:
            self.notes.add("without anisotropic", self.name, "materials")
        return self._bsdf_glossy(node)

    def _bsdf_glass(self, node):
        return self._made(node, Base_Color=value_of(node.inputs['Color']), Transmission=1, Specular=0.5,
                          Roughness=self._roughness(node), IOR=value_of(node.inputs['IOR']))

    def _bsdf_refraction(self, node):
        self.notes.add("reflecting as glass does", self.name, "materials")
        return self._bsdf_glass(node)

    def _roughness(self, node):
        return 0 if getattr(node, "distribution", '') == 'SHARP' else value_of(node.inputs['Roughness'])

    def _bsdf_transparent(self, node):
        return dict(_DEFAULTS, Alpha=0, Tint=value_of(node.inputs['Color']))

    def _emission(self, node):
        light = self._times(value_of(node.inputs['Color']), value_of(node.inputs['Strength']))
        return self._made(node, Base_Color=(0, 0, 0), Radiance=light)

    def _mix_shader(self, node):
        a, b = self._closure(node.inputs[1]), self._closure(node.inputs[2])
        factor = self._clamped(value_of(node.inputs[0]))
        if a is None and b is None:
            return None
        a, b = (self._half(found, socket) for found, socket in ((a, node.inputs[1]), (b, node.inputs[2])))
        if self._is_output(factor) and _is_by_view(factor):
            if node == self.root and self._hides_from_rays(b, factor):
                # Light that enters a plane of solid glass, and never leaves it, is weaker than in Cycles.
                return a if a['Transmission'] != 1 or self._is_solid() else self._lit_through(a)
            return self._mix_by_view(a, b, factor)
        if not self._is_output(factor) and factor in (0, 1):
            return b if factor else a
        for clear, other, share in (a, b, factor), (b, a, self._minus(factor)):
            if clear['Alpha'] == 0:
                if clear['Tint'] != (1, 1, 1):
                    self.notes.add("without colour where they are transparent", self.name, "materials")
                return dict(other, Alpha=self._times(other['Alpha'], share))
        mixed = {name: self._mix(factor, a[name], b[name]) for name in _DEFAULTS}
        if 'Added' in a or 'Added' in b:
            mixed['Added'] = True
        if not self._is_output(factor):
            self._keep_highlights(mixed, a, b, factor)
        if 'Normal' in a or 'Normal' in b:
            reflect = all(p['Base Color'] != (0, 0, 0) for p in (a, b))
            if reflect and a.get('Normal') != b.get('Normal'):
                self.notes.add("with the normals of the first of mixed surfaces that has any", self.name, "materials")
            mixed['Normal'] = a.get('Normal', b.get('Normal'))
        return mixed

    def _clamped(self, factor):
        """Returns a factor as a Mix Shader has it: a number from 0 to 1."""
        if not self._is_output(factor):
            return min(max(factor, 0), 1)
        if factor.node.type in ('TEX_IMAGE', 'FRESNEL', 'LAYER_WEIGHT', 'LIGHT_PATH', 'NEW_GEOMETRY'):
            return factor
        clamp = self.tree.nodes.new('ShaderNodeClamp')
        self.tree.links.new(factor, clamp.inputs[0])
        return clamp.outputs[0]

    def _keep_highlights(self, mixed, a, b, factor):
        """Gives a mixture by a number the roughness of what reflects, and its own base to what scatters."""
        shares = ((a, 1 - factor), (b, factor))
        reflecting = [(p, share) for p, share in shares if self._reflects(p)]
        if len(reflecting) == 2 and not any(self._is_output(p['Roughness']) for p in (a, b)) and \
                abs(a['Roughness'] - b['Roughness']) > 0.1:
            self.notes.add("reflecting by one roughness, between those of mixed surfaces", self.name, "materials")
        if len(reflecting) != 1:
            return
        (shiny, share), = reflecting
        base = b if shiny is a else a
        mixed['Roughness'] = shiny['Roughness']
        if self._is_metal(shiny):
            mixed.update({'Metallic': 0, 'Base Color': self._times(1 - share, base['Base Color']), 'Shine': share,
                          'Shine Color': shiny['Base Color']})

    def _reflects(self, p):
        return any(self._is_output(p[name]) or p[name] > 0 for name in ('Metallic', 'Specular', 'Transmission', 'Shine', 'Clearcoat'))

    def _is_metal(self, p):
        return p['Metallic'] == 1 and p['Transmission'] == 0 and not self._is_output(p['Base Color'])

    def _half(self, found, socket):
        """Returns the parameters of a half of a mixture: black where nothing is linked, as in Cycles."""
        if found is not None:
            return found
        if source_of(socket) is None:
            return dict(_DEFAULTS, **{'Base Color': (0, 0, 0)})
        self.notes.add("in part in the viewport colour, as one of its surfaces is unknown", self.name, "materials")
        return dict(_DEFAULTS, **{'Base Color': tuple(self.original.diffuse_color)[:3]})

    def _hides_from_rays(self, other, factor):
        """Marks a surface that rays of one kind pass, where a factor gives them the `other`, clear surface. Returns whether it is."""
        mark = _HIDING_RAYS.get(factor.name) if factor.node.type == 'LIGHT_PATH' else None
        if mark is None or other['Alpha'] != 0 or other['Tint'] != (1, 1, 1) or other['Radiance'] != (0, 0, 0):
            return False
        self.copy[mark] = True
        return True

    def _mix_by_view(self, a, b, factor):
        """A coat that a Fresnel factor adds is glTF's own, and so is a sheet of glass; of tricks with kinds of rays, what lights
        the scene holds, else what the camera sees."""
        kinds = {n.type for n in upstream(factor)}
        is_ray, is_by_angle = 'LIGHT_PATH' in kinds, not kinds.isdisjoint({'FRESNEL', 'LAYER_WEIGHT'})
        if is_by_angle and not is_ray and a['Metallic'] == 0 and a['Alpha'] == 1 and b['Metallic'] == 1:
            return self._coated(a, b, factor)
        clear, other = (a, b) if a['Alpha'] == 0 else (b, a)
        is_glass = clear['Alpha'] == 0 and other['Alpha'] == 1 and (other['Metallic'] == 1 or other['Transmission'] == 1)
        if is_glass and is_by_angle and not is_ray:
            return self._pane(clear, other, factor if clear is a else None)
        if is_glass and is_ray and other['Transmission'] == 1:
            return self._lit_through(other)
        self.notes.add("the same from all sides and for all rays", self.name, "materials")
        if is_ray:
            return b if factor.name == 'Is Camera Ray' and a['Radiance'] == (0, 0, 0) else a
        return other if clear['Alpha'] == 0 else a

    def _coated(self, base, shine, factor):
        """Returns a surface under a coat that reflects as a factor says."""
        ior = _ior_of(factor)
        specular = ((ior - 1) / (ior + 1)) ** 2 / 0.08 if ior else 0.5
        if ior is None or specular > 1:
            self.notes.add("reflecting as a clear coat does", self.name, "materials")
        if self._is_output(shine['Base Color']) or min(shine['Base Color']) < 0.75:
            self.notes.add("reflecting white light", self.name, "materials")
        return dict(base, Specular=min(specular, 1), Roughness=shine['Roughness'])

    def _pane(self, clear, shine, factor):
        """Returns a sheet of glass, for a clear surface that shines as a factor says, None for one that is not known."""
        ior = _ior_of(factor) if factor is not None else None
        if ior is None:
            self.notes.add("reflecting as clear glass does", self.name, "materials")
        if self._is_output(shine['Roughness']) or shine['Roughness'] > 0.1 or shine['Base Color'] != (1, 1, 1) and \
                (self._is_output(shine['Base Color']) or min(shine['Base Color']) < 0.75):
            self.notes.add("reflecting white light, and sharply", self.name, "materials")
        self.notes.add("made a sheet of glass, the same from both sides", self.name, "materials")
        self.copy["lull_thin"] = True
        return dict(_DEFAULTS, **{'Base Color': clear['Tint'], 'Transmission': 1, 'Specular': 0.5, 'Roughness': 0,
                                  'IOR': ior or 1.45})

    def _is_solid(self):
        return any(solids.has_solid(o, slot) for o, slot in self.meshes.values())

    def _lit_through(self, glass):
        """Returns glass which light passes that other glass refracts."""
        if self.copy.get("lull_thin"):
            return glass
        if self._is_solid():
            self.notes.add("solid glass, which lamps do not shine through", self.name, "materials")
            return glass
        self.notes.add("made a sheet of glass, the same from both sides", self.name, "materials")
        self.copy["lull_thin"] = True
        return glass

    def _add_shader(self, node):
        a, b = self._closure(node.inputs[0]), self._closure(node.inputs[1])
        if a is None and b is None:
            return None
        a, b = (self._half(found, socket) for found, socket in ((a, node.inputs[0]), (b, node.inputs[1])))
        shines = a['Base Color'] == (0, 0, 0) and a['Radiance'] != (0, 0, 0)
        first, other = (b, a) if shines else (a, b)
        if self._is_metal(first) and not self._reflects(other):
            first, other = other, first
        if self._is_metal(other) and not self._reflects(first) and max(other['Base Color']) > 0:
            most = max(other['Base Color'])
            return dict(first, **{'Shine': most, 'Shine Color': tuple(c / most for c in other['Base Color']), 'Roughness': other['Roughness'],
                                  'Radiance': self._plus(first['Radiance'], other['Radiance'])})
        if other['Base Color'] != (0, 0, 0):
            self.notes.add("without the second of added surfaces", self.name, "materials")
        return dict(first, Radiance=self._plus(first['Radiance'], other['Radiance']))

    def _absorption(self, output):
        """Returns the absorption coefficient of a homogeneous volume, per metre; None without one."""
        source = source_of(output.inputs['Volume'])
        if source is None:
            return None
        node = source.node
        inputs = [s for s in node.inputs if s.links]
        if node.type != 'VOLUME_ABSORPTION' or inputs:
            self.notes.add("without volume", self.name, "materials")
            return None
        density = node.inputs['Density'].default_value
        return [density * max(0, 1 - c) for c in node.inputs['Color'].default_value[:3]]

    # Values

    @staticmethod
    def _is_output(value):
        return isinstance(value, bpy.types.NodeSocket)

    def _blend(self, kind, factor, a, b):
        node = self.tree.nodes.new('ShaderNodeMixRGB')
        node.blend_type = kind
        for socket, value in zip(node.inputs, (factor, a, b)):
            if self._is_output(value):
                self.tree.links.new(value, socket)
            elif socket.type == 'VALUE':
                socket.default_value = value
            else:
                socket.default_value = (*_triple(value), 1)
        return node.outputs[0]

    def _operate(self, kind, plain, a, b):
        if self._is_output(a) or self._is_output(b):
            return self._blend(kind, 1, a, b)
        if isinstance(a, tuple) or isinstance(b, tuple):
            return tuple(plain(x, y) for x, y in zip(_triple(a), _triple(b)))
        return plain(a, b)

    def _times(self, a, b):
        if not self._is_output(a) and _triple(a) == (1, 1, 1):
            return b
        if not self._is_output(b) and _triple(b) == (1, 1, 1):
            return a
        if not self._is_output(a) and not any(_triple(a)):
            return a
        return self._operate('MULTIPLY', lambda x, y: x * y, a, b)

    def _plus(self, a, b):
        return self._operate('ADD', lambda x, y: x + y, a, b)

    def _minus(self, factor):
        return self._operate('SUBTRACT', lambda x, y: x - y, 1, factor)

    def _mix(self, factor, a, b):
        if a == b:
            return a
        if any(self._is_output(v) for v in (factor, a, b)):
            return self._blend('MIX', factor, a, b)
        mixed = tuple(x + factor * (y - x) for x, y in zip(_triple(a), _triple(b)))
        return mixed if isinstance(a, tuple) else mixed[0]

    # Values that the exporter writes unchanged

    def _is_known(self, name, value):
        """Returns whether the exporter finds the image of a parameter, and nothing else changes it."""
        if name == 'Base Color' and value.node.type == 'MIX' and self._is_product(value.node):
            value = next((source for s in value.node.inputs[6:8] if (source := source_of(s))), value)
            if value.node.type != 'TEX_IMAGE':
                return False
        is_number = name in ('Metallic', 'Roughness')
        if is_number and value.node.type in ('SEPRGB', 'SEPARATE_COLOR') and getattr(value.node, "mode", 'RGB') == 'RGB':
            value, is_number = source_of(value.node.inputs[0]), False
            if value is None:
                return False
        if value.node.type == 'VERTEX_COLOR':
            return name == 'Base Color' and value.name == 'Color'
        if value.node.type != 'TEX_IMAGE' or name in _EVEN or not _is_plain(value.node) or value.node.image.is_float:
            return False
        if (name == 'Alpha') != (value.name == 'Alpha') or not _is_known_place(value.node.inputs['Vector']):
            return False
        image = value.node.image
        return name == 'Alpha' or _is_encoded(image, name in ('Base Color', 'Radiance')) and not (is_number and not images.is_grey(image))

    @staticmethod
    def _is_product(node):
        """Returns whether a node multiplies an image by a colour, as glTF's factors do."""
        if node.data_type != 'RGBA' or node.blend_type != 'MULTIPLY' or node.inputs[0].links or \
                abs(node.inputs[0].default_value - 1) > 1e-6:
            return False
        sides = node.inputs[6:8]
        linked = [s for s in sides if s.links]
        return len(linked) == 1 and max(next(s for s in sides if not s.links).default_value[:3]) <= 1

    def _is_known_normal(self, value):
        node = value.node
        if node.type != 'NORMAL_MAP' or node.space != 'TANGENT' or node.inputs['Strength'].links:
            return False
        source = source_of(node.inputs['Color'])
        return source is not None and source.node.type == 'TEX_IMAGE' and self._is_known('Normal', source)

    # Writing

    def write(self, baker, o):
        """Returns the new material. `o` is the object on whose mesh is baked what depends on it."""
        self.baker, self.object = baker, o
        self.copy.use_backface_culling = False  # which Cycles ignores, and glTF does not
        self._divide_base()
        new = self.tree.nodes.new('ShaderNodeBsdfPrincipled')
        self._write_normal(new)
        for name in _EVEN:
            self._set(principled_input(new, name), self._even(name))
        if self._is_output(self.parameters['Shine']) or self.parameters['Shine'] > 0:
            colour = self._pixels('Shine Color').reshape(-1, 3).mean(0)
            self.copy["lull_shine"] = [self._even('Shine'), *(float(c) for c in colour)]
        self._write_radiance(new)
        self._write_metal(new)
        self._write_base(new)
        self._show_alone(new)
        if self.absorbs:
            self.copy["lull_absorbs"] = self.absorbs
        return self.copy

    def _write_metal(self, new):
        shown = {n for name in ('Metallic', 'Roughness') if self._is_output(self.parameters[name])
                 for n in upstream(self.parameters[name]) if n.type == 'TEX_IMAGE'}
        if len(shown) < 2 and self._are_known(('Metallic', 'Roughness')):
            self._link(new, 'Metallic'), self._link(new, 'Roughness')
            return
        metallic, roughness = self._pixels('Metallic'), self._pixels('Roughness')
        packed = _packed(np.zeros(3, np.float32), roughness, metallic)
        image = self._image(packed, 'metal', False)
        channels = self.tree.nodes.new('ShaderNodeSeparateColor')
        self.tree.links.new(image.outputs['Color'], channels.inputs[0])
        self.tree.links.new(channels.outputs[1], principled_input(new, 'Roughness'))
        self.tree.links.new(channels.outputs[2], principled_input(new, 'Metallic'))

    def _write_base(self, new):
        colour, alpha = self.parameters['Base Color'], self.parameters['Alpha']
        # Where it reads the alpha of an image alone, the exporter writes its colours as well.
        are_apart = self._is_output(alpha) and not (self._is_output(colour) and alpha.node == colour.node)
        if self._are_known(('Base Color', 'Alpha')) and not are_apart:
            self._link(new, 'Base Color'), self._link(new, 'Alpha')
        else:
            self._write_colour(new)
        is_clear = bool(principled_input(new, 'Alpha').links) or principled_input(new, 'Alpha').default_value < 1
        self.copy.blend_method = 'BLEND' if is_clear else 'OPAQUE'

    def _show_alone(self, new):
        """Makes the node the surface, and removes all others that an exporter could take for it."""
        output = self.tree.get_output_node('CYCLES')
        for node in [n for n in self.tree.nodes if n.type == 'OUTPUT_MATERIAL' and n != output]:
            self.tree.nodes.remove(node)
        for name in 'Volume', 'Displacement':
            for link in list(output.inputs[name].links):
                self.tree.links.remove(link)
        self.tree.links.new(new.outputs[0], output.inputs['Surface'])
        for node in [n for n in self.tree.nodes if n.type == 'BSDF_PRINCIPLED' and n != new]:
            self.tree.nodes.remove(node)

    def _are_known(self, names):
        values = [(n, self.parameters[n]) for n in names]
        return all(self._is_known(n, v) if self._is_output(v) else not isinstance(v, np.ndarray) for n, v in values)

    def _link(self, node, name):
        self._set(principled_input(node, name), self.parameters[name])

    def _set(self, socket, value):
        if self._is_output(value):
            self.tree.links.new(value, socket)
        elif socket.type == 'VALUE':
            socket.default_value = value if not isinstance(value, tuple) else value[0]
        else:
            socket.default_value = (*_triple(value), 1)

    def _pixels(self, name):
        """Returns three numbers, or an image of them, of a parameter."""
        value = self.parameters[name]
        if isinstance(value, np.ndarray):
            return value
        if not self._is_output(value):
            return np.array(_triple(value), np.float32)
        if _is_by_view(value):
            self.notes.add("the same from all sides and for all rays", self.name, "materials")
        place = _place_of(value)
        if place == 'all':
            return self.baker.plain(self.copy, value)
        if not self.needs_mesh:
            return self.baker.over_uvs(self.copy, value, [n for n in self.layers if n], self._size(value))[:, :, :3]
        return self._over_mesh(value)

    def _over_mesh(self, value, kind='EMIT'):
        pixels = self.baker.over_mesh(self.copy, value, self.object, self.original, kind)[:, :, :3]
        if abs(np.diff(pixels, axis=1)).mean() > _FINE and self.baker.is_coarse(self.object):
            self.notes.add(f"blurred, by images of {self.baker.size} pixels over whole meshes (Texture Size)", self.name, "materials")
        return pixels

    def _even(self, name):
        values = self._pixels(name).reshape(-1, 3)[:, 0]
        if np.ptp(values) > 0.05:
            self.notes.add(f"of the same {name.lower()} everywhere", self.name, "materials")
        return float(values.mean())

    @staticmethod
    def _size(value):
        sizes = [max(n.image.size) for n in upstream(value) if n.type == 'TEX_IMAGE' and n.image]
        return min(4096, max(sizes, default=0))

    def _image(self, pixels, what, is_colour):
        """Adds a node of an image, on the UVs that it was made for."""
        height, width = pixels.shape[:2]
        full = np.ones((height, width, 4), np.float32)
        full[:, :, :pixels.shape[2]] = np.clip(pixels, 0, 1)
        image = bpy.data.images.new(f"{self.name} {what}", width, height, alpha=pixels.shape[2] == 4)
        image.colorspace_settings.name = 'sRGB' if is_colour else 'Non-Color'
        if is_colour:
            full[:, :, :3] = images.encoded(full[:, :, :3])
        image.pixels.foreach_set(full.ravel())
        image.update()
        image.pack()
        node = self.tree.nodes.new('ShaderNodeTexImage')
        node.image = image
        name = "lull" if self.needs_mesh else next(iter(self.layers), "")
        if name == uvs.STRANDS:
            node.extension = 'EXTEND'  # filtered, a root would have the colour of tips
        if name:
            uv = self.tree.nodes.new('ShaderNodeUVMap')
            uv.uv_map = name
            self.tree.links.new(uv.outputs[0], node.inputs[0])
        return node

    def _write_colour(self, new):
        colour, alpha = self._pixels('Base Color'), self._pixels('Alpha')
        if colour.ndim == 1 and alpha.ndim == 1:
            self._set(principled_input(new, 'Base Color'), tuple(colour))
            self._set(principled_input(new, 'Alpha'), float(alpha[0]))
            return
        if alpha.ndim == 1 and alpha[0] >= 1:
            image = self._image(_as_image(colour), 'colour', True)
            self.tree.links.new(image.outputs['Color'], principled_input(new, 'Base Color'))
            return
        image = self._image(_packed(colour, alpha), 'colour', True)
        self.tree.links.new(image.outputs['Color'], principled_input(new, 'Base Color'))
        self.tree.links.new(image.outputs['Alpha'], principled_input(new, 'Alpha'))

    def _divide_base(self):
        """Divides the diffuse base as KHR_materials_diffuse_transmission does: the colour that light has on the other side is
        one, or that of the base times one."""
        if self.parameters['Through'] == (0, 0, 0):
            return
        base, through = self._pixels('Base Color'), self._pixels('Through')
        most = float(through.max())
        share = most / max(most + float(base.max()), 1e-6)
        colour, is_image = through / max(share, 1e-6), through.ndim == 3
        if is_image and not base.any():
            base, colour, share = through, np.ones(3), 1
        elif is_image:
            _, base, fitted = (_resized(_as_image(p, through.shape[:2]), through.shape[:2]) for p in (base, base, through))
            ratio = (fitted * base).sum((0, 1)) / np.maximum((base * base).sum((0, 1)), 1e-9)
            if abs(fitted - ratio * base).mean() > 0.1 * fitted.mean():
                self.notes.add("translucent in the colours of their front", self.name, "materials")
            base, colour = base / (1 - share), ratio * (1 - share) / share
        else:
            base = base / (1 - share) if share < 1 else base
        self.parameters['Base Color'] = base if base.ndim == 3 else tuple(float(v) for v in base)
        self.copy["lull_through"] = [share, *(float(min(c, 1)) for c in colour), float(is_image)]

    def _write_radiance(self, new):
        emission = principled_input(new, 'Emission')
        value = self.parameters['Radiance']
        if self._is_output(value) and self._is_known('Radiance', value):
            self.tree.links.new(value, emission)
            new.inputs['Emission Strength'].default_value = 1
            return
        pixels = self._pixels('Radiance')
        most = float(pixels.max())
        new.inputs['Emission Strength'].default_value = max(most, 0)
        if most <= 0:
            self._set(emission, (0, 0, 0))
        elif pixels.ndim == 1:
            self._set(emission, tuple(pixels / most))
        else:
            self.tree.links.new(self._image(pixels / most, 'emission', True).outputs['Color'], emission)

    def _write_normal(self, new):
        value = self.parameters.get('Normal')
        if value is None:
            return
        if self._is_known_normal(value):
            self._write_known_normal(value)
            self.tree.links.new(value, new.inputs['Normal'])
            return
        pixels = self._over_mesh(value, 'NORMAL')
        self._note_leaning(pixels)
        image = self._image(pixels, 'normal', False)
        node = self.tree.nodes.new('ShaderNodeNormalMap')
        node.uv_map = "lull"
        self.tree.links.new(image.outputs['Color'], node.inputs['Color'])
        self.tree.links.new(node.outputs[0], new.inputs['Normal'])

    def _write_known_normal(self, value):
        strength, shown = value.node.inputs['Strength'], source_of(value.node.inputs['Color']).node
        pixels = images.numbers_of(shown.image)
        self._note_leaning(pixels, strength.default_value)
        if 0 < strength.default_value < 1:
            shown.image = normals.weakened(pixels, shown.image.name, strength.default_value)
            strength.default_value = 1

    def _note_leaning(self, pixels, strength=1):
        p = self.parameters
        is_diffuse = all(self._is_output(p[n]) or p[n] < 1 for n in ('Metallic', 'Transmission'))
        if is_diffuse and normals.dimmed(pixels, strength) > normals.MOST:
            self.notes.add("brighter where light falls flat, as normals lean far", self.name, "materials")


def _ior_of(factor):
    """Returns the index of refraction by which a factor grows with the angle; None where it does not as glass has it."""
    value = factor.node.inputs[0]
    if value.links:
        return None
    if factor.node.type == 'FRESNEL':
        return value.default_value
    if factor.node.type == 'LAYER_WEIGHT' and factor.name == 'Fresnel':
        return 1 / max(1 - value.default_value, 1e-5)
    return None


def _is_neutral(socket):
    """Returns whether an input without links changes nothing: a weight of 0, or a white tint."""
    return socket.default_value == 0 if socket.type == 'VALUE' else min(socket.default_value[:3]) >= 1


def _triple(value):
    return value if isinstance(value, tuple) else (value, value, value)


def _is_plain(node):
    """Returns whether glTF's samplers read an image as its node does."""
    return (node.image is not None and node.image.size[0] > 0 and node.projection == 'FLAT' and not _has_own_mapping(node) and
            node.extension in ('REPEAT', 'EXTEND') and node.image.source in ('FILE', 'GENERATED'))


def _has_own_mapping(node):
    """Returns whether the node of a texture has a mapping of its own, as files of old versions have."""
    own = node.texture_mapping
    return (own.mapping, own.mapping_x, own.mapping_y, own.mapping_z) != ('FLAT', 'X', 'Y', 'Z') or own.use_min or own.use_max or \
        any(tuple(v) != (plain,) * 3 for v, plain in ((own.translation, 0), (own.rotation, 0), (own.scale, 1)))


def _is_encoded(image, is_colour):
    """Returns whether the numbers of a file are what glTF takes them for: encoded colours, or data."""
    space = image.colorspace_settings
    return space.name == 'sRGB' if is_colour else space.is_data


def _is_known_place(socket):
    """Returns whether an image has UVs, moved by one Mapping at most."""
    source = source_of(socket)
    if source is not None and source.node.type == 'MAPPING' and _is_known_mapping(source.node):
        source = source_of(source.node.inputs['Vector'])
        if source is None:  # all of it the same
            return False
    return source is None or not getattr(source.node, "from_instancer", False) and (
        source.node.type == 'UVMAP' or source.node.type == 'TEX_COORD' and source.name == 'UV')


def _is_known_mapping(node):
    turn, scale = node.inputs['Rotation'].default_value, node.inputs['Scale'].default_value
    # Of a texture that is moved, glTF has no scale after the rotation.
    is_known = node.vector_type == 'POINT' or node.vector_type == 'TEXTURE' and (turn[2] == 0 or scale[0] == scale[1])
    return is_known and abs(turn[0]) + abs(turn[1]) < 1e-6 and not any(s.links for s in node.inputs[1:])


def _as_image(values, shape=None):
    return values if values.ndim == 3 else np.broadcast_to(values, (*(shape or (4, 4)), 3)).copy()


def _packed(*parts):
    """Puts the first three numbers of the first part, or its first, and the first of the others into the channels of an image."""
    shapes = [p.shape[:2] for p in parts if p.ndim == 3]
    shape = max(shapes, default=(4, 4))
    images = [_resized(_as_image(p, shape), shape) for p in parts]
    if len(parts) == 2:
        return np.concatenate([images[0], images[1][:, :, :1]], 2)
    return np.concatenate([i[:, :, :1] for i in images], 2)


def _resized(image, shape):
    rows = np.arange(shape[0]) * image.shape[0] // shape[0]
    columns = np.arange(shape[1]) * image.shape[1] // shape[1]
    return image[rows][:, columns]


def _keep_used_colours(mesh):
    """Leaves the colours that its materials read: glTF multiplies by any."""
    wanted = set()
    for material in mesh.materials:
        node = principled(material)
        source = source_of(principled_input(node, 'Base Color')) if node else None
        if source is not None:
            wanted |= {n.layer_name for n in upstream(source) if n.type == 'VERTEX_COLOR'}
    layers = mesh.color_attributes
    if "" in wanted and 0 <= layers.render_color_index < len(layers):
        wanted.add(layers[layers.render_color_index].name)
    for name in [layer.name for layer in layers if layer.name not in wanted]:
        layers.remove(layers[name])
