"""Features that public files of other people have."""
import bpy

from cases import ball, camera, case, cover, cube, dress, dressed, lamp, link, matte, mix, node, principled, surface, the, wall, without
from compatible import displace, socket


def seen_flat(made):
    """Covers a floor, which is seen along its surface under a white sky, by a material."""
    without("key", "ball", "floor")
    bpy.context.scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.8, 0.8, 0.8, 1)
    bpy.ops.mesh.primitive_plane_add(size=200)
    dress(made)
    camera((0, -10, 1.5), (1.42, 0, 0), lens=35)


@case("Glossy of a dark colour, seen along its surface")
def glossy_seen_flat(scene):
    seen_flat(surface('BsdfGlossy', Color=(0.3, 0.1, 0.03, 1), Roughness=0.45, distribution='GGX')[0])


@case("Principled: metal without specular, and dark, seen along its surface")
def metal_seen_flat(scene):
    seen_flat(principled(Base_Color=(0.2, 0.1, 0.05, 1), Metallic=1, Roughness=0.4, Specular=0, distribution='GGX')[0])


@case("Principled: nearly black under a lamp")
def nearly_black(scene):
    without("key", "ball", "floor")
    scene.world = None
    bpy.ops.mesh.primitive_plane_add(size=30)
    dress(principled(Base_Color=(0.006, 0.006, 0.006, 1), Roughness=0.6)[0])
    camera((0, -5, 5), (0.785, 0, 0), lens=50)
    lamp('POINT', 1000, (1, -6, 5), shadow_soft_size=0.2)


@case("Glossy and Principled: rough metals of Multiscatter GGX")
def multiple_scattering(scene):
    dressed(surface('BsdfGlossy', Color=(0.9, 0.6, 0.4, 1), Roughness=0.9, distribution='MULTI_GGX')[0])
    ball(principled(Base_Color=(0.9, 0.9, 0.9, 1), Metallic=1, Roughness=0.8, distribution='MULTI_GGX')[0], 1.5)
    made, glossy, tree = surface('BsdfGlossy', Color=(0.9, 0.9, 0.9, 1), Roughness=0.7, distribution='MULTI_GGX')
    mix(tree, 0.4, node(tree, 'ShaderNodeBsdfDiffuse', Color=(0.2, 0.1, 0.3, 1)), glossy)
    ball(made, -1.5)


@case("Glossy: Beckmann")
def beckmann(scene):
    dressed(surface('BsdfGlossy', Color=(0.9, 0.9, 0.9, 1), Roughness=0.7, distribution='BECKMANN')[0])


@case("shaders that are linked to colours")
def shader_into_colour(scene):
    made, glossy, tree = surface('BsdfGlossy', Color=(0.2, 0.02, 0.02, 1), Roughness=0.6, distribution='GGX')
    link(tree, (node(tree, 'ShaderNodeBsdfDiffuse', Color=(0.1, 0.8, 0.1, 1)).outputs[0], glossy.inputs['Color']))
    dressed(made)
    made, shining, tree = surface('Emission', Color=(0.05, 0.05, 1, 1), Strength=0.5)
    link(tree, (node(tree, 'ShaderNodeBsdfGlass').outputs[0], shining.inputs['Color']))
    ball(made, 1.5)


@case("colours that are linked to surfaces, also of a lamp")
def colour_into_surface(scene):
    made = matte()
    tree = made.node_tree
    noise, ramp = node(tree, 'ShaderNodeTexNoise', Scale=2), node(tree, 'ShaderNodeValToRGB')
    for at, colour in zip(ramp.color_ramp.elements, ((1, 0.2, 0.1, 1), (0.1, 0.4, 1, 1))):
        at.color = colour
    link(tree, (noise.outputs[0], ramp.inputs[0]))
    cover(ramp, tree)
    dressed(made)
    made, diffuse, tree = surface('BsdfDiffuse')
    colour = node(tree, 'ShaderNodeRGB')
    colour.outputs[0].default_value = (0.1, 0.9, 0.1, 1)
    mix(tree, 0.5, colour, diffuse)
    ball(made, 1.5)
    light = the("key").data
    light.use_nodes = True
    colour = node(light.node_tree, 'ShaderNodeRGB')
    colour.outputs[0].default_value = (1, 0.5, 0.2, 1)
    link(light.node_tree, (colour.outputs[0], light.node_tree.get_output_node('ALL').inputs[0]))


@case("stripes by nodes of Texture Coordinate's UV and of UV Map")
def stripes(scene):
    for x, kind, output in (-0.8, 'ShaderNodeTexCoord', 'UV'), (0.8, 'ShaderNodeUVMap', 'UV'):
        made, bsdf, tree = principled()
        source, parts = node(tree, kind), node(tree, 'ShaderNodeSeparateXYZ')
        link(tree, (source.outputs[output], parts.inputs[0]))
        last = parts.outputs['X']
        for operation, value in ('MULTIPLY', 4), ('FRACT', 0), ('GREATER_THAN', 0.5):
            one = node(tree, 'ShaderNodeMath', operation=operation)
            one.inputs[1].default_value = value
            link(tree, (last, one.inputs[0]))
            last = one.outputs[0]
        link(tree, (last, bsdf.inputs['Base Color']))
        wall(made, 0.7).location.x = x


@case("a mesh with numbers of copies, baked; Diffuse and Translucent added")
def numbered_copies(scene):
    made, bsdf, tree = principled()
    link(tree, (node(tree, 'ShaderNodeTexNoise', Scale=2).outputs[1], bsdf.inputs['Base Color']))
    dressed(made)
    the("ball").data.attributes.new("id", 'INT', 'POINT')
    made, diffuse, tree = surface('BsdfDiffuse', Color=(0.4, 0.1, 0.1, 1))
    added = tree.nodes.new('ShaderNodeAddShader')
    through = node(tree, 'ShaderNodeBsdfTranslucent', Color=(0.1, 0.5, 0.1, 1))
    link(tree, (through.outputs[0], added.inputs[0]), (diffuse.outputs[0], added.inputs[1]))
    cover(added, tree)
    ball(made, 1.5)


@case("a sun 90 degrees across")
def wide_sun(scene):
    without("key")
    lamp('SUN', 2, (0, 0, 5), (0.4, 0, 0.5), angle=1.5708 if bpy.app.version < (4, 0) else 0.1)


@case("no light: a lamp whose energy is keyed to nothing")
def no_light(scene):
    without("key")
    scene.world = None
    light = lamp('POINT', 500, (3, -3, 3)).data
    light.keyframe_insert('energy', frame=1)
    light.energy = 0
    light.keyframe_insert('energy', frame=20)
    scene.frame_set(20)


@case("objects that are scaled to nothing: an emitter of particles, one with a texture, one that is displaced")
def scaled_to_nothing(scene):
    for kind in "particles", "noise", "displacement":
        made, bsdf, tree = principled()
        noise = node(tree, 'ShaderNodeTexNoise')
        if kind == "noise":
            link(tree, (noise.outputs[1], bsdf.inputs['Base Color']))
        if kind == "displacement":
            moved = node(tree, 'ShaderNodeDisplacement')
            link(tree, (noise.outputs[0], moved.inputs['Height']), (moved.outputs[0], tree.get_output_node('ALL').inputs['Displacement']))
            displace(made, 'DISPLACEMENT')
        o = cube(made)
        if kind == "particles":
            o.modifiers.new("seeds", 'PARTICLE_SYSTEM')
            settings = o.particle_systems[0].settings
            settings.type, settings.render_type, settings.instance_object, settings.count = 'HAIR', 'OBJECT', the("ball"), 5
        o.scale = (0, 0, 0)


@case("a lamp, text, a metaball and a curve that are scaled to nothing; points nowhere and far away; a mesh without faces")
def nowhere(scene):
    for add in (bpy.ops.object.light_add, bpy.ops.object.text_add, bpy.ops.object.metaball_add, bpy.ops.curve.primitive_bezier_circle_add):
        add()
        bpy.context.object.scale = (0, 0, 0)
    bpy.context.object.data.bevel_depth = 0.1
    for name, last, faces in ("no number", float("nan"), [(0, 1, 2)]), ("far", 1e30, [(0, 1, 2)]), ("no faces", 1, []):
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata([(0, 0, 0), (1, 0, 0), (last, 1, 0)], [], faces)
        o = bpy.data.objects.new(name, mesh)
        o.location.z = -5
        scene.collection.objects.link(o)


def speckled(tree, low, high):
    """Returns the output of a texture from one number to another."""
    noise, ramp = node(tree, 'ShaderNodeTexNoise', Scale=6), node(tree, 'ShaderNodeValToRGB')
    for at, v in zip(ramp.color_ramp.elements, (low, high)):
        at.color = (v, v, v, 1)
    link(tree, (noise.outputs[0], ramp.inputs[0]))
    return ramp.outputs[0]


@case("Mix of Diffuse and Glossy by a texture, and of colours that are textures")
def mix_by_texture(scene):
    made, diffuse, tree = surface('BsdfDiffuse', Color=(0.2, 0.06, 0.02, 1))
    mix(tree, speckled(tree, 0.1, 0.3), diffuse, node(tree, 'ShaderNodeBsdfGlossy', Color=(1, 1, 1, 1), Roughness=0.2))
    dressed(made)
    made, diffuse, tree = surface('BsdfDiffuse', Color=(0.2, 0.06, 0.02, 1))
    glossy = node(tree, 'ShaderNodeBsdfGlossy', Roughness=0.2)
    link(tree, (speckled(tree, 0.2, 1), glossy.inputs['Color']), (speckled(tree, 0.1, 0.5), diffuse.inputs['Color']))
    mix(tree, 0.3, diffuse, glossy)
    ball(made, 1.5)


def window(scene, turn):
    without("key", "ball", "floor")
    scene.world.node_tree.nodes["Background"].inputs[0].default_value = (5, 5, 5, 1)
    x, y, z = 2, 3, 3
    white = matte("white", (0.7, 0.7, 0.7, 1))
    pane = [(-1, y, 1), (1, y, 1), (1, y, 2.4), (-1, y, 2.4)]
    corners = [(i, j, k) for k in (0, z) for j in (-y, y) for i in (-x, x)]
    faces = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5), (0, 1, 5, 4), (2, 3, 9, 8), (3, 7, 10, 9), (7, 6, 11, 10),
             (6, 2, 8, 11)]
    for name, points, sides, made in (("room", corners + pane, faces, white),
                                      ("window", pane, [(0, 1, 2, 3)[::turn]], surface('BsdfGlass', Roughness=0, IOR=1.45)[0])):
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(points, [], sides)
        mesh.materials.append(made)
        scene.collection.objects.link(bpy.data.objects.new(name, mesh))
    camera((0, -2.9, 1.5), (1.52, 0, 0), lens=18)


@case("window of one plane of Glass, whose normal points out of the room")
def window_out(scene):
    window(scene, -1)


@case("window of one plane of Glass, whose normal points into the room")
def window_in(scene):
    window(scene, 1)


@case("window and camera coordinates, depth and distance, and normals in the camera's space")
def by_camera(scene):
    scene.camera.data.shift_x = 0.1
    for x, kind, output in (-1.5, 'TexCoord', 'Window'), (-0.5, 'TexCoord', 'Camera'), (0.5, 'CameraData', 'View Z Depth'), \
            (1.5, 'CameraData', 'View Distance'), (0, 'CameraData', 'View Vector'), (None, None, None):
        made, bsdf, tree = principled(Specular=0, Roughness=1)
        if kind:
            source = node(tree, 'ShaderNode' + kind).outputs[output]
        else:
            turn = node(tree, 'ShaderNodeVectorTransform', vector_type='NORMAL', convert_from='WORLD', convert_to='CAMERA')
            link(tree, (node(tree, 'ShaderNodeNewGeometry').outputs['Normal'], turn.inputs[0]))
            source = turn.outputs[0]
        fraction = node(tree, 'ShaderNodeVectorMath', operation='FRACTION')
        scaled = node(tree, 'ShaderNodeVectorMath', operation='SCALE')
        socket(scaled, "Scale").default_value = 2
        link(tree, (source, scaled.inputs[0]), (scaled.outputs[0], fraction.inputs[0]), (fraction.outputs[0], bsdf.inputs['Base Color']))
        if x == 0:
            dressed(made, "floor")
        elif x is None:
            dressed(made)
            the("ball").location.z = 2
        else:
            cube(made, 0.8, (x, 0, 0.4), rotation=(0, 0, 0.4))


@case("Mix of plastic and Diffuse by a texture; transmission and specular that are textures")
def interface_by_texture(scene):
    made, plastic, tree = principled(Roughness=0.3, Base_Color=(0.4, 0.1, 0.1, 1))
    mix(tree, speckled(tree, 0, 1), node(tree, 'ShaderNodeBsdfDiffuse', Color=(0.1, 0.1, 0.4, 1)), plastic)
    dressed(made)
    for x, name, roughness, colour in (1.5, "Specular", 0.3, 0.05), (-1.5, "Transmission", 0.1, 0.7):
        made, bsdf, tree = principled(Roughness=roughness, Base_Color=(colour, colour, colour, 1))
        link(tree, (speckled(tree, 0, 1), socket(bsdf, name)))
        ball(made, x)
