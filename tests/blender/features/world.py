"""Features of worlds."""
import numpy as np

from cases import camera, case, dressed, first, floats, image, link, mix, node, surface, without


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


def world_sky(scene):
    without("key")
    sky(scene, 'ShaderNodeTexSky', sky_type='NISHITA', sun_elevation=0.8, sun_rotation=2.5, sun_intensity=0.2)
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0.1


def low_sun(scene, **values):
    world_sky(scene)
    made = first(scene.world.node_tree, 'TEX_SKY')
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


@case("world: sky with the sun, turned by nodes")
def world_sky_turned(scene):
    world_sky(scene)
    tree = scene.world.node_tree
    made = first(tree, 'TEX_SKY')
    turn, where = node(tree, 'ShaderNodeMapping', Rotation=(0, 0, 0.7)), node(tree, 'ShaderNodeTexCoord')
    tree.links.new(where.outputs['Generated'], turn.inputs['Vector'])
    tree.links.new(turn.outputs[0], made.inputs[0])


@case("world: backdrop other than the light")
def world_backdrop(scene):
    tree = scene.world.node_tree
    shown = node(tree, 'ShaderNodeBackground', Color=(1, 1, 1, 1), Strength=3)
    mix(tree, tree.nodes.new('ShaderNodeLightPath').outputs['Is Camera Ray'], tree.nodes["Background"], shown)


@case("world: other light for mirrors")
def world_glossy(scene):
    world_backdrop(scene)
    tree = scene.world.node_tree
    link(tree, (first(tree, 'LIGHT_PATH').outputs['Is Glossy Ray'], first(tree, 'MIX_SHADER').inputs[0]))
    dressed(surface('BsdfGlossy', Roughness=0.1)[0])


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


def by_window(tree):
    shown = node(tree, 'ShaderNodeTexGradient')
    tree.links.new(tree.nodes.new('ShaderNodeTexCoord').outputs['Window'], shown.inputs[0])
    return shown.outputs[0]


@case("world: gradient over the picture")
def world_window(scene):
    tree = scene.world.node_tree
    tree.links.new(by_window(tree), tree.nodes["Background"].inputs[0])


@case("world: image with a sun of one pixel")
def world_pixel(scene):
    without("key")
    values = np.full((64, 128, 3), 0.2)
    values[48, 60] = 3000
    sky(scene, 'ShaderNodeTexEnvironment', image=floats(values, "sun"))
