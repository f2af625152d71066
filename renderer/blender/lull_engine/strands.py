"""Makes meshes of hair: particles that are rendered as paths, and hair curves. glTF has no curves."""
import numpy as np

from . import meshes
from .nodes import all_nodes

STRANDS = "lull strand"  # UVs: a random number, and the way along a strand; 0, 0 on other surfaces
_SIDES, _MOST = (3, 8), 1_000_000  # of tubes, at least and at most; vertices, beyond which tubes have fewer sides
_LIMIT, _BYTES = 12_000_000, 600  # vertices at most; of memory that each takes, here and in lull
_RADIUS = 0.005  # of curves that have none, as in Cycles


def _kept(count, steps, name, notes):
    """Returns which of so many strands and of their steps are shown, and how much wider, so that they fit into memory."""
    most = _LIMIT
    try:
        with open("/proc/meminfo", encoding="ascii") as f:
            free = next(int(line.split()[1]) for line in f if line.startswith("MemAvailable:"))
        most = min(most, free * 1024 // 2 // _BYTES)
    except (OSError, StopIteration):
        pass
    points = max(most // _SIDES[0], 2)
    every = -(-2 * count // points)
    left = int(np.clip(points // -(-count // every), 2, steps))
    if left < steps or every > 1:
        told = f"1 of {every} hairs, as much wider, " * (every > 1) + f"{left - 1} of {steps - 1} segments"
        notes.add(f"shown with {told}, as all would take {count * steps * _SIDES[0] * _BYTES / 1e9:.0f} GB", name)
    return slice(None, None, every), np.linspace(0, steps - 1, left).round().astype(int), every


def of_particles(o, notes):
    """Returns meshes, in the world, of the hair of an evaluated object, with its materials."""
    found = []
    for modifier in o.modifiers:
        if modifier.type != 'PARTICLE_SYSTEM' or not modifier.show_render:
            continue
        system = modifier.particle_system
        settings = system.settings
        if settings.type != 'HAIR' or settings.render_type != 'PATH':
            continue
        parents, children = len(system.particles), len(system.child_particles)
        first = parents if children and not settings.use_parent_particles else 0
        steps = (1 << settings.render_step) + 1
        some, at, wider = _kept(parents + children - first, steps, o.name, notes)
        numbers = range(first, parents + children)[some]
        points = np.array([system.co_hair(o, particle_no=i, step=s) for i in numbers for s in at.tolist()]).reshape(-1, len(at), 3)
        slots = [slot.material for slot in o.material_slots]
        material = slots[min(settings.material, len(slots)) - 1] if slots else None
        uvs = _uvs(o, modifier, system, numbers)
        found.append(_tubes(o.name, points, np.broadcast_to(wider * _radii(settings, steps)[at], points.shape[:2]), material, uvs))
    return [mesh for mesh in found if mesh]


def _radii(settings, steps):
    """Returns the radius at each step, as Cycles has it."""
    left = 1 - np.linspace(0, 1, steps)
    shape = settings.shape
    left = left ** (1 + shape if shape < 0 else 1 / max(1 - shape, 1e-6))
    root, tip = (0.5 * settings.radius_scale * r for r in (settings.root_radius, settings.tip_radius))
    radii = left * (root - tip) + tip
    if settings.use_close_tip:
        radii[-1] = 0
    return radii


def _uvs(o, modifier, system, numbers):
    """Returns where each strand stands on the UVs of its emitter; None without UVs."""
    if o.type != 'MESH' or not o.data.uv_layers or not system.particles:
        return None
    first = system.particles[0]
    own = len(system.particles)
    return np.array([system.uv_on_emitter(modifier, particle=system.particles[i] if i < own else first, particle_no=i, uv_no=0)
                     for i in numbers])


def of_curves(o, notes):
    """Returns a mesh, in the space of the object, of evaluated hair curves; None without any."""
    data = o.data
    if not len(data.curves):
        return None
    points = np.empty(3 * len(data.points))
    data.attributes["position"].data.foreach_get("vector", points)
    points = points.reshape(-1, 3)
    radii = np.full(len(points), _RADIUS)
    if "radius" in data.attributes:
        data.attributes["radius"].data.foreach_get("value", radii)
    counts = np.array([c.points_length for c in data.curves])
    starts = np.array([c.first_point_index for c in data.curves])
    some, steps, wider = _kept(len(counts), int(counts.max()), o.name, notes)
    # The last point is repeated where a curve has fewer.
    at = starts[some, None] + np.minimum(steps, counts[some, None] - 1)
    return _tubes(o.name, points[at], wider * radii[at], o.material_slots[0].material if o.material_slots else None, None)


def _tubes(name, points, radii, material, uvs):
    """Makes a mesh of tubes around lines: arrays of strands x steps x 3, and of strands x steps."""
    count, steps = points.shape[:2]
    if not count or steps < 2:
        return None
    along = np.gradient(points, axis=1)
    along /= np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), 1e-12)
    # A frame that does not turn along a strand, from the axis at the largest angle to its chord.
    whole = points[:, -1] - points[:, 0]
    least = np.eye(3)[np.argmin(abs(whole), axis=1)]
    side = np.cross(along, least[:, None])
    side /= np.maximum(np.linalg.norm(side, axis=-1, keepdims=True), 1e-12)
    other = np.cross(along, side)
    sides = int(np.clip(_MOST // (count * steps), *_SIDES))
    wider = np.pi / (sides * np.sin(np.pi / sides))  # so that tubes are as wide as round ones, on average
    angles = 2 * np.pi * np.arange(sides) / sides
    ring = side[..., None, :] * np.cos(angles)[:, None] + other[..., None, :] * np.sin(angles)[:, None]
    vertices = (points[..., None, :] + wider * radii[..., None, None] * ring).reshape(-1, 3)
    number = np.arange(count * steps * sides, dtype=np.int32).reshape(count, steps, sides)
    low, high = number[:, :-1], number[:, 1:]
    corners = np.stack([low, np.roll(low, -1, 2), np.roll(high, -1, 2), high], -1).ravel()
    mesh = meshes.Mesh(name, vertices.astype(np.float32), corners, np.arange(0, len(corners), 4, dtype=np.int32))
    mesh.cut()
    mesh.normals = ring.reshape(-1, 3)[corners].astype(np.float32)
    mesh.materials = [material]
    mesh.uv_of_render = "UVMap"
    if uvs is not None:
        mesh.uvs["UVMap"] = np.repeat(uvs, (steps - 1) * sides * 4, 0).astype(np.float32)
    if material is None or not material.use_nodes or all(n.type != 'HAIR_INFO' for n in all_nodes(material.node_tree)):
        return mesh
    way = np.arange(steps) / (steps - 1)
    told = np.empty((count, steps - 1, sides, 4, 2), np.float32)
    told[..., 0] = np.random.default_rng(0).uniform(0.001, 0.999, count)[:, None, None, None]
    told[..., 1] = np.stack([way[:-1], way[:-1], way[1:], way[1:]], -1)[:, None]  # of the corners
    mesh.uvs[STRANDS] = told.reshape(-1, 2)
    return mesh
