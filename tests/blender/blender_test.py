#!/usr/bin/env python3
"""Tests of the Blender add-on, headless: blender_test.py BLENDER ADDON.zip PROGRAM.

Pictures are compared with those of Cycles, as means of the whole and of blocks of 10x10 pixels: small,
with a fixed seed on both sides. `--keep FOLDER` leaves them there to look at."""
import json
import os
import pathlib
import shlex
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy as np

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE.parents[1] / "renderer/python/lull"))
import exr  # noqa: E402

BLENDER, ADDON, PROGRAM = sys.argv[1:4]
KEEP = sys.argv[5] if sys.argv[4:5] == ["--keep"] else None
SIZE, SPP = (60, 40), 64
SAMPLES = "s.stop_by, s.spp, s.denoise = 'SAMPLES', %d, False; " % SPP


def rgb(channels, name="Combined"):
    return np.stack([channels[f"{name}.{c}"] for c in "RGB"], -1)


def blocks(image, n=10):
    height, width = image.shape[:2]
    return image.reshape(height // n, n, width // n, n, 3).mean((1, 3))


class AddOn(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(KEEP or cls.scratch.name)
        user = pathlib.Path(cls.scratch.name, "user")
        cls.environment = dict(os.environ, BLENDER_USER_SCRIPTS=str(user / "scripts"),
                               BLENDER_USER_CONFIG=str(user / "config"),
                               PATH=f"{pathlib.Path(PROGRAM).parent}:{os.environ['PATH']}")
        os.makedirs(user / "scripts/addons")
        cls.addon = user / "scripts/addons/lull_engine"
        cls.blender("--factory-startup", "--python-expr",
                    f"import bpy; bpy.ops.preferences.addon_install(filepath={ADDON!r})")
        for frame, spp, names in ((1, 4 * SPP, ["factory", "lamps", "glass", "veil", "nodes", "pane", "passes", "fur",
                                                 "cards", "mixtures", "sides"]),
                                  (11, 4 * SPP, ["skin"]), (1, 0, ["doubtful"])):
            what = {"folder": str(cls.folder), "names": names, "size": SIZE, "spp": spp, "frame": frame}
            cls.blender("--factory-startup", "--python", str(HERE / "scenes.py"), "--",
                        json.dumps(what))

    @classmethod
    def tearDownClass(cls):
        cls.scratch.cleanup()

    @classmethod
    def blender(cls, *arguments, fails=False):
        ran = subprocess.run([BLENDER, "-b", "-noaudio", "--python-exit-code", "3", *arguments],
                             text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             env=cls.environment, timeout=600)
        assert (ran.returncode != 0) == fails, ran.stdout
        return ran.stdout

    def command(self, name, settings, frame=1):
        """Returns the arguments that render a scene with lull."""
        return [str(self.folder / f"{name}.blend"), "--addons", "lull_engine", "-E", "LULL", "-o",
                str(self.folder / f"{name}.lull."), "-F", "OPEN_EXR_MULTILAYER", "--python-expr",
                f"import bpy; scene = bpy.context.scene; s = scene.lull; {settings}", "-f", str(frame)]

    def read(self, name, frame=1):
        """Returns the passes of a picture by their names, without that of the view layer."""
        file = f"{name}.exr" if frame is None else f"{name}.lull.{frame:04}.exr"
        channels, _ = exr.read(self.folder / file)
        return {key.split(".", 1)[1]: plane for key, plane in channels.items()}

    rendered = {}  # with no settings but the samples, by name and frame

    def render(self, name, settings=SAMPLES, frame=1):
        known = self.rendered.get((name, frame)) if settings == SAMPLES else None
        if known is None:
            said = self.blender(*self.command(name, settings, frame))
            known = self.read(name, frame), said
            if settings == SAMPLES:
                self.rendered[name, frame] = known
        return known

    def assert_close(self, name, passes, most, most_of_blocks):
        """Compares with Cycles: the mean of each channel, and blocks, on average."""
        lull, cycles = rgb(passes), rgb(self.read(f"{name}.cycles", None))
        apart = lull.mean((0, 1)) / cycles.mean((0, 1)) - 1
        of_blocks = abs(blocks(lull) - blocks(cycles)).mean() / cycles.mean()
        print(f"{name}: means {np.round(100 * apart, 2)} %, blocks {100 * of_blocks:.2f} %")
        self.assertLess(abs(apart).max(), most)
        self.assertLess(of_blocks, most_of_blocks)

    def test_factory_scene(self):
        passes, said = self.render("factory")
        # Blender's base below the interface is lighter: tests/measurements/renderer.md.
        self.assert_close("factory", passes, 0.05, 0.05)
        cycles = self.read("factory.cycles", None)
        seen = cycles["Depth.Z"] < 1e9
        self.assertLess(np.median(abs(passes["Depth.Z"] - cycles["Depth.Z"])[seen]), 0.01)
        for axis in "XYZ":
            self.assertLess(np.median(abs(passes[f"Normal.{axis}"] - cycles[f"Normal.{axis}"])[seen]),
                            0.01)
        self.assertAlmostEqual(np.median(passes["Albedo.R"][seen]), 0.8, delta=0.1)
        self.assertTrue((passes["Samples.X"] == SPP).all())
        self.assertTrue((passes["Noise.X"][seen] > 0).any())
        self.assertTrue((passes["Combined.A"] == 1).all())
        self.assertIn("blocks stopped", said)

    def test_leaves_the_background_out(self):
        passes, said = self.render("factory", SAMPLES + "scene.render.film_transparent = True")
        self.assertNotIn("Warning", said)
        alpha, seen = passes["Combined.A"], self.read("factory.cycles", None)["Depth.Z"] < 1e9
        inside = alpha == 1
        self.assertLess((inside != seen).mean(), 0.15)  # but for the edges
        self.assertGreater((alpha == 0).mean(), 0.3)
        self.assertEqual(abs(rgb(passes)[alpha == 0]).max(), 0)
        # Where there is no background, it is the picture that it always is.
        opaque, _ = self.render("factory")
        self.assertEqual(abs(rgb(opaque)[inside] - rgb(passes)[inside]).max(), 0)

    def test_lamps(self):
        passes, said = self.render("lamps")
        self.assert_close("lamps", passes, 0.01, 0.02)
        self.assertNotIn("Warning", said)

    def test_glass_under_an_image(self):
        passes, said = self.render("glass")
        self.assert_close("glass", passes, 0.01, 0.02)
        cycles = self.read("glass.cycles", None)
        behind = (cycles["Depth.Z"] > 1e9) & (passes["Depth.Z"] > 1e9)
        self.assertLess(np.percentile(abs(rgb(passes) - rgb(cycles))[behind], 95), 0.01)  # the world, as sharp as there
        self.assertNotIn("Warning", said)

    def test_alpha_portals_and_a_sun(self):
        passes, said = self.render("veil")
        self.assert_close("veil", passes, 0.01, 0.02)
        self.assertNotIn("Warning", said)

    def test_nodes_that_gltf_lacks(self):
        passes, said = self.render("nodes")
        self.assert_close("nodes", passes, 0.01, 0.02)
        self.assertNotIn("Warning", said)

    def test_hair_leaves_and_what_cameras_see(self):
        passes, said = self.render("fur")
        self.assert_close("fur", passes, 0.02, 0.04)
        self.assertNotIn("Warning", said)

    def test_images_and_colours_as_cycles_reads_them(self):
        passes, said = self.render("cards")
        self.assert_close("cards", passes, 0.01, 0.02)
        self.assertNotIn("Warning", said)

    def test_mixtures_and_places_of_textures(self):
        passes, said = self.render("mixtures")
        self.assert_close("mixtures", passes, 0.01, 0.02)
        self.assertNotIn("Warning", said)

    def test_sides_corners_and_coordinates(self):
        passes, said = self.render("sides")
        self.assert_close("sides", passes, 0.01, 0.02)
        self.assertNotIn("Warning", said)

    def test_keeps_an_orthographic_camera(self):
        _, said = self.render("factory", SAMPLES + "d = scene.camera.data; d.type, d.dof.use_dof = 'ORTHO', True")
        self.assertIn("the orthographic camera 'Camera' is sharp at all distances", said)

    def test_passes_of_view_layers(self):
        passes, said = self.render("passes")
        cycles = self.read("passes.cycles", None)
        self.assertIn("passes that lull lacks are missing: uv", said)
        self.assert_close("passes", passes, 0.01, 0.02)
        for name, near in ("Mist.Z", 0.01), ("Position.X", 0.02), ("Position.Y", 0.02), ("Position.Z", 0.02):
            self.assertLess(np.median(abs(passes[name] - cycles[name])), near, name)
        for name, index in ("IndexOB.X", 3), ("IndexMA.X", 5):
            found, wanted = passes[name] == index, cycles[name] == index
            self.assertGreater(wanted.sum(), 20)
            self.assertLess((found != wanted).sum(), 0.2 * wanted.sum(), name)
            self.assertEqual(set(np.unique(passes[name])), {0, index})
        for kind in "CryptoObject00", "CryptoMaterial00":  # ids are hashes of names
            ids, wanted = (p[kind + ".r"].view(np.uint32) for p in (passes, cycles))
            self.assertGreater((ids == wanted).mean(), 0.9, kind)
        _, attributes = exr.read(self.folder / "passes.lull.0001.exr")
        names = [value for key, value in attributes.items() if key.startswith("cryptomatte/") and key.endswith("/name")]
        self.assertEqual(sorted(names), [b"ViewLayer.CryptoMaterial", b"ViewLayer.CryptoObject"])
        for group in "warm", "cold", "sky":
            got, wanted = (rgb(p, "Combined_" + group).mean() for p in (passes, cycles))
            self.assertAlmostEqual(got / wanted, 1, delta=0.02, msg=group)
        self.assertEqual(rgb(passes, "Combined_none").max(), 0)

    def test_passes_by_the_names_that_composites_link(self):
        passes, said = self.render("passes", SAMPLES + "c = scene.view_layers[0].cycles; c.denoising_store_passes = True; "
                                   "c.pass_debug_sample_count = c.use_pass_volume_direct = True")
        for theirs, ours in (("Denoising Normal.X", "Normal.X"), ("Denoising Albedo.G", "Albedo.G"), ("Denoising Depth.Z", "Depth.Z"),
                             ("Noisy Image.R", "Combined.R"), ("Debug Sample Count.X", "Samples.X")):
            self.assertTrue((passes[theirs] == passes[ours]).all(), theirs)
        self.assertIn("passes that lull lacks are missing: uv, volume direct", said)

    def test_brightens_as_the_film_and_the_view_do(self):
        once, _ = self.render("lamps")
        twice, said = self.render("lamps", SAMPLES + "scene.cycles.film_exposure = 2; scene.view_settings.exposure = 1")
        self.assertNotIn("Error", said)
        self.assertLess(abs(rgb(twice) - 2 * rgb(once)).max(), 1e-4)

    def test_lets_the_sun_through_panes(self):
        solid, said = self.render("pane", SAMPLES + "s.panes = False")
        self.assertNotIn("Warning", said)
        sheet, said = self.render("pane")
        self.assertIn("1 object is made a sheet instead of a slab", said)
        open_, _ = self.render("pane", SAMPLES + "bpy.data.objects['pane'].hide_render = True")
        shadow = (slice(-6, None), slice(20, 40))  # below the pane
        self.assertLess(rgb(solid)[shadow].mean(), 0.2 * rgb(open_)[shadow].mean())
        # By both interfaces' colour and one's reflection; the pane reflects some light of the floor, too.
        share = rgb(sheet)[shadow].mean((0, 1)) / rgb(open_)[shadow].mean((0, 1))
        for got, colour in zip(share, (0.9, 0.95, 0.9)):
            self.assertAlmostEqual(got, colour ** 2 * 0.97, delta=0.05)

    def test_skin_at_a_frame(self):
        passes, _ = self.render("skin", frame=11)
        self.assert_close("skin", passes, 0.005, 0.01)

    def test_denoises_a_border(self):
        passes, _ = self.render("skin", SAMPLES + "s.denoise = True; r = scene.render; "
                                "r.use_border = r.use_crop_to_border = True; r.border_min_x = 0.3; "
                                "r.border_max_x, r.border_min_y, r.border_max_y = 0.7, 0.25, 0.9", 3)
        self.assertEqual(passes["Noisy.R"].shape, (26, 24))
        self.assertGreater(abs(rgb(passes) - rgb(passes, "Noisy")).max(), 0)
        self.assertLess(abs(rgb(passes) - rgb(passes, "Noisy")).mean(), 0.05)

    def test_denoises_by_default(self):
        passes, said = self.render("factory", "")
        self.assertIn("Noisy.R", passes)
        self.assertLess(passes["Samples.X"].max(), 1000)
        self.assertLess(said.count("blocks stopped, "), 20)

    def test_ends_early_with_what_there_is(self):
        # Of a frame that is ended, Blender's own -f writes nothing.
        render = ("s.stop_by, s.spp, s.cap, s.denoise = 'SAMPLES', 1000000, 1000000, False; bpy.ops.render.render(); "
                  f"bpy.data.images['Render Result'].save_render({str(self.folder / 'ended.exr')!r})")
        with subprocess.Popen([BLENDER, "-b", "-noaudio", *self.command("lamps", render)[:-2]],
                              text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              env=self.environment, start_new_session=True) as process:
            said = ""
            for line in process.stdout:
                said += line
                if "blocks stopped, " in line and "stopped, 0 spp" not in line:
                    process.send_signal(signal.SIGINT)
                    break
            said += process.communicate(timeout=100)[0]
        passes = self.read("ended", None)
        self.assertTrue((1 <= passes["Samples.X"]).all() and (passes["Samples.X"] < 1000000).all(), said)
        self.assertGreater(rgb(passes).mean(), 0)

    def program(self, path, text):
        """Makes a program of a shell script."""
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("#!/bin/sh\n" + text, encoding="utf-8")
        path.chmod(0o755)
        return path

    def test_renders_in_this_blender_alone_with_its_own_program(self):
        own = self.program(self.addon / "program/bin/lull", f'echo "by its own" >&2; exec {PROGRAM} "$@"\n')
        try:
            passes, said = self.render("factory", SAMPLES + "from lull_engine import baking; baking.run = None; bpy.ops.lull.test()")
        finally:
            own.unlink()
        self.assertIn("The add-on's own, version ", said)
        self.assertGreater(rgb(passes).mean(), 0)

    def test_gives_no_time_while_all_samples_are_its_bound(self):
        said = self.blender("--factory-startup", "--addons", "lull_engine", "--python-expr", """
from lull_engine.engine import _progress
event = {'blocks': 4, 'medianSpp': 0, 'remainingSeconds': 20000, 'remainingIsUpperBound': True}
print(_progress({**event, 'stoppedBlocks': 0}), '|', _progress({**event, 'stoppedBlocks': 1}))""")
        self.assertIn("0 of 4 blocks stopped, 0 spp | 1 of 4 blocks stopped, 0 spp, at most 6 h left", said)

    def test_refuses_light_linking_by_name(self):
        _, said = self.render("factory", SAMPLES + """
light = bpy.data.objects['Light']
if hasattr(light, 'light_linking'):
    light.light_linking.receiver_collection = bpy.data.collections.new('some')
else:
    print("1 object is lighting and shadowing all objects, without light linking: 'Light'")""")
        self.assertEqual(said.count("1 object is lighting and shadowing all objects, without light linking: 'Light'"), 1, said)

    def test_says_what_is_wrong(self):
        other = self.program(self.folder / "other/lull", "echo lull 9.8.7\n")
        for message, settings in (
                ("Program not found: /nowhere/lull", "bpy.ops.preferences.addon_enable(module='lull_engine'); "
                 "bpy.context.preferences.addons['lull_engine'].preferences.program = '/nowhere/lull'"),
                ("Program lull not found on the PATH", "import os; os.environ['PATH'] = '/nowhere'"),
                (f"{other} is lull 9.8.7; this add-on needs lull", "import bpy; bpy.ops.preferences.addon_enable(module='lull_engine'); "
                 f"bpy.context.preferences.addons['lull_engine'].preferences.program = {str(other)!r}"),
                ("lull: --stop", "s.stop_by, s.rule = 'RULE', 'nonsense'"),
                ("panoramic", "scene.camera.data.type = 'PANO'")):
            said = self.blender(*self.command("factory", settings), fails=True)
            errors = [line for line in said.splitlines() if line.startswith("Error")]
            self.assertEqual(len(errors), 1, said)
            self.assertIn(message, errors[0])
            self.assertNotIn("Traceback", said)

    def test_checks_and_exports_for_the_command_line(self):
        path = self.folder / "exported" / "lamps.gltf"
        path.parent.mkdir()
        said = self.blender(*self.command("lamps", SAMPLES + f"""
bpy.ops.lull.check()
print('TEXT', repr(bpy.data.texts['lull: differences'].as_string()))
bpy.ops.lull.export(filepath={str(path)!r})""")[:-2])
        self.assertIn("TEXT 'Nothing will look different.", said)
        command = next(line[line.index("lull render"):] for line in said.splitlines() if "lull render" in line)
        self.assertEqual(sorted(f.name for f in path.parent.iterdir()), ["lamps.bin", "lamps.gltf"])
        self.assertNotIn("Warning", said)
        picture = path.with_name("picture.exr")
        subprocess.run(shlex.split(command) + ["-o", picture, "--quiet"], env=self.environment, check=True,
                       stdout=subprocess.DEVNULL)
        channels, _ = exr.read(picture)
        once, _ = self.render("lamps")
        self.assertLess(abs(np.stack([channels[c] for c in "RGB"], -1) - rgb(once)).max(), 1e-5)

    def test_exports_one_file(self):
        path = self.folder / "one" / "passes.glb"
        path.parent.mkdir()
        path.with_suffix(".blend").write_bytes(b"the user's")
        said = self.blender(*self.command("passes", SAMPLES + f"bpy.ops.lull.export(filepath={str(path)!r})")[:-2])
        command = next(line[line.index("lull render"):] for line in said.splitlines() if "lull render" in line)
        self.assertEqual(sorted(f.name for f in path.parent.iterdir()), ["passes.blend", "passes.glb", "passes.world.exr"])
        self.assertEqual(path.with_suffix(".blend").read_bytes(), b"the user's")
        picture = path.with_name("picture.exr")
        subprocess.run(shlex.split(command) + ["-o", picture, "--quiet"], env=self.environment, check=True,
                       stdout=subprocess.DEVNULL)
        channels, _ = exr.read(picture)
        once, _ = self.render("passes")
        self.assertLess(abs(np.stack([channels[c] for c in "RGB"], -1) - rgb(once)).max(), 1e-5)

    def test_exports_copies_as_one_mesh(self):
        path = self.folder / "copies.gltf"
        self.blender(*self.command("factory", SAMPLES + f"""
cube = bpy.data.objects['Cube']
for k in (1, 2):
    copy = bpy.data.objects.new(f'Copy {{k}}', cube.data)
    copy.location.x = 3 * k
    scene.collection.objects.link(copy)
bpy.ops.lull.export(filepath={str(path)!r})""")[:-2])
        nodes = {node["name"]: node for node in json.loads(path.read_text())["nodes"]}
        cube, first, second = (nodes[name] for name in ("Cube", "Copy 1", "Copy 2"))
        self.assertEqual((first["mesh"], second["mesh"]), (cube["mesh"], cube["mesh"]))
        self.assertEqual([first["matrix"][12], second["matrix"][12]], [3, 6])

    def test_exports_what_moves_while_the_shutter_is_open(self):
        path = self.folder / "moving.gltf"
        said = self.blender(*self.command("factory", SAMPLES + f"""
scene.render.use_motion_blur, scene.render.motion_blur_shutter, scene.render.fps = True, 0.5, 25
cube = bpy.data.objects['Cube']
for frame in 0, 2:
    cube.location.x = 4 * frame
    cube.keyframe_insert('location', frame=frame)
cube.animation_data.action.fcurves[0].keyframe_points[0].interpolation = 'LINEAR'
scene.frame_set(1)
bpy.ops.lull.export(filepath={str(path)!r})""")[:-2])
        self.assertIn("--frame 0 --shutter 0.02 ", said)
        root = json.loads(path.read_text())
        animation, = root["animations"]
        self.assertEqual({root["nodes"][c["target"]["node"]]["name"] for c in animation["channels"]}, {"Cube"})
        channel = next(c for c in animation["channels"] if c["target"]["path"] == "translation")
        view = root["bufferViews"][root["accessors"][animation["samplers"][channel["sampler"]]["output"]]["bufferView"]]
        keys = path.with_suffix(".bin").read_bytes()[view["byteOffset"]:][:view["byteLength"]]
        np.testing.assert_allclose(np.frombuffer(keys, "<f4").reshape(2, 3)[:, 0], (3, 5), atol=1e-5)

    def test_warns_by_name(self):
        _, said = self.render("factory", SAMPLES + """
cube = bpy.data.objects['Cube']
cube.is_holdout = True
nodes = cube.active_material.node_tree.nodes
noise = nodes.new('ShaderNodeTexNoise')
cube.active_material.node_tree.links.new(noise.outputs['Color'], nodes['Principled BSDF'].inputs['Base Color'])
(nodes['Principled BSDF'].inputs.get('Subsurface') or nodes['Principled BSDF'].inputs['Subsurface Weight']).default_value = 0.5
bpy.data.lights['Light'].use_shadow = False""")
        for text in ("1 object is shown as surfaces, not as shadow catchers or holdouts: 'Cube'", "1 material is without subsurface: 'Material'",
                     "1 light is casting shadows all the same: 'Light'"):
            self.assertEqual(said.count(text), 1, said)


    def test_warns_of_all_that_differs(self):
        passes, said = self.render("doubtful", SAMPLES + "s.texture = 64")
        for text in (
                "1 material is the same from all sides and for all rays: 'by rays'",
                "1 material is in the viewport colour, as nothing is known of the surface: 'unknown'",
                "1 material is with the normals of the first of mixed surfaces that has any: 'bumped'",
                "1 material is displaced as finely as meshes are, without bump: 'moved'",
                "1 material is letting light through where transparent: 'veiled'",
                "1 material is with the normals of the surface on its clear coat: 'coated'",
                "1 material is in part in the viewport colour, as one of its surfaces is unknown: 'half known'",
                "1 material is of the same transmission everywhere: 'patchy'",
                "1 material is occluded by the same object alone: 'shaded'",
                "1 material is reflecting as a clear coat does: 'facing'",
                "1 material is brighter where light falls flat, as normals lean far: 'leaning'",
                "1 object is brighter near the edge of its own shadow, without its Shading Offset: 'soft'",
                "1 light is shining in another direction, being sheared: 'askew'",
                "passes that lull lacks are missing: cryptomatte above 6 levels",
                "1 material is without anisotropic: 'brushed'",
                "1 material is without diffuse roughness: 'rough'",
                "1 material is without the length, width and direction of hair: 'haired'",
                "1 object is lit otherwise along edges, where smooth normals lean far from faces: 'round'",
                "blurred, by images of 64 pixels over whole meshes (Texture Size): 'fine'",
                "1 material is the same on all copies: 'random'",
                "1 light group is black in its pass, as one of more than 16: 'group",
                "1 light is left out, taking light away: 'dark'",
                "1 object is shown although Cycles culls by the camera or the distance: 'edge'",
                "glass is opaque before a transparent background",
                "differs: all bounces are traced, without Cycles' fast approximation",
                "noise is judged without the look 'High Contrast'"):
            self.assertEqual(said.count(text), 1, text + "\n" + said)
        self.assertGreater(rgb(passes).mean(), 0)


if __name__ == "__main__":
    del sys.argv[1:4]
    if KEEP:
        del sys.argv[1:3]
    unittest.main()
