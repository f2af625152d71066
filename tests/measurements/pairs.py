#!/usr/bin/env python3
"""Measures what one decision for both eyes of a pair costs: renders a pair, and each eye by itself. pairs.py LULL SCENE... > pairs.csv

Eyes of 160x160 pixels, 0.065 apart, that see the same at a distance of 5, in blocks of 40, --denoise, at most 2000 spp. CPU seconds are
of the whole program, with loading the scene."""
import csv
import json
import pathlib
import resource
import subprocess
import sys
import tempfile

OPTIONS = ["--stereo", "0.065,5", "--denoise", "--resolution", "160x160", "--block", "40", "--cap", "2000", "--threads", "2", "--quiet"]


def measure(lull, scene, *eye):
    """Returns millions of samples, CPU seconds and the blocks at the cap."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder, "report.json")
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([lull, "render", scene, *OPTIONS, *eye, "-o", f"{folder}/a.exr", "--report", report], check=True,
                       stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        totals = json.loads(report.read_text(encoding="utf-8"))["totals"]
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return totals["samples"] / 1e6, seconds, totals["blocksAtCap"]


def main():
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(["scene", "image", "million samples", "CPU seconds", "blocks at the cap"])
    for scene in sys.argv[2:]:
        path = pathlib.Path(scene)
        name = path.stem if path.stem != "scene" else path.parent.name
        for image, *eye in ("pair",), ("left", "--eye", "left"), ("right", "--eye", "right"):
            samples, seconds, capped = measure(sys.argv[1], scene, *eye)
            table.writerow([name, image, f"{samples:.2f}", f"{seconds:.1f}", capped])
            sys.stdout.flush()


if __name__ == "__main__":
    main()
