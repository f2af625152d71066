#!/usr/bin/env python3
"""Renders a scene by three rules: how large is the error, after how many seconds, and where did the samples
go? A notebook, cell by cell (`# %%`), and a script:

    three_rules.py scenes/cornell/scene.pbrt --resolution 300x300 [--plots FOLDER]      # needs matplotlib
"""
# %% Scene and rules
import argparse
import pathlib

import numpy as np

import lull

parser = argparse.ArgumentParser(description=__doc__,
                                 formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("scene")
parser.add_argument("--resolution", default="300x300")
parser.add_argument("--max-spp", type=int, default=2000)
parser.add_argument("--block", type=int, default=100)
parser.add_argument("--plots", type=pathlib.Path, help="folder for error.png and spp.png")
o = parser.parse_args()
size = dict(resolution=o.resolution, block=o.block, max_spp=o.max_spp)

# %% Render: the truth, with other samples and twice as many, and a picture by each rule
truth = lull.render(o.scene, **dict(size, max_spp=2 * o.max_spp), stop=f"fixed:{2 * o.max_spp}", seed=1).image
rules = {"learned": dict(stop="learned"), "lnoise:0.5": dict(stop="lnoise:0.5"),
         "denoised": dict(denoise=True)}
pictures = {name: lull.render(o.scene, **size, **rule) for name, rule in rules.items()}


# %% The error in lightness, 0 to 100, as people see it
def lightness(image):
    y = np.clip(image @ [0.2126, 0.7152, 0.0722], 0, 1)
    return np.where(y > 0.008856, 116 * np.cbrt(y) - 16, 903.3 * y)


def error(image):
    return np.sqrt(np.mean((lightness(image) - lightness(truth)) ** 2))


print("rule         mean spp  seconds  error")
for name, picture in pictures.items():
    print(f"{name:12} {picture.spp.mean():8.0f} {picture.seconds:8.1f} {error(picture.image):6.2f}")

# %% Error against seconds, and the samples of each block
if o.plots:
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots()
    for name, picture in pictures.items():
        axes.plot(picture.seconds, error(picture.image), "o", label=name)
    axes.set(xlabel="seconds", ylabel="RMSE of lightness")
    axes.set_xlim(left=0)
    axes.set_ylim(bottom=0)
    axes.legend()
    figure.savefig(o.plots / "error.png")

    figure, axes = plt.subplots(2, len(pictures), figsize=(3 * len(pictures), 6))
    for (name, picture), (above, below) in zip(pictures.items(), axes.T):
        above.imshow(np.clip(picture.image, 0, 1) ** (1 / 2.2))
        above.set_title(name)
        figure.colorbar(below.imshow(picture.spp, vmin=0, vmax=o.max_spp), ax=below, label="spp")
    figure.tight_layout()
    figure.savefig(o.plots / "spp.png")
