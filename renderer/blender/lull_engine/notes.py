"""Differences from the picture of Cycles, collected by their consequences, and those of the whole scene."""
import contextlib
import traceback

from .process import Failure

_WITHOUT_EFFECT = "settings of Cycles without effect: "


class Notes:
    """Lists names by consequences, and sentences."""

    def __init__(self):
        self._names, self._sentences = {}, []

    def add(self, consequence, name, kind="objects"):
        """Notes that `name`, of a kind in the plural, will be so."""
        self._names.setdefault((kind, consequence), []).append(name)

    def add_true(self, consequences, name, kind="objects"):
        """Notes the consequences whose values are true."""
        for consequence, is_so in consequences.items():
            if is_so:
                self.add(consequence, name, kind)

    def say(self, sentence):
        if sentence not in self._sentences:
            self._sentences.append(sentence)

    @contextlib.contextmanager
    def of(self, name, kind="objects"):
        """Limits the effect of an exception to one thing."""
        try:
            yield
        except Failure:
            raise
        except Exception as e:  # whatever it is, the rest of the scene can be shown
            traceback.print_exc()
            self.add(f"left out or plain, after an error ({type(e).__name__}: {e})", name, kind)

    def lines(self):
        """Returns a line each, such as "2 materials are even: chalk, sand"."""
        lines = list(self._sentences)
        for (kind, consequence), names in self._names.items():
            names = sorted(set(names))
            shown = ", ".join(f"'{n}'" for n in names[:5]) + (" and others" if len(names) > 5 else "")
            is_one = len(names) == 1
            lines.append(f"{len(names)} {kind[:-1] if is_one else kind} {'is' if is_one else 'are'} {consequence}: {shown}")
        return lines

    def take(self, other):
        """Adds other notes."""
        for sentence in other._sentences:
            self.say(sentence)
        for key, names in other._names.items():
            self._names.setdefault(key, []).extend(names)


def note_film(scene, layer, notes):
    if scene.render.use_multiview and scene.render.views_format == 'MULTIVIEW':
        notes.say("all views have the same picture")
    if scene.render.pixel_aspect_x != scene.render.pixel_aspect_y:
        notes.say("pixels are square, whatever their aspect")
    if scene.render.film_transparent and scene.cycles.film_transparent_glass:
        notes.say("glass is opaque before a transparent background")
    if scene.render.use_simplify and (scene.cycles.use_camera_cull or scene.cycles.use_distance_cull):
        for o in scene.objects:
            if o.cycles.use_camera_cull or o.cycles.use_distance_cull:
                notes.add("shown although Cycles culls by the camera or the distance", o.name)
    if any(c.holdout for c in _collections(layer.layer_collection)):
        notes.say("collections that are holdouts are shown as any others")


def limits(scene, depth):
    """Returns sentences about settings of Cycles that lull lacks and that change the picture: of those that somebody chose, and of
    those that Blender has from the start."""
    c, r, chosen, usual = scene.cycles, scene.render, [], []

    def note(text, is_usual=False):
        (usual if is_usual else chosen).append(text)

    if c.max_bounces < depth:
        note(f"{c.max_bounces} bounces")
    for name, bounces in ("diffuse", 4), ("glossy", 4), ("transmission", 12):
        found = getattr(c, name + "_bounces")
        if found < min(depth, c.max_bounces):
            note(f"{found} {name} bounces", found == bounces)
    if c.sample_clamp_indirect > 0 or c.sample_clamp_direct > 0:
        note("clamping", c.sample_clamp_direct == 0 and c.sample_clamp_indirect >= 10)
    if not (c.caustics_reflective and c.caustics_refractive):
        note("no caustics")
    if c.use_fast_gi:
        note("Fast GI Approximation")
    if c.blur_glossy > 0:
        note("Filter Glossy", c.blur_glossy <= 1)
    if c.transparent_max_bounces < 8:
        note(f"{c.transparent_max_bounces} transparent bounces")
    if r.use_simplify and c.texture_limit_render != 'OFF':
        note("the limit of textures")
    if c.pixel_filter_type != 'BOX' or c.filter_width != 1:
        note("the pixel filter", True)
    return [_WITHOUT_EFFECT + ", ".join(chosen)] * bool(chosen), [_WITHOUT_EFFECT + ", ".join(usual)] * bool(usual) + _unjudged(scene)


def _unjudged(scene):
    """Returns a sentence about changes of colour that are unknown to lull, which judges noise without them."""
    view = scene.view_settings
    found = [f"the look '{view.look}'"] * (view.look != 'None') + ["gamma"] * (view.gamma != 1) + \
        ["curves"] * view.use_curve_mapping + [f"a display of {scene.display_settings.display_device}"] * \
        (scene.display_settings.display_device != 'sRGB')
    return ["noise is judged without " + ", ".join(found)] if found else []


def _collections(collection):
    return [collection] + [c for child in collection.children for c in _collections(child)]
