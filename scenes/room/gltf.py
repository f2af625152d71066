"""The room as glTF: its materials, lights and camera, by day and by night.

Materials are those of materials.pbrt. A mix of two colours by an image becomes an image, by a procedural texture the
mean colour. Translucent cloth and leaves become rough thin sheets, and the sky becomes two panels of light,
behind the hedge and above it, between which the sun shines in.
"""
import math
import re
import struct
import zlib

from glb_scene import GlbScene
from images import png

LUMENS = 683  # per watt, which lull divides by
SOLAR = (17, 13.8, 9.8)
BLIND = (5.5, 6, 6.8)


def read_materials(text):
    """Returns mean colours, images and mixes by texture, and the parameters of each material."""
    def values(body, kind, name):
        found = re.search(rf'"{kind} {name}"\s+(?:\[ ([^\]]*) \]|"([^"]*)"|(\S+))', body)
        return found and next(v for v in found.groups() if v is not None)

    def rgb(text):
        return [float(v) for v in text.split()]

    entries = re.findall(r'^(Texture|MakeNamedMaterial) "(\w+)"((?:.*\n(?![TM#\n]))*.*)', text, re.M)
    colours, images, mixes, materials = {}, {}, {}, {}
    for kind, name, body in entries:
        if kind == 'Texture' and values(body, 'string', 'filename') and 'planar' not in body:
            number = lambda key, least: float(values(body, 'float', key) or least)
            images[name] = (values(body, 'string', 'filename'), (number('uscale', 1), number('vscale', 1)),
                            number('udelta', 0))
        elif kind == 'Texture' and values(body, 'rgb', 'tex1'):
            pair = [rgb(values(body, 'rgb', end)) for end in ('tex1', 'tex2')]
            colours[name] = [(a + b) / 2 for a, b in zip(*pair)]
            if values(body, 'texture', 'amount') in images:
                mixes[name] = (*pair, values(body, 'texture', 'amount'))
        elif kind == 'MakeNamedMaterial':
            materials[name] = {'type': values(body, 'string', 'type'), 'texture': values(body, 'texture', 'Kd'),
                               'rough': float(values(body, 'float', '[uv]?roughness') or 0)}
            for key in ('Kd', 'transmit', 'reflect', 'eta', 'k'):
                if values(body, 'rgb', key):
                    materials[name][key] = rgb(values(body, 'rgb', key))
    return colours, images, mixes, materials


def grey_image(data):
    """Returns width, height and values in [0, 1] of a PNG as png() writes it: 8 bits, one channel, no filters."""
    width, height = struct.unpack('>II', data[16:24])
    packed = b''.join(data[m.end():m.end() + struct.unpack('>I', data[m.start() - 4:m.start()])[0]]
                      for m in re.finditer(b'IDAT', data))
    rows = zlib.decompress(packed)
    return width, height, [v / 255 for y in range(height) for v in rows[y * (width + 1) + 1:(y + 1) * (width + 1)]]


def encoded(value):
    """Returns a linear value as sRGB has it."""
    return 12.92 * value if value <= .0031308 else 1.055 * value ** (1 / 2.4) - .055


def roughness(value):
    """Returns glTF's roughness for pbrt's, which is remapped to alpha."""
    x = math.log(max(value, 1e-3))
    return math.sqrt(min(1, 1.62142 + .819955 * x + .1734 * x ** 2 + .0171201 * x ** 3 + .000640711 * x ** 4))


class Materials:
    def __init__(self, folder):
        self.folder, self.textures = folder, {}
        self.colours, self.images, self.mixes, self.materials = read_materials((folder / 'materials.pbrt').read_text())

    def __call__(self, glb, name):
        m = self.materials[name]
        colour = m.get('Kd') or self.colours.get(m['texture'], [1, 1, 1])
        matte = {'KHR_materials_specular': {'specularFactor': 0}}
        if m['type'] == 'glass':
            return glb.material(name, (1, 1, 1), 0, 0, {'KHR_materials_transmission': {'transmissionFactor': 1},
                                                        'KHR_materials_volume': {'thicknessFactor': .004}})
        if m['type'] == 'metal':
            f0 = [((e - 1) ** 2 + k * k) / ((e + 1) ** 2 + k * k) for e, k in zip(m['eta'], m['k'])]
            return glb.material(name, f0, 1, roughness(m['rough']), doubleSided=True)
        if m['type'] == 'translucent':
            total = [r + t for r, t in zip(m['reflect'], m['transmit'])]
            through = sum(m['transmit']) / sum(total)
            return glb.material(name, [c * t for c, t in zip(colour, total)], 0, 1,
                                {**matte, 'KHR_materials_transmission': {'transmissionFactor': round(through, 4)}},
                                doubleSided=True)
        pbr = {}
        if m['texture'] in self.images or m['texture'] in self.mixes:
            pbr['baseColorTexture'], colour = self.texture(glb, m['texture']), (1, 1, 1)
        is_matte = m['type'] == 'matte'
        return glb.material(name, colour, 0, 1 if is_matte else roughness(m['rough']), matte if is_matte else None,
                            doubleSided=True, pbr=pbr)


    def texture(self, glb, name):
        """Returns the use of an image, or of a mix of two colours by one."""
        *pair, amount = self.mixes.get(name, (name,))
        file, (u, v), shift = self.images[amount]
        picture = (self.folder / file).read_bytes()
        if pair:
            width, height, values = grey_image(picture)
            picture = png(width, height, lambda x, y: [
                encoded(a + (b - a) * values[y * width + x]) for a, b in zip(*pair)])
        if (file, name if pair else '') not in self.textures:
            self.textures[file, name if pair else ''] = glb.texture(picture)
        use = {'index': self.textures[file, name if pair else '']}
        if (u, v, shift) != (1, 1, 0):
            use['extensions'] = {'KHR_texture_transform': {'offset': [shift, 1 - v], 'scale': [u, v]}}
            if 'KHR_texture_transform' not in glb.root['extensionsUsed']:
                glb.root['extensionsUsed'].append('KHR_texture_transform')
        return use


def panel(glb, name, corners, radiance):
    """Adds a quad that emits to both sides; corners in pbrt's axes."""
    strength = max(radiance)
    material = glb.material(name, (0, 0, 0), 0, 1,
                            {'KHR_materials_emissive_strength': {'emissiveStrength': strength},
                             'KHR_materials_specular': {'specularFactor': 0}},
                            emissiveFactor=[c / strength for c in radiance], doubleSided=True)
    glb.materials[name] = material
    glb.shape(name, (corners, [(0, 1, 2), (0, 2, 3)], [(0, 0)] * 4))


def light(glb, **entry):
    if 'extensions' not in glb.root:
        glb.root['extensionsUsed'].append('KHR_lights_punctual')
        glb.root['extensions'] = {'KHR_lights_punctual': {'lights': []}}
    lights = glb.root['extensions']['KHR_lights_punctual']['lights']
    lights.append(entry)
    return {'KHR_lights_punctual': {'light': len(lights) - 1}}


def bulb(glb, at, radius, radiance):
    """Adds a sphere of light; `radiance` becomes an intensity in candela."""
    strength = max(radiance)
    x, y, z = at
    glb.node(translation=[x, y, -z], extensions=light(
        glb, type='point', intensity=round(LUMENS * math.pi * radius ** 2 * strength, 3),
        color=[round(c / strength, 4) for c in radiance], extras={'lull': {'radius': radius}}))


def write_rooms(parts, folder, target):
    """Writes room.glb and room-night.glb."""
    for name in ('room', 'room-night'):
        glb = GlbScene(Materials(folder))
        for part in parts:
            part(glb)
        by_day = name == 'room'
        bright, dim = ((11, 12.4, 13.6), (7, 9, 12)) if by_day else ((.55, .62, 1.0), (.3, .4, .8))
        panel(glb, 'horizon', [(-16, -.5, -14), (-16, -.5, 26), (-16, 8, 26), (-16, 8, -14)], bright)
        panel(glb, 'zenith', [(-16, 14, -14), (-16, 14, 26), (-3, 14, 26), (-3, 14, -14)], dim)
        if by_day:
            panel(glb, 'blind', [(-1, .1, -1.89), (1.7, .1, -1.89), (1.7, 2.4, -1.89), (-1, 2.4, -1.89)], BLIND)
            glb.look((-.68, .5, .38), (0, 0, 0), extensions=light(
                glb, type='directional', intensity=LUMENS * SOLAR[0], color=[round(c / SOLAR[0], 4) for c in SOLAR]))
        else:
            bulb(glb, (.20, 1.50, 4.42), .035, (2200, 1460, 730))
            bulb(glb, (-.60, 2.02, 2.75), .085, (13, 8.6, 4.4))
        camera = glb.add('cameras', type='perspective', name='view', perspective={
            'yfov': 2 * math.atan(math.tan(math.radians(18))), 'aspectRatio': 16 / 9, 'znear': .01},
            extras={'lull': {'shift': [0, -.05]}})
        glb.look((1.30, 1.30, 1.30), (-.80, 1.30, -4.5), camera=camera)
        glb.write(target / f'{name}.glb')
