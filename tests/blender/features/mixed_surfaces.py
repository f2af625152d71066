"""Further features of textures and surfaces."""
import math
import os

import bpy
import numpy as np
from mathutils import Euler, Matrix

from compatible import displace, use_own_normals
from cases import (
    add, ball, case, checks, cube, dress, dressed, empty, first, folder, geometry_nodes, image, link, matte, mix, node, principled, surface,
    textured, the, wall, without)
from lamps import only
from surfaces import half, leaf, sheet
from textures import normal_map


@case("image texture over the UV map that is chosen for renders")
def uv_for_renders(scene):
    layers = wall(textured()[0]).data.uv_layers
    layer = layers.new(name="small")
    for loop, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
        loop.uv = [0.2 * v for v in uv]
    layer.active_render, layers.active_index = True, 0


@case("colours of vertices that are chosen for renders")
def colours_for_renders(scene):
    made, bsdf, tree = principled()
    link(tree, (node(tree, 'ShaderNodeVertexColor').outputs[0], bsdf.inputs['Base Color']))
    dressed(made)
    attributes = the("ball").data.color_attributes
    for name, colour in ("red", (0.8, 0.1, 0.1, 1)), ("green", (0.1, 0.8, 0.1, 1)):
        for one in attributes.new(name, 'FLOAT_COLOR', 'POINT').data:
            one.color = colour
    attributes.active_color_index, attributes.render_color_index = 0, 1


@case("transparent image whose alpha is not linked")
def alpha_unused(scene):
    wall(textured(half())[0])


@case("image of few pixels that differ much")
def coarse_image(scene):
    wall(textured(np.stack([np.indices((4, 4)).sum(0) % 2 * 0.9] * 3, -1))[0])


@case("Mapping of the kinds Texture, Vector and Normal, with a location; mapping in the node of an image")
def mappings(scene):
    for x, kind in (-1.5, 'TEXTURE'), (-0.5, 'VECTOR'), (0.5, 'NORMAL'):
        made, shown, _, tree = textured(checks()[:, ::-1] * np.linspace(0.2, 1, 64)[:, None, None])
        turn = node(tree, 'ShaderNodeMapping', vector_type=kind, Rotation=(0, 0, 0.3), Scale=(0.5, 0.5 if kind == 'TEXTURE' else 0.3, 1))
        where = tree.nodes.new('ShaderNodeTexCoord')
        if 'Location' in turn.inputs and turn.inputs['Location'].enabled:
            turn.inputs['Location'].default_value = (0.2, 0.1, 0)
        link(tree, (where.outputs['UV'], turn.inputs[0]), (turn.outputs[0], shown.inputs[0]))
        wall(made, 0.45).location.x = x
    made, shown, _, _ = textured()
    shown.texture_mapping.scale, shown.texture_mapping.translation = (0.3, 0.2, 1), (0.1, 0.3, 0)
    wall(made, 0.45).location.x = 1.5


@case("image texture over Generated coordinates, Extend, and Cubic")
def generated(scene):
    made, shown, _, tree = textured(extension='EXTEND', interpolation='Cubic')
    turn, where = node(tree, 'ShaderNodeMapping', Scale=(1.5, 1.5, 1), Location=(-0.2, -0.2, 0)), tree.nodes.new('ShaderNodeTexCoord')
    link(tree, (where.outputs['Generated'], turn.inputs[0]), (turn.outputs[0], shown.inputs[0]))
    dressed(made)


@case("texture over the coordinates of another object")
def other_coordinates(scene):
    made, shown, _, tree = textured()
    where = tree.nodes.new('ShaderNodeTexCoord')
    where.object = empty(matrix_world=Matrix.LocRotScale((0.3, 0, 0), Euler((0.4, 0, 0.5)), (2, 2, 2)))
    link(tree, (where.outputs['Object'], shown.inputs[0]))
    shown.projection = 'BOX'
    dressed(made)


@case("image of tiles (UDIM)")
def tiles(scene):
    made, shown, _, _ = textured()
    tiled = bpy.data.images.new("tiled", 64, 64, tiled=True)
    for number, colour in (1001, (0.8, 0.1, 0.1)), (1002, (0.1, 0.8, 0.1)):
        image(np.ones((64, 64, 3)) * colour, f"tile.{number}")
    tiled.filepath = os.path.join(folder(), "tile.<UDIM>.png")
    tiled.source = 'TILED'
    if len(tiled.tiles) < 2:
        tiled.tiles.new(1002)
    tiled.reload()
    shown.image = tiled
    for loop in wall(made).data.uv_layers[0].data:
        loop.uv.x *= 2


@case("normal map of strength 2, and one in space of the object")
def normal_strength(scene):
    normal_map(scene)
    tree = the("ball").data.materials[0].node_tree
    first(tree, 'NORMAL_MAP').inputs['Strength'].default_value = 2
    made = the("ball").data.materials[0].copy()
    first(made.node_tree, 'NORMAL_MAP').space = 'OBJECT'
    dressed(made, "floor")


@case("normal map that leans 30 degrees towards the light")
def leaning(scene):
    made, bsdf, tree = principled(Base_Color=(0.6, 0.4, 0.2, 1))
    tilted = np.ones((8, 8, 3)) * (0.5 + 0.5 * math.sin(0.52), 0.5, 0.5 + 0.5 * math.cos(0.52))
    shown, mapped = node(tree, 'ShaderNodeTexImage', image=image(tilted, "tilted", 'Non-Color')), tree.nodes.new('ShaderNodeNormalMap')
    link(tree, (shown.outputs[0], mapped.inputs['Color']), (mapped.outputs[0], bsdf.inputs['Normal']))
    wall(made)
    only('SUN', 3, (0, 0, 9), (0.2, 1.3, 0), angle=0)


@case("custom normals, and smooth shading with an angle")
def custom_normals(scene):
    without("ball")
    o = cube(surface('BsdfGlossy', Roughness=0.3)[0], 1.2, (0, 0, 0.6))
    for polygon in o.data.polygons:
        polygon.use_smooth = True
    use_own_normals(o)
    o.data.normals_split_custom_set_from_vertices([v.co.normalized() for v in o.data.vertices])


@case("two-sided material by Backfacing")
def two_sided(scene):
    made, front, tree = surface('BsdfDiffuse', Color=(0.8, 0.1, 0.1, 1))
    mix(tree, tree.nodes.new('ShaderNodeNewGeometry').outputs['Backfacing'], front, node(tree, 'ShaderNodeBsdfDiffuse', Color=(0.1, 0.1, 0.8, 1)))
    for x, turn in (-0.8, 0), (0.8, math.pi):
        o = wall(made, 0.6)
        o.location.x, o.rotation_euler.z = x, turn


@case("colour by the facing of Layer Weight")
def by_facing(scene):
    made, bsdf, tree = principled()
    ramped = node(tree, 'ShaderNodeValToRGB')
    link(tree, (node(tree, 'ShaderNodeLayerWeight', Blend=0.5).outputs['Facing'], ramped.inputs[0]), (ramped.outputs[0], bsdf.inputs['Base Color']))
    dressed(made)


@case("colour and emission by properties, the index and the colour of objects")
def by_object(scene):
    made, bsdf, tree = surface('Emission')
    for name, output, into in ("power", 'Fac', 1), ("paint", 'Color', 0):
        link(tree, (node(tree, 'ShaderNodeAttribute', attribute_type='OBJECT', attribute_name=name).outputs[output], bsdf.inputs[into]))
    the("ball")["power"], the("ball")["paint"] = 3.0, [0.2, 0.5, 0.7]
    dressed(made)
    for x, kind in (-1.6, 'Emission'), (1.6, 'BsdfDiffuse'):
        made, bsdf, tree = surface(kind)
        info = tree.nodes.new('ShaderNodeObjectInfo')
        link(tree, (info.outputs['Color'], bsdf.inputs[0]), *[(info.outputs['Object Index'], bsdf.inputs[1])] * (x < 0))
        o = ball(made, x)
        o.pass_index, o.color = 3 * (x < 0), (0.3, 0.6, 0.9, 1)


@case("Add of Transparent and Emission, and their Mix")
def glow(scene):
    for x, covered in (-0.8, add), (0.8, mix):
        made, bsdf, tree = surface('Emission', Strength=0.5, Color=(1, 0.3, 0.1, 1))
        covered(tree, *[0.5] * (covered == mix), tree.nodes.new('ShaderNodeBsdfTransparent'), bsdf)
        wall(made, 0.6).location.x = x


@case("Add of Diffuse and Glossy")
def added_shine(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    add(tree, base, node(tree, 'ShaderNodeBsdfGlossy', Color=(0.2, 0.2, 0.2, 1)))
    dressed(made)


@case("glass that is clear to shadows and diffuse light, by a Math node")
def glass_by_math(scene):
    made, bsdf, tree = surface('BsdfGlass', Roughness=0, IOR=1.45)
    rays, most = tree.nodes.new('ShaderNodeLightPath'), node(tree, 'ShaderNodeMath', operation='MAXIMUM')
    link(tree, (rays.outputs['Is Shadow Ray'], most.inputs[0]), (rays.outputs['Is Diffuse Ray'], most.inputs[1]))
    mix(tree, most.outputs[0], bsdf, tree.nodes.new('ShaderNodeBsdfTransparent'))
    sheet(made)


@case("Mix of Refraction and Glossy by Fresnel")
def built_glass(scene):
    made, base, tree = surface('BsdfRefraction', Roughness=0, IOR=1.45)
    mix(tree, node(tree, 'ShaderNodeFresnel', IOR=1.45).outputs[0], base, node(tree, 'ShaderNodeBsdfGlossy', Roughness=0))
    dressed(made)


@case("leaf with an alpha: Transparent, Diffuse and Translucent")
def leaf_cut(scene):
    leaf(scene)
    tree = the("wall").data.materials[0].node_tree
    inner, shown = first(tree, 'MIX_SHADER'), node(tree, 'ShaderNodeTexImage', image=image(half()))
    mix(tree, shown.outputs[1], tree.nodes.new('ShaderNodeBsdfTransparent'), inner)


@case("surface Holdout")
def holdout_surface(scene):
    scene.render.film_transparent = True
    dressed(surface('Holdout')[0])


@case("material with nothing on its surface, and no volume")
def nothing(scene):
    made, bsdf, tree = principled()
    tree.nodes.remove(bsdf)
    dressed(made)


@case("material of the object, not of its mesh")
def slots(scene):
    for x, colour in (-1.6, (0.1, 0.6, 0.1, 1)), (1.6, (0.1, 0.1, 0.6, 1)):
        o = bpy.data.objects.new("other", the("ball").data)
        scene.collection.objects.link(o)
        o.location = (x, 0, 0.7)
        o.material_slots[0].link = 'OBJECT'
        o.material_slots[0].material = matte("own", colour)


@case("metal and roughness of an image's channels")
def packed(scene):
    made, bsdf, tree = principled()
    values = np.zeros((64, 64, 3)) + (0, 0.3, 0)
    values[:, 32:, 1], values[16:48, :, 2] = 0.7, 1
    shown, parts = node(tree, 'ShaderNodeTexImage', image=image(values, "packed", 'Non-Color')), tree.nodes.new('ShaderNodeSeparateColor')
    link(tree, (shown.outputs[0], parts.inputs[0]), (parts.outputs[1], bsdf.inputs['Roughness']), (parts.outputs[2], bsdf.inputs['Metallic']))
    dressed(made)


@case("points and volumes of geometry nodes")
def points(scene):
    without("ball")
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=3, size=3, location=(0, 0, 0.4))
    group, inlet, outlet, made = geometry_nodes(dress(matte("red", (0.6, 0.2, 0.1, 1))), 'GeometryNodeMeshToPoints')
    made.inputs['Radius'].default_value = 0.3
    link(group, (inlet.outputs[0], made.inputs[0]), (made.outputs[0], outlet.inputs[0]))


@case("geometry nodes: a material that they set, and an attribute that they name")
def node_attribute(scene):
    made, bsdf, tree = principled()
    link(tree, (node(tree, 'ShaderNodeAttribute', attribute_name="height").outputs['Fac'], bsdf.inputs['Base Color']))
    group, inlet, outlet, store, dressing, place, parts = geometry_nodes(
        the("ball"), 'GeometryNodeStoreNamedAttribute', 'GeometryNodeSetMaterial', 'GeometryNodeInputPosition', 'ShaderNodeSeparateXYZ')
    store.inputs['Name'].default_value, dressing.inputs['Material'].default_value = "height", made
    value = next(s for s in store.inputs if s.type == 'VALUE' and s.enabled)
    link(group, (inlet.outputs[0], store.inputs[0]), (place.outputs[0], parts.inputs[0]), (parts.outputs[2], value),
         (store.outputs[0], dressing.inputs[0]), (dressing.outputs[0], outlet.inputs[0]))


@case("glass and a mirror with bump")
def bumped_mirrors(scene):
    without("ball")
    for x, (made, bsdf, tree) in (-0.9, surface('BsdfGlass', Roughness=0.05, IOR=1.45)), (0.9, principled(Metallic=1, Roughness=0.05)):
        bumped = node(tree, 'ShaderNodeBump', Strength=0.5, Distance=0.1)
        link(tree, (node(tree, 'ShaderNodeTexNoise', Scale=8).outputs[0], bumped.inputs['Height']), (bumped.outputs[0], bsdf.inputs['Normal']))
        ball(made, x)


@case("Principled: an alpha of 0.4, with metal, glass and emission")
def alphas(scene):
    dressed(principled(Metallic=1, Roughness=0.2, Alpha=0.4)[0])
    for x, values in (-1.6, dict(Transmission=1, Roughness=0)), (1.6, dict(Emission=(1, 0.8, 0.3, 1), Emission_Strength=2)):
        ball(principled(Alpha=0.4, **values)[0], x)
    scene.cycles.samples = scene.lull.spp = 512  # of caustics


@case("vector displacement of a grid, displacement of a cube")
def displacements(scene):
    without("ball")
    for kind, output, values in (('VectorDisplacement', 1, dict(Scale=0.5, Midlevel=0.5, space='OBJECT')), ('Displacement', 0, dict(Scale=0.3, Midlevel=0))):
        made, _, tree = principled(Base_Color=(0.6, 0.4, 0.2, 1))
        moved = node(tree, 'ShaderNode' + kind, **values)
        link(tree, (node(tree, 'ShaderNodeTexNoise', Scale=3).outputs[output], moved.inputs[0]),
             (moved.outputs[0], tree.get_output_node('ALL').inputs['Displacement']))
        displace(made, 'DISPLACEMENT')
        if kind == 'Displacement':
            fine = cube(made, 1, (1.2, 0, 0.6)).modifiers.new("fine", 'SUBSURF')
            fine.subdivision_type, fine.render_levels = 'SIMPLE', 5
        else:
            bpy.ops.mesh.primitive_grid_add(x_subdivisions=60, y_subdivisions=60, size=2, location=(-1.2, 0, 0.5))
            dress(made, smooth=True)
