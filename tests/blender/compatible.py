"""Differences between versions of Blender for the cases of features/, which use the names of Blender 3. For Blender's Python."""
import bpy

IS_FOUR = bpy.app.version >= (4, 0)
LINEAR, RAW = ("Linear Rec.709", "Non-Color") if IS_FOUR else ("Linear", "Raw")
_INPUTS = {"Specular": "Specular IOR Level", "Transmission": "Transmission Weight", "Clearcoat": "Coat Weight",
           "Clearcoat Roughness": "Coat Roughness", "Clearcoat Normal": "Coat Normal", "Emission": "Emission Color",
           "Subsurface": "Subsurface Weight", "Sheen": "Sheen Weight"}
_KINDS = {"ShaderNodeBsdfVelvet": "ShaderNodeBsdfSheen", "ShaderNodeTexMusgrave": "ShaderNodeTexNoise"}


def new_node(tree, kind):
    """Adds a node. A Principled BSDF shines as that of Blender 3, by its colour."""
    if bpy.app.version >= (4, 1) or kind != "ShaderNodeTexMusgrave" and IS_FOUR:
        kind = _KINDS.get(kind, kind)
    made = tree.nodes.new(kind)
    if IS_FOUR and kind == 'ShaderNodeBsdfPrincipled':
        made.inputs["Emission Color"].default_value, made.inputs["Emission Strength"].default_value = (0, 0, 0, 1), 1
    return made


def socket(node, name):
    """Returns an input of a node; None for one that this Blender has no more."""
    if node.type == 'BSDF_PRINCIPLED' and IS_FOUR:
        name = _INPUTS.get(name, name)
    return node.inputs.get(name) if node.type == 'BSDF_PRINCIPLED' else node.inputs[name]


def set_input(node, name, value):
    found = socket(node, name)
    if found is not None:
        is_colour = found.type == 'RGBA' and isinstance(value, (int, float))
        found.default_value = (value, value, value, 1) if is_colour else value


def add_input(group, kind, name):
    return group.interface.new_socket(name, in_out='INPUT', socket_type=kind) if IS_FOUR else group.inputs.new(kind, name)


def add_output(group, kind, name):
    return group.interface.new_socket(name, in_out='OUTPUT', socket_type=kind) if IS_FOUR else group.outputs.new(kind, name)


def displace(material, how):
    """Sets the displacement method."""
    (material if hasattr(material, "displacement_method") else material.cycles).displacement_method = how


def shadow_transparently(material, does):
    (material if hasattr(material, "use_transparent_shadow") else material.cycles).use_transparent_shadow = does


def use_own_normals(o):
    """Lets a mesh have its custom normals."""
    if hasattr(o.data, "use_auto_smooth"):
        o.data.use_auto_smooth = True


def shade_smooth_to(o, angle):
    """Smooths an object's faces that meet at less than an angle."""
    if hasattr(o.data, "use_auto_smooth"):
        o.data.use_auto_smooth, o.data.auto_smooth_angle = True, angle
        return
    for each in bpy.context.view_layer.objects:
        each.select_set(each == o)
    bpy.context.view_layer.objects.active = o
    bpy.ops.object.shade_smooth_by_angle(angle=angle)


def offset_shadow(o, by):
    """Sets the Shading Offset of an object."""
    if hasattr(o, "shadow_terminator_shading_offset"):
        o.shadow_terminator_shading_offset = by
    else:
        o.cycles.shadow_terminator_offset = by


def open_shutter(scene, at):
    """Sets the place of the shutter's time: START, CENTER or END."""
    (scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles).motion_blur_position = at


def add_grease_pencil(at):
    """Adds one where a Blender without a window can draw it."""
    if bpy.app.version < (4, 3):
        bpy.ops.object.gpencil_add(location=at, type='STROKE')
