"""Prints the noise of recorded blocks at the thresholds of observers, by viewpoint: geometric means over blocks, and the
standard deviation of their logarithms. Needs h5py and NumPy.

    python3 levels.py HUMAN.csv DATASET.h5...
"""

import sys

import h5py
import numpy as np


def read_thresholds(path):
    rows = (line.strip().strip(';').split(';') for line in open(path) if line.strip())
    return {row[0]: [int(spp) for spp in row[1:]] for row in rows}


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


def main():
    human = read_thresholds(sys.argv[1])
    views = {}
    for path in sys.argv[2:]:
        with h5py.File(path, 'r') as file:
            for view in file:
                for name in file[view]:
                    threshold = human[view][int(name[len('block_'):])]
                    views.setdefault(view, []).append(np.log(measures(file[view][name], threshold)))
    print('| viewpoint | blocks | mean of masked noise | RMS | peak noise |\n|---|---|---|---|---|')
    cell = lambda values: f'{np.exp(np.mean(values)):.2f} ({np.std(values):.2f})'
    for view, rows in sorted(views.items()):
        print(f'| {view} | {len(rows)} | ' + ' | '.join(cell(c) for c in np.array(rows).T) + ' |')
    means = np.array([np.mean(rows, axis=0) for rows in views.values()])
    print(f'| between viewpoints | {len(means)} | ' + ' | '.join(cell(c) for c in means.T) + ' |')


if __name__ == '__main__':
    main()
