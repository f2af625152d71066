#!/usr/bin/python3
"""Renders pbrt-v3 scenes with several programs, and prints how long each takes to the same error.

    tests/measurements/against_pbrt.py OUT --lull "before=OLD/lull --sampler sobol" \\
        --lull "now=NEW/lull --sampler sobol" [--pbrt PBRT] SCENE.pbrt...

Every program renders each of --spp, with one thread; pbrt-v3 with its default sampler, halton.
The error is the mean square of what lightness (CIE 1976, 0 to 100) is off, against two references of
the last --lull without its options: the mean product of both differences, in which the references'
own noise has no part. Seconds are CPU times without loading, which is the constant of the line through
the renders. Two figures are printed for each program: samples per second, and the time to the error that
the first program has after as many spp as the middle of --spp, from a line through the logarithms, as a
ratio to the first. Images stay in the folder OUT; existing ones are not rendered again.
"""

import argparse
import pathlib
import re
import shlex
import sys

import numpy as np

from measure import Renders, lightness, read, run


class Scene(Renders):
    def __init__(self, path, o):
        path = pathlib.Path(path).resolve()
        super().__init__(pathlib.Path(o.out) / path.parent.name, path)
        self.o = o

    def lull(self, name, program, spp, *how):
        size = f'{self.o.side}x{self.o.side}'
        self.make(name, lambda: run(program, 'render', self.scene, '-o', self.file(name), '--resolution', size, '--spp',
                                    str(spp), '--threads', '1', '--quiet', *how))

    def pbrt(self, name, spp):
        """Renders the scene with another size and sampler, with links to the files it needs."""
        for other in self.scene.parent.iterdir():
            link = self.folder / other.name
            if other != self.scene and not link.is_symlink():
                link.symlink_to(other)
        text = re.sub(r'("integer [xy]resolution"\s*)(\[\s*\d+\s*\]|\d+)', rf'\g<1>[ {self.o.side} ]', self.scene.read_text())
        text, count = re.subn(r'Sampler\s+"\w+"(\s*"[^"]*"\s*(\[[^]]*\]|[\d.]+))*',
                              f'Sampler "halton" "integer pixelsamples" [ {spp} ]', text)
        if count != 1:
            sys.exit(f'{self.scene}: has {count} samplers, not one')
        scene = self.folder / f'{name}.pbrt'
        scene.write_text(text)
        self.make(name, lambda: run(self.o.pbrt, '--quiet', '--nthreads=1', '--outfile', self.file(name), scene))

    def render_all(self):
        o = self.o
        for seed in (101, 102):
            self.lull(f'reference-{seed}', o.lull[-1][1][0], o.reference, '--seed', str(seed), '--sampler', 'random')
        # Programs take turns, as the machine's speed changes with what others do.
        for spp in o.spp:
            for name, (program, *how) in o.lull:
                self.lull(f'{name}-{spp}', program, spp, *how)
            if o.pbrt:
                self.pbrt(f'pbrt-v3-{spp}', spp)

    def curve(self, program):
        """Returns samples per second, and seconds without loading and errors of the renders."""
        spp = np.array(self.o.spp)
        seconds = np.array([self.seconds[f'{program}-{n}'] for n in spp])
        slope, loading = np.polyfit(spp, seconds, 1, w=1 / np.sqrt(seconds))
        a, b = (lightness(read(self.file(f'reference-{seed}'))) for seed in (101, 102))
        images = [lightness(read(self.file(f'{program}-{n}'))) for n in spp]
        errors = np.array([((image - a) * (image - b)).mean() for image in images])
        return self.o.side ** 2 / slope, np.maximum(seconds - loading, spp * slope / 2), errors


def time_to(error, seconds, errors):
    """Returns the seconds after which a power law through the points has the error."""
    slope, constant = np.polyfit(np.log(errors), np.log(seconds), 1)
    return np.exp(constant + slope * np.log(error))


def print_table(scenes, programs, o):
    print('| scene | ' + ' | '.join([f'samples/s, {p}' for p in programs] + [f'time, {p}' for p in programs[1:]]) + ' |')
    print('|---' * (2 * len(programs)) + '|')
    ratios = []
    for s in scenes:
        curves = [s.curve(p) for p in programs]
        wanted = curves[0][2][len(o.spp) // 2]
        times = [time_to(wanted, seconds, errors) for _, seconds, errors in curves]
        ratios.append([c[0] / curves[0][0] for c in curves[1:]] + [t / times[0] for t in times[1:]])
        print(f'| {s.folder.name} | {curves[0][0] / 1000:.0f} k | ' + ' | '.join(f'{r:.2f}' for r in ratios[-1]) + ' |', flush=True)
    print('| geometric mean | | ' + ' | '.join(f'{m:.2f}' for m in np.exp(np.log(ratios).mean(0))) + ' |')


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('out', help='folder for images and measurements')
    parser.add_argument('scenes', nargs='+', help='pbrt-v3 scenes')
    parser.add_argument('--lull', action='append', required=True, metavar='NAME=PROGRAM [OPTION...]')
    parser.add_argument('--pbrt', help='the program of pbrt-v3')
    parser.add_argument('--side', type=int, default=64, help='of the images, in pixels (64)')
    parser.add_argument('--spp', default='16,64,256', help='samples per pixel (16,64,256)')
    parser.add_argument('--reference', type=int, default=2048, help='spp of each of two (2048)')
    o = parser.parse_args()
    o.spp = sorted(int(n) for n in o.spp.split(','))
    o.lull = [(name, shlex.split(program)) for name, program in (text.split('=', 1) for text in o.lull)]
    scenes = [Scene(path, o) for path in o.scenes]
    for scene in scenes:
        scene.render_all()
    print_table(scenes, [name for name, _ in o.lull] + ['pbrt-v3'] * bool(o.pbrt), o)


main()
