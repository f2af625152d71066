#!/usr/bin/env python3
"""Renders crops of two blocks that observers judged, of public scenes, and makes two pictures of the documents in scenes/pictures.

observed.py LULL SCENES [-o FOLDER]: SCENES has the folders staircase2 and pavilion of the data sets. stops.png has a block of
staircase2 by day, night-block.jpg one of pavilion by night as it is and three stops brighter. FOLDER (out/observed) keeps
checkpoints: a render that was ended goes on. Needs Pillow and oiiotool (Debian: python3-pil, openimageio-tools); about 15
minutes of CPU time.
"""
import argparse
import pathlib
import subprocess

from crops import crop, sheet

HERE = pathlib.Path(__file__).resolve().parent
STAIRS = ["staircase2/scene.pbrt", "--crop", "0.3125,0.4375,0.275,0.4"]  # a quarter of block 5
WALL = ["pavilion/night-view2.pbrt", "--substitute", "--crop", "0.75,0.9375,0.75,0.8875"]  # 150x110 pixels of block 15

# The stop is by a model trained without staircase2, the threshold the mean of the observers. In stopping/data:
#   lull train *.h5 --human human.csv --leave-out p3d_staircase2-view0_part6 --threads 1 -o out.h5
#   lull evaluate staircase2-view0.h5 --human human.csv --stop learned:out.h5 --blocks stops.csv
STAIRS_COUNTS = {20: "", 2380: "stop", 2886: "human threshold", 10000: "reference"}
WALL_COUNTS = {300: "the stop", 2333: "the human threshold"}


def render(options, name, scene, spp):
    """Renders as for the observers, on from fewer samples; returns the EXR, which has a PNG beside it."""
    image = options.output / f"{name}_{spp}.exr"
    if not image.exists():
        subprocess.run([options.lull, "render", options.scenes / scene[0], *scene[1:], "--resolution", "800x800",
                        "--estimator", "pbrt-v3", "--sampler", "random", "--spp", str(spp), "--threads", "1", "--quiet",
                        "--checkpoint", options.output / f"{name}.h5", "--keep-checkpoint", "--resume", "-o", image],
                       check=True, stdout=subprocess.DEVNULL)
    return image


def brightened(image):
    """Returns a PNG of the image, three stops brighter."""
    picture = image.with_suffix(".bright.png")
    subprocess.run(["oiiotool", image, "--ch", "R,G,B", "--fullpixels", "--mulc", "8", "--colorconvert", "linear", "sRGB",
                    "-d", "uint8", "-o", picture], check=True)
    return picture


def stairs(options):
    images = {spp: render(options, "stairs", STAIRS, spp) for spp in STAIRS_COUNTS}
    return sheet([[([f"{spp:,} spp", STAIRS_COUNTS[spp]], crop(image.with_suffix(".png")))
                   for spp, image in images.items()]])


def wall(options):
    images = {spp: render(options, "wall", WALL, spp) for spp in WALL_COUNTS}
    return sheet([[([f"{spp:,} spp: {WALL_COUNTS[spp]}", how], crop(picture(image)))
                   for spp, image in images.items()]
                  for how, picture in (("as observers saw it", lambda image: image.with_suffix(".png")),
                                       ("three stops brighter", brightened))])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lull")
    parser.add_argument("scenes", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=HERE.parent / "out/observed")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    stairs(options).save(HERE / "pictures/stops.png", optimize=True)
    wall(options).save(HERE / "pictures/night-block.jpg", quality=92)


if __name__ == "__main__":
    main()
