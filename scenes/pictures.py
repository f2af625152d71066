#!/usr/bin/env python3
"""Renders scenes until their blocks have stopped, and makes the pictures of the documents in scenes/pictures.

pictures.py LULL [cornell|room]: of cornell report.jpg, a screenshot of its report; of the room, denoised, room-day.jpg, and
room-night.jpg within ten minutes. All by default. Needs oiiotool (Debian: openimageio-tools) and, for the screenshot, chromium.
"""
import pathlib
import subprocess
import sys
import tempfile

SCENES = pathlib.Path(__file__).resolve().parent
SIDE = 400  # of cornell, in pixels


def jpeg(source, target, quality=92):
    subprocess.run(["oiiotool", source, "--nosoftwareattrib", "--compression", f"jpeg:{quality}", "-o", target], check=True)


def screenshot(page, target, size):
    """Shows a page in a browser without a window, and writes a picture of it."""
    picture = page.with_suffix(".page.png")
    subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                    f"--window-size={size}", f"--screenshot={picture}", page.as_uri()], check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    jpeg(picture, target, 80)


def cornell(lull, out, pictures):
    page = out / "r.html"
    subprocess.run([lull, "render", SCENES / "cornell/scene.pbrt", "--resolution", f"{SIDE}x{SIDE}", "-o", out / "r.exr",
                    "--report", page], check=True)
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
