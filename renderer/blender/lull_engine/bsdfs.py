"""Surfaces of one node as parameters. Besides DEFAULTS they may have a Normal, and marks: Added, of an interface that does not attenuate
the base; Even, of one that reflects as much from all directions; Multi, of one whose microfacets keep all light."""
import numpy as np

from .nodes import is_output, value_of
from .values import times
from .versions import HAS_ADDED_INTERFACE, principled_input

# Parameters that are inputs of a Principled BSDF.
_INPUTS = ('Base Color', 'Metallic', 'Roughness', 'Specular', 'Transmission', 'IOR', 'Alpha', 'Clearcoat', 'Clearcoat Roughness')
_ROUGH = ('Transmission', 0.25), ('Metallic', 0.5)  # roughness, from which it shows
# Specular is the reflectance at normal incidence, divided by 0.08, as in Blender 3.
DEFAULTS = {'Base Color': (0.8, 0.8, 0.8), 'Metallic': 0, 'Roughness': 1, 'Specular': 0, 'Transmission': 0, 'IOR': 1.45,
            'Alpha': 1, 'Clearcoat': 0, 'Clearcoat Roughness': 0.03, 'Radiance': (0, 0, 0), 'Through': (0, 0, 0),
            'Sheen': (0, 0, 0), 'Sheen Roughness': 0.5, 'Specular Tint': (1, 1, 1),
            'Tint': (1, 1, 1), 'Shine': 0, 'Shine Color': (1, 1, 1)}  # the latter are of a Glossy surface that is added to the base
BLACK = dict(DEFAULTS, **{'Base Color': (0, 0, 0)})
_KEPT = np.linspace(0, 1, 11), (1, 0.9996, 0.9944, 0.9777, 0.9428, 0.8853, 0.8074, 0.7129, 0.6091, 0.506, 0.4121)  # after one bounce
# Plain values of these are left out.
_UNSAID = ('Subsurface', 'Anisotropic', 'Transmission Roughness', 'Thin Film Thickness', 'Diffuse Roughness')
_UNSAID_IN_3, _UNSAID_IN_4 = ('Sheen', 'Specular Tint'), ('Coat Tint',)


def made(node, **parameters):
    found = dict(DEFAULTS, **{k.replace('_', ' '): v for k, v in parameters.items()})
    normal = node.inputs.get('Normal')
    if normal is not None and normal.source is not None:
        found['Normal'] = normal.source
    return found


def _note_roughness(surface, node, found):
    """Marks surfaces that keep all light, and notes others so rough that single scattering loses light."""
    kind = getattr(node, "distribution", '')
    rough = next((least for name, least in _ROUGH if is_output(found[name]) or found[name] > 0), None)
    is_rough = rough is not None and (is_output(found['Roughness']) or found['Roughness'] > rough)
    if kind == 'MULTI_GGX':
        found['Multi'] = True
        if is_rough and not any(bounced(found)):
            surface.note("darker than Cycles' where rough, without multiple scattering")
    elif is_rough and found['Metallic'] != 0 and kind in ('BECKMANN', 'ASHIKHMIN_SHIRLEY'):
        surface.note(f"with the highlights of GGX instead of {'Beckmann' if kind == 'BECKMANN' else 'Ashikhmin-Shirley'}")
    return found


def bounced(found):
    """Returns the colour of the light that leaves the microfacets of a metal after more than one bounce, as from a diffuse surface."""
    colour, roughness = found['Base Color'], found['Roughness']
    if 'Multi' not in found or found['Metallic'] != 1 or is_output(colour) or is_output(roughness):
        return 0, 0, 0
    lost = 1 - float(np.interp(roughness, *_KEPT))
    return tuple(lost * (1 - lost) * c * c / (1 - lost * min(c, 1)) for c in colour)


def _is_neutral(socket):
    """Returns whether an input changes nothing: a weight of 0, or a white tint."""
    if socket.source is not None:
        return False
    return socket.default_value == 0 if socket.type == 'VALUE' else min(socket.default_value[:3]) >= 1


def _principled(surface, node):
    found = made(node)
    for name in _INPUTS:
        found[name] = value_of(principled_input(node, name))
    if HAS_ADDED_INTERFACE:
        found['Clearcoat'] = times(0.25, found['Clearcoat'])
        found['Added'] = True
    else:
        ior = found['IOR'] if isinstance(found['IOR'], (int, float)) else 1.5
        found['Specular'] = times(2 * ((ior - 1) / (ior + 1)) ** 2 / 0.08, found['Specular'])
        found['Specular Tint'] = value_of(node.inputs['Specular Tint'])
        weight = value_of(node.inputs['Sheen Weight'])
        if weight != 0:
            found['Sheen'] = times(value_of(node.inputs['Sheen Tint']), weight)
            found['Sheen Roughness'] = value_of(node.inputs['Sheen Roughness'])
            surface.note("with the sheen of glTF's cloth")
        if found['Transmission'] == 1 and found['Metallic'] == 0 and not is_output(found['Base Color']):
            found['Base Color'] = tuple(max(c, 0) ** 0.5 for c in found['Base Color'])  # of each of the two sides that light passes
        if found['Clearcoat'] != 0 and value_of(node.inputs['Coat IOR']) != 1.5:
            surface.note("with a clear coat of the index 1.5")
    if found['Clearcoat'] != 0 and principled_input(node, 'Clearcoat Normal').source is not None:
        surface.note("with the normals of the surface on its clear coat")
    found['Radiance'] = times(value_of(principled_input(node, 'Emission')), value_of(node.inputs['Emission Strength']))
    for name in _UNSAID + (_UNSAID_IN_3 if HAS_ADDED_INTERFACE else _UNSAID_IN_4 if found['Clearcoat'] != 0 else ()):
        unsaid = principled_input(node, name)
        if unsaid is not None and not _is_neutral(unsaid):
            surface.note(f"without {name.lower()}")
    return _note_roughness(surface, node, found)


def _diffuse(surface, node):
    if 'Roughness' in node.inputs and not _is_neutral(node.inputs['Roughness']):
        surface.note("without diffuse roughness")
    return made(node, Base_Color=value_of(node.inputs['Color']))


def _translucent(surface, node):
    return made(node, Base_Color=(0, 0, 0), Through=value_of(node.inputs['Color']))


def _as_diffuse(surface, node):
    surface.note("shown as diffuse ones")
    return _diffuse(surface, node)


def _roughness(node):
    return 0 if getattr(node, "distribution", '') == 'SHARP' else value_of(node.inputs['Roughness'])


def _glossy(surface, node):
    anisotropy = node.inputs.get('Anisotropy')
    if anisotropy is not None and not _is_neutral(anisotropy):
        surface.note("without anisotropic")
    return _note_roughness(surface, node, made(node, Base_Color=value_of(node.inputs['Color']), Metallic=1, Roughness=_roughness(node),
                                               Even=True))


def _glass(surface, node):
    return _note_roughness(surface, node, made(node, Base_Color=value_of(node.inputs['Color']), Transmission=1, Specular=0.5,
                                               Roughness=_roughness(node), IOR=value_of(node.inputs['IOR'])))


def _refraction(surface, node):
    surface.note("reflecting as glass does")
    return _glass(surface, node)


def _transparent(surface, node):
    return dict(DEFAULTS, Alpha=0, Tint=value_of(node.inputs['Color']))


def _emission(surface, node):
    return made(node, Base_Color=(0, 0, 0), Radiance=times(value_of(node.inputs['Color']), value_of(node.inputs['Strength'])))


def _metallic(surface, node):
    surface.note("with the edges of glTF's metals")
    return made(node, Base_Color=value_of(node.inputs['Base Color']), Metallic=1, Roughness=_roughness(node))


# By the types of nodes: functions of a surface (surfaces.py) and the node, which return parameters.
READERS = {'BSDF_PRINCIPLED': _principled, 'BSDF_DIFFUSE': _diffuse, 'BSDF_TRANSLUCENT': _translucent, 'BSDF_VELVET': _as_diffuse,
           'BSDF_SHEEN': _as_diffuse, 'BSDF_TOON': _as_diffuse, 'SUBSURFACE_SCATTERING': _as_diffuse, 'BSDF_HAIR': _as_diffuse,
           'BSDF_GLOSSY': _glossy, 'BSDF_ANISOTROPIC': _glossy, 'BSDF_GLASS': _glass, 'BSDF_REFRACTION': _refraction,
           'BSDF_TRANSPARENT': _transparent, 'EMISSION': _emission, 'BSDF_METALLIC': _metallic}
