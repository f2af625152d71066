#!/usr/bin/env python3
"""Makes a wheel, which pip installs, from a tree of `cmake --install`.

wheel.py TREE PYTHON_DIR VERSION ARCH FOLDER [PLATFORM]: PYTHON_DIR is where the modules are in TREE, ARCH for
which processor they are built ("": any). Run by the Python that the modules are for. In the wheel
everything lies as in TREE, so that it finds the rest as it does there; the libraries of the system
that it needs are not in it, unless TREE has them; PLATFORM then says what it runs on, such as manylinux_2_36_x86_64.
The name `lull` is another's on the index of Python packages; the module is `lull` all the same.
"""
import base64
import hashlib
import pathlib
import re
import sys
import sysconfig
import zipfile

ROOT = pathlib.Path(__file__).parents[1]
METADATA = """Metadata-Version: 2.1
Name: lull-render
Version: {version}
Summary: path tracer that knows when to stop
License: Apache-2.0
Requires-Python: =={python}.*
Requires-Dist: numpy
"""
WHEEL = """Wheel-Version: 1.0
Generator: cmake/wheel.py
Root-Is-Purelib: false
Tag: {tag}
"""


def contents(tree, python_dir, data):
    """Yields the names in the wheel and the files of the tree that go there."""
    for path in sorted(tree.rglob("*")):
        name = path.relative_to(tree)
        # Wheels have no links: a library is in it once, by the name that programs look for.
        is_versioned = re.search(r"\.so\.[\d.]+$", name.name)
        if path.is_dir() or (is_versioned or name.match("lib*.so")) and not re.search(r"\.so\.\d+$", name.name):
            continue
        if name.is_relative_to(python_dir):
            yield str(name.relative_to(python_dir)), path
        elif name.parts[0] == "bin":
            yield f"{data}/scripts/{name.name}", path
        else:
            yield f"{data}/data/{name}", path


def main():
    if len(sys.argv) not in (6, 7):
        raise SystemExit(__doc__)
    tree, python_dir, version, arch, folder = sys.argv[1:6]
    platform = sys.argv[6] if len(sys.argv) == 7 else sysconfig.get_platform()
    if len(pathlib.Path(python_dir).parts) != 3:  # as lib/python3.11/site-packages has
        raise SystemExit(f"LULL_PYTHON_DIR={python_dir}: a wheel needs it to be LIB/PYTHON/PACKAGES")
    if arch:
        version += "+" + re.sub(r"[^a-z0-9]+", ".", arch.lower())
    python = "cp%d%d" % sys.version_info[:2]
    tag = f"{python}-{python}-" + re.sub(r"[-.]", "_", platform)
    info, data = f"lull_render-{version}.dist-info", f"lull_render-{version}.data"
    files = {name: path.read_bytes() for name, path in contents(pathlib.Path(tree), python_dir, data)}
    address = re.search(r'HOMEPAGE_URL "(.+)"', (ROOT / "CMakeLists.txt").read_text())
    metadata = METADATA.format(version=version, python="%d.%d" % sys.version_info[:2])
    files[f"{info}/METADATA"] = (metadata + (f"Home-page: {address[1]}\n" if address else "")).encode()
    files[f"{info}/WHEEL"] = WHEEL.format(tag=tag).encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    files[f"{info}/LICENSE.uPlot"] = (ROOT / "renderer/pages/uPlot/LICENSE").read_bytes()
    record = f"{info}/RECORD"
    rows = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        rows += f"{name},sha256={digest},{len(content)}\n"
    files[record] = (rows + f"{record},,\n").encode()

    wheel = pathlib.Path(folder, f"lull_render-{version}-{tag}.whl")
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name)  # of 1980: the same files make the same wheel
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if "/scripts/" in name else 0o100644) << 16
            archive.writestr(entry, content)
    print(wheel)


if __name__ == "__main__":
    main()
