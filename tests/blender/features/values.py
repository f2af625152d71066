"""Features of colours and numbers that nodes make of each other, and of images by their files."""
import os

import bpy
import numpy as np

from cases import case, checks, cube, dressed, folder, image, link, mix, node, principled, textured, wall, without
from surfaces import half


@case("channel and alpha of an image, and alpha of vertex colours, as colours")
def channels_as_colours(scene):
    made, shown, bsdf, tree = textured(checks() * (1, 0.3, 0.1))
    parts = tree.nodes.new('ShaderNodeSeparateColor')
    link(tree, (shown.outputs[0], parts.inputs[0]), (parts.outputs[1], bsdf.inputs['Base Color']))
    wall(made, 0.6).location.x = -1.4
    made, shown, bsdf, tree = textured(half())
    link(tree, (shown.outputs[1], bsdf.inputs['Base Color']))
    wall(made, 0.6)
    made, bsdf, tree = principled()
    link(tree, (node(tree, 'ShaderNodeVertexColor', layer_name="mask").outputs[1], bsdf.inputs['Base Color']))
    o = cube(made, 1, (1.4, 0, 0.5))
    for one in o.data.color_attributes.new("mask", 'FLOAT_COLOR', 'POINT').data:
        one.color = (1, 0, 0, 0.3)


def split():
    """Half red, half blue."""
    values = np.zeros((64, 64, 3))
    values[:, :32, 0] = values[:, 32:, 2] = 1
    return image(values, "split", 'Non-Color')


@case("roughness by a coloured image, alpha by a colour")
def numbers_of_colours(scene):
    made, bsdf, tree = principled(Metallic=1, Base_Color=(0.9, 0.9, 0.9, 1))
    link(tree, (node(tree, 'ShaderNodeTexImage', image=split()).outputs[0], bsdf.inputs['Roughness']))
    wall(made, 0.7).location.x = -0.8
    made, bsdf, tree = principled(Base_Color=(0.9, 0.2, 0.2, 1))
    shown, gamma = node(tree, 'ShaderNodeTexImage', image=split()), node(tree, 'ShaderNodeGamma')
    link(tree, (shown.outputs[0], gamma.inputs[0]), (gamma.outputs[0], bsdf.inputs['Alpha']))
    wall(made, 0.7).location.x = 0.8


@case("roughness of an RGB node, and a Mix Shader by a number above 1")
def numbers_of_nodes(scene):
    made, bsdf, tree = principled(Metallic=1, Base_Color=(0.9, 0.9, 0.9, 1))
    colour = tree.nodes.new('ShaderNodeRGB')
    colour.outputs[0].default_value = (1, 0.1, 0, 1)
    link(tree, (colour.outputs[0], bsdf.inputs['Roughness']))
    dressed(made)
    made, bsdf, tree = principled(Base_Color=(0.9, 0.1, 0.1, 1))
    value = tree.nodes.new('ShaderNodeValue')
    value.outputs[0].default_value = 1.7
    mix(tree, value.outputs[0], bsdf, node(tree, 'ShaderNodeBsdfDiffuse', Color=(0.1, 0.1, 0.9, 1)))
    cube(made, 1, (1.5, 0, 0.5))


@case("roughness and metal of two images with a mapping each")
def two_mappings(scene):
    made, bsdf, tree = principled(Base_Color=(0.9, 0.6, 0.2, 1))
    where = tree.nodes.new('ShaderNodeTexCoord')
    for name, scale in ("Roughness", 1), ("Metallic", 3):
        shown, turn = node(tree, 'ShaderNodeTexImage', image=image(checks(), name, 'Non-Color')), node(tree, 'ShaderNodeMapping', Scale=(scale, 1, 1))
        link(tree, (where.outputs['UV'], turn.inputs[0]), (turn.outputs[0], shown.inputs[0]), (shown.outputs[0], bsdf.inputs[name]))
    wall(made)


@case("Attribute: Fac and Alpha; colours of corners as floats, of points as bytes")
def attribute_outputs(scene):
    without("ball")
    for x, kind, domain, output in ((-2, 'FLOAT_COLOR', 'CORNER', 'Color'), (-0.7, 'BYTE_COLOR', 'POINT', 'Color'),
                                    (0.7, 'FLOAT_COLOR', 'POINT', 'Fac'), (2, 'FLOAT_COLOR', 'POINT', 'Alpha')):
        made, bsdf, tree = principled()
        source = node(tree, 'ShaderNodeVertexColor', layer_name="mask") if output == 'Color' else node(tree, 'ShaderNodeAttribute', attribute_name="mask")
        link(tree, (source.outputs[output], bsdf.inputs['Base Color']))
        o = cube(made, 0.8, (x, 0, 0.5))
        for i, one in enumerate(o.data.color_attributes.new("mask", kind, domain).data):
            one.color = (0.8, 0.2, 0.1 + 0.5 * (i % 2), 0.3 + 0.1 * (i % 3))


@case("sequence of images at its second frame")
def sequence(scene):
    for i, colour in enumerate(((0.8, 0.1, 0.1), (0.1, 0.8, 0.1), (0.1, 0.1, 0.8))):
        image(np.ones((16, 16, 3)) * colour, f"seq_{i + 1:04}")
    made, shown, _, _ = textured()
    shown.image = bpy.data.images.load(os.path.join(folder(), "seq_0001.png"))
    shown.image.source = 'SEQUENCE'
    shown.image_user.frame_duration, shown.image_user.frame_start, shown.image_user.use_auto_refresh = 3, 1, True
    dressed(made)
    scene.frame_set(2)


@case("packed image, and generated ones")
def packed_images(scene):
    made, shown, _, _ = textured()
    shown.image.pack()
    os.remove(shown.image.filepath_raw)
    wall(made, 0.6).location.x = -1.3
    for x, kind in (0, 'COLOR_GRID'), (1.3, 'UV_GRID'):
        made, shown, _, _ = textured()
        shown.image = bpy.data.images.new("grid", 64, 64)
        shown.image.generated_type = kind
        wall(made, 0.6).location.x = x


@case("grey PNG and TIFF, and a JPEG")
def formats(scene):
    settings, view = scene.render.image_settings, scene.view_settings
    before, view.view_transform = view.view_transform, 'Standard'
    for x, kind, mode in (-1.2, 'PNG', 'BW'), (0, 'JPEG', 'RGB'), (1.2, 'TIFF', 'BW'):
        made, shown, bsdf, tree = textured(checks() * (1, 0.7, 0.4))
        path = os.path.join(folder(), f"written.{kind.lower()}")
        settings.file_format, settings.color_mode = kind, mode
        shown.image.save_render(path, scene=scene)
        shown.image = bpy.data.images.load(path)
        link(tree, (shown.outputs[0], bsdf.inputs['Roughness']))
        wall(made, 0.5).location.x = x
    view.view_transform = before
