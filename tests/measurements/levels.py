"""Prints the noise of recorded blocks at the thresholds of observers, by viewpoint: geometric means over blocks, and the
standard deviation of their logarithms; then the masked noise by kinds of blocks, its sub-blocks pooled in several ways, with the
standard deviations within viewpoints. Needs h5py and NumPy.

    python3 levels.py HUMAN.csv DATASET.h5...
"""

import sys

import h5py
import numpy as np

from published import read

NO_NOISE = 0.05  # L*; blocks with less, such as a plain sky, say nothing of what people accept


def at(block, spp):
    """Returns a function that reads a channel at the record nearest to a sample count."""
    index = int(np.argmin(np.abs(np.log(block['spp'][:] / spp))))
    return lambda channel: np.asarray(block[channel][index], dtype=float)


def measures(block, human):
    """Mean and RMS over sub-blocks of the masked noise, and the peak noise, in L*."""
    now = at(block, human)
    masked = now('masked_noise')
    if 'peak_noise' in block:
        peak = now('peak_noise')
    else:  # as if noise were bell-shaped in each sub-block, a lower bound
        noise = now('noise')
        peak = 3 ** 0.25 * now('half_noise') * np.where(noise > 0, np.minimum(1, masked / np.maximum(noise, 1e-12)), 1)
    return masked.mean(), np.sqrt((masked ** 2).mean()), (peak ** 4).mean() ** 0.25


# Kinds of blocks, by the means over sub-blocks of lightness and texture in L*; a block can be of two.
KINDS = {'all': lambda lightness, texture: True, 'dark (L* below 30)': lambda lightness, texture: lightness < 30,
         'bright (L* above 80)': lambda lightness, texture: lightness > 80, 'smooth (texture below 2)': lambda lightness, texture: texture < 2,
         'between': lambda lightness, texture: 2 <= texture < 5, 'textured (texture above 5)': lambda lightness, texture: texture >= 5}
POOLS = {'mean': np.mean, 'RMS': lambda x: (x ** 2).mean() ** 0.5, '4th power': lambda x: (x ** 4).mean() ** 0.25,
         '75 %': lambda x: np.quantile(x, 0.75), '95 %': lambda x: np.quantile(x, 0.95), 'largest': np.max}


def within(values, groups):
    """Standard deviation from the means of groups, each block as one degree of freedom less."""
    means = {g: np.mean([v for v, h in zip(values, groups) if h == g]) for g in set(groups)}
    freedom = len(values) - len(means)
    return np.sqrt(sum((v - means[g]) ** 2 for v, g in zip(values, groups)) / freedom) if freedom > 0 else 0


def print_kinds(blocks):
    """Blocks are tuples of viewpoint, lightness, texture and the masked noise of sub-blocks."""
    print('\n| kind | blocks | ' + ' | '.join(POOLS) + ' |\n|---|---|' + '---|' * len(POOLS))
    for kind, is_one in KINDS.items():
        found = [b for b in blocks if is_one(b[1], b[2])]
        views = [b[0] for b in found]
        cells = []
        for pool in POOLS.values():
            values = [np.log(pool(b[3])) for b in found]
            cells.append(f'{np.exp(np.mean(values)):.2f} ({within(values, views):.2f})')
        print(f'| {kind} | {len(found)} | ' + ' | '.join(cells) + ' |')


def main():
    human = read(sys.argv[1])
    views, blocks = {}, []
    for path in sys.argv[2:]:
        with h5py.File(path, 'r') as file:
            for view in file:
                for name in file[view]:
                    threshold = human[view][int(name[len('block_'):])]
                    now = at(file[view][name], threshold)
                    if now('masked_noise').mean() < NO_NOISE:
                        continue
                    views.setdefault(view, []).append(np.log(measures(file[view][name], threshold)))
                    blocks.append((view, now('lightness').mean(), now('texture').mean(), now('masked_noise')))
    print('| viewpoint | blocks | mean of masked noise | RMS | peak noise |\n|---|---|---|---|---|')
    cell = lambda values: f'{np.exp(np.mean(values)):.2f} ({np.std(values):.2f})'
    for view, rows in sorted(views.items()):
        print(f'| {view} | {len(rows)} | ' + ' | '.join(cell(c) for c in np.array(rows).T) + ' |')
    means = np.array([np.mean(rows, axis=0) for rows in views.values()])
    print(f'| between viewpoints | {len(means)} | ' + ' | '.join(cell(c) for c in means.T) + ' |')
    print_kinds(blocks)


if __name__ == '__main__':
    main()
