#!/usr/bin/env python3
"""Renders small crops of scenes of this folder, and makes two pictures of the documents in scenes/pictures.

remedies.py LULL [-o FOLDER]: caution.png has one block of cornell by the default rule and by `denoised`, each with
several thresholds; remedies.jpg has pairs of noise and remedy. A crop that FOLDER (out/remedies) has is not rendered again.
Needs Pillow (Debian: python3-pil); about two minutes of CPU time.
"""
import argparse
import json
import pathlib
import subprocess

from crops import crop, sheet

SCENES = pathlib.Path(__file__).resolve().parent
CORNELL = ["cornell/scene.pbrt", "--resolution", "100x100"]
DARK = ["dark/scene.pbrt", "--resolution", "200x200", "--crop", "0,0.5,0.5,1", "--spp", "128"]
CAUSTIC = ["caustic/scene.pbrt", "--resolution", "200x200", "--crop", "0.5,1,0.5,1", "--spp", "64", "--sampler", "sobol"]
GLOSSY = ["glossy/scene.pbrt", "--resolution", "200x200", "--crop", "0.2,0.7,0.5,1"]
CAUTION = [
    {"ca05": ("--caution 0.5", CORNELL + ["--caution", "0.5"]),
     "ca1": ("--caution 1 (default)", CORNELL + ["--caution", "1"]),
     "ca2": ("--caution 2", CORNELL + ["--caution", "2"])},
    {"de6": ("--denoise, denoised:6", CORNELL + ["--denoise", "--stop", "denoised:6"]),
     "de31": ("--denoise (3.1)", CORNELL + ["--denoise", "--stop", "denoised:3.1"]),
     "de15": ("--denoise, denoised:1.5", CORNELL + ["--denoise", "--stop", "denoised:1.5"])},
]
REMEDIES = [
    {"cz_path": ("caustic, path", CAUSTIC),
     "dk_off": ("dark, path", DARK + ["--sampler", "sobol"]),
     "dn4": ("glossy, --denoise --spp 4", GLOSSY + ["--spp", "4", "--denoise"])},
    {"cz_bdpt": ("--integrator bdpt", CAUSTIC + ["--integrator", "bdpt"]),
     "dk_on": ("--denoise", DARK + ["--denoise"]),
     "dnstop": ("--denoise", GLOSSY + ["--denoise"])},
]


def render(lull, name, arguments, folder):
    """Renders a crop unless that has been done; returns its samples per pixel and CPU seconds."""
    report = folder / f"{name}.json"
    if not report.exists():
        subprocess.run([lull, "render", SCENES / arguments[0], *arguments[1:], "--threads", "1", "--quiet",
                        "-o", folder / f"{name}.exr", "--report", report], check=True, stdout=subprocess.DEVNULL)
    block, = json.loads(report.read_text())["blocks"]
    return block["spp"], block["seconds"]


def pictures(lull, rows, folder):
    """Returns the sheet of rows of crops, each crop with its title, samples and seconds above."""
    def labelled(name, title, arguments):
        spp, seconds = render(lull, name, arguments, folder)
        return [title, f"{spp:,} spp, {seconds:.1f} s"], crop(folder / f"{name}.png")
    return sheet([[labelled(name, *how) for name, how in row.items()] for row in rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lull")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=SCENES.parent / "out/remedies")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    pictures(options.lull, CAUTION, options.output).save(SCENES / "pictures/caution.png", optimize=True)
    pictures(options.lull, REMEDIES, options.output).save(SCENES / "pictures/remedies.jpg", quality=92)


if __name__ == "__main__":
    main()
