"""Renders a glTF file with Cycles. Runs inside Blender, for side_by_side.py, which says how it is
called: its last argument is a JSON object of model, width, height, bounces, frame and shutter (seconds; the latter 0 for none),
folder and runs. A run has a name, spp, seed and materials: "imported" as Blender's importer makes them, or "specification" as
appendix B of glTF 2.0 has them. Writes FOLDER/NAME.exr, multi-layer.
"""

import json
import math
import struct
import sys

import bpy
import numpy

numpy.bool = bool  # which Blender 3.4's importer asks a later NumPy for


def read_materials(path):
    """Returns the materials of a .glb file by the names that Blender gives them."""
    with open(path, 'rb') as f:
        size = struct.unpack('<12x2I', f.read(20))[0]
        root = json.loads(f.read(size))
    return {m.get('name', 'Material_%d' % i): m for i, m in enumerate(root.get('materials', []))}


def surface_of(described):
    """Returns metallic, roughness, transmission and the reflectance of the interface at normal
    incidence and at grazing angles."""
    more, pbr = described.get('extensions', {}), described.get('pbrMetallicRoughness', {})
    transmission = more.get('KHR_materials_transmission', {}).get('transmissionFactor', 0)
    interface = more.get('KHR_materials_specular', {})
    specular = interface.get('specularFactor', 1) * max(interface.get('specularColorFactor', [1]))
    ior = more.get('KHR_materials_ior', {}).get('ior', 1.5)
    f0 = specular * ((ior - 1) / (ior + 1)) ** 2
    return (pbr.get('metallicFactor', 1), pbr.get('roughnessFactor', 1), transmission, f0,
            specular)


def math_node(tree, operation, *inputs):
    """Makes a node of numbers and other nodes' outputs. Returns its output."""
    node = tree.nodes.new('ShaderNodeMath')
    node.operation = operation
    for socket, value in zip(node.inputs, inputs):
        if isinstance(value, (int, float)):
            socket.default_value = value
        else:
            tree.links.new(value, socket)
    return node.outputs[0]


def albedo_fit(roughness):
    """Returns the numbers of a fit to the albedo of rough interfaces (Karis 2014, "Physically Based
    Shading on Mobile")."""
    return [roughness * a + b for a, b in
            ((-1, 1), (-0.0275, 0.0425), (-0.572, 1.04), (0.022, -0.04))]


def reflected(tree, roughness, f0, f90):
    """Makes nodes for the share of light that a rough interface reflects in all under Schlick's
    reflectance, by the cosine of the view. Returns their output."""
    x, y, z, w = albedo_fit(roughness)
    facing = tree.nodes.new('ShaderNodeLayerWeight')
    facing.inputs['Blend'].default_value = 0.5
    cosine = math_node(tree, 'SUBTRACT', 1, facing.outputs['Facing'])
    steep = math_node(tree, 'MINIMUM', math_node(tree, 'POWER', 2 ** -9.28, cosine), x * x)
    term = math_node(tree, 'MULTIPLY_ADD', steep, x, y)
    return math_node(tree, 'MULTIPLY_ADD', term, 1.04 * (f90 - f0), f0 * z + f90 * w)


def glossy(tree, roughness, share):
    """Makes a node that reflects that share of light. Returns its output."""
    node = tree.nodes.new('ShaderNodeBsdfGlossy')
    node.distribution = 'GGX'
    node.inputs['Roughness'].default_value = roughness
    _, _, z, w = albedo_fit(roughness)  # z + w: of an interface that reflects all
    tree.links.new(math_node(tree, 'DIVIDE', share, z + w), node.inputs['Color'])
    return node.outputs[0]


def follow_volume(material, described):
    """Makes a volume absorb as KHR_materials_volume says: in Cycles, 1 - colour is absorbed in a unit
    of length times the density."""
    volume = described.get('extensions', {}).get('KHR_materials_volume', {})
    for node in [n for n in material.node_tree.nodes if n.type == 'VOLUME_ABSORPTION']:
        if volume.get('thicknessFactor', 0) <= 0 or 'attenuationDistance' not in volume:
            material.node_tree.nodes.remove(node)
            continue
        absorbed = [-math.log(max(c, 1e-30)) / volume['attenuationDistance']
                    for c in volume.get('attenuationColor', [1, 1, 1])[:3]]
        density = max(absorbed)
        node.inputs['Density'].default_value = density
        node.inputs['Color'].default_value = (*(1 - a / (density or 1) for a in absorbed), 1)


def brushed(tree, described):
    """Makes a node of anisotropic metal as KHR_materials_anisotropy says, which Blender 3.4 does not
    read: rougher along the tangent. Returns its output."""
    pbr = described['pbrMetallicRoughness']
    anisotropy = described['extensions']['KHR_materials_anisotropy']
    across = pbr.get('roughnessFactor', 1) ** 2
    along = across + (1 - across) * anisotropy['anisotropyStrength'] ** 2
    node, tangent = tree.nodes.new('ShaderNodeBsdfAnisotropic'), tree.nodes.new('ShaderNodeTangent')
    tangent.direction_type = 'UV_MAP'
    tree.links.new(tangent.outputs[0], node.inputs['Tangent'])
    node.distribution = 'GGX'
    node.inputs['Color'].default_value = pbr['baseColorFactor']
    # A negative anisotropy -a divides the alpha along the tangent by 1 - a, and multiplies the other.
    node.inputs['Roughness'].default_value = (along * across) ** 0.25
    node.inputs['Anisotropy'].default_value = (across / along) ** 0.5 - 1
    node.inputs['Rotation'].default_value = anisotropy.get('anisotropyRotation', 0) / (2 * math.pi)
    return node.outputs[0]


def follow_specification(material, described):
    """Rebuilds differences of Blender 3.4's Principled BSDF from the specification: its base is Disney's
    diffuse and is not attenuated by the interface above it, and it emits on both sides. For surfaces
    without normal maps, coats and alpha, as extensions.py makes them."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    principled = next((n for n in nodes if n.type == 'BSDF_PRINCIPLED'), None)
    if principled is None:
        return
    metallic, roughness, transmission, f0, f90 = surface_of(described)
    targets = [link.to_socket for link in principled.outputs[0].links]
    follow_volume(material, described)
    if 'KHR_materials_anisotropy' in described.get('extensions', {}):
        for target in targets:
            links.new(brushed(material.node_tree, described), target)
        return

    def take(name, socket):
        """Moves an input of the Principled BSDF to another socket, and leaves black."""
        source = principled.inputs[name]
        for link in list(source.links):
            links.new(link.from_socket, socket)
            links.remove(link)
        socket.default_value = source.default_value
        source.default_value = (0, 0, 0, 1)

    shaders = []
    if metallic == 0 and transmission == 0:
        diffuse, below = nodes.new('ShaderNodeBsdfDiffuse'), nodes.new('ShaderNodeMixShader')
        take('Base Color', diffuse.inputs['Color'])
        links.new(diffuse.outputs[0], below.inputs[1])
        below.inputs[0].default_value = 0
        if f0 > 0:
            share = reflected(material.node_tree, roughness, f0, f90)
            links.new(share, below.inputs[0])
            shaders.append(glossy(material.node_tree, roughness, share))
        for link in list(principled.inputs['Specular'].links):
            links.remove(link)
        principled.inputs['Specular'].default_value = 0
        shaders.append(below.outputs[0])
    else:
        shaders.append(principled.outputs[0])
    strength = principled.inputs['Emission Strength'].default_value
    if max(described.get('emissiveFactor', [0])) > 0:
        emission = nodes.new('ShaderNodeEmission')
        take('Emission', emission.inputs['Color'])
        emission.inputs['Strength'].default_value = strength
        if not described.get('doubleSided', False):
            geometry, front = nodes.new('ShaderNodeNewGeometry'), nodes.new('ShaderNodeMath')
            front.operation = 'MULTIPLY_ADD'  # strength, at the back 0
            front.inputs[1].default_value, front.inputs[2].default_value = -strength, strength
            links.new(geometry.outputs['Backfacing'], front.inputs[0])
            links.new(front.outputs[0], emission.inputs['Strength'])
        shaders.append(emission.outputs[0])
    total = shaders[0]
    for shader in shaders[1:]:
        both = nodes.new('ShaderNodeAddShader')
        links.new(total, both.inputs[0])
        links.new(shader, both.inputs[1])
        total = both.outputs[0]
    for target in targets:
        links.new(total, target)


def load(o):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=o['model'])
    scene = bpy.context.scene
    scene.camera = next(x for x in scene.objects if x.type == 'CAMERA')
    for light in bpy.data.lights:  # glTF's have no size, Blender's new ones do
        light.shadow_soft_size = 0
        if light.type == 'SUN':
            light.angle = 0
    for x in scene.objects:  # where smooth normals and coarse triangles disagree
        if x.type == 'MESH':
            x.cycles.shadow_terminator_geometry_offset = 0
    for material in bpy.data.materials:  # an absorption of nothing
        if material.use_nodes:
            for node in [n for n in material.node_tree.nodes if n.type == 'VOLUME_ABSORPTION']:
                if node.inputs['Density'].default_value == 0:
                    material.node_tree.nodes.remove(node)
    scene.world = None
    return scene


def set_up(scene, o):
    r, c = scene.render, scene.cycles
    r.engine = 'CYCLES'
    r.resolution_x, r.resolution_y, r.resolution_percentage = o['width'], o['height'], 100
    r.threads_mode, r.threads = 'FIXED', 2
    r.image_settings.file_format = 'OPEN_EXR_MULTILAYER'
    r.image_settings.color_depth = '32'
    r.film_transparent = False
    c.device, c.use_denoising, c.use_adaptive_sampling, c.film_exposure = 'CPU', False, False, 1
    c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = o['bounces']
    c.transparent_max_bounces = 64
    c.sample_clamp_direct = c.sample_clamp_indirect = c.light_sampling_threshold = c.blur_glossy = 0
    c.caustics_reflective = c.caustics_refractive = True
    c.pixel_filter_type, c.filter_width = 'BOX', 1
    if o['frame'] is not None:
        frame = o['frame'] * r.fps / r.fps_base
        scene.frame_set(int(frame), subframe=frame - int(frame))
    r.use_motion_blur = o['shutter'] > 0
    r.motion_blur_shutter = o['shutter'] * r.fps / r.fps_base or 1
    c.motion_blur_position = 'START'


def main():
    o = json.loads(sys.argv[-1])
    described = read_materials(o['model'])
    scene, loaded = None, None
    for run in o['runs']:
        if loaded != run['materials']:
            scene, loaded = load(o), run['materials']
            set_up(scene, o)
            if loaded == 'specification':
                for material in bpy.data.materials:
                    if material.name in described and material.use_nodes:
                        follow_specification(material, described[material.name])
        scene.cycles.samples, scene.cycles.seed = run['spp'], run['seed']
        scene.render.filepath = '%s/%s.exr' % (o['folder'], run['name'])
        bpy.ops.render.render(write_still=True)


main()
