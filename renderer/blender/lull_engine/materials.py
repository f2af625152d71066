"""Writes surfaces as materials of glTF, as JSON with Textures in it."""
import math
from dataclasses import dataclass

import numpy as np

from . import images, known, normals, values
from .nodes import is_output, upstream
from .strands import STRANDS
from .surfaces import EVEN

_FINE = 0.005  # difference of neighbouring pixels, on average, from which an image has details of their size
_UNEVEN = 0.05  # difference of numbers, from which on they are not the same
_REPEAT, _CLAMP = 10497, 33071


@dataclass(frozen=True, eq=False)
class Texture:
    """`uv` is the name of the layer, "" that of the render; `moves` a KHR_texture_transform, or None."""
    picture: object
    uv: str = ""
    wrap: int = _REPEAT
    moves: dict = None
    scale: float = 1


def plain(name, colour):
    return {"name": name, "doubleSided": True, "pbrMetallicRoughness": {
        "baseColorFactor": [*(min(max(float(c), 0), 1) for c in colour), 1], "metallicFactor": 0, "roughnessFactor": 1},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}


def shining(name, radiance, spread):
    """Returns a material that shines on its front, and lets other light pass: in Cycles, lamps cast no shadows."""
    made = _of_air({"name": name, "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}})
    _emit(made, radiance)
    made["extras"] = {"lull": {"openBehind": True, **({"spread": spread} if spread < math.pi - 1e-4 else {})}}
    return made


def _of_air(material):
    """Makes a surface a sheet that reflects nothing, and lets through its base colour."""
    material.setdefault("extensions", {}).update(
        KHR_materials_specular={"specularFactor": 0}, KHR_materials_transmission={"transmissionFactor": 1}, KHR_materials_ior={"ior": 1})
    return material


def _emit(material, radiance, texture=None):
    most = max(*radiance, 0)
    if most <= 0:
        return
    material["emissiveFactor"] = [float(max(c, 0) / max(most, 1)) for c in radiance]
    if most > 1:
        material.setdefault("extensions", {})["KHR_materials_emissive_strength"] = {"emissiveStrength": float(most)}
    if texture is not None:
        material["emissiveTexture"] = texture


def write(surface, baker, pictures, note, over):
    """Returns a material. `over` is None, or for materials that depend on it a mesh, its place and the slots of the material;
    `note` takes visible differences from Cycles."""
    return _Writing(surface, baker, pictures, note, over).write()


def needs_mesh(surface, pictures):
    """Returns whether something has to be baked over the whole mesh."""
    normal = surface.parameters.get('Normal')
    baked = [value for name, value in surface.parameters.items()
             if name != 'Normal' and is_output(value) and not known.is_known(name, value, pictures)]
    surface.layers = set().union(*map(values.layers_of, baked))
    return normal is not None and not known.is_known_normal(normal, pictures) or len(surface.layers) > 1 or any(
        values.place_of(v) in ('mesh', 'object') for v in baked)


class _Writing:
    def __init__(self, surface, baker, pictures, note, over):
        self.surface, self.baker, self.pictures, self.note, self.over = surface, baker, pictures, note, over
        self.p, self.made, self.through, self.is_through_image = dict(surface.parameters), {}, None, False

    def write(self):
        s = self.surface
        self._divide_base()
        pbr = self.pbr = {}
        extensions = self.extensions = {}
        self.made.update(name=s.name, doubleSided=True, pbrMetallicRoughness=pbr, extensions=extensions)
        through, specular = self._pixels('Transmission'), self._pixels('Specular')
        self.varies = any(p.ndim == 3 and np.ptp(p[:, :, 0]) > _UNEVEN for p in (through, specular))
        even = {name: self._even(name) for name in EVEN}
        if not 1 <= even['IOR'] <= 100:  # which glTF has not
            self.note("with an index of refraction from 1 to 100")
            even['IOR'] = min(max(even['IOR'], 1), 100)
        self._write_normal()
        self._write_radiance()
        self._write_metal()
        self._write_base()
        self._write_interface(even)
        if self.varies:
            self._write_varying(through, specular, even['IOR'])
        own = dict(s.own)
        if self.through:
            extensions["KHR_materials_diffuse_transmission"] = self.through
            if self.is_through_image and "baseColorTexture" in pbr:
                self.through["diffuseTransmissionColorTexture"] = pbr["baseColorTexture"]
        if s.is_air:
            _of_air(self.made)
        if even['Transmission'] > 0 and not s.is_thin:
            volume = extensions["KHR_materials_volume"] = {"thicknessFactor": 1}  # without it, glass would be a thin sheet
            own["keepsRadiance"] = True
            if s.absorbs and max(s.absorbs) > 0:
                distance = 1 / max(s.absorbs)
                volume.update(attenuationDistance=distance, attenuationColor=[math.exp(-a * distance) for a in s.absorbs])
        if is_output(self.p['Shine']) or self.p['Shine'] > 0:
            if "evenInterface" not in own:
                own["addedInterface"] = True
            extensions.pop("KHR_materials_ior", None)  # with the usual one, normal incidence has 0.04
            extensions["KHR_materials_specular"] = self._shine(self._pixels('Shine'), self._pixels('Shine Color'))
        if own:
            self.made["extras"] = {"lull": own}
        return self.made

    def _write_interface(self, even):
        e, ior, transmission = self.extensions, even['IOR'], even['Transmission']
        if even['Clearcoat'] > 0:
            e["KHR_materials_clearcoat"] = {"clearcoatFactor": even['Clearcoat'], "clearcoatRoughnessFactor": even['Clearcoat Roughness']}
        if transmission > 0:
            e["KHR_materials_transmission"] = {"transmissionFactor": transmission}
        tint = self._pixels('Specular Tint').reshape(-1, 3).mean(0)
        if abs(even['Specular'] - 0.5) > 1e-6 or tint.min() < 1:
            f0 = ((ior - 1) / (ior + 1)) ** 2
            colour = [float(((1 - transmission) * 0.08 * even['Specular'] / f0 + transmission) * c) if f0 > 0 else 1. for c in tint]
            # Surfaces without specular reflection would reflect at grazing angles.
            e["KHR_materials_specular"] = {"specularColorFactor": colour} if max(colour) > 0 else {"specularFactor": 0}
        if ("KHR_materials_specular" in e or transmission > 0) and abs(ior - 1.5) > 1e-6:
            e["KHR_materials_ior"] = {"ior": ior}
        sheen = self._pixels('Sheen').reshape(-1, 3).mean(0)
        if sheen.max() > 0:
            e["KHR_materials_sheen"] = {"sheenColorFactor": [float(min(c, 1)) for c in sheen],
                                        "sheenRoughnessFactor": even['Sheen Roughness']}

    def _write_varying(self, through, specular, ior):
        """Lets some of the surface be glass, and some have less of an interface."""
        f0 = max(((ior - 1) / (ior + 1)) ** 2, 1e-6)
        both = _packed(through, through, specular)
        share = (1 - both[:, :, 1:2]) * 0.08 * both[:, :, 2:] / f0 + both[:, :, 1:2]
        most = max(1, float(share.max()))
        if through.any():
            self.extensions["KHR_materials_transmission"] = {"transmissionTexture": self._image(both, 'glass', False), "transmissionFactor": 1}
        self.extensions["KHR_materials_specular"] = {
            "specularTexture": self._image(_packed(np.ones(3, np.float32), share / most), 'interface', True),
            "specularColorFactor": [most] * 3}

    def _shine(self, share, colour):
        """Returns an interface that reflects a share in a colour; unless it is even, white at grazing angles."""
        if share.ndim == colour.ndim == 1:
            return {"specularFactor": float(share[0]), "specularColorFactor": [float(c) / 0.04 for c in colour]}
        both = self._image(_packed(colour, share), 'shine', True)
        return {"specularTexture": both, "specularColorTexture": both, "specularColorFactor": [1 / 0.04] * 3}

    def _write_metal(self):
        metallic, roughness = self.p['Metallic'], self.p['Roughness']
        if not is_output(metallic) and not is_output(roughness):
            self.pbr.update(metallicFactor=float(metallic), roughnessFactor=float(roughness))
            return
        shown = [self._channel(v) if is_output(v) and known.is_known(n, v, self.pictures) else None
                 for n, v in (('Metallic', metallic), ('Roughness', roughness))]
        nodes = {n for n, _ in filter(None, shown)}
        if len(nodes) == 1 and all(found or not is_output(v) for found, v in zip(shown, (metallic, roughness))):
            self._write_known_metal(nodes.pop(), *(found and found[1] for found in shown))
            return
        packed = _packed(np.zeros(3, np.float32), self._pixels('Roughness'), self._pixels('Metallic'))
        self.pbr["metallicRoughnessTexture"] = self._image(packed, 'metal', False)

    def _write_known_metal(self, node, metal, rough):
        """Writes the channels of one image, numbers or None; glTF has roughness in the green one and metal in the blue one."""
        metallic, image = self.p['Metallic'], node.image
        is_grey = self.pictures.is_grey(image)
        fits = (rough is None or rough == 1 or is_grey) and (metal == 2 or is_grey and metal is not None or metal is None and metallic == 0)
        self.pbr.update(metallicFactor=1. if metal is not None else float(metallic), roughnessFactor=1. if rough is not None else
                        float(self.p['Roughness']))
        if fits:
            self.pbr["metallicRoughnessTexture"] = self._texture(node, self.pictures.data(image))
            return
        pixels = self.pictures.numbers_of(image)
        made = np.ones((*pixels.shape[:2], 3), np.float32)
        for at, channel in (1, rough), (2, metal):
            if channel is not None:
                made[:, :, at] = pixels[:, :, channel]
        self.pbr["metallicRoughnessTexture"] = self._texture(node, self.pictures.of_pixels(image.name + " metal", made))

    @staticmethod
    def _channel(value):
        """Returns the image's node and the channel that a number is."""
        if value.node.type in ('SEPRGB', 'SEPARATE_COLOR'):
            return value.node.inputs[0].source.node, value.index
        return value.node, 0

    def _write_base(self):
        colour, alpha = self.p['Base Color'], self.p['Alpha']
        are_apart = is_output(alpha) and not (is_output(colour) and known.tinted(colour)[0] is alpha.node)
        if all(known.is_known(n, v, self.pictures) if is_output(v) else not isinstance(v, np.ndarray)
               for n, v in (('Base Color', colour), ('Alpha', alpha))) and not are_apart:
            factor = (1, 1, 1)
            if not is_output(colour):
                factor = values.triple(colour)
            elif colour.node.type == 'VERTEX_COLOR':
                self.made["colours"] = colour.node.layer_name
            else:
                node, factor = known.tinted(colour)
                self.pbr["baseColorTexture"] = self._colours(node)
            self._set_base(factor, 1 if is_output(alpha) else alpha, is_output(alpha))
            return
        pixels, alphas = self._pixels('Base Color'), self._pixels('Alpha')
        if pixels.ndim == 1 and alphas.ndim == 1:
            self._set_base(pixels, alphas[0], False)
            return
        is_opaque = alphas.ndim == 1 and alphas[0] >= 1
        self.pbr["baseColorTexture"] = self._image(_as_image(pixels) if is_opaque else _packed(pixels, alphas), 'colour', True)
        self._set_base((1, 1, 1), 1, not is_opaque)

    def _set_base(self, colour, alpha, is_clear):
        self.pbr["baseColorFactor"] = [float(min(max(c, 0), 1)) for c in (*colour, alpha)]
        if is_clear or alpha < 1:
            self.made["alphaMode"] = "BLEND"

    def _write_radiance(self):
        value = self.p['Radiance']
        if is_output(value) and known.is_known('Radiance', value, self.pictures):
            node, factor = known.tinted(value)
            _emit(self.made, factor, self._colours(node))
            return
        pixels = self._pixels('Radiance')
        most = float(pixels.max())
        if pixels.ndim == 1:
            _emit(self.made, pixels)
        elif most > 0:
            _emit(self.made, (most,) * 3, self._image(pixels / most, 'emission', True))

    def _divide_base(self):
        """Divides the diffuse base as KHR_materials_diffuse_transmission does: the colour that light has on the other side is
        one, or that of the base times one."""
        if self.p['Through'] == (0, 0, 0):
            return
        base, through = self._pixels('Base Color'), self._pixels('Through')
        most = float(through.max())
        share = most / max(most + float(base.max()), 1e-6)
        colour, is_image = through / max(share, 1e-6), through.ndim == 3
        if is_image and not base.any():
            base, colour, share = through, np.ones(3), 1
        elif is_image:
            _, base, fitted = (_resized(_as_image(p, through.shape[:2]), through.shape[:2]) for p in (base, base, through))
            ratio = (fitted * base).sum((0, 1)) / np.maximum((base * base).sum((0, 1)), 1e-9)
            if abs(fitted - ratio * base).mean() > 0.1 * fitted.mean():
                self.note("translucent in the colours of their front")
            base, colour = base / (1 - share), ratio * (1 - share) / share
        else:
            base = base / (1 - share) if share < 1 else base
        self.p['Base Color'] = base if base.ndim == 3 else tuple(float(v) for v in base)
        self.through = {"diffuseTransmissionFactor": float(share), "diffuseTransmissionColorFactor": [float(min(c, 1)) for c in colour]}
        self.is_through_image = is_image

    def _write_normal(self):
        value = self.p.get('Normal')
        if value is None:
            return
        if known.is_known_normal(value, self.pictures):
            strength, node = value.node.inputs['Strength'].default_value, value.node.inputs['Color'].source.node
            pixels = self.pictures.numbers_of(node.image)
            self._note_leaning(pixels, strength)
            is_weak = 0 < strength < 1
            picture = self.pictures.data(node.image)
            if is_weak:
                picture = self.pictures.of_pixels(node.image.name, normals.weakened(pixels, strength))
            self.made["normalTexture"] = self._texture(node, picture, 1 if is_weak else strength)
            return
        pixels = self._over_mesh(value, self.surface.kind)
        self._note_leaning(pixels)
        self.made["normalTexture"] = Texture(self.pictures.of_pixels(self.surface.name + " normal", pixels), "lull")

    def _note_leaning(self, pixels, strength=1):
        is_diffuse = all(is_output(self.p[n]) or self.p[n] < 1 for n in ('Metallic', 'Transmission'))
        step = max(1, len(pixels) // 512)
        # Cycles bends reflections that bumps would send below the surface.
        if normals.dimmed(pixels[::step, ::step], strength) > (normals.MOST if is_diffuse else normals.MOST / 8):
            self.note("brighter where light falls flat, as normals lean far" if is_diffuse else
                      "reflecting in other directions where normals lean")

    # Values

    def _pixels(self, name):
        """Returns three numbers, or an image of them, of a parameter."""
        value = self.p[name]
        if isinstance(value, np.ndarray):
            return value
        if not is_output(value):
            return np.array(values.triple(value), np.float32)
        value = self.surface.number_of(name, value)
        if values.is_by_view(value):
            self.note("the same from all sides and for all rays")
        place = values.place_of(value)
        if place in ('all', 'object'):
            return self.baker.plain(self.surface.material, value, self.over[1] if place == 'object' else None)
        if self.over is None:
            sizes = [max(n.image.size) for n in upstream(value) if n.type == 'TEX_IMAGE' and n.image]
            names = [n for n in self.surface.layers if n]
            return self.baker.over_uvs(self.surface.material, value, names, min(4096, max(sizes, default=0)))
        return self._over_mesh(value)

    def _over_mesh(self, value, kind='EMIT'):
        mesh, shown, slots = self.over
        pixels = self.baker.over_mesh(self.surface.material, value, mesh, shown, slots, kind)
        if abs(np.diff(pixels, axis=1)).mean() > _FINE and self.baker.is_coarse(mesh):
            self.note(f"blurred, by images of {self.baker.size} pixels over whole meshes (Texture Size)")
        return pixels

    def _even(self, name):
        found = self._pixels(name).reshape(-1, 3)[:, 0]
        if np.ptp(found) > _UNEVEN and not (self.varies and name in ('Transmission', 'Specular')):
            self.note(f"of the same {name.lower()} everywhere")
        return float(found.mean())

    def _image(self, pixels, what, is_colour):
        """Returns a texture of baked pixels, on the UVs that they were baked for."""
        if is_colour:
            pixels = np.concatenate([images.encoded(np.clip(pixels[:, :, :3], 0, 1)), pixels[:, :, 3:]], 2)
        name = "lull" if self.over is not None else next(iter(self.surface.layers), "")
        # Filtered, a root would have the colour of tips.
        return Texture(self.pictures.of_pixels(f"{self.surface.name} {what}", pixels), name, _CLAMP if name == STRANDS else _REPEAT)

    def _colours(self, node):
        """Returns the texture of an image of colours."""
        return self._texture(node, self.pictures.colour(node, node.origin.outputs['Alpha'].is_linked, self.surface.name))

    def _texture(self, node, picture, scale=1):
        source, moves = node.inputs['Vector'].source, None
        if source is not None and source.node.type == 'MAPPING':
            moves, source = known.moved(source.node), source.node.inputs['Vector'].source
        uv = source.node.uv_map if source is not None and source.node.type == 'UVMAP' else ""
        return Texture(picture, uv, _REPEAT if node.extension == 'REPEAT' else _CLAMP, moves, scale)


def _as_image(pixels, shape=None):
    return pixels if pixels.ndim == 3 else np.broadcast_to(pixels, (*(shape or (4, 4)), 3)).copy()


def _packed(*parts):
    """Puts the first three numbers of the first part, or its first, and the first of the others into the channels of an image."""
    shape = max((p.shape[:2] for p in parts if p.ndim == 3), default=(4, 4))
    planes = [_resized(_as_image(p, shape), shape) for p in parts]
    return np.concatenate([planes[0], planes[1][:, :, :1]] if len(parts) == 2 else [p[:, :, :1] for p in planes], 2)


def _resized(image, shape):
    rows = np.arange(shape[0]) * image.shape[0] // shape[0]
    columns = np.arange(shape[1]) * image.shape[1] // shape[1]
    return image[rows][:, columns]
