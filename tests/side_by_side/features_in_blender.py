"""Makes scenes of one feature of Blender each, and renders them with Cycles and with lull. Runs inside Blender, for features.py:
the last argument is a JSON object of names (none: all but those that are there), there, size, spp and folder.

Prints "CASE name | title" before each scene, "MADE" behind, and "ALL" with all names at the end. Pictures are FOLDER/NAME.cycles.exr and NAME.lull.exr.
"""
import json
import math
import os
import pathlib
import sys

import bpy
import numpy as np
from mathutils import Euler, Matrix

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "blender"))
from scenes import camera, dress, floor, lamp, material, matte  # noqa: E402

CASES = {}
FOLDER = ""


def case(title):
    """Lists a function that changes the scene of begin()."""
    def add(function):
        CASES[function.__name__] = title, function
        return function
    return add


def begin():
    """A ball on a floor, under a square lamp and a grey sky. Returns the scene."""
    scene, others = bpy.data.scenes.new("case"), list(bpy.data.scenes)
    for kind in ("objects", "meshes", "materials", "lights", "cameras", "worlds", "node_groups", "particles", "curves", "images",
                 "texts", "collections", "libraries"):
        blocks = getattr(bpy.data, kind)
        for block in list(blocks):
            blocks.remove(block)
    bpy.context.window.scene = scene
    for other in others:
        if other != scene:
            bpy.data.scenes.remove(other)
    world = scene.world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs[0].default_value = (0.3, 0.33, 0.4, 1)
    floor(matte("floor", (0.5, 0.5, 0.5, 1))).name = "floor"
    ball(matte("ball", (0.6, 0.2, 0.1, 1)))
    lamp('AREA', 400, (1.5, -2, 5), (0.35, 0, 0.26), size=1).name = "key"
    camera((0, -6, 2.5), (1.25, 0, 0), lens=35)
    return scene


def ball(made):
    bpy.ops.mesh.primitive_uv_sphere_add(location=(0, 0, 0.7), radius=0.7, segments=32, ring_count=16)
    bpy.context.object.name = "ball"
    return dress(made, smooth=True)


def the(name):
    return bpy.data.objects[name]


def without(*names):
    for name in names:
        bpy.data.objects.remove(the(name))


def cube(made, size=1.0, at=(0, 0, 0.5), **more):
    bpy.ops.mesh.primitive_cube_add(size=size, location=at, **more)
    return dress(made)


def wall(made, x=1.5, y=0.0, z=2.0):
    """Puts a rectangle with UVs in the place of the ball."""
    if "ball" in bpy.data.objects:
        without("ball")
    mesh = bpy.data.meshes.new("wall")
    mesh.from_pydata([(-x, y, 0), (x, y, 0), (x, y, z), (-x, y, z)], [], [(0, 1, 2, 3)])
    layer = mesh.uv_layers.new(name="UVMap")
    for loop, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
        loop.uv = uv
    mesh.materials.append(made)
    o = bpy.data.objects.new("wall", mesh)
    bpy.context.collection.objects.link(o)
    return o


def node(tree, kind, **values):
    """Adds a node. `values` are inputs by their names, with _ for spaces, and properties."""
    made = tree.nodes.new(kind)
    for key, value in values.items():
        if key in made.bl_rna.properties:
            setattr(made, key, value)
        else:
            made.inputs[key.replace("_", " ")].default_value = value
    return made


def surface(kind, **values):
    """Returns a new material of one node, the node and its tree."""
    made = material("surface", kind, **{k.replace("_", " "): v for k, v in values.items()})
    return made, made.node_tree.nodes[-1], made.node_tree


def cover(socket_owner, tree):
    tree.links.new(socket_owner.outputs[0], tree.get_output_node('ALL').inputs[0])


def principled(**values):
    return surface('BsdfPrincipled', **values)


def dressed(made, name="ball"):
    the(name).data.materials[0] = made


def checks():
    return np.stack([(np.indices((64, 64)).sum(0) // 8 % 2) * 0.6 + 0.2] * 3, -1)


def image(values, name="image", colours='sRGB'):
    """Returns a PNG of encoded values."""
    full = np.ones((*values.shape[:2], 4), np.float32)
    full[:, :, :values.shape[2]] = values
    made = bpy.data.images.new(name, full.shape[1], full.shape[0], alpha=values.shape[2] == 4)
    made.colorspace_settings.name = colours
    made.pixels.foreach_set(full.ravel())
    made.filepath_raw, made.file_format = os.path.join(FOLDER, name + ".png"), 'PNG'
    made.save()
    return made


def textured(values=None, **texture):
    """Returns a material whose colour is an image, the image's node, the surface's and the tree."""
    made, bsdf, tree = principled()
    shown = node(tree, 'ShaderNodeTexImage', image=image(checks() if values is None else values), **texture)
    tree.links.new(shown.outputs[0], bsdf.inputs['Base Color'])
    return made, shown, bsdf, tree


# Camera and film

@case("shift, portrait")
def shift(scene):
    scene.camera.data.shift_x, scene.camera.data.shift_y = 0.15, 0.2
    scene.render.resolution_x, scene.render.resolution_y = scene.render.resolution_y, scene.render.resolution_x


@case("vertical sensor fit")
def sensor(scene):
    scene.camera.data.sensor_fit, scene.camera.data.shift_y = 'VERTICAL', 0.2


@case("orthographic camera")
def orthographic(scene):
    scene.camera.data.type, scene.camera.data.ortho_scale = 'ORTHO', 6


@case("panoramic camera")
def panorama(scene):
    scene.camera.data.type = 'PANO'


@case("depth of field")
def depth_of_field(scene):
    dof = scene.camera.data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 3, 0.2


@case("aperture blades")
def blades(scene):
    depth_of_field(scene)
    scene.camera.data.dof.aperture_blades = 3


@case("clip start before a wall")
def clip_start(scene):
    o = wall(matte("outside"), 3, -4, 4)
    o.name = "outside"
    ball(matte("ball", (0.6, 0.2, 0.1, 1)))
    scene.camera.data.clip_start = 3


@case("clip end")
def clip_end(scene):
    scene.camera.data.clip_end = 6.5


@case("motion blur")
def motion_blur(scene):
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1
    for frame, x in (0, -1), (1, 0), (2, 1):
        the("ball").location.x = x
        the("ball").keyframe_insert("location", frame=frame)


def keyed(owner, path, *values):
    for frame, value in enumerate(values):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


@case("motion blur of the camera, before a sky")
def motion_of_camera(scene):
    world_image(scene)
    motion_blur(scene)
    scene.cycles.motion_blur_position = 'START'
    keyed(scene.camera, "rotation_euler", (1.25, 0, 0), (1.25, 0, 0), (1.35, 0, 0.2))


@case("motion blur of copies that turn, and of a parent")
def motion_of_copies(scene):
    motion_blur(scene)
    without("ball")
    parent = bpy.data.objects.new("parent", None)
    scene.collection.objects.link(parent)
    keyed(parent, "rotation_euler", (0, 0, 0), (0, 0, 0.4), (0, 0, 0.8))
    first = cube(matte("box", (0.6, 0.2, 0.1, 1)), at=(0, 0, 0.7))
    copies = [first, first.copy(), first.copy()]
    for o, x in zip(copies, (-2, 0, 2)):
        o.parent, o.location.x = parent, x
        if o != first:
            scene.collection.objects.link(o)


@case("motion blur of what shines, of a lamp and of a shape")
def motion_of_lamps(scene):
    motion_blur(scene)
    dressed(surface('Emission')[0])
    keyed(the("key"), "location", (0.5, -2, 5), (1.5, -2, 5), (2.5, -2, 5))
    o = cube(matte("box", (0.1, 0.2, 0.6, 1)), at=(2, 0, 0.5))
    o.shape_key_add(name="Basis")
    key = o.shape_key_add(name="up")
    for point in key.data:
        point.co.z *= 3
    keyed(key, "value", 0, 0.5, 1)


@case("percentage of the resolution")
def percentage(scene):
    scene.render.resolution_percentage = 50


@case("pixel aspect")
def pixel_aspect(scene):
    scene.render.pixel_aspect_x = 2


@case("border, cropped")
def border(scene):
    r = scene.render
    r.use_border = r.use_crop_to_border = True
    r.border_min_x, r.border_max_x, r.border_min_y, r.border_max_y = 0.21, 0.83, 0.3, 0.9


@case("exposure of the film")
def exposure(scene):
    scene.cycles.film_exposure = 2.5


@case("transparent film")
def transparent(scene):
    scene.render.film_transparent = True


@case("transparent film, with transparent glass")
def transparent_glass(scene):
    transparent(scene)
    scene.cycles.film_transparent_glass = True
    dressed(surface('BsdfGlass', Roughness=0, IOR=1.05)[0])


@case("Cycles' own limits: 4 diffuse bounces, indirect light clamped at 10")
def limits(scene):
    interior(scene)
    c = scene.cycles
    c.diffuse_bounces, c.glossy_bounces, c.sample_clamp_indirect = 4, 4, 10


# Lamps

def only(kind, energy, at, turned=(0, 0, 0), **more):
    without("key")
    made = lamp(kind, energy, at, turned, **more)
    made.name = "only"
    return made


@case("area lamp: square, rectangle, disk, ellipse")
def area_shapes(scene):
    without("key")
    for x, shape in zip((-3, -1, 1, 3), ('SQUARE', 'RECTANGLE', 'DISK', 'ELLIPSE')):
        lamp('AREA', 100, (x, -1, 3), (0.3, 0, 0), shape=shape, size=1, size_y=0.4)


@case("area lamp before a sun, from behind and from the front")
def area_shadow(scene):
    only('SUN', 4, (0, 0, 9), angle=0)
    lamp('AREA', 20, (-1.5, 0, 3.5), size=2)
    lamp('AREA', 20, (1.5, 0, 3.5), (math.pi, 0, 0), size=2)


@case("spread of an area lamp")
def area_spread(scene):
    the("key").data.spread = 0.6


@case("area lamp that the camera does not see")
def area_unseen(scene):
    lamp('AREA', 50, (-1.5, 1, 1.5), (math.pi / 2, 0, 0), size=1).visible_camera = False


@case("edge of an area lamp that the camera does not see")
def area_unseen_edge(scene):
    lamp('AREA', 200, (-4, 0, 1.5), (0, -math.pi / 4, 0), size=3).visible_camera = False


@case("area lamp as a portal")
def portal(scene):
    lamp('AREA', 100, (0, 2, 1.5), (-1.57, 0, 0), size=2).data.cycles.is_portal = True


@case("lamp in the reflection of a mirror")
def reflected(scene):
    dressed(surface('BsdfGlossy', Roughness=0)[0])


@case("sun without an angle")
def sun(scene):
    only('SUN', 3, (0, 0, 5), (0.7, 0, 0.5), angle=0)


@case("sun of 0.5 degrees")
def sun_small(scene):
    only('SUN', 3, (0, 0, 5), (0.7, 0, 0.5), angle=math.radians(0.5))


@case("sun of 10 degrees")
def sun_large(scene):
    only('SUN', 3, (0, 0, 5), (0.7, 0, 0.5), angle=math.radians(10))


@case("point lamp without a radius")
def point(scene):
    only('POINT', 300, (1, -2, 3), shadow_soft_size=0)


@case("point lamp with a radius")
def point_radius(scene):
    only('POINT', 300, (1, -2, 3), shadow_soft_size=0.3)


@case("point lamp with a radius, between a sun and the ball")
def point_shadow(scene):
    only('SUN', 3, (0, 0, 5), angle=0)
    lamp('POINT', 20, (0, 0, 3), shadow_soft_size=0.6)


@case("spot lamp")
def spot(scene):
    only('SPOT', 800, (2, -3, 4), (0.65, 0, 0.6), shadow_soft_size=0, spot_size=0.8, spot_blend=0.5)


@case("spot lamp with a radius")
def spot_radius(scene):
    only('SPOT', 800, (2, -3, 4), (0.65, 0, 0.6), shadow_soft_size=0.5, spot_size=0.8)


@case("penumbra of a spot lamp of radius 0.25, under the edge of a card")
def spot_penumbra(scene):
    without("ball")
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0
    only('SPOT', 800, (0, 0, 4), shadow_soft_size=0.25, spot_size=1.2)
    wall(matte("card", (0, 0, 0, 1)), x=2).matrix_world = Matrix.LocRotScale((-2, 1, 2), Euler((math.pi / 2, 0, 0)), (1, 1, 1))
    camera((0, 0, 1.5), (0, 0, 0), type='ORTHO', ortho_scale=3)


@case("lamp of negative strength")
def negative_lamp(scene):
    lamp('POINT', -20, (0, -2, 2))


@case("lamp without shadows")
def no_shadow(scene):
    the("key").data.use_shadow = the("key").data.cycles.cast_shadow = False


@case("lamp by rays: no diffuse light")
def lamp_rays(scene):
    the("key").visible_diffuse = False


@case("max bounces of a lamp")
def lamp_bounces(scene):
    the("key").data.cycles.max_bounces = 0


def noded(light):
    light.use_nodes = True
    return light.node_tree, light.node_tree.nodes["Emission"]


@case("colour of a lamp by a blackbody")
def blackbody(scene):
    tree, emission = noded(the("key").data)
    tree.links.new(node(tree, 'ShaderNodeBlackbody', Temperature=3000).outputs[0], emission.inputs[0])


@case("falloff of a lamp")
def falloff(scene):
    tree, emission = noded(only('POINT', 50, (1, -2, 3), shadow_soft_size=0).data)
    tree.links.new(node(tree, 'ShaderNodeLightFalloff', Strength=3).outputs['Linear'], emission.inputs[1])


@case("quadratic falloff of a lamp")
def falloff_quadratic(scene):
    tree, emission = noded(only('POINT', 50, (1, -2, 3), shadow_soft_size=0).data)
    tree.links.new(node(tree, 'ShaderNodeLightFalloff', Strength=3).outputs['Quadratic'], emission.inputs[1])


@case("IES profile")
def ies(scene):
    tree, emission = noded(only('POINT', 30, (0, -1, 3), shadow_soft_size=0).data)
    profile = bpy.data.texts.new("lamp.ies")
    profile.write("IESNA:LM-63-2002\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 10\n0 30 90\n0\n1000 100 0\n")
    tree.links.new(node(tree, 'ShaderNodeTexIES', ies=profile).outputs[0], emission.inputs[1])


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


# World

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


# Objects

@case("object that the camera does not see")
def unseen(scene):
    the("ball").visible_camera = False


@case("object and lamp that no ray sees")
def unseen_by_all(scene):
    lamp('POINT', 500, (2, -2, 1), shadow_soft_size=0.1).name = "lamp"
    for name in "camera", "diffuse", "glossy", "transmission", "volume_scatter", "shadow":
        for o in "ball", "lamp":
            setattr(the(o), "visible_" + name, False)


@case("object without a shadow")
def shadowless(scene):
    the("ball").visible_shadow = False


@case("holdout")
def holdout(scene):
    the("ball").is_holdout = scene.render.film_transparent = True


@case("shadow catcher")
def catcher(scene):
    the("floor").is_shadow_catcher = scene.render.film_transparent = True


@case("collection: indirect only")
def indirect_only(scene):
    made = bpy.data.collections.new("indirect")
    scene.collection.children.link(made)
    made.objects.link(the("ball"))
    scene.collection.objects.unlink(the("ball"))
    scene.view_layers[0].layer_collection.children["indirect"].indirect_only = True


@case("background set, and a grease pencil")
def background_set(scene):
    other = bpy.data.scenes.new("set")
    for name in "ball", "key":
        other.collection.objects.link(the(name))
        scene.collection.objects.unlink(the(name))
    scene.background_set = other
    bpy.ops.object.gpencil_add(location=(0, -1, 1), type='STROKE')


@case("material override of a view layer")
def override(scene):
    scene.view_layers[0].material_override = matte("clay", (0.8, 0.8, 0.8, 1))


@case("view layer without the sky and strands")
def layer_without(scene):
    hair(scene)
    scene.view_layers[0].use_sky = scene.view_layers[0].use_strand = False


@case("view layer without surfaces")
def layer_of_strands(scene):
    hair(scene)
    scene.view_layers[0].use_solid = False


@case("sheared object")
def sheared(scene):
    without("ball")
    parent = bpy.data.objects.new("parent", None)
    scene.collection.objects.link(parent)
    parent.scale = (3, 1, 1)
    o = cube(matte("box", (0.6, 0.2, 0.1, 1)), rotation=(0, 0, 0.7))
    o.parent = parent


@case("empty slot of a material")
def empty_slot(scene):
    the("ball").data.materials.append(None)
    made, shown, _, tree = textured()
    tree.links.new(node(tree, 'ShaderNodeUVMap', uv_map="UVMap").outputs[0], shown.inputs[0])
    wall(made).location.y = 1
    ball(matte("red", (0.6, 0.2, 0.1, 1))).data.materials.append(None)
    the("ball").data.polygons[0].material_index = 1


@case("instanced collection outside the scene, with an object hidden from renders")
def instanced_collection(scene):
    without("ball")
    parts = bpy.data.collections.new("parts")
    shown = cube(matte("shown", (0.6, 0.2, 0.1, 1)))
    shown.modifiers.new("round", 'SUBSURF').render_levels = 3
    cutter = cube(matte("cutter", (0.1, 0.8, 0.1, 1)), 0.6, (0.4, -0.4, 0.8))
    cutter.hide_render = True
    cut = shown.modifiers.new("cut", 'BOOLEAN')
    cut.object = cutter
    unseen = cube(matte("unseen", (0.1, 0.8, 0.1, 1)), 0.6, (1.5, 0, 0.3))
    unseen.hide_viewport = True
    for o in shown, cutter, unseen:
        parts.objects.link(o)
        scene.collection.objects.unlink(o)
    copy = bpy.data.objects.new("copy", None)
    copy.instance_type, copy.instance_collection = 'COLLECTION', parts
    scene.collection.objects.link(copy)


@case("other values in the viewport: particles, curves, Screw, metaballs, geometry nodes")
def viewport_values(scene):
    particle_objects(scene)
    bpy.data.particles[0].display_method = 'PATH'
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.7, location=(1.5, -1, 0.8))
    bpy.context.object.data.bevel_depth, bpy.context.object.data.resolution_u = 0.2, 1
    bpy.context.object.data.render_resolution_u = 12
    bpy.ops.object.metaball_add(location=(-2, 0, 0.8), radius=1)
    bpy.context.object.data.resolution = 1
    rod = cube(matte("rod", (0.6, 0.2, 0.1, 1)), 0.3, (0, -1.5, 1))
    screw = rod.modifiers.new("screw", 'SCREW')
    screw.angle, screw.screw_offset, screw.steps, screw.render_steps = 0.1, 1, 2, 16
    group = bpy.data.node_groups.new("late", 'GeometryNodeTree')
    group.inputs.new('NodeSocketGeometry', "in"), group.outputs.new('NodeSocketGeometry', "out")
    inlet, outlet, switch, asks = (group.nodes.new(k) for k in (
        'NodeGroupInput', 'NodeGroupOutput', 'GeometryNodeSwitch', 'GeometryNodeIsViewport'))
    switch.input_type = 'GEOMETRY'
    geometry = [s for s in switch.inputs if s.type == 'GEOMETRY']
    group.links.new(inlet.outputs[0], geometry[0])
    group.links.new(next(s for s in switch.outputs if s.type == 'GEOMETRY'), outlet.inputs[0])
    group.links.new(asks.outputs[0], switch.inputs[1])
    cube(matte("late", (0.1, 0.2, 0.6, 1)), 0.6, (-1, -1.5, 0.4)).modifiers.new("late", 'NODES').node_group = group


@case("override of an object of a library, beside a local one of its name")
def library(scene):
    made = textured()[0]
    dressed(made)
    parts, path = bpy.data.collections.new("parts"), os.path.join(FOLDER, "library.blend")
    parts.objects.link(the("ball"))
    bpy.data.libraries.write(path, {parts})
    without("ball")
    bpy.data.collections.remove(parts)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.collections = ["parts"]
    copy = bpy.data.objects.new("copy", None)
    copy.instance_type, copy.instance_collection, copy.scale = 'COLLECTION', wanted.collections[0], (-1, 1, 1.2)
    scene.collection.objects.link(copy)
    source = copy.instance_collection.objects[0]
    scene.collection.objects.link(source)
    moved = source.override_create(remap_local_usages=True)
    moved.location.x = -1.5


@case("negative scale")
def negative(scene):
    without("ball")
    bpy.ops.mesh.primitive_monkey_add(size=1.6, location=(0, 0, 0.8))
    dress(matte("red", (0.6, 0.2, 0.1, 1))).scale = (-1, 1, 1)


@case("text, curves and metaballs")
def text(scene):
    without("ball")
    bpy.ops.object.text_add(location=(-1, 0, 0.2), rotation=(1.2, 0, 0))
    bpy.context.object.data.body, bpy.context.object.data.extrude = "lull", 0.1
    bpy.context.object.data.materials.append(matte("ink", (0.6, 0.2, 0.1, 1)))
    bpy.ops.curve.primitive_bezier_circle_add(location=(1.5, 0, 0.8))
    bpy.context.object.data.bevel_depth = 0.2
    bpy.ops.object.metaball_add(location=(-2, 0, 0.8), radius=1)


@case("instances on faces")
def faces(scene):
    without("ball")
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4, size=4, location=(0, 0, 0.3))
    carrier = dress(None)
    cube(matte("copy", (0.6, 0.2, 0.1, 1)), 0.4).parent = carrier
    carrier.instance_type, carrier.show_instancer_for_render = 'FACES', False


@case("lamps on faces")
def lamps_on_faces(scene):
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=2, y_subdivisions=2, size=4, location=(0, 0, 3))
    carrier = bpy.context.object
    lamp('POINT', 50, (0, 0, 0)).parent = carrier
    carrier.instance_type, carrier.show_instancer_for_render = 'FACES', False


@case("instances of geometry nodes")
def geometry_nodes(scene):
    without("ball")
    one = cube(matte("copy", (0.6, 0.2, 0.1, 1)), 0.4, (0, 50, 0))
    group = bpy.data.node_groups.new("scatter", 'GeometryNodeTree')
    group.inputs.new('NodeSocketGeometry', "in"), group.outputs.new('NodeSocketGeometry', "out")
    inlet, outlet, put, info = (group.nodes.new(k) for k in (
        'NodeGroupInput', 'NodeGroupOutput', 'GeometryNodeInstanceOnPoints', 'GeometryNodeObjectInfo'))
    info.inputs[0].default_value = one
    for a, b in ((inlet.outputs[0], put.inputs['Points']), (info.outputs['Geometry'], put.inputs['Instance']),
                 (put.outputs[0], outlet.inputs[0])):
        group.links.new(a, b)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=3, size=3, location=(0, 0, 0.4))
    dress(None).modifiers.new("scatter", 'NODES').node_group = group


def particles(o, **values):
    o.modifiers.new("particles", 'PARTICLE_SYSTEM')
    settings = o.particle_systems[0].settings
    settings.type = 'HAIR'
    for key, value in values.items():
        setattr(settings, key, value)


def lawn():
    without("ball")
    bpy.ops.mesh.primitive_grid_add(size=3, location=(0, 0, 0.1))
    return dress(matte("lawn", (0.1, 0.3, 0.1, 1)))


@case("particles that are objects")
def particle_objects(scene):
    bpy.ops.mesh.primitive_ico_sphere_add(radius=0.3, location=(0, 50, 0))
    one = dress(matte("copy", (0.6, 0.2, 0.1, 1)))
    particles(lawn(), count=40, render_type='OBJECT', instance_object=one, particle_size=0.5)


@case("hair of particles")
def hair(scene):
    particles(lawn(), count=1000, hair_length=0.6, root_radius=5)


@case("hair of curves")
def hair_curves(scene):
    bpy.context.preferences.experimental.use_new_curves_tools = True
    bpy.ops.object.curves_random_add()
    bpy.context.object.data.materials.append(matte("strands", (0.3, 0.2, 0.1, 1)))


@case("modifiers: subdivision, boolean")
def modifiers(scene):
    the("ball").hide_render = True
    o = cube(matte("box", (0.6, 0.2, 0.1, 1)), 1.4, (0, 0, 0.7))
    o.modifiers.new("round", 'SUBSURF').render_levels = 3
    cut = o.modifiers.new("cut", 'BOOLEAN')
    cut.object = the("ball")


@case("adaptive subdivision")
def dicing(scene):
    o = cube(matte("box", (0.6, 0.2, 0.1, 1)), 1.4, (0, 0, 0.7))
    without("ball")
    scene.cycles.feature_set = 'EXPERIMENTAL'
    o.modifiers.new("round", 'SUBSURF').levels = 3
    o.cycles.use_adaptive_subdivision = True


@case("simplify")
def simplify(scene):
    scene.render.use_simplify, scene.render.simplify_subdivision_render = True, 0
    the("ball").modifiers.new("round", 'SUBSURF').render_levels = 3


@case("smooth shading with an angle, auto smooth")
def auto_smooth(scene):
    without("ball")
    bpy.ops.mesh.primitive_cylinder_add(radius=0.7, depth=1.2, location=(0, 0, 0.6))
    o = dress(surface('BsdfGlossy', Roughness=0.2)[0], smooth=True)
    o.data.use_auto_smooth, o.data.auto_smooth_angle = True, 0.6


@case("volume of an object without a surface")
def volume(scene):
    made, _, tree = principled()
    tree.nodes.remove(next(n for n in tree.nodes if n.type == 'BSDF_PRINCIPLED'))
    tree.links.new(node(tree, 'ShaderNodeVolumePrincipled').outputs[0], tree.get_output_node('ALL').inputs['Volume'])
    cube(made, 1.5, (0, 0, 0.8))
    without("ball")


@case("unit scale of a scene")
def units(scene):
    scene.unit_settings.scale_length = 0.01


# Surfaces

@case("Principled: metal, rough and smooth")
def metal(scene):
    dressed(principled(Metallic=1, Roughness=0.3, Base_Color=(0.9, 0.6, 0.3, 1))[0])


@case("Principled: plastic")
def plastic(scene):
    dressed(principled(Roughness=0.3, Base_Color=(0.1, 0.3, 0.7, 1))[0])


@case("Principled: glass")
def principled_glass(scene):
    dressed(principled(Transmission=1, Roughness=0)[0])


@case("Principled: clear coat")
def coat(scene):
    dressed(principled(Clearcoat=1, Roughness=0.8, Base_Color=(0.5, 0.05, 0.05, 1))[0])


@case("Principled: sheen")
def sheen(scene):
    dressed(principled(Sheen=1, Roughness=1, Specular=0, Base_Color=(0.3, 0.1, 0.1, 1))[0])


@case("Principled: subsurface")
def subsurface(scene):
    dressed(principled(Subsurface=0.5, Subsurface_Color=(0.8, 0.2, 0.1, 1))[0])


@case("Principled: anisotropy")
def anisotropic(scene):
    dressed(principled(Metallic=1, Roughness=0.4, Anisotropic=0.8)[0])


@case("Principled: tinted specular reflection")
def tint(scene):
    dressed(principled(Specular_Tint=1, Specular=1, Roughness=0.2, Base_Color=(0.7, 0.1, 0.1, 1))[0])


@case("Diffuse, with roughness")
def oren_nayar(scene):
    dressed(surface('BsdfDiffuse', Color=(0.7, 0.6, 0.5, 1), Roughness=1)[0])


@case("Glossy")
def glossy(scene):
    dressed(surface('BsdfGlossy', Roughness=0.3, Color=(0.9, 0.7, 0.4, 1))[0])


@case("Glass")
def glass(scene):
    dressed(surface('BsdfGlass', Roughness=0, IOR=1.45)[0])


@case("rough glass")
def rough_glass(scene):
    dressed(surface('BsdfGlass', Roughness=0.4, IOR=1.45)[0])


@case("Refraction")
def refraction(scene):
    dressed(surface('BsdfRefraction', Roughness=0, IOR=1.45)[0])


@case("glass with absorption")
def absorption(scene):
    made, _, tree = surface('BsdfGlass', Roughness=0, IOR=1.45)
    tree.links.new(node(tree, 'ShaderNodeVolumeAbsorption', Color=(0.8, 0.3, 0.1, 1), Density=2).outputs[0],
                   tree.get_output_node('ALL').inputs['Volume'])
    dressed(made)


@case("pane of glass, as a slab")
def pane(scene):
    wall(matte("red", (0.6, 0.2, 0.1, 1)))
    made = cube(surface('BsdfGlass', Roughness=0, IOR=1.45)[0], 1, (0, -1, 1))
    made.scale = (3, 0.02, 2)


@case("Translucent")
def translucent(scene):
    o = wall(surface('BsdfTranslucent', Color=(0.6, 0.7, 0.3, 1))[0])
    o.location.y = -1.5


@case("leaf: Diffuse and Translucent mixed")
def leaf(scene):
    made, front, tree = surface('BsdfDiffuse', Color=(0.2, 0.5, 0.1, 1))
    behind, mix = node(tree, 'ShaderNodeBsdfTranslucent', Color=(0.5, 0.7, 0.1, 1)), node(tree, 'ShaderNodeMixShader')
    tree.links.new(front.outputs[0], mix.inputs[1]), tree.links.new(behind.outputs[0], mix.inputs[2])
    cover(mix, tree)
    wall(made).location.y = -1.5


@case("Velvet")
def velvet(scene):
    dressed(surface('BsdfVelvet', Color=(0.5, 0.1, 0.1, 1))[0])


@case("Toon")
def toon(scene):
    dressed(surface('BsdfToon', Color=(0.5, 0.1, 0.1, 1))[0])


@case("Subsurface Scattering")
def scattering(scene):
    dressed(surface('SubsurfaceScattering', Color=(0.8, 0.4, 0.3, 1))[0])


@case("Emission, seen from both sides")
def emission(scene):
    without("key")
    bpy.ops.mesh.primitive_plane_add(size=2, location=(0, 0.5, 1.6))
    dress(surface('Emission', Strength=4)[0])


@case("Emission from an image of high range")
def emission_image(scene):
    shown = bpy.data.images.new("bright", 32, 16, float_buffer=True)
    shown.pixels.foreach_set(np.tile(np.array([3, 2, 1, 1], np.float32), 512))
    shown.filepath_raw, shown.file_format = os.path.join(FOLDER, "bright.exr"), 'OPEN_EXR'
    shown.save()
    made, bsdf, tree = surface('Emission')
    tree.links.new(node(tree, 'ShaderNodeTexImage', image=shown).outputs[0], bsdf.inputs[0])
    wall(made)


def half(values=4):
    pixels = np.ones((8, 8, 4), np.float32)
    pixels[:, :, :3], pixels[:, 4:, 3] = (0.1, 0.4, 0.1), 0
    return pixels


@case("alpha of an image, whatever the blend mode")
def alpha(scene):
    made, shown, bsdf, tree = textured(np.repeat(np.repeat(half(), 8, 0), 8, 1))
    tree.links.new(shown.outputs[1], bsdf.inputs['Alpha'])
    made.blend_method = 'OPAQUE'
    wall(made)


@case("Mix with Transparent")
def mix_transparent(scene):
    made, shown, bsdf, tree = textured(np.repeat(np.repeat(half(), 8, 0), 8, 1))
    clear, mix = tree.nodes.new('ShaderNodeBsdfTransparent'), tree.nodes.new('ShaderNodeMixShader')
    for a, b in ((shown.outputs[1], mix.inputs[0]), (clear.outputs[0], mix.inputs[1]), (bsdf.outputs[0], mix.inputs[2])):
        tree.links.new(a, b)
    cover(mix, tree)
    wall(made)


@case("coloured Transparent")
def transparent_colour(scene):
    wall(surface('BsdfTransparent', Color=(0.8, 0.3, 0.2, 1))[0]).location.y = -1
    ball(matte("ball", (0.6, 0.2, 0.1, 1)))


@case("surface by kinds of rays: shadows without glass")
def glass_by_rays(scene):
    made, bsdf, tree = surface('BsdfGlass', Roughness=0, IOR=1.45)
    rays, clear, mix = (tree.nodes.new('ShaderNode' + k) for k in ('LightPath', 'BsdfTransparent', 'MixShader'))
    for a, b in ((rays.outputs['Is Shadow Ray'], mix.inputs[0]), (bsdf.outputs[0], mix.inputs[1]), (clear.outputs[0], mix.inputs[2])):
        tree.links.new(a, b)
    cover(mix, tree)
    dressed(made)


def sheet(made):
    """Puts a plane before the wall, in the way of the sun."""
    wall(matte("red", (0.6, 0.2, 0.1, 1))).location.y = 1
    only('SUN', 3, (0, 0, 9), (0.9, 0, 0), angle=0)
    o = wall(made, x=2, z=2.2)
    o.location.y = -1


@case("pane: Transparent and Glossy by Fresnel")
def pane_by_fresnel(scene):
    made, clear, tree = surface('BsdfTransparent', Color=(0.9, 0.95, 0.9, 1))
    shine, fresnel, mix = (tree.nodes.new('ShaderNode' + k) for k in ('BsdfGlossy', 'Fresnel', 'MixShader'))
    shine.inputs['Roughness'].default_value, shine.inputs['Color'].default_value = 0, (1, 1, 1, 1)
    for a, b in ((fresnel.outputs[0], mix.inputs[0]), (clear.outputs[0], mix.inputs[1]), (shine.outputs[0], mix.inputs[2])):
        tree.links.new(a, b)
    cover(mix, tree)
    sheet(made)


@case("pane: plane of Glass without a shadow by Light Path")
def pane_by_rays(scene):
    glass_by_rays(scene)
    made = the("ball").data.materials[0]
    sheet(made)


@case("Mix by Fresnel: Diffuse and Glossy")
def coated(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    shine, fresnel, mix = (tree.nodes.new('ShaderNode' + k) for k in ('BsdfGlossy', 'Fresnel', 'MixShader'))
    shine.inputs['Roughness'].default_value = 0.2
    for a, b in ((fresnel.outputs[0], mix.inputs[0]), (base.outputs[0], mix.inputs[1]), (shine.outputs[0], mix.inputs[2])):
        tree.links.new(a, b)
    cover(mix, tree)
    dressed(made)


@case("Mix of Diffuse and Glossy by a number")
def mixed(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    shine, mix = node(tree, 'ShaderNodeBsdfGlossy', Roughness=0.3), node(tree, 'ShaderNodeMixShader', Fac=0.3)
    tree.links.new(base.outputs[0], mix.inputs[1]), tree.links.new(shine.outputs[0], mix.inputs[2])
    cover(mix, tree)
    dressed(made)


@case("Mix of Diffuse and nothing")
def half_mixed(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    mix = tree.nodes.new('ShaderNodeMixShader')
    tree.links.new(base.outputs[0], mix.inputs[1])
    cover(mix, tree)
    dressed(made)


@case("wall that is there from inside alone")
def one_sided(scene):
    made, _, tree = surface('BsdfTransparent')
    inside, mix, where = (tree.nodes.new('ShaderNode' + k) for k in ('BsdfDiffuse', 'MixShader', 'NewGeometry'))
    for a, b in ((where.outputs['Backfacing'], mix.inputs[0]), (tree.nodes[1].outputs[0], mix.inputs[1]), (inside.outputs[0], mix.inputs[2])):
        tree.links.new(a, b)
    cover(mix, tree)
    cube(made, 3, (0, 0, 1.5))


@case("Add of Diffuse and Emission")
def added(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    light, add = node(tree, 'ShaderNodeEmission', Strength=0.5), tree.nodes.new('ShaderNodeAddShader')
    tree.links.new(base.outputs[0], add.inputs[0]), tree.links.new(light.outputs[0], add.inputs[1])
    cover(add, tree)
    dressed(made)


@case("unknown surface (Hair BSDF)")
def unknown(scene):
    dressed(surface('BsdfHairPrincipled')[0])


@case("material without nodes")
def no_nodes(scene):
    made = bpy.data.materials.new("plain")
    made.diffuse_color = (0.2, 0.5, 0.2, 1)
    dressed(made)


@case("glass by a mask")
def masked_glass(scene):
    made, bsdf, tree = principled(Roughness=0.1)
    tree.links.new(node(tree, 'ShaderNodeTexChecker', Scale=2).outputs['Fac'], bsdf.inputs['Transmission'])
    dressed(made)


@case("Random of two objects")
def random(scene):
    made, bsdf, tree = surface('BsdfDiffuse')
    tree.links.new(tree.nodes.new('ShaderNodeObjectInfo').outputs['Random'], bsdf.inputs['Color'])
    dressed(made)
    dressed(made, "floor")


@case("texture over places, on objects that share a mesh")
def places(scene):
    made, bsdf, tree = surface('BsdfDiffuse')
    checker = node(tree, 'ShaderNodeTexChecker', Scale=1.5)
    tree.links.new(tree.nodes.new('ShaderNodeNewGeometry').outputs['Position'], checker.inputs[0])
    tree.links.new(checker.outputs[0], bsdf.inputs['Color'])
    dressed(made)
    other = bpy.data.objects.new("other", the("ball").data)
    scene.collection.objects.link(other)
    other.location = (1.5, 0, 0.7)


@case("group of nodes")
def group(scene):
    inner = bpy.data.node_groups.new("paint", 'ShaderNodeTree')
    inner.outputs.new('NodeSocketShader', "Shader")
    outlet, paint = inner.nodes.new('NodeGroupOutput'), node(inner, 'ShaderNodeBsdfPrincipled', Base_Color=(0.1, 0.5, 0.1, 1))
    inner.links.new(paint.outputs[0], outlet.inputs[0])
    made, bsdf, tree = principled()
    outside = node(tree, 'ShaderNodeGroup', node_tree=inner)
    cover(outside, tree)
    tree.nodes.remove(bsdf)
    dressed(made)


# Textures

@case("image texture, repeated and turned")
def repeated(scene):
    made, shown, _, tree = textured()
    turn, where = node(tree, 'ShaderNodeMapping', Scale=(2, 3, 1), Rotation=(0, 0, 0.4)), tree.nodes.new('ShaderNodeTexCoord')
    tree.links.new(where.outputs['UV'], turn.inputs[0]), tree.links.new(turn.outputs[0], shown.inputs[0])
    dressed(made)


@case("image texture: data read as colours, and colours as data")
def colour_spaces(scene):
    made, shown, bsdf, tree = textured()
    shown.image.colorspace_settings.name = 'Non-Color'
    rough = node(tree, 'ShaderNodeTexImage', image=image(np.ones((64, 64, 3)) * 0.5, "rough", 'sRGB'))
    tree.links.new(rough.outputs[0], bsdf.inputs['Roughness'])
    bsdf.inputs['Specular'].default_value = 1
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


@case("image texture: box projection")
def box(scene):
    made, shown, _, tree = textured(projection='BOX')
    tree.links.new(tree.nodes.new('ShaderNodeTexCoord').outputs['Object'], shown.inputs[0])
    dressed(made)


@case("image texture over object coordinates")
def object_coordinates(scene):
    made, shown, _, tree = textured()
    tree.links.new(tree.nodes.new('ShaderNodeTexCoord').outputs['Object'], shown.inputs[0])
    dressed(made)


@case("image texture without UVs")
def no_uvs(scene):
    dressed(textured()[0])
    layers = the("ball").data.uv_layers
    layers.remove(layers[0])


@case("image texture over the second of two sets of UVs, and bump")
def two_uvs(scene):
    made, shown, bsdf, tree = textured()
    tree.links.new(node(tree, 'ShaderNodeUVMap', uv_map="small").outputs[0], shown.inputs[0])
    bumped = node(tree, 'ShaderNodeBump', Strength=0.2)
    tree.links.new(node(tree, 'ShaderNodeTexNoise', Scale=3).outputs[0], bumped.inputs['Height'])
    tree.links.new(bumped.outputs[0], bsdf.inputs['Normal'])
    layer = wall(made).data.uv_layers.new(name="small")
    for loop in layer.data:
        loop.uv *= 0.5


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


@case("image texture through ramp and curves")
def ramp(scene):
    made, shown, bsdf, tree = textured()
    ramped, curved = node(tree, 'ShaderNodeValToRGB'), node(tree, 'ShaderNodeRGBCurve')
    ramped.color_ramp.elements[0].color = (0.1, 0.3, 0.1, 1)
    for a, b in ((shown.outputs[0], ramped.inputs[0]), (ramped.outputs[0], curved.inputs['Color']), (curved.outputs[0], bsdf.inputs['Base Color'])):
        tree.links.new(a, b)
    dressed(made)


@case("missing image")
def missing(scene):
    made, shown, _, _ = textured()
    shown.image = bpy.data.images.load(image(checks(), "other").filepath_raw)
    shown.image.filepath = "/nowhere/a.png"
    dressed(made)


@case("movie or sequence of images")
def movie(scene):
    made, shown, _, _ = textured()
    shown.image.source = 'SEQUENCE'
    dressed(made)


@case("procedural textures: noise, Voronoi, bricks")
def noise(scene):
    made, bsdf, tree = principled()
    tree.links.new(node(tree, 'ShaderNodeTexVoronoi', Scale=4).outputs['Color'], bsdf.inputs['Base Color'])
    dressed(made)
    floored, bsdf, tree = principled()
    tree.links.new(node(tree, 'ShaderNodeTexBrick', Scale=3).outputs['Color'], bsdf.inputs['Base Color'])
    dressed(floored, "floor")


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


@case("colour of the object")
def object_colour(scene):
    made, bsdf, tree = principled()
    tree.links.new(tree.nodes.new('ShaderNodeObjectInfo').outputs['Color'], bsdf.inputs['Base Color'])
    the("ball").color = (0.2, 0.7, 0.3, 1)
    dressed(made)


def waves():
    y, x = np.mgrid[0:256, 0:256] / 256
    return np.repeat((0.5 + 0.5 * np.sin(x * 50) * np.sin(y * 50))[..., None], 3, -1)


@case("bump of an image")
def bump(scene):
    made, bsdf, tree = principled(Base_Color=(0.6, 0.4, 0.2, 1))
    shown, bumped = node(tree, 'ShaderNodeTexImage', image=image(waves(), "waves", 'Non-Color')), node(tree, 'ShaderNodeBump', Strength=0.3)
    tree.links.new(shown.outputs[0], bumped.inputs['Height']), tree.links.new(bumped.outputs[0], bsdf.inputs['Normal'])
    dressed(made)


@case("normal map")
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
    made.cycles.displacement_method = 'BOTH'
    dressed(made)
    the("ball").modifiers.new("fine", 'SUBSURF').render_levels = 3


@case("Bevel and Ambient Occlusion")
def bevel(scene):
    without("ball")
    made, bsdf, tree = principled(Base_Color=(0.6, 0.4, 0.2, 1))
    tree.links.new(node(tree, 'ShaderNodeBevel', Radius=0.1).outputs[0], bsdf.inputs['Normal'])
    tree.links.new(tree.nodes.new('ShaderNodeAmbientOcclusion').outputs[0], bsdf.inputs['Base Color'])
    cube(made)


# More of textures and surfaces

def link(tree, *pairs):
    for a, b in pairs:
        tree.links.new(a, b)


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


@case("Attribute nodes: colours of points, and UVs")
def attributes(scene):
    made, bsdf, tree = principled()
    link(tree, (node(tree, 'ShaderNodeAttribute', attribute_name="mask").outputs[0], bsdf.inputs['Base Color']))
    dressed(made)
    for i, one in enumerate(the("ball").data.color_attributes.new("mask", 'FLOAT_COLOR', 'POINT').data):
        one.color = (0.8, 0.2, 0.1 + 0.5 * (i % 2), 1)
    made, shown, _, tree = textured()
    link(tree, (node(tree, 'ShaderNodeAttribute', attribute_name="UVMap").outputs['Vector'], shown.inputs[0]))
    dressed(made, "floor")


@case("transparent image whose alpha is not linked")
def alpha_unused(scene):
    wall(textured(np.repeat(np.repeat(half(), 8, 0), 8, 1))[0])


@case("transparent image with an alpha that is linked, on instances")
def leaves(scene):
    made, shown, bsdf, tree = textured(np.repeat(np.repeat(half(), 8, 0), 8, 1))
    link(tree, (shown.outputs[1], bsdf.inputs['Alpha']))
    one = wall(made, 0.3, z=0.6)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4, size=3, location=(0, 0, 0.1))
    one.parent = dress(matte("lawn", (0.1, 0.3, 0.1, 1)))
    one.parent.instance_type = 'VERTS'


@case("image texture through hue, gamma, contrast and Invert")
def corrected(scene):
    made, shown, bsdf, tree = textured()
    made_of = [node(tree, 'ShaderNodeHueSaturation', Hue=0.6, Saturation=1.5, Value=0.8), node(tree, 'ShaderNodeGamma', Gamma=1.4),
               node(tree, 'ShaderNodeBrightContrast', Bright=0.05, Contrast=0.2), node(tree, 'ShaderNodeInvert', Fac=0.3)]
    source = shown.outputs[0]
    for one in made_of:
        link(tree, (source, one.inputs['Color']))
        source = one.outputs[0]
    link(tree, (source, bsdf.inputs['Base Color']))
    dressed(made)


@case("two images mixed by a third, with a mapping each")
def mixed_images(scene):
    made, shown, bsdf, tree = textured()
    other = node(tree, 'ShaderNodeTexImage', image=image(checks() * (1, 0.3, 0.2), "other"))
    mask = node(tree, 'ShaderNodeTexImage', image=image(waves(), "mask", 'Non-Color'))
    mix, where = node(tree, 'ShaderNodeMixRGB'), tree.nodes.new('ShaderNodeTexCoord')
    for i, one in enumerate((other, mask)):
        turn = node(tree, 'ShaderNodeMapping', Scale=(1.5 + i, 2, 1), Rotation=(0, 0, 0.3 + i), Location=(0.2, 0.1, 0))
        link(tree, (where.outputs['UV'], turn.inputs[0]), (turn.outputs[0], one.inputs[0]))
    link(tree, (mask.outputs[0], mix.inputs[0]), (shown.outputs[0], mix.inputs[1]), (other.outputs[0], mix.inputs[2]),
         (mix.outputs[0], bsdf.inputs['Base Color']))
    wall(made)


@case("image texture mirrored by nodes")
def mirrored(scene):
    made, shown, _, tree = textured(checks() * np.linspace(0.2, 1, 64)[None, :, None])
    where, parts, back = (tree.nodes.new('ShaderNode' + k) for k in ('TexCoord', 'SeparateXYZ', 'CombineXYZ'))
    link(tree, (where.outputs['UV'], parts.inputs[0]), (back.outputs[0], shown.inputs[0]))
    for i in range(2):
        times, fold = node(tree, 'ShaderNodeMath', operation='MULTIPLY'), node(tree, 'ShaderNodeMath', operation='PINGPONG')
        times.inputs[1].default_value, fold.inputs[1].default_value = 3, 1
        link(tree, (parts.outputs[i], times.inputs[0]), (times.outputs[0], fold.inputs[0]), (fold.outputs[0], back.inputs[i]))
    wall(made)


@case("mapping in the node of an image")
def own_mapping(scene):
    made, shown, _, _ = textured()
    shown.texture_mapping.scale, shown.texture_mapping.translation = (0.3, 0.2, 1), (0.1, 0.3, 0)
    wall(made)


@case("Mapping of the kinds Texture, Vector and Normal, with a location")
def mappings(scene):
    for x, kind in (-1.2, 'TEXTURE'), (0, 'VECTOR'), (1.2, 'NORMAL'):
        made, shown, _, tree = textured(checks()[:, ::-1] * np.linspace(0.2, 1, 64)[:, None, None])
        turn = node(tree, 'ShaderNodeMapping', vector_type=kind, Rotation=(0, 0, 0.3), Scale=(0.5, 0.3, 1))
        where = tree.nodes.new('ShaderNodeTexCoord')
        if 'Location' in turn.inputs and turn.inputs['Location'].enabled:
            turn.inputs['Location'].default_value = (0.2, 0.1, 0)
        link(tree, (where.outputs['UV'], turn.inputs[0]), (turn.outputs[0], shown.inputs[0]))
        wall(made, 0.5).location.x = x


@case("image texture over Generated coordinates, Extend, and Cubic")
def generated(scene):
    made, shown, _, tree = textured(extension='EXTEND', interpolation='Cubic')
    turn, where = node(tree, 'ShaderNodeMapping', Scale=(1.5, 1.5, 1), Location=(-0.2, -0.2, 0)), tree.nodes.new('ShaderNodeTexCoord')
    link(tree, (where.outputs['Generated'], turn.inputs[0]), (turn.outputs[0], shown.inputs[0]))
    dressed(made)


@case("gradient through a ramp")
def gradient(scene):
    made, bsdf, tree = principled()
    where, shown, ramped = (tree.nodes.new('ShaderNode' + k) for k in ('TexCoord', 'TexGradient', 'ValToRGB'))
    shown.gradient_type = 'SPHERICAL'
    ramped.color_ramp.interpolation = 'CONSTANT'
    ramped.color_ramp.elements[0].color, ramped.color_ramp.elements[1].position = (0.7, 0.1, 0.1, 1), 0.4
    link(tree, (where.outputs['Generated'], shown.inputs[0]), (shown.outputs[0], ramped.inputs[0]), (ramped.outputs[0], bsdf.inputs['Base Color']))
    dressed(made)


@case("texture over the coordinates of another object")
def other_coordinates(scene):
    made, shown, _, tree = textured()
    where = tree.nodes.new('ShaderNodeTexCoord')
    where.object = bpy.data.objects.new("place", None)
    scene.collection.objects.link(where.object)
    where.object.matrix_world = Matrix.LocRotScale((0.3, 0, 0), Euler((0.4, 0, 0.5)), (2, 2, 2))
    link(tree, (where.outputs['Object'], shown.inputs[0]))
    shown.projection = 'BOX'
    dressed(made)


@case("image of tiles (UDIM)")
def tiles(scene):
    made, shown, _, _ = textured()
    tiled = bpy.data.images.new("tiled", 64, 64, tiled=True)
    for number, colour in (1001, (0.8, 0.1, 0.1)), (1002, (0.1, 0.8, 0.1)):
        image(np.ones((64, 64, 3)) * colour, f"tile.{number}")
    tiled.filepath = os.path.join(FOLDER, "tile.<UDIM>.png")
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
    next(n for n in tree.nodes if n.type == 'NORMAL_MAP').inputs['Strength'].default_value = 2
    made = the("ball").data.materials[0].copy()
    next(n for n in made.node_tree.nodes if n.type == 'NORMAL_MAP').space = 'OBJECT'
    dressed(made, "floor")


@case("normal map that leans 30 degrees towards the light")
def leaning(scene):
    made, bsdf, tree = principled(Base_Color=(0.6, 0.4, 0.2, 1))
    tilted = np.ones((8, 8, 3)) * (0.5 + 0.5 * math.sin(0.52), 0.5, 0.5 + 0.5 * math.cos(0.52))
    shown, mapped = node(tree, 'ShaderNodeTexImage', image=image(tilted, "tilted", 'Non-Color')), tree.nodes.new('ShaderNodeNormalMap')
    link(tree, (shown.outputs[0], mapped.inputs['Color']), (mapped.outputs[0], bsdf.inputs['Normal']))
    wall(made)
    only('SUN', 3, (0, 0, 9), (0.2, 1.3, 0), angle=0)


@case("normal map under bump")
def chained(scene):
    normal_map(scene)
    tree = the("ball").data.materials[0].node_tree
    bsdf, mapped = (next(n for n in tree.nodes if n.type == k) for k in ('BSDF_PRINCIPLED', 'NORMAL_MAP'))
    bumped = node(tree, 'ShaderNodeBump', Strength=0.3)
    link(tree, (node(tree, 'ShaderNodeTexNoise', Scale=6).outputs[0], bumped.inputs['Height']), (mapped.outputs[0], bumped.inputs['Normal']),
         (bumped.outputs[0], bsdf.inputs['Normal']))


@case("custom normals, and smooth shading with an angle")
def custom_normals(scene):
    without("ball")
    o = cube(surface('BsdfGlossy', Roughness=0.3)[0], 1.2, (0, 0, 0.6))
    for polygon in o.data.polygons:
        polygon.use_smooth = True
    o.data.use_auto_smooth = True
    o.data.normals_split_custom_set_from_vertices([v.co.normalized() for v in o.data.vertices])


@case("modifiers: array, mirror, solidify, bevel with weighted normals")
def more_modifiers(scene):
    without("ball")
    o = cube(matte("box", (0.6, 0.2, 0.1, 1)), 0.6, (0.8, 0, 0.4))
    o.scale = (-1, 1.3, 0.8)
    for name, kind, values in (("bevel", 'BEVEL', dict(width=0.08, segments=3)), ("copies", 'ARRAY', dict(count=3)),
                               ("other", 'MIRROR', dict(mirror_object=the("floor"))), ("normals", 'WEIGHTED_NORMAL', {})):
        made = o.modifiers.new(name, kind)
        for key, value in values.items():
            setattr(made, key, value)
    for polygon in o.data.polygons:
        polygon.use_smooth = True
    o.data.use_auto_smooth = True


@case("hair whose density is a group of vertices")
def hair_by_group(scene):
    o = lawn()
    group = o.vertex_groups.new(name="dense")
    group.add([v.index for v in o.data.vertices if v.co.x > 0], 1, 'REPLACE')
    particles(o, count=1000, hair_length=0.6, root_radius=5)
    o.particle_systems[0].vertex_group_density = "dense"


@case("two-sided material by Backfacing")
def two_sided(scene):
    made, front, tree = surface('BsdfDiffuse', Color=(0.8, 0.1, 0.1, 1))
    behind = node(tree, 'ShaderNodeBsdfDiffuse', Color=(0.1, 0.1, 0.8, 1))
    mix, where = tree.nodes.new('ShaderNodeMixShader'), tree.nodes.new('ShaderNodeNewGeometry')
    link(tree, (where.outputs['Backfacing'], mix.inputs[0]), (front.outputs[0], mix.inputs[1]), (behind.outputs[0], mix.inputs[2]))
    cover(mix, tree)
    wall(made).rotation_euler.z = math.pi


@case("colour by the facing of Layer Weight")
def by_facing(scene):
    made, bsdf, tree = principled()
    ramped = node(tree, 'ShaderNodeValToRGB')
    link(tree, (node(tree, 'ShaderNodeLayerWeight', Blend=0.5).outputs['Facing'], ramped.inputs[0]), (ramped.outputs[0], bsdf.inputs['Base Color']))
    dressed(made)


@case("emission by a property of the object")
def emission_property(scene):
    made, bsdf, tree = surface('Emission')
    link(tree, (node(tree, 'ShaderNodeAttribute', attribute_type='OBJECT', attribute_name="power").outputs['Fac'], bsdf.inputs[1]))
    the("ball")["power"] = 3.0
    dressed(made)


@case("emission by the index and the colour of the object")
def emission_index(scene):
    made, bsdf, tree = surface('Emission')
    info = tree.nodes.new('ShaderNodeObjectInfo')
    link(tree, (info.outputs['Object Index'], bsdf.inputs[1]), (info.outputs['Color'], bsdf.inputs[0]))
    the("ball").pass_index, the("ball").color = 3, (0.3, 0.6, 1, 1)
    dressed(made)


@case("emission that the camera sees weaker")
def emission_by_rays(scene):
    made, bsdf, tree = surface('Emission')
    ranged = node(tree, 'ShaderNodeMapRange')
    ranged.inputs[3].default_value, ranged.inputs[4].default_value = 10, 1
    link(tree, (tree.nodes.new('ShaderNodeLightPath').outputs['Is Camera Ray'], ranged.inputs[0]), (ranged.outputs[0], bsdf.inputs[1]))
    dressed(made)


@case("Add of Transparent and Emission, and their Mix")
def glow(scene):
    for x, kind in (-0.8, 'AddShader'), (0.8, 'MixShader'):
        made, bsdf, tree = surface('Emission', Strength=0.5, Color=(1, 0.3, 0.1, 1))
        both, clear = tree.nodes.new('ShaderNode' + kind), tree.nodes.new('ShaderNodeBsdfTransparent')
        inputs = [s for s in both.inputs if s.type == 'SHADER']
        link(tree, (clear.outputs[0], inputs[0]), (bsdf.outputs[0], inputs[1]))
        cover(both, tree)
        wall(made, 0.6).location.x = x


@case("Add of Diffuse and Glossy")
def added_shine(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    add = tree.nodes.new('ShaderNodeAddShader')
    link(tree, (base.outputs[0], add.inputs[0]), (node(tree, 'ShaderNodeBsdfGlossy', Color=(0.2, 0.2, 0.2, 1)).outputs[0], add.inputs[1]))
    cover(add, tree)
    dressed(made)


@case("glass that is clear to shadows and diffuse light, by a Math node")
def glass_by_math(scene):
    made, bsdf, tree = surface('BsdfGlass', Roughness=0, IOR=1.45)
    rays, clear, mix, most = (tree.nodes.new('ShaderNode' + k) for k in ('LightPath', 'BsdfTransparent', 'MixShader', 'Math'))
    most.operation = 'MAXIMUM'
    link(tree, (rays.outputs['Is Shadow Ray'], most.inputs[0]), (rays.outputs['Is Diffuse Ray'], most.inputs[1]), (most.outputs[0], mix.inputs[0]),
         (bsdf.outputs[0], mix.inputs[1]), (clear.outputs[0], mix.inputs[2]))
    cover(mix, tree)
    sheet(made)


@case("Mix of Refraction and Glossy by Fresnel")
def built_glass(scene):
    made, base, tree = surface('BsdfRefraction', Roughness=0, IOR=1.45)
    shine, fresnel = node(tree, 'ShaderNodeBsdfGlossy', Roughness=0), node(tree, 'ShaderNodeFresnel', IOR=1.45)
    mix = tree.nodes.new('ShaderNodeMixShader')
    link(tree, (fresnel.outputs[0], mix.inputs[0]), (base.outputs[0], mix.inputs[1]), (shine.outputs[0], mix.inputs[2]))
    cover(mix, tree)
    dressed(made)


@case("leaf with an alpha: Transparent, Diffuse and Translucent")
def leaf_cut(scene):
    leaf(scene)
    tree = the("wall").data.materials[0].node_tree
    inner = next(n for n in tree.nodes if n.type == 'MIX_SHADER')
    shown = node(tree, 'ShaderNodeTexImage', image=image(np.repeat(np.repeat(half(), 8, 0), 8, 1)))
    clear, mix = tree.nodes.new('ShaderNodeBsdfTransparent'), tree.nodes.new('ShaderNodeMixShader')
    link(tree, (shown.outputs[1], mix.inputs[0]), (clear.outputs[0], mix.inputs[1]), (inner.outputs[0], mix.inputs[2]))
    cover(mix, tree)


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
    group = bpy.data.node_groups.new("points", 'GeometryNodeTree')
    group.inputs.new('NodeSocketGeometry', "in"), group.outputs.new('NodeSocketGeometry', "out")
    inlet, outlet, made = (group.nodes.new(k) for k in ('NodeGroupInput', 'NodeGroupOutput', 'GeometryNodeMeshToPoints'))
    made.inputs['Radius'].default_value = 0.3
    link(group, (inlet.outputs[0], made.inputs[0]), (made.outputs[0], outlet.inputs[0]))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=3, size=3, location=(0, 0, 0.4))
    dress(matte("red", (0.6, 0.2, 0.1, 1))).modifiers.new("points", 'NODES').node_group = group


@case("geometry nodes: a material that they set, and an attribute that they name")
def node_attribute(scene):
    made, bsdf, tree = principled()
    link(tree, (node(tree, 'ShaderNodeAttribute', attribute_name="height").outputs['Fac'], bsdf.inputs['Base Color']))
    group = bpy.data.node_groups.new("paint", 'GeometryNodeTree')
    group.inputs.new('NodeSocketGeometry', "in"), group.outputs.new('NodeSocketGeometry', "out")
    inlet, outlet, store, dressing, place, parts = (group.nodes.new(k) for k in (
        'NodeGroupInput', 'NodeGroupOutput', 'GeometryNodeStoreNamedAttribute', 'GeometryNodeSetMaterial', 'GeometryNodeInputPosition',
        'ShaderNodeSeparateXYZ'))
    store.inputs['Name'].default_value, dressing.inputs['Material'].default_value = "height", made
    value = next(s for s in store.inputs if s.type == 'VALUE' and s.enabled)
    link(group, (inlet.outputs[0], store.inputs[0]), (place.outputs[0], parts.inputs[0]), (parts.outputs[2], value),
         (store.outputs[0], dressing.inputs[0]), (dressing.outputs[0], outlet.inputs[0]))
    the("ball").modifiers.new("paint", 'NODES').node_group = group


# More of lamps, cameras, layers and worlds

@case("instanced collection with lamps in it, scaled and mirrored")
def lamps_in_collection(scene):
    without("key")
    parts = bpy.data.collections.new("parts")
    for made in (lamp('AREA', 100, (1, 0, 2), (0.4, 0, 0), size=0.5, shape='ELLIPSE', size_y=1),
                 lamp('SPOT', 200, (-1, -1, 2), (0.5, 0, 0), shadow_soft_size=0.1, spot_size=1)):
        parts.objects.link(made)
        scene.collection.objects.unlink(made)
    for x, scale in (-1.5, (1, 1, 1)), (1.5, (-1.5, 1, 1.2)):
        copy = bpy.data.objects.new("copy", None)
        copy.instance_type, copy.instance_collection, copy.location, copy.scale = 'COLLECTION', parts, (x, 0, 0.5), scale
        scene.collection.objects.link(copy)


@case("lamps whose size, colour and energy are animated, and a driver")
def animated_lamps(scene):
    light = the("key").data
    keyed(light, "size", 1, 1, 0.2, 2), keyed(light, "energy", 1, 1, 200, 400)
    keyed(light, "color", (1, 1, 1), (1, 1, 1), (1, 0.5, 0.5), (1, 0.2, 0.2))
    driver = the("ball").driver_add("location", 0).driver
    driver.expression = "frame / 2"
    scene.frame_set(2)


@case("sun with a blackbody and a strength of nodes")
def sun_nodes(scene):
    tree, emission = noded(only('SUN', 1, (0, 0, 5), (0.7, 0, 0.5), angle=0.1).data)
    link(tree, (node(tree, 'ShaderNodeBlackbody', Temperature=4500).outputs[0], emission.inputs[0]))
    emission.inputs[1].default_value = 2.5


@case("strength of a lamp by a Math node")
def lamp_math(scene):
    tree, emission = noded(the("key").data)
    times = node(tree, 'ShaderNodeMath', operation='MULTIPLY')
    times.inputs[0].default_value, times.inputs[1].default_value = 0.5, 4
    link(tree, (times.outputs[0], emission.inputs[1]))


@case("spot lamp that is scaled")
def spot_scaled(scene):
    o = only('SPOT', 800, (1, -2, 3), (0.4, 0, 0.3), shadow_soft_size=0, spot_size=1, spot_blend=0.2)
    o.scale = (2, 1, 1)


@case("point lamp with a radius that is scaled, and a sheared area lamp")
def lamps_scaled(scene):
    only('POINT', 100, (1, -2, 3), shadow_soft_size=0.2).scale = (2, 2, 2)
    parent = bpy.data.objects.new("parent", None)
    scene.collection.objects.link(parent)
    parent.scale = (2, 1, 1)
    o = lamp('AREA', 100, (-1, 0, 3), (0.3, 0, 0.6), size=1)
    o.parent = parent


@case("scaled camera that tracks an object, focus on an object")
def tracking(scene):
    camera = scene.camera
    camera.scale = (2, 2, 2)
    camera.constraints.new('TRACK_TO').target = the("ball")
    camera.data.dof.use_dof, camera.data.dof.focus_object, camera.data.dof.aperture_fstop = True, the("ball"), 0.2


@case("orthographic camera, portrait, with a shift")
def orthographic_portrait(scene):
    orthographic(scene)
    shift(scene)


@case("camera of a field of view, another sensor")
def field_of_view(scene):
    data = scene.camera.data
    data.lens_unit, data.sensor_width = 'FOV', 24
    data.angle = 1.2


@case("border, not cropped")
def border_whole(scene):
    border(scene)
    scene.render.use_crop_to_border = False


@case("all of it 20 km from the origin, in feet")
def far_away(scene):
    scene.unit_settings.system, scene.unit_settings.length_unit = 'IMPERIAL', 'FEET'
    for o in scene.objects:
        o.location = [a + b for a, b in zip(o.location, (15000, 12000, 100))]


@case("look, gamma and curves of the view")
def looks(scene):
    view = scene.view_settings
    view.view_transform, view.look, view.gamma, view.exposure = 'Filmic', 'High Contrast', 1.2, 0.5


@case("two view layers, one with an excluded collection")
def layers(scene):
    made = bpy.data.collections.new("out")
    scene.collection.children.link(made)
    made.objects.link(the("ball"))
    scene.collection.objects.unlink(the("ball"))
    scene.view_layers.new("other")
    scene.view_layers[0].layer_collection.children["out"].exclude = True


@case("world: mirror ball, through hue and strength")
def world_ball(scene):
    world_image(scene)
    tree = scene.world.node_tree
    made, hue = next(n for n in tree.nodes if n.type == 'TEX_ENVIRONMENT'), node(tree, 'ShaderNodeHueSaturation', Hue=0.7, Saturation=1.5)
    made.projection = 'MIRROR_BALL'
    link(tree, (made.outputs[0], hue.inputs['Color']), (hue.outputs[0], tree.nodes["Background"].inputs[0]))
    tree.nodes["Background"].inputs[1].default_value = 1.5


@case("world: gradient of nodes, and Hosek's sky")
def world_gradient(scene):
    tree = scene.world.node_tree
    made, mix = node(tree, 'ShaderNodeTexSky', sky_type='HOSEK_WILKIE'), node(tree, 'ShaderNodeMixRGB', Fac=0.5)
    where, shown = tree.nodes.new('ShaderNodeTexCoord'), node(tree, 'ShaderNodeTexGradient')
    link(tree, (where.outputs['Generated'], shown.inputs[0]), (shown.outputs[0], mix.inputs[1]), (made.outputs[0], mix.inputs[2]),
         (mix.outputs[0], tree.nodes["Background"].inputs[0]))


@case("shadow terminator of an object")
def terminator(scene):
    without("ball")
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=0.7, location=(0, 0, 0.7))
    o = dress(matte("red", (0.6, 0.2, 0.1, 1)), smooth=True)
    o.cycles.shadow_terminator_offset = 0.5
    only('SUN', 3, (0, 0, 9), (0.9, 0.9, 0), angle=0)


@case("curve with the profile of another, and an image texture")
def curves(scene):
    without("ball")
    bpy.ops.curve.primitive_bezier_circle_add(radius=0.3, location=(0, 50, 0))
    profile = bpy.context.object
    bpy.ops.curve.primitive_bezier_curve_add(radius=1.2, location=(0, 0, 0.6))
    o = bpy.context.object
    o.data.bevel_mode, o.data.bevel_object, o.data.use_fill_caps = 'OBJECT', profile, True
    o.data.materials.append(textured()[0])


@case("text with an image texture")
def text_uvs(scene):
    without("ball")
    bpy.ops.object.text_add(location=(-1.5, 0, 0.2), rotation=(1.2, 0, 0))
    o = bpy.context.object
    o.data.body, o.data.extrude, o.data.bevel_depth, o.data.size = "lull", 0.1, 0.02, 1.6
    o.data.materials.append(textured()[0])


@case("smooth shading of few faces, under a low sun")
def coarse(scene):
    terminator(scene)
    next(o for o in scene.objects if o.type == 'MESH' and o.name != "floor").cycles.shadow_terminator_offset = 0


@case("two outputs, for Cycles and for Eevee")
def outputs(scene):
    made, bsdf, tree = surface('BsdfDiffuse', Color=(0.1, 0.6, 0.1, 1))
    first = tree.get_output_node('ALL')
    first.target = 'CYCLES'
    other = node(tree, 'ShaderNodeOutputMaterial', target='EEVEE')
    link(tree, (node(tree, 'ShaderNodeEmission', Strength=5).outputs[0], other.inputs[0]))
    other.is_active_output = True
    dressed(made)


@case("two Principled surfaces mixed by an image")
def mixed_by_image(scene):
    made, metal, tree = principled(Metallic=1, Roughness=0.2, Base_Color=(0.9, 0.6, 0.3, 1))
    other, mix = node(tree, 'ShaderNodeBsdfPrincipled', Roughness=0.7, Base_Color=(0.1, 0.2, 0.5, 1)), tree.nodes.new('ShaderNodeMixShader')
    mask = node(tree, 'ShaderNodeTexImage', image=image(np.round(waves()), "mask", 'Non-Color'))
    link(tree, (mask.outputs[0], mix.inputs[0]), (metal.outputs[0], mix.inputs[1]), (other.outputs[0], mix.inputs[2]))
    cover(mix, tree)
    dressed(made)


@case("Mix of Glass and Transparent by a number")
def weak_glass(scene):
    made, bsdf, tree = surface('BsdfGlass', Roughness=0, IOR=1.45)
    mix = node(tree, 'ShaderNodeMixShader', Fac=0.6)
    link(tree, (bsdf.outputs[0], mix.inputs[1]), (tree.nodes.new('ShaderNodeBsdfTransparent').outputs[0], mix.inputs[2]))
    cover(mix, tree)
    dressed(made)


@case("alpha of another image than the colour's, with another mapping")
def alpha_apart(scene):
    made, shown, bsdf, tree = textured()
    turn, where = node(tree, 'ShaderNodeMapping', Scale=(1.5, 1.5, 1), Rotation=(0, 0, 0.5)), tree.nodes.new('ShaderNodeTexCoord')
    mask = node(tree, 'ShaderNodeTexImage', image=image(np.round(waves()), "mask", 'Non-Color'))
    link(tree, (where.outputs['UV'], turn.inputs[0]), (turn.outputs[0], mask.inputs[0]), (mask.outputs[0], bsdf.inputs['Alpha']))
    wall(made)


@case("images whose colour spaces are Linear, Raw and Filmic sRGB")
def more_spaces(scene):
    for x, space in (-1.2, 'Linear'), (0, 'Raw'), (1.2, 'Filmic sRGB'):
        made, shown, _, _ = textured(checks() * (1, 0.7, 0.4))
        shown.image.colorspace_settings.name = space
        wall(made, 0.5).location.x = x


@case("image of 16 bits, and one of floats")
def deep(scene):
    for x, kind in (-0.8, 'PNG'), (0.8, 'OPEN_EXR'):
        shown = bpy.data.images.new("deep", 64, 64, float_buffer=True)
        shown.pixels.foreach_set(np.concatenate([checks() * (1, 0.7, 0.4), np.ones((64, 64, 1))], 2).astype(np.float32).ravel())
        shown.filepath_raw, shown.file_format = os.path.join(FOLDER, "deep." + ("png" if kind == 'PNG' else "exr")), kind
        shown.save()
        made, texture, _, _ = textured()
        texture.image = bpy.data.images.load(shown.filepath_raw)
        wall(made, 0.7).location.x = x


@case("image whose alpha is another channel, and one whose alpha is ignored")
def alpha_modes(scene):
    for x, mode in (-0.8, 'CHANNEL_PACKED'), (0.8, 'NONE'):
        made, shown, bsdf, tree = textured(np.repeat(np.repeat(half(), 8, 0), 8, 1))
        shown.image.alpha_mode = mode
        link(tree, (shown.outputs[1], bsdf.inputs['Roughness']))
        wall(made, 0.7).location.x = x


@case("emission of the front alone, by Backfacing")
def one_sided_light(scene):
    without("key")
    made, bsdf, tree = surface('Emission', Strength=6)
    clear, mix, where = (tree.nodes.new('ShaderNode' + k) for k in ('BsdfTransparent', 'MixShader', 'NewGeometry'))
    link(tree, (where.outputs['Backfacing'], mix.inputs[0]), (bsdf.outputs[0], mix.inputs[1]), (clear.outputs[0], mix.inputs[2]))
    cover(mix, tree)
    bpy.ops.mesh.primitive_plane_add(size=2, location=(0, 0.5, 2.6))
    dress(made).rotation_euler.x = 2.6


@case("waves, Musgrave and magic on a scaled object")
def scaled_textures(scene):
    made, bsdf, tree = principled()
    where, mix = tree.nodes.new('ShaderNodeTexCoord'), tree.nodes.new('ShaderNodeMixRGB')
    wave, magic = node(tree, 'ShaderNodeTexWave', Scale=2), node(tree, 'ShaderNodeTexMagic', Scale=3)
    link(tree, (where.outputs['Object'], wave.inputs[0]), (where.outputs['Object'], magic.inputs[0]), (wave.outputs[0], mix.inputs[1]),
         (magic.outputs[0], mix.inputs[2]), (node(tree, 'ShaderNodeTexMusgrave', Scale=3).outputs[0], mix.inputs[0]), (mix.outputs[0], bsdf.inputs['Base Color']))
    dressed(made)
    the("ball").scale = (-1.5, 0.8, 1)


@case("normal map on an object of uneven negative scale")
def normal_mirrored(scene):
    normal_map(scene)
    the("ball").scale = (-1.4, 0.8, 1)


@case("displacement that only bumps, by an image")
def bump_by_displacement(scene):
    displacement(scene)
    the("ball").data.materials[0].cycles.displacement_method = 'BUMP'


@case("objects and collections that are hidden in the viewport alone")
def hidden_in_viewport(scene):
    made = bpy.data.collections.new("hidden")
    scene.collection.children.link(made)
    for x, o in (-1.5, cube(matte("one", (0.1, 0.6, 0.1, 1)), 0.8)), (1.5, cube(matte("two", (0.1, 0.1, 0.6, 1)), 0.8)):
        o.location.x = x
    made.objects.link(o)
    scene.collection.objects.unlink(o)
    scene.view_layers[0].layer_collection.children["hidden"].hide_viewport = True
    scene.objects[-2].hide_set(True)
    the("ball").hide_viewport = True
    key = the("key")
    key.hide_set(True)


@case("instanced collection within an instanced collection, with a lamp and textures by place")
def nested(scene):
    without("ball")
    inner, outer = bpy.data.collections.new("inner"), bpy.data.collections.new("outer")
    made, bsdf, tree = principled()
    link(tree, (tree.nodes.new('ShaderNodeTexCoord').outputs['Generated'], bsdf.inputs['Base Color']))
    for o in cube(made, 0.6, (0, 0, 0.3)), lamp('POINT', 10, (0, -0.6, 0.8)):
        inner.objects.link(o)
        scene.collection.objects.unlink(o)
    for x, y, into, of in (-0.6, 0, outer, inner), (0.6, 0.3, outer, inner), (-1, 0, scene.collection, outer), (1.3, 0.5, scene.collection, outer):
        copy = bpy.data.objects.new("copy", None)
        copy.instance_type, copy.instance_collection, copy.location = 'COLLECTION', of, (x, y, 0)
        copy.rotation_euler.z, copy.scale = x, (1, 1.3, 1)
        into.objects.link(copy)


@case("particles of a collection, turned and scaled at random")
def particle_collection(scene):
    parts = bpy.data.collections.new("parts")
    for o in cube(matte("one", (0.1, 0.6, 0.1, 1)), 0.3, (0, 50, 0)), cube(matte("two", (0.6, 0.1, 0.1, 1)), 0.2, (3, 50, 0)):
        parts.objects.link(o)
        scene.collection.objects.unlink(o)
    particles(lawn(), count=60, render_type='COLLECTION', instance_collection=parts, particle_size=0.8, size_random=0.7, use_advanced_hair=True,
              use_rotations=True, rotation_factor_random=0.8, phase_factor_random=2)


@case("hair with interpolated children")
def hair_children(scene):
    particles(lawn(), count=100, hair_length=0.6, root_radius=5, child_type='INTERPOLATED', rendered_child_count=10)


@case("object of no height, with a texture over places, and loose edges")
def flat(scene):
    made, bsdf, tree = principled()
    link(tree, (node(tree, 'ShaderNodeTexNoise', Scale=3).outputs[1], bsdf.inputs['Base Color']))
    o = cube(made, 1.5, (1, 0, 0.3))
    o.scale.z = 0
    mesh = bpy.data.meshes.new("edges")
    mesh.from_pydata([(0, 0, 0), (0, 0, 1)], [(0, 1)], [])
    scene.collection.objects.link(bpy.data.objects.new("edges", mesh))


@case("image texture without an image")
def no_image(scene):
    made, shown, _, _ = textured()
    shown.image = None
    dressed(made)


@case("names with slashes, quotes and letters of all kinds")
def names(scene):
    made = textured(checks())[0]
    dressed(made)
    made.name, the("ball").name, the("key").name, scene.name = "Wände/\"weiß\" 木", "Tür/1 'a' \\b", "лампа", "Szene: \"1/2\""


@case("Principled: coloured glass, rough")
def coloured_glass(scene):
    dressed(principled(Transmission=1, Roughness=0.3, Base_Color=(0.8, 0.4, 0.3, 1))[0])


@case("Principled: half a metal, half a glass")
def halves(scene):
    dressed(principled(Metallic=0.5, Roughness=0.3, Base_Color=(0.8, 0.4, 0.3, 1))[0])
    other = principled(Transmission=0.5, Roughness=0.2, Base_Color=(0.3, 0.4, 0.8, 1))[0]
    bpy.ops.mesh.primitive_uv_sphere_add(location=(1.6, 0, 0.7), radius=0.7)
    dress(other, smooth=True)


@case("water in a glass: one interface in another")
def water(scene):
    dressed(surface('BsdfGlass', Roughness=0, IOR=1.5)[0])
    bpy.ops.mesh.primitive_uv_sphere_add(location=(0, 0, 0.7), radius=0.5, segments=32, ring_count=16)
    dress(surface('BsdfGlass', Roughness=0, IOR=1.33, Color=(0.5, 0.7, 1, 1))[0], smooth=True)


@case("Mix by Fresnel of an index of 2.5: Diffuse and Glossy")
def coats(scene):
    coated(scene)
    next(n for n in the("ball").data.materials[0].node_tree.nodes if n.type == 'FRESNEL').inputs[0].default_value = 2.5


@case("Mix by Facing: Diffuse and Glossy")
def coat_by_facing(scene):
    coated(scene)
    tree = the("ball").data.materials[0].node_tree
    link(tree, (node(tree, 'ShaderNodeLayerWeight', Blend=0.5).outputs['Facing'], next(n for n in tree.nodes if n.type == 'MIX_SHADER').inputs[0]))


@case("Mix by Fresnel: Diffuse and tinted Glossy")
def coat_tinted(scene):
    coats(scene)
    next(n for n in the("ball").data.materials[0].node_tree.nodes if n.type == 'BSDF_GLOSSY').inputs[0].default_value = (0.8, 0.2, 0.1, 1)


@case("Diffuse, Translucent and Glossy mixed")
def three_mixed(scene):
    leaf(scene)
    tree = the("wall").data.materials[0].node_tree
    inner = next(n for n in tree.nodes if n.type == 'MIX_SHADER')
    mix = node(tree, 'ShaderNodeMixShader', Fac=0.2)
    link(tree, (inner.outputs[0], mix.inputs[1]), (node(tree, 'ShaderNodeBsdfGlossy', Roughness=0.3).outputs[0], mix.inputs[2]))
    cover(mix, tree)


@case("Principled: emission of an image times a number")
def screens(scene):
    made, bsdf, tree = principled(Emission_Strength=2, Base_Color=(0.1, 0.1, 0.1, 1))
    link(tree, (node(tree, 'ShaderNodeTexImage', image=image(checks() * (1, 0.5, 0.2), "screen")).outputs[0], bsdf.inputs['Emission']))
    wall(made)


@case("frosted pane of glass, as a slab")
def frosted(scene):
    pane(scene)
    scene.objects[-1].data.materials[0].node_tree.nodes["Glass BSDF"].inputs['Roughness'].default_value = 0.3


@case("lampshade: Translucent around a lamp")
def shade(scene):
    without("ball", "key")
    bpy.ops.mesh.primitive_cylinder_add(radius=0.6, depth=1, location=(0, 0, 1), end_fill_type='NOTHING')
    dress(surface('BsdfTranslucent', Color=(0.8, 0.7, 0.5, 1))[0], smooth=True)
    lamp('POINT', 80, (0, 0, 1), shadow_soft_size=0.1)


@case("world: Preetham's sky, and Nishita's without a disc, mixed")
def skies(scene):
    tree = scene.world.node_tree
    mix = node(tree, 'ShaderNodeMixRGB', Fac=0.5)
    link(tree, (node(tree, 'ShaderNodeTexSky', sky_type='PREETHAM').outputs[0], mix.inputs[1]),
         (node(tree, 'ShaderNodeTexSky', sky_type='NISHITA', sun_disc=False).outputs[0], mix.inputs[2]),
         (mix.outputs[0], tree.nodes["Background"].inputs[0]))
    tree.nodes["Background"].inputs[1].default_value = 0.1


@case("orthographic camera with depth of field")
def orthographic_focus(scene):
    orthographic(scene)
    dof = scene.camera.data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 6, 2


# Rooms

@case("room of diffuse surfaces, lit by an area lamp")
def interior(scene):
    room(scene, matte("white", (0.8, 0.8, 0.8, 1)))


@case("room of Principled surfaces")
def interior_principled(scene):
    room(scene, principled(Base_Color=(0.8, 0.8, 0.8, 1))[0])


def room(scene, made):
    without("ball", "floor")
    cube(made, 4, (0, 0, 2))
    scene.camera.location, scene.camera.rotation_euler = (0, -1.8, 2), (math.pi / 2, 0, 0)
    scene.camera.data.lens = 18
    key = the("key")
    key.location, key.rotation_euler, key.data.energy = (0, 0, 3.9), (0, 0, 0), 60
    c = scene.cycles
    scene.lull.max_depth = c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = 32


def render(scene, engine, path, spp):
    r, c, l = scene.render, scene.cycles, scene.lull
    r.engine, r.filepath = engine, path
    r.image_settings.file_format, r.image_settings.color_depth, r.image_settings.color_mode = 'OPEN_EXR', '32', 'RGBA'
    r.image_settings.exr_codec = 'ZIP'
    c.samples, c.use_denoising, c.use_adaptive_sampling = spp, False, False
    c.pixel_filter_type, c.filter_width = 'BOX', 1
    l.stop_by, l.spp, l.denoise = 'SAMPLES', spp, False
    try:
        bpy.ops.render.render(write_still=True)
    except RuntimeError as e:
        print("Error:", str(e).strip())


def main():
    global FOLDER
    o = json.loads(sys.argv[-1])
    FOLDER = o["folder"]
    for name in o["names"] or [n for n in CASES if n not in o["there"]]:
        title, change = CASES[name]
        print(f"CASE {name} | {title}", flush=True)
        scene = begin()
        scene.render.resolution_x, scene.render.resolution_y = o["size"]
        c = scene.cycles
        c.sample_clamp_indirect = c.light_sampling_threshold = c.blur_glossy = 0
        c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = scene.lull.max_depth = 12
        try:
            change(scene)
        except (RuntimeError, AttributeError, KeyError, TypeError) as e:
            print("Info: not made:", e)
            continue
        for engine in 'CYCLES', 'LULL':
            path = os.path.join(FOLDER, f"{name}.{engine.lower()}.exr")
            if os.path.exists(path):
                os.remove(path)
            render(scene, engine, path, o["spp"])
        print("MADE", flush=True)
    print("ALL", *CASES, flush=True)


main()
