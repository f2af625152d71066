#!/usr/bin/python3
"""Renders glTF files with lull and with Cycles, and says by how much they differ and who is faster.

    apt-get install blender python3-numpy python3-openimageio
    cmake --build --preset release --target lull
    tests/side_by_side/side_by_side.py build/release OUT MODEL.glb...

Both render the same file and the same environment: same camera, light, bounces and filter, without
denoising, clamping, thresholds of light or a limit of caustics. Images and measurements stay in the folder OUT; what is there already is not rendered
again, so that --spp, --reference and the list of scenes can grow. Not part of CI.

Seconds are those of processors, without loading, which is what the shortest render takes less its
samples at the speed of the references.
"""

import argparse
import json
import os
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio

from pictures import lightness, read
from seconds import Seconds

HERE = os.path.dirname(os.path.abspath(__file__))
PROGRAMS = ('lull', 'cycles')


class Scene:
    """One scene: its files, and for each render the CPU time."""

    def __init__(self, path, o):
        self.model, self.o = os.path.abspath(path), o
        parts = self.model.split(os.sep)
        stem = os.path.splitext(parts[-1])[0]
        self.name = parts[-2] if stem == 'scene' else stem
        self.folder = os.path.join(os.path.abspath(o.out), self.name)
        os.makedirs(self.folder, exist_ok=True)
        self.seconds = Seconds(os.path.join(self.folder, 'seconds.json'))
        self.environment = o.environment and os.path.abspath(o.environment)

    def file(self, name):
        return os.path.join(self.folder, name + '.exr')

    def lull(self, name, *how):
        """Renders with lull unless that has been done."""
        command = [os.path.join(self.o.build, 'renderer/lull'), 'render', self.model, '-o',
                   self.file(name), '--resolution', '%dx%d' % (self.o.width, self.o.height),
                   '--block', str(self.o.block), '--threads', '2', '--quiet', '--max-depth',
                   str(self.o.bounces + 1), *how]
        if self.environment:
            command += ['--environment', self.environment]
        if self.o.frame is not None:
            command += ['--frame', str(self.o.frame), '--shutter', str(self.o.shutter)]
        self.seconds.run(name, command)

    def cycles(self, runs):
        """Renders with Cycles, in one Blender, what has not been done of (name, spp, seed,
        adaptive, materials)."""
        keys = ('name', 'spp', 'seed', 'adaptive', 'materials')
        runs = [dict(zip(keys, run)) for run in runs if run[0] not in self.seconds]
        if not runs:
            return
        options = {'model': self.model, 'environment': self.environment, 'width': self.o.width,
                   'height': self.o.height, 'bounces': self.o.bounces, 'frame': self.o.frame,
                   'shutter': self.o.shutter, 'folder': self.folder, 'runs': runs}
        command = ['blender', '-b', '-noaudio', '-t', '2', '--python-exit-code', '1', '--python',
                   os.path.join(HERE, 'in_blender.py'), '--', json.dumps(options)]
        run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        tail = []
        for line in run.stdout:
            tail = tail[-30:] + [line]
            if line.startswith('RESULT '):
                result = json.loads(line[7:])
                self.seconds.note(result['name'], result['seconds'])
        if run.wait() != 0:
            sys.exit(''.join(tail))

    def render(self):
        o = self.o
        # Short renders of the two take turns, as the machine's speed changes with what others do.
        for spp in o.spp:
            self.lull('lull-%d' % spp, '--spp', str(spp))
            self.cycles([('cycles-%d' % spp, spp, 1, 0, 'specification')])
        if o.reference:
            for seed in (11, 12):
                self.lull('lull-reference-%d' % seed, '--spp', str(o.reference), '--seed',
                          str(seed))
            self.cycles([('cycles-reference-%d' % seed, o.reference, seed, 0, 'specification')
                         for seed in (11, 12)] +
                        [('imported', max(o.spp), 2, 0, 'imported')])
        if o.stop:
            self.lull('lull-stop', '--cap', str(o.cap))
            self.lull('lull-denoised', '--denoise', '--cap', str(o.cap))
            self.lull('lull-cautious', '--denoise', '--caution', '2', '--cap', str(o.cap))
            self.cycles([('cycles-stop', o.cap, 1, 0.01, 'specification')])

    def reference(self, program):
        """Returns the mean of both halves of the reference, and the mean square of its own error in
        lightness, which the difference of the halves shows."""
        a, b = (read(self.file('%s-reference-%d' % (program, seed)))[0] for seed in (11, 12))
        return (a + b) / 2, ((lightness(a) - lightness(b)) ** 2).mean() / 4

    def per_sample(self, program):
        """Returns processor seconds for one sample per pixel, and for all that is none."""
        least, most = min(self.o.spp), self.o.reference
        low = self.seconds['%s-%d' % (program, least)]
        high = sum(self.seconds['%s-reference-%d' % (program, seed)] for seed in (11, 12)) / 2
        slope = (high - low) / (most - least)
        return slope, low - least * slope

    def error(self, program, name):
        """Returns the RMSE of lightness against the program's own reference, without what that
        misses itself."""
        reference, own = self.reference(program)
        square = ((lightness(read(self.file(name))[0]) - lightness(reference)) ** 2).mean()
        return max(0, square - own) ** 0.5

    def flip(self, program, name):
        """Returns FLIP against the program's own reference."""
        truth = self.file(program + '-reference')
        if not os.path.exists(truth):
            write(truth, self.reference(program)[0])
        out, picture = os.path.join(self.folder, name), self.file(name + '-rgb')
        write(picture, read(self.file(name))[0])  # without the names of Blender's layers
        subprocess.run([os.path.join(self.o.build, 'renderer/lull'), 'compare', '--reference', truth,
                        '--automatic', picture, '-o', out], check=True, capture_output=True)
        images = json.load(open(out + '.compare.json'))['images']
        return next(i for i in images if i['name'] == 'automatic')['figures']['flip']


def write(path, rgb):
    image = oiio.ImageBuf(oiio.ImageSpec(rgb.shape[1], rgb.shape[0], 3, oiio.FLOAT))
    image.set_pixels(oiio.ROI(), np.ascontiguousarray(rgb, np.float32))
    image.write(path)


def blocks(image, n=10):
    h, w = image.shape[0] // n * n, image.shape[1] // n * n
    return image[:h, :w].reshape(h // n, n, w // n, n, -1).mean((1, 3))


def print_agreement(scenes):
    print('Means of the references, Cycles over lull:\n')
    print('| scene | R | G | B | standard error | blocks | of that noise | as imported |')
    print('|---|---|---|---|---|---|---|---|')
    for s in scenes:
        halves = {p: [read(s.file('%s-reference-%d' % (p, seed)))[0] for seed in (11, 12)]
                  for p in PROGRAMS}
        lull, cycles = (sum(halves[p]) / 2 for p in PROGRAMS)
        ratio = cycles.mean((0, 1)) / lull.mean((0, 1))
        # Of independent pixels whose values the halves show to scatter so much.
        noise = [((halves[p][0] - halves[p][1]).mean(2) / 2).std() / lull.mean() for p in PROGRAMS]
        error = np.hypot(*noise) / np.sqrt(lull.shape[0] * lull.shape[1])
        apart = abs(blocks(cycles) - blocks(lull)).mean() / lull.mean()
        chance = np.hypot(*[abs(blocks(halves[p][0]) - blocks(halves[p][1])).mean() / 2
                            for p in PROGRAMS]) / lull.mean()
        imported = read(s.file('imported'))[0].mean() / lull.mean()
        print('| %s | %.4f | %.4f | %.4f | %.4f | %.2f %% | %.2f %% | %.3f |' %
              (s.name, *ratio, error, 100 * apart, 100 * chance, imported))


def print_speed(scenes, o):
    print('\nSamples a second and core, and RMSE of L and FLIP against processor seconds:\n')
    print('| scene | program | samples/s | ' + ' | '.join('%d spp' % n for n in o.spp) + ' |')
    print('|---|---|---' + '|---' * len(o.spp) + '|')
    for s in scenes:
        for program in PROGRAMS:
            slope, _ = s.per_sample(program)
            names = ['%s-%d' % (program, n) for n in o.spp]
            cells = ['%.2f, %.3f in %.2f s' % (s.error(program, name), s.flip(program, name), n * slope)
                     for n, name in zip(o.spp, names)]
            print('| %s | %s | %.0f | %s |' % (s.name, program, o.width * o.height / slope,
                                               ' | '.join(cells)))


def print_stops(scenes, o):
    print("\nEach one's own stopping rule, lull's default, plain, denoised and with half the error, and Cycles' threshold of 0.01:\n")
    print('| scene | program | mean spp | seconds | RMSE of L | worst block | FLIP |')
    print('|---|---|---|---|---|---|---|')
    for s in scenes:
        for name in 'lull-stop', 'lull-denoised', 'lull-cautious', 'cycles-stop':
            program = name.split('-')[0]
            rgb, spp = read(s.file(name))
            mean = spp.mean() * (o.cap if program == 'cycles' else 1)
            reference, _ = s.reference(program)
            square = (lightness(rgb) - lightness(reference)) ** 2
            print('| %s | %s | %.0f | %.1f | %.2f | %.2f | %.3f |' %
                  (s.name, name, mean, s.seconds[name] - s.per_sample(program)[1],
                   s.error(program, name), blocks(square[:, :, None], o.block).max() ** 0.5,
                   s.flip(program, name)))


def save_pair(s):
    """Writes lull's and Cycles' reference side by side as FOLDER/pair.png."""
    pair = np.concatenate([s.reference(p)[0] for p in PROGRAMS], 1).clip(0, 1)
    srgb = np.where(pair <= 0.0031308, 12.92 * pair, 1.055 * pair ** (1 / 2.4) - 0.055)
    image = oiio.ImageBuf(oiio.ImageSpec(srgb.shape[1], srgb.shape[0], 3, oiio.UINT8))
    image.set_pixels(oiio.ROI(), np.ascontiguousarray(srgb, np.float32))
    image.write(os.path.join(s.folder, 'pair.png'))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('build', help='the build folder')
    parser.add_argument('out', help='folder for images and measurements')
    parser.add_argument('scenes', nargs='+', help='.glb models')
    parser.add_argument('--size', default='160x160', help='of the images (160x160)')
    parser.add_argument('--block', type=int, default=40, help="pixels a side of lull's blocks (40)")
    parser.add_argument('--spp', default='16,64,256', help='samples per pixel (16,64,256)')
    parser.add_argument('--reference', type=int, default=1024,
                        help='spp of each half of a reference (1024); 0: none, and no tables')
    parser.add_argument('--no-stop', dest='stop', action='store_false',
                        help='leave out the stopping rules')
    parser.add_argument('--cap', type=int, default=4096, help='of the stopping rules (4096)')
    parser.add_argument('--bounces', type=int, default=12)
    parser.add_argument('--frame', type=float, help='seconds of the animation (as the file stands)')
    parser.add_argument('--shutter', type=float, default=0, help='seconds that it is open (0)')
    parser.add_argument('--environment', help='surrounds a .glb model')
    o = parser.parse_args()
    o.width, o.height = (int(n) for n in o.size.split('x'))
    o.spp = sorted(int(n) for n in o.spp.split(','))
    scenes = [Scene(path, o) for path in o.scenes]
    for scene in scenes:
        scene.render()
    if not o.reference:
        return
    print_agreement(scenes)
    print_speed(scenes, o)
    if o.stop:
        print_stops(scenes, o)
    for scene in scenes:
        save_pair(scene)


main()
