#!/usr/bin/env python3
"""Writes scenes that show one plug-in of pbrt-v3 each, and pbrt-v3's own renders of them.

    make.py scenes                     writes scenes/NAME.pbrt and the images they use
    make.py references PBRT [NAME...]  renders them (those named) into references/NAME.exr
    make.py table PROGRAM [SAMPLES]    runs lull_plugins_tests with SAMPLES (256), writes plugins.csv and prints the ranges

PBRT is a pbrt-v3 whose film has been told to write moments: where the environment variable
PBRT_MOMENTS names a file, each pixel's mean (R, G, B), unbiased variance of one sample and number of
samples, as seven doubles, row by row, for box-filtered pixels. References hold mean and variance as
16-bit floats (R, G, B, variance.R, variance.G, variance.B) and the count as samplesPerPixel.
"""
import csv
import math
import os
import random
import re
import struct
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, '..', '..', 'scenes'))
from make import write_png  # noqa: E402

SIZE = 32
SAMPLES = 4096


def scene(world, camera='LookAt 0 -5 2.2  0 0 0.4  0 0 1\nCamera "perspective" "float fov" 38',
          integrator='"path"', depth=5, samples=SAMPLES):
    return f'''Film "image" "integer xresolution" {SIZE} "integer yresolution" {SIZE} "string filename" "o.pfm"
Sampler "random" "integer pixelsamples" {samples}
Integrator {integrator} "integer maxdepth" {depth}
{camera}
WorldBegin
{world.strip()}
WorldEnd
'''


SKY = '''LightSource "infinite" "rgb L" [.5 .6 .7]
LightSource "point" "point from" [2 -3 4] "rgb I" [16 14 12]
'''
QUAD = '"integer indices" [0 1 2 0 2 3] "float uv" [0 0 1 0 1 1 0 1]'
FLOOR = f'''Texture "board" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8
  "rgb tex1" [.7 .6 .5] "rgb tex2" [.2 .3 .4]
Material "matte" "texture Kd" "board"
Shape "trianglemesh" {QUAD} "point P" [-3 -3 0  3 -3 0  3 3 0  -3 3 0]
'''
PATTERN = '''Texture "pattern" "spectrum" "checkerboard" "float uscale" 6 "float vscale" 4
  "rgb tex1" [.8 .3 .2] "rgb tex2" [.2 .4 .8]
Material "matte" "texture Kd" "pattern"
'''


def shape(text, transform='', before=PATTERN):
    return scene(SKY + FLOOR + f'AttributeBegin\n{before}{transform}\n{text}\nAttributeEnd')


def texture(kind, parameters='', type='spectrum'):
    """Shows a texture on a wall and a ball."""
    return scene(SKY + f'''AttributeBegin
Scale 3 3 3
Texture "t" "{type}" "{kind}" {parameters}
Texture "k" "spectrum" "scale" "rgb tex1" [.7 .6 .5] "texture tex2" "t"
Texture "s" "spectrum" "mix" "rgb tex1" [.1 .2 .3] "texture tex2" "k" "float amount" .7
Material "matte" "texture Kd" "s"
AttributeEnd
'''.replace('AttributeEnd\n', '') + f'''Shape "trianglemesh" {QUAD} "point P" [-1 -1 0  1 -1 0  1 1 0  -1 1 0]
Translate 0 0 .18
Shape "sphere" "float radius" .2
AttributeEnd''')


def material(text, extra=''):
    return scene(SKY + '''LightSource "distant" "point from" [-2 -3 2] "rgb L" [1 .8 .6]
''' + FLOOR + f'''AttributeBegin
Translate 0 0 .9
{text}
Shape "sphere" "float radius" .9
AttributeEnd
''' + extra)


def grid_medium():
    n = 6
    rng = random.Random(1)
    values = ' '.join(f'{4 * rng.random() ** 2:.3f}' for _ in range(n ** 3))
    return f'''MakeNamedMedium "m" "string type" "heterogeneous" "integer nx" {n} "integer ny" {n}
  "integer nz" {n} "point p0" [-1 -1 0] "point p1" [1 1 2] "rgb sigma_a" [.2 .2 .2]
  "rgb sigma_s" [.9 .9 .9] "float g" .3 "float density" [{values}]
'''


BOX = '''Shape "trianglemesh" "integer indices" [0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7]
  "point P" [-1 -1 .02 1 -1 .02 1 1 .02 -1 1 .02 -1 -1 1.98 1 -1 1.98 1 1 1.98 -1 1 1.98]
'''


def fur(strands, length, width):
    """Lets strands grow out of a ball of radius 0.6 above the floor, bent to one side."""
    rng = random.Random(2)
    text = ''
    for _ in range(strands):
        z, phi = rng.uniform(-.9, 1), rng.uniform(0, 2 * math.pi)
        out = [math.sqrt(1 - z * z) * math.cos(phi), math.sqrt(1 - z * z) * math.sin(phi), z]
        bend = [rng.gauss(.5, .3), rng.gauss(0, .3), rng.gauss(-.5, .3)]
        points = ' '.join(f'{.6 * o + length * t * o + length * t * t * b + (.9 if axis == 2 else 0):.3f}'
                          for t in (0, 1 / 3, 2 / 3, 1) for axis, (o, b) in enumerate(zip(out, bend)))
        text += f'Shape "curve" "point P" [{points}] "float width0" {width} "float width1" {width / 4}\n'
    return text


LAMP = '''AttributeBegin
AreaLightSource "diffuse" "rgb L" [9 8 7]
Translate 1.6 -1.5 2.6
Shape "sphere" "float radius" .35
AttributeEnd
'''
SHAPES = {
    'cylinder': shape('Shape "cylinder" "float radius" .7 "float zmin" -.6 "float zmax" .9 "float phimax" 280',
                      'Translate 0 0 .6\nRotate 20 1 .3 0'),
    'cone': shape('Shape "cone" "float radius" .9 "float height" 1.6 "float phimax" 300', 'Rotate 200 0 0 1'),
    'paraboloid': shape('Shape "paraboloid" "float radius" .9 "float zmin" .1 "float zmax" 1.3', 'Rotate 10 1 0 0'),
    'hyperboloid': shape('Shape "hyperboloid" "point p1" [.9 .2 -.8] "point p2" [.2 .9 .8] "float phimax" 320',
                         'Translate 0 0 .8'),
    'heightfield': shape('''Shape "heightfield" "integer nu" 4 "integer nv" 3
  "float Pz" [.1 .5 .2 .7  .6 .1 .9 .3  .2 .8 .4 .1]''', 'Scale 2.4 2 1\nTranslate -.5 -.5 .1'),
    'curve': shape('''Shape "curve" "point P" [-1.2 0 .2  -.9 .3 1.9  -.2 -.6 1.6  -.5 .1 .3] "float width0" .3 "float width1" .1
Shape "curve" "string type" "cylinder" "string basis" "bspline" "integer splitdepth" 2 "float width" .25
  "point P" [-.6 -.5 -.6  -.2 -.4 .4  .2 .2 1.4  .5 -.3 1.2  .2 -.8 .5  .5 -.9 -.9]
Shape "curve" "string type" "ribbon" "integer degree" 2 "integer splitdepth" 0 "float width0" .5 "float width1" 0
  "point P" [.9 -.5 .1  1.3 .2 .9  .7 0 1.7  .1 -.2 2.4  -.6 .3 1.9] "normal N" [0 -1 0  .4 -1 .3  1 -.3 .2]
Shape "curve" "string type" "ribbon" "string basis" "bspline" "integer degree" 2 "float width" .2
  "point P" [1 -.9 .1  1 -.4 .6  .2 -1 .7  -.9 -.8 .2  -1.5 -1 0] "normal N" [.3 -1 .1  0 -1 .9  .2 -.2 1  -.3 -.5 1]''',
                   'Rotate 10 .2 1 .3\nScale 1.1 1.1 1.1'),
    # Widths and sides are those before the transform.
    'curve-stretched': shape('''Shape "curve" "point P" [-.8 0 .2  -.9 .3 1.3  -.2 -.6 1.1  -.5 .1 .3] "float width" .3
Shape "curve" "string type" "cylinder" "point P" [0 0 .1  .1 .3 1.5  .6 -.6 1.2  .4 .1 .3] "float width" .3
Shape "curve" "string type" "ribbon" "point P" [.9 0 .2  1 -.4 1.3  .2 -.6 1.1  -.6 -.7 .3] "float width" .2
  "normal N" [.3 -1 0  -.1 -1 .9]''', 'Scale -1 1.5 1.2'),
    'nurbs': shape('''Shape "nurbs" "integer nu" 4 "integer nv" 4 "integer uorder" 4 "integer vorder" 3
  "float uknots" [0 0 0 0 1 1 1 1] "float vknots" [0 0 0 .5 1 1 1]
  "point P" [-1 -1 .2  -.3 -1 .9  .3 -1 .1  1 -1 .6  -1 -.3 1  -.3 -.3 .2  .3 -.3 1.6  1 -.3 .3
             -1 .3 .3  -.3 .3 1.4  .3 .3 .3  1 .3 1  -1 1 .8  -.3 1 .3  .3 1 .9  1 1 .2]''', 'Rotate 15 0 0 1'),
}
SCENES = {
    'camera-orthographic': scene(SKY + FLOOR + 'Translate 0 0 1\nShape "sphere" "float radius" .8', '''LookAt 0 -5 3  0 0 .5  0 0 1
Camera "orthographic" "float screenwindow" [-2 2 -1.6 1.9] "float lensradius" .3 "float focaldistance" 5.8'''),
    'camera-environment': scene(SKY + FLOOR + 'Translate 0 1.6 1\nShape "sphere" "float radius" .8', '''LookAt 0 0 1  1 2 .7  0 0 1
Camera "environment"'''),
    # Wide open, so that light is lost towards the corners.
    'camera-realistic': scene(SKY + FLOOR + 'Translate .9 -1.2 .6\nShape "sphere" "float radius" .6', '''LookAt 0 -5 2.2  0 0 0.4  0 0 1
Camera "realistic" "string lensfile" "lens.dat" "float aperturediameter" 17 "float focusdistance" 4''', samples=2048),
    'camera-realistic-exposed': scene(SKY + FLOOR + 'Translate .9 -1.2 .6\nShape "sphere" "float radius" .6', '''LookAt 0 -5 2.2  0 0 0.4  0 0 1
Camera "realistic" "string lensfile" "lens.dat" "float aperturediameter" 6 "bool simpleweighting" "false"
  "float focusdistance" 5 "float shutteropen" .1 "float shutterclose" .6''', samples=2048),
    'texture-bilerp': texture('bilerp', '"rgb v00" [1 0 0] "rgb v01" [0 1 0] "rgb v10" [0 0 1] "rgb v11" [1 1 1]'),
    'texture-uv': texture('uv', '"float uscale" 3 "float vscale" 2 "float udelta" .3'),
    'texture-dots': texture('dots', '"float uscale" 7 "float vscale" 5 "rgb inside" [1 .2 .1] "rgb outside" [.1 .3 .9]'),
    'texture-windy': texture('windy'),
    'texture-wrinkled': texture('wrinkled', '"integer octaves" 5 "float roughness" .6'),
    'light-goniometric': scene('''AttributeBegin
Translate .2 -.3 1.6
Rotate 30 1 0 0
LightSource "goniometric" "string mapname" "beam.png" "rgb I" [9 8 7]
AttributeEnd
''' + FLOOR + 'Translate 0 1 1\nShape "sphere" "float radius" .7'),
    'light-projection': scene('''AttributeBegin
Translate .2 -2.3 2.6
Rotate -125 1 .1 0
LightSource "projection" "string mapname" "beam.png" "rgb I" [30 28 26] "float fov" 40
AttributeEnd
LightSource "infinite" "rgb L" [.05 .05 .05]
''' + FLOOR + 'Translate 0 .7 .7\nShape "sphere" "float radius" .7'),
    'light-cylinder': scene(FLOOR + '''AttributeBegin
AreaLightSource "diffuse" "rgb L" [6 5 4]
Translate -.4 0 1.2
Rotate 80 .3 1 0
Shape "cylinder" "float radius" .25 "float zmin" -.8 "float zmax" .7 "float phimax" 250
AttributeEnd
Translate .9 .6 .5
Shape "sphere" "float radius" .5'''),
    'material-none': scene(SKY + LAMP + FLOOR + '''AttributeBegin
Material "none"
Translate 0 0 1
Shape "sphere" "float radius" 1.1
AttributeEnd
Material "metal" "float roughness" .1
Translate 0 0 .7
Shape "sphere" "float radius" .5'''),
    'material-disney': material('''Material "disney" "rgb color" [.8 .4 .2] "float metallic" .3 "float roughness" .35 "float speculartint" .4
  "float anisotropic" .6 "float sheen" .7 "float sheentint" .3 "float clearcoat" .8 "float clearcoatgloss" .6'''),
    'material-disney-glass': material('Material "disney" "rgb color" [.9 .8 .7] "float spectrans" .8 "float roughness" .4 "float eta" 1.4'),
    'material-disney-below': material('''Material "disney" "rgb color" [.9 .6 .4] "rgb scatterdistance" [.6 .3 .15] "float roughness" .4
  "float eta" 1.4 "float clearcoat" .3'''),
    'material-disney-thin': material('''Material "disney" "bool thin" "true" "rgb color" [.6 .8 .5] "float difftrans" 1.2 "float flatness" .5
  "float clearcoat" .5 "float roughness" .3'''),
    'material-hair': material('Material "hair" "float eumelanin" .4 "float beta_m" .4 "float beta_n" .5 "float alpha" 3', '''AttributeBegin
Material "hair" "rgb color" [.7 .4 .2]
Translate -1.4 0 .2
Rotate 70 0 1 0
Shape "cylinder" "float radius" .3 "float zmin" 0 "float zmax" 3
AttributeEnd
'''),
    # Hair on what it is for: the offset across it comes from the curve.
    'material-hair-curves': scene(SKY + FLOOR + f'''AttributeBegin
Material "hair" "rgb color" [.6 .35 .2] "float beta_m" .35
{fur(150, .5, .06)}AttributeEnd
Translate 0 0 .9
Shape "sphere" "float radius" .6''', depth=8),
    'material-subsurface': material('Material "subsurface" "string name" "Skin1" "float scale" 12 "float eta" 1.4'),
    'material-subsurface-rough': material('''Material "subsurface" "rgb sigma_a" [.3 .8 2] "rgb sigma_s" [9 8 6] "float g" .3
  "float uroughness" .3 "float vroughness" .2 "rgb Kr" [.9 .8 .7]'''),
    'material-kdsubsurface': scene(LAMP + '''LightSource "point" "point from" [-2 -3 4] "rgb I" [16 14 12]
''' + FLOOR + '''AttributeBegin
Texture "kd" "spectrum" "checkerboard" "float uscale" 6 "float vscale" 4
  "rgb tex1" [.9 .6 .4] "rgb tex2" [.3 .5 .8]
Material "kdsubsurface" "texture Kd" "kd" "rgb mfp" [.3 .15 .08]
MediumInterface "" "fog"
Translate 0 0 1
''' + BOX.replace('.02', '-.96').replace('1.98', '.5').replace('"point P"', '"float uv" [0 0 1 0 1 1 0 1 0 1 1 1 1 0 0 0] "point P"') + '''AttributeEnd
''', camera='''MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [.02 .02 .02] "rgb sigma_s" [.06 .06 .06]
MediumInterface "" "fog"
LookAt 0 -5 2.2  0 0 0.4  0 0 1
Camera "perspective" "float fov" 38''', integrator='"volpath"', depth=8),
    'material-fourier': material('Material "fourier" "string bsdffile" "layered.bsdf"'),
    'medium-homogeneous': scene('''MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [.1 .2 .4] "rgb sigma_s" [1.2 .9 .5] "float g" .4
''' + SKY + LAMP + FLOOR + '''AttributeBegin
Material "none"
MediumInterface "m" ""
''' + BOX + '''AttributeEnd
AttributeBegin
Material "plastic"
MediumInterface "m" "m"
Translate 0 0 .6
Shape "sphere" "float radius" .4
AttributeEnd''', integrator='"volpath"', depth=8),
    'medium-grid': scene(grid_medium() + SKY + LAMP + FLOOR + '''AttributeBegin
Material "none"
MediumInterface "m" ""
''' + BOX + '''AttributeEnd
''', integrator='"volpath"', depth=8),
    'medium-camera': scene('''AttributeBegin
Material "matte"
MediumInterface "" "fog"
AreaLightSource "diffuse" "rgb L" [9 8 7]
Translate 1 .5 2
Shape "sphere" "float radius" .35
AttributeEnd
MediumInterface "fog" "fog"
LightSource "point" "point from" [-1 -1 2] "rgb I" [4 5 6]
''' + FLOOR + '''AttributeBegin
Material "glass"
MediumInterface "" "fog"
Translate -.6 0 .6
Shape "sphere" "float radius" .6
AttributeEnd''', camera='''MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [.02 .03 .05] "rgb sigma_s" [.15 .12 .1] "float g" -.3
MediumInterface "" "fog"
LookAt 0 -5 2.2  0 0 0.4  0 0 1
Camera "perspective" "float fov" 38''', integrator='"volpath"', depth=8),
    'motion-shape': scene(SKY + FLOOR + '''AttributeBegin
''' + PATTERN + '''ActiveTransform StartTime
Translate -1.2 0 .5
ActiveTransform EndTime
Translate -.4 .3 1
Rotate 150 0 0 1
Scale 1 1.5 .7
ActiveTransform All
Shape "sphere" "float radius" .5
AttributeEnd
AttributeBegin
Translate .9 0 .8
ActiveTransform EndTime
Rotate 180 0 1 0
ActiveTransform All
Material "plastic" "rgb Kd" [.2 .6 .3]
''' + f'Shape "trianglemesh" {QUAD} "point P" [-.2 0 -.2  .7 0 -.2  .7 .4 .5  -.2 .4 .5]\nAttributeEnd'),
    'motion-instance': scene(SKY + LAMP + FLOOR + '''ObjectBegin "o"
Material "plastic" "rgb Kd" [.6 .3 .2]
Shape "sphere" "float radius" .3
AttributeBegin
Material "metal" "float roughness" .2
Translate 0 0 .6
ActiveTransform EndTime
Translate .4 0 .3
ActiveTransform All
Shape "disk" "float radius" .35
AttributeEnd
ObjectEnd
AttributeBegin
Translate -.8 0 .4
ObjectInstance "o"
AttributeEnd
AttributeBegin
ActiveTransform StartTime
Translate .4 -.6 .3
Rotate -30 1 0 0
ActiveTransform EndTime
Translate 1.3 .5 .5
Rotate 60 1 0 1
Scale 1.2 .6 1
ActiveTransform All
ObjectInstance "o"
AttributeEnd''', '''TransformTimes 1.2 1.8
LookAt 0 -5 2.2  0 0 0.4  0 0 1
Camera "perspective" "float fov" 38 "float shutteropen" 1 "float shutterclose" 1.6'''),
    'motion-camera': scene(SKY + FLOOR + PATTERN + '''Translate 0 0 .6
Shape "sphere" "float radius" .6''', '''ActiveTransform StartTime
LookAt -.3 -5 2.2  0 0 0.4  0 0 1
ActiveTransform EndTime
LookAt .5 -4.5 2.6  0.2 .1 .5  .3 0 1
ActiveTransform All
Camera "perspective" "float fov" 38 "float lensradius" .1 "float focaldistance" 5'''),
    # A medium without an end, on the side of the ball that it is not meant for.
    'medium-endless': scene('''MakeNamedMedium "m" "string type" "homogeneous" "rgb sigma_a" [.02 .03 .04] "rgb sigma_s" [.02 .02 .01]
''' + SKY + FLOOR + '''AttributeBegin
Material "glass"
MediumInterface "" "m"
Translate 0 0 .9
Shape "sphere" "float radius" .9
AttributeEnd
''', integrator='"volpath"', depth=8),
} | {f'shape-{name}': text for name, text in SHAPES.items()}


def write_bsdf(path, nodes):
    """Tabulates scattering to both sides: luminance, red and blue as two Fourier coefficients each."""
    mu = [-math.cos(math.pi * i / (nodes - 1)) for i in range(nodes)]
    cdf, places, coefficients = [], [], []
    for mu_o in mu:
        # The highlight is where -wi is the mirrored wo; from above twice as much as from below.
        y = [abs(m) * (0.03 + (0.2 if m * mu_o < 0 else 0.1) * math.exp(-8 * (m + mu_o) ** 2)) for m in mu]
        total = 0
        for i in range(nodes):
            cdf.append(total)
            places += [len(coefficients), 2]
            coefficients += [y[i], .8 * y[i], 1.1 * y[i], .6 * y[i], .7 * y[i], .5 * y[i]]
            if i + 1 == nodes:
                break
            # The integral of the Catmull-Rom spline that pbrt-v3 draws through the values.
            width = mu[i + 1] - mu[i]
            d0 = width * (y[i + 1] - y[i - 1]) / (mu[i + 1] - mu[i - 1]) if i > 0 else y[1] - y[0]
            d1 = width * (y[i + 2] - y[i]) / (mu[i + 2] - mu[i]) if i + 2 < nodes else y[i + 1] - y[i]
            total += ((d0 - d1) / 12 + (y[i] + y[i + 1]) / 2) * width
    with open(path, 'wb') as file:
        file.write(b'SCATFUN\1' + struct.pack('<9if4i', 1, nodes, len(coefficients), 2, 3, 1, 0, 0, 0, 1.3, 0, 0, 0, 0) +
                   struct.pack(f'<{nodes}f{nodes * nodes}f', *mu, *cdf) +
                   struct.pack(f'<{len(places)}i{len(coefficients)}f', *places, *coefficients))


LENS = '''# Two achromats about a stop, about 42 mm: radius, thickness, index, diameter, in millimetres
  48    5    1.52  24
 -60    1.5  1.62  24
-170    4    1     24
   0    4    0     18
 170    1.5  1.62  22
  60    5    1.52  22
 -48    30   1     22
'''


def write_scenes():
    folder = os.path.join(HERE, 'scenes')
    os.makedirs(folder, exist_ok=True)
    for name, text in SCENES.items():
        with open(os.path.join(folder, name + '.pbrt'), 'w') as file:
            file.write(text)
    write_bsdf(os.path.join(folder, 'layered.bsdf'), 16)
    with open(os.path.join(folder, 'lens.dat'), 'w') as file:
        file.write(LENS)
    # Sides are powers of two: others pbrt-v3 resamples.
    write_png(os.path.join(folder, 'beam.png'), 32, 16,
              lambda x, y: [v / 255 for v in (x * 8, 40 + y * 13, (x // 4 + y // 4) % 2 * 200 + 30)])


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
        path = os.path.join(HERE, 'scenes', name + '.pbrt')
        environment = {**os.environ, 'PBRT_MOMENTS': moments}
        subprocess.run([pbrt, '--nthreads', '1', '--quiet', '--outfile', os.path.join(scratch, 'o.pfm'), path],
                       check=True, env=environment)
        with open(moments, 'rb') as file:
            values = list(struct.iter_unpack('<7d', file.read()))
    folder = os.path.join(HERE, 'references')
    os.makedirs(folder, exist_ok=True)
    write_exr(os.path.join(folder, name + '.exr'),
              [values[y * SIZE:(y + 1) * SIZE] for y in range(SIZE)], int(values[0][6]))


# What scenes show where their names do not say it.
SHOWN = {
    'camera-realistic': 'camera realistic, wide open',
    'camera-realistic-exposed': 'camera realistic, weights by exposure',
    'light-cylinder': 'diffuse area light, a cylinder',
    'material-disney': 'material disney, reflecting',
    'material-disney-below': 'material disney, scatterdistance',
    'material-disney-glass': 'material disney, spectrans',
    'material-disney-thin': 'material disney, thin',
    'material-hair': 'material hair, on quadrics',
    'material-hair-curves': 'material hair, on curves',
    'material-subsurface': 'material subsurface, smooth',
    'material-subsurface-rough': 'material subsurface, rough',
    'medium-camera': 'medium homogeneous, about camera and lights',
    'medium-endless': 'medium homogeneous, without an end',
    'medium-grid': 'medium heterogeneous',
    'motion-camera': 'ActiveTransform of the camera',
    'motion-instance': 'ActiveTransform of instances',
    'motion-shape': 'ActiveTransform of shapes',
    'shape-curve': 'shape curve: flat, cylinder, ribbon; splitdepth',
    'shape-curve-stretched': 'shape curve, under a transform that stretches',
}


COLUMNS = ['plug-in', 'scene'] + [f'{figure}, {estimator}' for estimator in ('pbrt-v3', 'combined') for figure in (
    'energy', 'standard errors', '% of pixels out', '% of tiles out')]


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
    rows = []
    for name, by in sorted(found.items()):
        both = [by[estimator] for estimator in ('pbrt-v3', 'combined')]
        rows.append([SHOWN.get(name, name.replace('-', ' ', 1)), name, *(figure for one in both for figure in one)])
    with open(os.path.join(HERE, 'plugins.csv'), 'w', newline='') as file:
        csv.writer(file, lineterminator='\n').writerows([COLUMNS, *rows])
    for column in range(2, len(COLUMNS)):
        values = [float(row[column]) for row in rows]
        print(f'{COLUMNS[column]}: {min(values)} to {max(values)}, {len(rows)} scenes, {samples} spp')


def main():
    if sys.argv[1:] == ['scenes']:
        write_scenes()
    elif len(sys.argv) > 2 and sys.argv[1] == 'references':
        for name in sys.argv[3:] or SCENES:
            print(name, flush=True)
            render_reference(sys.argv[2], name)
    elif len(sys.argv) in (3, 4) and sys.argv[1] == 'table':
        write_table(sys.argv[2], (sys.argv[3:] or ['256'])[0])
    else:
        sys.exit(__doc__)


main()
