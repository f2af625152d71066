"""Reads the OpenEXR files that lull writes: scan lines, in one part or several, without compression or with ZIP's. Writes floats without
compression."""
import struct
import zlib

import numpy as np

_MAGIC, _VERSION, _LONG_NAMES, _PARTS = 20000630, 2, 0x400, 0x1000
_ROWS = {0: 1, 2: 1, 3: 16}  # by compression: none, ZIPS, ZIP
_TYPES = {0: np.dtype("<u4"), 1: np.dtype("<f2"), 2: np.dtype("<f4")}


class _Bytes:
    def __init__(self, data):
        self.data, self.at = data, 0

    def take(self, format):
        values = struct.unpack_from("<" + format, self.data, self.at)
        self.at += struct.calcsize("<" + format)
        return values[0] if len(values) == 1 else values

    def text(self):
        end = self.data.index(b"\0", self.at)
        text = self.data[self.at:end].decode()
        self.at = end + 1
        return text


def _header(file):
    attributes = {}
    while name := file.text():
        file.text()  # its type
        size = file.take("i")
        attributes[name] = file.data[file.at:file.at + size]
        file.at += size
    return attributes


def _channels(data):
    file, channels = _Bytes(data), []
    while name := file.text():
        kind, _, x, y = file.take("iIii")
        if (x, y) != (1, 1):
            raise ValueError("has channels of several resolutions")
        channels.append((name, _TYPES[kind]))
    return channels


def _unzip(data, size):
    """Decompresses ZIP data: differences of bytes, the even ones first."""
    if len(data) == size:
        return data
    bytes_ = np.frombuffer(zlib.decompress(data), np.uint8)
    sums = np.cumsum(bytes_, dtype=np.int64) - 128 * np.arange(size)
    whole, half = np.empty(size, np.uint8), (size + 1) // 2
    whole[0::2], whole[1::2] = sums[:half], sums[half:]
    return whole.tobytes()


def _part(file, attributes, first):
    """Reads a part whose table of chunks comes next; each begins `first` bytes before its row."""
    compression = attributes["compression"][0]
    if compression not in _ROWS:
        raise ValueError("is compressed otherwise than by ZIP")
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    channels = _channels(attributes["channels"])
    picture = {name: np.empty((height, width), kind) for name, kind in channels}
    rows = _ROWS[compression]
    row_bytes = width * sum(kind.itemsize for _, kind in channels)
    for _ in range(-(-height // rows)):
        offset = file.take("Q") + first
        y, size = struct.unpack_from("<ii", file.data, offset)
        y, count = y - y0, min(rows, height - (y - y0))
        data = file.data[offset + 8:offset + 8 + size]
        lines = np.frombuffer(_unzip(data, count * row_bytes), np.uint8).reshape(count, row_bytes)
        at = 0
        for name, kind in channels:
            end = at + width * kind.itemsize
            picture[name][y:y + count] = np.ascontiguousarray(lines[:, at:end]).view(kind)
            at = end
    return picture


def read(path):
    """Returns the channels of a file by their names, arrays of height x width with the upper row
    first, and its attributes, as bytes. Of several parts, as of a pair for two eyes, the first has
    these; channels of the others begin with the name of their part ("right.R"). Raises OSError, or
    ValueError for what lull does not write."""
    with open(path, "rb") as f:
        file = _Bytes(f.read())
    try:
        magic, version = file.take("ii")
        if magic != _MAGIC or version & ~(_LONG_NAMES | _PARTS) != _VERSION:
            raise ValueError("is no OpenEXR file of scan lines")
        has_parts = bool(version & _PARTS)
        headers = [_header(file)]
        while has_parts and (more := _header(file)):
            headers.append(more)
        picture = {}
        for attributes in headers:
            prefix = attributes["name"].decode() + "." if picture else ""
            picture.update((prefix + name, plane) for name, plane in _part(file, attributes, 4 * has_parts).items())
    except (struct.error, zlib.error, KeyError, IndexError, ValueError) as e:
        raise ValueError(f"{path}: cannot be read as OpenEXR: {e}") from e
    return picture, headers[0]


def write(path, channels):
    """Writes arrays of height x width, the upper row first, by the names of their channels."""
    names = sorted(channels)
    planes = np.stack([np.asarray(channels[name], "<f4") for name in names], 1)  # of a row, channel by channel
    height, _, width = planes.shape
    box, row = struct.pack("<4i", 0, 0, width - 1, height - 1), planes[0].nbytes
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in names) + b"\0"
    head = struct.pack("<ii", _MAGIC, _VERSION)
    for name, kind, value in (("channels", "chlist", listed), ("compression", "compression", b"\0"), ("dataWindow", "box2i", box),
                              ("displayWindow", "box2i", box), ("lineOrder", "lineOrder", b"\0"),
                              ("pixelAspectRatio", "float", struct.pack("<f", 1)),
                              ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)), ("screenWindowWidth", "float", struct.pack("<f", 1))):
        head += name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    head += b"\0"
    first = len(head) + 8 * height
    with open(path, "wb") as f:
        f.write(head + struct.pack("<%dQ" % height, *(first + y * (8 + row) for y in range(height))))
        for y in range(height):
            f.write(struct.pack("<ii", y, row) + planes[y].tobytes())
