#!/usr/bin/env python3
"""The method of Buisine et al., Entropy 2021, 23(1), 75, on a folder of pictures.

    paper.py FOLDER [--model MODEL.h5] [--human H.csv --name NAME]

FOLDER has PNG files (which needs Pillow) of one scene at increasing samples per pixel; the last number in a
name is its spp: kitchen_20.png, kitchen_40.png, ... The result is a line of a thresholds file: the spp at which
each block stopped, row by row. With --human also the critical error, by human thresholds.

docs/paper.md has each step, the function behind it and its test. MODEL is "paper", lull's own small network, or a
file of `lull train --preset paper` or of Keras. It fixes k, n, the sub-blocks, H, H1 or H2, and snorm.
"""
import argparse
import pathlib

import lull
import numpy as np
from drive_renderer import by_spp, read

CAP = 10000  # spp of the picture that people compared with
PASS = 20  # spp between the published pictures


def pictures_in(folder):
    """Returns the pictures of a folder as (spp, path), by their spp."""
    files = list(pathlib.Path(folder).glob("*.png"))
    if not files:
        raise SystemExit(f"{folder}: has no PNG files")
    return by_spp(files)


def thresholds_of(pictures, model="paper", block=200):
    """Returns the spp at which each block stopped, CAP where it never did; `pictures` has (spp, path)."""
    # A rule that knows the pass looks at the first picture; otherwise at whole multiples of n.
    step = pictures[0][0]
    is_regular = all(spp == step * (i + 1) for i, (spp, _) in enumerate(pictures))
    stopper = None
    for spp, path in pictures:
        image = read(path)  # 8-bit sRGB, as people saw it
        if stopper is None:  # blocks of 200x200 pixels, each with a window and votes of its own
            height, width = image.shape[:2]
            stopper = lull.Stopper(width, height, model=model, block=block, pass_spp=step if is_regular else 0)
        # Entropies of the sub-blocks (Eq. 3), the window of k of them, its normalisation, the network's
        # probability of noise, and the vote: all of it in one call.
        answer = stopper.observe(image, spp)
        checked = answer.probability[answer.checked]
        text = f", P(noise) {checked.mean():.2f} on average" if checked.size else ""
        print(f"{spp:6} spp: {answer.stopped.sum()} of {answer.stopped.size} blocks are clean{text}")
        if answer.stop:
            break
    return np.where(answer.stopped, answer.spp, CAP).ravel()


def critical_error(human, stops, margin=2, grid=40):
    """The share of spp at which a stop is wrong (Table 3): `margin` % of the cap around human thresholds is free."""
    half = PASS * int(CAP / PASS * margin / 200)
    x = np.arange(PASS, CAP + 1, grid)
    shares = []
    for t, s in zip(human, stops):
        low, high = (CAP, CAP) if t >= CAP else (t - half, t + half)
        right = (x <= low) & (x <= s) | (x >= high) & (x >= s) | (low < x) & (x < high)
        shares.append(1 - right.mean())
    return float(np.mean(shares))


def row_of(path, name):
    """Returns the thresholds that a file `name;t0;t1;...` has for a viewpoint."""
    for line in pathlib.Path(path).read_text().splitlines():
        fields = line.split(";")
        if fields[0] == name:
            return [int(t) for t in fields[1:] if t]
    raise SystemExit(f"{path}: has no row '{name}'")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER")
    parser.add_argument("--model", default="paper")
    parser.add_argument("--human", metavar="H.csv")
    parser.add_argument("--name", help="the viewpoint in H.csv [the folder's name]")
    options = parser.parse_args()
    stops = thresholds_of(pictures_in(options.folder), options.model)
    name = options.name or pathlib.Path(options.folder).resolve().name
    print(name + ";" + "".join(f"{s};" for s in stops))
    if options.human:
        error = critical_error(row_of(options.human, name), stops)
        print(f"critical error at a margin of 2 %: {100 * error:.2f} %")


if __name__ == "__main__":
    main()
