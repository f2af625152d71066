"""The render engine: exports the scene, runs lull, and fills Blender's render result."""
import math
import os
import re
import tempfile
import time
import traceback

import bpy
import numpy as np

from . import exr, passes
from .camera import resolution, views
from .export import export
from .process import Failure, Render, ended
from .program import find_lull
from .versions import IS_RECT_FLAT

_ADVICE = "--solid-glass"  # which sheets of this add-on's making need not
_SECONDS_BETWEEN_VIEWS = 0.5
_SECONDS_BETWEEN_LINES = 10  # of progress, in a terminal


def _duration(seconds):
    minutes, hours = round(seconds / 60), round(seconds / 3600)
    return ("%d s" % seconds if seconds < 60 else "%d min" % minutes if minutes < 120 else
            "%d h" % hours)


def _step(event):
    left = event["remainingSeconds"]
    return event["name"] + ("" if left is None else ", %s left" % _duration(left))


def _progress(event):
    text = "%d of %d blocks clean, %d spp" % (
        event["cleanBlocks"], event["blocks"], event["medianSpp"])
    left, between = event["remainingSeconds"], event["remainingRange"]
    if left is None:
        return text
    if between:
        return "%s, done in %s to %s (80 %%)" % (text, *map(_duration, between))
    return "%s, %s%s left" % (text, "at most " if event["remainingIsUpperBound"] else "", _duration(left))


class LullEngine(bpy.types.RenderEngine):
    bl_idname = "LULL"
    bl_label = "lull"
    bl_use_preview = False
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False
    bl_use_postprocess = True
    instead = None  # a function of the engine and the depsgraph, called instead of a render

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", 'COLOR')
        for made in passes.wanted(scene, renderlayer):
            self.register_pass(scene, renderlayer, made.name, len(made.channels), made.channels, made.kind)

    def render(self, depsgraph):
        if LullEngine.instead is not None:
            LullEngine.instead(self, depsgraph)
            return
        try:
            with tempfile.TemporaryDirectory(prefix="lull-") as folder:
                _Job(self, depsgraph, folder).run()
        except Exception as e:
            told = str(_told(e))
            self.error_set(told)  # in the window
            self.report({'ERROR'}, told)  # and in the terminal


def _told(e):
    """Returns an exception as one to show to the user."""
    if isinstance(e, (Failure, OSError)):
        return e
    traceback.print_exception(type(e), e, e.__traceback__)
    return Failure(f"The scene cannot be rendered: {type(e).__name__}: {e}")


def export_scene(scene, layer, folder, name="scene", suffix=".gltf"):
    """Writes a view layer as a render would, and renders nothing. Returns Exported. Raises: Failure."""
    found, r = [], scene.render

    def instead(engine, graph):
        try:
            with tempfile.TemporaryDirectory(prefix="lull-") as scratch:
                found.append(export(graph, engine.frame_set, folder, scratch, name, suffix, False, lambda: False, lambda said: None))
        except Exception as e:
            found.append(_told(e))

    kept = {n: getattr(r, n) for n in ("engine", "use_compositing", "use_sequencer")}
    slots = getattr(bpy.data.images.get("Render Result"), "render_slots", None)
    slot = slots.active_index if slots else 0
    try:
        r.engine, r.use_compositing, r.use_sequencer, LullEngine.instead = 'LULL', False, False, instead
        if slots:  # the last picture is to stay
            slots.active_index = len(slots) - 1
        bpy.ops.render.render(scene=scene.name, layer=layer)
    finally:
        LullEngine.instead = None
        for n, value in kept.items():
            setattr(r, n, value)
        if slots:
            slots.active_index = slot
    if not found:
        raise Failure("The scene cannot be exported")
    if isinstance(found[0], Exception):
        raise found[0]
    return found[0]


def arguments(scene, exported, size):
    """Returns the arguments of `lull render` for an exported scene of this size, as Blender's settings have it."""
    said = [exported.gltf, "--resolution", "%dx%d" % size, *exported.stereo, *scene.lull.arguments()]
    if exported.shutter:
        said += ["--frame", "0", "--shutter", "%.9g" % exported.shutter]
    if exported.environment:
        said += ["--environment", exported.environment]
    if scene.render.film_transparent or exported.backdrop:
        said += ["--transparent"]
    if scene.cycles.film_exposure not in (0, 1):
        said += ["--exposure", "%.9g" % math.log2(scene.cycles.film_exposure)]
    if scene.view_settings.exposure:
        said += ["--view-exposure", "%.9g" % scene.view_settings.exposure]
    return said + _view(scene)


def _view(scene):
    """Returns the arguments for the view transform, which lull has by Blender's own configuration."""
    name = scene.view_settings.view_transform
    folder = bpy.utils.system_resource('DATAFILES', path="colormanagement")
    config = os.environ.get("OCIO") or os.path.join(folder, "config.ocio")
    if name == 'Standard' or scene.display_settings.display_device != 'sRGB' or not os.path.exists(config):
        return []
    return ["--ocio", config, "--view", name]


class _Job:
    """The render of one view layer."""

    def __init__(self, engine, depsgraph, folder):
        self.engine, self.folder, self.graph = engine, folder, depsgraph
        self.scene = depsgraph.scene.original
        self.settings = self.scene.lull
        self.is_transparent = self.scene.render.film_transparent
        self.layer = depsgraph.view_layer.name
        self.view_layer = self.scene.view_layers[self.layer]
        self.passes = passes.wanted(self.scene, self.view_layer)
        self.shown = time.monotonic()  # the progress of the export
        self.views = {name: self._eye(name, depsgraph.scene.camera) for name in views(depsgraph.scene.render)}
        self._measure(depsgraph.scene.render)

    def _eye(self, view, camera):
        """Returns where the camera of a view is."""
        self.engine.active_view_set(view)
        return camera and self.engine.camera_model_matrix(camera).translation.copy()

    def _measure(self, render):
        """Sets the size of the whole image and the rendered part, in fractions."""
        self.whole = resolution(render)
        self.crop, self.size, self.corner = None, self.whole, (0, 0)  # the corner is the lower left one
        if render.use_border:
            # In single precision, as Blender has it: 0.9 of 40 pixels are 36.
            (x0, x1), (y0, y1) = ((int(np.float32(low) * np.float32(n)), int(np.float32(high) * np.float32(n))) for low, high, n in (
                (render.border_min_x, render.border_max_x, self.whole[0]),
                (render.border_min_y, render.border_max_y, self.whole[1])))
            self.size, self.corner = (x1 - x0, y1 - y0), (x0, y0)
            width, height = self.whole
            # lull rounds up: half a pixel less is the same pixel, whatever the fractions lose.
            edges = ((x0, width), (x1, width), (height - y1, height), (height - y0, height))
            self.crop = ",".join("%.9g" % max(0, (at - 0.5) / n) for at, n in edges)

    def run(self):
        lull, engine = find_lull(), self.engine
        engine.update_stats("", "Exporting")
        with tempfile.TemporaryDirectory(prefix="lull-") as scratch:
            exported = export(self.graph, engine.frame_set, self.folder, scratch, "scene", ".glb", True, engine.test_break,
                              self._show_export)
        if exported is None:
            return
        for warning in exported.warnings:
            engine.report({'WARNING'}, warning)
        for remark in exported.remarks:
            engine.report({'INFO'}, remark)
        if lacked := passes.lacked(self.view_layer):
            engine.report({'WARNING'}, "passes that lull lacks are missing: " + ", ".join(lacked))
        picture = os.path.join(self.folder, "picture.exr")
        command = [lull, "render", *arguments(self.scene, exported, self.whole), "-o", picture,
                   *passes.arguments(self.passes, exported.groups)]
        if self.crop:
            command += ["--crop", self.crop]
        if self.scene.render.threads_mode == 'FIXED':
            command += ["--threads", str(self.scene.render.threads)]
        engine.update_stats("", "Reading the scene")
        render = Render(command)
        result = engine.begin_result(0, 0, *self.size, layer=self.layer)
        try:
            self._watch(render, result, exported)
            if os.path.exists(picture):
                self._fill(result, picture, exported)
            elif render.code != 130:
                raise Failure("lull: " + (" ".join(render.errors) or
                                          ended(render.code)))
        finally:
            engine.end_result(result)

    def _show_export(self, said):
        if found := re.match(r"lull: (baking .*)\n$", said):
            self.engine.update_stats("", found[1].capitalize())
        if time.monotonic() - self.shown < (_SECONDS_BETWEEN_LINES if bpy.app.background else _SECONDS_BETWEEN_VIEWS):
            return
        self.shown = time.monotonic()
        if found := re.findall(r"^lull: (image \d+ of \d+)$", said, re.M):
            self.engine.update_stats("", "Baking " + found[-1])

    @staticmethod
    def _named(text, exported):
        """Returns a message with names in place of paths in the file, such as "object 'lamp'" for /nodes/6."""
        def name(found):
            names, number = exported.names.get(found[1], ()), int(found[2])
            kind = "object" if found[1] == "nodes" else found[1][:-1]
            return f"{kind} '{names[number]}': " if number < len(names) else found[0]

        return re.sub(r"\S*scene\.glb: /(\w+)/(\d+)\S*: (?:warning: )?", name, text)

    def _watch(self, render, result, exported):
        """Shows the progress of the render until it ends."""
        count = 2 if len(exported.stereo) == 2 else 1  # of pictures side by side
        film = np.zeros((self.size[1], count * self.size[0], 4), np.float32)
        changed, shown, said = False, time.monotonic(), -_SECONDS_BETWEEN_LINES
        for kind, what in render.events(self.engine.test_break):
            if kind == "show":
                x, y, channels = what
                rectangle = film[y:y + len(channels["R"]), x:x + channels["R"].shape[1]]
                for i, name in enumerate("RGB"):
                    rectangle[:, :, i] = channels[name]
                rectangle[:, :, 3] = 1
                changed = True
            elif kind in ("progress", "step"):
                self.engine.update_progress(what["percent"] / 100)
                if bpy.app.background and time.monotonic() - said < _SECONDS_BETWEEN_LINES:
                    continue  # there each of them is a line
                said = time.monotonic()
                self.engine.update_stats("", (_step if kind == "step" else _progress)(what))
            elif kind in ("warning", "note") and _ADVICE not in what:
                self.engine.report({'WARNING' if kind == "warning" else 'INFO'}, "lull: " + self._named(what, exported))
            if changed and time.monotonic() - shown > _SECONDS_BETWEEN_VIEWS:
                for i, view in enumerate(self.views):
                    self._set(result, "Combined", view, np.split(film, count, 1)[i % count])
                self.engine.update_result(result)
                changed, shown = False, time.monotonic()

    def _fill(self, result, path, exported):
        try:
            channels, attributes = exr.read(path)
        except ValueError as e:
            raise Failure(str(e)) from e
        for made in self.passes:
            self.engine.add_pass(made.name, len(made.channels), made.channels, layer=self.layer)
        for view in self.views:
            own = {name.removeprefix(view + "."): plane for name, plane in channels.items() if view and name.startswith(view + ".")}
            self._fill_view(result, view, channels | own, attributes, exported)
        for field, value in passes.cryptomatte_fields(self.layer, attributes):
            self.engine.get_result().stamp_data_add_field(field, value)

    def _fill_view(self, result, view, channels, attributes, exported):
        if exported.backdrop and not self.is_transparent:
            behind = (1 - channels["A"][..., None]) * self._backdrop(exported.backdrop)
            for name in channels.keys() & {prefix + c for prefix in ("", "noisy.", "light.environment.") for c in "RGB"}:
                channels[name] = channels[name] + behind[..., "RGB".index(name[-1])]
        combined = np.ones((self.size[1], self.size[0], 4), np.float32)
        for i, name in enumerate("RGB"):
            combined[:, :, i] = channels[name]
        if self.is_transparent:  # colours are multiplied by it, as Blender wants them
            combined[:, :, 3] = channels["A"]
        self._set(result, "Combined", view, combined)
        picture = passes.Picture(channels, attributes, exported, self.scene, self.views[view])
        for made in self.passes:
            self._set(result, made.name, view, made.fill(picture))

    def _backdrop(self, path):
        """Returns the rendered part of the backdrop."""
        image = bpy.data.images.load(path)
        try:
            width, height = image.size
            pixels = np.empty(width * height * 4, np.float32)
            image.pixels.foreach_get(pixels)
        finally:
            bpy.data.images.remove(image)
        x, y = self.corner
        shown = pixels.reshape(height, width, 4)[y:y + self.size[1], x:x + self.size[0], :3]
        return shown[::-1] * (self.scene.cycles.film_exposure or 1)

    @staticmethod
    def _set(result, name, view, values):
        """Fills a pass, whose lowest row comes first."""
        values = np.ascontiguousarray(values[::-1], np.float32)
        target = result.layers[0].passes.find_by_name(name, view)
        target.rect.foreach_set(values.ravel() if IS_RECT_FLAT else values.reshape(-1, values.shape[2]))
