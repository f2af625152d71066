"""Runs the `lull evaluate` and `lull train --cross-validate` commands of the documents on the shipped data sets, and
compares their output with the text that follows them.

    python3 figures.py LULL            # compares all but the trainings; prints differences, and fails
    python3 figures.py LULL --write    # runs all, and replaces the outputs and figures in the documents

Numbers may differ by 0.3 or 2 %: other processors round differently, and a block may stop a check earlier.

A command is an indented line, or several with \\ at their ends, that begins with "lull evaluate" or "lull train"; its
output is the fenced block that follows it. Commands run in stopping/data. A figure elsewhere names the block that it
repeats: `<!--LABEL:COLUMN-->` after it, with `<!--output:LABEL:ROW-->` after the fenced block of that row, `_` for blanks. It
may be rounded.
"""

import argparse
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = ['tests/measurements/models.md', 'stopping/docs/paper.md', 'README.md']
COMMAND = re.compile(r'^((?:    .*\\\n)*    lull (?:evaluate|train) [^\n]*(?:(?<=\\)\n    [^\n]*)*)\n\n```text\n(.*?)```\n', re.M | re.S)
OUTPUT = re.compile(r'<!--output:([\w-]+):(\S*)-->')
FIGURE = re.compile(r'([0-9.-]+)(\**(?: %)?<!--([\w-]+):([^>]*)-->)')


def run(lull, command):
    """Returns the output of a command, without the talk on stderr."""
    line = re.sub(r'^ *lull', shlex.quote(lull), command.replace('\\\n', ' '))
    result = subprocess.run(line, shell=True, cwd=ROOT / 'stopping' / 'data', capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(f'{command.strip()}: {result.stderr.strip()}')
    return re.sub(r' +$', '', result.stdout, flags=re.M)


def agree(documented, printed):
    """Returns whether two texts are the same but for small differences of numbers."""
    number = re.compile(r'-?\d+(?:\.\d+)?')
    if number.sub('#', documented).split() != number.sub('#', printed).split():
        return False
    pairs = zip(map(float, number.findall(documented)), map(float, number.findall(printed)))
    return all(abs(a - b) <= max(0.3, 0.02 * abs(a)) for a, b in pairs)


def cell(output, row, column):
    """Returns the number in a row, whose first words are given, below the heading of a column."""
    heading = None
    for line in output.split('\n'):
        if re.search(r'\s' + re.escape(column) + r'(\s|$)', line):
            heading = line
        elif heading and line.startswith(row):
            end = heading.index(' ' + column) + 1 + len(column)
            return line[:end].split()[-1]
    raise RuntimeError(f'no row {row!r} with a column {column!r}')


def rounded(value, like):
    """Returns a number with as many decimals as another has; other texts, such as intervals, as they are."""
    try:
        return f'{float(value):.{len(like.partition(".")[2])}f}'
    except ValueError:
        return value


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('lull')
    parser.add_argument('--write', action='store_true')
    options = parser.parse_args()
    options.lull = str(pathlib.Path(options.lull).resolve())
    texts = {name: (ROOT / name).read_text() for name in DOCUMENTS}
    wrong, known, commands = [], {}, 0
    for name, text in texts.items():
        def replace(match):
            nonlocal commands
            runs = ' lull train ' not in match[1] or options.write
            commands += runs
            output = run(options.lull, match[1]) if runs else match[2]
            labels = re.match(r'(?:<!--.*?-->\n)*', text[match.end():])[0]
            for label, row in OUTPUT.findall(labels):
                known[label] = output if options.write else match[2], row.replace('_', ' ')
            if not agree(match[2], output):
                wrong.append(f'{name}: {match[1].strip()}\n--- documented\n{match[2]}--- printed\n{output}')
            return f'{match[1]}\n\n```text\n{output}```\n'
        texts[name] = COMMAND.sub(replace, text)
    for name, text in texts.items():
        for number, _, label, column in FIGURE.findall(text):
            value = cell(*known[label], column) if label in known else None
            if value is None or rounded(value, number) != number:
                wrong.append(f'{name}: {number} is not {label}:{column}, {value}')
    if options.write:
        for name, text in texts.items():
            (ROOT / name).write_text(FIGURE.sub(
                lambda f: rounded(cell(*known[f[3]], f[4]) if f[3] in known else f[1], f[1]) + f[2], text))
        return 0
    if not commands:
        wrong.append('no command was found')
    print('\n'.join(wrong) if wrong else f'{commands} commands print what the documents say')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
