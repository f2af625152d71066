"""Features of lamps."""
import math

import bpy
from mathutils import Euler, Matrix

from compatible import add_input, add_output
from cases import camera, case, lamp, matte, node, the, wall, without


def only(kind, energy, at, turned=(0, 0, 0), **more):
    without("key")
    made = lamp(kind, energy, at, turned, **more)
    made.name = "only"
    return made


@case("area lamp: square, rectangle, disk, ellipse; scaled and coloured, without a world")
def area_shapes(scene):
    without("key")
    scene.world = None
    for x, shape in zip((-3, -1, 1, 3), ('SQUARE', 'RECTANGLE', 'DISK', 'ELLIPSE')):
        lamp('AREA', 100, (x, -1, 3), (0.3, 0, 0), shape=shape, size=1, size_y=0.4, color=(1, 0.6, 0.5 + x / 6)).scale = (1.5, 1, 1)


@case("area lamp before a sun, from behind and from the front")
def area_shadow(scene):
    only('SUN', 4, (0, 0, 9), angle=0)
    lamp('AREA', 20, (-1.5, 0, 3.5), size=2)
    lamp('AREA', 20, (1.5, 0, 3.5), (math.pi, 0, 0), size=2)


@case("spread of an area lamp")
def area_spread(scene):
    the("key").data.spread = 0.6


@case("edge of an area lamp that the camera does not see")
def area_unseen_edge(scene):
    lamp('AREA', 200, (-4, 0, 1.5), (0, -math.pi / 4, 0), size=3).visible_camera = False


@case("area lamp as a portal")
def portal(scene):
    lamp('AREA', 100, (0, 2, 1.5), (-1.57, 0, 0), size=2).data.cycles.is_portal = True


@case("point lamp with a radius, between a sun and the ball")
def point_shadow(scene):
    only('SUN', 3, (0, 0, 5), angle=0)
    lamp('POINT', 20, (0, 0, 3), shadow_soft_size=0.6)


@case("spot lamp")
def spot(scene):
    only('SPOT', 800, (2, -3, 4), (0.65, 0, 0.6), shadow_soft_size=0, spot_size=0.8, spot_blend=0.5)


@case("penumbra of a spot lamp of radius 0.25, under the edge of a card")
def spot_penumbra(scene):
    without("ball")
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0
    only('SPOT', 800, (0, 0, 4), shadow_soft_size=0.25, spot_size=1.2)
    wall(matte("card", (0, 0, 0, 1)), x=2).matrix_world = Matrix.LocRotScale((-2, 1, 2), Euler((math.pi / 2, 0, 0)), (1, 1, 1))
    camera((0, 0, 1.5), (0, 0, 0), type='ORTHO', ortho_scale=3)


@case("lamps of negative strength, one by a Math node")
def negative_lamp(scene):
    lamp('POINT', -20, (0, -2, 2))
    tree, emission = noded(lamp('POINT', 20, (0, -2, 2)).data)
    less = node(tree, 'ShaderNodeMath', operation='SUBTRACT')
    less.inputs[0].default_value, less.inputs[1].default_value = 0, 1
    through(tree, emission.inputs[1], less)


@case("lamp without shadows")
def no_shadow(scene):
    the("key").data.use_shadow = the("key").data.cycles.cast_shadow = False


@case("lamp by rays: no diffuse light")
def lamp_rays(scene):
    the("key").visible_diffuse = False


@case("light linking of a lamp")
def light_linking(scene):
    the("key").light_linking.receiver_collection = bpy.data.collections.new("some")


@case("max bounces of a lamp")
def lamp_bounces(scene):
    the("key").data.cycles.max_bounces = 0


def noded(light):
    light.use_nodes = True
    return light.node_tree, light.node_tree.nodes["Emission"]


@case("falloff of a lamp")
def falloff(scene):
    tree, emission = noded(only('POINT', 50, (1, -2, 3), shadow_soft_size=0).data)
    tree.links.new(node(tree, 'ShaderNodeLightFalloff', Strength=3).outputs['Linear'], emission.inputs[1])


@case("quadratic falloff of a lamp")
def falloff_quadratic(scene):
    tree, emission = noded(only('POINT', 50, (1, -2, 3), shadow_soft_size=0).data)
    tree.links.new(node(tree, 'ShaderNodeLightFalloff', Strength=3).outputs['Quadratic'], emission.inputs[1])


@case("IES profile, of a lamp that is turned")
def ies_turned(scene):
    lamp = only('POINT', 30, (0, -1, 3), shadow_soft_size=0)
    lamp.rotation_euler = (0.3, 0.2, 0.5)
    tree, emission = noded(lamp.data)
    profile = bpy.data.texts.new("lamp.ies")
    profile.write("IESNA:LM-63-2002\nTILT=NONE\n1 1000 2 3 5 1 2 0 0 0\n1 1 10\n0 40 90\n0 90 180 270 360\n"
                  "900 700 0\n900 100 0\n900 400 0\n900 10 0\n900 700 0\n")
    tree.links.new(node(tree, 'ShaderNodeTexIES', ies=profile).outputs[0], emission.inputs[1])


@case("texture of a lamp")
def lamp_texture(scene):
    tree, emission = noded(the("key").data)
    tree.links.new(node(tree, 'ShaderNodeTexChecker', Scale=1).outputs[0], emission.inputs[0])


def through(tree, socket, *nodes):
    """Links nodes in a row, each to the first input of the next, and the last to a socket."""
    for one, following in zip(nodes, nodes[1:]):
        tree.links.new(one.outputs[0], following.inputs[0])
    tree.links.new(nodes[-1].outputs[0], socket)


@case("strength of a spot lamp and colour of a point lamp by groups of nodes")
def lamp_groups(scene):
    without("key")
    inner = bpy.data.node_groups.new("dimmer", 'ShaderNodeTree')
    add_input(inner, 'NodeSocketFloat', "level"), add_output(inner, 'NodeSocketFloat', "strength"), add_output(inner, 'NodeSocketColor', "colour")
    inlet, outlet = inner.nodes.new('NodeGroupInput'), inner.nodes.new('NodeGroupOutput')
    power = node(inner, 'ShaderNodeMath', operation='POWER')
    power.inputs[1].default_value = 2
    inner.links.new(inlet.outputs[0], power.inputs[0]), inner.links.new(power.outputs[0], outlet.inputs[0])
    inner.links.new(node(inner, 'ShaderNodeWavelength', Wavelength=590).outputs[0], outlet.inputs[1])
    for at, kind in ((2, -3, 4), 'SPOT'), ((-1, -2, 3), 'POINT'):
        tree, emission = noded(lamp(kind, 60, at, (0.65, 0, 0.6) if kind == 'SPOT' else (0, 0, 0), shadow_soft_size=0.1).data)
        outside = node(tree, 'ShaderNodeGroup', node_tree=inner)
        outside.inputs[0].default_value = 3
        tree.links.new(outside.outputs[0 if kind == 'SPOT' else 1], emission.inputs[1 if kind == 'SPOT' else 0])


@case("IES profile times a number, with a strength of its own")
def ies_times(scene):
    tree, emission = noded(only('POINT', 10, (0, -1, 3), shadow_soft_size=0).data)
    profile = bpy.data.texts.new("lamp.ies")
    profile.write("IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 30 90\n0\n1000 100 0\n")
    times = node(tree, 'ShaderNodeMath', operation='MULTIPLY')
    times.inputs[1].default_value = 4
    through(tree, emission.inputs[1], node(tree, 'ShaderNodeTexIES', ies=profile, Strength=0.7), times)


@case("lamp with nodes, and nothing linked to its output")
def lamp_unlinked(scene):
    tree, emission = noded(lamp('POINT', 100, (0, -2, 2)).data)
    tree.links.remove(emission.outputs[0].links[0])


@case("lamps that the camera sees")
def lamps_seen(scene):
    for at, kind, turned in ((-1.5, 0, 1.5), 'POINT', (0, 0, 0)), ((1.5, 0, 1.5), 'SPOT', (1.3, 0, 0)), ((0, 1, 2), 'AREA', (1.2, 0, 0)):
        o = lamp(kind, 20, at, turned)
        o.visible_camera = True
        if kind == 'AREA':
            o.data.size = 0.5
        else:
            o.data.shadow_soft_size = 0.3


@case("lamps with a radius that the camera does not see")
def lamps_unseen(scene):
    for x, kind in (-1.5, 'POINT'), (1.5, 'SPOT'):
        o = lamp(kind, 40, (x, -1, 1.5), (1.3, 0, 0))
        o.visible_camera, o.data.shadow_soft_size = False, 0.4


@case("area lamps of negative scale, one without a width")
def area_scaled(scene):
    without("key")
    for x, scale in (-2, (-1, 1, 1)), (0, (1, 1, -1)), (2, (-1, -1, 1)):
        o = lamp('AREA', 60, (x, -0.5, 1.5), (0.2, 0.3, 0), size=1)
        o.scale, o.visible_camera = scale, True
    lamp('AREA', 60, (0, -1.5, 3), shape='RECTANGLE', size=1, size_y=0)
