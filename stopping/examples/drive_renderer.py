#!/usr/bin/env python3
"""Stops another renderer where its picture has had enough samples.

    drive_renderer.py --pictures frame-*.png     watches pictures that are there
    drive_renderer.py                            drives a small renderer of its own

The first takes PNG files (needs Pillow) at any samples per pixel, which are the last number in their names
(frame-64.png, frame-90.png, ...), in any order.
The second shows the whole loop: samples are only taken in blocks that go on, the picture is shown, and
stopped blocks are not computed. Replace `sample()` by a call of your renderer.
"""
import argparse
import pathlib
import re

import lull
import numpy as np


def report(spp, answer):
    share = answer.stopped.mean()
    noisy = "" if answer.probability is None else f", noise seen in {(answer.probability >= 0.5).sum()}"
    print(f"{spp:6} spp: {share:4.0%} of {answer.stopped.size} blocks are clean{noisy}")


def by_spp(files):
    """Returns files as (spp, file), by the last number in their names: 9 before 20, and that before 100."""
    found = {}
    for file in files:
        numbers = re.findall(r"\d+", pathlib.Path(file).stem)
        if not numbers or int(numbers[-1]) == 0:
            raise SystemExit(f"{file}: has no number of samples in its name, such as frame-64.png")
        if (other := found.setdefault(int(numbers[-1]), file)) != file:
            raise SystemExit(f"{file} has as many samples as {other}, by their names")
    return sorted(found.items())


def read(file):
    from PIL import Image
    return np.asarray(Image.open(file).convert("RGB"))


def watch_pictures(files, **settings):
    """Returns the spp at which each block may stop, 0 where none of the pictures is good enough."""
    stopper = None
    for spp, file in by_spp(files):
        image = read(file)
        if stopper is None:
            stopper = lull.Stopper(image.shape[1], image.shape[0], **settings)
        answer = stopper.observe(image, spp)
        report(spp, answer)
        if answer.stop:
            break
    return np.where(answer.stopped, answer.spp, 0)


def sample(random, truth, noise, count):
    """The renderer: the sum of `count` samples of these pixels, which scatter around the truth."""
    return count * truth + np.sqrt(count) * noise * random.standard_normal(truth.shape)


def drive(width=400, height=300, step=40, cap=10000, **settings):
    """Renders a picture whose noise grows from left to right; returns it, and the spp of each block."""
    y, x = np.mgrid[0:height, 0:width] / max(width, height)
    truth = np.stack([0.25 + 0.2 * x, 0.3 + 0.1 * y, 0.35 - 0.1 * x], axis=-1)
    noise = (0.05 + 0.6 * x)[..., None]
    random = np.random.default_rng(1)
    stopper = lull.Stopper(width, height, block=100, **settings)
    total, spp = np.zeros(truth.shape), 0
    samples = np.zeros((height, width, 1), int)
    while not stopper.done and spp < cap:
        spp += step
        active = stopper.active
        total[active] += sample(random, truth[active], noise[active], step)
        samples[active] += step
        answer = stopper.observe(total / samples, spp)  # linear; 1 is white
        report(spp, answer)
    print(f"{1 - samples.mean() / spp:.0%} of the samples saved against {spp} everywhere")
    return total / samples, answer.spp


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pictures", nargs="+", metavar="P.png")
    parser.add_argument("--model", help="entropy (default), noise, paper or a file")
    options = parser.parse_args()
    if options.pictures:
        print(watch_pictures(options.pictures, model=options.model))
    else:
        print(drive(model=options.model)[1])


if __name__ == "__main__":
    main()
