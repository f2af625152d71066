"""Renders scenes with --denoise, and with --default by the default rule, to their stops, and prints samples, time and error.

    python3 denoising.py FOLDER NAME=SCENE.pbrt[@X0,X1,Y0,Y1] ...

Images are kept in FOLDER: existing ones are not rendered again. The truth is a denoised render of --truth spp
with another seed, whose own error adds to all figures. With --truth 0 there is none.
"""

import argparse

import numpy as np

from measure import Renders

FIGURES = {'visibleDifference': ('visible difference', '.1f'), 'rmseLightness': ('RMSE of L', '.2f'),
           'flip': ('FLIP', '.3f'), 'ssim': ('SSIM', '.3f')}


def print_row(scene, name, truth, **options):
    """Prints the row of a scene for a rule."""
    scene.render('start', spp=1)
    report = scene.render(name, seed=1, **options)
    spp = report['totals']['samples'] / sum(b['width'] * b['height'] for b in report['blocks'])
    seconds = scene.seconds[name] - scene.seconds['start']
    cells = [scene.folder.name, name, f'{spp:,.0f}', f'{seconds:.1f}']
    bounds = [block['visibleDifference']['upper'] for block in report['blocks'] if 'visibleDifference' in block]
    cells.append(f'{np.mean(bounds):.1f}' if bounds else '–')
    if truth:
        scene.render('truth', spp=truth, seed=7, denoise=True)
        errors = scene.compare(name)
    cells += [f'{errors[key]:{form}}' if truth else '–' for key, (_, form) in FIGURES.items()]
    print('| ' + ' | '.join(cells) + ' |', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('folder')
    parser.add_argument('scenes', nargs='+')
    parser.add_argument('--resolution', default='400x400')
    parser.add_argument('--truth', type=int, default=4096)
    parser.add_argument('--threads', type=int, default=0)
    parser.add_argument('--default', action='store_true')
    o = parser.parse_args()
    head = ['scene', 'rule', 'spp', 's', 'bound', *(name for name, _ in FIGURES.values())]
    print('| ' + ' | '.join(head) + ' |\n' + '|---' * len(head) + '|')
    for text in o.scenes:
        scene = Renders.parse(text, o.folder, resolution=o.resolution, threads=o.threads)
        print_row(scene, 'denoised', o.truth, denoise=True)
        if o.default:
            print_row(scene, 'default', o.truth)


if __name__ == '__main__':
    main()
