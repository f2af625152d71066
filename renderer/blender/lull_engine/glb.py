"""Writes glTF files: .glb, or .gltf with .bin and images beside it."""
import json
import os
import struct
import zlib

import numpy as np

_JSON, _BIN = 0x4E4F534A, 0x004E4942
_TYPES = {np.dtype(np.float32): 5126, np.dtype(np.uint32): 5125, np.dtype(np.uint16): 5123}
_KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class Writer:
    """A file in the making. `root` is its JSON, to whose lists add() appends."""

    def __init__(self):
        self.root = {"asset": {"version": "2.0", "generator": "lull's add-on for Blender"}}
        self._parts, self._size, self._images, self._textures = [], 0, [], {}

    def add(self, kind, value):
        """Appends to a list of the file. Returns the number of the value."""
        values = self.root.setdefault(kind, [])
        values.append(value)
        return len(values) - 1

    def _view(self, data):
        start = self._size
        self._parts += [data, b"\0" * (-len(data) % 4)]
        self._size += len(data) + len(self._parts[-1])
        return self.add("bufferViews", {"buffer": 0, "byteOffset": start, "byteLength": len(data)})

    def array(self, values, is_bounded=False):
        """Adds an array of numbers, or of rows of two to four. Returns the number of the accessor."""
        values = np.ascontiguousarray(values)
        rows = values.reshape(len(values), -1)
        made = {"bufferView": self._view(memoryview(values).cast("B")), "componentType": _TYPES[values.dtype], "count": len(rows),
                "type": _KINDS[rows.shape[1]]}
        if is_bounded:
            made.update(min=[float(v) for v in rows.min(0)], max=[float(v) for v in rows.max(0)])
        return self.add("accessors", made)

    def texture(self, picture, wrap):
        """Adds an image (images.Picture) and a sampler. Returns the number of the texture."""
        key = picture, wrap
        if key not in self._textures:
            if picture not in self._images:
                self._images.append(picture)
            self._textures[key] = self.add("textures", {
                "source": self._images.index(picture),
                "sampler": self.add("samplers", {"wrapS": wrap, "wrapT": wrap, "magFilter": 9729, "minFilter": 9987})})
        return self._textures[key]

    def write(self, path):
        base, is_binary = os.path.splitext(path)[0], path.endswith(".glb")
        names = set()
        for picture in self._images:
            data = picture.data.result()
            kind = "image/jpeg" if picture.suffix == ".jpg" else "image/png"
            if is_binary:
                self.add("images", {"bufferView": self._view(data), "mimeType": kind, "name": picture.name})
                continue
            name = stem = os.path.basename(base) + "." + "".join(c if c.isalnum() or c in "-_" else "_" for c in picture.name)
            while name + picture.suffix in names:
                name = f"{stem}-{len(names)}"
            names.add(name + picture.suffix)
            with open(os.path.join(os.path.dirname(path), name + picture.suffix), "wb") as f:
                f.write(data)
            self.add("images", {"uri": name + picture.suffix, "name": picture.name})
        root = {name: value for name, value in self.root.items() if value}
        if used := sorted(_extensions(root)):
            root["extensionsUsed"] = used
        if self._size:
            root["buffers"] = [{"byteLength": self._size} if is_binary else
                               {"byteLength": self._size, "uri": os.path.basename(base) + ".bin"}]
        text = json.dumps(root).encode()
        if not is_binary:
            with open(path, "wb") as f:
                f.write(text)
            with open(base + ".bin", "wb") as f:
                f.writelines(self._parts)
            return
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as f:
            f.write(b"glTF" + struct.pack("<4I", 2, 28 + len(text) + self._size, len(text), _JSON) + text)
            f.write(struct.pack("<2I", self._size, _BIN))
            f.writelines(self._parts)


def _extensions(value):
    """Returns the names of the extensions that are used."""
    found = set()
    if isinstance(value, dict):
        found |= set(value.get("extensions", {}))
        value = [v for name, v in value.items() if name not in ("bufferViews", "accessors", "extras")]
    for v in value if isinstance(value, list) else ():
        if isinstance(v, (dict, list)):
            found |= _extensions(v)
    return found


def png(pixels, level):
    """Returns a PNG of 8-bit pixels, of one to four channels, the upper row first."""
    height, width, channels = pixels.shape
    rows = np.zeros((height, 1 + width * channels), np.uint8)
    rows[:, 1:] = pixels.reshape(height, -1)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 2: 4, 3: 2, 4: 6}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows.tobytes(), level)) + chunk(b"IEND", b"")
