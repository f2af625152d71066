"""The passes of a render: passes that lull always has, and passes that the view layer asks for."""
import json
from dataclasses import dataclass
from typing import Callable

import numpy as np

_LAYERS = 3  # of Cryptomatte, two ranks each
# Passes that Cycles or EEVEE have and lull lacks, by their properties.
_LACKED = ("vector", "uv", "shadow", "ambient_occlusion", "emit", "environment", "diffuse_direct", "diffuse_indirect",
           "diffuse_color", "glossy_direct", "glossy_indirect", "glossy_color", "transmission_direct", "transmission_indirect",
           "transmission_color", "subsurface_direct", "subsurface_indirect", "subsurface_color")


@dataclass
class Picture:
    """The source of passes: channels and attributes of an EXR, and the result of the export."""
    channels: dict
    attributes: dict
    exported: dict
    scene: object
    eye: object  # where the camera is


@dataclass
class Pass:
    name: str
    channels: str  # Blender's names of its channels
    aov: str  # of lull; empty: none
    fill: Callable  # takes a Picture, returns an array of height x width x channels

    @property
    def kind(self):
        return 'VALUE' if len(self.channels) == 1 else 'VECTOR' if self.channels == "XYZ" else 'COLOR'


def _channels(names, prefix=""):
    return lambda picture: np.stack([picture.channels[prefix + n] for n in names], -1)


def _turned(prefix):
    """Of glTF's world, whose y is up."""
    def fill(picture):
        x, y, z = (picture.channels[prefix + c] for c in "XYZ")
        return np.stack([x, -z, y], -1)
    return fill


def _index(which):
    """Returns a function that reads the numbers of objects or materials as Blender's pass indices."""
    def fill(picture):
        names = json.loads(picture.attributes[which + "Names"].decode())
        numbers, indices = picture.channels[which + "ID"], getattr(picture.exported, which + "s")
        found = np.zeros(numbers.shape, np.float32)
        for number, name in names.items():
            if name in indices:
                found[numbers == int(number)] = indices[name]
        return found[..., None]
    return fill


def _mist(picture):
    settings = picture.scene.world.mist_settings
    away = _turned("P.")(picture) - np.array(picture.eye)
    is_flat = picture.scene.camera.data.type == 'ORTHO'
    distance = picture.channels["Z"] if is_flat else np.linalg.norm(away, axis=-1)
    share = np.clip((distance - settings.start) / max(settings.depth, 1e-9), 0, 1)
    share = share ** {'QUADRATIC': 2, 'LINEAR': 1, 'INVERSE_QUADRATIC': 0.5}[settings.falloff]
    covered = picture.channels["A"]
    return (1 - covered + covered * share)[..., None]


def _noisy(picture):
    of = "noisy." if "noisy.R" in picture.channels else ""
    alpha = picture.channels["A"] if picture.scene.render.film_transparent else np.ones_like(picture.channels["R"])
    return np.stack([*(picture.channels[of + c] for c in "RGB"), alpha], -1)


def _of_group(name):
    def fill(picture):
        layer = picture.exported.groups.get(name)
        if layer is None:  # nothing shines
            return np.zeros((*picture.channels["R"].shape, 3), np.float32)
        return _channels("RGB", f"light.{layer}.")(picture)
    return fill


_FIRST_HITS = (("Depth", "Z", "depth", _channels("Z")), ("Normal", "XYZ", "normal", _turned("N.")),
               ("Albedo", "RGB", "albedo", _channels("RGB", "albedo.")))


def wanted(scene, layer):
    """Returns the passes of a view layer, besides Combined. Denoising ..., Noisy Image and Debug Sample Count are
    names of Cycles, which composites link."""
    of_cycles, stores = layer.cycles, layer.cycles.denoising_store_passes
    found = [Pass(*hit) for hit in _FIRST_HITS]
    found += [Pass("Samples", "X", "", _channels(["spp"])), Pass("Noise", "X", "noise", _channels(["noise"]))]
    found += [Pass("Denoising " + name, *rest) for name, *rest in _FIRST_HITS if stores]
    found += [Pass(*rest) for is_wanted, *rest in (
        (scene.lull.denoise, "Noisy", "RGB", "", _channels("RGB", "noisy.")),
        (stores or scene.cycles.use_denoising and of_cycles.use_denoising, "Noisy Image", "RGBA", "", _noisy),
        (of_cycles.pass_debug_sample_count, "Debug Sample Count", "X", "", _channels(["spp"])),
        (layer.use_pass_position, "Position", "XYZ", "position", _turned("P.")),
        (layer.use_pass_mist and scene.world, "Mist", "Z", "position,alpha", _mist),
        (layer.use_pass_object_index, "IndexOB", "X", "object", _index("object")),
        (layer.use_pass_material_index, "IndexMA", "X", "material", _index("material"))) if is_wanted]
    layers = min(_LAYERS, -(-layer.pass_cryptomatte_depth // 2))
    for kind in "Object", "Material":
        if getattr(layer, "use_pass_cryptomatte_" + kind.lower()):
            names = [f"Crypto{kind}{i:02}" for i in range(layers)]
            found += [Pass(n, "rgba", "cryptomatte", _channels("RGBA", n + ".")) for n in names]
    return found + [Pass("Combined_" + g.name, "RGB", "", _of_group(g.name)) for g in layer.lightgroups]


def lacked(layer):
    """Returns the names of passes that a view layer asks for and lull lacks."""
    found = [name.replace("_", " ") for name in _LACKED if getattr(layer, "use_pass_" + name, False)]
    found += [name for name, wanted in (
        ("volume direct", layer.cycles.use_pass_volume_direct), ("volume indirect", layer.cycles.use_pass_volume_indirect),
        ("shadow catcher", layer.cycles.use_pass_shadow_catcher)) if wanted]
    if (layer.use_pass_cryptomatte_object or layer.use_pass_cryptomatte_material) and layer.pass_cryptomatte_depth > 2 * _LAYERS:
        found.append(f"cryptomatte above {2 * _LAYERS} levels")
    return found + ["cryptomatte of assets"] * layer.use_pass_cryptomatte_asset + [aov.name for aov in layer.aovs]


def arguments(passes, groups):
    """Returns the arguments of `lull render` for passes, and light groups as lull knows them."""
    names = ",".join(p.aov for p in passes if p.aov).split(",")
    said = ["--aov", ",".join(dict.fromkeys(names))]
    return said + (["--light-groups", ",".join(groups.values())] if groups else [])


def cryptomatte_fields(layer, attributes):
    """Yields the fields of Cryptomatte's metadata with Blender's names of layers."""
    for key, value in attributes.items():
        if key.startswith("cryptomatte/"):
            value = value.decode()
            yield key, f"{layer}.{value}" if key.endswith("/name") else value
