#!/usr/bin/env python3
"""Writes the types of the functions that run commands, from the help of the program.

stubs.py LULL FILE: reads `LULL COMMAND --help-all` and writes FILE, commands.pyi of the module `lull`.
"""
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent / "lull"))
sys.dont_write_bytecode = True
import options  # noqa: E402

HEAD = '''"""Written by stubs.py."""
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, Literal

import numpy as np

Path = str | PathLike[str]
Value = Path | float
Progress = Callable[[Mapping[str, Any]], None] | Literal[False] | None


class Rendering:
    image: np.ndarray
    spp: np.ndarray
    noisy: np.ndarray | None
    layers: dict[str, np.ndarray]
    blocks: list[dict[str, Any]]
    seconds: float
    interrupted: bool
    report: dict[str, Any]


class Comparison:
    images: dict[str, np.ndarray]
    figures: dict[str, Any]
'''
FUNCTIONS = {"render": ("scene: Path, *, progress: Progress = None", "Rendering"),
             "compare": ("scene: Path | None = None, *, progress: Progress = None", "Comparison"),
             "evaluate": ("*recordings: Path | Sequence[Path]", "list[dict[str, Any]]"),
             "entropy": ("*images: Path | Sequence[Path]", "list[dict[str, Any]]")}


def type_of(option):
    """Returns the Python type of an option."""
    if option.value is None:
        return "bool"
    name = option.value.partition(":")[0].partition("=")[0]
    if re.fullmatch(r"[a-z0-9-]+(\|[a-z0-9-]+)+", name):
        return "Literal[%s]" % ", ".join(word if word.isdigit() else f'"{word}"' for word in name.split("|"))
    if name == "WxH":
        return "tuple[int, int] | str"
    if "," in name or "given again" in option.text:
        return "Value | Sequence[Value]"
    return "int" if ":INT" in option.value else "float" if ":FLOAT" in option.value else "Value"


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    text = HEAD
    for command, (inputs, result) in FUNCTIONS.items():
        helped = subprocess.run([sys.argv[1], command, "--help-all"], check=True, text=True,
                                stdout=subprocess.PIPE).stdout
        lines = [f"    {name}: {type_of(option)} | None = None,"
                 for name, option in options.read(helped).items()]
        text += "\n\ndef %s(\n    %s,\n%s\n) -> %s: ...\n" % (command, inputs, "\n".join(lines), result)
    pathlib.Path(sys.argv[2]).write_text(text)


if __name__ == "__main__":
    main()
