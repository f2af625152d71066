#!/usr/bin/env python3
"""Renders a glTF file with lull and with Cycles and says by how much they differ. Not part of CI.

    tests/side_by_side/side_by_side.py LULL [MODEL.glb] [--spp 256] [--size 200] [--keep FOLDER]

LULL is the program; without a model a Cornell box of Lambertian surfaces is rendered, which it
writes itself. Needs Blender (Debian: blender). Both render with the same camera, lights and bounces,
without denoising, clamping, a light threshold or adaptive sampling, with two threads. As imported,
Blender's Principled surfaces are Disney's diffuse ones; a second render of Cycles has Lambertian ones
in their place wherever a material has neither metal nor highlights, as lull has by the specification.

Prints the means of both images, their ratio, the mean absolute difference of pixels averaged over
blocks of 10x10 pixels, and the samples that each took in a second of processor time.
"""

import argparse
import json
import os
import resource
import struct
import subprocess
import sys
import tempfile

BOUNCES = 12


def cornell():
    """Returns a Cornell box as the bytes of a .glb file."""
    data, root = b'', {
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': []}], 'nodes': [],
        'extensionsUsed': ['KHR_materials_specular', 'KHR_materials_emissive_strength'],
        'meshes': [], 'accessors': [], 'bufferViews': [], 'materials': []}

    def add(kind, entry):
        root[kind].append(entry)
        return len(root[kind]) - 1

    def accessor(values, code, component, kind, count, **more):
        nonlocal data
        data += bytes(-len(data) % 4)
        view = add('bufferViews', {'buffer': 0, 'byteOffset': len(data),
                                   'byteLength': struct.calcsize(code) * len(values)})
        data += struct.pack('<%d%s' % (len(values), code), *values)
        return add('accessors', {'bufferView': view, 'componentType': component, 'type': kind,
                                 'count': count, **more})

    def material(color, **more):
        return add('materials', {
            'doubleSided': True,
            'pbrMetallicRoughness': {'baseColorFactor': [*color, 1], 'metallicFactor': 0},
            'extensions': {'KHR_materials_specular': {'specularFactor': 0},
                           **more.pop('extensions', {})}, **more})

    def mesh(points, triangles, surface, **node):
        flat = [c for p in points for c in p]
        position = accessor(flat, 'f', 5126, 'VEC3', len(points),
                            min=[min(flat[i::3]) for i in range(3)],
                            max=[max(flat[i::3]) for i in range(3)])
        indices = accessor([i for t in triangles for i in t], 'H', 5123, 'SCALAR',
                           3 * len(triangles))
        made = add('meshes', {'primitives': [{'attributes': {'POSITION': position},
                                              'indices': indices, 'material': surface}]})
        root['scenes'][0]['nodes'].append(add('nodes', {'mesh': made, **node}))

    quad = [(0, 1, 2), (0, 2, 3)]
    box = [(-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1), (-1, 1, -1), (-1, 1, 1), (1, 1, 1),
           (1, 1, -1)]
    sides = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7), (0, 1, 5), (0, 5, 4), (1, 2, 6), (1, 6, 5),
             (2, 3, 7), (2, 7, 6), (3, 0, 4), (3, 4, 7)]
    white, red = material((.76, .74, .7)), material((.68, .17, .1))
    blue = material((.09, .36, .42))
    lamp = material((.8, .8, .8), emissiveFactor=[1, .75, .5],
                    extensions={'KHR_materials_emissive_strength': {'emissiveStrength': 26}})
    mesh([(-1, 0, -1), (-1, 0, 1), (1, 0, 1), (1, 0, -1)], quad, white)
    mesh([(-1, 2, -1), (-1, 2, 1), (1, 2, 1), (1, 2, -1)], quad, white)
    mesh([(-1, 0, -1), (1, 0, -1), (1, 2, -1), (-1, 2, -1)], quad, white)
    mesh([(-1, 0, -1), (-1, 0, 1), (-1, 2, 1), (-1, 2, -1)], quad, red)
    mesh([(1, 0, -1), (1, 0, 1), (1, 2, 1), (1, 2, -1)], quad, blue)
    mesh([(-.28, 1.99, -.22), (.28, 1.99, -.22), (.28, 1.99, .22), (-.28, 1.99, .22)], quad, lamp)
    mesh(box, sides, white, translation=[-.36, 0, -.34], scale=[.29, 1.2, .29],
         rotation=[0, .174, 0, .985])
    mesh(box, sides, white, translation=[.36, 0, .3], scale=[.3, .5, .3],
         rotation=[0, -.148, 0, .989])
    root['cameras'] = [{'type': 'perspective', 'perspective': {
        'yfov': .499, 'aspectRatio': 1, 'znear': .1}}]
    root['scenes'][0]['nodes'].append(
        add('nodes', {'camera': 0, 'translation': [0, 1, 4.9]}))
    data += bytes(-len(data) % 4)
    root['buffers'] = [{'byteLength': len(data)}]
    text = json.dumps(root).encode()
    text += b' ' * (-len(text) % 4)
    return (b'glTF' + struct.pack('<II', 2, 28 + len(text) + len(data)) +
            struct.pack('<I', len(text)) + b'JSON' + text + struct.pack('<I', len(data)) +
            b'BIN\0' + data)


# Runs inside Blender: renders the model with Cycles, once as imported and once with Lambertian
# surfaces, and compares the images.
INSIDE = '''
import bpy, json, sys, time
import numpy as np
o = json.loads(sys.argv[-1])
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=o['model'])
scene = bpy.context.scene
if scene.world is None:
    scene.world = bpy.data.worlds.new('none')
scene.world.use_nodes = False
scene.world.color = (0, 0, 0)
scene.camera = next(x for x in scene.objects if x.type == 'CAMERA')
r, c = scene.render, scene.cycles
r.engine = 'CYCLES'
r.resolution_x, r.resolution_y, r.resolution_percentage = o['width'], o['height'], 100
r.threads_mode, r.threads = 'FIXED', 2
r.image_settings.file_format, r.image_settings.color_depth = 'OPEN_EXR', '32'
c.samples, c.use_adaptive_sampling, c.use_denoising = o['spp'], False, False
c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = o['bounces']
c.transparent_max_bounces = 64
c.sample_clamp_direct = c.sample_clamp_indirect = c.light_sampling_threshold = c.blur_glossy = 0
c.pixel_filter_type, c.filter_width = 'BOX', 1

def render(name):
    r.filepath = o['folder'] + '/' + name + '.exr'
    start = time.process_time()
    bpy.ops.render.render(write_still=True)
    return time.process_time() - start

def lambertian():
    for m in bpy.data.materials:
        if not m.use_nodes:
            continue
        p = next((n for n in m.node_tree.nodes if n.type == 'BSDF_PRINCIPLED'), None)
        if p is None or p.inputs['Metallic'].default_value or p.inputs['Specular'].default_value:
            continue
        links, nodes = m.node_tree.links, m.node_tree.nodes
        d, e, a = (nodes.new(k) for k in
                   ('ShaderNodeBsdfDiffuse', 'ShaderNodeEmission', 'ShaderNodeAddShader'))
        d.inputs['Color'].default_value = p.inputs['Base Color'].default_value
        for link in list(p.inputs['Base Color'].links):
            links.new(link.from_socket, d.inputs['Color'])
        e.inputs['Color'].default_value = p.inputs['Emission'].default_value
        e.inputs['Strength'].default_value = p.inputs['Emission Strength'].default_value
        links.new(d.outputs[0], a.inputs[0])
        links.new(e.outputs[0], a.inputs[1])
        for link in list(p.outputs[0].links):
            links.new(a.outputs[0], link.to_socket)

def pixels(name):
    image = bpy.data.images.load(o['folder'] + '/' + name + '.exr')
    image.colorspace_settings.name = 'Non-Color'
    return np.array(image.pixels[:], 'f').reshape(image.size[1], image.size[0], -1)[:, :, :3]

def blocks(image, n=10):
    h, w = image.shape[0] // n * n, image.shape[1] // n * n
    return image[:h, :w].reshape(h // n, n, w // n, n, 3).mean((1, 3))

seconds = {'lull': o['seconds'], 'cycles': render('cycles')}
lambertian()
seconds['cycles-lambert'] = render('cycles-lambert')
count = o['width'] * o['height'] * o['spp']
mine = pixels('lull')
print('RESULT %-15s %9s %9s %9s %11s %11s %13s' %
      ('', 'R', 'G', 'B', 'ratio', 'blocks', 'samples/s'))
for name in ('lull', 'cycles', 'cycles-lambert'):
    theirs = pixels(name)
    ratio = theirs.mean() / mine.mean()
    apart = abs(blocks(theirs) - blocks(mine)).mean() / mine.mean()
    print('RESULT %-15s %9.5f %9.5f %9.5f %11.4f %10.2f%% %13.0f' %
          (name, *theirs.mean((0, 1)), ratio, 100 * apart, count / seconds[name]))
'''


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n')[0])
    parser.add_argument('lull')
    parser.add_argument('model', nargs='?')
    parser.add_argument('--spp', type=int, default=256)
    parser.add_argument('--size', type=int, default=200, help='height of the images in pixels')
    parser.add_argument('--aspect', type=float, default=1, help='of the camera of the model')
    parser.add_argument('--keep', help='folder for the images')
    o = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = os.path.abspath(o.keep or temporary)
        os.makedirs(folder, exist_ok=True)
        model = os.path.abspath(o.model) if o.model else folder + '/cornell.glb'
        if not o.model:
            with open(model, 'wb') as f:
                f.write(cornell())
        width = round(o.size * o.aspect)
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        subprocess.run([o.lull, 'render', model, '-o', folder + '/lull.exr', '--spp', str(o.spp),
                        '--resolution', '%dx%d' % (width, o.size), '--threads', '2', '--quiet',
                        '--max-depth', str(BOUNCES + 1)], check=True, stdout=subprocess.DEVNULL)
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        script = folder + '/inside.py'
        with open(script, 'w') as f:
            f.write(INSIDE)
        options = {'model': model, 'folder': folder, 'spp': o.spp, 'bounces': BOUNCES,
                   'width': width, 'height': o.size, 'seconds': seconds}
        run = subprocess.run(['blender', '-b', '-noaudio', '--python-exit-code', '1', '--python',
                              script, '--', json.dumps(options)], capture_output=True, text=True)
        if run.returncode != 0:
            sys.exit(run.stdout[-2000:] + run.stderr[-2000:])
        print('\n'.join(line[7:] for line in run.stdout.splitlines()
                        if line.startswith('RESULT ')))


main()
