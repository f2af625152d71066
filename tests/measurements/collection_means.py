#!/usr/bin/python3
"""Renders the scenes of public collections with pbrt-v3 and lull, and prints the ratio of their means.

    tests/measurements/collection_means.py FOLDER --pbrt PBRT > tests/measurements/collection_means.csv

FOLDER has checkouts of the collections, by the names in tests/measurements/collections.csv (owner/name). Scenes that load
completely are rendered at 96 pixels on the longer side, by the integrator `path` (at most 5 bounces) where they have one
that lull does not have, with 64 random samples per pixel and one thread. Columns: ratio of the means of R, G and B, and its
standard error from the differences of pixels. A scene that takes a program over 40 s is left out.
"""

import argparse
import csv
import pathlib
import re
import subprocess
import tempfile

import numpy as np

from measure import lull, read, run

SIDE, SPP, SECONDS = 96, 64, 40
OTHER_INTEGRATORS = r'Integrator\s+"(whitted|directlighting|sppm|mlt|ao)"[^\n]*(\n[ \t]+"[^\n]*)*'


def small(text):
    """Returns the text of a scene with another size, sampler and, if need be, integrator."""
    size = [re.findall(rf'"integer {which}resolution"\s*\[?\s*(\d+)', text) for which in 'xy']
    width, height = (int(size[0][0]), int(size[1][0])) if all(size) else (640, 480)
    scale = SIDE / max(width, height)
    width, height = max(8, round(width * scale)), max(8, round(height * scale))
    if all(size):
        for which, n in ('x', width), ('y', height):
            text = re.sub(rf'("integer {which}resolution"\s*\[?\s*)\d+', rf'\g<1>{n}', text)
    else:
        text = re.sub(r'(Film\s+"image")', rf'\1 "integer xresolution" [{width}] "integer yresolution" [{height}]', text)
    text = re.sub(OTHER_INTEGRATORS, 'Integrator "path" "integer maxdepth" [5]', text)
    text = re.sub(r'^[ \t]*Sampler\s+"[^"]*"[^\n]*(\n[ \t]+"[^\n]*)*', '', text, flags=re.M)
    return text.replace('WorldBegin', f'Sampler "random" "integer pixelsamples" [{SPP}]\nWorldBegin', 1)


def compare(path, o, folder):
    """Returns ratios of means and their standard errors, R, G and B."""
    # In the folder of the original, as names of files are relative to the scene.
    scene = path.with_name('collection_means.pbrt')
    try:
        scene.write_text(small(path.read_text(errors='replace')))
        a, b = folder / 'pbrt.exr', folder / 'lull.exr'
        for command in ([o.pbrt, '--quiet', '--nthreads', '1', '--outfile', a, scene],
                        [lull.program.find(), 'render', scene, '--threads', '1', '--spp', str(SPP), '--seed', '3', '--quiet',
                         '-o', b]):
            run(*command, cwd=path.parent, timeout=SECONDS)
        theirs, ours = read(a), read(b)
        mean = np.maximum(theirs.mean((0, 1)), 1e-9)
        return ours.mean((0, 1)) / mean, np.sqrt(((theirs - ours) ** 2).mean((0, 1)) / theirs[..., 0].size) / mean
    finally:
        scene.unlink()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('folder', type=pathlib.Path)
    parser.add_argument('--pbrt', required=True)
    o = parser.parse_args()
    print('collection,file,R,G,B,standard error of R,of G,of B')
    with tempfile.TemporaryDirectory() as folder, open(pathlib.Path(__file__).with_name('collections.csv')) as f:
        for row in csv.DictReader(f):
            path = o.folder.resolve() / row['collection'] / row['file']
            if row['loaded'] != 'complete' or not path.exists():
                continue
            try:
                ratio, error = compare(path, o, pathlib.Path(folder))
                figures = ','.join(f'{v:.4f}' for v in (*ratio, *error))
            except (subprocess.SubprocessError, ValueError):
                figures = 'not compared,,,,,'
            print(f'{row["collection"]},{row["file"]},{figures}', flush=True)


if __name__ == '__main__':
    main()
