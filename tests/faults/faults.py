#!/usr/bin/env python3
"""Gives lull damaged files, and kills it: faults.py LULL [--cases N] [--kills N] [--seed S].

Every case of every reader has a number, and is the same for the same seed. It counts as fine (exit
code 0), clear (exit code 1 and lines of error that each name a file, at most ten of them and how
many more there are) or as anything else: a crash, a hang, an error without a name. Those are kept in
the folder --keep, with the command. A killed render, comparison or recording has to come to
the same results in the end but for times, with no more than one temporary file left meanwhile of
each that it writes.
With --write FOLDER the damaged files are only written, for the fuzzers (tests/fuzz).
Exits with 0 if there was nothing else.
"""
import argparse
import base64
import concurrent.futures
import json
import os
import pathlib
import random
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile
import time

SECONDS = 30          # of a processor that a case may take; of the clock ten times that
MEMORY = 4 << 30      # bytes that it may take; 0: any number

SCENE = """LookAt 0 1 -4  0 0.5 0  0 1 0
Camera "perspective" "float fov" [40] "float lensradius" [0.01] "float focaldistance" [4]
Film "image" "integer xresolution" [8] "integer yresolution" [8] "string filename" "out.exr"
PixelFilter "mitchell"
Sampler "random" "integer pixelsamples" [2]
Integrator "volpath" "integer maxdepth" [4]
WorldBegin
MakeNamedMedium "fog" "string type" "heterogeneous" "integer nx" [2] "float density" [0.5 2]
    "rgb sigma_a" [1 1 1] "rgb sigma_s" [2 2 2] "point p0" [-1 -1 -1] "point p1" [1 1 1]
LightSource "infinite" "rgb L" [0.5 0.5 0.6]
LightSource "point" "rgb I" [5 5 5] "point from" [0 3 -1]
Texture "t" "spectrum" "imagemap" "string filename" "t.png"
Texture "u" "float" "checkerboard" "float tex1" [0.1] "float tex2" [0.5]
Material "uber" "texture Kd" "t" "rgb Ks" [0.2 0.2 0.2] "float eta" [1.5] "texture roughness" "u"
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-3 0 -3 3 0 -3 3 0 3 -3 0 3]
AttributeBegin
    Translate -0.5 0.5 0
    Material "glass" "float eta" [1.4]
    Shape "sphere" "float radius" [0.4]
    Material ""
    MediumInterface "fog" ""
    Shape "sphere" "float radius" [0.9]
AttributeEnd
ObjectBegin "a"
    Material "metal" "float roughness" [0.2]
    Shape "plymesh" "string filename" "m.ply"
ObjectEnd
Translate 0.7 0.4 0
Rotate 30 0 1 0
Scale 0.5 0.5 0.5
ObjectInstance "a"
WorldEnd
"""

PLY = """ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
element face 3
property list uchar int vertex_indices
end_header
-1 -1 0
1 -1 0
1 1 0.5
-1 1 0
3 0 1 2
3 0 2 3
4 0 1 2 3
"""

LENS = "29.475 3.76 1.67 25.2\n84.83 0.12 1 25.2\n0 4.025 0 22.8\n-20 2 1.6 20\n-25 30 1 20\n"


def gltf():
    points = struct.pack("<9f", -1, -1, 0, 1, -1, 0, 0, 1, 0)
    data = base64.b64encode(points + struct.pack("<4H", 0, 1, 2, 0)).decode()
    return json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "scale": [1, 1, 1], "translation": [0, 0, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.5, "roughnessFactor": 0.5},
                       "emissiveFactor": [1, 1, 1]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [-1, -1, 0], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36},
                        {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "buffers": [{"byteLength": 44, "uri": "data:application/octet-stream;base64," + data}]},
        indent=1)


NUMBERS = ["0", "-1", "1e30", "-1e30", "1e-30", "1e400", "nan", "inf", "5e18", "2147483648",
           "-2147483649", "99999999999999999999", "0.5", "1e19", "x", ""]


def damage_text(text, rng):
    """Changes numbers, words and lines, such as a hand or a broken exporter would."""
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        kind = rng.randrange(7)
        numbers = list(re.finditer(r"(?<![\w.])-?\d[\d.e+-]*", text))
        lines = text.split("\n")
        at = rng.randrange(len(lines))
        if kind <= 2 and numbers:
            m = rng.choice(numbers)
            text = text[:m.start()] + rng.choice(NUMBERS) + text[m.end():]
        elif kind == 3:
            text = "\n".join(lines[:at] + lines[at + 1:])
        elif kind == 4:
            text = "\n".join(lines[:at] + [lines[at]] * rng.choice([2, 50]) + lines[at:])
        elif kind == 5:
            text = text[:rng.randrange(len(text) + 1)]
        else:
            i = rng.randrange(len(text) + 1)
            text = text[:i] + chr(rng.choice([0, 10, 34, 91, 93, 35, 255, rng.randrange(256)])) + \
                text[i + rng.randrange(3):]
        text = text or " "
    return text


def damage_bytes(data, rng):
    """Flips bits, overwrites, cuts, inserts and repeats."""
    data = bytearray(data)
    for _ in range(rng.choice([1, 1, 2, 8])):
        # Headers are at the beginning.
        i = rng.randrange(min(len(data), 200) if rng.random() < 0.5 else len(data))
        n = rng.choice([1, 2, 4, 16])
        kind = rng.randrange(5)
        if kind == 0:
            data[i] ^= 1 << rng.randrange(8)
        elif kind == 1:
            data[i:i + n] = rng.choice([b"\0", b"\xff", b"\x7f", b"\x80"]) * n
        elif kind == 2:
            del data[i:i + rng.choice([1, n, len(data)])]
        elif kind == 3:
            data[i:i] = rng.randbytes(n)
        else:
            data[i:i] = data[i:i + 64]
        data = data or bytearray(b"\0")
    return bytes(data)


class Reader:
    """A file that is damaged, the other files beside it, and what reads them."""

    def __init__(self, name, file, arguments):
        self.name, self.file, self.arguments = name, file, arguments

    def damaged(self, files, rng):
        data = files[self.file]
        try:
            return damage_text(data.decode("ascii"), rng).encode("latin-1") \
                if rng.random() < 0.9 else damage_bytes(data, rng)
        except UnicodeDecodeError:
            return damage_bytes(data, rng)


# The size is not left to the file: a whole image may take longer than a case may.
RENDER = "render {} --resolution 8x8 --spp 1 --threads 1 --quiet -o out.exr"
READERS = [
    Reader("pbrt", "scene.pbrt", RENDER.format("scene.pbrt")),
    Reader("ply", "m.ply", RENDER.format("scene.pbrt")),
    Reader("png", "t.png", RENDER.format("scene.pbrt")),
    Reader("exr", "t.exr", RENDER.format("exr.pbrt")),
    Reader("lens", "lens.dat", RENDER.format("lens.pbrt")),
    Reader("gltf", "m.gltf", RENDER.format("m.gltf")),
    Reader("csv", "h.csv", "evaluate --human h.csv --predicted p.csv"),
    Reader("model", "model.h5", RENDER.format("scene.pbrt --stop learned:model.h5")
           .replace("--spp 1", "--cap 20")),
    Reader("dataset", "d.h5", "evaluate d.h5 --human v.csv --stop fixed:20"),
    Reader("checkpoint", "c.h5", RENDER.format("scene.pbrt --checkpoint c.h5 --resume")
           .replace("--spp 1", "--spp 4000")),
]


def is_sanitized(lull):
    """Says whether it is built with the address sanitizer, which takes addresses without end."""
    return b"__asan_init" in pathlib.Path(lull).read_bytes()


def limit():
    if MEMORY:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))


def run(lull, arguments, folder):
    """Returns the exit code, None for a hang, and what was said."""
    try:
        done = subprocess.run([lull] + arguments.split(), cwd=folder, preexec_fn=limit,
                              timeout=10 * SECONDS, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        return done.returncode, done.stderr.decode("utf-8", "replace")
    except subprocess.TimeoutExpired:
        return None, ""


def verdict(code, said, folder):
    if code == 0:
        return "fine"
    errors = [line for line in said.split("\n") if line.startswith("lull: error: ")]
    is_last = said.endswith("\n") and said.rstrip("\n").split("\n")[-1:] == errors[-1:]
    names = [p.name for p in folder.iterdir()]
    rest = errors[:-1] if re.fullmatch(r"lull: error: and \d+ more", "".join(errors[-1:])) else errors
    if code == 1 and 1 <= len(rest) <= 10 and is_last and \
            all(any(n in error for n in names) for error in rest):
        return "clear"
    return "else"


def make_files(lull, folder):
    """Returns the good files by their names, those of them that lull writes made by it."""
    lens = 'Camera "realistic" "string lensfile" "lens.dat" "float focusdistance" [3]'
    files = {"scene.pbrt": SCENE, "m.ply": PLY, "lens.dat": LENS, "m.gltf": gltf(),
             "v.csv": "v;30\n", "h.csv": "a;20;40;60;80\nb;100;200;300;400\n", "p.csv": "a;20;20;20;20\nb;9;9;9;9\n",
             "lens.pbrt": re.sub(r"Camera .*", lens, SCENE),
             "exr.pbrt": SCENE.replace("t.png", "t.exr")}
    for name, text in files.items():
        (folder / name).write_text(text)
    plain = 'WorldBegin\nLightSource "infinite"\nShape "sphere"\nWorldEnd\n'
    (folder / "plain.pbrt").write_text(plain)
    for arguments in ("render plain.pbrt --resolution 8x8 --spp 1 --quiet -o t.exr",
                      "record plain.pbrt --name v --resolution 40x40 --block 40 --cap 40 "
                      "--quiet -o d.h5"):
        code, said = run(lull, arguments, folder)
        if code != 0:
            raise SystemExit("no files to begin with: " + said)
    model = pathlib.Path(lull).resolve().parent.parent / "share/lull/models/entropy.h5"
    if model.exists():
        shutil.copy(model, folder / "model.h5")
    # Interrupted as soon as there is a checkpoint.
    command = [lull] + READERS[-1].arguments.replace("--resume", "--checkpoint-interval 0.1").split()
    process = subprocess.Popen(command, cwd=folder, stderr=subprocess.DEVNULL)
    while process.poll() is None and not (folder / "c.h5").exists():
        time.sleep(0.01)
    process.terminate()
    process.wait()
    kept = ["plain.pbrt", "v.csv", "d.h5", "scene.pbrt", "exr.pbrt", "lens.pbrt", "m.ply", "lens.dat", "m.gltf", "h.csv", "p.csv",
            "t.png", "t.exr", "model.h5", "c.h5"]
    return {name: (folder / name).read_bytes() for name in kept if (folder / name).exists()}


def damaged_file(reader, files, seed, number):
    return reader.damaged(files, random.Random(f"{seed} {reader.name} {number}"))


def write_cases(reader, files, seed, cases, folder):
    folder = pathlib.Path(folder) / reader.name
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(cases):
        (folder / str(number)).write_bytes(damaged_file(reader, files, seed, number))


def try_case(lull, reader, files, seed, number, keep):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for other, data in files.items():
            (folder / other).write_bytes(data)
        damaged = damaged_file(reader, files, seed, number)
        (folder / reader.file).write_bytes(damaged)
        code, said = run(lull, reader.arguments, folder)
        found = verdict(code, said, folder)
        if found == "else":
            kept = pathlib.Path(keep) / f"{reader.name}-{number}"
            kept.mkdir(parents=True, exist_ok=True)
            for other, data in files.items():
                (kept / other).write_bytes(data)
            (kept / reader.file).write_bytes(damaged)
            (kept / "said.txt").write_text(f"lull {reader.arguments}\nexit code {code}\n{said}")
        return found


def without_seconds(path):
    """Returns the bytes of a result but times: those in the notes of recordings, and columns of tables."""
    data = re.sub(rb"\d+ s of threads for (\d+ spp), \d+ s for", rb"\1", path.read_bytes())
    if path.suffix != ".csv" or b"seconds" not in data:
        return data
    rows = [line.split(b",") for line in data.split(b"\n")]
    kept = [i for i, title in enumerate(rows[0]) if b"seconds" not in title]
    return b"\n".join(b",".join(row[i] for i in kept if i < len(row)) for row in rows)


class Killed:
    """A command that is killed, how it is resumed, and the results that have to be the same."""

    def __init__(self, arguments, resume, results):
        self.arguments, self.resume, self.results = arguments, resume, results


COMMON = "scene.pbrt --block 20 --checkpoint-interval 0.1 --threads 2 --quiet"
KILLED = [
    Killed(f"render {COMMON} --resolution 60x60 --spp 300 --checkpoint c.h5 -o out.exr", "--resume",
           ["out.png", "out.spp.png"]),
    Killed(f"compare {COMMON} --resolution 60x60 --cap 300 --stop entropy --snapshots "
           "--curves --checkpoint c.h5 -o out", "--resume",
           ["out.automatic.png", "out.reference.png", "out.thresholds.csv"]),
    Killed(f"record {COMMON.replace('20', '60', 1)} --resolution 120x60 --cap 200 --name v "
           "-o out.h5", "", ["out.h5"]),
]


def try_kills(lull, files, seed, kills, command):
    """Returns how many kills there were and what was wrong with them."""
    rng = random.Random(f"{seed} {command.arguments}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def begin():
            for path in folder.iterdir():
                path.unlink()
            for other, data in files.items():
                (folder / other).write_bytes(data)
            (folder / "c.h5").unlink(missing_ok=True)

        begin()
        start = time.monotonic()
        code, said = run(lull, command.arguments, folder)
        if code != 0:
            return 0, ["the whole of it failed: " + said]
        whole = time.monotonic() - start
        results = {result: without_seconds(folder / result) for result in command.results}
        problems, done = [], 0
        while done < kills:
            begin()
            resume = ""
            while True:
                process = subprocess.Popen(
                    [lull] + f"{command.arguments} {resume}".split(), cwd=folder,
                    stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                resume = command.resume
                try:
                    process.wait(rng.uniform(0, 1.2 * whole))
                    break
                except subprocess.TimeoutExpired:
                    process.kill()
                    process.wait()
                    done += 1
                left = [p.name for p in folder.iterdir() if p.name.startswith(".")]
                if len(left) > 6:  # one for each file that is written, and a lock
                    problems.append(f"left: {left}")
            if process.returncode != 0:
                problems.append(f"exit code {process.returncode}")
                continue
            problems += [f"another {result}" for result, data in results.items()
                         if without_seconds(folder / result) != data]
        return done, problems


def main():
    global SECONDS, MEMORY
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("lull")
    parser.add_argument("--cases", type=int, default=500, help="of each reader")
    parser.add_argument("--kills", type=int, default=20, help="of each command")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="one reader", choices=[r.name for r in READERS])
    parser.add_argument("--keep", default="faults-found")
    parser.add_argument("--write", help="a folder for the damaged files; none is tried")
    args = parser.parse_args()
    lull = os.path.abspath(args.lull)
    if is_sanitized(lull):
        SECONDS, MEMORY = 10 * SECONDS, 0
    others = 0
    with tempfile.TemporaryDirectory() as folder:
        files = make_files(lull, pathlib.Path(folder))
    readers = [r for r in READERS if r.file in files and args.only in (None, r.name)]
    if args.write:
        for reader in readers:
            write_cases(reader, files, args.seed, args.cases, args.write)
        return 0
    print(f"seed {args.seed}\nreader      cases   fine  clear   else  seconds")
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for reader in readers:
            start = time.monotonic()
            found = list(pool.map(lambda k: try_case(lull, reader, files, args.seed, k, args.keep),
                                  range(args.cases)))
            counts = [found.count(v) for v in ("fine", "clear", "else")]
            others += counts[2]
            print(f"{reader.name:10}" + "".join(f"{n:7}" for n in [args.cases] + counts) +
                  f"  {time.monotonic() - start:7.1f}", flush=True)
    if args.kills > 0 and not args.only:
        for command in KILLED:
            kills, problems = try_kills(lull, files, args.seed, args.kills, command)
            others += len(problems)
            print(f"{command.arguments.split()[0]}: {kills} kills: " +
                  ("; ".join(problems) or "the same results in the end"), flush=True)
    return 1 if others else 0


if __name__ == "__main__":
    sys.exit(main())
