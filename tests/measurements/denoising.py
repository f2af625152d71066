"""Renders scenes with --denoise to their stops, and prints samples, time and error.

    python3 denoising.py FOLDER NAME=SCENE.pbrt[@X0,X1,Y0,Y1] ...

Images are kept in FOLDER: existing ones are not rendered again. The truth is a denoised render of --truth spp
with another seed, whose own error adds to all figures. With --truth 0 there is none.
"""

import argparse

import numpy as np

from measure import Renders

FIGURES = {'visibleDifference': ('visible difference', '.1f'), 'rmseLightness': ('RMSE of L', '.2f'),
           'flip': ('FLIP', '.3f'), 'ssim': ('SSIM', '.3f')}


def print_row(scene, truth):
    """Prints the row of a scene."""
    scene.render('start', spp=1)
    report = scene.render('denoised', seed=1, denoise=True)
    spp = report['totals']['samples'] / sum(b['width'] * b['height'] for b in report['blocks'])
    seconds = scene.seconds['denoised'] - scene.seconds['start']
    bound = np.mean([block['visibleDifference']['upper'] for block in report['blocks']])
    cells = [scene.folder.name, f'{spp:,.0f}', f'{seconds:.1f}', f'{bound:.1f}']
    if truth:
        scene.render('truth', spp=truth, seed=7, denoise=True)
        errors = scene.compare('denoised')
    cells += [f'{errors[key]:{form}}' if truth else '–' for key, (_, form) in FIGURES.items()]
    print('| ' + ' | '.join(cells) + ' |', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('folder')
    parser.add_argument('scenes', nargs='+')
    parser.add_argument('--resolution', default='400x400')
    parser.add_argument('--truth', type=int, default=4096)
    o = parser.parse_args()
    head = ['scene', 'spp', 's', 'bound', *(name for name, _ in FIGURES.values())]
    print('| ' + ' | '.join(head) + ' |\n' + '|---' * len(head) + '|')
    for text in o.scenes:
        print_row(Renders.parse(text, o.folder, resolution=o.resolution), o.truth)


if __name__ == '__main__':
    main()
