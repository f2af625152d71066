"""Prints the critical errors, at a margin of 2 %, of the thresholds that the networks of Buisine et al. (2021) predicted:
over all blocks, over those that the networks were trained on, and over the others. For comparison, the errors of one
sample count per viewpoint (chosen with its human thresholds), and of one for each viewpoint that is best for all others.

    python3 published.py ../../stopping/data
"""

import pathlib
import sys

CAP, MARGIN = 10000, 100  # spp; the band of 2 % is 200 spp wide


def read(path):
    rows = (line.strip().strip(';').split(';') for line in open(path) if line.strip())
    return {row[0]: [int(value) for value in row[1:]] for row in rows}


def critical_error(human, stop, grid):
    """Returns the percentage of sample counts at which the decision is wrong (docs/paper.md, 9)."""
    low, high = (CAP, CAP) if human >= CAP else (human - MARGIN, human + MARGIN)
    counts = range(20, CAP + 1, grid)
    right = sum((x <= low and x <= stop) or (x >= high and x >= stop) or low < x < high for x in counts)
    return 100 * (1 - right / len(counts))


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def main():
    folder = pathlib.Path(sys.argv[1])
    human, training = read(folder / 'human.csv'), read(folder / 'training-blocks.csv')
    for file, grid in (('svd-entropy-rnn.csv', 40), ('26-attributes-rnn.csv', 20)):
        stops = read(folder / file)
        for name, is_meant in (('all blocks', lambda view, block: True),
                               ('training blocks', lambda view, block: block in training[view]),
                               ('other blocks', lambda view, block: block not in training[view])):
            print('%-22s %-16s %6.2f' % (file, name, mean(
                mean(critical_error(human[view][b], stops[view][b], grid)
                     for b in range(len(human[view])) if is_meant(view, b)) for view in human)))
    counts = range(20, CAP + 1, 80)
    errors = {view: [mean(critical_error(t, n, 40) for t in human[view]) for n in counts] for view in human}
    sums = [sum(column) for column in zip(*errors.values())]
    others = {view: min(range(len(counts)), key=lambda i, view=view: sums[i] - errors[view][i]) for view in human}
    print('%-22s %-16s %6.2f' % ('one count', 'known', mean(min(e) for e in errors.values())))
    print('%-22s %-16s %6.2f' % ('one count', 'of others', mean(errors[view][i] for view, i in others.items())))


if __name__ == '__main__':
    main()
