"""Further features of lamps, cameras, view layers and worlds."""
import bpy
import numpy as np

from compatible import LINEAR, RAW, displace, offset_shadow
from cases import (
    case, checks, cube, dress, dressed, empty, first, floats, image, lamp, link, matte, mix, node, parts_of, principled, set_apart, surface,
    textured, the, wall, without)
from camera import border, orthographic
from lamps import noded, only
from surfaces import coated, half, pane
from textures import displacement, waves


@case("instanced collection with lamps in it, scaled and mirrored")
def lamps_in_collection(scene):
    without("key")
    parts = parts_of(lamp('AREA', 100, (1, 0, 2), (0.4, 0, 0), size=0.5, shape='ELLIPSE', size_y=1),
                     lamp('SPOT', 200, (-1, -1, 2), (0.5, 0, 0), shadow_soft_size=0.1, spot_size=1))
    for x, scale in (-1.5, (1, 1, 1)), (1.5, (-1.5, 1, 1.2)):
        empty(parts, location=(x, 0, 0.5), scale=scale)


@case("sun with a blackbody and a strength of nodes")
def sun_nodes(scene):
    tree, emission = noded(only('SUN', 1, (0, 0, 5), (0.7, 0, 0.5), angle=0.1).data)
    link(tree, (node(tree, 'ShaderNodeBlackbody', Temperature=4500).outputs[0], emission.inputs[0]))
    emission.inputs[1].default_value = 2.5


@case("spot lamp that is scaled")
def spot_scaled(scene):
    o = only('SPOT', 800, (1, -2, 3), (0.4, 0, 0.3), shadow_soft_size=0, spot_size=1, spot_blend=0.2)
    o.scale = (2, 1, 1)


@case("point lamp with a radius that is scaled, and a sheared area lamp")
def lamps_scaled(scene):
    only('POINT', 100, (1, -2, 3), shadow_soft_size=0.2).scale = (2, 2, 2)
    lamp('AREA', 100, (-1, 0, 3), (0.3, 0, 0.6), size=1).parent = empty(scale=(2, 1, 1))


@case("scaled camera that tracks an object, focus on an object")
def tracking(scene):
    camera = scene.camera
    camera.scale = (2, 2, 2)
    camera.constraints.new('TRACK_TO').target = the("ball")
    camera.data.dof.use_dof, camera.data.dof.focus_object, camera.data.dof.aperture_fstop = True, the("ball"), 0.2


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
    scene.view_layers.new("other")
    set_apart(scene, the("ball"), "out").exclude = True


@case("shadow terminator of an object")
def terminator(scene):
    without("ball")
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2, radius=0.7, location=(0, 0, 0.7))
    o = dress(matte("red", (0.6, 0.2, 0.1, 1)), smooth=True)
    offset_shadow(o, 0.5)
    only('SUN', 3, (0, 0, 9), (0.9, 0.9, 0), angle=0)


@case("text with an image texture")
def text_uvs(scene):
    without("ball")
    bpy.ops.object.text_add(location=(-1.5, 0, 0.2), rotation=(1.2, 0, 0))
    o = bpy.context.object
    o.data.body, o.data.extrude, o.data.bevel_depth, o.data.size = "lull", 0.1, 0.02, 1.6
    o.data.materials.append(textured()[0])


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
    mask = node(tree, 'ShaderNodeTexImage', image=image(np.round(waves()), "mask", 'Non-Color'))
    mix(tree, mask.outputs[0], metal, node(tree, 'ShaderNodeBsdfPrincipled', Roughness=0.7, Base_Color=(0.1, 0.2, 0.5, 1)))
    dressed(made)


@case("Mix of Glass and Transparent by a number")
def weak_glass(scene):
    made, bsdf, tree = surface('BsdfGlass', Roughness=0, IOR=1.45)
    mix(tree, 0.6, bsdf, tree.nodes.new('ShaderNodeBsdfTransparent'))
    dressed(made)
    scene.cycles.samples = scene.lull.spp = 1024  # of caustics, whose noise is above the limits at 64


@case("alpha of another image than the colour's, with another mapping")
def alpha_apart(scene):
    made, shown, bsdf, tree = textured()
    turn, where = node(tree, 'ShaderNodeMapping', Scale=(1.5, 1.5, 1), Rotation=(0, 0, 0.5)), tree.nodes.new('ShaderNodeTexCoord')
    mask = node(tree, 'ShaderNodeTexImage', image=image(np.round(waves()), "mask", 'Non-Color'))
    link(tree, (where.outputs['UV'], turn.inputs[0]), (turn.outputs[0], mask.inputs[0]), (mask.outputs[0], bsdf.inputs['Alpha']))
    wall(made)


@case("images whose colour spaces are Linear, Raw and Filmic sRGB")
def more_spaces(scene):
    for x, space in (-1.2, LINEAR), (0, RAW), (1.2, 'Filmic sRGB'):
        made, shown, _, _ = textured(checks() * (1, 0.7, 0.4))
        shown.image.colorspace_settings.name = space
        wall(made, 0.5).location.x = x


@case("image of 16 bits, and one of floats")
def deep(scene):
    for x, kind in (-0.8, 'PNG'), (0.8, 'OPEN_EXR'):
        made, shown, _, _ = textured()
        shown.image = bpy.data.images.load(floats(checks() * (1, 0.7, 0.4), "deep", kind).filepath_raw)
        wall(made, 0.7).location.x = x


@case("image whose alpha is another channel, and one whose alpha is ignored")
def alpha_modes(scene):
    for x, mode in (-0.8, 'CHANNEL_PACKED'), (0.8, 'NONE'):
        made, shown, bsdf, tree = textured(half())
        shown.image.alpha_mode = mode
        link(tree, (shown.outputs[1], bsdf.inputs['Roughness']))
        wall(made, 0.7).location.x = x


@case("displacement that only bumps, by an image")
def bump_by_displacement(scene):
    displacement(scene)
    displace(the("ball").data.materials[0], 'BUMP')


@case("objects and collections that are hidden in the viewport alone")
def hidden_in_viewport(scene):
    for x, o in (-1.5, cube(matte("one", (0.1, 0.6, 0.1, 1)), 0.8)), (1.5, cube(matte("two", (0.1, 0.1, 0.6, 1)), 0.8)):
        o.location.x = x
    set_apart(scene, o, "hidden").hide_viewport = True
    scene.objects[-2].hide_set(True)
    the("ball").hide_viewport = True
    key = the("key")
    key.hide_set(True)


@case("instanced collection within an instanced collection, with a lamp and textures by place")
def nested(scene):
    without("ball")
    made, bsdf, tree = principled()
    link(tree, (tree.nodes.new('ShaderNodeTexCoord').outputs['Generated'], bsdf.inputs['Base Color']))
    inner, outer = parts_of(cube(made, 0.6, (0, 0, 0.3)), lamp('POINT', 10, (0, -0.6, 0.8))), bpy.data.collections.new("outer")
    for x, y, within, of in (-0.6, 0, outer, inner), (0.6, 0.3, outer, inner), (-1, 0, None, outer), (1.3, 0.5, None, outer):
        empty(of, within, location=(x, y, 0), rotation_euler=(0, 0, x), scale=(1, 1.3, 1))


@case("flat object with a position-dependent texture and loose edges")
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


@case("water in a glass: one interface in another")
def water(scene):
    dressed(surface('BsdfGlass', Roughness=0, IOR=1.5)[0])
    bpy.ops.mesh.primitive_uv_sphere_add(location=(0, 0, 0.7), radius=0.5, segments=32, ring_count=16)
    dress(surface('BsdfGlass', Roughness=0, IOR=1.33, Color=(0.5, 0.7, 1, 1))[0], smooth=True)


@case("Mix by Fresnel of an index of 2.5: Diffuse and tinted Glossy")
def coat_tinted(scene):
    coated(scene)
    tree = the("ball").data.materials[0].node_tree
    first(tree, 'FRESNEL').inputs[0].default_value, first(tree, 'BSDF_GLOSSY').inputs[0].default_value = 2.5, (0.8, 0.2, 0.1, 1)


@case("frosted pane of glass, as a slab")
def frosted(scene):
    pane(scene)
    scene.objects[-1].data.materials[0].node_tree.nodes["Glass BSDF"].inputs['Roughness'].default_value = 0.3


@case("orthographic camera with depth of field")
def orthographic_focus(scene):
    orthographic(scene)
    dof = scene.camera.data.dof
    dof.use_dof, dof.focus_distance, dof.aperture_fstop = True, 6, 2


@case("passes of a view layer, and light groups")
def passes(scene):
    scene.render.image_settings.file_format, layer = 'OPEN_EXR_MULTILAYER', scene.view_layers[0]
    the("ball").data.materials[0].pass_index = 5
    cube(matte("blue", (0.1, 0.1, 0.7, 1)), 1, (1.6, 0, 0.5)).pass_index = 3
    bpy.ops.mesh.primitive_plane_add(size=1, location=(2.5, 0, 3), rotation=(3.14, 0, 0))
    shining = dress(surface('Emission', Strength=5)[0]), lamp('POINT', 100, (-3, -2, 3), shadow_soft_size=0.2)
    for o, name in zip((*shining, the("key"), scene.world), ("warm", "warm", "cold", "sky")):
        o.lightgroup = name
    for name in "warm", "cold", "sky", "none":
        layer.lightgroups.add().name = name
    scene.world.mist_settings.start, scene.world.mist_settings.depth, layer.pass_cryptomatte_depth = 2, 10, 8
    for name in "z", "normal", "mist", "position", "object_index", "material_index", "cryptomatte_object", "cryptomatte_material", "uv":
        setattr(layer, "use_pass_" + name, True)


@case("more light groups than lull has")
def light_groups(scene):
    for i in range(17):
        scene.view_layers[0].lightgroups.add().name = f"group {i}"
        lamp('POINT', 10, (i - 8, 0, 3)).lightgroup = f"group {i}"
