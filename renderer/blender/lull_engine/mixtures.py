"""Mixed and added surfaces as parameters, which are mixed with the same factor."""
from . import values
from .bsdfs import BLACK, DEFAULTS, bounced
from .nodes import is_output, upstream, value_of
from .values import times

# The marks of surfaces that the rays of an output pass.
_HIDING_RAYS = {'Is Camera Ray': "hiddenFromCamera", 'Is Shadow Ray': "castsNoShadow"}
_REFLECTING = 'Metallic', 'Specular', 'Transmission', 'Shine', 'Clearcoat'


def mixed(surface, node):
    halves = _halves(surface, node.inputs[1:3])
    if halves is None:
        return None
    (a, b), factor = halves, values.clamped(value_of(node.inputs[0]))
    if is_output(factor) and values.is_by_view(factor):
        if node is surface.root and _hides_from_rays(surface, b, factor):
            return a
        return _mixed_by_view(surface, a, b, factor)
    if not is_output(factor) and factor in (0, 1):
        return b if factor else a
    for clear, other, share in (a, b, factor), (b, a, values.minus(factor)):
        if clear['Alpha'] == 0:
            if clear['Tint'] != (1, 1, 1):
                surface.note("without colour where they are transparent")
            return dict(other, Alpha=times(other['Alpha'], share))
    both = {name: values.mix(factor, a[name], b[name]) for name in DEFAULTS}
    if 'Added' in a or 'Added' in b:
        both['Added'] = True
    reflecting = [p for p in (a, b) if _reflects(p)]
    both.update({mark: True for mark in ('Even', 'Multi') if reflecting and all(mark in p for p in reflecting)})
    _keep_highlights(surface, both, a, b, factor)
    if 'Normal' in a or 'Normal' in b:
        reflect = all(p['Base Color'] != (0, 0, 0) for p in (a, b))
        if reflect and a.get('Normal') is not b.get('Normal'):
            surface.note("with the normals of the first of mixed surfaces that has any")
        both['Normal'] = a.get('Normal', b.get('Normal'))
    return both


def added(surface, node):
    halves = _halves(surface, node.inputs[:2])
    if halves is None:
        return None
    a, b = halves
    is_base_black = a['Base Color'] == (0, 0, 0) and (a['Radiance'] != (0, 0, 0) or a['Through'] != (0, 0, 0))
    first, other = (b, a) if is_base_black else (a, b)
    if _is_metal(first) and not _reflects(other):
        first, other = other, first
    radiance = values.plus(first['Radiance'], other['Radiance'])
    if _is_metal(other) and not _reflects(first):
        return dict(first, **{'Shine': 1, 'Shine Color': other['Base Color'], 'Roughness': other['Roughness'], 'Radiance': radiance,
                              'Base Color': values.plus(first['Base Color'], bounced(other)),
                              **{mark: True for mark in ('Even', 'Multi') if mark in other}})
    if other['Base Color'] != (0, 0, 0):
        surface.note("without the second of added surfaces")
    return dict(first, Radiance=radiance, Through=values.plus(first['Through'], other['Through']))


def _halves(surface, sockets):
    """Returns the parameters of both halves of a mixture, black where nothing is linked, as in Cycles; None if both are unknown."""
    found = [surface.closure(socket) for socket in sockets]
    if found == [None, None]:
        return None
    for i, socket in enumerate(sockets):
        if found[i] is None and socket.source is None:
            found[i] = dict(BLACK)
        elif found[i] is None:
            surface.note("in part in the viewport colour, as one of its surfaces is unknown")
            found[i] = dict(DEFAULTS, **{'Base Color': tuple(surface.material.diffuse_color)[:3]})
    return found


def _keep_highlights(surface, both, a, b, factor):
    """Gives a mixture the roughness and the colour of its reflecting half, and the base of the other."""
    shares = ((a, values.minus(factor)), (b, factor))
    reflecting = [(p, share) for p, share in shares if _reflects(p)]
    if len(reflecting) == 2 and not any(is_output(p['Roughness']) for p in (a, b)) and abs(a['Roughness'] - b['Roughness']) > 0.1:
        surface.note("reflecting by one roughness, between those of mixed surfaces")
    if len(reflecting) != 1:
        return
    (shiny, share), = reflecting
    base = b if shiny is a else a
    both.update({name: shiny[name] for name in ('Roughness', 'Shine Color')})
    if _is_metal(shiny):
        both.update({'Metallic': 0, 'Shine': share, 'Shine Color': shiny['Base Color'],
                     'Base Color': values.plus(times(values.minus(share), base['Base Color']), times(share, bounced(shiny)))})


def _reflects(p):
    return any(is_output(p[name]) or p[name] > 0 for name in _REFLECTING)


def _is_metal(p):
    return p['Metallic'] == 1 and p['Transmission'] == 0


def _hides_from_rays(surface, other, factor):
    """Marks a surface that rays of one kind pass, where a factor gives them the `other`, clear surface. Returns whether it is."""
    mark = _HIDING_RAYS.get(factor.name) if factor.node.type == 'LIGHT_PATH' else None
    if mark is None or other['Alpha'] != 0 or other['Tint'] != (1, 1, 1) or other['Radiance'] != (0, 0, 0):
        return False
    surface.own[mark] = True
    return True


def _mixed_by_view(surface, a, b, factor):
    """A coat that a Fresnel factor adds is glTF's own, and so is a sheet of glass; by kinds of rays, the surface that lights
    the scene is taken, else that for the camera."""
    kinds = {n.type for n in upstream(factor)}
    is_ray, is_by_angle = 'LIGHT_PATH' in kinds, not kinds.isdisjoint({'FRESNEL', 'LAYER_WEIGHT'})
    if is_by_angle and not is_ray and a['Metallic'] == 0 and a['Alpha'] == 1 and b['Metallic'] == 1:
        return _coated(surface, a, b, factor)
    clear, other = (a, b) if a['Alpha'] == 0 else (b, a)
    is_glass = clear['Alpha'] == 0 and other['Alpha'] == 1 and (other['Metallic'] == 1 or other['Transmission'] == 1)
    if is_glass and is_by_angle and not is_ray:
        return _pane(surface, clear, other, factor if clear is a else None)
    if is_glass and is_ray and other['Transmission'] == 1:
        return _lit_through(surface, other)
    surface.note("the same from all sides and for all rays")
    if is_ray:
        return b if factor.name == 'Is Camera Ray' and a['Radiance'] == (0, 0, 0) else a
    return other if clear['Alpha'] == 0 else a


def _coated(surface, base, shine, factor):
    """Returns a surface under a coat that reflects as a factor says."""
    ior = _ior_of(factor)
    specular = ((ior - 1) / (ior + 1)) ** 2 / 0.08 if ior else 0.5
    if ior is None or specular > 1:
        surface.note("reflecting as a clear coat does")
    if is_output(shine['Base Color']) or min(shine['Base Color']) < 0.75:
        surface.note("reflecting white light")
    return dict(base, Specular=min(specular, 1), Roughness=shine['Roughness'])


def _pane(surface, clear, shine, factor):
    """Returns a sheet of glass, for a clear surface that shines as a factor says, None for one that is not known."""
    ior = _ior_of(factor) if factor is not None else None
    if ior is None:
        surface.note("reflecting as clear glass does")
    if is_output(shine['Roughness']) or shine['Roughness'] > 0.1 or shine['Base Color'] != (1, 1, 1) and \
            (is_output(shine['Base Color']) or min(shine['Base Color']) < 0.75):
        surface.note("reflecting white light, and sharply")
    surface.note("made a sheet of glass, the same from both sides")
    surface.is_thin = True
    return dict(DEFAULTS, **{'Base Color': clear['Tint'], 'Transmission': 1, 'Specular': 0.5, 'Roughness': 0, 'IOR': ior or 1.45})


def _lit_through(surface, glass):
    """Returns glass which light passes that other glass refracts."""
    if surface.is_thin:
        return glass
    if surface.is_solid():
        surface.note("solid glass, which lamps do not shine through")
        return glass
    surface.note("made a sheet of glass, the same from both sides")
    surface.is_thin = True
    return glass


def _ior_of(factor):
    """Returns the index of refraction by which a factor grows with the angle; None where it does not as glass has it."""
    value = factor.node.inputs[0]
    if value.source is not None:
        return None
    if factor.node.type == 'FRESNEL':
        return value.default_value
    if factor.node.type == 'LAYER_WEIGHT' and factor.name == 'Fresnel':
        return 1 / max(1 - value.default_value, 1e-5)
    return None
