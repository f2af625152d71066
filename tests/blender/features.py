#!/usr/bin/python3
"""Renders scenes of one feature of Blender each with Cycles and with the add-on, and writes a table of features.

    cmake --build --preset release --target lull blender_addon
    tests/blender/features.py blender build/release/share/lull/lull-blender.zip build/release/renderer/lull OUT [NAME...]

A feature is right if means of R, G, B and alpha are within 2 % of Cycles', blocks of 10x10 pixels within 5 % of the mean, on average,
and each block of 5x5 pixels within 15 % of the mean of the block and the picture, or within four standard errors; refused if there is
no picture; else warned. One that differs without a warning is silent, and the exit code is 1. Pictures stay in the folder OUT,
`NAME.png` with Cycles on the left; existing ones are not rendered again, but lull's if it is named, or with `--again`. `--write`
writes features-VERSION.csv, all features in a version of Blender, and their counts in renderer/docs/blender.md. blender_test.py judges
some of the features, for CI.
"""
import argparse
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "renderer/python/lull"))
import exr  # noqa: E402

BEGIN = "<!-- features.py writes the next line -->\n"
SIZE, MEANS, BLOCKS, WORST, ERRORS = (60, 40), 0.02, 0.05, 0.15, 4


class Blender:
    """A Blender with the add-on, whose settings are in a folder."""
    version = None  # of the last render

    def __init__(self, program, addon, lull, folder):
        self.addon, self._program = pathlib.Path(folder, "scripts/addons/lull_engine"), program
        self._environment = dict(os.environ, BLENDER_USER_SCRIPTS=f"{folder}/scripts", BLENDER_USER_CONFIG=f"{folder}/config",
                                 PATH=f"{pathlib.Path(lull).resolve().parent}:{os.environ['PATH']}")
        os.makedirs(self.addon.parent)
        self.start("--factory-startup", "--python-expr",
                   f"import bpy; bpy.ops.preferences.addon_install(filepath={str(addon)!r})").communicate()

    def start(self, *arguments, **more):
        return subprocess.Popen([self._program, "-b", "-noaudio", "--python-exit-code", "3", *arguments], text=True, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, env=self._environment, **more)

    def render(self, runs, out, spp):
        """Renders as features_in_blender.py has it. Yields each name, its title and the lines that were printed; nothing for features that
        this Blender lacks."""
        what = {"runs": runs, "size": SIZE, "spp": spp, "folder": str(out)}
        lines = []
        with self.start("--factory-startup", "--addons", "lull_engine", "--python", str(HERE / "features_in_blender.py"), "--",
                        json.dumps(what)) as process, open(out / "log.txt", "w", encoding="utf-8") as log:
            for line in process.stdout:
                log.write(line)
                if line.startswith("CASE "):
                    (name, title), lines = line[5:].strip().split(" | "), []
                elif line == "MADE\n":
                    yield name, title, lines
                elif line.startswith("VERSION "):
                    self.version = line.split()[1]
                else:
                    lines.append(line.strip())
        if process.returncode not in (0, 1):  # 1 after an error of a render
            sys.exit(f"Blender ended early; see {out}/log.txt")


def all_names():
    return [name for file in sorted((HERE / "features").glob("*.py"))
            for name in re.findall(r"^@case.*\ndef (\w+)", file.read_text(encoding="utf-8"), re.M)]


def run(o):
    """Renders named features, or those missing in OUT."""
    names = o.names or [name for name in all_names() if o.again or not (o.out / f"{name}.json").exists()]
    with tempfile.TemporaryDirectory() as folder:
        blender = Blender(o.blender, o.addon, o.lull, folder)
        for name, title, lines in blender.render([(name, name, "", ['CYCLES', 'LULL']) for name in names], o.out, o.spp):
            (o.out / f"{name}.json").write_text(json.dumps({"title": title, "said": said(lines)}), encoding="utf-8")
            print(name, flush=True)
    (o.out / "version.txt").write_text(blender.version, encoding="utf-8")


def said(lines):
    return [line for line in lines if re.match("(Warning|Error|Info): ", line)]


def picture(path):
    """Returns R, G, B and alpha; None without the file."""
    if not path.exists():
        return None
    channels, _ = exr.read(path)
    return np.stack([next(v for k, v in channels.items() if re.fullmatch(rf"((.*\.)?Combined\.)?{c}", k)) for c in "RGBA"], -1)


def blocks(values, n=10):
    height, width = (n * (side // n) for side in values.shape[:2])
    return values[:height, :width].reshape(height // n, n, width // n, n, -1).mean((1, 3))


def worst(a, b, n=5):
    """Returns the largest difference of a block that noise does not explain: of colours a fraction of the mean of the block and the
    picture, so that a small object counts, and of alpha itself."""
    first, difference = blocks(a, n), a - b
    error = np.sqrt(np.maximum(blocks(difference ** 2, n) - blocks(difference, n) ** 2, 0)) / n
    apart = abs(blocks(difference, n))
    scale = np.concatenate([(first[..., :3] + a[..., :3].mean()) / 2, np.ones_like(first[..., 3:])], -1)
    return np.where(apart > ERRORS * error, apart / np.maximum(scale, 1e-9), 0).max()


def beside(a, b, path):
    from PIL import Image
    both = np.concatenate([a[..., :3], np.ones((len(a), 3, 3)), b[..., :3]], 1).clip(0, 1)
    both = np.where(both < 0.0031308, both * 12.92, 1.055 * both ** (1 / 2.4) - 0.055)
    shown = Image.fromarray((255 * both).astype(np.uint8))
    shown.resize((3 * shown.width, 3 * shown.height), 0).save(path)


def clean(line):
    line = re.sub("^((Warning|Error|Info): )+", "", line)
    line = re.sub(r"lull: \S+: /\S+: warning: ", "lull: ", line)
    return line.removeprefix("The scene cannot be exported: ")


def consequences(lines, kinds="Warning|Error"):
    """Returns the warnings of a feature, once each, without the names."""
    lines = [clean(line) for line in lines if re.match(f"({kinds}): ", line)]
    return list(dict.fromkeys(re.sub(r": '.*$", "", line) for line in lines))


def judge(out, name, lines):
    """Returns the verdict, and the differences of means, of blocks and of the worst block; without a picture the verdict alone."""
    a, b = (picture(out / f"{name}.{engine}.exr") for engine in ("cycles", "lull"))
    remarks = [line for line in consequences(lines, "Info") if line.startswith("settings of Cycles without effect: ")]
    warnings = [line for line in consequences(lines) if line not in remarks]
    if b is None:
        return ("refused: " + "; ".join(warnings),)
    means = (b.mean((0, 1)) + 1e-9) / (a.mean((0, 1)) + 1e-9) - 1
    apart = means[np.argmax(abs(means))]
    apart_in_blocks = abs(blocks(a) - blocks(b))
    off = max(apart_in_blocks[..., :3].mean() / max(a[..., :3].mean(), 1e-9), apart_in_blocks[..., 3].mean())
    of_worst = worst(a, b)
    is_right = abs(apart) <= MEANS and off <= BLOCKS and of_worst <= WORST
    texts = "; ".join(warnings + remarks)
    verdict = "right" if is_right else "" if texts else "**silent**"
    return ", ".join(filter(None, (verdict, f"warned: {texts}" if texts else ""))), apart, off, of_worst


def write(rows, path):
    """Writes all features."""
    with open(path, "w", encoding="utf-8", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([["feature", "lull", "means in %", "blocks in %", "worst block in %"], *rows])


def read(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))[1:]


def tables():
    """Returns the rows of all features by version and title."""
    return {path.stem.removeprefix("features-"): {row[0]: row for row in read(path)} for path in sorted(HERE.glob("features-*.csv"))}


def counts():
    """Returns the numbers of right features by version."""
    parts = [f"{sum(row[1].startswith('right') for row in rows.values())} of {len(rows)} in Blender {version}"
             for version, rows in tables().items()]
    return f"Right are {' and '.join(parts)}."


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("blender")
    parser.add_argument("addon", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("lull")
    parser.add_argument("out", type=lambda path: pathlib.Path(path).resolve())
    parser.add_argument("names", nargs="*", help="features, by the names of their functions [all]")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--again", action="store_true", help="render all of lull's pictures again")
    parser.add_argument("--table", action="store_true", help="render nothing, and judge the pictures in OUT")
    parser.add_argument("--write", action="store_true", help="replace features-VERSION.csv and the counts in renderer/docs/blender.md")
    o = parser.parse_args()
    os.makedirs(o.out, exist_ok=True)
    if not o.table:
        run(o)
    rows, silent = [], []
    for name in all_names():
        if not (o.out / f"{name}.json").exists():
            continue
        feature = json.loads((o.out / f"{name}.json").read_text(encoding="utf-8"))
        verdict, *apart = judge(o.out, name, feature["said"])
        if apart:
            beside(*(picture(o.out / f"{name}.{engine}.exr") for engine in ("cycles", "lull")), o.out / f"{name}.png")
        silent += [name] if "silent" in verdict else []
        figures = [f"{100 * value:{form}}" for value, form in zip(apart, ("+.1f", ".1f", ".0f"))] or [""] * 3
        rows.append([feature["title"], verdict, *figures])
        print(*rows[-1], sep=" | ")
    write(rows, o.out / "features.csv")
    if o.write:
        write(rows, HERE / f"features-{(o.out / 'version.txt').read_text(encoding='utf-8')}.csv")
        page = ROOT / "renderer/docs/blender.md"
        before, rest = page.read_text(encoding="utf-8").split(BEGIN)
        page.write_text(before + BEGIN + counts() + rest[rest.index("\n"):], encoding="utf-8")
    if silent:
        sys.exit("silent: " + ", ".join(silent))


if __name__ == "__main__":
    main()
