#!/usr/bin/env python3
"""Renders all scenes with the default stopping rule, and makes the contact sheet of this folder's README.

gallery.py LULL [-o FOLDER] [--side N] [--block N] [--cap N]: renders scenes/*/scene.* to FOLDER
(out/gallery), each as N x N pixels, and writes scenes/pictures/gallery.png from what is there: of each
scene the image, the samples of its blocks and what was saved of the cap. A scene that FOLDER has, with
the same settings, is not rendered again. Needs Pillow (Debian: python3-pil).
"""
import argparse
import json
import math
import pathlib
import subprocess

from PIL import Image, ImageDraw, ImageFont

from crops import INK, PAPER

SCENES = pathlib.Path(__file__).resolve().parent
# Captions of the scenes, in the order of the sheet.
TITLES = {
    "direct": "direct light stops early",
    "textured": "texture hides noise",
    "gltf": "a glTF model",
    "many-lights": "67 lamps",
    "cornell": "light by way of walls",
    "glossy": "metal that sees metal",
    "dark": "a dark room, a door",
    "caustic": "light through glass",
}
FONTS = "/usr/share/fonts/truetype/dejavu/DejaVuSans%s.ttf"
FAINT = (120, 122, 126)
COLUMNS, GAP, TEXT, SIDE = 2, 14, 46, 240  # of the sheet, in pixels
# Viridis at equal steps: as the program's own map of samples.
VIRIDIS = [(68, 1, 84), (72, 40, 120), (62, 74, 137), (49, 104, 142), (38, 130, 142), (31, 158, 137),
           (53, 183, 121), (110, 206, 88), (181, 222, 43), (253, 231, 37)]


def render(lull, scene, folder, settings):
    """Renders a scene unless that has been done; returns its report."""
    name = scene.parent.name
    report, made = folder / f"{name}.json", folder / f"{name}.settings"
    if not (report.exists() and made.exists() and made.read_text() == " ".join(settings)):
        print("rendering", name, flush=True)
        subprocess.run([lull, "render", scene, *settings, "--quiet", "-o", folder / f"{name}.exr",
                        "--report", report], check=True, stdout=subprocess.DEVNULL)
        made.write_text(" ".join(settings))
    return json.loads(report.read_text())


def colour(spp, least, most):
    t = (math.log(spp / least) / math.log(most / least) if most > least else 0) * (len(VIRIDIS) - 1)
    i = min(int(t), len(VIRIDIS) - 2)
    return tuple(round(a + (t - i) * (b - a)) for a, b in zip(VIRIDIS[i], VIRIDIS[i + 1]))


def samples_map(blocks, size, least, most, font):
    """Draws the blocks in the colours of their samples, with the numbers."""
    picture = Image.new("RGB", (SIDE, SIDE), PAPER)
    draw = ImageDraw.Draw(picture)
    for block in blocks:
        x, y, w, h = (v * SIDE / size for v in (block["x"], block["y"], block["width"], block["height"]))
        fill = colour(block["spp"], least, most)
        draw.rectangle([x, y, x + w - 1, y + h - 1], fill=fill, outline=PAPER)
        ink = INK if sum(fill) > 330 else (255, 255, 255)
        draw.text((x + w / 2, y + h / 2), str(block["spp"]), fill=ink, font=font, anchor="mm")
    return picture


def sheet(reports, folder, size, cap):
    """Lays the scenes out in pairs of image and map, with a line of words above each."""
    bold, plain, small = (ImageFont.truetype(FONTS % style, points)
                          for style, points in (("-Bold", 15), ("", 13), ("", 12)))
    rows = -(-len(reports) // COLUMNS)
    pair = 2 * SIDE + 4
    picture = Image.new("RGB", (COLUMNS * pair + (COLUMNS + 1) * GAP, rows * (SIDE + TEXT + GAP) + GAP), PAPER)
    draw = ImageDraw.Draw(picture)
    every = [b["spp"] for r in reports.values() for b in r["blocks"]]
    for place, (name, report) in enumerate(reports.items()):
        x = GAP + place % COLUMNS * (pair + GAP)
        y = GAP + place // COLUMNS * (SIDE + TEXT + GAP)
        blocks = report["blocks"]
        pixels = sum(b["width"] * b["height"] for b in blocks)
        mean = sum(b["spp"] * b["width"] * b["height"] for b in blocks) / pixels
        draw.text((x, y + 4), name, fill=INK, font=bold)
        draw.text((x, y + 24), TITLES.get(name, ""), fill=FAINT, font=plain)
        draw.text((x + pair, y + 4), f"{100 * (1 - mean / cap):.0f} % saved", fill=INK, font=bold, anchor="ra")
        draw.text((x + pair, y + 24), f"{mean:.0f} of {cap} spp", fill=FAINT, font=plain, anchor="ra")
        image = Image.open(folder / f"{name}.png").convert("RGB")
        picture.paste(image.resize((SIDE, SIDE), Image.LANCZOS), (x, y + TEXT))
        picture.paste(samples_map(blocks, size, min(every), max(every), small), (x + SIDE + 4, y + TEXT))
    return picture


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lull")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=SCENES.parent / "out/gallery")
    parser.add_argument("--side", type=int, default=240)
    parser.add_argument("--block", type=int, default=60)
    parser.add_argument("--cap", type=int, default=2000)
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    settings = ["--resolution", f"{options.side}x{options.side}", "--block", str(options.block), "--cap",
                str(options.cap)]
    scenes = {s.parent.name: s for s in sorted(SCENES.glob("*/scene.*")) if s.suffix in (".pbrt", ".glb")}
    order = [n for n in TITLES if n in scenes] + [n for n in scenes if n not in TITLES]
    reports = {n: render(options.lull, scenes[n], options.output, settings) for n in order}
    picture = sheet(reports, options.output, options.side, options.cap)
    picture.save(SCENES / "pictures/gallery.png", optimize=True)


if __name__ == "__main__":
    main()
