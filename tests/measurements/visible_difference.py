"""Compares the metric of visible differences with human thresholds.

    python3 visible_difference.py sensitivity PROGRAM data_individual.csv    # castleCSF's data: thresholds of single people
    python3 visible_difference.py blocks PROGRAM FOLDER HUMAN.csv            # blocks with human thresholds

    lull render staircase2/scene.pbrt --resolution 800x800 --spp 64 --seed 1 --denoise --denoise-layers --estimator pbrt-v3 \\
        --sampler random -o FOLDER/staircase2-view0.exr

PROGRAM is the target `visible_difference`. FOLDER has VIEWPOINT.exr of 800x800 pixels or VIEWPOINT-BLOCK.exr of 200x200,
rendered with --denoise --denoise-layers; all else is made from them: the denoised picture stands for that of 10,000 spp, and the
noise that one of fewer has beside it is drawn from the differences of both halves in the 5x5 pixels around, many times, and
scaled to the variance v (1 / spp - 1 / 10,000). One number for all blocks, set on the other scenes (the word before the first
hyphen, so that views of one scene leave together), says where it is seen no more.
"""

import argparse
import collections
import csv
import glob
import os
import re
import subprocess

import numpy as np

import published
from measure import read, visible_differences

CAP, PASS, SIDE = 10000, 20, 200
LADDER = [250, 500, 1000, 2000, 4000, 7000, 9500]
LIMIT = 3.1  # of `lull compare` and the rule `denoised`


def decibels(ratio):
    return 20 * np.log10(ratio)


def barten(u, area, luminance):
    """P. G. J. Barten: Formula for the contrast sensitivity of the human eye, Proc. SPIE 5294, 2004, equation 11."""
    return 5200 * np.exp(-0.0016 * u * u * (1 + 100 / luminance) ** 0.08) / np.sqrt(
        (1 + 144 / area + 0.64 * u * u) * (63 / luminance ** 0.83 + 1 / (1 - np.exp(-0.02 * u * u))))


def sensitivity(o):
    with open(o.data, encoding='latin1') as f:
        rows = [r for r in csv.DictReader(f) if r['dataset'] == 'modelfest']
    patches = np.array([[float(r[k]) for k in ('s_frequency', 'area', 'luminance')] for r in rows])
    measured = np.array([float(r['sensitivity']) for r in rows])
    people = np.array([r['observer'] for r in rows])
    text = '\n'.join(' '.join(repr(float(v)) for v in p) for p in patches)
    out = subprocess.run([o.program, 'sensitivity'], input=text, stdout=subprocess.PIPE, text=True, check=True).stdout
    predicted = np.array([[float(v) for v in line.split()] for line in out.splitlines()])[:, 0]
    for name, model in (('castleCSF', predicted), ('Barten', barten(*patches.T))):
        error = decibels(measured / model)
        means = [error[people == p].mean() for p in sorted(set(people))]
        within = np.sqrt(np.mean([error[people == p].var() for p in sorted(set(people))]))
        print(f'{name}: {len(error)} thresholds of {len(means)} people, measured over predicted: mean {error.mean():.2f} dB, '
              f'RMS {np.sqrt(np.mean(error ** 2)):.2f}, scatter {error.std():.2f} (between people {np.std(means):.2f}, '
              f'within {within:.2f})')


def noise(difference, random, count=32):
    """Returns noise of the local covariance of `difference`, closer to normal than that."""
    h, w, _ = difference.shape
    y, x = np.mgrid[:h, :w]
    total = np.zeros_like(difference)
    for _ in range(count):
        rows = np.abs(y + random.integers(-2, 3, (h, w)))
        columns = np.abs(x + random.integers(-2, 3, (h, w)))
        rows, columns = np.minimum(rows, 2 * h - 2 - rows), np.minimum(columns, 2 * w - 2 - columns)
        total += difference[rows, columns] * random.choice([-1, 1], (h, w, 1))
    return total / np.sqrt(count)


def load_blocks(o):
    """Returns for each block its viewpoint, the threshold of people, the clean picture and the noise of one sample a pixel."""
    human, blocks = published.read(o.human), []
    for path in sorted(glob.glob(os.path.join(glob.escape(o.folder), '*.exr'))):
        name, block = re.fullmatch(r'(.*-view\d+)(?:-(\d+))?', os.path.basename(path)[:-4]).groups()
        images = [read(path, *layer) for layer in ((), ('halfA.',), ('halfB.',), ('', ['spp']))]
        for b in [int(block)] if block else range(16):
            x, y = (0, 0) if block else (b % 4 * SIDE, b // 4 * SIDE)
            colour, half_a, half_b, spp = (image[y:y + SIDE, x:x + SIDE] for image in images)
            difference = (half_a - half_b) / 2 * np.sqrt(spp)
            random = np.random.default_rng([o.seed, b])
            blocks.append((name, b, human[f'p3d_{name}_part6'][b], colour, noise(difference, random)))
    return blocks


def scene(viewpoint):
    return viewpoint.split('-')[0]


def viewpoints(blocks):
    return list(dict.fromkeys(b[0] for b in blocks))


def curve(o, viewing, block):
    """Returns the logarithms of the visible differences from the clean picture of a block at the spp of LADDER."""
    _, _, _, clean, sample = block
    pictures = [clean + sample * np.sqrt(1 / n - 1 / CAP) for n in LADDER]
    return np.log(visible_differences(o.program, viewing, [clean, *pictures], 'without' if o.without_worst else SIDE))


def deviation(spp):
    return np.log(np.sqrt(1 / np.minimum(np.asarray(spp, float), CAP - 1) - 1 / CAP))


def stop(values, limit):
    """Returns the first multiple of PASS at which the curve is below a limit."""
    x = deviation(LADDER)
    slope = (values[0] - values[-1]) / (x[0] - x[-1])
    if np.log(limit) >= values[0]:
        at = x[0] + (np.log(limit) - values[0]) / slope
    elif np.log(limit) <= values[-1]:
        at = x[-1] + (np.log(limit) - values[-1]) / slope
    else:
        at = np.interp(np.log(limit), values[::-1], x[::-1])
    spp = 1 / (np.exp(2 * at) + 1 / CAP)
    return int(np.clip(np.ceil(spp / PASS) * PASS, PASS, CAP))


def critical_error(human, stops):
    """Returns the mean over blocks, in %."""
    return np.mean([published.critical_error(h, s, 40) for h, s in zip(human, stops)])


def best(human, choices, stops_of):
    return min(choices, key=lambda c: np.mean([critical_error(human[v], stops_of(v, c)) for v in human]))


def interval(human, limits, stops_of, seed, draws=2000):
    """Returns the central 95 % of the best limit, where viewpoints and their blocks are drawn again with replacement."""
    random = np.random.default_rng(seed)
    errors = [np.array([[critical_error([h], [s]) for h, s in zip(human[v], stops_of(v, limit))] for limit in limits])
              for v in human]
    found = []
    for _ in range(draws):
        views = random.integers(len(errors), size=len(errors))
        total = sum(errors[v][:, random.integers(errors[v].shape[1], size=errors[v].shape[1])].mean(1) for v in views)
        found.append(limits[int(np.argmin(total))])
    return np.percentile(found, [2.5, 97.5])


def correlation(a, b):
    return np.corrcoef(np.log(a), np.log(b))[0, 1] if np.std(np.log(b)) > 0 else float('nan')


def report(o, viewing, blocks):
    views = viewpoints(blocks)
    human = {v: [b[2] for b in blocks if b[0] == v] for v in views}
    curves = {v: [curve(o, viewing, b) for b in blocks if b[0] == v] for v in views}
    limits = np.geomspace(0.2, 300, 150)
    stops_of = lambda v, limit: [stop(c, limit) for c in curves[v]]
    error_with = lambda limit: np.mean([critical_error(human[v], stops_of(v, limit)) for v in views])
    accepted = {v: [np.exp(np.interp(deviation(h), deviation(LADDER)[::-1], c[::-1])) for h, c in zip(human[v], curves[v])
                    if h < CAP] for v in views}
    rows = []
    for v in views:
        others = {w: human[w] for w in views if scene(w) != scene(v)}
        limit = best(others, limits, stops_of)
        stops = stops_of(v, limit)
        rows.append((v, limit, critical_error(human[v], stops), correlation(human[v], stops), np.mean(human[v]), np.mean(stops),
                     np.median(accepted[v]), stops))
    together = correlation(np.concatenate([human[v] for v in views]), np.concatenate([r[-1] for r in rows]))
    every = np.concatenate([accepted[v] for v in views])
    limit = best(human, limits, stops_of)
    low, high = interval(human, limits, stops_of, o.seed)
    print(f'{viewing}: critical error {np.mean([r[2] for r in rows]):.1f} %, correlation of logarithms {together:.2f}, within '
          f'viewpoints {np.mean([r[3] for r in rows]):.2f}; with one limit for all, {limit:.3g} (95 %: {low:.2g} to {high:.2g}), '
          f'{error_with(limit):.1f}; accepted: median '
          f'{np.median(every):.3g}, from {every.min():.3g} to {every.max():.3g}', flush=True)
    ratio = np.exp(np.mean([np.mean(np.log(np.divide(stops_of(v, LIMIT), human[v]))) for v in views]))
    print(f'    with {LIMIT} for all {error_with(LIMIT):.1f} %, predicted / human thresholds {ratio:.2f}', flush=True)
    for v, limit, error, r, h, s, a, _ in rows:
        print(f'    {v:<26} limit of the others {limit:.3g}: {error:.1f} %, correlation of logarithms within {r:.2f}, '
              f'people {h:.0f} spp, predicted {s:.0f}; accepted, median {a:.3g}', flush=True)


def judge_blocks(o):
    blocks = load_blocks(o)
    human = collections.defaultdict(list)
    for b in blocks:
        human[b[0]].append(b[2])
    constants = range(PASS, CAP + 1, PASS)
    print('the best constant of each viewpoint: %.1f %%' % np.mean(
        [min(critical_error(h, [c] * len(h)) for c in constants) for h in human.values()]))
    for viewing in o.viewing.split(';'):
        report(o, viewing, blocks)


if __name__ == '__main__':
    p = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    commands = p.add_subparsers(required=True)
    s = commands.add_parser('sensitivity')
    s.add_argument('program'), s.add_argument('data')
    s.set_defaults(run=sensitivity)
    s = commands.add_parser('blocks')
    s.add_argument('program'), s.add_argument('folder'), s.add_argument('human')
    s.add_argument('--viewing', default=';'.join(f'{cd}cd,{ppd}ppd,250lux' for ppd in (30, 40, 50, 60) for cd in (80, 100, 200)))
    s.add_argument('--seed', type=int, default=1)
    s.add_argument('--without-worst', action='store_true', help='leave out the worst pixels, as `denoised` does')
    s.set_defaults(run=judge_blocks)
    o = p.parse_args()
    o.run(o)
