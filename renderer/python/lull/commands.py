"""The commands render, compare and evaluate as functions."""
import contextlib
import csv
import dataclasses
import glob
import json
import os
import tempfile

import numpy as np

from . import exr, program

# What the layers of `--aov` are called here, where the EXR has other names.
_LAYERS = {"N": "normal", "Z": "depth", "P": "position", "objectID": "object",
           "materialID": "material"}


@dataclasses.dataclass(repr=False)
class Rendering:
    """A picture: arrays of height x width, or height x width x 3, with the upper row first."""
    image: np.ndarray  # linear
    spp: np.ndarray  # samples of each pixel
    noisy: np.ndarray | None  # with denoise: the means of the samples
    layers: dict  # those of `aov`, and with denoise `error`, by their names
    blocks: list  # what the report says of each block: dicts with x, y, width, height, spp, ...
    seconds: float
    interrupted: bool
    report: dict  # all of it

    def __repr__(self):
        height, width = self.spp.shape
        return "<lull.Rendering of %d x %d pixels: %d to %d spp, %.3g s%s>" % (
            width, height, self.spp.min(), self.spp.max(), self.seconds,
            ", interrupted" if self.interrupted else "")


@dataclasses.dataclass(repr=False)
class Comparison:
    """What `lull compare` finds: pictures by their names, and all figures."""
    images: dict
    figures: dict

    def __repr__(self):
        return "<lull.Comparison of %s>" % ", ".join(sorted(self.images))


def _stack(channels):
    """Returns arrays of pixels by the names of layers, "" for R, G and B."""
    layers = {}
    for name in sorted(channels, key=lambda n: "RGBXYZ".find(n[-1])):
        layer, _, component = name.rpartition(".")
        if not layer and component not in "RGB":
            layer = component
        layers.setdefault(layer, []).append(channels[name])
    return {_LAYERS.get(name, name): np.stack(planes, -1) if len(planes) > 1 else planes[0]
            for name, planes in layers.items()}


@contextlib.contextmanager
def _output(options, name):
    """Yields where to write, which is gone afterwards unless the user has said where."""
    with tempfile.TemporaryDirectory(prefix="lull-") as folder:
        options.setdefault("output", os.path.join(folder, name))
        yield folder


def render(scene, *, progress=None, **options):
    """Renders a scene until each block of the image has stopped. Returns a Rendering.

    Options are those of `lull render`. A KeyboardInterrupt ends it early, with what there is.
    `progress` is called with each event of --json-progress; False: shows nothing. Files stay only
    where `output` or `report` name them. Raises TypeError, ValueError or lull.Error."""
    with _output(options, "image.exr") as folder:
        options.setdefault("report", os.path.join(folder, "report.json"))
        last = program.run("render", [scene], options, progress)
        picture = os.path.splitext(os.fspath(options["output"]))[0] + ".exr"
        if last.get("event") != "end":  # before anything was rendered
            raise KeyboardInterrupt
        layers = _stack(exr.read(picture)[0])
        report = {}
        if os.fspath(options["report"]).endswith(".json"):
            with open(options["report"], encoding="utf-8") as f:
                report = json.load(f)
    return Rendering(image=layers.pop(""), spp=layers.pop("spp").astype(np.int32),
                     noisy=layers.pop("noisy", None), layers=layers,
                     blocks=report.get("blocks", []), seconds=last["seconds"],
                     interrupted=last["end"] == "interrupted", report=report)


def compare(scene=None, *, progress=None, **options):
    """Compares the images of a rule, of people and of the cap. Returns a Comparison. Options are
    those of `lull compare`."""
    with _output(options, "compare"):
        program.run("compare", [] if scene is None else [scene], options, progress)
        beginning = os.fspath(options["output"])
        with open(beginning + ".compare.json", encoding="utf-8") as f:
            figures = json.load(f)
        images = {path[len(beginning) + 1:-len(".exr")]: _stack(exr.read(path)[0])[""]
                  for path in glob.glob(glob.escape(beginning) + ".*.exr")}
    return Comparison(images, figures)


def evaluate(*recordings, **options):
    """Judges stopping rules by the thresholds of people. Returns the rows of its CSV file, as dicts
    with numbers where there are such. Options are those of `lull evaluate`."""
    with tempfile.TemporaryDirectory(prefix="lull-") as folder:
        options.setdefault("csv", os.path.join(folder, "rows.csv"))
        program.run("evaluate", recordings, options)
        with open(options["csv"], encoding="utf-8", newline="") as f:
            return [{key: _number(value) for key, value in row.items()} for row in csv.DictReader(f)]


def _number(text):
    try:
        return float(text)
    except ValueError:
        return text

