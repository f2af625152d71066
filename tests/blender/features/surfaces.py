"""Features of surfaces."""
import bpy
import numpy as np

from compatible import add_input, add_output, new_node, shadow_transparently, socket
from cases import (
    add, ball, case, cover, cube, dress, dressed, floats, link, matte, mix, node, principled, surface, textured, the, wall, without)
from lamps import only


@case("Principled: metal, rough and smooth")
def metal(scene):
    dressed(principled(Metallic=1, Roughness=0.3, Base_Color=(0.9, 0.6, 0.3, 1))[0])


@case("Principled: plastic")
def plastic(scene):
    dressed(principled(Roughness=0.3, Base_Color=(0.1, 0.3, 0.7, 1))[0])


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


@case("sun through a pane of glass, as a slab")
def sunlit_pane(scene):
    without("ball")
    only('SUN', 3, (0, 0, 5), (0.3, 0, 0), angle=0)
    made = cube(surface('BsdfGlass', Roughness=0, IOR=1.45, Color=(0.9, 0.95, 0.9, 1))[0], 1, (0, 0, 2), rotation=(0.1, 0, 0.4))
    made.name, made.scale = "pane", (4, 4, 0.02)


@case("Translucent")
def translucent(scene):
    o = wall(surface('BsdfTranslucent', Color=(0.6, 0.7, 0.3, 1))[0])
    o.location.y = -1.5


def leaf(scene):
    made, front, tree = surface('BsdfDiffuse', Color=(0.2, 0.5, 0.1, 1))
    mix(tree, 0.5, front, node(tree, 'ShaderNodeBsdfTranslucent', Color=(0.5, 0.7, 0.1, 1)))
    wall(made).location.y = -1.5


@case("Velvet")
def velvet(scene):
    dressed(surface('BsdfVelvet', Color=(0.5, 0.1, 0.1, 1))[0])


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
    made, bsdf, tree = surface('Emission')
    tree.links.new(node(tree, 'ShaderNodeTexImage', image=floats(np.ones((16, 32, 3)) * (3, 2, 1), "bright")).outputs[0], bsdf.inputs[0])
    wall(made)


def half():
    """Returns the pixels of a leaf that is there on the left half."""
    pixels = np.ones((64, 64, 4), np.float32)
    pixels[:, :, :3], pixels[:, 32:, 3] = (0.1, 0.4, 0.1), 0
    return pixels


@case("alpha of an image, whatever the blend mode")
def alpha(scene):
    made, shown, bsdf, tree = textured(half())
    tree.links.new(shown.outputs[1], bsdf.inputs['Alpha'])
    made.blend_method = 'OPAQUE'
    wall(made)


@case("coloured Transparent")
def transparent_colour(scene):
    wall(surface('BsdfTransparent', Color=(0.8, 0.3, 0.2, 1))[0]).location.y = -1
    ball(matte("ball", (0.6, 0.2, 0.1, 1)))


def clear_for(kind, made, bsdf, tree):
    """Dresses the ball in a surface that is transparent for rays of a kind."""
    mix(tree, tree.nodes.new('ShaderNodeLightPath').outputs[kind], bsdf, tree.nodes.new('ShaderNodeBsdfTransparent'))
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
    mix(tree, new_node(tree, 'ShaderNodeFresnel').outputs[0], clear, node(tree, 'ShaderNodeBsdfGlossy', Roughness=0, Color=(1, 1, 1, 1)))
    sheet(made)


@case("pane: plane of Glass without a shadow by Light Path")
def pane_by_rays(scene):
    glass_by_rays(scene)
    made = the("ball").data.materials[0]
    sheet(made)


@case("Mix by Fresnel: Diffuse and Glossy")
def coated(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    mix(tree, new_node(tree, 'ShaderNodeFresnel').outputs[0], base, node(tree, 'ShaderNodeBsdfGlossy', Roughness=0.2))
    dressed(made)


@case("Mix of Diffuse and Glossy by a number")
def mixed(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    mix(tree, 0.3, base, node(tree, 'ShaderNodeBsdfGlossy', Roughness=0.3))
    dressed(made)


@case("Mix of Diffuse and nothing")
def half_mixed(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    mix(tree, 0.5, base, None)
    dressed(made)


@case("Mix with Transparent, without transparent shadows")
def shadowed(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    mix(tree, 0.7, base, tree.nodes.new('ShaderNodeBsdfTransparent'))
    shadow_transparently(made, False)
    dressed(made)


@case("surfaces with parts that lull lacks: a half unknown, bump of a coat, one of two bumps, anisotropy, hair, occlusion")
def in_part(scene):
    without("ball")
    made, base, tree = surface('BsdfDiffuse')
    mix(tree, 0.5, base, tree.nodes.new('ShaderNodeBsdfHairPrincipled'))
    ball(made, -2.4)
    made, base, tree = surface('BsdfDiffuse')
    tree.links.new(new_node(tree, 'ShaderNodeBump').outputs[0], base.inputs['Normal'])
    mix(tree, 0.5, base, tree.nodes.new('ShaderNodeBsdfGlossy'))
    ball(made, -1.6)
    for x, kind, output, name in ((-0.8, 'Bump', 0, 'Clearcoat Normal'), (0, 'HairInfo', 'Length', 'Roughness'),
                                  (0.8, 'AmbientOcclusion', 0, 'Base Color')):
        made, bsdf, tree = principled(Clearcoat=x < 0)
        tree.links.new(new_node(tree, 'ShaderNode' + kind).outputs[output], socket(bsdf, name))
        ball(made, x)
    ball(surface('BsdfAnisotropic', Anisotropy=0.5)[0], 1.6)


@case("wall that is there from inside alone")
def one_sided(scene):
    made, clear, tree = surface('BsdfTransparent')
    mix(tree, new_node(tree, 'ShaderNodeNewGeometry').outputs['Backfacing'], clear, new_node(tree, 'ShaderNodeBsdfDiffuse'))
    cube(made, 3, (0, 0, 1.5))


@case("Add of Diffuse and Emission")
def added(scene):
    made, base, tree = surface('BsdfDiffuse', Color=(0.1, 0.3, 0.6, 1))
    add(tree, base, node(tree, 'ShaderNodeEmission', Strength=0.5))
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


@case("group of nodes with an input, on one of the materials of a mesh")
def group(scene):
    inner = bpy.data.node_groups.new("paint", 'ShaderNodeTree')
    add_input(inner, 'NodeSocketColor', "Color"), add_output(inner, 'NodeSocketShader', "Shader")
    inlet, outlet, paint = (new_node(inner, kind) for kind in ('NodeGroupInput', 'NodeGroupOutput', 'ShaderNodeBsdfPrincipled'))
    link(inner, (inlet.outputs[0], paint.inputs['Base Color']), (paint.outputs[0], outlet.inputs[0]))
    made, _, tree = principled()
    outside = node(tree, 'ShaderNodeGroup', node_tree=inner)
    tree.links.new(node(tree, 'ShaderNodeTexChecker', Scale=4, Color1=(0.1, 0.5, 0.1, 1)).outputs[0], outside.inputs[0])
    cover(outside, tree)
    mesh = the("ball").data
    mesh.materials.append(made)
    for polygon in mesh.polygons:
        polygon.material_index = polygon.index % 2
