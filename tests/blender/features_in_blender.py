"""Makes scenes of one feature of Blender each, and renders them with Cycles and with lull. Runs inside Blender, for features.py:
the last argument is a JSON object of runs, size, spp and folder. A run is a name, the case that it shows, Python that changes it once
all is set up, and the engines that render it.

Prints "VERSION 3.4", "CASE name | title" before each scene, and "MADE" behind. Pictures are FOLDER/NAME.cycles.exr, kept where there
is one, and NAME.lull.exr, of all passes if the scene asks for files of several layers.
"""
import importlib
import json
import os
import pathlib
import sys

import bpy

HERE = pathlib.Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE / "features")]
from cases import CASES, begin  # noqa: E402

for file in sorted((HERE / "features").glob("*.py")):
    importlib.import_module(file.stem)


def set_up(scene, o):
    r, c, l = scene.render, scene.cycles, scene.lull
    r.resolution_x, r.resolution_y = o["size"]
    c.samples, c.use_denoising, c.use_adaptive_sampling = o["spp"], False, False
    c.pixel_filter_type, c.filter_width = 'BOX', 1
    c.sample_clamp_indirect = c.light_sampling_threshold = c.blur_glossy = 0
    c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = l.max_depth = 12
    l.stop_by, l.spp, l.denoise = 'SAMPLES', o["spp"], False


def render(scene, engine, path):
    if os.path.exists(path):
        if engine == 'CYCLES':
            return
        os.remove(path)
    scene.render.engine, scene.render.filepath, settings = engine, path, scene.render.image_settings
    if settings.file_format != 'OPEN_EXR_MULTILAYER':
        settings.file_format, settings.color_mode = 'OPEN_EXR', 'RGBA'
    settings.color_depth, settings.exr_codec = '32', 'ZIP'
    try:
        bpy.ops.render.render(write_still=True)
    except RuntimeError as e:
        print("Error:", str(e).strip())


def main():
    o = json.loads(sys.argv[-1])
    print("VERSION", ".".join(map(str, bpy.app.version[:2])), flush=True)
    for name, case, code, engines in o["runs"]:
        title, change = CASES[case]
        print(f"CASE {name} | {title}", flush=True)
        scene = begin()
        set_up(scene, o)
        try:
            change(scene)
        except (RuntimeError, AttributeError, KeyError, TypeError) as e:
            print("Info: not made:", e)
            continue
        exec(code, {"bpy": bpy, "scene": scene, "s": scene.lull, "r": scene.render})
        for engine in engines:
            render(scene, engine, os.path.join(o["folder"], f"{name}.{engine.lower()}.exr"))
        print("MADE", flush=True)


main()
