"""Features of UV maps and other coordinates."""
import bpy
import numpy as np

from cases import case, checks, cube, dress, empty, geometry_nodes, image, link, matte, node, principled, textured, wall, without


def uneven():
    return checks() * np.linspace(0.2, 1, 64)[None, :, None]


@case("muted nodes: Mapping and Mix")
def muted(scene):
    made, shown, bsdf, tree = textured(uneven())
    scaled = node(tree, 'ShaderNodeMapping', Scale=(3, 1, 1))
    mix = node(tree, 'ShaderNodeMixRGB', blend_type='MULTIPLY', Fac=1, Color2=(1, 0.1, 0.1, 1))
    link(tree, (tree.nodes.new('ShaderNodeTexCoord').outputs['UV'], scaled.inputs[0]), (scaled.outputs[0], shown.inputs[0]),
         (shown.outputs[0], mix.inputs[1]), (mix.outputs[0], bsdf.inputs['Base Color']))
    scaled.mute = mix.mute = True
    wall(made)


def by_place(kind='TexNoise', output='Color', **values):
    made, bsdf, tree = principled()
    link(tree, (node(tree, 'ShaderNode' + kind, **values).outputs[output], bsdf.inputs['Base Color']))
    return made


@case("Generated coordinates of an array, of a deformed mesh and of a sheared object")
def generated_of_modifiers(scene):
    without("ball")
    cube(by_place(Scale=4), 0.6, (-1.2, 0, 0.5)).modifiers.new("copies", 'ARRAY').count = 4
    cube(by_place('TexCoord', 'Generated'), 0.8, (0, 0.7, 0.6), rotation=(0, 0, 0.7)).parent = empty(scale=(3, 1, 1))
    taper = cube(by_place('TexCoord', 'Generated'), 0.6, (0, -1.5, 0.5)).modifiers.new("taper", 'SIMPLE_DEFORM')
    taper.deform_method, taper.factor, taper.deform_axis = 'TAPER', 2, 'Z'


@case("Generated coordinates of shape keys, in an instanced collection with an offset")
def generated_of_keys(scene):
    without("ball")
    o = cube(by_place(Scale=4), 0.8, (-0.8, 0, 0.4))
    o.shape_key_add(name="Basis")
    key = o.shape_key_add(name="up")
    for i, point in enumerate(key.data):
        point.co.z *= 3
        point.co.x *= 1 + i % 2
    key.value = 0.7
    parts = bpy.data.collections.new("parts")
    parts.instance_offset = (-1, 0, -0.5)
    parts.objects.link(o)
    empty(parts, location=(0.3, 0, 0))


@case("image over a UV map that the mesh lacks")
def uvs_lacking(scene):
    made, shown, _, tree = textured(uneven())
    link(tree, (node(tree, 'ShaderNodeUVMap', uv_map="nowhere").outputs[0], shown.inputs[0]))
    wall(made)


@case("UVs that geometry nodes store as vectors")
def stored_uvs(scene):
    made, shown, _, tree = textured(uneven())
    link(tree, (node(tree, 'ShaderNodeUVMap', uv_map="stored").outputs[0], shown.inputs[0]))
    o = wall(made)
    o.data.uv_layers.remove(o.data.uv_layers[0])
    group, inlet, outlet, store, where, parts, back = geometry_nodes(
        o, 'GeometryNodeStoreNamedAttribute', 'GeometryNodeInputPosition', 'ShaderNodeSeparateXYZ', 'ShaderNodeCombineXYZ')
    store.data_type, store.domain = 'FLOAT_VECTOR', 'CORNER'
    store.inputs['Name'].default_value = "stored"
    link(group, (inlet.outputs[0], store.inputs[0]), (where.outputs[0], parts.inputs[0]), (parts.outputs[0], back.inputs[0]),
         (parts.outputs[2], back.inputs[1]), (back.outputs[0], next(s for s in store.inputs if s.type == 'VECTOR')), (store.outputs[0], outlet.inputs[0]))


@case("images over two UV maps, mixed")
def two_maps(scene):
    made, shown, bsdf, tree = textured(checks() * (1, 0.5, 0.2))
    ramp, mix = node(tree, 'ShaderNodeValToRGB'), node(tree, 'ShaderNodeMixRGB', Fac=0.5)
    other = node(tree, 'ShaderNodeTexImage', image=image(checks(), "other", 'Non-Color'))
    link(tree, (node(tree, 'ShaderNodeUVMap', uv_map="small").outputs[0], shown.inputs[0]), (shown.outputs[0], ramp.inputs[0]),
         (other.outputs[0], mix.inputs[1]), (ramp.outputs[0], mix.inputs[2]), (mix.outputs[0], bsdf.inputs['Base Color']))
    for loop in wall(made).data.uv_layers.new(name="small").data:
        loop.uv *= 0.3


@case("UVs of the instancer")
def instancer_uvs(scene):
    without("ball")
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4, size=3, location=(0, 0, 0.1))
    carrier = dress(matte("lawn", (0.1, 0.3, 0.1, 1)))
    made, shown, _, tree = textured(uneven())
    link(tree, (node(tree, 'ShaderNodeTexCoord', from_instancer=True).outputs['UV'], shown.inputs[0]))
    cube(made, 0.4).parent = carrier
    carrier.instance_type = 'FACES'
