"""Renders scenes with --denoise, and with --default by the default rule, to their stops, and prints samples, time and error.

    python3 denoising.py FOLDER NAME=SCENE.pbrt[@X0,X1,Y0,Y1] ...

Images are kept in FOLDER: existing ones are not rendered again. The truth is a denoised render of --truth spp
with another seed, whose own error adds to all figures. With --truth 0 there is none. With --metric PROGRAM, the
target `visible_difference`, the column "true" is the visible difference without the worst pixels, as the rule
estimates it, from the mean of such renders with --truths seeds, less their own error.
"""

import argparse
import math

import numpy as np

from measure import Renders, read, visible_differences

DISPLAY = '100cd,40ppd,250lux'

FIGURES = {'visibleDifference': ('visible difference', '.1f'), 'rmseLightness': ('RMSE of L', '.2f'),
           'flip': ('FLIP', '.3f'), 'ssim': ('SSIM', '.3f')}


def true_difference(o, scene, name, spp):
    """Returns the visible difference of an image from the mean of the truths, whose error falls as spp^-0.75."""
    truth = np.mean([read(scene.file(truth_name(k))) for k in range(o.truths)], 0)
    difference, = visible_differences(o.metric, DISPLAY, [truth, read(scene.file(name))], 'without')
    return difference / math.sqrt(1 + (spp / o.truth) ** 1.5 / o.truths)


def truth_name(k):
    return f'truth{k or ""}'


def print_row(o, scene, name, **options):
    """Prints the row of a scene for a rule."""
    scene.render('start', spp=1)
    report = scene.render(name, seed=1, **options)
    spp = report['totals']['samples'] / sum(b['width'] * b['height'] for b in report['blocks'])
    seconds = scene.seconds[name] - scene.seconds['start']
    cells = [scene.folder.name, name, f'{spp:,.0f}', f'{seconds:.1f}']
    blocks = [block['visibleDifference'] for block in report['blocks'] if 'visibleDifference' in block]
    cells += [f'{np.mean([block[key] for block in blocks]):.1f}' if blocks else '–' for key in ('estimate', 'upper')]
    if o.truth:
        for k in range(o.truths):
            scene.render(truth_name(k), spp=o.truth, seed=7 + k, denoise=True)
        errors = scene.compare(name)
    cells.append(f'{true_difference(o, scene, name, spp):.1f}' if o.truth and o.metric else '–')
    cells += [f'{errors[key]:{form}}' if o.truth else '–' for key, (_, form) in FIGURES.items()]
    print('| ' + ' | '.join(cells) + ' |', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('folder')
    parser.add_argument('scenes', nargs='+')
    parser.add_argument('--resolution', default='400x400')
    parser.add_argument('--truth', type=int, default=4096)
    parser.add_argument('--truths', type=int, default=1)
    parser.add_argument('--metric')
    parser.add_argument('--threads', type=int, default=0)
    parser.add_argument('--default', action='store_true')
    o = parser.parse_args()
    head = ['scene', 'rule', 'spp', 's', 'estimate', 'bound', 'true', *(name for name, _ in FIGURES.values())]
    print('| ' + ' | '.join(head) + ' |\n' + '|---' * len(head) + '|')
    for text in o.scenes:
        scene = Renders.parse(text, o.folder, resolution=o.resolution, threads=o.threads)
        print_row(o, scene, 'denoised', denoise=True)
        if o.default:
            print_row(o, scene, 'default')


if __name__ == '__main__':
    main()
