"""Runs the program lull."""
import functools
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import warnings

from . import options as _options

_INTERRUPTED = 130


class Error(RuntimeError):
    """An input or environment error, with the message of the program."""


def find():
    """Returns the path of the program: $LULL_PROGRAM, that of this installation, or that on the PATH.

    Raises: FileNotFoundError.
    """
    prefix = pathlib.Path(__file__).resolve().parents[4]
    for path in (os.environ.get("LULL_PROGRAM"), prefix / "bin" / "lull", prefix / "renderer" / "lull",
                 "lull"):
        if path and (found := shutil.which(path)):
            return found
    raise FileNotFoundError("lull is not on the PATH; set LULL_PROGRAM to the program")


@functools.lru_cache
def _help(program, command):
    return subprocess.run([program, command, "--help-all"], check=True, text=True,
                          stdout=subprocess.PIPE).stdout


def options(command):
    """Returns the options of a command by their keywords."""
    return _options.read(_help(find(), command))


def run(command, inputs, given, progress=None):
    """Runs a command. A KeyboardInterrupt ends it with its current results, a second one at once.

    Args:
        command: its name.
        inputs: paths of input files.
        given: options by keyword.
        progress: called with each event; None: a line in a terminal or a notebook; False: nothing.

    Returns: the last event, or {}.
    Raises: TypeError for unknown options, ValueError for invalid values, Error otherwise.
    """
    known = options(command)
    words = [find(), command, *map(_file, inputs), *_options.arguments(command, known, given)]
    if "--json-progress" in _help(find(), command):
        words.append("--json-progress")
    show = _Line() if progress is None else progress or (lambda event: None)
    # In a group of its own, so that Ctrl-C reaches it once, through us.
    with subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, text=True,
                          stderr=subprocess.PIPE, start_new_session=True) as process:
        said, last, told = [], {}, False
        try:
            while True:
                try:
                    line = process.stderr.readline()
                    if not line:
                        break
                    event = _event(line)
                    if event["event"] == "warning":
                        warnings.warn(event["message"].removeprefix("warning: "), stacklevel=3)
                    elif event["event"] == "error":
                        said.append(event["message"])
                    last = event
                    show(event)
                except KeyboardInterrupt:
                    if told:
                        raise
                    process.send_signal(signal.SIGINT)
                    told = True
            code = process.wait()
        except BaseException:
            process.kill()
            raise
        finally:
            if isinstance(show, _Line):
                show.end()
    if code not in (0, _INTERRUPTED):
        message = "\n".join(said) or "%s ended with exit code %d" % (command, code)
        raise ValueError(message) if code == 2 else Error(message)
    return last


def _file(path):
    """Returns the path of a file as an argument that cannot be an option."""
    path = os.fspath(path)
    return os.path.join(os.curdir, path) if path.startswith("-") else path


def _event(line):
    try:
        event = json.loads(line)
        if "event" in event:
            return event
    except (ValueError, TypeError):
        pass
    return {"event": "error", "message": line.strip().removeprefix("lull: error: ")}


class _Line:
    """Shows progress in one line, rewritten in place."""

    def __init__(self):
        self.shows = sys.stderr.isatty() or "ipykernel" in sys.modules
        self.width = 0

    def __call__(self, event):
        if not self.shows or event["event"] != "progress":
            return
        text = "%3.0f %%, %d of %d blocks clean, %d spp" % (
            event["percent"], event["cleanBlocks"], event["blocks"], event["medianSpp"])
        if event["remainingRange"]:
            text += ", done in %.0f to %.0f s (80 %%)" % tuple(event["remainingRange"])
        elif event["remainingSeconds"] is not None:
            text += ", %.0f s left" % event["remainingSeconds"]
        sys.stderr.write("\r" + text.ljust(self.width))
        sys.stderr.flush()
        self.width = len(text)

    def end(self):
        if self.width:
            sys.stderr.write("\n")
