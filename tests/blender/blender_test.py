#!/usr/bin/env python3
"""Tests of the Blender add-on, headless: blender_test.py BLENDER ADDON.zip PROGRAM [--keep FOLDER].

One Blender renders or checks cases of features/ by their names, judged as by features.py; verdicts are those of the table of this
version. `--keep` leaves the pictures there to look at."""
import json
import os
import pathlib
import re
import shlex
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np

import features
from features import exr

BLENDER, ADDON, PROGRAM = sys.argv[1:4]
KEEP = sys.argv[5] if sys.argv[4:5] == ["--keep"] else None
SPP = 64
MEANS, BLOCKS = 0.01, 0.02  # differences from the table

# Rendered with Cycles and with lull.
PICTURES = """plastic transparent exposure shift orthographic_focus depth_of_field clip_start area_shapes area_shadow lamp_groups
sun_nodes lamps_seen spot portal world_image world_backdrop water emission alphas alpha leaf_cut shadowed glow mixed added_shine
coated two_sided nothing group by_object coarse_image mappings muted uvs_lacking alpha_unused colours_for_renders colours
channels_as_colours generated_of_modifiers faces text_uvs layers pose motion_of_copies unseen_copies hair_info displacement
passes glossy_seen_flat nearly_black mix_by_texture multiple_scattering shader_into_colour colour_into_surface no_light
scaled_to_nothing numbered_copies wide_sun window_in unsaved_images python_drivers rigid_body""".split()

# Exported by lull alone, for the warnings.
WARNED = """in_part unknown masked_glass coat_tinted leaning terminator lamps_scaled limits oren_nayar subsurface tint velvet
smooth_edges instancer_uvs by_facing fine light_groups negative_lamp no_shadow lamp_rays lamp_bounces falloff lamp_texture spot_scaled
light_linking simplify transparent_glass holdout pixel_aspect blades sheared_camera motion_of_lamps world_volume world_rays points
volume dicing missing beckmann""".split()

EXPORT = "bpy.ops.lull.check(); print('TEXT', repr(bpy.data.texts['lull: differences'].as_string())); bpy.ops.lull.export(filepath={!r})"
LAYERS = "r.image_settings.file_format = 'OPEN_EXR_MULTILAYER'; "
EYES = "r.use_multiview, eyes = True, scene.camera.data.stereo; eyes.interocular_distance, eyes.convergence_distance = 0.6, 5; "
PROGRAM_OF = ("bpy.ops.preferences.addon_enable(module='lull_engine'); "
              "bpy.context.preferences.addons['lull_engine'].preferences.program = {!r}")


def rgb(channels, name="Combined"):
    return np.stack([channels[f"{name}.{c}"] for c in "RGB"], -1)


class AddOn(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(KEEP or cls.scratch.name).resolve()
        cls.blender = features.Blender(BLENDER, ADDON, PROGRAM, cls.scratch.name + "/user")
        cls.exported = cls.folder / "exported"
        cls.exported.mkdir(exist_ok=True)
        (cls.exported / "passes.blend").write_bytes(b"the user's")
        cls.other = cls.program(cls.folder / "other/lull", "echo lull 9.8.7\n")
        paths = {name: str(cls.exported / name) for name in ("shapes.gltf", "passes.glb", "moving.gltf")}
        lull, none = ['LULL'], []
        runs = [(name, name, "", ['CYCLES', 'LULL']) for name in PICTURES]
        runs += [(name, name, "bpy.ops.lull.check()", none) for name in WARNED]
        runs += [
            ("stored", "plastic", f"bpy.ops.wm.save_as_mainfile(filepath={str(cls.folder / 'stored.blend')!r})", none),
            ("composites", "passes", "c = scene.view_layers[0].cycles; c.denoising_store_passes = True; "
             "c.pass_debug_sample_count = c.use_pass_volume_direct = True", lull),
            ("pane", "sunlit_pane", "", lull), ("slab", "sunlit_pane", "s.panes = False", lull),
            ("open", "sunlit_pane", "bpy.data.objects['pane'].hide_render = True", lull),
            ("cropped", "plastic", LAYERS + "s.denoise = r.use_border = r.use_crop_to_border = True; r.border_min_x = 0.3; "
             "r.border_max_x, r.border_min_y, r.border_max_y = 0.7, 0.25, 0.9", lull),
            ("eyes", "plastic", LAYERS + EYES + "r.image_settings.views_format = 'MULTIVIEW'", ['CYCLES', 'LULL']), ("toe-in", "plastic", EYES + "eyes.convergence_mode = 'TOE'", lull),
            ("default", "plastic", LAYERS + "s.stop_by, s.denoise = 'DEFAULT', True", lull),
            ("looks", "looks", "scene.cycles.use_fast_gi = True; bpy.ops.lull.check()", none),
            ("shapes", "area_shapes", EXPORT.format(paths["shapes.gltf"]), none),
            ("glb", "passes", EXPORT.format(paths["passes.glb"]), none),
            ("moving", "motion_blur", f"""
ball = bpy.data.objects['ball']
for curve in ball.animation_data.action.fcurves:
    for key in curve.keyframe_points:
        key.interpolation = 'LINEAR'
for k in 1, 2:
    copy = bpy.data.objects.new(f'copy {{k}}', ball.data)
    copy.location.x = 3 * k
    scene.collection.objects.link(copy)
r.motion_blur_shutter, r.fps = 0.5, 25
bpy.ops.lull.export(filepath={paths["moving.gltf"]!r})""", none),
            ("faulty", "plastic", """
from lull_engine import lights, materials, meshes
places = [(meshes, 'of_blender', 1, 'ball'), (materials, 'write', 0, 'floor'), (lights.Lights, '_folded', 1, 'Area')]
kept = [getattr(owner, name) for owner, name, _, _ in places]
for (owner, name, at, wanted), old in zip(places, kept):
    def faulty(*values, at=at, wanted=wanted, old=old, **more):
        if getattr(values[at], 'name', values[at]) == wanted:
            raise ValueError('no sense')
        return old(*values, **more)
    setattr(owner, name, faulty)
bpy.ops.lull.check()
for (owner, name, _, _), old in zip(places, kept):
    setattr(owner, name, old)""", none),
            ("thinned", "hair_info", """
from lull_engine import strands
strands._LIMIT = 1200
bpy.ops.lull.check()
strands._LIMIT = 12_000_000""", none),
            ("time", "plastic", """
from lull_engine.engine import _progress
event = {'blocks': 4, 'cleanBlocks': 0, 'medianSpp': 0, 'remainingSeconds': None, 'remainingRange': None, 'remainingIsUpperBound': True}
bound, known = {'cleanBlocks': 1, 'remainingSeconds': 20000}, {'remainingSeconds': 600, 'remainingRange': [500, 800]}
print(_progress(event), '|', _progress({**event, **bound}), '|', _progress({**event, **known}))""", none),
            ("settings", "plastic", """
s.seed, s.quality, s.stop_by = 5, 'draft', 'DEFAULT'
scene.frame_set(7)
print(*s.arguments())
s.same_seed, s.caution = True, 1.5
print(*s.arguments())""", none),
            ("no rule", "plastic", "s.stop_by, s.rule = 'RULE', 'nonsense'", lull), ("panoramic", "panorama", "", lull),
            ("nowhere", "plastic", PROGRAM_OF.format("/nowhere/lull"), lull), ("other", "plastic", PROGRAM_OF.format(str(cls.other)), lull),
            ("no program", "plastic", "import os; os.environ['PATH'] = '/nowhere'; " + PROGRAM_OF.format(""), lull)]
        cls.heard = {name: (title, lines) for name, title, lines in cls.blender.render(runs, cls.folder, SPP)}
        cls.table = features.tables().get(cls.blender.version, {})

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def program(cls, path, text):
        """Makes a program of a shell script."""
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("#!/bin/sh\n" + text, encoding="utf-8")
        path.chmod(0o755)
        return path

    def stored(self):
        """Returns the arguments that open a stored scene for renders with lull."""
        return str(self.folder / "stored.blend"), "--addons", "lull_engine", "-E", "LULL", "-F", "OPEN_EXR_MULTILAYER"

    def said(self, name):
        return "\n".join(self.heard[name][1])

    def read(self, name):
        """Returns the passes of a picture by their names, without that of the view layer."""
        channels, _ = exr.read(self.folder / f"{name}.exr")
        return {key.split(".", 1)[-1] if "." in key else "Combined." + key: plane for key, plane in channels.items()}

    def test_pictures_are_those_of_cycles(self):
        for name in PICTURES:
            with self.subTest(name):
                title, lines = self.heard[name]
                verdict, *apart, worst = features.judge(self.folder, name, features.said(lines))
                print(f"{name}: mean {100 * apart[0]:.2f} %, blocks {100 * apart[1]:.2f} %, worst block {100 * worst:.0f} %")
                wanted = self.table.get(title, ["", verdict, 0, 0])
                self.assertEqual(verdict, wanted[1])
                for value, figure, most in zip(apart, wanted[2:], (MEANS, BLOCKS)):
                    self.assertLess(abs(value - float(figure) / 100), most)

    def test_warns_of_all_that_differs(self):
        for name in WARNED:
            with self.subTest(name):
                if name not in self.heard:
                    self.assertEqual(name, "light_linking")
                    continue
                title, lines = self.heard[name]
                texts = features.consequences(features.said(lines))
                if title in self.table:
                    self.assertEqual(self.table[title][1].partition("warned: ")[2], "; ".join(texts))
                else:
                    self.assertTrue(texts)
        for name, text in (("holdout", "1 object is shown as surfaces, not as shadow catchers or holdouts: 'ball'"),
                           ("oren_nayar", "1 material is without diffuse roughness: 'surface'"),
                           ("no_shadow", "1 light is casting shadows all the same: 'key'")):
            self.assertEqual(self.said(name).count(text), 1, self.said(name))

    def test_passes_of_view_layers(self):
        passes, cycles, said = self.read("passes.lull"), self.read("passes.cycles"), self.said("passes")
        self.assertIn("passes that lull lacks are missing: uv, cryptomatte above 6 levels", said)
        self.assertIn("blocks clean", said)
        seen = cycles["Depth.Z"] < 1e9
        for name, near in (("Depth.Z", 0.01), ("Normal.X", 0.01), ("Normal.Y", 0.01), ("Normal.Z", 0.01), ("Mist.Z", 0.01),
                           ("Position.X", 0.02), ("Position.Y", 0.02), ("Position.Z", 0.02)):
            self.assertLess(np.median(abs(passes[name] - cycles[name])[seen]), near, name)
        self.assertAlmostEqual(passes["Albedo.R"][-1, 0], 0.5, delta=0.01)  # of the floor
        self.assertTrue((passes["Samples.X"] == SPP).all())
        self.assertTrue((passes["Noise.X"][seen] > 0).any())
        self.assertTrue((passes["Combined.A"] == 1).all())
        for name, index in ("IndexOB.X", 3), ("IndexMA.X", 5):
            found, wanted = passes[name] == index, cycles[name] == index
            self.assertGreater(wanted.sum(), 20)
            self.assertLess((found != wanted).sum(), 0.2 * wanted.sum(), name)
            self.assertEqual(set(np.unique(passes[name])), {0, index})
        for kind in "CryptoObject00", "CryptoMaterial00":  # ids are hashes of names
            ids, wanted = (p[kind + ".r"].view(np.uint32) for p in (passes, cycles))
            self.assertGreater((ids == wanted).mean(), 0.9, kind)
        _, attributes = exr.read(self.folder / "passes.lull.exr")
        names = [value for key, value in attributes.items() if key.startswith("cryptomatte/") and key.endswith("/name")]
        self.assertEqual(sorted(names), [b"ViewLayer.CryptoMaterial", b"ViewLayer.CryptoObject"])
        for group in "warm", "cold", "sky":
            got, wanted = (rgb(p, "Combined_" + group).mean() for p in (passes, cycles))
            self.assertAlmostEqual(got / wanted, 1, delta=0.02, msg=group)
        self.assertEqual(rgb(passes, "Combined_none").max(), 0)

    def test_passes_by_the_names_that_composites_link(self):
        passes = self.read("composites.lull")
        for theirs, ours in (("Denoising Normal.X", "Normal.X"), ("Denoising Albedo.G", "Albedo.G"), ("Denoising Depth.Z", "Depth.Z"),
                             ("Noisy Image.R", "Combined.R"), ("Debug Sample Count.X", "Samples.X")):
            self.assertTrue((passes[theirs] == passes[ours]).all(), theirs)
        self.assertIn("passes that lull lacks are missing: uv, volume direct", self.said("composites"))

    def test_leaves_the_background_out(self):
        # Where there is no background, it is the picture that it always is.
        opaque, clear = self.read("plastic.lull"), self.read("transparent.lull")
        self.assertEqual(set(np.unique(opaque["Combined.A"])), {1})
        self.assertEqual(abs(rgb(clear)[clear["Combined.A"] == 0]).max(), 0)

    def test_lets_the_sun_through_panes(self):
        self.assertNotIn("Warning", self.said("slab"))
        self.assertIn("1 object is made a sheet instead of a slab", self.said("pane"))
        slab, sheet, free = (rgb(self.read(name + ".lull")) for name in ("slab", "pane", "open"))
        shadow = free.sum(2) > 0  # where the sheet is between the sun and the floor
        shadow &= slab.sum(2) < 0.5 * free.sum(2)
        shadow[:24] = False
        self.assertGreater(shadow.sum(), 50)
        # By the colour of both interfaces and the reflection of one; the pane reflects some light of the floor, too.
        for share, colour in zip(sheet[shadow].mean(0) / free[shadow].mean(0), (0.9, 0.95, 0.9)):
            self.assertAlmostEqual(share, colour ** 2 * 0.97, delta=0.08)

    def test_renders_both_eyes(self):
        ours, theirs = self.read("eyes.lull"), self.read("eyes.cycles")
        for eye, other in ("left", "right"), ("right", "left"):
            here, there = (abs(rgb(ours, "Combined." + eye) - rgb(theirs, "Combined." + e)).mean() for e in (eye, other))
            self.assertLess(2 * here, there, eye)
        self.assertGreater(abs(ours["Depth.left.Z"] - ours["Depth.right.Z"]).max(), 1)

    def test_denoises_a_border(self):
        passes = self.read("cropped.lull")
        self.assertEqual(passes["Noisy.R"].shape, (26, 24))
        self.assertGreater(abs(rgb(passes) - rgb(passes, "Noisy")).max(), 0)
        self.assertLess(abs(rgb(passes) - rgb(passes, "Noisy")).mean(), 0.05)

    def test_denoises_by_default(self):
        passes = self.read("default.lull")
        self.assertIn("Noisy.R", passes)
        self.assertLess(passes["Samples.X"].max(), 1000)
        self.assertLess(self.said("default").count("blocks clean, "), 20)

    def test_ends_early_with_the_picture_so_far(self):
        # Of a frame that is ended, Blender's own -f writes nothing.
        render = ("import bpy; scene = bpy.context.scene; s = scene.lull; s.stop_by, s.spp, s.cap, s.denoise = 'SAMPLES', 1000000, 1000000, "
                  "False; bpy.ops.render.render(); "
                  f"bpy.data.images['Render Result'].save_render({str(self.folder / 'ended.exr')!r})")
        with self.blender.start(*self.stored(), "--python-expr", render, start_new_session=True) as process:
            said = ""
            for line in process.stdout:
                said += line
                if "blocks clean, " in line and "clean, 0 spp" not in line:
                    process.send_signal(signal.SIGINT)
                    break
            said += process.communicate(timeout=100)[0]
        passes = self.read("ended")
        self.assertTrue((1 <= passes["Samples.X"]).all() and (passes["Samples.X"] < 1000000).all(), said)
        self.assertGreater(rgb(passes).mean(), 0)

    def test_renders_in_this_blender_alone_with_its_own_program(self):
        own = self.program(self.blender.addon / "program/bin/lull", f'echo "by its own" >&2; exec {PROGRAM} "$@"\n')
        expression = "import bpy; from lull_engine import baking; baking.run = None; bpy.ops.lull.test()"
        with self.blender.start(*self.stored(), "-o", str(self.folder / "frame."), "--python-expr", expression, "-f", "1") as process:
            said = process.communicate(timeout=300)[0]
        own.unlink()
        self.assertEqual(process.returncode, 0, said)
        self.assertIn("Version 0.1.0, the add-on's own", said)
        np.testing.assert_allclose(rgb(self.read("frame.0001")), rgb(self.read("plastic.lull")), atol=1e-5)

    def test_names_what_an_exception_left_out(self):
        for kind, name in ("object", "ball"), ("material", "floor"), ("light", "key"):
            self.assertIn(f"1 {kind} is left out or plain, after an error (ValueError: no sense): '{name}'", self.said("faulty"))

    def test_thins_out_hair_that_memory_does_not_suffice_for(self):
        self.assertIn("1 object is shown with 1 of 5 hairs, as much wider, 1 of 8 segments, as all would take", self.said("thinned"))

    def test_says_what_it_bakes_before(self):
        self.assertIn("Baking 4 images of up to 64 pixels across, the world, about 1 s", self.said("unsaved_images"))

    def test_lull_ends_with_blender(self):
        render = "import bpy; s = bpy.context.scene.lull; s.stop_by, s.spp, s.cap = 'SAMPLES', 1000000, 1000000; bpy.ops.render.render()"
        with self.blender.start(*self.stored(), "--python-expr", render) as process:
            while "blocks clean, " not in process.stdout.readline():
                pass
            child, = subprocess.run(["pgrep", "-P", str(process.pid)], stdout=subprocess.PIPE, text=True, check=True).stdout.split()
            process.kill()
        for _ in range(100):
            try:  # one that has ended is a zombie until init waits for it, which that of a container may not do
                if pathlib.Path("/proc", child, "stat").read_text(encoding="utf-8").rpartition(") ")[2].startswith("Z"):
                    return
            except OSError:
                return
            time.sleep(0.1)
        self.fail("lull runs on")

    def test_gives_no_time_before_it_is_known(self):
        self.assertIn("0 of 4 blocks clean, 0 spp | 1 of 4 blocks clean, 0 spp, at most 6 h left | "
                      "0 of 4 blocks clean, 0 spp, done in 8 min to 13 min (80 %)", self.said("time"))

    def test_has_a_seed_for_each_frame_and_the_caution_of_old_files(self):
        first, second = [line for line in self.said("settings").split("\n") if line.startswith("--max-spp")]
        self.assertIn("--seed 12 ", first)
        self.assertIn("--quality draft", first)
        self.assertIn("--seed 5 ", second)
        self.assertIn("--caution 1.5", second)
        self.assertNotIn("--quality", second)

    def test_says_why_there_is_no_picture(self):
        for name, message in (("no rule", "lull: --stop"), ("panoramic", "panoramic"), ("toe-in", "toe-in"),
                              ("nowhere", "Program not found: /nowhere/lull"), ("other", f"{self.other} is lull 9.8.7; this add-on needs lull"),
                              ("no program", "Program lull not found on the PATH")):
            errors = [line for line in self.heard[name][1] if line.startswith("Error")]
            self.assertIn(message, "\n".join(errors))
            self.assertEqual(len({features.clean(line) for line in errors}), 1, errors)
            self.assertNotIn("Traceback", self.said(name))

    def render_exported(self, name):
        """Renders as the export says. Returns the picture."""
        command = re.search("lull render .*", self.said(name)).group(0)
        picture = self.folder / f"{name}.exported.exr"
        subprocess.run(shlex.split(command) + ["-o", picture, "--quiet"], check=True, stdout=subprocess.DEVNULL,
                       env=dict(os.environ, PATH=f"{pathlib.Path(PROGRAM).resolve().parent}:{os.environ['PATH']}"))
        return rgb(self.read(picture.stem))

    def test_checks_and_exports_for_the_command_line(self):
        self.assertIn("TEXT 'Nothing will look different.", self.said("shapes"))
        self.assertNotIn("Warning", self.said("shapes"))
        self.assertIn("noise is judged without the look 'High Contrast', gamma", self.said("looks"))
        self.assertIn("settings of Cycles without effect: Fast GI Approximation", self.said("looks"))
        self.assertLess(abs(self.render_exported("shapes") - rgb(self.read("area_shapes.lull"))).max(), 1e-5)
        self.assertLess(abs(self.render_exported("glb") - rgb(self.read("passes.lull"))).max(), 1e-5)
        self.assertEqual(sorted(f.name for f in self.exported.iterdir()), [
            "moving.bin", "moving.gltf", "moving.world.exr", "passes.blend", "passes.glb", "passes.world.exr", "shapes.bin", "shapes.gltf"])
        self.assertEqual((self.exported / "passes.blend").read_bytes(), b"the user's")

    def test_exports_copies_as_one_mesh_and_movement_by_the_shutter(self):
        root = json.loads((self.exported / "moving.gltf").read_text())
        nodes = {node["name"]: node for node in root["nodes"]}
        self.assertEqual({nodes[name]["mesh"] for name in ("copy 1", "copy 2")}, {nodes["ball"]["mesh"]})
        self.assertEqual([nodes[name]["matrix"][12] for name in ("copy 1", "copy 2")], [3, 6])
        self.assertIn("--frame 0 --shutter 0.02 ", self.said("moving"))
        animation, = root["animations"]
        self.assertEqual({root["nodes"][c["target"]["node"]]["name"] for c in animation["channels"]}, {"ball"})
        channel = next(c for c in animation["channels"] if c["target"]["path"] == "translation")
        view = root["bufferViews"][root["accessors"][animation["samplers"][channel["sampler"]]["output"]]["bufferView"]]
        keys = (self.exported / "moving.bin").read_bytes()[view["byteOffset"]:][:view["byteLength"]]
        np.testing.assert_allclose(np.frombuffer(keys, "<f4").reshape(2, 3)[:, 0], (-0.25, 0.25), atol=1e-5)


if __name__ == "__main__":
    del sys.argv[1:4]
    if KEEP:
        del sys.argv[1:3]
    unittest.main()
