#!/usr/bin/env python3
"""Renders scenes until every block has stopped, and makes the pictures of the README.

pictures.py LULL [many-lights|room]: of many-lights, scenes/pictures/render.png, spp.png and decision.svg, drawn from
the report: what the rule computed of the block that stopped last, pass by pass. Of the room, denoised, by day and by
night, room-day.jpg, room-night.jpg, and by day room-spp.png. Both by default. JPEG files need oiiotool (Debian:
openimageio-tools).
"""
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile

SCENES = pathlib.Path(__file__).resolve().parent
SIDE = 200        # of many-lights, in pixels
ROOM_CAP = "200"  # samples per pixel


def curve(decisions, width, height):
    """Returns an SVG of the rule's number against spp, both logarithmic, and its threshold."""
    points = [(s, v) for s, v in zip(decisions["spp"], decisions["value"]) if v > 0]
    limit, left, bottom = decisions["threshold"], 44, 36
    xs = [math.log(s) for s, _ in points]
    ys = [math.log(v) for _, v in points] + [math.log(limit)]
    low, high = min(ys) - 0.4, max(ys) + 0.1

    def place(x, y):
        return (left + (x - xs[0]) / (xs[-1] - xs[0]) * (width - left - 24),
                12 + (high - y) / (high - low) * (height - bottom - 12))

    line = " ".join("%.1f,%.1f" % place(x, math.log(v)) for x, (_, v) in zip(xs, points))
    limit_y = place(xs[0], math.log(limit))[1]
    end_x, end_y = place(xs[-1], math.log(points[-1][1]))
    ticks = "".join(
        '<text x="%.0f" y="%d" text-anchor="middle">%d</text>' % (place(x, low)[0], height - 20, round(math.exp(x)))
        for x in (xs[0], (xs[0] + xs[-1]) / 2, xs[-1]))
    return f"""<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}"
 font-family="sans-serif" font-size="13" fill="#555">
<rect width="{width}" height="{height}" fill="#fff"/>
<line x1="{left}" x2="{width - 12}" y1="{limit_y:.1f}" y2="{limit_y:.1f}" stroke="#c33" stroke-dasharray="5 4"/>
<text x="{left + 6}" y="{limit_y + 16:.1f}" fill="#c33">stops below this</text>
<polyline points="{line}" fill="none" stroke="#246" stroke-width="2"/>
<circle cx="{end_x:.1f}" cy="{end_y:.1f}" r="5" fill="#246"/>
<text x="{width - 12}" y="{limit_y + 34:.1f}" text-anchor="end" fill="#246">stopped at {points[-1][0]} spp</text>
{ticks}
<text x="{(width + left) / 2:.0f}" y="{height - 4}" text-anchor="middle">samples per pixel</text>
<text transform="translate(16 {height / 2 - 10:.0f}) rotate(-90)" text-anchor="middle">what the rule computes</text>
</svg>
"""


def many_lights(lull, out, pictures):
    subprocess.run([lull, "render", SCENES / "many-lights/scene.pbrt", "--resolution", f"{SIDE}x{SIDE}", "--block", "50",
                    "--cap", "1000", "-o", out / "r.exr", "--report", out / "r.json"], check=True)
    shutil.copy(out / "r.spp.png", pictures / "spp.png")
    shutil.copy(out / "r.png", pictures / "render.png")
    blocks = json.loads((out / "r.json").read_text())["blocks"]
    stopped = [b for b in blocks if b["end"] == "stopped" and "decisions" in b]
    last = max(stopped, key=lambda b: b["spp"])
    (pictures / "decision.svg").write_text(curve(last["decisions"], 300, 300))


def room(lull, out, pictures):
    for name, scene in (("day", "room"), ("night", "room-night")):
        subprocess.run([lull, "render", SCENES / f"room/{scene}.pbrt", "--denoise", "--block", "120", "--cap", ROOM_CAP,
                        "-o", out / f"{name}.exr"], check=True)
        subprocess.run(["oiiotool", out / f"{name}.png", "--compression", "jpeg:92", "-o", pictures / f"room-{name}.jpg"],
                       check=True)
    shutil.copy(out / "day.spp.png", pictures / "room-spp.png")


def main():
    makers = {"many-lights": many_lights, "room": room}
    if len(sys.argv) not in (2, 3) or sys.argv[2:] and sys.argv[2] not in makers:
        raise SystemExit(__doc__)
    pictures = SCENES / "pictures"
    pictures.mkdir(exist_ok=True)
    for name in sys.argv[2:] or makers:
        with tempfile.TemporaryDirectory() as folder:
            makers[name](sys.argv[1], pathlib.Path(folder), pictures)


if __name__ == "__main__":
    main()
