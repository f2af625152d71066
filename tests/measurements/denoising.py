"""Renders scenes by the default rule, plain and denoised, and prints the time and error of both.

    python3 denoising.py FOLDER NAME=SCENE.pbrt[@X0,X1,Y0,Y1] ...
    python3 denoising.py --calibrate FOLDER ...     # estimated and true errors
    python3 denoising.py --denoised FOLDER ...      # without renders by the default rule, which take hours

Images are kept in FOLDER: existing ones are not rendered again. The truth is a denoised render of --truth spp
with another seed, whose own error adds to all figures. With --truth 0 there is none.
"""

import argparse

import numpy as np

from measure import Renders

FIGURES = {'visibleDifference': ('visible difference', '.1f'), 'rmseLightness': ('RMSE of L', '.2f'),
           'flip': ('FLIP', '.3f'), 'ssim': ('SSIM', '.3f')}


def said(report):
    """Returns estimate and upper bound of the visible difference, as the report of a render has them."""
    return [np.mean([block['visibleDifference'][k] for block in report['blocks']]) for k in ('estimate', 'upper')]


def calibrate(scenes, truth):
    """Prints estimate, bound and truth of the visible difference at all counts of samples."""
    print('| scene | spp | estimate | upper bound | truth |\n|---|---|---|---|---|')
    rows = []
    for scene in scenes:
        scene.render('truth', spp=truth, seed=7, denoise=True)
        for spp in '20', '80', '320':
            estimate, upper = said(scene.render(spp, spp=spp, denoise=True, seed=1))
            rows.append((estimate, upper, scene.compare(spp)['visibleDifference']))
            print(f'| {scene.folder.name} | {spp} |' + ''.join(f' {value:.1f} |' for value in rows[-1]), flush=True)
    estimate, upper, true = np.array(rows).T
    for name, value in ('estimate', estimate), ('bound', upper):
        ratio = np.log(value / true)
        print(f'{name} / truth: geometric mean {np.exp(ratio.mean()):.2f}, standard deviation of the logarithm '
              f'{ratio.std():.2f}; truth above it in {np.sum(true > value)} of {len(true)}')


def row(scene, names, truth):
    """Prints the row of a scene; returns the ratio of the times of the first and the last of its renders."""
    scene.render('start', spp=1)
    cells, seconds = [scene.folder.name], []
    for name in names:
        report = scene.render(name, seed=1, denoise=name == 'denoised')
        spp = report['totals']['samples'] / sum(b['width'] * b['height'] for b in report['blocks'])
        seconds.append(scene.seconds[name] - scene.seconds['start'])
        cells += [f'{spp:,.0f}', f'{seconds[-1]:.1f}']
        if name == 'denoised':
            cells.append(f'{said(report)[1]:.1f}')
        if truth:
            scene.render('truth', spp=truth, seed=7, denoise=True)
            errors = scene.compare(name)
        cells += [f'{errors[key]:{form}}' if truth else '–' for key, (_, form) in FIGURES.items()]
    print('| ' + ' | '.join(cells + [f'{seconds[0] / seconds[-1]:.1f}'] * (len(names) > 1)) + ' |', flush=True)
    return seconds[0] / seconds[-1]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('folder')
    parser.add_argument('scenes', nargs='+')
    parser.add_argument('--resolution', default='400x400')
    parser.add_argument('--calibrate', action='store_true')
    parser.add_argument('--denoised', action='store_true')
    parser.add_argument('--truth', type=int, default=4096)
    o = parser.parse_args()
    scenes = [Renders.parse(text, o.folder, resolution=o.resolution) for text in o.scenes]
    if o.calibrate:
        return calibrate(scenes, o.truth)
    columns = [name for name, _ in FIGURES.values()]
    plain = [] if o.denoised else ['spp, plain', 's', *columns]
    head = ['scene', *plain, 'spp, denoised', 's', 'bound', *columns] + ['times faster'] * (not o.denoised)
    print('| ' + ' | '.join(head) + ' |\n' + '|---' * len(head) + '|')
    gains = [row(scene, ['denoised'] if o.denoised else ['plain', 'denoised'], o.truth) for scene in scenes]
    if not o.denoised:
        print(f'geometric mean: {np.exp(np.mean(np.log(gains))):.1f} times faster')


if __name__ == '__main__':
    main()
