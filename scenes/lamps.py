#!/usr/bin/env python3
"""Writes a scene of many lamps to the standard output: `python3 scenes/lamps.py 100000 > lamps.pbrt`.

A floor lies under small emitting spheres of all colours; with `--triangles` an emitting ceiling of
so many triangles in waves takes their place. All the light together is the same for any number.
The camera looks at the floor from below the lamps, so that all noise is of direct light.
"""

import argparse
import math
import random

HEAD = """LookAt 0 .9 -9  0 0 -7.5  0 1 0
Camera "perspective" "float fov" [40]
Film "image" "integer xresolution" [100] "integer yresolution" [100]
  "string filename" "lamps.exr"
Sampler "random" "integer pixelsamples" [16]
Integrator "path" "integer maxdepth" [5]
WorldBegin
Material "matte" "rgb Kd" [.6 .6 .6]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point P" [-20 0 -20  20 0 -20  20 0 20  -20 0 20]"""

HALF = 10  # of the side of the lamps' square


def write_spheres(count):
    numbers = random.Random(count)
    radius = .03
    brightness = 9000 / count
    for _ in range(count):
        x, z = numbers.uniform(-HALF, HALF), numbers.uniform(-HALF, HALF)
        y = numbers.uniform(1, 3)
        color = ' '.join(f'{numbers.uniform(.2, 1) * brightness:.5g}' for _ in range(3))
        print(f'AttributeBegin Translate {x:.5f} {y:.5f} {z:.5f} '
              f'AreaLightSource "diffuse" "rgb L" [{color}] '
              f'Shape "sphere" "float radius" [{radius}] AttributeEnd')


def write_ceiling(count):
    side = max(1, math.isqrt((count + 1) // 2))
    points, indices = [], []
    for j in range(side + 1):
        for i in range(side + 1):
            x, z = (2 * HALF * k / side - HALF for k in (i, j))
            points.append(f'{x:.5f} {2 + .5 * math.sin(3 * x) * math.cos(2 * z):.5f} {z:.5f}')
    for j in range(side):
        for i in range(side):
            a = j * (side + 1) + i
            b = a + side + 1
            indices.append(f'{a} {a + 1} {b} {a + 1} {b + 1} {b}')
    print('AttributeBegin AreaLightSource "diffuse" "rgb L" [.3 .25 .2]')
    print('Shape "trianglemesh" "integer indices" [')
    print('\n'.join(indices))
    print('] "point P" [')
    print('\n'.join(points))
    print('] AttributeEnd')


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument('count', type=int, help='how many lamps')
parser.add_argument('--triangles', action='store_true', help='a ceiling of triangles')
arguments = parser.parse_args()
print(HEAD)
(write_ceiling if arguments.triangles else write_spheres)(arguments.count)
print('WorldEnd')
