"""Corrects files that Blender's glTF exporter has written, .gltf or .glb, where the exporter has no option."""
import json
import math
import struct

import numpy as np

import motion

_MAGIC, _JSON = b"glTF", 0x4E4F534A
_MOST_GROUPS = 16  # that lull renders


def mend_exporter():
    """Lets Blender's exporter write the colours of corners: that of 3.4 looks them up by the number of the vertex."""
    import io_scene_gltf2.blender.exp.gltf2_blender_gather_primitives_extract as extract
    name = "_PrimitiveCreator__get_color_attribute"
    theirs = getattr(getattr(extract, "PrimitiveCreator", None), name, None)
    if theirs is None:
        return

    def of_corners(creator, attribute):
        if attribute["blender_domain"] != 'CORNER':
            theirs(creator, attribute)
            return
        layers = creator.blender_mesh.color_attributes
        colours = np.empty(4 * len(creator.blender_mesh.loops), np.float32)
        layers[layers.render_color_index].data.foreach_get("color", colours)
        for i, channel in enumerate(colours.reshape(-1, 4).T):
            creator.dots[attribute["gltf_attribute_name"] + str(i)] = channel

    setattr(extract.PrimitiveCreator, name, of_corners)


def _read(path):
    """Returns the JSON of a file, and the bytes that follow it in a .glb."""
    with open(path, "rb") as f:
        data = f.read()
    if data[:4] != _MAGIC:
        return json.loads(data), None
    size, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + size]), data[20 + size:]


def _write(path, root, rest):
    text = json.dumps(root).encode()
    if rest is not None:
        text += b" " * (-len(text) % 4)
        text = _MAGIC + struct.pack("<4I", 2, 20 + len(text) + len(rest), len(text), _JSON) + text + rest
    with open(path, "wb") as f:
        f.write(text)


def _let_through(material):
    """Makes the surface of a lamp a pane of air that shines: in Cycles nothing is shadowed by a lamp."""
    material["pbrMetallicRoughness"] = {"metallicFactor": 0, "roughnessFactor": 0}
    _make_air(material)


def _make_air(material):
    """Makes a surface a sheet that reflects nothing, and lets through its base colour."""
    extensions = material.setdefault("extensions", {})
    extensions["KHR_materials_specular"] = {"specularFactor": 0}
    extensions["KHR_materials_transmission"] = {"transmissionFactor": 1}
    extensions["KHR_materials_ior"] = {"ior": 1}
    material["extras"]["lull_thin"] = 1


def _add_shine(extensions, share, *colour):
    """Adds an interface that reflects a share in a colour, white at grazing angles."""
    extensions.pop("KHR_materials_ior", None)  # with the usual one, normal incidence has 0.04
    extensions["KHR_materials_specular"] = {"specularFactor": share, "specularColorFactor": [c / 0.04 for c in colour]}


def _brighten(pbr, more):
    if "baseColorTexture" in pbr:
        return
    *colour, alpha = pbr.get("baseColorFactor", [1, 1, 1, 1])
    pbr["baseColorFactor"] = [*(min(max(0, c + more), 1) for c in colour), alpha]


def _scatter_through(material, share, red, green, blue, is_image):
    made = {"diffuseTransmissionFactor": share, "diffuseTransmissionColorFactor": [red, green, blue]}
    base = material.get("pbrMetallicRoughness", {}).get("baseColorTexture")
    if is_image and base:
        made["diffuseTransmissionColorTexture"] = dict(base)
    material.setdefault("extensions", {})["KHR_materials_diffuse_transmission"] = made


def _own_flags(extras):
    """Takes marks, numbers as Blender has no others, out of `extras`. Returns lull's own properties of materials and nodes."""
    marks = {"lull_adds": "addedInterface", "lull_open": "openBehind", "lull_sided": "openBehind",
             "lull_hidden": "hiddenFromCamera", "lull_shadowless": "castsNoShadow"}
    return {name: True for mark, name in marks.items() if extras.pop(mark, None)}


def _patch_material(material):
    extras, extensions = material.get("extras", {}), material.get("extensions", {})
    material["name"] = extras.pop("lull_name", material.get("name", ""))
    if extras.get("lull_open"):
        _let_through(material)
    if extras.pop("lull_air", None):
        _make_air(material)
    if brightens := extras.pop("lull_brightens", None):
        _brighten(material["pbrMetallicRoughness"], brightens)
    if through := extras.pop("lull_through", None):
        _scatter_through(material, *through)
    if shine := extras.pop("lull_shine", None):
        extras["lull_adds"] = 1
    # Without this, glass would be a thin sheet; Blender's is solid.
    if "KHR_materials_transmission" in extensions and not extras.pop("lull_thin", None):
        extensions.setdefault("KHR_materials_volume", {"thicknessFactor": 1})
    own = _own_flags(extras)
    if spread := extras.pop("lull_spread", None):
        own["spread"] = spread
    if own:
        extras["lull"] = own
    absorbs = extras.pop("lull_absorbs", None)
    if absorbs and max(absorbs) > 0 and "KHR_materials_volume" in extensions:
        distance = 1 / max(absorbs)
        extensions["KHR_materials_volume"].update(
            attenuationDistance=distance, attenuationColor=[math.exp(-a * distance) for a in absorbs])
    # Without this, surfaces without specular reflection would reflect at grazing angles.
    specular = extensions.get("KHR_materials_specular", {})
    if specular.get("specularColorFactor") == [0, 0, 0]:
        specular["specularFactor"] = 0
    if shine:
        _add_shine(material.setdefault("extensions", {}), *shine)


def _textures(part):
    """Yields the references to textures of a material or a part of it."""
    for key, value in part.items():
        if key.endswith("Texture"):
            yield value
        elif isinstance(value, dict):
            yield from _textures(value)


def _renumber_uvs(root, notes):
    """Gives the primitives the two sets of UVs that their materials use: lull reads TEXCOORD_0 and 1 alone."""
    kept = {}
    for number, material in enumerate(root.get("materials", [])):
        textures = list(_textures(material))
        sets = sorted({t.get("texCoord", 0) for t in textures})
        if not sets or sets[-1] < 2:
            continue
        if len(sets) > 2:
            notes.add("without the third of its sets of UVs", material["name"], "materials")
        kept[number] = sets[:2]
        for texture in textures:
            texture["texCoord"] = min(sets.index(texture.get("texCoord", 0)), 1)
    for primitive in (p for mesh in root.get("meshes", []) for p in mesh["primitives"]):
        if sets := kept.get(primitive.get("material")):
            attributes = primitive["attributes"]
            uvs = [attributes.get(f"TEXCOORD_{s}") for s in sets]
            primitive["attributes"] = {n: a for n, a in attributes.items() if not n.startswith("TEXCOORD_")} | {
                f"TEXCOORD_{i}": accessor for i, accessor in enumerate(uvs) if accessor is not None}


def _shines(root, node):
    if "KHR_lights_punctual" in node.get("extensions", {}):
        return True
    parts = root["meshes"][node["mesh"]]["primitives"] if "mesh" in node else ()
    materials = [root["materials"][p["material"]] for p in parts if "material" in p]
    return any(max(m.get("emissiveFactor", [0])) > 0 for m in materials)


def _patch_nodes(root, groups, notes):
    """Gives nodes the meshes that they share with others, and the names of Blender's objects, or that of their light group.

    Returns: the names of groups that shine.
    """
    found = {}
    meshes = {node["name"]: node["mesh"] for node in root.get("nodes", []) if "mesh" in node}
    for node in root.get("nodes", []):
        extras = node.get("extras", {})
        if mesh := extras.pop("lull_mesh", None):
            node["mesh"] = meshes[mesh]
        if own := _own_flags(extras):
            extras["lull"] = own
        node["name"] = extras.pop("lull_source", node.get("name", ""))
        group = extras.pop("lull_group", None)
        if group not in groups or not _shines(root, node):
            continue
        if group not in found and len(found) == _MOST_GROUPS:
            notes.add(f"black in its pass, as one of more than {_MOST_GROUPS}", group, "light groups")
        else:
            node["name"] = found.setdefault(group, f"light group {len(found)}")
    return found


def patch(path, groups, shutter, notes):
    """Corrects a file; `groups`: the names of the view layer's light groups; `shutter`: the time that it is open, seconds.

    Returns: the names that `lull render --light-groups` takes for those that shine, and whether anything is blurred by its motion.
    """
    root, rest = _read(path)
    for material in root.get("materials", []):
        _patch_material(material)
    _renumber_uvs(root, notes)
    used = {name for m in root.get("materials", []) for name in m.get("extensions", {})}
    if used:
        root["extensionsUsed"] = sorted({*root.get("extensionsUsed", []), *used})
    found = _patch_nodes(root, groups, notes)
    is_blurred = motion.animate(root, shutter, notes, lambda node: _shines(root, node))
    _write(path, root, rest)
    return found, is_blurred
