"""Features of objects."""
import os

import bpy

from camera import keyed
from compatible import add_grease_pencil, shade_smooth_to
from cases import (
    ball, case, cube, dress, dressed, empty, first, folder, geometry_nodes, lamp, link, matte, node, parts_of, principled, set_apart,
    surface, textured, the, wall, without)


@case("object that the camera does not see")
def unseen(scene):
    the("ball").visible_camera = False


@case("object and lamp that no ray sees")
def unseen_by_all(scene):
    lamp('POINT', 500, (2, -2, 1), shadow_soft_size=0.1).name = "lamp"
    for name in "camera", "diffuse", "glossy", "transmission", "volume_scatter", "shadow":
        for o in "ball", "lamp":
            setattr(the(o), "visible_" + name, False)


@case("copies that the camera does not see, or without a shadow")
def unseen_copies(scene):
    without("ball")
    parts = parts_of(cube(matte("part", (0.6, 0.2, 0.1, 1))))
    for x, name in (-2, "visible_camera"), (0, "visible_shadow"), (2, None):
        copy = empty(parts, location=(x, 0, 0))
        if name:
            setattr(copy, name, False)


@case("holdout")
def holdout(scene):
    the("ball").is_holdout = scene.render.film_transparent = True


@case("shadow catcher")
def catcher(scene):
    the("floor").is_shadow_catcher = scene.render.film_transparent = True


@case("collection: indirect only")
def indirect_only(scene):
    set_apart(scene, the("ball"), "indirect").indirect_only = True


@case("background set, and a grease pencil")
def background_set(scene):
    other = bpy.data.scenes.new("set")
    for name in "ball", "key":
        other.collection.objects.link(the(name))
        scene.collection.objects.unlink(the(name))
    scene.background_set = other
    add_grease_pencil((0, -1, 1))


@case("material override of a view layer")
def override(scene):
    scene.view_layers[0].material_override = matte("clay", (0.8, 0.8, 0.8, 1))


@case("view layer without the sky and strands")
def layer_without(scene):
    hair(scene)
    scene.view_layers[0].use_sky = scene.view_layers[0].use_strand = False


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
    shown = cube(matte("shown", (0.6, 0.2, 0.1, 1)))
    shown.modifiers.new("round", 'SUBSURF').render_levels = 3
    cutter = cube(matte("cutter", (0.1, 0.8, 0.1, 1)), 0.6, (0.4, -0.4, 0.8))
    cutter.hide_render = True
    cut = shown.modifiers.new("cut", 'BOOLEAN')
    cut.object = cutter
    unseen = cube(matte("unseen", (0.1, 0.8, 0.1, 1)), 0.6, (1.5, 0, 0.3))
    unseen.hide_viewport = True
    empty(parts_of(shown, cutter, unseen))


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
    late = cube(matte("late", (0.1, 0.2, 0.6, 1)), 0.6, (-1, -1.5, 0.4))
    group, inlet, outlet, switch, asks = geometry_nodes(late, 'GeometryNodeSwitch', 'GeometryNodeIsViewport')
    switch.input_type = 'GEOMETRY'
    geometry = [s for s in switch.inputs if s.type == 'GEOMETRY']
    link(group, (inlet.outputs[0], geometry[0]), (next(s for s in switch.outputs if s.type == 'GEOMETRY'), outlet.inputs[0]),
         (asks.outputs[0], switch.inputs[1]))


@case("override of an object of a library, beside a local one of its name")
def library(scene):
    made = textured()[0]
    dressed(made)
    parts, path = bpy.data.collections.new("parts"), os.path.join(folder(), "library.blend")
    parts.objects.link(the("ball"))
    bpy.data.libraries.write(path, {parts})
    without("ball")
    bpy.data.collections.remove(parts)
    with bpy.data.libraries.load(path, link=True) as (_, wanted):
        wanted.collections = ["parts"]
    source = empty(wanted.collections[0], scale=(-1, 1, 1.2)).instance_collection.objects[0]
    scene.collection.objects.link(source)
    moved = source.override_create(remap_local_usages=True)
    moved.location.x = -1.5


@case("negative scale")
def negative(scene):
    without("ball")
    bpy.ops.mesh.primitive_monkey_add(size=1.6, location=(0, 0, 0.8))
    dress(matte("red", (0.6, 0.2, 0.1, 1))).scale = (-1, 1, 1)


@case("instances on faces")
def faces(scene):
    without("ball")
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=4, y_subdivisions=4, size=4, location=(0, 0, 0.3))
    carrier = dress(None)
    cube(matte("copy", (0.6, 0.2, 0.1, 1)), 0.4).parent = carrier
    carrier.instance_type, carrier.show_instancer_for_render = 'FACES', False


@case("instances of geometry nodes")
def scattered(scene):
    without("ball")
    one = cube(matte("copy", (0.6, 0.2, 0.1, 1)), 0.4, (0, 50, 0))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=3, y_subdivisions=3, size=3, location=(0, 0, 0.4))
    group, inlet, outlet, put, info = geometry_nodes(dress(None), 'GeometryNodeInstanceOnPoints', 'GeometryNodeObjectInfo')
    info.inputs[0].default_value = one
    link(group, (inlet.outputs[0], put.inputs['Points']), (info.outputs['Geometry'], put.inputs['Instance']), (put.outputs[0], outlet.inputs[0]))


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


def particle_objects(scene):
    bpy.ops.mesh.primitive_ico_sphere_add(radius=0.3, location=(0, 50, 0))
    one = dress(matte("copy", (0.6, 0.2, 0.1, 1)))
    particles(lawn(), count=40, render_type='OBJECT', instance_object=one, particle_size=0.5)


def hair(scene):
    particles(lawn(), count=1000, hair_length=0.6, root_radius=5)


@case("hair of curves")
def hair_curves(scene):
    bpy.context.preferences.experimental.use_new_curves_tools = True
    bpy.ops.object.curves_random_add()
    bpy.context.object.data.materials.append(matte("strands", (0.3, 0.2, 0.1, 1)))


@case("adaptive subdivision")
def dicing(scene):
    o = cube(matte("box", (0.6, 0.2, 0.1, 1)), 1.4, (0, 0, 0.7))
    without("ball")
    scene.cycles.feature_set = 'EXPERIMENTAL'
    o.modifiers.new("round", 'SUBSURF').levels = 3
    o.cycles.use_adaptive_subdivision = True


@case("bar that an armature bends, at a frame; a floor without a material")
def pose(scene):
    without("ball")
    the("floor").data.materials.clear()
    bpy.ops.mesh.primitive_cylinder_add(radius=0.4, depth=3, location=(0, 0, 1.5))
    bar = dress(matte("bar", (0.2, 0.4, 0.7, 1)))
    bar.modifiers.new("fine", 'SUBSURF').subdivision_type = 'SIMPLE'
    bpy.ops.object.armature_add(enter_editmode=True)
    rig = bpy.context.object
    lower, upper = rig.data.edit_bones[0], rig.data.edit_bones.new("upper")
    lower.tail, upper.head, upper.tail, upper.parent = (0, 0, 1.5), (0, 0, 1.5), (0, 0, 3), lower
    bpy.ops.object.mode_set(mode='OBJECT')
    for number, bone in enumerate(rig.data.bones):
        bar.vertex_groups.new(name=bone.name).add([v.index for v in bar.data.vertices if (v.co.z > 0) == number], 1, 'REPLACE')
    bar.modifiers.new("skin", 'ARMATURE').object = rig
    rig.pose.bones["upper"].rotation_mode = 'XYZ'
    keyed(rig.pose.bones["upper"], "rotation_euler", (0, 0, 0), (0, 0, 0), (0.6, 0, 0.6))
    scene.frame_set(2)


@case("simplify, and culling by the camera")
def simplify(scene):
    scene.cycles.use_camera_cull = the("ball").cycles.use_camera_cull = True
    scene.render.use_simplify, scene.render.simplify_subdivision_render = True, 0
    the("ball").modifiers.new("round", 'SUBSURF').render_levels = 3


@case("smooth shading with an angle, auto smooth")
def auto_smooth(scene):
    without("ball")
    bpy.ops.mesh.primitive_cylinder_add(radius=0.7, depth=1.2, location=(0, 0, 0.6))
    o = dress(surface('BsdfGlossy', Roughness=0.2)[0], smooth=True)
    shade_smooth_to(o, 0.6)


@case("volume of an object without a surface")
def volume(scene):
    made, _, tree = principled()
    tree.nodes.remove(first(tree, 'BSDF_PRINCIPLED'))
    tree.links.new(node(tree, 'ShaderNodeVolumePrincipled').outputs[0], tree.get_output_node('ALL').inputs['Volume'])
    cube(made, 1.5, (0, 0, 0.8))
    without("ball")


@case("hair whose colour goes by Intercept and Random")
def hair_info(scene):
    o = lawn()
    made, bsdf, tree = principled()
    info, ramp, random = tree.nodes.new('ShaderNodeHairInfo'), node(tree, 'ShaderNodeValToRGB'), node(tree, 'ShaderNodeMixRGB', blend_type='MULTIPLY', Fac=0.25)
    ramp.color_ramp.elements[0].color, ramp.color_ramp.elements[1].color = (0.8, 0.02, 0.02, 1), (0.02, 0.8, 0.02, 1)
    link(tree, (info.outputs['Intercept'], ramp.inputs[0]), (ramp.outputs[0], random.inputs[1]), (info.outputs['Random'], random.inputs[2]),
         (random.outputs[0], bsdf.inputs['Base Color']))
    o.data.materials[0] = made
    particles(o, count=1000, hair_length=0.6, root_radius=5)


@case("cube and cylinder that are smooth without an angle")
def smooth_edges(scene):
    cube(principled(Roughness=0.2)[0], 1, (-1, 0, 0.5), rotation=(0, 0, 0.6))
    dress(None, smooth=True)
    bpy.ops.mesh.primitive_cylinder_add(radius=0.6, depth=1.2, location=(1, 0, 0.6))
    dress(matte("red", (0.6, 0.1, 0.1, 1)), smooth=True)
    without("ball")


@case("concave polygons")
def concave(scene):
    without("ball")
    mesh = bpy.data.meshes.new("frame")
    outer, inner = [(-1.5, 0, 0), (1.5, 0, 0), (1.5, 0, 2), (-1.5, 0, 2)], [(-1, 0, 0.4), (-1, 0, 1.6), (1, 0, 1.6), (1, 0, 0.4)]
    mesh.from_pydata(outer + inner, [], [(0, 1, 2, 3, 5, 6, 7, 4), (0, 4, 5, 3)])
    mesh.materials.append(matte("red", (0.6, 0.1, 0.1, 1)))
    scene.collection.objects.link(bpy.data.objects.new("frame", mesh))
