"""Features of what Blender has in its session alone."""
import bpy
import numpy as np

from cases import case, checks, cube, dressed, empty, image, link, node, principled, the, wall, without


def through_hue(shown):
    """Returns a material whose colour nodes make of an image."""
    made, bsdf, tree = principled()
    hue = node(tree, 'ShaderNodeHueSaturation', Hue=0.6)
    link(tree, (node(tree, 'ShaderNodeTexImage', image=shown).outputs[0], hue.inputs['Color']), (hue.outputs[0], bsdf.inputs['Base Color']))
    return made


@case("images that are painted and not saved: of floats, of bytes, packed, of a file; one in the world")
def unsaved_images(scene):
    without("ball")
    painted = np.concatenate([checks() * (1, 0.4, 0.2), np.ones((64, 64, 1))], 2).astype(np.float32)
    made = [bpy.data.images.new("floats", 64, 64, float_buffer=True), bpy.data.images.new("bytes", 64, 64),
            bpy.data.images.new("packed", 64, 64), image(checks()[:, ::-1], "file")]
    made[2].pack()
    for x, one in zip((-1.8, -0.6, 0.6, 1.8), made):
        one.pixels.foreach_set(painted.ravel())
        one.update()
        o = wall(through_hue(one), 0.5)
        o.name, o.location.x = "picture", x
    sky = bpy.data.images.new("sky", 32, 16, float_buffer=True)
    sky.pixels.foreach_set(np.tile([0.5, 0.3, 0.2, 1], 512).astype(np.float32))
    tree = scene.world.node_tree
    link(tree, (node(tree, 'ShaderNodeTexEnvironment', image=sky).outputs[0], tree.nodes["Background"].inputs[0]))


@case("drivers in Python, of an object, of a node and of the object whose coordinates a texture has")
def python_drivers(scene):
    made, bsdf, tree = principled()
    noise, where = node(tree, 'ShaderNodeTexChecker', Color2=(0.1, 0.02, 0.02, 1)), tree.nodes.new('ShaderNodeTexCoord')
    where.object = empty(location=(0.3, 0, 0))
    link(tree, (where.outputs['Object'], noise.inputs[0]), (noise.outputs[0], bsdf.inputs['Base Color']))
    dressed(made)
    driven = [(where.object, 'rotation_euler', 2, "sum([0.5, 0.2])"), (the("ball"), 'location', 0, "len([1, 2]) * 0.3"),
              (bsdf.inputs['Roughness'], 'default_value', -1, "max([0.8, 0.1])")]
    bpy.app.driver_namespace["lift"] = lambda frame: 1 + frame / 2
    driven.append((noise.inputs['Scale'], 'default_value', -1, "lift(frame)"))
    for owner, path, index, expression in driven:
        owner.driver_add(path, *([index] if index >= 0 else [])).driver.expression = expression
    scene.frame_set(2)


@case("rigid body that is stepped and not baked, with a texture over its coordinates")
def rigid_body(scene):
    bpy.context.view_layer.objects.active = the("floor")
    bpy.ops.rigidbody.object_add()
    the("floor").rigid_body.type = 'PASSIVE'
    without("ball")
    made, bsdf, tree = principled()
    checker, where = node(tree, 'ShaderNodeTexChecker', Scale=3, Color2=(0.1, 0.02, 0.02, 1)), tree.nodes.new('ShaderNodeTexCoord')
    link(tree, (where.outputs['Object'], checker.inputs[0]), (checker.outputs[0], bsdf.inputs['Base Color']))
    falling = cube(made, at=(0, 0, 2.5), rotation=(0.3, 0.5, 0))
    bpy.ops.rigidbody.object_add()
    where.object = falling
    for frame in range(1, 20):
        scene.frame_set(frame)
