#!/usr/bin/python3
"""Renders glTF files with lull and with Cycles, and prints the ratios of their means.

    apt-get install blender
    tests/side_by_side/side_by_side.py OUT MODEL.glb...

Both render the same file: same camera, light, bounces and filter, without denoising, clamping, thresholds of
light or a limit of caustics. Images stay in the folder OUT; existing ones are not rendered again. Not part
of CI. Requirements: those of measure.py.
"""

import argparse
import json
import pathlib
import subprocess
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / 'measurements'))
from measure import Renders, read  # noqa: E402

SEEDS = (11, 12)


def render_by_cycles(renders, o):
    """Renders in one Blender: as glTF's specification has surfaces, and as Blender imports them."""
    width, height = map(int, o.size.split('x'))
    runs = [(f'cycles-{seed}', seed, 'specification') for seed in SEEDS] + [('imported', 2, 'imported')]
    runs = [dict(name=name, spp=o.spp, seed=seed, materials=materials) for name, seed, materials in runs
            if not renders.file(name).exists()]
    if not runs:
        return
    options = {'model': str(renders.scene), 'width': width, 'height': height, 'bounces': o.bounces,
               'frame': o.frame, 'shutter': o.shutter, 'folder': str(renders.folder), 'runs': runs}
    done = subprocess.run(['blender', '-b', '-noaudio', '-t', '2', '--python-exit-code', '1', '--python',
                           HERE / 'in_blender.py', '--', json.dumps(options)], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stdout[-3000:] + done.stderr)


def print_row(path, o):
    path = pathlib.Path(path).resolve()
    renders = Renders(pathlib.Path(o.out) / path.stem, path, resolution=o.size, spp=o.spp, threads=2, max_depth=o.bounces + 1,
                      frame=o.frame, shutter=None if o.frame is None else o.shutter)
    for seed in SEEDS:
        renders.render(f'lull-{seed}', seed=seed)
    render_by_cycles(renders, o)
    combined = 'ViewLayer.Combined.'
    lull, cycles = ([read(renders.file(f'{program}-{seed}'), layer) for seed in SEEDS]
                    for program, layer in (('lull', ''), ('cycles', combined)))
    mean = np.mean(lull)
    # Of independent pixels whose values the two images of a program show to scatter so much.
    error = np.hypot(*(((a - b).mean(2) / 2).std() for a, b in (lull, cycles))) / lull[0][..., 0].size ** 0.5
    figures = (*(np.mean(cycles, (0, 1, 2)) / np.mean(lull, (0, 1, 2))), error / mean)
    imported = read(renders.file('imported'), combined).mean() / mean
    print(f'| {path.stem} | ' + ' | '.join(f'{v:.4f}' for v in figures) + f' | {imported:.3f} |', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('out', help='folder for images')
    parser.add_argument('scenes', nargs='+', help='.glb models')
    parser.add_argument('--size', default='160x160', help='of the images (160x160)')
    parser.add_argument('--spp', type=int, default=1024, help='of each of two images of a program (1024)')
    parser.add_argument('--bounces', type=int, default=12)
    parser.add_argument('--frame', type=float, help='seconds of the animation (as the file stands)')
    parser.add_argument('--shutter', type=float, default=0, help='seconds that it is open (0)')
    o = parser.parse_args()
    print('Means, Cycles / lull:\n')
    print('| scene | R | G | B | standard error | as imported |\n|---|---|---|---|---|---|')
    for path in o.scenes:
        print_row(path, o)


main()
