#!/usr/bin/env python3
"""Tests of the Python module: python_test.py FOLDER, where the module is."""
import ast
import contextlib
import io
import pathlib
import sys
import tempfile
import threading
import unittest
import unittest.mock
import warnings

import numpy as np

sys.path.insert(0, sys.argv.pop(1))
sys.path.append(str(pathlib.Path(__file__).parents[2] / "stopping/examples"))
import drive_renderer  # noqa: E402
import lull  # noqa: E402
import paper  # noqa: E402

WIDTH, HEIGHT = 70, 60


def picture(spp, seed=0):
    """Returns a gradient and the noise of two halves of so many samples: their mean and the first."""
    random = np.random.default_rng(seed + spp)
    truth = np.linspace(0.2, 0.6, WIDTH)[None, :, None] * np.ones((HEIGHT, WIDTH, 3))
    halves = [truth + 0.4 * random.standard_normal(truth.shape) / np.sqrt(spp / 2) for _ in "ab"]
    return np.float32(sum(halves) / 2), np.float32(halves[0])


def numbers(answer):
    return [np.asarray(getattr(answer, name)).tolist() for name in
            ("stop", "stopped", "checked", "spp", "next_spp", "votes", "value", "probability")]


class StopperTest(unittest.TestCase):
    def test_stops_when_noise_is_gone(self):
        stopper = lull.Stopper(WIDTH, HEIGHT, model="entropy")
        self.assertFalse(stopper.done)
        self.assertFalse(stopper.needs_half)
        self.assertTrue(stopper.active.all())
        spp = 0
        while not stopper.done:
            spp += 40
            answer = stopper.observe(picture(spp)[0], spp)
            self.assertLess(spp, 10000)
            self.assertEqual(answer.stopped.shape, (1, 1))
        self.assertGreater(spp, 160)
        self.assertTrue(answer.stop)
        self.assertLess(answer.probability[0, 0], 0.5)
        self.assertEqual(answer.spp[0, 0], spp)
        self.assertIsNone(answer.masked_noise)
        self.assertFalse(stopper.active.any())
        self.assertEqual(numbers(stopper.answer())[3:], numbers(answer)[3:])

    def test_reads_any_layout(self):
        image, half = picture(40)
        plain = lull.Stopper(WIDTH, HEIGHT, rule="lnoise:0.1").observe(image, 40, half)
        self.assertGreater(plain.masked_noise[0, 0], 1)
        self.assertIsNone(plain.probability)
        with_alpha = np.concatenate([image, np.ones((HEIGHT, WIDTH, 1), np.float32)], axis=2)
        wide = np.zeros((2 * HEIGHT, 3 * WIDTH, 3), np.float32)
        wide[::2, ::3] = image
        layouts = {
            "fortran": np.asfortranarray(image),
            "flipped": image[::-1, ::-1, ::-1].copy()[::-1, ::-1, ::-1],
            "planes": np.ascontiguousarray(image.transpose(2, 0, 1)).transpose(1, 2, 0),
            "alpha": with_alpha,
            "every other": wide[::2, ::3],
            "double": np.float64(image),
            "big endian": image.astype(">f4"),
        }
        for name, other in layouts.items():
            for other_half in (half, half.astype(np.float64), np.asfortranarray(half)):
                with warnings.catch_warnings(record=True) as warned:
                    warnings.simplefilter("always")
                    answer = lull.Stopper(WIDTH, HEIGHT, rule="lnoise:0.1").observe(other, 40, other_half)
                self.assertEqual(["image has 4 channels" in str(w.message) for w in warned],
                                 [True] * (name == "alpha"))
                self.assertEqual(numbers(answer), numbers(plain), name)
        grey = np.broadcast_to(image[:, :, :1], image.shape)  # one value for all three
        grey_half = np.broadcast_to(half[:, :, :1], half.shape)
        answer = lull.Stopper(WIDTH, HEIGHT, rule="lnoise:0.1").observe(grey, 40, grey_half)
        copied = lull.Stopper(WIDTH, HEIGHT, rule="lnoise:0.1").observe(grey.copy(), 40, grey_half.copy())
        self.assertEqual(numbers(answer), numbers(copied))

    def test_takes_eight_bits(self):
        codes = np.arange(HEIGHT * WIDTH * 3, dtype=np.uint64).reshape(HEIGHT, WIDTH, 3)
        codes = (codes * codes // 7 % 256).astype(np.uint8)
        v = codes / 255
        linear = np.float32(np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4))
        eight, real = (lull.Stopper(WIDTH, HEIGHT, rule="entropy") for _ in "ab")
        for spp in (100, 200):
            a, b = eight.observe(codes[::-1], spp), real.observe(linear[::-1], spp)
            self.assertEqual(numbers(a), numbers(b))
            codes, linear = codes[:, ::-1], linear[:, ::-1]

    def test_blocks(self):
        stopper = lull.Stopper(140, 60, rule="lnoise:1.5", block=70)
        self.assertEqual(stopper.blocks, [(0, 0, 70, 60), (70, 0, 70, 60)])
        for spp in (4000, 8000, 12000):
            calm, noisy = picture(spp), picture(spp // 1000)
            image = [np.concatenate([a, b], axis=1) for a, b in zip(calm, noisy)]
            answer = stopper.observe(image[0], spp, image[1])
        self.assertEqual(answer.stopped.tolist(), [[True, False]])
        self.assertFalse(answer.stop)
        self.assertEqual(stopper.active[:, :70].sum(), 0)
        self.assertTrue(stopper.active[:, 70:].all())
        one = stopper.observe_block(1, noisy[0], 12500, half=noisy[1])
        self.assertEqual((one.stop, one.checked, one.spp, one.probability), (False, True, 12500, None))
        self.assertGreater(one.masked_noise, 1.5)

    def test_goes_on_from_saved_states(self):
        stopper, whole = (lull.Stopper(WIDTH, HEIGHT) for _ in "ab")
        for spp in range(40, 600, 40):
            image = picture(spp)[0]
            self.assertEqual(numbers(stopper.observe(image, spp)), numbers(whole.observe(image, spp)))
            state = stopper.save()
            stopper = lull.Stopper(WIDTH, HEIGHT)
            stopper.restore(state)
        with self.assertRaisesRegex(OSError, "damaged"):
            stopper.restore(state[:-1])
        with self.assertRaisesRegex(OSError, "other settings"):
            lull.Stopper(WIDTH, HEIGHT + 1).restore(state)

    def test_says_what_is_wrong(self):
        image, _ = picture(40)
        stopper = lull.Stopper(WIDTH, HEIGHT)
        for wrong, message in (
                (image[:-1], "59 x 70 x 3; needed are 60 x 70 x 3"),
                (image[:, :, :2], "60 x 70 x 2"), (image[:, :, 0], "60 x 70;"),
                (image.astype(np.int32), "int32"), (image > 0.3, "bool"), (np.complex64(image), "complex64")):
            with self.assertRaisesRegex(ValueError, message):
                stopper.observe(wrong, 40)
        with self.assertRaises(TypeError):
            stopper.observe("image", 40)
        with self.assertRaisesRegex(ValueError, "different types"):
            stopper.observe(image, 40, half=np.uint8(image))
        with self.assertRaisesRegex(ValueError, "half buffer"):
            lull.Stopper(WIDTH, HEIGHT, rule="lnoise").observe(image, 40)
        for wrong, message in ((255 * image, "brighter than 4 times"), (np.nan * image, "not finite"), (-image, "negative")):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                with self.assertRaisesRegex(ValueError, message):
                    stopper.observe(wrong, 40)
        stopper.observe(image, 40)
        with self.assertRaisesRegex(ValueError, "spp must increase"):
            stopper.observe(image, 40)
        with self.assertRaisesRegex(ValueError, "there is no block 1"):
            stopper.observe_block(1, image, 80)
        for settings, error in ((dict(rule="hunch"), ValueError), (dict(model="unknown"), OSError),
                                (dict(model="a", rule="b"), ValueError),
                                (dict(model="entropy\0"), ValueError), (dict(rule="lnoise\0"), ValueError),
                                (dict(models="a\0"), ValueError), (dict(block=0), ValueError),
                                (dict(caution=0), ValueError), (dict(caution=float("nan")), ValueError)):
            with self.assertRaises(error):
                lull.Stopper(WIDTH, HEIGHT, **settings)
        with self.assertRaises(ValueError):
            lull.Stopper(39, HEIGHT)

    def test_warns_at_once_of_what_it_cannot_check(self):
        def warned_at(ratio, **settings):
            """Returns at which picture it says so, of eight; None: never."""
            stopper, spp = lull.Stopper(WIDTH, HEIGHT, **settings), 40.0
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                for k in range(8):
                    try:
                        stopper.observe(picture(int(spp))[0], int(spp))
                    except UserWarning as warning:
                        self.assertRegex(str(warning), r"^images at \d+, \d+ and %d spp lie" % int(spp))
                        return k
                    spp *= ratio

        self.assertEqual((warned_at(2), warned_at(1.7), warned_at(1.4)), (2, 2, None))
        self.assertIsNone(warned_at(2, rule="entropy"))  # which looks at each
        self.assertIsNone(warned_at(2, rule="fixed:300"))
        for pass_spp in 20, 40:
            stopper = lull.Stopper(WIDTH, HEIGHT)
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                for spp in range(pass_spp, 300, pass_spp):
                    stopper.observe(picture(spp)[0], spp)
        image, half = picture(40)
        image[3, 4, 1] = np.nan
        black = np.nan_to_num(image)
        with self.assertWarnsRegex(UserWarning, "image has values that are not finite"):
            answer = lull.Stopper(WIDTH, HEIGHT, rule="lnoise:0.1").observe(image, 40, half)
        self.assertEqual(numbers(answer), numbers(
            lull.Stopper(WIDTH, HEIGHT, rule="lnoise:0.1").observe(black, 40, half)))
        for message, other in ("mostly above 1", black + 1), ("negative", black - 0.2):
            with self.assertWarnsRegex(UserWarning, "image .*" + message):
                lull.Stopper(WIDTH, HEIGHT).observe_block(0, np.float32(other), 40)
        half[0, 0, 2] = np.inf
        with self.assertWarnsRegex(UserWarning, "half has values"):
            lull.Stopper(WIDTH, HEIGHT, rule="lnoise:0.1").observe(black, 40, half)

    def test_measures_entropies(self):
        codes = np.uint8(255 * np.clip(picture(40)[0], 0, 1))
        whole = lull.svd_entropy(codes, sub_blocks=1)
        self.assertEqual(whole.h.shape, (1, 1))
        np.testing.assert_allclose(whole.h, whole.h1 + whole.h2, atol=1e-12)
        parts = lull.svd_entropy(codes)
        self.assertEqual(parts.h.shape, (10, 10))
        part = lull.svd_entropy(codes[6:12, 14:21], sub_blocks=1)  # row 1, column 2
        self.assertEqual(parts.h[1, 2], part.h[0, 0])
        self.assertTrue(((0 < parts.h) & (parts.h < 1)).all())
        self.assertGreater(lull.svd_entropy(picture(20)[0]).h.mean(), lull.svd_entropy(picture(9000)[0]).h.mean())
        # The definition, on an L that numpy computes.
        v = codes / 255
        y = np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4) @ [0.212671, 0.715160, 0.072169]
        lightness = 116 * np.where(y > 0.008856, np.cbrt(y), 7.787 * y + 16 / 116) - 16
        s = np.linalg.svd(lightness, compute_uv=False) ** 2
        terms = -s / s.sum() * np.log(s / s.sum()) / np.log(len(s))
        self.assertAlmostEqual(whole.h[0, 0], terms.sum(), 9)
        self.assertAlmostEqual(whole.h1[0, 0], terms[:len(s) // 4].sum(), 9)
        attributes = lull.attributes26(codes)
        self.assertEqual(attributes.shape, (26,))
        box = np.pad(lightness, 1, mode="reflect")
        mean = sum(box[j:j + HEIGHT, i:i + WIDTH] for j in range(3) for i in range(3)) / 9
        self.assertAlmostEqual(attributes[0], abs(lightness - mean).mean(), 9)
        for sub_blocks in 0, -1, 99, 61 * 61, 10 ** 9:
            with self.assertRaises(ValueError):
                lull.svd_entropy(codes, sub_blocks=sub_blocks)
        # One pixel has one singular value, and no parts.
        for one in codes[:1, :1], np.float32(codes[:1, :1]) / 255, np.zeros((1, 1, 3), np.float32):
            self.assertEqual([float(h[0, 0]) for h in lull.svd_entropy(one, sub_blocks=1)], [0, 0, 0])
            with self.assertRaisesRegex(ValueError, "1x1 pixels has no 100 sub-blocks"):
                lull.svd_entropy(one)
            with self.assertRaisesRegex(ValueError, "1x1"):
                lull.attributes26(one)
        for wrong in codes[:, :, 0], codes[:0], codes.astype(int):
            with self.assertRaises(ValueError):
                lull.svd_entropy(wrong)
        for text in (lull.svd_entropy, lull.attributes26, lull.Stopper.observe):
            self.assertRegex(text.__doc__, r"Args:\n(.|\n)*Returns:\n(.|\n)*Raises:\n")

    def test_tells_a_logger(self):
        stopper = lull.Stopper(140, 60, rule="fixed:80", block=70)
        image = np.concatenate([picture(40)[0]] * 2, axis=1)
        with self.assertLogs("lull.stopper", "DEBUG") as log:
            stopper.observe(image, 40)
            stopper.observe_block(0, picture(40)[0], 80)
        self.assertEqual(log.output[0], "INFO:lull.stopper:40 spp: 0 of 2 blocks are clean")
        self.assertEqual(log.output[1], "DEBUG:lull.stopper:block 0: <lull.BlockAnswer: active at 40 spp, value 40, threshold 80>")
        self.assertIn("block 0: <lull.BlockAnswer: clean at 80 spp", log.output[-1])
        with self.assertNoLogs("lull.stopper", "INFO"):
            stopper.observe_block(1, picture(40)[0], 80)

    def test_reads_rows_that_overlap(self):
        image = picture(40)[0]
        # Each row is the one above, moved by a pixel.
        window = np.lib.stride_tricks.as_strided(image, (40, 40, 3), (12, 12, 4), writeable=False)
        a, b = (lull.Stopper(40, 40, rule="entropy").observe(v, 40) for v in (window, window.copy()))
        self.assertEqual(numbers(a), numbers(b))

    def test_says_what_it_is(self):
        stopper = lull.Stopper(WIDTH, HEIGHT, rule="fixed:80")
        self.assertEqual(repr(stopper), "<lull.Stopper of 70 x 60 pixels: 0 of 1 blocks clean>")
        image, _ = picture(40)
        self.assertEqual(repr(stopper.observe(image, 40)), "<lull.Answer: 0 of 1 blocks clean, at 40 to 40 spp>")
        self.assertEqual(repr(stopper.observe_block(0, image, 80)),
                         "<lull.BlockAnswer: clean at 80 spp, value 80, threshold 80>")
        self.assertEqual(repr(stopper), "<lull.Stopper of 70 x 60 pixels: 1 of 1 blocks clean>")

    def test_stub_names_all_there_is(self):
        stub = ast.parse(pathlib.Path(lull.__file__).with_name("_lull.pyi").read_text())
        for kind in (node for node in stub.body if isinstance(node, ast.ClassDef)):
            members = [n for n in kind.body if not isinstance(n, ast.Expr)]  # a docstring is one
            named = {n.target.id if isinstance(n, ast.AnnAssign) else n.name for n in members}
            if kind.name == "SvdEntropy":
                self.assertEqual(named, set(lull.SvdEntropy._fields))
                continue
            real = {n for n in vars(getattr(lull, kind.name)) if not n.startswith("_")}
            self.assertEqual(named - {"__init__"}, real, kind.name)

    def test_lets_other_threads_run(self):
        answers = [None] * 4

        def judge(i):
            stopper = lull.Stopper(WIDTH, HEIGHT, rule="entropy:2")
            for spp in range(40, 400, 40):
                answers[i] = numbers(stopper.observe(picture(spp)[0], spp))

        threads = [threading.Thread(target=judge, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(answers, [answers[0]] * 4)
        self.assertIsNotNone(answers[0])

    def test_example_drives_a_renderer(self):
        with contextlib.redirect_stdout(io.StringIO()) as out:
            image, spp = drive_renderer.drive(width=200, height=100, caution=0.5)
        self.assertEqual(spp.shape, (1, 2))
        self.assertLess(2 * spp[0, 0], spp[0, 1])  # less noise on the left
        self.assertLess(spp[0, 1], 10000)
        self.assertIn("100% of 2 blocks are clean", out.getvalue())
        self.assertTrue(np.isfinite(image).all())

    def test_example_watches_pictures_by_their_spp(self):
        images = {spp: np.uint8(255 * np.clip(picture(spp)[0], 0, 1)) for spp in (40, 100, 56, 80)}
        names = {f"tex_{spp}.png": image for spp, image in images.items()}
        self.assertEqual(drive_renderer.by_spp(sorted(names)),
                         [(spp, f"tex_{spp}.png") for spp in (40, 56, 80, 100)])
        with unittest.mock.patch.object(drive_renderer, "read", names.get):
            with contextlib.redirect_stdout(io.StringIO()) as out:
                drive_renderer.watch_pictures(sorted(names))
        self.assertEqual([line.split()[0] for line in out.getvalue().splitlines()], ["40", "56", "80", "100"])
        for files, message in ((["a.png"], "no number of samples"), (["a_40.png", "b_40.png"], "as many samples")):
            with self.assertRaisesRegex(SystemExit, message):
                drive_renderer.by_spp(files)

    def test_example_runs_the_papers_method(self):
        pictures = {spp: np.uint8(255 * np.clip(picture(spp)[0], 0, 1)) for spp in range(20, 420, 20)}
        own = lull.Stopper(WIDTH, HEIGHT, model="paper", pass_spp=20)
        answers = {spp: own.observe(image, spp) for spp, image in pictures.items()}
        with tempfile.TemporaryDirectory() as folder:
            for spp, image in pictures.items():
                with open(f"{folder}/room7_{spp}.png", "wb") as file:
                    np.save(file, image)  # no PNG, so that the test needs no Pillow
            found = paper.pictures_in(folder)
            self.assertEqual([spp for spp, _ in found], list(pictures))  # 100 is after 80
            with unittest.mock.patch.object(paper, "read", np.load):
                with contextlib.redirect_stdout(io.StringIO()) as out:
                    stops = paper.thresholds_of(found)
        last = max(answers)
        self.assertEqual(stops.tolist(), [answers[last].spp[0, 0] if answers[last].stop else paper.CAP])
        lines = out.getvalue().splitlines()
        self.assertEqual(lines[0], "    20 spp: 0 of 1 blocks are clean")
        # Eight pictures 40 spp apart make the first window.
        self.assertEqual([int(line.split()[0]) for line in lines if "P(noise)" in line][:3], [300, 340, 380])
        self.assertIn(f"P(noise) {answers[300].probability[0, 0]:.2f}", lines[14])

    def test_example_has_the_papers_critical_error(self):
        self.assertEqual(paper.critical_error([1000, 1000], [1000, 900]), 0)
        self.assertAlmostEqual(paper.critical_error([1000], [800], grid=20), 5 / 500)
        self.assertAlmostEqual(paper.critical_error([1000], [1200]), 3 / 250)
        self.assertAlmostEqual(paper.critical_error([10000], [9000], margin=10, grid=20), 49 / 500)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "human.csv")
            path.write_text("room;20;40;\nattic;60;\n")
            self.assertEqual(paper.row_of(path, "attic"), [60])
            with self.assertRaisesRegex(SystemExit, "no row 'cellar'"):
                paper.row_of(path, "cellar")
            with self.assertRaisesRegex(SystemExit, "no PNG files"):
                paper.pictures_in(folder)
            pathlib.Path(folder, "room.png").touch()
            with self.assertRaisesRegex(SystemExit, "no number of samples"):
                paper.pictures_in(folder)

    def test_version(self):
        self.assertRegex(lull.__version__, r"^\d+\.\d+\.\d+$")


if __name__ == "__main__":
    unittest.main()
