"""Names and behaviour that differ between versions of Blender, in one table. 3.4 and 4.3 are tested."""
import bpy

TESTED = (3, 4), (4, 3)

# Inputs of the Principled BSDF, by our names: until and from Blender 4.
_PRINCIPLED = {
    'Specular': ('Specular', 'Specular IOR Level'),
    'Transmission': ('Transmission', 'Transmission Weight'),
    'Clearcoat': ('Clearcoat', 'Coat Weight'),
    'Clearcoat Roughness': ('Clearcoat Roughness', 'Coat Roughness'),
    'Clearcoat Normal': ('Clearcoat Normal', 'Coat Normal'),
    'Emission': ('Emission', 'Emission Color'),
    'Subsurface': ('Subsurface', 'Subsurface Weight'),
    'Sheen': ('Sheen', 'Sheen Weight'),
}

# Blender 3's Principled BSDF does not attenuate its base under the interface; its coat has a quarter of its weight.
HAS_ADDED_INTERFACE = bpy.app.version < (4, 0)

HAS_COLOURED_LAMPS = bpy.app.version < (3, 5)  # lamps whose output has a colour instead of a shader are as bright as others
HAS_DIM_LAMPS = bpy.app.version < (4, 0)  # area lights by pi / 4, spot lights off their axis, suns by their angle
IS_PROFILE_OPEN = bpy.app.version >= (4, 0)  # the interpolation of IES profiles takes 0 behind the last angles, also around
IS_RECT_FLAT = bpy.app.version >= (4, 0)  # the pixels of a pass


def principled_input(node, name):
    """Returns the input of a Principled BSDF; None where this Blender has none of the name."""
    names = _PRINCIPLED.get(name, (name,))
    return next((node.inputs[n] for n in names if n in node.inputs), None)


def displacement_method(material):
    return getattr(material, "displacement_method", None) or material.cycles.displacement_method  # the latter until 4.0


def panorama(camera):
    """Returns the owner of a camera's `panorama_type`."""
    return camera if hasattr(camera, "panorama_type") else camera.cycles


def motion_settings(scene):
    """Returns the owner of a scene's `motion_blur_position`."""
    return scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles  # the latter until 4.1


_told = []  # versions


def not_tested():
    """Returns a sentence about a version that was not tried, once a session; None for one that was."""
    version = bpy.app.version[:2]
    if version in (*TESTED, *_told):
        return None
    _told.append(version)
    return "the add-on was tried with Blender {} and {}, not with {}".format(*(".".join(map(str, v)) for v in (*TESTED, version)))
