"""Renders scenes by the default rule, plain and denoised, and says what both took and how wrong they are.

    python3 denoising.py FOLDER NAME=SCENE.pbrt[@X0,X1,Y0,Y1] ... [--lull ../../build/release/renderer/lull]
    python3 denoising.py --calibrate FOLDER ...     # what renders say of their error, beside the truth

Images are kept in FOLDER: what is there is not rendered again. The truth is the mean of two renders of
half of --truth spp each, whose difference is its noise, which is subtracted from visible errors but not
from FLIP and SSIM. With --truth 0 there is none, and visible errors are those that renders say of themselves.
"""

import argparse
import json
import os
import subprocess

import numpy as np
import OpenImageIO as oiio

from seconds import Seconds  # PYTHONPATH=../side_by_side

WEIGHTS = np.array([0.212671, 0.715160, 0.072169])
SIDE = 20  # pixels of a sub-block: 10 x 10 of them in a block


def read(path):
    return np.asarray(oiio.ImageBuf(path).get_pixels(oiio.FLOAT), np.float64)[:, :, :3]


def write(path, rgb, like):
    """Writes an image of the same part of the frame as another one."""
    frame = oiio.ImageBuf(like).spec()
    spec = oiio.ImageSpec(rgb.shape[1], rgb.shape[0], 3, oiio.FLOAT)
    spec.x, spec.y = frame.x, frame.y
    spec.full_x, spec.full_y, spec.full_width, spec.full_height = (
        frame.full_x, frame.full_y, frame.full_width, frame.full_height)
    buffer = oiio.ImageBuf(spec)
    buffer.set_pixels(spec.roi, rgb.astype(np.float32))
    buffer.write(path)


def srgb(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055)


def lightness(rgb, encoded=False):
    if encoded:
        rgb = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    y = np.clip(rgb @ WEIGHTS, 0, 1)
    return np.where(y > 216 / 24389, 116 * np.cbrt(y) - 16, y * 24389 / 27)


def sub_blocks(values):
    h, w = values.shape[0] // SIDE, values.shape[1] // SIDE
    return values[:h * SIDE, :w * SIDE].reshape(h, SIDE, w, SIDE).mean((1, 3))


def slope(y):
    y = np.clip(y, 1e-4, 1)
    return np.where(y > 216 / 24389, 116 / 3 * y ** (-2 / 3), 24389 / 27)


def seen(truth):
    """What an observer sees of a difference in lightness: less by flare and by detail."""
    mean = sub_blocks(truth)
    detail = np.sqrt(np.maximum(sub_blocks(truth ** 2) - mean ** 2, 0))
    y = np.where(mean > 8, ((mean + 16) / 116) ** 3, mean * 27 / 24389)
    flare = 0.05
    return slope((y + flare) / (1 + flare)) / (1 + flare) / slope(y) / (1 + detail / 40)


def as_seen(difference, radius=3):
    """Doubles what is coarse, as AsSeen() in visible_error.cpp does: the mean over the pixels around, within the image."""
    def total(values):
        padded = np.pad(values, ((radius + 1, radius), (radius + 1, radius))).cumsum(0).cumsum(1)
        n = 2 * radius + 1
        return padded[n:, n:] - padded[:-n, n:] - padded[n:, :-n] + padded[:-n, :-n]
    return difference + total(difference) / total(np.ones_like(difference))


def visible_error(rgb, halves):
    a, b = map(lightness, halves)
    truth = lightness((halves[0] + halves[1]) / 2)
    squared = sub_blocks(as_seen(lightness(rgb) - truth) ** 2 - as_seen(a - b) ** 2 / 4)
    return float(np.mean(np.sqrt(np.maximum(squared, 0)) * seen(truth)))


def entropies(rgb):
    """SVD-entropies of sub-blocks as a display shows them."""
    levels = lightness(np.round(255 * np.clip(srgb(rgb), 0, 1)) / 255, encoded=True)
    h, w = levels.shape[0] // SIDE, levels.shape[1] // SIDE
    blocks = levels[:h * SIDE, :w * SIDE].reshape(h, SIDE, w, SIDE).swapaxes(1, 2)
    shares = np.linalg.svd(blocks, compute_uv=False) ** 2
    shares /= np.maximum(shares.sum(-1, keepdims=True), 1e-300)
    return -(shares * np.log(np.maximum(shares, 1e-300))).sum(-1) / np.log(SIDE), blocks.mean((2, 3))


def entropy_fall(before, now, truth):
    """What still changes in a picture since half as many samples."""
    (h0, _), (h1, mean) = entropies(before), entropies(now)
    return float(np.mean(np.sqrt(np.abs(h0 - h1)) * mean * seen(truth)))


class Scene:
    def __init__(self, text, o):
        self.name, rest = text.split('=')
        self.scene, _, self.crop = rest.partition('@')
        self.o = o
        self.seconds = Seconds(os.path.join(o.folder, self.name + '.seconds.json'))

    def file(self, name):
        return os.path.join(self.o.folder, f'{self.name}.{name}')

    def render(self, name, *how):
        crop = ['--crop', self.crop] if self.crop else []
        self.seconds.run(name, [self.o.lull, 'render', self.scene, '--resolution', self.o.resolution, *crop, '--quiet',
                                '-o', self.file(name + '.exr'), '--report', self.file(name + '.json'), *how])

    def spp(self, name):
        report = json.load(open(self.file(name + '.json')))
        return report['totals']['samples'] / sum(b['width'] * b['height'] for b in report['blocks'])

    def judge(self, name, truth):
        out = self.file(name)
        subprocess.run([self.o.lull, 'compare', '--reference', truth, '--automatic', self.file(name + '.exr'), '-o', out],
                       check=True, capture_output=True)
        figures = json.load(open(out + '.compare.json'))
        return next(i for i in figures['images'] if i['name'] == 'automatic')['figures']

    def truth(self):
        half = str(self.o.truth // 2)
        self.render('a', '--spp', half, '--seed', '3')
        self.render('b', '--spp', half, '--seed', '4')
        return [read(self.file(n + '.exr')) for n in 'ab']

    def calibrate(self):
        """Returns estimate, bound and truth of all counts of samples."""
        halves, rows, before = self.truth(), [], None
        for spp in 32, 64, 128, 256, 512:
            self.render(str(spp), '--spp', str(spp), '--denoise', '--seed', '1')
            picture = read(self.file(f'{spp}.exr'))
            estimate, upper = self.said(str(spp))
            true = visible_error(picture, halves)
            fall = entropy_fall(before, picture, lightness((halves[0] + halves[1]) / 2)) if before is not None else np.nan
            before = picture
            rows.append((estimate, upper, fall, true))
            print(f'| {self.name} | {spp} | {estimate:.2f} | {upper:.2f} | {fall:.2f} | {true:.2f} |', flush=True)
        return rows

    def said(self, name):
        """Estimate and upper bound of the visible error, as the render's report has them."""
        blocks = [b['visibleError'] for b in json.load(open(self.file(name + '.json')))['blocks']]
        return [np.mean([b[k] for b in blocks]) for k in ('estimate', 'upper')]

    def row(self):
        self.render('start', '--spp', '1')
        self.render('denoised', '--denoise', '--seed', '1')
        self.render('plain', '--seed', '1')
        halves = self.truth() if self.o.truth else None
        if halves:
            truth = self.file('truth.exr')
            write(truth, (halves[0] + halves[1]) / 2, self.file('a.exr'))
        seconds = {n: self.seconds[n] - self.seconds['start'] for n in ('plain', 'denoised')}
        cells = [self.name]
        for name in 'plain', 'denoised':
            cells += [f'{self.spp(name):,.0f}', f'{seconds[name]:.1f}']
            if halves:
                f = self.judge(name, truth)
                cells += [f'{visible_error(read(self.file(name + ".exr")), halves):.2f}',
                          f'{f["rmseLightness"]:.2f}', f'{f["flip"]:.3f}', f'{f["ssim"]:.3f}']
            else:
                cells += [', '.join(f'{v:.2f}' for v in self.said(name)) if name == 'denoised' else '–'] + ['–'] * 3
        print('| ' + ' | '.join(cells + [f'{seconds["plain"] / seconds["denoised"]:.1f}']) + ' |', flush=True)
        return seconds['plain'] / seconds['denoised']


def calibrate(o):
    print('| scene | spp | estimate | upper bound | fall of SVD-entropy | truth |\n|---|---|---|---|---|---|')
    rows = np.array([row for text in o.scenes for row in Scene(text, o).calibrate()])
    estimate, upper, fall, true = rows.T
    for name, said in ('estimate', estimate), ('bound', upper), ('entropy', fall):
        known = np.isfinite(said) & (said > 0) & (true > 0)
        ratio = np.log(said[known] / true[known])
        print(f'{name} / truth: geometric mean {np.exp(ratio.mean()):.2f}, standard deviation of the logarithm '
              f'{ratio.std():.2f}; truth above it in {np.mean(true[known] > said[known]):.0%} of {known.sum()}')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('folder')
    parser.add_argument('scenes', nargs='+')
    parser.add_argument('--lull', default='lull')
    parser.add_argument('--resolution', default='400x400')
    parser.add_argument('--calibrate', action='store_true')
    parser.add_argument('--truth', type=int, default=4096)
    o = parser.parse_args()
    os.makedirs(o.folder, exist_ok=True)
    if o.calibrate:
        calibrate(o)
        return
    columns = ['spp', 's', 'visible', 'RMSE of L', 'FLIP', 'SSIM']
    print('| scene | ' + ' | '.join(f'{c}, {n}' for n in ('plain', 'denoised') for c in columns) + ' | times faster |')
    print('|---' * 14 + '|')
    gains = [Scene(text, o).row() for text in o.scenes]
    print(f'geometric mean: {np.exp(np.mean(np.log(gains))):.1f} times faster')


if __name__ == '__main__':
    main()
