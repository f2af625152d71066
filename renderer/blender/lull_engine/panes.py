"""Makes sheets of panes that are modelled as slabs of glass: light sampling passes a sheet, and no solid."""
import bpy
import numpy as np

import solids
import surfaces
from versions import principled_input

_SMOOTH = 0.03  # roughness


def prepare(made, notes):
    """Replaces the meshes of flattened objects whose materials are converted."""
    sheets = {}
    for o in made:
        mesh = o.data
        if o.get("lull_shadowless"):  # light passes it as it is
            continue
        if mesh not in sheets:
            sheets[mesh] = _sheet(o) if len(mesh.materials) == 1 and _glass(mesh.materials[0]) else None
        if sheets[mesh] is not None:
            o.data = sheets[mesh]
            notes.add("made a sheet instead of a slab of glass, so that light passes", o["lull_source"])


def _glass(material):
    """Returns the surface of smooth clear glass; None for other materials."""
    surface = surfaces.principled(material)
    if surface is None or material.get("lull_absorbs") or material.get("lull_shadowless"):
        return None
    inputs = surface.inputs
    transmission = principled_input(surface, 'Transmission')
    values = (transmission, inputs['Roughness'], inputs['Base Color'], inputs['Alpha'], inputs['Normal'])
    is_glass = (not any(s.links for s in values) and transmission.default_value > 0.99 and
                inputs['Roughness'].default_value <= _SMOOTH and inputs['Alpha'].default_value == 1)
    return surface if is_glass else None


def _sheet(o):
    """Returns the middle of a closed slab; None for other meshes."""
    mesh = o.data
    points = np.empty(3 * len(mesh.vertices))
    mesh.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3)
    low, high = points.min(0), points.max(0)
    sides = (high - low) * np.abs(o.matrix_world.to_scale())
    axis = int(np.argmin(sides))
    others = np.delete(sides, axis)
    thick = high[axis] - low[axis]
    is_slab = thick > 0 and others.min() >= solids.LEAST_WIDTHS * sides[axis]
    top = points[:, axis] > high[axis] - 0.01 * thick
    bottom = points[:, axis] < low[axis] + 0.01 * thick
    if not is_slab or not (top | bottom).all() or not solids.is_closed(mesh.polygons):
        return None
    middle = points.copy()
    middle[:, axis] = (low[axis] + high[axis]) / 2
    faces = [tuple(p.vertices) for p in mesh.polygons if top[list(p.vertices)].all()]
    used = sorted({v for f in faces for v in f})
    place = {v: i for i, v in enumerate(used)}
    sheet = bpy.data.meshes.new(mesh.name + " sheet")
    sheet.from_pydata([tuple(middle[v]) for v in used], [], [tuple(place[v] for v in f) for f in faces])
    sheet.materials.append(_thin(mesh.materials[0]))
    return sheet


def _thin(material):
    """Returns glass without thickness, which light passes once: the colour of both sides of the slab."""
    thin = material.copy()
    colour = _glass(thin).inputs['Base Color']
    colour.default_value = [c * c for c in colour.default_value[:3]] + [1]
    thin["lull_thin"] = True
    return thin
