#!/usr/bin/env python3
"""Renders scenes until their blocks have stopped, and makes the pictures of the documents in scenes/pictures.

pictures.py LULL [cornell|room]: of cornell decision.svg, the estimates for the block that stopped last, and report.jpg,
a screenshot of its report. Of the room, denoised: room-day.jpg, and room-night.jpg within ten minutes. All by default. Needs
oiiotool (Debian: openimageio-tools) and, for the screenshot, chromium.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SCENES = pathlib.Path(__file__).resolve().parent
SIDE = 400  # of cornell, in pixels


def curve(decisions, width, height):
    """Returns an SVG of a network's probabilities against spp, on a logarithmic scale, with the threshold."""
    points, limit, left, bottom = list(zip(decisions["spp"], decisions["value"])), decisions["threshold"], 60, 44
    first, last = (math.log(points[k][0]) for k in (0, -1))

    def place(spp, value):
        return (left + (math.log(spp) - first) / (last - first) * (width - left - 24),
                12 + (1 - value) * (height - bottom - 12))

    line = " ".join("%.1f,%.1f" % place(*p) for p in points)
    limit_y, (end_x, end_y) = place(points[0][0], limit)[1], place(*points[-1])
    columns = [s for s in (20, 50, 100, 200, 500, 1000, 2000, 5000, 10000) if points[0][0] <= s <= points[-1][0]]
    ticks = "".join('<path d="M%.0f 12V%d" stroke="#ddd"/><text x="%.0f" y="%d" text-anchor="middle">%s</text>' % (
        place(s, 0)[0], height - bottom, place(s, 0)[0], height - bottom + 17, f"{s:,}") for s in columns)
    ticks += "".join('<path d="M%d %.0fH%d" stroke="#ddd"/><text x="%d" y="%.0f" text-anchor="end">%g</text>' % (
        left, place(points[0][0], v)[1], width - 12, left - 6, place(points[0][0], v)[1] + 4, v)
        for v in (0, .25, .5, .75, 1))
    return f"""<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}"
 font-family="sans-serif" font-size="13" fill="#444">
<style>@media (prefers-color-scheme: dark) {{ svg {{ fill: #bbb }} rect {{ fill: #0d1117 }} [stroke="#ddd"] {{ stroke: #333 }}
 [stroke="#246"] {{ stroke: #79c0ff }} [fill="#246"] {{ fill: #79c0ff }} [stroke="#c33"] {{ stroke: #ff7b72 }} [fill="#c33"] {{ fill: #ff7b72 }} }}</style>
<rect width="{width}" height="{height}" fill="#fff"/>
{ticks}
<path d="M{left} {limit_y:.1f}H{width - 12}" stroke="#c33" stroke-dasharray="5 4"/>
<text x="{left + 6}" y="{limit_y + 16:.1f}" fill="#c33">votes to stop below 1/2</text>
<polyline points="{line}" fill="none" stroke="#246" stroke-width="2"/>
<circle cx="{end_x:.1f}" cy="{end_y:.1f}" r="5" fill="#246"/>
<text x="{width - 12}" y="{end_y + 22:.1f}" text-anchor="end" fill="#246">stopped at {points[-1][0]:,} spp</text>
<text x="{(width + left) / 2:.0f}" y="{height - 6}" text-anchor="middle">samples per pixel</text>
<text transform="translate(15 {(height - bottom) / 2 + 6:.0f}) rotate(-90)" text-anchor="middle">P(observer sees noise)</text>
</svg>
"""


def jpeg(source, target, quality=92):
    subprocess.run(["oiiotool", source, "--nosoftwareattrib", "--compression", f"jpeg:{quality}", "-o", target], check=True)


def screenshot(page, target, size):
    """Shows a page in a browser without a window, and writes a picture of it."""
    picture = page.with_suffix(".page.png")
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                    f"--window-size={size}", f"--screenshot={picture}", page.as_uri()], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    jpeg(picture, target, 80)


def data_of(page):
    """Returns the data that a report carries: those of --report R.json."""
    _, _, after = page.read_text().partition('<script id="data" type="application/json">')
    return json.loads(after.partition("</script>")[0])


def cornell(lull, out, pictures):
    page = out / "r.html"
    subprocess.run([lull, "render", SCENES / "cornell/scene.pbrt", "--resolution", f"{SIDE}x{SIDE}", "-o", out / "r.exr",
                    "--report", page], check=True)
    stopped = [b for b in data_of(page)["blocks"] if b["end"] == "stopped" and "decisions" in b]
    last = max(stopped, key=lambda b: b["spp"])
    (pictures / "decision.svg").write_text(curve(last["decisions"], 420, 300))
    screenshot(page, pictures / "report.jpg", "1400,1620")


def room(lull, out, pictures):
    for name, scene, settings in (("day", "room", ["--resolution", "600x400"]),
                                  ("night", "room-night", ["--time", "10m"])):
        subprocess.run([lull, "render", SCENES / f"room/{scene}.pbrt", "--denoise", *settings, "-o", out / f"{name}.exr"],
                       check=True)
        jpeg(out / f"{name}.png", pictures / f"room-{name}.jpg")


def main():
    makers = {"cornell": cornell, "room": room}
    if len(sys.argv) not in (2, 3) or sys.argv[2:] and sys.argv[2] not in makers:
        raise SystemExit(__doc__)
    pictures = SCENES / "pictures"
    pictures.mkdir(exist_ok=True)
    for name in sys.argv[2:] or makers:
        with tempfile.TemporaryDirectory() as folder:
            makers[name](sys.argv[1], pathlib.Path(folder), pictures)


if __name__ == "__main__":
    main()
