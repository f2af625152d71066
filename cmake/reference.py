#!/usr/bin/env python3
"""Writes the reference of commands, C and Python in Markdown, from the help, headers and docstrings.

reference.py LULL FOLDER: runs `LULL COMMAND --help-all`, reads the sources, and writes reference.md and interfaces.md in
FOLDER, renderer/docs. With --check, fails if one of them differs from that.
"""
import ast
import difflib
import inspect
import pathlib
import re
import sys

import manual

ROOT = pathlib.Path(__file__).resolve().parents[1]
HEADER = "renderer/embedding/include/lull/lull.h"
MODULE = ("renderer/python/lull/commands.py", "renderer/python/lull/program.py", "renderer/python/_lull.pyi")
PUBLIC = {"render", "compare", "evaluate", "entropy", "Rendering", "Comparison", "Error"}  # of the .py files


def cell(text):
    return text.replace("|", "\\|")


def commands(lull):
    """Yields the help of each command. An option is described where the first command has it."""
    top = manual.help_of(lull)
    first = {}  # command of a row
    for command in (c.names[0] for c in top.entries["Subcommands"]):
        page = manual.help_of(lull, command)
        yield f"## lull {command}\n\n{page.about}\n\n    {page.usage.strip()}\n"
        shared = {}  # names by command
        for title, options in page.groups().items():
            rows = ""
            for o in options:
                row = f"| `{cell(', '.join(o.names) + ' ' * bool(o.value) + o.value)}` | {cell(o.text)} |\n"
                if first.setdefault(row, command) == command:
                    rows += row
                elif not {"--help", "--help-all"} & set(o.names):
                    shared.setdefault(first[row], []).append(f"`{o.names[0]}`")
            if rows:
                yield f"| {title} | |\n|---|---|\n{rows}"
        for other, names in shared.items():
            yield f"As in [lull {other}](#lull-{other}): {', '.join(names)}\n"
        if notes := page.notes.partition("\nExit codes: 0 success")[0].rstrip():
            yield f"```\n{notes}\n```\n"


def c_interface(header):
    """Yields each declaration behind its comment; a blank line ends it."""
    text = (ROOT / header).read_text()
    comment = re.compile(r"\s*/\*(.*?)\*/\s*", re.S)
    yield "```\n" + re.sub(r"(?m)^ \* ?", "", comment.match(text)[1]).strip() + "\n```\n"
    for part in re.split(r"\n\s*\n", text.partition('extern "C" {')[2]):
        names = re.findall(r"\b(lull_\w+)(?=\()|^} (lull_\w+);|^typedef struct (lull_\w+) \w+;", part, re.M)
        declared = [n for found in names for n in found if n]
        if "LULL_API " in part or part.startswith(("typedef", "/*")) and declared:
            about, code = "", part
            if begin := comment.match(part):
                about = re.sub(r"\s*\n \* ", " ", begin[1]).strip()
                code = part[begin.end():]
            yield f"#### {', '.join(f'`{n}`' for n in dict.fromkeys(re.findall(r'lull_[a-z_]+', ' '.join(declared))))}\n"
            yield (about + "\n\n" if about else "") + f"```c\n{code.strip()}\n```\n"


def python_interface(file):
    is_stub = file.endswith(".pyi")

    def signature(node):
        return f"{node.name}({ast.unparse(node.args)})" + (f" -> {ast.unparse(node.returns)}" if node.returns else "")

    def text(node):
        return inspect.cleandoc(ast.get_docstring(node) or "")

    for node in ast.parse((ROOT / file).read_text()).body:
        if isinstance(node, ast.FunctionDef) and (is_stub or node.name in PUBLIC):
            yield f"#### `{signature(node)}`\n\n```\n{text(node)}\n```\n"
        elif isinstance(node, ast.ClassDef) and (is_stub or node.name in PUBLIC):
            members = [f"{ast.unparse(n.target)}: {ast.unparse(n.annotation)}" for n in node.body
                       if isinstance(n, ast.AnnAssign)]
            functions = [n for n in node.body if isinstance(n, ast.FunctionDef) and n.name != "__repr__"]
            yield f"#### `class {node.name}`\n\n```\n{text(node)}\n```\n"
            if members:
                yield "```python\n" + "\n".join(members) + "\n```\n"
            for function in functions:
                yield f"##### `{signature(function)}`\n\n" + (f"```\n{text(function)}\n```\n" if text(function) else "")


def main():
    is_check = sys.argv[3:] == ["--check"]
    if len(sys.argv) != 3 and not is_check:
        raise SystemExit(__doc__)
    lull, folder = sys.argv[1:3]
    python = [part for source in MODULE for part in python_interface(source)]
    pages = {
        "reference.md": ["# Commands\n", "Written by `cmake/reference.py` from `lull COMMAND --help-all`. Each option is described where "
                         "the first command has it; all commands have `-h` and `--help-all`. Exit codes: 0 success, 1 input or "
                         "environment error, 2 usage error, 130 interrupted.\n", *commands(lull)],
        "interfaces.md": ["# C and Python\n", "Written by `cmake/reference.py` from the header and docstrings.\n",
                          "## C: `lull/lull.h`\n", *c_interface(HEADER), "## Python: `lull`\n", *python]}
    for name, parts in pages.items():
        file, text = pathlib.Path(folder, name), "\n".join(parts)
        if not is_check:
            file.write_text(text)
        elif file.read_text() != text:
            difference = difflib.unified_diff(file.read_text().split("\n"), text.split("\n"), lineterm="")
            raise SystemExit("\n".join(difference) + f"\n{file} differs. Write it again: cmake/reference.py {lull} {folder}")


if __name__ == "__main__":
    main()
