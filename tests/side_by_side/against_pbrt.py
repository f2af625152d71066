#!/usr/bin/python3
"""Renders pbrt-v3 scenes with several programs, and says how long each takes to the same error.

    apt-get install python3-numpy python3-openimageio
    tests/side_by_side/against_pbrt.py OUT --lull "before=OLD/lull --sampler sobol" \\
        --lull "now=NEW/lull --sampler sobol" [--pbrt PBRT] SCENE.pbrt...

Every program renders each of --spp, with one thread; pbrt-v3 with its default sampler, halton.
The error is the mean square of what lightness (CIE 1976, 0 to 100) is off, against two references of
the last --lull without its options: the mean product of both differences, in which the references'
own noise has no part. Seconds are those of processors, without loading, which is what the line
through the renders says of none. Two figures are printed for each program: samples a second, and the
time to the error that the first program has after as many spp as the middle of --spp, from a line
through the logarithms, as a ratio to the first. Images and measurements stay in the folder OUT; what
is there already is not rendered again. Not part of CI.
"""

import argparse
import os
import re
import shlex
import sys

import numpy as np

from pictures import lightness, read
from seconds import Seconds


class Scene:
    """One scene: for each render its CPU time."""

    def __init__(self, path, o):
        self.path, self.o = os.path.abspath(path), o
        self.name = os.path.basename(os.path.dirname(self.path))
        self.folder = os.path.join(os.path.abspath(o.out), self.name)
        os.makedirs(self.folder, exist_ok=True)
        self.seconds = Seconds(os.path.join(self.folder, 'seconds.json'))

    def file(self, name):
        return os.path.join(self.folder, name + '.exr')

    def lull(self, name, program, spp, *how):
        size = '%dx%d' % (self.o.side, self.o.side)
        self.seconds.run(name, [*program, 'render', self.path, '-o', self.file(name),
                                '--resolution', size, '--spp', str(spp), '--threads', '1',
                                '--quiet', *how])

    def pbrt(self, name, spp):
        """Renders the scene with another size and sampler, beside links to the files it needs."""
        for other in os.listdir(os.path.dirname(self.path)):
            link = os.path.join(self.folder, other)
            if other != os.path.basename(self.path) and not os.path.lexists(link):
                os.symlink(os.path.join(os.path.dirname(self.path), other), link)
        text = open(self.path).read()
        for which in 'xy':
            text = re.sub(r'("integer %sresolution"\s*)(\[\s*\d+\s*\]|\d+)' % which,
                          r'\g<1>[ %d ]' % self.o.side, text)
        sampler = 'Sampler "halton" "integer pixelsamples" [ %d ]' % spp
        text, count = re.subn(r'Sampler\s+"\w+"(\s*"[^"]*"\s*(\[[^]]*\]|[\d.]+))*', sampler, text)
        if count != 1:
            sys.exit(self.path + ': has %d samplers, not one' % count)
        scene = os.path.join(self.folder, name + '.pbrt')
        with open(scene, 'w') as f:
            f.write(text)
        self.seconds.run(name, [self.o.pbrt, '--quiet', '--nthreads=1', '--outfile',
                                self.file(name), scene])

    def render(self):
        o = self.o
        for seed in (101, 102):
            self.lull('reference-%d' % seed, o.lull[-1][1][:1], o.reference, '--seed', str(seed),
                      '--sampler', 'random')
        # Programs take turns, as the machine's speed changes with what others do.
        for spp in o.spp:
            for name, program in o.lull:
                self.lull('%s-%d' % (name, spp), program[:1], spp, *program[1:])
            if o.pbrt:
                self.pbrt('pbrt-v3-%d' % spp, spp)

    def error(self, name):
        """Returns the mean squared error of lightness."""
        image = lightness(read(self.file(name))[0])
        a, b = (lightness(read(self.file('reference-%d' % seed))[0]) for seed in (101, 102))
        return ((image - a) * (image - b)).mean()

    def curve(self, program):
        """Returns samples a second, and seconds without loading and errors of the renders."""
        spp = np.array(self.o.spp)
        seconds = np.array([self.seconds['%s-%d' % (program, n)] for n in spp])
        slope, loading = np.polyfit(spp, seconds, 1, w=1 / np.sqrt(seconds))
        errors = np.array([self.error('%s-%d' % (program, n)) for n in spp])
        return self.o.side ** 2 / slope, np.maximum(seconds - loading, spp * slope / 2), errors


def time_to(error, seconds, errors):
    """Returns the seconds after which a power law through the points has the error."""
    slope, constant = np.polyfit(np.log(errors), np.log(seconds), 1)
    return np.exp(constant + slope * np.log(error))


def print_table(scenes, programs, o):
    print('| scene | ' + ' | '.join('samples/s, %s' % p for p in programs) + ' | ' +
          ' | '.join('time, %s' % p for p in programs[1:]) + ' |')
    print('|---' * (2 * len(programs)) + '|')
    ratios = []
    for s in scenes:
        curves = [s.curve(p) for p in programs]
        wanted = curves[0][2][len(o.spp) // 2]
        times = [time_to(wanted, seconds, errors) for _, seconds, errors in curves]
        row = [c[0] / curves[0][0] for c in curves[1:]] + [t / times[0] for t in times[1:]]
        ratios.append(row)
        print('| %s | %.0f k | ' % (s.name, curves[0][0] / 1000) +
              ' | '.join('%.2f' % r for r in row) + ' |', flush=True)
    means = np.exp(np.log(ratios).mean(0))
    print('| geometric mean | | ' + ' | '.join('%.2f' % m for m in means) + ' |')


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('out', help='folder for images and measurements')
    parser.add_argument('scenes', nargs='+', help='pbrt-v3 scenes')
    parser.add_argument('--lull', action='append', required=True, metavar='NAME=PROGRAM [OPTION...]')
    parser.add_argument('--pbrt', help='the program of pbrt-v3')
    parser.add_argument('--side', type=int, default=64, help='of the images, in pixels (64)')
    parser.add_argument('--spp', default='16,64,256', help='samples per pixel (16,64,256)')
    parser.add_argument('--reference', type=int, default=2048, help='spp of each of two (2048)')
    o = parser.parse_args()
    o.spp = sorted(int(n) for n in o.spp.split(','))
    o.lull = [(name, shlex.split(program))
              for name, program in (text.split('=', 1) for text in o.lull)]
    scenes = [Scene(path, o) for path in o.scenes]
    for scene in scenes:
        scene.render()
    print_table(scenes, [name for name, _ in o.lull] + ['pbrt-v3'] * bool(o.pbrt), o)


main()
