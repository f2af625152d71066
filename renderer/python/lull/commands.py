"""The commands render, compare, evaluate and entropy as functions."""
import contextlib
import csv
import dataclasses
import glob
import json
import os
import tempfile

import numpy as np

from . import exr, program

# Names of `--aov` layers that differ from those in the EXR.
_LAYERS = {"N": "normal", "Z": "depth", "P": "position", "objectID": "object",
           "materialID": "material"}


@dataclasses.dataclass(repr=False)
class Rendering:
    """An image: arrays of height x width, or height x width x 3, with the upper row first."""
    image: np.ndarray  # linear
    spp: np.ndarray  # samples of each pixel
    noisy: np.ndarray | None  # with denoise: the means of the samples
    layers: dict  # those of `aov`, and with denoise `error`, by their names
    blocks: list  # dicts of the report, one per block: x, y, width, height, spp, ...
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
    """Results of `lull compare`: images by their names, and all figures."""
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
    """Renders a scene until each block of the image has stopped.

    A KeyboardInterrupt ends it early, with the current image.

    Args:
        scene: a file of pbrt or glTF.
        progress: a function that is called with each event of --json-progress; None: a line in a
            terminal or a notebook; False: nothing.
        **options: those of `lull render`, with _ for -: resolution=(400, 300), denoise=True. Files
            stay only where `output` or `report` name them.

    Returns:
        A Rendering.

    Raises:
        TypeError: for an option that the command does not have.
        ValueError: for a value that an option does not take.
        lull.Error: for a scene or a file that is at fault.
        FileNotFoundError: if the program lull is not found.
    """
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
    """Compares the images of a rule, at human thresholds and at the maximum sample count.

    Args:
        scene: a file of pbrt or glTF; None: images=FOLDER names images of another renderer,
            or automatic=, human= and reference= images that were rendered before.
        progress: as for render().
        **options: those of `lull compare`, with _ for -.

    Returns:
        A Comparison, whose images are those that were written as OpenEXR.

    Raises:
        TypeError, ValueError, lull.Error, FileNotFoundError: as render().
    """
    with _output(options, "compare"):
        program.run("compare", [] if scene is None else [scene], options, progress)
        beginning = os.fspath(options["output"])
        with open(beginning + ".compare.json", encoding="utf-8") as f:
            figures = json.load(f)
        images = {path[len(beginning) + 1:-len(".exr")]: _stack(exr.read(path)[0])[""]
                  for path in glob.glob(glob.escape(beginning) + ".*.exr")}
    return Comparison(images, figures)


def evaluate(*recordings, **options):
    """Evaluates stopping rules by human thresholds.

    Args:
        *recordings: data sets, each by itself or all in a list.
        **options: those of `lull evaluate`, with _ for -: human="human.csv", stop=["learned"],
            images="images/kitchen".

    Returns:
        The rows of its CSV file: dicts, with numbers where there are such.

    Raises:
        TypeError, ValueError, lull.Error, FileNotFoundError: as render().
    """
    return _rows("evaluate", recordings, options)


def entropy(*images, **options):
    """Computes the SVD-entropies of images, of their blocks and sub-blocks.

    Args:
        *images: image files, each by itself or all in a list.
        **options: options of `lull entropy`, with _ for -: images="images/kitchen", block=200,
            sub_blocks=100, values=True, attributes=True.

    Returns:
        The rows of its CSV file, for each image in the order of the samples per pixel: dicts
        with spp, block (empty: the image), h, h1, h2, mean_h, ...

    Raises:
        TypeError, ValueError, lull.Error, FileNotFoundError: as render().
    """
    return _rows("entropy", images, options)


def _rows(command, inputs, options):
    """Runs a command that writes a CSV file on inputs, and returns the rows."""
    with tempfile.TemporaryDirectory(prefix="lull-") as folder:
        options.setdefault("csv", os.path.join(folder, "rows.csv"))
        program.run(command, _flat(inputs), options)
        with open(options["csv"], encoding="utf-8", newline="") as f:
            return [{key: _number(value) for key, value in row.items()} for row in csv.DictReader(f)]


def _flat(inputs):
    """Returns files that are given one by one or in lists."""
    for one in inputs:
        if isinstance(one, (list, tuple)):
            yield from one
        else:
            yield one


def _number(text):
    try:
        return float(text)
    except ValueError:
        return text

