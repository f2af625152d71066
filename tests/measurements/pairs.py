#!/usr/bin/env python3
"""Measures what one decision for both eyes of a pair costs: renders a pair, and each eye by itself. pairs.py OUT SCENE... > pairs.csv

Eyes of 160x160 pixels, 0.065 apart, that see the same at a distance of 5, in blocks of 40, --denoise, at most 2000 spp. CPU seconds are
of the whole program, with loading the scene. Images stay in OUT; those that are there are not rendered again."""
import csv
import pathlib
import sys

from measure import Renders

table = csv.writer(sys.stdout, lineterminator="\n")
table.writerow(["scene", "image", "million samples", "CPU seconds", "blocks at the cap"])
for scene in map(pathlib.Path, sys.argv[2:]):
    name = scene.stem if scene.stem != "scene" else scene.parent.name
    renders = Renders(pathlib.Path(sys.argv[1], name), scene, stereo="0.065,5", denoise=True, resolution="160x160", block=40,
                      max_spp=2000, threads=2)
    for image, eye in ("pair", {}), ("left", {"eye": "left"}), ("right", {"eye": "right"}):
        totals = renders.render(image, **eye)["totals"]
        table.writerow([name, image, f"{totals['samples'] / 1e6:.2f}", f"{renders.seconds[image]:.1f}", totals["blocksAtCap"]])
        sys.stdout.flush()
