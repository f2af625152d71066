"""Runs lull as a process, with its messages and images as events. Images come in the protocol of tev (`--display`)."""
import ctypes
import json
import os
import selectors
import signal
import socket
import struct
import subprocess
import sys

import numpy as np


class Failure(Exception):
    """An error to show to the user."""


_UPDATE = 6  # of the kinds of messages; the others change no pixels
_LIBC = ctypes.CDLL(None) if sys.platform == "linux" else None


def _start(command, **more):
    """Starts a process in a group of its own, so that Ctrl-C in Blender's terminal reaches it once, through us; it ends with Blender."""
    return subprocess.Popen(command, stdin=subprocess.DEVNULL, start_new_session=True,
                            preexec_fn=_LIBC and (lambda: _LIBC.prctl(1, signal.SIGKILL)), **more)  # PR_SET_PDEATHSIG


def ended(code):
    """Returns how a process of this exit code ended."""
    return f"ended by signal {-code}" + (", as if memory did not suffice" if code == -signal.SIGKILL else "") if code < 0 else \
        f"ended with exit code {code}"


def run(command, stopped, heard):
    """Runs a command, and calls `heard` with its output. Returns its exit code, its output, and whether `stopped` returned true."""
    with _start(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace") as process:
        with selectors.DefaultSelector() as selector:
            selector.register(process.stdout, selectors.EVENT_READ)
            said = ""
            while True:
                if stopped():
                    process.kill()
                    return 0, said, True
                if selector.select(0.1):
                    line = os.read(process.stdout.fileno(), 1 << 16)
                    if not line:
                        break
                    said += line.decode(errors="replace")
                    heard(said)
        return process.wait(), said, False


class Render:
    """A render of lull.

    `for kind, data in render.events(stopped)` yields ("progress", {...}), ("step", {...}), ("warning", text),
    ("note", text), ("show", (x, y, channels)) and ("idle", None) until the program ends; `code` is then its exit code.
    If `stopped` returns true, the program ends with the current image.
    """

    def __init__(self, command):
        self.server = socket.create_server(("127.0.0.1", 0))
        address = "127.0.0.1:%d" % self.server.getsockname()[1]
        self.process = _start(command + ["--json-progress", "--display", address], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.code, self.said, self.errors = None, b"", []

    def events(self, stopped):
        stream, told = Stream(), False
        try:
            with selectors.DefaultSelector() as selector:
                selector.register(self.process.stderr, selectors.EVENT_READ)
                selector.register(self.server, selectors.EVENT_READ)
                while self.code is None:
                    if not told and stopped():
                        self.process.send_signal(signal.SIGINT)
                        told = True
                    ready = [key.fileobj for key, _ in selector.select(0.1)]
                    if not ready:
                        yield "idle", None
                    for source in ready:
                        if source is self.server:
                            selector.register(self.server.accept()[0], selectors.EVENT_READ)
                        elif source is self.process.stderr:
                            yield from self._heard(os.read(source.fileno(), 1 << 16))
                        elif data := _receive(source):
                            yield from (("show", update) for update in stream.feed(data))
                        else:
                            selector.unregister(source)
                            source.close()
                for key in list(selector.get_map().values()):
                    if key.fileobj not in (self.server, self.process.stderr):
                        key.fileobj.close()
        finally:
            self.server.close()
            if self.code is None:
                self.process.kill()
                self.process.wait()
            self.process.stderr.close()

    def _heard(self, data):
        if not data:
            self.code = self.process.wait()
        *lines, self.said = (self.said + data).split(b"\n")
        for line in lines:
            try:
                event = json.loads(line)
                kind = event["event"]
            except (ValueError, TypeError, KeyError):  # of the command line, before it knows JSON
                kind, event = "error", {"message": line.decode(errors="replace")}
            if kind == "error":
                self.errors.append(event["message"])
            elif kind in ("warning", "note"):
                yield kind, event["message"].removeprefix("warning: ")
            elif kind in ("progress", "step"):
                yield kind, event


def _receive(connection):
    try:
        return connection.recv(1 << 20)
    except ConnectionError:
        return b""


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
