"""Chooses a model's options inside the folds: each scene is judged by a network whose options were chosen, and which was
trained, on the others. A scene is a viewpoint, or all whose names begin with a text of --together.

    python3 nested.py LULL HUMAN.csv DATASET.h5... [--grid "mask 24 40 1e9; nearness 0.25 0.35"] [--keep FOLDER]

Options are chosen by the critical error at 2 % with recordings extended, each of the other viewpoints left out in turn. Results
are kept in FOLDER, and existing ones are not trained again.
"""

import argparse
import csv
import itertools
import os
import subprocess


def train(o, name, *options):
    """Returns the figures of a training by viewpoint, with recordings extended."""
    path = os.path.join(o.keep, name + '.csv')
    if not os.path.exists(path):
        command = [o.lull, 'train', *o.data, '--human', o.human, '--quiet', '--threads', '1', '--csv', path + '.new', *options]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(' '.join(command) + '\n' + done.stderr)
        os.replace(path + '.new', path)
    with open(path) as f:
        rows = [r for r in csv.DictReader(f) if 'trained on' not in r['rule'] and 'at least' not in r['rule']]
    return {r['viewpoint']: r for r in rows}


def grid(text):
    """Returns the combinations as lists of options, from lines, or what is between semicolons: `mask 24 40 # a comment`."""
    axes = [axis for line in text.replace(';', '\n').splitlines() if (axis := line.split('#')[0].split())]
    names = [axis[0] for axis in axes]
    for name, *values in axes:
        if names.count(name) > 1 or not values or len(set(values)) < len(values):
            raise SystemExit(f"the grid: '{name}' has no values, or something comes twice")
    if not axes:
        raise SystemExit('the grid has no option to vary; a line is, for example, k 4 8 16')
    return [[f'--{name}={value}' for name, value in zip(names, values)] for values in itertools.product(*(a[1:] for a in axes))]


def error(rows):
    return float(rows['all']['critical_error_2'])


def nested(o):
    combinations = grid(o.grid)
    name = lambda options: '_'.join(options).replace('--', '')
    together = lambda left: [f'--together={t}' for t in o.together if not any(v.startswith(t) for v in left)]
    every = {name(c): train(o, 'all_' + name(c), '--cross-validate', *together([]), *c) for c in combinations}
    scenes = {}
    for v in (v for v in next(iter(every.values())) if v != 'all'):
        scenes.setdefault(next((t for t in o.together if v.startswith(t)), v), []).append(v)
    total = []
    for scene, views in scenes.items():
        without = [f'--without={v}' for v in views]
        best = min(combinations, key=lambda c: error(train(o, f'not_{scene}_{name(c)}', *without, '--cross-validate',
                                                           *together(views), *c)))
        out = [f'--leave-out={v}' for v in views]
        rows = train(o, f'left_{scene}_{name(best)}', *out, '-o', os.path.join(o.keep, 'model.h5'), *best)
        for v in views:
            row = rows[v]
            total.append(row)
            print(f"{v}: {' '.join(best)}: {100 * float(row['critical_error_2']):.1f} %, early {100 * float(row['early']):.0f} %, "
                  f"late {100 * float(row['late']):.0f} %", flush=True)
    mean = lambda key: 100 * sum(float(r[key]) for r in total) / len(total)
    print(f"chosen inside the folds: {mean('critical_error_2'):.1f} %, early {mean('early'):.0f} %, late {mean('late'):.0f} %, "
          f"AUC {mean('auc'):.1f}")
    for c in sorted(combinations, key=lambda c: error(every[name(c)]))[:5]:
        r = every[name(c)]['all']
        print(f"chosen by all: {' '.join(c)}: {100 * float(r['critical_error_2']):.1f} %, early {100 * float(r['early']):.0f} %, "
              f"late {100 * float(r['late']):.0f} %")


if __name__ == '__main__':
    p = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    p.add_argument('lull'), p.add_argument('human'), p.add_argument('data', nargs='+')
    p.add_argument('--grid', default='nearness 0.25 0.35; peak-limit 1.1 1.3')
    p.add_argument('--together', action='append', default=[])
    p.add_argument('--keep', default='nested')
    o = p.parse_args()
    os.makedirs(o.keep, exist_ok=True)
    nested(o)
