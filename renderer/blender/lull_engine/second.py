"""Bakes nodes and renders the world, in a Blender of its own; see baking.py, which writes the request.

The last argument is the path of a JSON file: `blend` (materials, worlds, lights and cameras), frame, subframe, `bakes`, `bodies`,
`world` and `images`. Answers are .npy files beside it, and said.json: the suns of the world, and materials that `failed`.
"""
import importlib
import json
import os
import sys
import traceback
import types

import bpy
import numpy as np

# The add-on's modules without the add-on, which is not registered here.
_PACKAGE = types.ModuleType("lull_parts")
_PACKAGE.__path__ = [os.path.dirname(os.path.abspath(__file__))]
sys.modules["lull_parts"] = _PACKAGE
bake, displacement, world = (importlib.import_module(f"lull_parts.{name}") for name in ("bake", "displacement", "world"))


def load(path):
    """Appends everything of a file to nothing, so that it keeps its name."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(path) as (there, wanted):
        for kind in "scenes", "materials", "worlds", "lights", "cameras", "objects":
            setattr(wanted, kind, getattr(there, kind))


def change(name, pixels):
    """Gives an image these pixels."""
    old = next((i for i in bpy.data.images if i.name_full == name), None)
    if old is None:  # no node has it
        return
    made = bpy.data.images.new(name, pixels.shape[1], pixels.shape[0], alpha=True, float_buffer=old.is_float)
    made.colorspace_settings.name, made.alpha_mode = old.colorspace_settings.name, old.alpha_mode
    made.pixels.foreach_set(pixels.ravel())
    old.user_remap(made)


def baked(baker, bodies, each):
    if each["over"] == 'all':
        return baker.plain(each["nodes"], each["object"])
    if each["over"] == 'uv':
        return baker.over_uvs(each["nodes"], each["names"], each["size"])
    return baker.over_mesh(each["nodes"], bodies[str(each["body"])], each["size"], each["slots"], each["kind"])


def _told(name, error):
    traceback.print_exc()
    return name, f"{type(error).__name__}: {error}"


def main():
    request = sys.argv[-1]
    with open(request, encoding="utf-8") as f:
        what = json.load(f)
    folder = os.path.dirname(request)
    load(what["blend"])
    for name, file in what["images"].items():
        change(name, np.load(os.path.join(folder, file)))
    baker = bake.Baker(what["frame"], what["subframe"])
    bodies, failed = {}, []
    for number, body in what["bodies"].items():
        arrays = dict(np.load(os.path.join(folder, body["arrays"])))
        said = {"uv": np.zeros((len(arrays["corners"]), 2), np.float32), "points": arrays["points"], "normals": arrays["normals"]}
        try:
            made = bodies[number] = baker.body(arrays, body)
            said["uv"] = made.uvs()
            if body["moves"]:
                vectors = {slot: made.displace(baker, described, body["size"], [slot]) for slot, described in body["moves"]}
                points = displacement.moved(*(arrays[n] for n in ("points", "corners", "starts", "slots")), np.array(body["matrix"]), vectors)
                said["normals"], said["points"] = made.move(points), points.astype(np.float32)
        except Exception as e:  # whatever it is, the other meshes have their values
            failed.append(_told(body["name"], e))
        for name, values in said.items():
            np.save(os.path.join(folder, f"{name}{number}.npy"), values)
    for i, each in enumerate(what["bakes"]):
        print(f"lull: image {i + 1} of {len(what['bakes'])}", flush=True)
        try:
            found = baked(baker, bodies, each)
        except Exception as e:  # whatever it is, the other materials have their values
            failed.append(_told(next((n["copy"][1] for n in each["nodes"]["nodes"] if "copy" in n), ""), e))
            found = np.zeros(3) if each["over"] == 'all' else np.zeros((4, 4, 3))
        np.save(os.path.join(folder, f"bake{each['number']}.npy"), found)
    suns = world.write(what["world"], what["frame"], what["subframe"]) if what["world"] else []
    with open(os.path.join(folder, "said.json"), "w", encoding="utf-8") as f:
        json.dump({"suns": suns, "failed": failed}, f)


main()
