"""Makes scenes of one feature of Blender each, and renders them with Cycles and with lull. Runs inside Blender, for features.py:
the last argument is a JSON object of names (none: all but those that are there), there, size, spp, engines and folder.

Prints "VERSION 3.4", "CASE name | title" before each scene, "MADE" behind, and "ALL" with all names at the end. Pictures are FOLDER/NAME.cycles.exr, kept
where there is one, and NAME.lull.exr.
"""
import importlib
import json
import os
import pathlib
import sys

import bpy

FEATURES = pathlib.Path(__file__).parent / "features"
sys.path.insert(0, str(FEATURES))
from cases import CASES, begin  # noqa: E402

for file in sorted(FEATURES.glob("*.py")):
    importlib.import_module(file.stem)


def render(scene, engine, path, spp):
    r, c, l = scene.render, scene.cycles, scene.lull
    r.engine, r.filepath = engine, path
    r.image_settings.file_format, r.image_settings.color_depth, r.image_settings.color_mode = 'OPEN_EXR', '32', 'RGBA'
    r.image_settings.exr_codec = 'ZIP'
    c.samples, c.use_denoising, c.use_adaptive_sampling = spp, False, False
    c.pixel_filter_type, c.filter_width = 'BOX', 1
    l.stop_by, l.spp, l.denoise = 'SAMPLES', spp, False
    try:
        bpy.ops.render.render(write_still=True)
    except RuntimeError as e:
        print("Error:", str(e).strip())


def main():
    o = json.loads(sys.argv[-1])
    print("VERSION", ".".join(map(str, bpy.app.version[:2])), flush=True)
    for name in o["names"] or [n for n in CASES if n not in o["there"]]:
        title, change = CASES[name]
        print(f"CASE {name} | {title}", flush=True)
        scene = begin()
        scene.render.resolution_x, scene.render.resolution_y = o["size"]
        c = scene.cycles
        c.sample_clamp_indirect = c.light_sampling_threshold = c.blur_glossy = 0
        c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = scene.lull.max_depth = 12
        try:
            change(scene)
        except (RuntimeError, AttributeError, KeyError, TypeError) as e:
            print("Info: not made:", e)
            continue
        for engine in o["engines"]:
            path = os.path.join(o["folder"], f"{name}.{engine.lower()}.exr")
            if os.path.exists(path):
                if engine == 'CYCLES':
                    continue
                os.remove(path)
            render(scene, engine, path, o["spp"])
        if 'LULL' in o["engines"]:
            print("MADE", flush=True)
    print("ALL", *CASES, flush=True)


main()
