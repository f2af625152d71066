#!/usr/bin/python3
"""Renders scenes with lull and with Cycles, and prints by how much they differ and which is faster.

    apt-get install blender python3-openimageio
    cmake --build --preset release --target pbrt_to_gltf
    tests/side_by_side/side_by_side.py OUT SCENE.pbrt|MODEL.glb...

Both render the same glTF file, which is made from a pbrt-v3 scene, and the same environment: same
camera, light, bounces and filter, without denoising, clamping, thresholds of light or a limit of
caustics. Images and measurements stay in the folder OUT; what is there already is not rendered
again, so that --spp, --reference and the list of scenes can grow. Not part of CI. It needs what
measure.py needs.

Seconds are CPU times without loading, which is what the shortest render takes less its samples at
the speed of the references.
"""

import argparse
import json
import pathlib
import subprocess
import sys

import numpy as np
import OpenImageIO as oiio

HERE = pathlib.Path(__file__).resolve().parent
sys.path.append(str(HERE.parent / 'measurements'))
from measure import ROOT, Renders, lightness, read, run  # noqa: E402

PROGRAMS = {'lull': '', 'cycles': 'ViewLayer.Combined.'}  # and the layer of their images


class Scene(Renders):
    def __init__(self, path, o):
        path = pathlib.Path(path).resolve()
        name = path.parent.name if path.stem == 'scene' else path.stem
        super().__init__(pathlib.Path(o.out) / name, path)
        self.o, self.model = o, path
        self.environment = o.environment and str(pathlib.Path(o.environment).resolve())
        if path.suffix == '.pbrt':
            self.model, sky = self.folder / f'{name}.glb', self.folder / 'environment.exr'
            if not self.model.exists():
                run(ROOT / 'build/release/tests/pbrt_to_gltf', path, self.model, sky)
            self.environment = str(sky) if sky.exists() else None
        self.scene = self.model
        self.options = {'resolution': o.size, 'block': o.block, 'threads': 2, 'max_depth': o.bounces + 1,
                        'environment': self.environment}
        if o.frame is not None:
            self.options.update(frame=o.frame, shutter=o.shutter)

    def cycles(self, *runs):
        """Renders with Cycles, in one Blender, what has not been done of (name, spp, seed, materials)."""
        keys = ('name', 'spp', 'seed', 'materials')
        runs = [dict(zip(keys, run), adaptive=0) for run in runs if run[0] not in self.seconds]
        if not runs:
            return
        width, height = map(int, self.o.size.split('x'))
        options = {'model': str(self.model), 'environment': self.environment, 'width': width, 'height': height,
                   'bounces': self.o.bounces, 'frame': self.o.frame, 'shutter': self.o.shutter,
                   'folder': str(self.folder), 'runs': runs}
        command = ['blender', '-b', '-noaudio', '-t', '2', '--python-exit-code', '1', '--python',
                   str(HERE / 'in_blender.py'), '--', json.dumps(options)]
        process = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        for line in process.stdout.splitlines():
            if line.startswith('RESULT '):
                result = json.loads(line[7:])
                self.note(result['name'], result['seconds'])
        if process.returncode != 0:
            sys.exit(process.stdout[-3000:])

    def render_all(self):
        o = self.o
        # Short renders of the two take turns, as the machine's speed changes with what others do.
        for spp in o.spp:
            self.render(f'lull-{spp}', spp=spp)
            self.cycles((f'cycles-{spp}', spp, 1, 'specification'))
        for seed in (11, 12):
            self.render(f'lull-reference-{seed}', spp=o.reference, seed=seed)
        self.cycles(*((f'cycles-reference-{seed}', o.reference, seed, 'specification') for seed in (11, 12)),
                    ('imported', max(o.spp), 2, 'imported'))

    def image(self, name):
        return read(self.file(name), PROGRAMS['lull' if name.startswith('lull') else 'cycles'])

    def halves(self, program):
        """Returns both halves of the reference."""
        return [self.image(f'{program}-reference-{seed}') for seed in (11, 12)]

    def per_sample(self, program):
        """Returns CPU seconds for one sample per pixel."""
        least, most = min(self.o.spp), self.o.reference
        high = sum(self.seconds[f'{program}-reference-{seed}'] for seed in (11, 12)) / 2
        return (high - self.seconds[f'{program}-{least}']) / (most - least)

    def error(self, program, name):
        """Returns the RMSE of lightness against the program's own reference, without what that misses
        itself, which the difference of its halves shows."""
        a, b = self.halves(program)
        own = ((lightness(a) - lightness(b)) ** 2).mean() / 4
        square = ((lightness(self.image(name)) - lightness((a + b) / 2)) ** 2).mean()
        return max(0, square - own) ** 0.5


def print_agreement(scenes):
    print('Means of the references, Cycles over lull:\n')
    print('| scene | R | G | B | standard error | as imported |\n|---|---|---|---|---|---|')
    for s in scenes:
        halves = {p: s.halves(p) for p in PROGRAMS}
        lull, cycles = (sum(halves[p]) / 2 for p in PROGRAMS)
        # Of independent pixels whose values the halves show to scatter so much.
        noise = [((halves[p][0] - halves[p][1]).mean(2) / 2).std() / lull.mean() for p in PROGRAMS]
        figures = (*(cycles.mean((0, 1)) / lull.mean((0, 1))), np.hypot(*noise) / lull[..., 0].size ** 0.5)
        print(f'| {s.folder.name} | ' + ' | '.join(f'{v:.4f}' for v in figures) +
              f' | {s.image("imported").mean() / lull.mean():.3f} |')


def print_speed(scenes, o):
    print('\nSamples per CPU second, and RMSE of L against CPU seconds:\n')
    print('| scene | program | samples/s | ' + ' | '.join(f'{n} spp' for n in o.spp) + ' |')
    print('|---|---|---' + '|---' * len(o.spp) + '|')
    for s in scenes:
        for program in PROGRAMS:
            slope = s.per_sample(program)
            cells = [f'{s.error(program, f"{program}-{n}"):.2f} in {n * slope:.2f} s' for n in o.spp]
            samples = s.image(f'{program}-{o.spp[0]}')[..., 0].size / slope
            print(f'| {s.folder.name} | {program} | {samples:.0f} | {" | ".join(cells)} |')


def save_pair(s):
    """Writes lull's and Cycles' reference side by side as FOLDER/pair.png."""
    pair = np.concatenate([sum(s.halves(p)) / 2 for p in PROGRAMS], 1).clip(0, 1)
    srgb = np.where(pair <= 0.0031308, 12.92 * pair, 1.055 * pair ** (1 / 2.4) - 0.055)
    image = oiio.ImageBuf(oiio.ImageSpec(srgb.shape[1], srgb.shape[0], 3, oiio.UINT8))
    image.set_pixels(oiio.ROI(), np.ascontiguousarray(srgb, np.float32))
    image.write(str(s.folder / 'pair.png'))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('out', help='folder for images and measurements')
    parser.add_argument('scenes', nargs='+', help='pbrt-v3 scenes or .glb models')
    parser.add_argument('--size', default='160x160', help='of the images (160x160)')
    parser.add_argument('--block', type=int, default=40, help="pixels a side of lull's blocks (40)")
    parser.add_argument('--spp', default='16,64,256', help='samples per pixel (16,64,256)')
    parser.add_argument('--reference', type=int, default=1024, help='spp of each half of a reference (1024)')
    parser.add_argument('--bounces', type=int, default=12)
    parser.add_argument('--frame', type=float, help='seconds of the animation (as the file stands)')
    parser.add_argument('--shutter', type=float, default=0, help='seconds that it is open (0)')
    parser.add_argument('--environment', help='surrounds a .glb model')
    o = parser.parse_args()
    o.spp = sorted(int(n) for n in o.spp.split(','))
    scenes = [Scene(path, o) for path in o.scenes]
    for scene in scenes:
        scene.render_all()
    print_agreement(scenes)
    print_speed(scenes, o)
    for scene in scenes:
        save_pair(scene)


main()
