#!/usr/bin/env python3
"""Renders the scenes of single plug-ins of pbrt-v3, scenes/NAME.pbrt, with pbrt-v3, and tabulates lull's deviations.

    make.py references PBRT [NAME...]  renders them (those named) into references/NAME.exr
    make.py table PROGRAM [SAMPLES]    runs lull_plugins_tests with SAMPLES (256), writes plugins.csv and prints the ranges

PBRT is a pbrt-v3 whose film has been told to write moments: where the environment variable
PBRT_MOMENTS names a file, each pixel's mean (R, G, B), unbiased variance of one sample and number of
samples, as seven doubles, row by row, for box-filtered pixels. References hold mean and variance as
16-bit floats (R, G, B, variance.R, variance.G, variance.B) and the count as samplesPerPixel.
"""
import csv
import os
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SCENES = sorted(path.stem for path in (HERE / 'scenes').glob('*.pbrt'))
SIZE = 32


def write_exr(path, pixels, samples):
    """Writes rows of (R, G, B, their variances) as 16-bit floats, not compressed."""
    names = {'B': 2, 'G': 1, 'R': 0, 'variance.B': 5, 'variance.G': 4, 'variance.R': 3}
    height, width = len(pixels), len(pixels[0])

    def attribute(name, kind, data):
        return name.encode() + b'\0' + kind.encode() + b'\0' + struct.pack('<i', len(data)) + data
    box = struct.pack('<4i', 0, 0, width - 1, height - 1)
    channels = b''.join(n.encode() + b'\0' + struct.pack('<iB3xii', 1, 0, 1, 1) for n in names) + b'\0'
    head = struct.pack('<ii', 20000630, 2) + attribute('channels', 'chlist', channels) + \
        attribute('compression', 'compression', b'\0') + attribute('dataWindow', 'box2i', box) + \
        attribute('displayWindow', 'box2i', box) + attribute('lineOrder', 'lineOrder', b'\0') + \
        attribute('pixelAspectRatio', 'float', struct.pack('<f', 1)) + \
        attribute('samplesPerPixel', 'int', struct.pack('<i', samples)) + \
        attribute('screenWindowCenter', 'v2f', struct.pack('<2f', 0, 0)) + \
        attribute('screenWindowWidth', 'float', struct.pack('<f', 1)) + b'\0'
    rows = []
    for y, row in enumerate(pixels):
        data = b''.join(struct.pack(f'<{width}e', *(pixel[c] for pixel in row)) for c in names.values())
        rows.append(struct.pack('<ii', y, len(data)) + data)
    start = len(head) + 8 * height
    offsets = [start + sum(map(len, rows[:y])) for y in range(height)]
    with open(path, 'wb') as file:
        file.write(head + struct.pack(f'<{height}q', *offsets) + b''.join(rows))


def render_reference(pbrt, name):
    with tempfile.TemporaryDirectory() as scratch:
        moments = os.path.join(scratch, 'moments')
        subprocess.run([pbrt, '--nthreads', '1', '--quiet', '--outfile', os.path.join(scratch, 'o.pfm'), HERE / f'scenes/{name}.pbrt'],
                       check=True, env={**os.environ, 'PBRT_MOMENTS': moments})
        with open(moments, 'rb') as file:
            values = list(struct.iter_unpack('<7d', file.read()))
    write_exr(HERE / f'references/{name}.exr', [values[y * SIZE:(y + 1) * SIZE] for y in range(SIZE)], int(values[0][6]))


def write_table(program, samples):
    output = subprocess.run([program, '--gtest_filter=*LookAsInPbrt*'], stdout=subprocess.PIPE, text=True,
                            env={**os.environ, 'LULL_PLUGIN_SAMPLES': samples}).stdout
    found = {}
    for name, estimator, ratio, sigma, pixels, tiles in re.findall(
            r'^(\S+) +(pbrt-v3|combined) +energy (\S+) \((\S+) sigma\), pixels out (\S+) %, tiles out (\S+) %$',
            output, re.M):
        found.setdefault(name, {})[estimator] = (ratio, sigma, pixels, tiles)
    missing = set(SCENES) - set(found)
    if missing:
        sys.exit('not in the output: ' + ' '.join(sorted(missing)))
    table = HERE / 'plugins.csv'
    with open(table, newline='') as file:
        columns, *old = csv.reader(file)
    shown = {row[1]: row[0] for row in old}
    rows = [[shown.get(name, name.replace('-', ' ', 1)), name, *by['pbrt-v3'], *by['combined']] for name, by in sorted(found.items())]
    with open(table, 'w', newline='') as file:
        csv.writer(file, lineterminator='\n').writerows([columns, *rows])
    for column in range(2, len(columns)):
        values = [float(row[column]) for row in rows]
        print(f'{columns[column]}: {min(values)} to {max(values)}, {len(rows)} scenes, {samples} spp')


def main():
    if len(sys.argv) > 2 and sys.argv[1] == 'references':
        for name in sys.argv[3:] or SCENES:
            print(name, flush=True)
            render_reference(sys.argv[2], name)
    elif len(sys.argv) in (3, 4) and sys.argv[1] == 'table':
        write_table(sys.argv[2], (sys.argv[3:] or ['256'])[0])
    else:
        sys.exit(__doc__)


main()
