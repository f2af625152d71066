"""Prints the critical errors, at a margin of 2 %, of the thresholds that the networks of Buisine et al. (2021) predicted:
over all blocks, over those that the networks were trained on, and over the others. For comparison, the error of one
sample count per viewpoint, chosen with its human thresholds.

    python3 published.py ../../stopping/data
"""

import pathlib
import sys

import numpy as np

CAP, MARGIN = 10000, 100  # spp; the band of 2 % is 200 spp wide


def read(path):
    rows = (line.strip().strip(';').split(';') for line in open(path) if line.strip())
    return {row[0]: [int(value) for value in row[1:]] for row in rows}


def critical_error(human, stop, grid):
    """Returns the percentage of sample counts at which the decision is wrong (docs/paper.md, 9)."""
    low, high = (CAP, CAP) if human >= CAP else (human - MARGIN, human + MARGIN)
    x = np.arange(20, CAP + 1, grid)
    right = ((x <= low) & (x <= stop)) | ((x >= high) & (x >= stop)) | ((low < x) & (x < high))
    return 100 * (1 - right.mean())


def main():
    folder = pathlib.Path(sys.argv[1])
    human, training = read(folder / 'human.csv'), read(folder / 'training-blocks.csv')
    for file, grid in (('svd-entropy-rnn.csv', 40), ('26-attributes-rnn.csv', 20)):
        stops = read(folder / file)
        for name, is_meant in (('all blocks', lambda view, block: True),
                               ('training blocks', lambda view, block: block in training[view]),
                               ('other blocks', lambda view, block: block not in training[view])):
            print('%-22s %-16s %6.2f' % (file, name, np.mean([
                np.mean([critical_error(human[view][b], stops[view][b], grid)
                         for b in range(len(human[view])) if is_meant(view, b)]) for view in human])))
    counts = range(20, CAP + 1, 80)
    errors = [min(np.mean([critical_error(t, n, 40) for t in thresholds]) for n in counts) for thresholds in human.values()]
    print('%-22s %-16s %6.2f' % ('one count', 'known', np.mean(errors)))


if __name__ == '__main__':
    main()
