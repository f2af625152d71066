"""Makes a model of Blender's own primitives and lets Blender's exporter write it as glTF:

    blender -b -noaudio --python-exit-code 1 --python tests/side_by_side/primitives.py -- OUT.glb

Spheres of metal, plastic, glass and clear coat, a textured cube, Suzanne twice (one mesh in two
places), a transparent plane, a glowing cylinder, panels with a normal map, a map of metal and
roughness, colours of vertices, a turned texture and holes, and a sun, a point and a spot light.
"""

import math
import sys

import bpy


def material(name, **inputs):
    m = bpy.data.materials.new(name)
    m.use_nodes = True
    principled = m.node_tree.nodes['Principled BSDF']
    for key, value in inputs.items():
        principled.inputs[key.replace('_', ' ')].default_value = value
    return m


def solid(m):
    """Says that what is transmitted is refracted (KHR_materials_volume): without, it is a sheet."""
    group = bpy.data.node_groups.get('glTF Material Output')
    if group is None:
        group = bpy.data.node_groups.new('glTF Material Output', 'ShaderNodeTree')
        group.inputs.new('NodeSocketFloat', 'Thickness')
        group.nodes.new('NodeGroupInput')
    node = m.node_tree.nodes.new('ShaderNodeGroup')
    node.node_tree = group
    node.inputs['Thickness'].default_value = 1
    return m


def link_image(m, name, size, pixel, targets, is_data=False, turned=False):
    """Links an image of pixel(x, y), x and y in [0, 1), to inputs of the material, each as (channel,
    input). Returns its node."""
    nodes, links = m.node_tree.nodes, m.node_tree.links
    image = bpy.data.images.new(name, size, size, alpha=True)
    if is_data:
        image.colorspace_settings.name = 'Non-Color'
    image.pixels = [c for y in range(size) for x in range(size)
                    for c in pixel((x + .5) / size, (y + .5) / size)]
    image.pack()
    node = nodes.new('ShaderNodeTexImage')
    node.image = image
    if turned:
        mapping, uv = nodes.new('ShaderNodeMapping'), nodes.new('ShaderNodeTexCoord')
        mapping.inputs['Scale'].default_value = (2, 3, 1)
        mapping.inputs['Rotation'].default_value = (0, 0, .4)
        mapping.inputs['Location'].default_value = (.2, .1, 0)
        links.new(uv.outputs['UV'], mapping.inputs['Vector'])
        links.new(mapping.outputs[0], node.inputs['Vector'])
    split = None
    for channel, target in targets:
        if channel in ('Color', 'Alpha'):
            links.new(node.outputs[channel], target)
            continue
        if split is None:
            split = nodes.new('ShaderNodeSeparateColor')
            links.new(node.outputs['Color'], split.inputs[0])
        links.new(split.outputs[channel], target)
    return node


def inputs_of(m):
    return m.node_tree.nodes['Principled BSDF'].inputs


def colours(x, y):
    """Differs left and right, top and bottom. Smooth but for one edge, as Cycles interpolates
    encoded colours where glTF wants linear ones."""
    return x, y, .2 + .6 * (y > .5), 1


def bumps(x, y):
    nx, ny = .5 * math.sin(8 * math.pi * x), .5 * math.sin(4 * math.pi * y)
    return .5 + .5 * nx, .5 + .5 * ny, .5 + .5 * math.sqrt(1 - nx * nx - ny * ny), 1


def panels(add):
    """Hangs panels on the wall."""
    made = [material(name, Roughness=1) for name in
            ('bumpy', 'metals', 'vertices', 'turned', 'holes')]
    bumpy, metals, vertices, turned, holes = made
    normal = bumpy.node_tree.nodes.new('ShaderNodeNormalMap')
    link_image(bumpy, 'bumps', 64, bumps, [('Color', normal.inputs['Color'])], is_data=True)
    bumpy.node_tree.links.new(normal.outputs[0], inputs_of(bumpy)['Normal'])
    inputs_of(metals)['Base Color'].default_value = (.9, .6, .4, 1)
    link_image(metals, 'metals', 16, lambda x, y: (0, .15 + .8 * x, float(y > .5), 1),
               [('Green', inputs_of(metals)['Roughness']), ('Blue', inputs_of(metals)['Metallic'])],
               is_data=True)
    attribute = vertices.node_tree.nodes.new('ShaderNodeVertexColor')
    attribute.layer_name = 'Col'
    vertices.node_tree.links.new(attribute.outputs['Color'], inputs_of(vertices)['Base Color'])
    link_image(turned, 'turned', 64, colours, [('Color', inputs_of(turned)['Base Color'])],
               turned=True)
    link_image(holes, 'holes', 64, lambda x, y: (.8, .3, .2, float(math.hypot(x - .5, y - .5) > .3)),
               [('Color', inputs_of(holes)['Base Color']), ('Alpha', inputs_of(holes)['Alpha'])])
    holes.blend_method = 'CLIP'
    for i, surface in enumerate(made):
        panel = put(add.primitive_plane_add, (-3.4 + 1.7 * i, 3.2, 3), surface, size=1.4,
                    rotation=(math.pi / 2, 0, 0))
        if surface is vertices:
            layer = panel.data.color_attributes.new('Col', 'BYTE_COLOR', 'CORNER')
            for corner, c in zip(layer.data, ((1, 0, 0, 1), (0, 1, 0, 1), (.2, .2, 1, 1),
                                              (1, 1, 1, 1))):
                corner.color = c


def put(add, where, surface, smooth=False, **more):
    add(location=where, **more)
    thing = bpy.context.object
    thing.data.materials.append(surface)
    if smooth:
        for polygon in thing.data.polygons:
            polygon.use_smooth = True
    return thing


def light(kind, where, turn, energy, **more):
    made = bpy.data.lights.new(kind, kind)
    made.energy, made.color = energy, more.pop('color', (1, 1, 1))
    for key, value in more.items():
        setattr(made, key, value)
    node = bpy.data.objects.new(kind, made)
    node.location, node.rotation_euler = where, turn
    bpy.context.collection.objects.link(node)


def main():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    add = bpy.ops.mesh
    matte = material('matte', Base_Color=(.7, .7, .65, 1), Roughness=1)
    put(add.primitive_plane_add, (0, 0, 0), matte, size=14)
    put(add.primitive_plane_add, (0, 3.5, 3), matte, size=14, rotation=(math.pi / 2, 0, 0))
    row = [('gold', dict(Base_Color=(1, .7, .3, 1), Metallic=1, Roughness=.25)),
           ('mirror', dict(Base_Color=(.9, .9, .9, 1), Metallic=1, Roughness=0)),
           ('plastic', dict(Base_Color=(.1, .3, .7, 1), Roughness=.3)),
           ('coated', dict(Base_Color=(.6, .05, .05, 1), Roughness=.8, Clearcoat=1,
                           Clearcoat_Roughness=.05)),
           ('glass', dict(Base_Color=(1, 1, 1, 1), Roughness=0, Transmission=1, IOR=1.5)),
           ('frosted', dict(Base_Color=(1, 1, 1, 1), Roughness=.4, Transmission=1, IOR=1.5))]
    for i, (name, inputs) in enumerate(row):
        made = material(name, **inputs)
        if 'Transmission' in inputs:
            solid(made)
        put(add.primitive_uv_sphere_add, (-3 + 1.2 * i, -.8, .5), made, smooth=True, radius=.5,
            segments=48, ring_count=24)
    textured = material('textured', Roughness=1)
    link_image(textured, 'colours', 64, colours, [('Color', inputs_of(textured)['Base Color'])])
    put(add.primitive_cube_add, (-2.6, 1.2, .7), textured, size=1.4, rotation=(0, 0, .5))
    panels(add)
    monkey = put(add.primitive_monkey_add, (-.4, 1.2, .9), matte, size=1.6)
    twin = bpy.data.objects.new('twin', monkey.data)
    twin.location, twin.rotation_euler = (1.6, 1.3, .8), (.2, .3, -.8)
    twin.scale = (.7, .9, -.7)
    bpy.context.collection.objects.link(twin)
    glow = material('glow', Base_Color=(0, 0, 0, 1), Specular=0, Emission=(1, .5, .2, 1),
                    Emission_Strength=6)
    put(add.primitive_cylinder_add, (3.1, 1.4, .6), glow, radius=.3, depth=1.2)
    veil = material('veil', Base_Color=(.2, .7, .3, 1), Roughness=1, Specular=0, Alpha=.4)
    veil.blend_method = 'BLEND'
    put(add.primitive_plane_add, (3.2, -.6, .7), veil, size=1.2, rotation=(math.pi / 2, 0, .3))

    light('SUN', (0, 0, 5), (.6, .3, 0), 1.5, color=(1, .95, .9))
    light('POINT', (-2.5, -2.5, 3), (0, 0, 0), 150, color=(.6, .7, 1))
    light('SPOT', (1.5, -2, 4), (.35, -.1, 0), 400, spot_size=.8, spot_blend=.05)

    camera = bpy.data.cameras.new('camera')
    camera.lens = 40
    node = bpy.data.objects.new('camera', camera)
    node.location, node.rotation_euler = (0, -9.5, 3.6), (1.35, 0, 0)
    bpy.context.collection.objects.link(node)
    r = bpy.context.scene.render
    r.resolution_x, r.resolution_y = 160, 100
    bpy.context.scene.camera = node
    bpy.ops.export_scene.gltf(filepath=sys.argv[-1], export_format='GLB', export_cameras=True,
                              export_lights=True)


main()
