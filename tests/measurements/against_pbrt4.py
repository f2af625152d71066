#!/usr/bin/python3
"""Compares lull with pbrt-v4: means of images, and speed.

    tests/measurements/against_pbrt4.py OUT PBRT SCENE.pbrt... > pbrt4.csv
    tests/measurements/against_pbrt4.py OUT PBRT SCENE.pbrt... --blocks 4 --side 48 --spp 64 --runs 8 > tests/plugins/pbrt4.csv

PBRT is the program of pbrt-v4. Both programs render one copy of each scene, in squares of --side pixels, with one thread, pbrt-v4
with independent samples: --runs times --spp, and once 1 spp, whose CPU time is taken off. Errors are standard errors of the
ratio of means, from what runs differ in 8x8 blocks. --blocks N tabulates N x N blocks of pbrt-v4 alone: their means, and the
variances of these.
Images stay in the folder OUT; those that are there are not rendered again.
"""
import argparse
import csv
import os
import pathlib
import re
import sys

import numpy as np

from measure import Renders, read, run

COLUMNS = ['scene', 'million samples', 'lull R', 'lull G', 'lull B', 'pbrt-v4 R', 'pbrt-v4 G', 'pbrt-v4 B', 'ratio R', 'ratio G', 'ratio B',
           'standard error', 'lull, samples per CPU s', 'pbrt-v4, samples per CPU s', 'speed, lull / pbrt-v4', 'warnings of lull']


class Scene(Renders):
    """The scene's folder is copied as links, as pbrt-v4 looks for files beside the scene."""

    def __init__(self, path, o):
        path = pathlib.Path(path).resolve()
        shared = next((p for p in path.parents if p.name == 'pbrt4-scenes'), path.parent)
        inside = path.relative_to(shared if shared.name == 'pbrt4-scenes' else shared.parent)
        self.name = str(inside.with_suffix('')).removesuffix('/scene')
        root = pathlib.Path(o.out).absolute()
        base = root / shared.name / path.parent.relative_to(shared)
        self.copy(shared.parent / 'pbrt-scenes', root / 'pbrt-scenes')
        self.copy(path.parent, base)
        text = path.read_text()
        text = re.sub(r'("integer [xy]resolution"\s*)(\[\s*\d+\s*\]|\d+)', rf'\g<1>[ {o.side} ]', text)
        text = re.sub(r'^\s*Sampler\s+"\w+"(\s*"[^"]*"\s*(\[[^]]*\]|[\d.]+))*', '', text, flags=re.MULTILINE)
        scene = base / f'{path.stem}.{o.side}.pbrt'
        scene.write_text('Sampler "independent"\n' + text)
        super().__init__(root / 'images' / self.name, scene)
        self.o = o

    @staticmethod
    def copy(source, target):
        if target.exists():
            return
        for folder, _, files in os.walk(source):
            to = target / pathlib.Path(folder).relative_to(source)
            to.mkdir(parents=True, exist_ok=True)
            for file in files:
                (to / file).symlink_to(pathlib.Path(folder, file))

    def render_all(self, *programs):
        for program in programs:
            for seed in range(self.o.runs + 1):
                name, spp = f'{program}-{seed}', 1 if seed == 0 else self.o.spp
                if program == 'lull':
                    self.render(name, spp=spp, seed=seed, threads=1)
                else:
                    self.make(name, lambda: run(self.o.pbrt, '--quiet', '--nthreads', '1', '--seed', str(seed), '--spp', str(spp),
                                                '--outfile', self.file(name), self.scene))

    def blocks(self, program, across):
        """Returns the means of across x across blocks, and the variances of these, for R, G and B."""
        images = [read(self.file(f'{program}-{seed}')) for seed in range(1, self.o.runs + 1)]
        means = np.array([[block.mean((0, 1)) for row in np.array_split(image, across) for block in np.array_split(row, across, 1)]
                          for image in images])
        return means.mean(0), means.var(0, ddof=1) / self.o.runs

    def moments(self, program):
        """Returns the mean of the image, and its variance."""
        means, variances = self.blocks(program, 8)
        return means.mean(0), variances.sum(0) / len(variances) ** 2

    def speed(self, program):
        seconds = np.mean([self.seconds[f'{program}-{seed}'] for seed in range(1, self.o.runs + 1)]) - self.seconds[f'{program}-0']
        return self.o.side ** 2 * (self.o.spp - 1) / seconds

    def row(self):
        (ours, our_variance), (theirs, their_variance) = self.moments('lull'), self.moments('pbrt')
        error = np.sqrt(our_variance / ours ** 2 + their_variance / theirs ** 2).max()
        speeds = self.speed('lull'), self.speed('pbrt')
        warnings = len(self.render('lull-0').get('warnings', []))
        samples = self.o.side ** 2 * self.o.spp * self.o.runs / 1e6
        return [self.name, f'{samples:.2f}', *(f'{v:.4f}' for v in (*ours, *theirs, *ours / theirs, error)),
                *(f'{v:.3g}' for v in speeds), f'{speeds[0] / speeds[1]:.2f}', warnings]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('out', help='folder for images and measurements')
    parser.add_argument('pbrt', help='the program of pbrt-v4')
    parser.add_argument('scenes', nargs='+', help='its scenes')
    parser.add_argument('--side', type=int, default=128, help='of the images, in pixels (128)')
    parser.add_argument('--spp', type=int, default=50, help='samples per pixel of a run (50)')
    parser.add_argument('--runs', type=int, default=4, help='of each program, with different seeds (4)')
    parser.add_argument('--blocks', type=int, metavar='N', help='tabulate N x N blocks of pbrt-v4 alone')
    o = parser.parse_args()
    table = csv.writer(sys.stdout, lineterminator='\n')
    table.writerow(['scene', 'block', *(of + c for of in ('', 'variance ') for c in 'RGB')] if o.blocks else COLUMNS)
    for path in o.scenes:
        scene = Scene(path, o)
        if o.blocks:
            scene.render_all('pbrt')
            for i, values in enumerate(np.hstack(scene.blocks('pbrt', o.blocks))):
                table.writerow([scene.name, i, *(f'{v:.5g}' for v in values)])
        else:
            scene.render_all('lull', 'pbrt')
            table.writerow(scene.row())
        sys.stdout.flush()


main()
