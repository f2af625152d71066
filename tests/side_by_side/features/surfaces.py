"""Features of surfaces."""
import os

import bpy
import numpy as np

from compatible import add_output, new_node, socket
from cases import ball, case, cover, cube, dressed, folder, node, principled, surface, textured, the, wall, without
from lamps import only
from scenes import dress, matte


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
    shown.filepath_raw, shown.file_format = os.path.join(folder(), "bright.exr"), 'OPEN_EXR'
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


@case("Principled: rough walls seen along their surface")
def rough_walls(scene):
    made = principled(Roughness=0.9, Specular=0.2)[0]
    mesh = bpy.data.meshes.new("walls")
    mesh.from_pydata([(x, y, z) for x in (-1, 1) for y, z in ((-5, 0), (4, 0), (4, 3), (-5, 3))], [], [(0, 1, 2, 3), (4, 5, 6, 7)])
    mesh.materials.append(made)
    scene.collection.objects.link(bpy.data.objects.new("walls", mesh))


def clear_for(kind, made, bsdf, tree):
    """Dresses the ball in a surface that is transparent for rays of a kind."""
    rays, clear, mix = (new_node(tree, 'ShaderNode' + k) for k in ('LightPath', 'BsdfTransparent', 'MixShader'))
    for a, b in ((rays.outputs[kind], mix.inputs[0]), (bsdf.outputs[0], mix.inputs[1]), (clear.outputs[0], mix.inputs[2])):
        tree.links.new(a, b)
    cover(mix, tree)
    dressed(made)


@case("surface by kinds of rays: shadows without glass")
def glass_by_rays(scene):
    clear_for('Is Shadow Ray', *surface('BsdfGlass', Roughness=0, IOR=1.45))


@case("surface by kinds of rays: the camera does not see it")
def unseen_by_rays(scene):
    clear_for('Is Camera Ray', *principled())


def sheet(made):
    """Puts a plane before the wall, in the way of the sun."""
    wall(matte("red", (0.6, 0.2, 0.1, 1))).location.y = 1
    only('SUN', 3, (0, 0, 9), (0.9, 0, 0), angle=0)
    o = wall(made, x=2, z=2.2)
    o.location.y = -1


@case("pane: Transparent and Glossy by Fresnel")
def pane_by_fresnel(scene):
    made, clear, tree = surface('BsdfTransparent', Color=(0.9, 0.95, 0.9, 1))
    shine, fresnel, mix = (new_node(tree, 'ShaderNode' + k) for k in ('BsdfGlossy', 'Fresnel', 'MixShader'))
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
    shine, fresnel, mix = (new_node(tree, 'ShaderNode' + k) for k in ('BsdfGlossy', 'Fresnel', 'MixShader'))
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
    inside, mix, where = (new_node(tree, 'ShaderNode' + k) for k in ('BsdfDiffuse', 'MixShader', 'NewGeometry'))
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
    tree.links.new(node(tree, 'ShaderNodeTexChecker', Scale=2).outputs['Fac'], socket(bsdf, 'Transmission'))
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
    add_output(inner, 'NodeSocketShader', "Shader")
    outlet, paint = inner.nodes.new('NodeGroupOutput'), node(inner, 'ShaderNodeBsdfPrincipled', Base_Color=(0.1, 0.5, 0.1, 1))
    inner.links.new(paint.outputs[0], outlet.inputs[0])
    made, bsdf, tree = principled()
    outside = node(tree, 'ShaderNodeGroup', node_tree=inner)
    cover(outside, tree)
    tree.nodes.remove(bsdf)
    dressed(made)
