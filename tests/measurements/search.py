"""Trains and judges all combinations of some options of `lull train`, each viewpoint left out in turn.

    python3 search.py GRID F.csv LULL train DATASET.h5... --human HUMAN.csv [options of lull train]

A line of GRID is an option without its dashes, and values: k 4 8 16. A # begins a comment. F.csv and, as Markdown, F.md have
a row for each combination, the largest AUC on the viewpoints left out first, as soon as it is trained; the columns on training
are of the network trained on all viewpoints. With --leave-out or --split instead of viewpoints in turn they are empty. The same
command goes on after an interruption, within a training too, from F.csv and F.csv.search. What cannot be trained has no row.
"""

import csv
import hashlib
import io
import os
import subprocess
import sys
import time

from nested import grid

FIGURES = {  # columns: titles, factors and digits for people
    'auc_left_out': ('AUC left out', 100, 1),
    'accuracy_left_out': ('accuracy left out', 100, 1),
    'auc_training': ('AUC training', 100, 1),
    'accuracy_training': ('accuracy training', 100, 1),
    'critical_error_2': ('critical error at 2 %', 100, 1),
    'early': ('early', 100, 0),
    'late': ('late', 100, 0),
}


def file_text(path):
    return path + ' ' + hashlib.sha256(open(path, 'rb').read()).hexdigest()


def write(path, text):
    with open(path + '.new', 'w', newline='') as f:
        f.write(text)
    os.replace(path + '.new', path)


def train(command, options, path):
    """Returns the figures of a combination, or None if it cannot be trained. `path` begins the names of its files."""
    model, figures = path + '.h5', path + '.csv'
    command = [*command, *options, '-o', model, '--csv', figures, '--quiet']
    if os.path.exists(model + '.checkpoint'):
        command.append('--resume')
    code = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
    if code == 130:
        raise KeyboardInterrupt
    if code == 2:
        raise SystemExit(f"{' '.join(options)}: are no options of lull train")
    if code != 0:
        print(f"{' '.join(options)}: not trained", file=sys.stderr, flush=True)
        return None
    rows = {}
    with open(figures) as f:
        for row in csv.DictReader(f):  # where recordings end too early: at these ends
            if row['viewpoint'] == 'all' and not row['rule'].endswith(', extended'):
                rows[row['rule'].removesuffix(', at least')] = row
    os.remove(figures), os.remove(model)
    test = rows.get('each viewpoint left out') or rows['blocks left out']
    training = rows.get('blocks trained on', {'auc': '', 'accuracy': ''})
    return {'auc_left_out': test['auc'], 'accuracy_left_out': test['accuracy'], 'auc_training': training['auc'],
            'accuracy_training': training['accuracy'], **{c: test[c] for c in ('critical_error_2', 'early', 'late')}}


def write_tables(path, axes, rows):
    rows = sorted(rows, key=lambda row: -float(row['auc_left_out'] or -1))
    text = io.StringIO()
    writer = csv.DictWriter(text, [*axes, *FIGURES, 'seconds'], lineterminator='\n')
    writer.writeheader(), writer.writerows(rows)
    write(path, text.getvalue())
    table = [[*axes, *(title for title, _, _ in FIGURES.values())]]
    for row in rows:
        figures = [f'{float(row[c]) * factor:.{digits}f}' if row[c] else '-' for c, (_, factor, digits) in FIGURES.items()]
        table.append([row[a] for a in axes] + figures)
    lines = ['| ' + ' | '.join(line) + ' |\n' for line in table]
    text = ''.join([lines[0], '|' + '---|' * len(table[0]) + '\n', *lines[1:]])
    write(os.path.splitext(path)[0] + '.md', text)
    return text


def search(grid_file, path, command):
    combinations = grid(open(grid_file).read())
    axes = [option[2:].split('=')[0] for option in combinations[0]]
    if not {'--leave-out', '--split', '--cross-validate'} & set(command):
        command = [*command, '--cross-validate']
    # Results of another search cannot be among those of this one.
    text = '\n'.join(file_text(a) if os.path.isfile(a) else a for a in command[1:]) + '\n' + ' '.join(axes)
    state = path + '.search'
    if (os.path.exists(path) or os.path.exists(state)) and (not os.path.exists(state) or open(state).read() != text):
        raise SystemExit(f'{path}: is not of this search; remove it and {state}, or name another file')
    write(state, text)
    rows = list(csv.DictReader(open(path, newline=''))) if os.path.exists(path) else []
    for options in combinations:
        values = dict(option[2:].split('=', 1) for option in options)
        if any(all(row[a] == values[a] for a in axes) for row in rows):
            continue
        start = time.monotonic()
        figures = train(command, options, path + '.' + '_'.join(options).replace('--', ''))
        if figures:
            rows.append({**values, **figures, 'seconds': f'{time.monotonic() - start:.2f}'})
            write_tables(path, axes, rows)
            print(f'{len(rows)}/{len(combinations)}', file=sys.stderr, flush=True)
    if not rows:
        raise SystemExit(f'{grid_file}: no combination could be trained')
    print(write_tables(path, axes, rows), end='')


if __name__ == '__main__':
    if len(sys.argv) < 5:
        raise SystemExit(__doc__)
    try:
        search(sys.argv[1], sys.argv[2], sys.argv[3:])
    except KeyboardInterrupt:
        raise SystemExit(130)
