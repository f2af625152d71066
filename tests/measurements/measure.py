"""Renders that are kept in a folder, their CPU times, and their errors: what the measuring scripts share.

They need NumPy, and lull's Python package: the one that the preset `release` builds, or one on PYTHONPATH.
$LULL_PROGRAM is another program. OpenEXR files that lull does not read need OpenImageIO (python3-openimageio).
"""
import json
import pathlib
import resource
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / 'build/release/lib/python3/dist-packages'))
import lull  # noqa: E402
from lull import exr  # noqa: E402

WEIGHTS = np.array([0.212671, 0.715160, 0.072169])  # of linear R, G and B in the luminance


def read(path, layer='', components='RGB'):
    """Returns channels of an OpenEXR file as height x width x components."""
    try:
        channels = exr.read(path)[0]
    except ValueError:
        import OpenImageIO as oiio
        image = oiio.ImageBuf(str(path))
        channels = dict(zip(image.spec().channelnames, np.moveaxis(image.get_pixels(oiio.FLOAT), 2, 0)))
    return np.stack([channels[layer + c] for c in components], 2).astype(np.float64)


def lightness(rgb):
    """Returns CIE 1976 lightness, 0 to 100, of linear RGB on a display."""
    y = np.clip(rgb, 0, 1) @ WEIGHTS
    return 116 * np.where(y > 0.008856, np.cbrt(y), 7.787 * y + 16 / 116) - 16


def run(*command, **how):
    """Runs a program without its output."""
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **how)


def visible_differences(program, viewing, pictures, *how):
    """Returns the visible differences of pictures from the first, by the target `visible_difference`.

    `how` is the side of its blocks, or 'without' for differences without the worst pixels.
    """
    height, width, _ = pictures[0].shape
    words = [*how, viewing, width, height] if 'without' in how else [viewing, width, height, *how]
    out = subprocess.run([program, *map(str, words)], input=np.stack(pictures).astype(np.float32).tobytes(),
                         stdout=subprocess.PIPE, check=True).stdout.decode()
    return [float(line.split()[0]) for line in out.splitlines()]


class Renders:
    """Pictures of a scene in a folder, NAME.exr. Those that are there are not rendered again."""

    def __init__(self, folder, scene, **options):
        """`options` are those of lull.render() for all pictures."""
        self.folder, self.scene, self.options = pathlib.Path(folder).absolute(), scene, options
        self.folder.mkdir(parents=True, exist_ok=True)
        self.times = self.folder / 'seconds.json'
        self.seconds = json.loads(self.times.read_text()) if self.times.exists() else {}  # CPU time by name

    @classmethod
    def parse(cls, text, folder, **options):
        """Reads NAME=SCENE.pbrt[@X0,X1,Y0,Y1], of which NAME is a folder, and the numbers are a crop."""
        name, _, rest = text.partition('=')
        scene, _, crop = rest.partition('@')
        return cls(pathlib.Path(folder) / name, scene, crop=crop or None, **options)

    def file(self, name):
        return self.folder / f'{name}.exr'

    def make(self, name, render):
        """Calls a function that renders by other processes, unless that has been done."""
        def used():
            children = resource.getrusage(resource.RUSAGE_CHILDREN)
            return children.ru_utime + children.ru_stime
        if name not in self.seconds:
            before = used()
            render()
            self.seconds[name] = used() - before
            self.times.write_text(json.dumps(self.seconds, indent=1))

    def render(self, name, **options):
        """Renders by lull, and returns the report."""
        lull.program.options('render')  # read before the time is taken
        report = self.folder / f'{name}.json'
        self.make(name, lambda: lull.render(self.scene, output=self.file(name), report=report, progress=False,
                                            **{**self.options, **options}))
        return json.loads(report.read_text())

    def compare(self, name, truth='truth'):
        """Returns the figures of `lull compare`."""
        images = lull.compare(reference=self.file(truth), automatic=self.file(name), progress=False).figures['images']
        return next(image for image in images if image['name'] == 'automatic')['figures']
