#!/usr/bin/env python3
"""Tests of the commands in Python: commands_test.py FOLDER PROGRAM, where the module and lull are."""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import threading
import unittest

import numpy as np

sys.path.insert(0, sys.argv.pop(1))
os.environ["LULL_PROGRAM"] = sys.argv.pop(1)
import lull  # noqa: E402
from lull import options, program  # noqa: E402

ROOT = pathlib.Path(__file__).parents[2]
CORNELL = ROOT / "scenes/cornell/scene.pbrt"
SMALL = dict(resolution=(50, 40), progress=False)


class Options(unittest.TestCase):
    def test_are_those_of_the_program(self):
        for command, some in (("render", {"resolution", "denoise", "aov", "max_depth", "output"}),
                              ("compare", {"snapshots", "reference"}), ("evaluate", {"human", "stop"})):
            known = program.options(command)
            self.assertLessEqual(some, known.keys())
            text = subprocess.run([program.find(), command, "--help-all"], capture_output=True,
                                  text=True).stdout
            self.assertEqual(set(re.findall(r"^  (?:-\w,)?--([a-z-]+)", text, re.M)) -
                             {"help", "help-all", "json-progress", "quiet"}, {o.name for o in known.values()})

    def test_become_arguments(self):
        def words(command, **given):
            return options.arguments(command, program.options(command), given)

        self.assertEqual(words("render", resolution=(40, 30), crop=(0, 0.5, 0, 1), denoise=True,
                               caution=None, exr_half=False, max_depth=3, output=pathlib.Path("a")),
                         ["--resolution", "40x30", "--crop", "0,0.5,0,1", "--denoise",
                          "--max-depth", "3", "--output", "a"])
        self.assertEqual(words("render", max_spp=5), words("render", cap=5))
        self.assertEqual(words("render", cap=5, quality="draft"), ["--max-spp", "5", "--quality", "draft"])
        self.assertEqual(words("render", aov_through_specular=True, pass_=5),
                         ["--aov-through-specular", "--pass", "5"])
        self.assertEqual(words("evaluate", stop=["paper", "noise"], margins=[2, 5]),
                         ["--stop", "paper", "--stop", "noise", "--margins", "2,5"])
        for message, given in (("did you mean denoise", {"denoised": True}), ("True or False", {"denoise": 3}),
                               ("is WxH", {"resolution": True})):
            with self.assertRaisesRegex(TypeError, message):
                words("render", **given)


class Exr(unittest.TestCase):
    def test_reads_what_it_writes(self):
        written = {name: np.random.default_rng(i).random((3, 5), np.float32) for i, name in enumerate("BRG")}
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "a.exr")
            lull.commands.exr.write(file, written)
            read, _ = lull.commands.exr.read(file)
        self.assertEqual(list(read), ["B", "G", "R"])
        for name, values in written.items():
            np.testing.assert_array_equal(read[name], values)


class Render(unittest.TestCase):
    def test_returns_what_the_command_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "a.exr")
            r = lull.render(CORNELL, spp=24, denoise=True, aov=["albedo", "normal", "depth"],
                            output=file, **SMALL)
            self.assertTrue(file.with_suffix(".png").exists())
            channels, _ = lull.commands.exr.read(file)
        np.testing.assert_array_equal(r.image[:, :, 2], channels["B"])
        np.testing.assert_array_equal(r.layers["normal"][:, :, 1], channels["N.Y"])
        self.assertEqual({k: v.shape for k, v in r.layers.items()},
                         {"albedo": (40, 50, 3), "normal": (40, 50, 3), "depth": (40, 50),
                          "error": (40, 50)})
        self.assertEqual((r.noisy.shape, r.image.dtype), ((40, 50, 3), np.float32))
        self.assertGreater(abs(r.noisy - r.image).max(), 0)
        self.assertTrue((r.spp == 24).all())
        self.assertEqual([b["spp"] for b in r.blocks], [24])
        self.assertFalse(r.interrupted)
        self.assertGreater(r.seconds, 0)
        self.assertRegex(repr(r), r"^<lull.Rendering of 50 x 40 pixels: 24 to 24 spp, \S+ s>$")

    def test_gives_the_errors_of_the_command(self):
        with self.assertRaisesRegex(lull.Error, "nowhere.pbrt"):
            lull.render("nowhere.pbrt", progress=False)
        with self.assertRaisesRegex(ValueError, "0x5.*is not a size"):
            lull.render(CORNELL, resolution=(0, 5))
        with self.assertRaisesRegex(TypeError, "no option sppp; did you mean spp"):
            lull.render(CORNELL, sppp=3)

    def test_ends_early_with_what_there_is(self):
        def interrupt(event):
            if event["event"] == "progress" and event["medianSpp"] >= 20 and not told:
                told.append(event)
                threading.Timer(0, os.kill, (os.getpid(), signal.SIGINT)).start()

        told = []
        r = lull.render(CORNELL, spp=1000000, resolution=(50, 40), progress=interrupt)
        self.assertTrue(r.interrupted)
        self.assertTrue(20 <= r.spp.min() < 1000000)
        self.assertGreater(r.image.mean(), 0)


class Others(unittest.TestCase):
    def test_compare_and_evaluate(self):
        with tempfile.TemporaryDirectory() as folder:
            c = lull.compare(CORNELL, snapshots=True, stop="lnoise:3", cap=200,
                             output=os.path.join(folder, "c"), **SMALL)
            self.assertEqual(set(c.images), {"automatic", "reference"})
            self.assertEqual(repr(c), "<lull.Comparison of automatic, reference>")
            self.assertEqual(c.images["reference"].shape, (40, 50, 3))
            self.assertIn("automatic", [i["name"] for i in c.figures["images"]])
            thresholds = os.path.join(folder, "c.thresholds.csv")
            rows = lull.evaluate(human=thresholds, predicted=thresholds)
            self.assertEqual(lull.evaluate([], human=thresholds, predicted=thresholds), rows)
            picture = os.path.join(folder, "c.reference.png")
            entropies = lull.entropy([picture], block=50, sub_blocks=25)
            self.assertEqual(entropies, lull.entropy(picture, block=50, sub_blocks=25))
            self.assertEqual([row["block"] for row in entropies], ["", 0])
            self.assertEqual(entropies[0]["h"], entropies[1]["h"])  # one block
            with self.assertRaisesRegex(ValueError, "data.h5"):
                lull.evaluate([os.path.join(folder, "data.h5")], human=thresholds, stop="learned")
        self.assertTrue(rows)
        self.assertTrue(any(value == 0 for row in rows for value in row.values()), rows)

    def test_module_is_the_program(self):
        def run(*words):
            return subprocess.run([sys.executable, "-m", "lull", *words], capture_output=True, text=True,
                                  env=dict(os.environ, PYTHONPATH=sys.path[0]))

        self.assertEqual(run("--version").stdout, "lull %s\n" % lull.__version__)
        self.assertEqual(run("rendr").returncode, 2)

    def test_help_has_arguments_and_results(self):
        for function in lull.render, lull.compare, lull.evaluate, lull.entropy:
            self.assertRegex(function.__doc__, r"Args:\n(.|\n)*Returns:\n(.|\n)*Raises:\n")

    def test_example_runs(self):
        example = ROOT / "renderer/python/examples/three_rules.py"
        said = subprocess.run([sys.executable, "-B", example, CORNELL, "--resolution", "50x40",
                               "--max-spp", "60"], capture_output=True, text=True,
                              env=dict(os.environ, PYTHONPATH=sys.path[0]))
        self.assertEqual(said.returncode, 0, said.stderr)
        for rule in "learned", "lnoise:0.5", "denoised":
            self.assertRegex(said.stdout, rule + r" +\d+ +\d")


if __name__ == "__main__":
    unittest.main()
