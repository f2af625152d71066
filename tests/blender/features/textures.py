"""Features of textures."""
import bpy
import numpy as np

from compatible import displace, set_input
from cases import case, checks, cube, dressed, image, node, principled, textured, the, wall, without


@case("image texture: data read as colours, and colours as data")
def colour_spaces(scene):
    made, shown, bsdf, tree = textured()
    shown.image.colorspace_settings.name = 'Non-Color'
    rough = node(tree, 'ShaderNodeTexImage', image=image(np.ones((64, 64, 3)) * 0.5, "rough", 'sRGB'))
    tree.links.new(rough.outputs[0], bsdf.inputs['Roughness'])
    set_input(bsdf, 'Specular', 1)
    wall(made)


@case("image texture: Clip")
def clip(scene):
    made, shown, _, tree = textured(np.ones((8, 8, 3)) * (0.8, 0.1, 0.1), extension='CLIP')
    scale, where = node(tree, 'ShaderNodeMapping', Scale=(2, 2, 1)), tree.nodes.new('ShaderNodeTexCoord')
    tree.links.new(where.outputs['UV'], scale.inputs[0]), tree.links.new(scale.outputs[0], shown.inputs[0])
    wall(made)


@case("image texture: Closest")
def closest(scene):
    wall(textured(checks()[::8, ::8], interpolation='Closest')[0])


@case("image texture without UVs")
def no_uvs(scene):
    dressed(textured()[0])
    layers = the("ball").data.uv_layers
    layers.remove(layers[0])


@case("image texture over a UV map that two meshes have in other places")
def uv_order(scene):
    made, shown, _, tree = textured()
    tree.links.new(node(tree, 'ShaderNodeUVMap', uv_map="small").outputs[0], shown.inputs[0])
    for x, others in (-1, ("other",)), (1, ()):
        o = wall(made, 0.9)
        o.location.x = x
        o.data.uv_layers.remove(o.data.uv_layers[0])
        for name in (*others, "small"):
            for loop, uv in zip(o.data.uv_layers.new(name=name).data, ((0, 0), (1, 0), (1, 1), (0, 1))):
                loop.uv = [v * (0.1 if name == "small" else 1) for v in uv]


@case("image texture times a colour")
def multiplied(scene):
    made, shown, bsdf, tree = textured()
    times = node(tree, 'ShaderNodeMixRGB', blend_type='MULTIPLY', Fac=1, Color2=(1, 0.2, 0.2, 1))
    tree.links.new(shown.outputs[0], times.inputs[1]), tree.links.new(times.outputs[0], bsdf.inputs['Base Color'])
    dressed(made)


@case("missing image")
def missing(scene):
    made, shown, _, _ = textured()
    shown.image = bpy.data.images.load(image(checks(), "other").filepath_raw)
    shown.image.filepath = "/nowhere/a.png"
    dressed(made)


@case("texture that is finer than its baked image")
def fine(scene):
    made, bsdf, tree = principled()
    tree.links.new(node(tree, 'ShaderNodeTexNoise', Scale=500).outputs[1], bsdf.inputs['Base Color'])
    dressed(made, "floor")
    scene.lull.texture = 64


@case("colours of vertices, used")
def colours(scene):
    made, bsdf, tree = principled()
    tree.links.new(node(tree, 'ShaderNodeVertexColor', layer_name="mask").outputs[0], bsdf.inputs['Base Color'])
    dressed(made)
    layer = the("ball").data.color_attributes.new("mask", 'BYTE_COLOR', 'CORNER')
    for i, one in enumerate(layer.data):
        one.color = (0.8, 0.2, 0.1 + 0.5 * (i % 2), 1)


@case("colours of vertices, not used")
def unused_colours(scene):
    layer = the("ball").data.color_attributes.new("mask", 'BYTE_COLOR', 'CORNER')
    for one in layer.data:
        one.color = (1, 0, 0, 1)


def waves():
    y, x = np.mgrid[0:256, 0:256] / 256
    return np.repeat((0.5 + 0.5 * np.sin(x * 50) * np.sin(y * 50))[..., None], 3, -1)


@case("bump of an image")
def bump(scene):
    made, bsdf, tree = principled(Base_Color=(0.6, 0.4, 0.2, 1))
    shown, bumped = node(tree, 'ShaderNodeTexImage', image=image(waves(), "waves", 'Non-Color')), node(tree, 'ShaderNodeBump', Strength=0.3)
    tree.links.new(shown.outputs[0], bumped.inputs['Height']), tree.links.new(bumped.outputs[0], bsdf.inputs['Normal'])
    dressed(made)


def normal_map(scene):
    made, bsdf, tree = principled(Base_Color=(0.6, 0.4, 0.2, 1))
    tilted = np.ones((8, 8, 3)) * (0.5, 0.5, 1)
    tilted[:, ::2] = (0.7, 0.5, 0.93)
    shown, mapped = node(tree, 'ShaderNodeTexImage', image=image(tilted, "tilted", 'Non-Color')), tree.nodes.new('ShaderNodeNormalMap')
    tree.links.new(shown.outputs[0], mapped.inputs['Color']), tree.links.new(mapped.outputs[0], bsdf.inputs['Normal'])
    dressed(made)


@case("displacement of a material")
def displacement(scene):
    made, _, tree = principled(Base_Color=(0.6, 0.4, 0.2, 1))
    shown, moved = node(tree, 'ShaderNodeTexImage', image=image(waves(), "waves", 'Non-Color')), node(tree, 'ShaderNodeDisplacement', Scale=0.1)
    tree.links.new(shown.outputs[0], moved.inputs['Height'])
    tree.links.new(moved.outputs[0], tree.get_output_node('ALL').inputs['Displacement'])
    displace(made, 'BOTH')
    dressed(made)
    the("ball").modifiers.new("fine", 'SUBSURF').render_levels = 3


@case("Bevel and Ambient Occlusion")
def bevel(scene):
    without("ball")
    made, bsdf, tree = principled(Base_Color=(0.6, 0.4, 0.2, 1))
    tree.links.new(node(tree, 'ShaderNodeBevel', Radius=0.1).outputs[0], bsdf.inputs['Normal'])
    tree.links.new(tree.nodes.new('ShaderNodeAmbientOcclusion').outputs[0], bsdf.inputs['Base Color'])
    cube(made)
