"""Receives images of `lull render --display`, in the protocol of tev."""
import struct

import numpy as np

_UPDATE = 6  # of the kinds of messages; the others change no pixels


def _text(message, at):
    end = message.index(b"\0", at)
    return message[at:end].decode(), end + 1


def _decode(message):
    """Returns x, y (from the upper left) and the channels by name of an update; None for other messages."""
    if message[4] != _UPDATE:
        return None
    _, at = _text(message, 6)
    count, = struct.unpack_from("<i", message, at)
    at += 4
    names = []
    for _ in range(count):
        name, at = _text(message, at)
        names.append(name)
    x, y, width, height = struct.unpack_from("<4i", message, at)
    # The skipped bytes are the positions of channels; lull's pixels have adjacent channels.
    values = np.frombuffer(message, "<f4", width * height * count, at + 16 + 16 * count)
    values = values.reshape(height, width, count)
    return x, y, {name: values[:, :, i] for i, name in enumerate(names)}


class Stream:
    """Reassembles the messages of a connection."""

    def __init__(self):
        self.bytes = bytearray()

    def feed(self, data):
        """Appends bytes, and yields completed updates."""
        self.bytes += data
        while len(self.bytes) >= 5:
            size, = struct.unpack_from("<I", self.bytes)
            if len(self.bytes) < size:
                return
            message = bytes(self.bytes[:size])
            del self.bytes[:size]
            if update := _decode(message):
                yield update
