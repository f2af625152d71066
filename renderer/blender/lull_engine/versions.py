"""What Blender 3 and Blender 4 call differently, in one table. Only 3.4 is tested."""
import bpy

# Inputs of the Principled BSDF, by our names: those until and from Blender 4.
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


def principled_input(node, name):
    """Returns the input of a Principled BSDF; None where this Blender has none of the name."""
    names = _PRINCIPLED.get(name, (name,))
    return next((node.inputs[n] for n in names if n in node.inputs), None)


def displacement_method(material):
    return getattr(material, "displacement_method", None) or material.cycles.displacement_method  # the latter until 4.0


def panorama(camera):
    """Returns the owner of a camera's `panorama_type`."""
    return camera if hasattr(camera, "panorama_type") else camera.cycles
