"""Features of worlds."""
import os

import bpy
import numpy as np

from cases import case, cover, dressed, folder, image, node, surface, without
from scenes import camera


def sky(scene, kind, **values):
    tree = scene.world.node_tree
    made = node(tree, kind, **values)
    tree.links.new(made.outputs[0], tree.nodes["Background"].inputs[0])
    return made, tree


@case("world: image, turned")
def world_image(scene):
    made, tree = sky(scene, 'ShaderNodeTexEnvironment', image=image(np.repeat(np.repeat(np.random.default_rng(1).random((4, 8, 3)), 8, 0), 8, 1), "sky"))
    turn, where = node(tree, 'ShaderNodeMapping', Rotation=(0.3, 0, 0.7)), node(tree, 'ShaderNodeTexCoord')
    tree.links.new(where.outputs['Generated'], turn.inputs['Vector'])
    tree.links.new(turn.outputs[0], made.inputs[0])


@case("world: sky with the sun's disc")
def world_sky(scene):
    without("key")
    sky(scene, 'ShaderNodeTexSky', sky_type='NISHITA', sun_elevation=0.8, sun_rotation=2.5, sun_intensity=0.2)
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0.1


def low_sun(scene, **values):
    world_sky(scene)
    made = next(n for n in scene.world.node_tree.nodes if n.type == 'TEX_SKY')
    for name, value in dict(sun_rotation=0.1, sun_intensity=0.3, sun_size=0.2, **values).items():
        setattr(made, name, value)
    camera((0, -6, 1), (1.7, 0, 0), lens=35)


@case("world: low sun that the camera and a mirror see")
def world_sun(scene):
    low_sun(scene, sun_elevation=0.2)
    dressed(surface('BsdfGlossy', Roughness=0)[0])


@case("world: sun that the horizon cuts")
def world_sunset(scene):
    low_sun(scene, sun_elevation=0.02)


@case("world: sky through nodes, under the noon's sun")
def world_noon(scene):
    world_sky(scene)
    tree = scene.world.node_tree
    made, hue = next(n for n in tree.nodes if n.type == 'TEX_SKY'), node(tree, 'ShaderNodeHueSaturation', Saturation=0.5, Value=0.7)
    made.sun_elevation, made.sun_rotation = 1.4, -1
    tree.links.new(made.outputs[0], hue.inputs['Color'])
    tree.links.new(hue.outputs[0], tree.nodes["Background"].inputs[0])


@case("world: sky with the sun, turned by nodes")
def world_sky_turned(scene):
    world_sky(scene)
    tree = scene.world.node_tree
    made = next(n for n in tree.nodes if n.type == 'TEX_SKY')
    turn, where = node(tree, 'ShaderNodeMapping', Rotation=(0, 0, 0.7)), node(tree, 'ShaderNodeTexCoord')
    tree.links.new(where.outputs['Generated'], turn.inputs['Vector'])
    tree.links.new(turn.outputs[0], made.inputs[0])


@case("world: backdrop other than the light")
def world_backdrop(scene):
    tree = scene.world.node_tree
    shown = node(tree, 'ShaderNodeBackground', Color=(1, 1, 1, 1), Strength=3)
    rays, mix = tree.nodes.new('ShaderNodeLightPath'), tree.nodes.new('ShaderNodeMixShader')
    tree.links.new(rays.outputs['Is Camera Ray'], mix.inputs[0])
    tree.links.new(tree.nodes["Background"].outputs[0], mix.inputs[1])
    tree.links.new(shown.outputs[0], mix.inputs[2])
    cover(mix, tree)


@case("world: other light for mirrors")
def world_glossy(scene):
    world_backdrop(scene)
    tree = scene.world.node_tree
    tree.links.new(next(n for n in tree.nodes if n.type == 'LIGHT_PATH').outputs['Is Glossy Ray'],
                   next(n for n in tree.nodes if n.type == 'MIX_SHADER').inputs[0])
    dressed(surface('BsdfGlossy', Roughness=0.1)[0])


@case("world that the camera does not see")
def world_unseen(scene):
    scene.world.cycles_visibility.camera = False


@case("world without nodes that the camera does not see")
def world_plain(scene):
    scene.world.use_nodes, scene.world.color = False, (0.3, 0.33, 0.4)
    scene.world.cycles_visibility.camera = False


@case("world without diffuse light")
def world_rays(scene):
    scene.world.cycles_visibility.diffuse = False


@case("world that the camera alone sees")
def world_behind(scene):
    for name in "diffuse", "glossy", "transmission", "scatter":
        setattr(scene.world.cycles_visibility, name, False)


@case("world: volume")
def world_volume(scene):
    tree = scene.world.node_tree
    tree.links.new(node(tree, 'ShaderNodeVolumeScatter', Density=0.1).outputs[0], tree.get_output_node('ALL').inputs['Volume'])


@case("world: strength by Math, colour by Hue, Gamma and a Mix of numbers")
def world_constants(scene):
    tree = scene.world.node_tree
    background = tree.nodes["Background"]
    power = node(tree, 'ShaderNodeMath', operation='POWER')
    power.inputs[0].default_value, power.inputs[1].default_value = 1.3, 3
    hue, gamma = node(tree, 'ShaderNodeHueSaturation', Hue=0.6, Saturation=1.5, Color=(0.4, 0.3, 0.2, 1)), node(tree, 'ShaderNodeGamma', Gamma=1.2)
    mix = node(tree, 'ShaderNodeMixRGB', blend_type='SCREEN', Fac=0.5, Color2=(0, 0.3, 0.1, 1))
    for a, b in ((power, background.inputs[1]), (hue, gamma.inputs[0]), (gamma, mix.inputs[1]), (mix, background.inputs[0])):
        tree.links.new(a.outputs[0], b)


@case("world: image turned by an object")
def world_object(scene):
    world_image(scene)
    tree = scene.world.node_tree
    turner = bpy.data.objects.new("turner", None)
    scene.collection.objects.link(turner)
    turner.rotation_euler = (0.4, 0.2, 1.5)
    where = next(n for n in tree.nodes if n.type == 'TEX_COORD')
    where.object = turner
    tree.links.new(where.outputs['Object'], next(n for n in tree.nodes if n.type == 'MAPPING').inputs[0])


def by_window(tree):
    shown = node(tree, 'ShaderNodeTexGradient')
    tree.links.new(tree.nodes.new('ShaderNodeTexCoord').outputs['Window'], shown.inputs[0])
    return shown.outputs[0]


@case("world: gradient over the picture")
def world_window(scene):
    tree = scene.world.node_tree
    tree.links.new(by_window(tree), tree.nodes["Background"].inputs[0])


@case("world: gradient over the picture, for the camera alone")
def world_gradient_behind(scene):
    world_backdrop(scene)
    tree = scene.world.node_tree
    mix = next(n for n in tree.nodes if n.type == 'MIX_SHADER')
    tree.links.new(by_window(tree), mix.inputs[2].links[0].from_node.inputs[0])


@case("world: image with a sun of one pixel")
def world_pixel(scene):
    without("key")
    values = np.full((64, 128, 4), 0.2, np.float32)
    values[48, 60, :3] = 3000
    shown = bpy.data.images.new("sun", 128, 64, float_buffer=True)
    shown.pixels.foreach_set(values.ravel())
    shown.filepath_raw, shown.file_format = os.path.join(folder(), "sun.exr"), 'OPEN_EXR'
    shown.save()
    sky(scene, 'ShaderNodeTexEnvironment', image=shown)
