"""The world of a render: as a colour, or as images that a second Blender renders, whatever its nodes are."""
import numpy as np

from . import exr
from .camera import resolution
from .nodes import Made, Tree, computed, described, is_output, upstream, value_of

_RAYS = "diffuse", "glossy", "transmission"
_SMALLEST, _LARGEST = 16, 4096  # pixels across: of a plain colour, and of any world
_USUAL = 1024
_OF_DIFFUSE_LIGHT = 'Is Diffuse Ray', 'Is Reflection Ray', 'Ray Depth', 'Diffuse Depth'


class Surroundings:
    """`light` is the path of an image of all directions, None for a black world; `backdrop` that of the picture behind the scene, where
    the camera sees another world, or one that `is_sharp` wants finer than all directions, else None."""

    def __init__(self, scene, layer, view, base, is_sharp, baker, notes):
        self.light = self.backdrop = None
        self._path = base + ".world.exr"
        world = self._world = scene.world
        if world is None or not layer.use_sky:
            return
        self._notes, self._is_asked = notes, False
        visible = getattr(world, "cycles_visibility", None)
        unseen = [ray for ray in _RAYS if not getattr(visible, ray, True)]
        lights = len(unseen) < len(_RAYS)
        tree = Tree(world) if world.use_nodes else None
        self._note(tree, unseen if lights else (), lights)
        plain = _plain(world, tree)
        if plain is not None and max(plain) == 0:
            return
        lit = Tree(world, self._answered) if tree else None
        surface = _pruned(lit.output.inputs['Surface'].source) if tree else None
        if tree:
            upstream(surface)  # reads all nodes, and finds questions for kinds of rays
        r, is_seen = scene.render, getattr(visible, "camera", True)
        size = resolution(r)
        if not r.film_transparent and (self._is_asked or not lights or not is_seen or is_sharp and plain is None):
            self.backdrop = base + ".backdrop.exr"
            if not is_seen:
                exr.write(self.backdrop, dict.fromkeys("RGB", np.zeros(size[::-1], np.float32)))
        asks_behind = self.backdrop is not None and is_seen
        if lights:
            self.light = self._path
        if lights and plain is not None:
            self._write(plain)
        asks_light = lights and plain is None
        if not asks_light and not asks_behind:
            return
        if asks_light and any(n.type == 'TEX_COORD' and used & {'Window', 'Camera'} for n, used in upstream(surface).items()):
            notes.say(f"the world '{world.name}' lights by coordinates of another camera")
        if asks_light and any(n.type == 'TEX_SKY' and n.sky_type == 'NISHITA' and n.sun_disc and
                              any(i.source for i in n.inputs) for n in upstream(surface)):
            notes.say(f"the sun of world '{world.name}' is as coarse as the image of its sky, which nodes turn")

        def part(path, *outputs):
            return {"name": world.name, "file": path,
                    "nodes": [output and described(output, ["worlds", world.original.name_full]) for output in outputs]}

        behind = [tree.output.inputs[name].source for name in ('Surface', 'Volume')] if tree else [
            Made('Background', 'BACKGROUND', (*world.color, 1.), 1.).output(0, 'SHADER')]
        baker.ask_world({
            "light": part(self.light, surface) if asks_light else None, "backdrop": part(self.backdrop, *behind) if asks_behind else None,
            "width": _width(surface) if asks_light else 0, "camera": view.data.original.name_full, "focus": view.focus(),
            "matrix": [list(row) for row in view.matrix], "resolution": size,
            "aspect": [r.pixel_aspect_x, r.pixel_aspect_y]}, world, view.data)

    def black(self):
        """Lets the world be there, and black."""
        self.light = self._path
        self._write((0, 0, 0))

    def _write(self, colour):
        exr.write(self.light, {c: np.full((_SMALLEST // 2, _SMALLEST), v, np.float32) for c, v in zip("RGB", colour)})

    def _note(self, tree, unseen, lights):
        world, say = self._world, self._notes.say
        if tree and tree.output is not None and tree.output.inputs['Volume'].source is not None:
            say(f"the volume of world '{world.name}' is left out")
        if unseen:
            say(f"the world '{world.name}' lights all rays but those of the camera, whatever its visibility")
        if world.cycles.max_bounces < 12 and lights:
            say(f"the world '{world.name}' lights after any number of bounces")

    def _answered(self, node, name):
        """Lets nodes that ask for the kind of a ray know that of diffuse light; see nodes.Tree."""
        if node.type != 'LIGHT_PATH':
            return None
        self._is_asked = True
        if name not in ('Is Camera Ray', 'Is Diffuse Ray'):
            self._notes.say(f"the world '{self._world.name}' lights mirrors and glass as it lights diffuse surfaces")
        return computed('ADD', float(name in _OF_DIFFUSE_LIGHT), 0.)


def _plain(world, tree):
    """Returns the colour of an even world; None for others."""
    if tree is None:
        return tuple(world.color)
    source = tree.output.inputs['Surface'].source if tree.output is not None else None
    if source is None:
        return 0, 0, 0
    if source.node.type != 'BACKGROUND':
        return None
    colour, strength = (value_of(source.node.inputs[name]) for name in ('Color', 'Strength'))
    return None if is_output(colour) or is_output(strength) else tuple(c * strength for c in colour)


def _pruned(output):
    """Leaves out surfaces for other rays, which are no part of the light."""
    while output.node.type == 'MIX_SHADER' and (factor := output.node.inputs[0].source) is not None and isinstance(factor.node, Made):
        seen = output.node.inputs[1 + int(factor.node.inputs[0].default_value)].source
        if seen is None:
            break
        output = seen
    return output


def _width(output):
    widths = [n.image.size[0] for n in upstream(output) if n.type == 'TEX_ENVIRONMENT' and n.image]
    # Twice as fine as images, which may be turned.
    return min(_LARGEST, max(2 * max(widths), _SMALLEST)) if widths else _USUAL
