"""Compares renders with and without learned direct light: mean squared error of lightness, and CPU time.

    python3 direct_light.py FOLDER NAME=SCENE.pbrt ... [--before LULL] [--after LULL] [--spp 64] [--seeds 3]

FOLDER keeps a reference of each scene, NAME.exr, which is not rendered again. Renders of both kinds alternate, on one
thread: before without --guide, after with --guide auto. Columns, after / before: MSE of
lightness (mean of seeds), median over pixels of the squared difference, CPU time, and CPU time times MSE.
"""

import argparse
import os
import resource
import subprocess

import numpy as np
import OpenImageIO as oiio

WEIGHTS = np.array([0.212671, 0.715160, 0.072169])


def lightness(path):
    """Returns CIE L* of an image, white at 1."""
    rgb = np.asarray(oiio.ImageBuf(path).get_pixels(oiio.FLOAT), np.float64)[:, :, :3]
    y = np.clip(rgb @ WEIGHTS, 0, 1)
    return np.where(y > 216 / 24389, 116 * np.cbrt(y) - 16, y * 24389 / 27)


def render(lull, scene, output, *options):
    """Renders on one thread and returns the CPU time, seconds, that it took."""
    def used():
        r = resource.getrusage(resource.RUSAGE_CHILDREN)
        return r.ru_utime + r.ru_stime
    start = used()
    subprocess.run(['nice', '-n', '10', lull, 'render', scene, '-o', output, '--threads', '1', '--quiet', *options],
                   check=True, stdout=subprocess.DEVNULL)
    return used() - start


def compare(o, name, scene):
    size = ['--resolution', o.resolution]
    reference = os.path.join(o.folder, name + '.exr')
    if not os.path.exists(reference):
        render(o.before or o.after, scene, reference, *size, '--spp', str(o.reference), '--seed', '77')
    truth = lightness(reference)
    # One sample a pixel takes the time of reading and compiling the scene.
    kinds = {'before': (o.before or o.after, []), 'after': (o.after, ['--guide', 'auto'])}
    squares = {k: [] for k in kinds}
    seconds = {k: 0. for k in kinds}
    for seed in range(1, o.seeds + 1):
        for kind, (lull, options) in kinds.items():
            picture = os.path.join(o.folder, f'{name}-{kind}-{seed}.exr')
            how = [*size, *options, '--seed', str(seed)]
            start = render(lull, scene, picture, *how, '--spp', '1')
            seconds[kind] += render(lull, scene, picture, *how, '--spp', str(o.spp)) - start
            squares[kind].append((lightness(picture) - truth) ** 2)
    mse = {k: np.mean(s) for k, s in squares.items()}
    median = {k: np.median(np.mean(s, 0)) for k, s in squares.items()}
    ratio = mse['after'] / mse['before']
    time = seconds['after'] / seconds['before']
    print(f'| {name} | {mse["before"]:.2f} | {mse["after"]:.2f} | {ratio:.2f} | {median["after"] / median["before"]:.2f} '
          f'| {time:.2f} | {ratio * time:.2f} |', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('folder')
    parser.add_argument('scenes', nargs='+')
    parser.add_argument('--before')
    parser.add_argument('--after', default='build/release/renderer/lull')
    parser.add_argument('--resolution', default='128x128')
    parser.add_argument('--spp', type=int, default=64)
    parser.add_argument('--seeds', type=int, default=3)
    parser.add_argument('--reference', type=int, default=1536)
    o = parser.parse_args()
    print('| scene | MSE before | MSE after | MSE | median | CPU time | CPU time x MSE |\n|---|---|---|---|---|---|---|')
    for scene in o.scenes:
        compare(o, *scene.split('=', 1))


main()
