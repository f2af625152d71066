#!/usr/bin/env python3
"""Draws scenes/pictures/decision.svg: a model's estimates for the block of stops.png, with its stop and the human threshold.

decision.py LULL: trains a model without staircase2 on the recordings in stopping/data, and runs it on that of staircase2.
"""
import csv
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
VIEWPOINT, BLOCK = "p3d_staircase2-view0_part6", 5
WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 420, 300, 60, 24, 12, 44  # of the picture and its margins, in pixels
LAST = 5000  # spp of the right border


def decisions(lull, folder):
    """Returns the rows of BLOCK: spp, value (the probability), threshold, stop and human threshold of the block."""
    data = ROOT / "stopping/data"
    model, curves = folder / "model.h5", folder / "curves.csv"
    human = ["--human", data / "human.csv"]
    for command in (["train", *sorted(data.glob("*.h5")), *human, "--leave-out", VIEWPOINT, "--threads", "1", "--quiet",
                     "-o", model],
                    ["evaluate", data / "staircase2-view0.h5", *human, "--stop", f"learned:{model}", "--brief",
                     "--curves", curves]):
        subprocess.run([lull, *command], check=True, stdout=subprocess.DEVNULL)
    with open(curves) as file:
        return [row for row in csv.DictReader(file) if int(row["block"]) == BLOCK and int(row["spp"]) <= LAST]


def place(spp, value):
    return (LEFT + spp / LAST * (WIDTH - LEFT - RIGHT), TOP + (1 - value) * (HEIGHT - BOTTOM - TOP))


def mark(spp, label, color, y):
    """Returns a vertical line at spp with a label at its right side."""
    x = place(spp, 0)[0]
    return (f'<path d="M{x:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="{color}"/>'
            f'<text x="{x + 6:.1f}" y="{y}" fill="{color}">{label}</text>')


def picture(rows):
    """Returns the SVG, for light and dark backgrounds."""
    stop, human = int(rows[0]["stop"]), int(rows[0]["human"])
    line = " ".join("%.1f,%.1f" % place(int(r["spp"]), float(r["value"])) for r in rows)
    limit = place(0, float(rows[0]["threshold"]))[1]
    grid = "".join(f'<path d="M{place(s, 0)[0]:.0f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>'
                   f'<text x="{place(s, 0)[0]:.0f}" y="{HEIGHT - BOTTOM + 17}" text-anchor="middle">{s:,}</text>'
                   for s in range(0, LAST + 1, 1000))
    grid += "".join(f'<path d="M{LEFT} {place(0, v)[1]:.0f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
                    f'<text x="{LEFT - 6}" y="{place(0, v)[1] + 4:.0f}" text-anchor="end">{v:g}</text>'
                    for v in (0, .25, .5, .75, 1))
    return f"""<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}"
 font-family="sans-serif" font-size="13" fill="#444">
<style>@media (prefers-color-scheme: dark) {{ svg {{ fill: #bbb }} rect {{ fill: #0d1117 }} [stroke="#ddd"] {{ stroke: #333 }}
 [stroke="#246"] {{ stroke: #79c0ff }} [fill="#246"] {{ fill: #79c0ff }} [stroke="#c33"] {{ stroke: #ff7b72 }}
 [fill="#c33"] {{ fill: #ff7b72 }} [stroke="#777"] {{ stroke: #999 }} [fill="#777"] {{ fill: #999 }} }}</style>
<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>
{grid}
<path d="M{LEFT} {limit:.1f}H{WIDTH - RIGHT}" stroke="#777" stroke-dasharray="5 4"/>
<text x="{LEFT + 6}" y="{limit + 16:.1f}" fill="#777">votes to stop below 1/2</text>
{mark(stop, f"stop: {stop:,}", "#246", TOP + 46)}
{mark(human, f"observers: {human:,}", "#c33", TOP + 16)}
<polyline points="{line}" fill="none" stroke="#246" stroke-width="2"/>
<text x="{(WIDTH + LEFT) / 2:.0f}" y="{HEIGHT - 6}" text-anchor="middle">samples per pixel</text>
<text transform="translate(15 {(HEIGHT - BOTTOM) / 2 + 6:.0f}) rotate(-90)" text-anchor="middle">P(observer sees noise)</text>
</svg>
"""


def main():
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        rows = decisions(sys.argv[1], pathlib.Path(folder))
    (ROOT / "scenes/pictures/decision.svg").write_text(picture(rows))


if __name__ == "__main__":
    main()
