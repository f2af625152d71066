"""Renders scenes by the default rule, plain and denoised, and prints the time and error of both.

    python3 denoising.py FOLDER NAME=SCENE.pbrt[@X0,X1,Y0,Y1] ... [--lull ../../build/release/renderer/lull]
    python3 denoising.py --calibrate FOLDER ...     # estimated and true errors
    python3 denoising.py --denoised FOLDER ...      # without renders by the default rule, which take hours

Images are kept in FOLDER: existing ones are not rendered again. The truth is a denoised render of --truth spp
with another seed, whose own error adds to all figures. With --truth 0 there is none.
"""

import argparse
import json
import os

import numpy as np

from crops import Crop  # PYTHONPATH=../side_by_side


class Scene(Crop):
    def __init__(self, text, o):
        super().__init__(text, o.folder, o.lull, o.resolution)
        self.o = o

    def spp(self, name):
        report = json.load(open(self.file(name + '.json')))
        return report['totals']['samples'] / sum(b['width'] * b['height'] for b in report['blocks'])

    def truth(self):
        self.render('truth', '--spp', str(self.o.truth), '--seed', '7', '--denoise')

    def calibrate(self):
        """Returns estimate, bound and truth of the visible difference at all counts of samples."""
        self.truth()
        rows = []
        for spp in 20, 80, 320:
            self.render(str(spp), '--spp', str(spp), '--denoise', '--seed', '1')
            estimate, upper = self.said(str(spp))
            true = self.judge(str(spp))['visibleDifference']
            rows.append((estimate, upper, true))
            print(f'| {self.name} | {spp} | {estimate:.1f} | {upper:.1f} | {true:.1f} |', flush=True)
        return rows

    def said(self, name):
        """Estimate and upper bound of the visible difference, as the render's report has them."""
        blocks = [b['visibleDifference'] for b in json.load(open(self.file(name + '.json')))['blocks']]
        return [np.mean([b[k] for b in blocks]) for k in ('estimate', 'upper')]

    def row(self):
        names = ['denoised'] if self.o.denoised else ['plain', 'denoised']
        self.render('start', '--spp', '1')
        for name in names:
            self.render(name, '--seed', '1', *(['--denoise'] if name == 'denoised' else []))
        if self.o.truth:
            self.truth()
        seconds = {n: self.seconds[n] - self.seconds['start'] for n in names}
        cells = [self.name]
        for name in names:
            cells += [f'{self.spp(name):,.0f}', f'{seconds[name]:.1f}']
            cells += [f'{self.said(name)[1]:.1f}'] if name == 'denoised' else []
            if self.o.truth:
                f = self.judge(name)
                cells += [f'{f["visibleDifference"]:.1f}', f'{f["rmseLightness"]:.2f}', f'{f["flip"]:.3f}',
                          f'{f["ssim"]:.3f}']
            else:
                cells += ['–'] * 4
        gain = seconds[names[0]] / seconds['denoised']
        print('| ' + ' | '.join(cells + ([] if self.o.denoised else [f'{gain:.1f}'])) + ' |', flush=True)
        return gain


def calibrate(o):
    print('| scene | spp | estimate | upper bound | truth |\n|---|---|---|---|---|')
    rows = np.array([row for text in o.scenes for row in Scene(text, o).calibrate()])
    estimate, upper, true = rows.T
    for name, said in ('estimate', estimate), ('bound', upper):
        ratio = np.log(said / true)
        print(f'{name} / truth: geometric mean {np.exp(ratio.mean()):.2f}, standard deviation of the logarithm '
              f'{ratio.std():.2f}; truth above it in {np.sum(true > said)} of {len(true)}')


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('folder')
    parser.add_argument('scenes', nargs='+')
    parser.add_argument('--lull', default='lull')
    parser.add_argument('--resolution', default='400x400')
    parser.add_argument('--calibrate', action='store_true')
    parser.add_argument('--denoised', action='store_true')
    parser.add_argument('--truth', type=int, default=4096)
    o = parser.parse_args()
    os.makedirs(o.folder, exist_ok=True)
    if o.calibrate:
        calibrate(o)
        return
    columns = ['visible difference', 'RMSE of L', 'FLIP', 'SSIM']
    plain = [] if o.denoised else ['spp, plain', 's', *columns]
    head = ['scene', *plain, 'spp, denoised', 's', 'bound', *columns] + ([] if o.denoised else ['times faster'])
    print('| ' + ' | '.join(head) + ' |')
    print('|---' * len(head) + '|')
    gains = [Scene(text, o).row() for text in o.scenes]
    if not o.denoised:
        print(f'geometric mean: {np.exp(np.mean(np.log(gains))):.1f} times faster')


if __name__ == '__main__':
    main()
