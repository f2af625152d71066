#!/usr/bin/env python3
"""Tests of the denoiser of the Python module: python_test.py FOLDER, where the module is."""
import sys
import unittest

import numpy as np

sys.path.insert(0, sys.argv.pop(1))
import lull  # noqa: E402

WIDTH, HEIGHT = 90, 52


def pictures(noise=0.08):
    """Returns a picture, two noisy halves of it, and its albedo."""
    random = np.random.default_rng(1)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    albedo = np.where((x // 15 + y // 15) % 2, 0.8, 0.3)[..., None] * np.ones(3)
    truth = albedo * (0.3 + 0.003 * x[..., None])
    halves = [np.float32(np.maximum(0, truth + noise * random.standard_normal(truth.shape))) for _ in "ab"]
    return truth, *halves, np.float32(albedo)


def rms(a, b):
    return np.sqrt(np.mean((a - b) ** 2))


class DenoisingTest(unittest.TestCase):
    def test_takes_noise_out(self):
        truth, a, b, albedo = pictures()
        clean = lull.denoise(a, b, albedo=albedo, block=40)
        self.assertEqual(clean.image.shape, truth.shape)
        self.assertEqual(clean.image.dtype, np.float32)
        self.assertLess(rms(clean.image, truth), rms((a + b) / 2, truth) / 4)
        self.assertEqual(clean.error.shape, (HEIGHT, WIDTH))
        self.assertEqual(clean.blocks, [(0, 0, 40, 52), (40, 0, 50, 52)])
        self.assertEqual(clean.upper.shape, (1, 2))
        self.assertTrue((clean.upper >= clean.estimate).all())
        less = lull.denoise(*pictures(0.02)[1:3], albedo=albedo, block=40)
        self.assertTrue((less.upper < clean.upper).all())

    def test_reads_any_layout(self):
        _, a, b, albedo = pictures()
        depth = np.ones((HEIGHT, WIDTH), np.float32)
        plain = lull.denoise(a, b, albedo=albedo, depth=depth).image
        alpha = np.ones((HEIGHT, WIDTH, 1), np.float32)
        other = lull.denoise(np.concatenate([a, alpha], axis=2), b[::-1].copy()[::-1],
                                       albedo=(albedo, np.float64(albedo)), depth=[depth[..., None], depth])
        np.testing.assert_array_equal(other.image, plain)

    def test_says_what_it_is_and_what_counts_as_black(self):
        _, a, b, _ = pictures()
        a[1, 2, 0] = np.nan
        with self.assertWarnsRegex(UserWarning, "a or b has values that are not finite"):
            clean = lull.denoise(a, b)
        for message, factor in ("mostly above 1", 5), ("negative", np.where(np.arange(WIDTH) % 5, 1, -1)[None, :, None]):
            with self.assertWarnsRegex(UserWarning, "a or b .*" + message):
                lull.denoise(np.float32(factor * np.nan_to_num(a)), np.float32(factor * b))
        self.assertRegex(repr(clean), r"^<lull.Denoised of 90 x 52 pixels: visible difference [\d.]+ in")

    def test_says_what_is_wrong(self):
        _, a, b, albedo = pictures()
        for message, call in (
                ("90 x 3", lambda: lull.denoise(a, b[:50])),
                ("normal", lambda: lull.denoise(a, b, normal=albedo[..., :2])),
                ("pair", lambda: lull.denoise(a, b, albedo=[albedo])),
                ("uint8", lambda: lull.denoise(np.uint8(a), b)),
                ("H x W x 3", lambda: lull.denoise(a[0], b)),
                ("the same colours", lambda: lull.denoise(a, a)),
                ("the same colours", lambda: lull.denoise(a, a.copy())),
                ("brighter than 4 times", lambda: lull.denoise(255 * a, 255 * b)),
                ("not finite", lambda: lull.denoise(a, np.nan * b)),
                ("negative", lambda: lull.denoise(-a, b)),
                ("39 pixels", lambda: lull.denoise(a, b, block=39))):
            with self.assertRaisesRegex(ValueError, message):
                call()


unittest.main()
