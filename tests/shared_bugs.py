#!/usr/bin/env python3
"""Runs the scripts of ../shared/bugs, whose inputs failed once, and compares their output with the right values.

    python3 tests/shared_bugs.py build/release/renderer/lull [FOLDER...] [--bugs ../shared/bugs]

FOLDER is the start of a name, such as 54; without any, all run that take seconds. Needs numpy, Pillow and OpenImageIO, with maketx.
Prints a line for each folder and each wrong value, and ends with 1 if there is one.
"""
import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

NUMBER = r"[-+]?\d*\.?\d+(?:e[-+]?\d+)?"


def near(*expected, by=0.01):
    """Returns whether the numbers of a text are these, each by at most `by`, absolutely or relatively."""
    def check(text):
        found = [float(v) for v in re.findall(NUMBER, text)]
        return len(found) == len(expected) and all(abs(a - b) <= by * max(1, abs(b)) for a, b in zip(found, expected))
    return check


def pairs(by):
    """Returns whether the numbers of a text are two equal halves."""
    def check(text):
        found = [float(v) for v in re.findall(NUMBER, text)]
        half = len(found) // 2
        return half > 0 and near(*found[half:], by=by)(" ".join(map(str, found[:half])))
    return check


def below(most):
    return lambda text: max(float(v) for v in re.findall(NUMBER, text)) < most


def anything(text):
    return True


# By folder: the script, and for each kind of line a pattern, how many lines match it, and the test of its group.
RIGHT = {
    "01": ("make.py", [(r"centre \[(\S+)", 5, near(0.5, by=0.005))]),
    "02": ("make.py", [(r"^corners ll,lr,ur,ul (.*) \(", 1, near(0.94, 0, 0.06, 0.06, 0.88, 0.06, 0.06, 0, 0.94, 0.94, 0.88, 0.94,
                                                                 by=0.02))]),
    "03": ("make.py", [(r"^(?:no-aspect \d+x1|aspect-1 \d+x\d)00 square covers (\d+ x \d+) px", 7, near(50, 50, by=0)),
                       (r"^no-aspect 100x200 square covers (\d+ x \d+) px", 1, near(100, 100, by=0)),
                       (r"^aspect-2 200x100 square covers (\d+ x \d+) px", 1, near(50, 50, by=0)),
                       (r"^aspect-2 100x[12]00 square covers (\d+ x \d+) px", 2, near(24, 24, by=0)),
                       (r"^aspect-2 150x100 square covers (\d+ x \d+) px", 1, near(38, 38, by=0))]),
    "07": ("make.py", [(r"dark square (\d+ x \d+) ", 7, near(50, 50, by=0))]),
    "08": ("make.py", [(r"share of green (?:pixels )?(\S+) ", 4, near(0.25, by=0.005))]),
    "09": ("make.py", [(r"^\S+ \[(.*)\]$", 12, lambda t: near(1.254, 0.3686, 0.1419, by=1e-3)(t) or near(0.2406, 0.1893, 0.1816)(t)),
                       (r"^odd \(1, .*(pairs of wavelength and value)", 1, anything),
                       (r"(no wavelength from 360 to 830 nm)", 1, anything)]),
    # pbrt's x grows to the left.
    "10": ("make.py", [(r"^(?:vertex-uv|wedge-texcoord|wedge-t) left (\[.*?\] right \[.*?\])", 3, near(0, 1.03, 0, 1.01, 0, 0, by=0.05)),
                       (r"^\S+-turned left (\[.*?\] right \[.*?\])", 2, near(1.03, 0, 0, 0, 1.01, 0, by=0.05))]),
    "13": ("make.py", [(r"seen from \+z (\S+ expected by winding \S+)", 30, pairs(0.01))]),
    "32": ("make.py", [(r"^utf16\S+ 1 .*(it is UTF-16 text)", 3, anything), (r"^\S+ 0 (ok)$", 5, anything),
                       (r"^(?:nbsp|quotes|form-feed) 1 lull: error: \S+\.pbrt:(\d)", 3, anything)]),
    "38": ("make.py", [(r"^(?:a\d+|rgb)\S* +\[(.*)\]", 18, near(0.8, 0.4, 0.2, by=0.004)),
                       (r"^assoc\S* +\[(.*)\]", 2, near(0.4, 0.2, 0.1, by=0.004)), (r"^grey16\S* +\[(.*)\]", 1, near(0.4, 0.4, 0.4))]),
    "40": ("make.py", [(r"^\w+ 0 .* rms (\S+) \(noisy mean", 6, below(0.02))]),
    "54": ("make.py", [(r"^\S+ +(\d+) pixels lit +expected 2500$", 17, near(2500, by=0)),
                       (r"^\S+ +(REFUSED|2500 pixels lit) +expected .*refused", 11, anything)]),
    "55": ("make.py", [(r"through the box \[(.*?)\]", 17, near(0.5, 0.5, 0.5, by=1e-4))]),
    "56": ("make.py", [(r"^\S+ +(\d+) +expected 2500", 13, near(2500, by=0))]),
    "57": ("make.py", [(r"^\S+ +(\d+) +expected 2500", 7, near(2500, by=0)), (r"^pbrt-flat +(REFUSED)", 1, anything)]),
    "58": ("make.py", [(r"^(?:front|back-double|mirrored) +centre \[(.*)\]", 3, near(0.332, 0.003, 0.003, by=0.002)),
                       (r"^back(?:-false)? +centre \[(.*)\]", 2, near(0, 1, 0, by=0))]),
    "60": ("make.py", [(r"^(?!uint\.exr)\S+ +largest difference (\S+)", 32, below(0.05)), (r"^yc.exr +(REFUSED)", 1, anything)]),
    "61": ("make.py", [(r"largest difference (\S+)", 13, below(0.02)), (r"^\S+ +(REFUSED)$", 5, anything)]),
    "62": ("make.py", [(r"^\S+ +(\d+) pixels", 25, near(2500, by=0)), (r"^gz (\d+)", 1, near(2500, by=0)),
                       (r"right \[(.*?)\] expected \S+ left red", 8, near(1.04, 0, 0, by=0.05)),
                       (r"^\S+ +(REFUSED) +expected .*refused", 3, anything)]),
    "63": ("make.py", [(r"mean (\S+) +expected .*(?:read|same)", 15, near(1, by=0.02)),
                       (r"^== \S+ +(REFUSED) +expected .*error", 16, anything), (r"(unused parameter: 'radius')", 1, anything)]),
    # The script integrates suns on too coarse a grid.
    "65": ("make.py", [(r"^(?!sun|1e30)\S+ +plate .*\) +\S+ \+- \S+ +expected (\S+ *)$", 32, anything),
                       (r"^sun-at-seam.*0\.7\) +(\S+) \+-", 1, near(652.6, by=2e-3)),
                       (r"^sun-at-pole.*1\) +(\S+) \+-", 1, near(39830, by=2e-3)),
                       (r"^(?:nan|inf|neg) (\S+)", 3, near(0.497, by=0.002)), (r"^black-and-lamp (\S+)", 1, near(0.5, by=0.005))]),
    "66": ("make.py", [(r"(finite) True", 16, anything), (r"^(?:inf|nan|neg|zero)-(?:one|both|inf) .* 8\.\.45 (\S+)", 7, below(0.01)),
                       (r"^scale \S+ denoised rms (\S+)", 4, below(0.01)), (r"^size .*\('(finite)'", 6, anything),
                       (r"^alpha kept (\S+)", 1, near(0, by=0))]),
    "72": ("glass.py", [(r"largest (\S+)", 7, below(1.006))]),
    "73": ("make.py", [(r"^\S+ +(\d+) +expected 2500", 8, near(2500, by=0)), (r"^khr-required +(REFUSED)", 1, anything)]),
    # "inside-out" has the volume around it, as the side of the normal decides; the base of "half-transmission" scatters.
    "74": ("make.py", [(r"^(?!inside-out|half-transmission)\S+ +\[(.*)\]", 16, pairs(0.004))]),
    "78": ("make.py", [(r"plate facing \w+ +(\S+ expected \S+)", 10, pairs(0.005))]),
    "80": ("make.py", [(r"^\S+ +(\d+) +expected 2500", 14, near(2500, by=0))]),
    "81": ("make.py", [(r"^coat-\S+ +(\S+ expected \S+)", 5, pairs(0.002)), (r"^back-\S+ +(\[.*\] expected .*)", 3, pairs(0)),
                       (r"texture: mean (\[.*\] expected \[.*\])", 1, pairs(0.002)),
                       (r"^goniometric, turned -90 (\S+)", 1, near(31.5, by=0.5)), (r"^goniometric, turned 90 (\S+)", 1, near(0, by=0))]),
}
LONG = ("72",)
# The others: 20 and 71 are tests/blender, 67 is tests/embedding/denoise_test.py, 23, 25, 28, 37 and 75 take minutes, 79 is
# LocalPeakNoise, 82 needs an encoder that is not stored.


def run(folder, script, lull, bugs):
    environment = dict(os.environ, LULL=str(lull), BUGS=str(bugs))
    made = subprocess.run([sys.executable, script], cwd=folder, env=environment, capture_output=True, text=True, errors="replace")
    return (made.stdout + made.stderr).splitlines(), made.returncode


def problems(lines, rows):
    for pattern, count, check in rows:
        groups = [m[1] for m in map(re.compile(pattern).search, lines) if m]
        if len(groups) != count:
            yield f"{len(groups)} lines in place of {count} have {pattern}"
        yield from (f"{group!r} is wrong: {pattern}" for group in groups if not check(group))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lull", type=pathlib.Path)
    parser.add_argument("folders", nargs="*")
    parser.add_argument("--bugs", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2] / "shared" / "bugs")
    o = parser.parse_args()
    wrong = 0
    with tempfile.TemporaryDirectory() as temporary:
        bugs = pathlib.Path(temporary) / "bugs"
        shutil.copytree(o.bugs, bugs, copy_function=shutil.copyfile)
        for folder in sorted(bugs.iterdir()):
            folder.chmod(0o755)
            number = folder.name[:2]
            if number not in RIGHT or not (number in o.folders if o.folders else number not in LONG):
                continue
            script, rows = RIGHT[number]
            lines, code = run(folder, script, o.lull.resolve(), bugs)
            found = [f"{script} ends with {code}: {lines[-1:]}"] * (code != 0) + list(problems(lines, rows))
            print(f"{folder.name:24s} {sum(row[1] for row in rows):3d} values  {'right' if not found else 'WRONG'}", flush=True)
            for problem in found:
                print("    " + problem)
            wrong += len(found)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
