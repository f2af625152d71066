#!/usr/bin/env python3
"""Makes the pictures of the documents in scenes/pictures.

pictures.py NAME...: strip, caution, remedies, gallery, report, room (by day and by night), decision, observed (stops.png and
night-block.jpg) and early (early-blocks.jpg), of scenes in ../shared or $LULL_SHARED. Renders stay in out/pictures; existing ones
are not rendered again. Needs what tests/measurements/measure.py needs, Pillow (Debian: python3-pil) and, for the report,
chromium. Pictures of the add-on are taken in a Blender where it is installed, F12 with lull on the PATH:

xvfb-run -s "-screen 0 560x820x24" blender --factory-startup --window-geometry 0 0 560 820 --python scenes/pictures.py -- panel
xvfb-run -s "-screen 0 960x640x24" blender --factory-startup --window-geometry 0 0 960 640 --python scenes/pictures.py -- f12
"""
import csv
import math
import os
import pathlib
import sys
import tempfile

import numpy as np
from PIL import Image, ImageDraw, ImageFont

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "tests/measurements"))
from measure import Renders, lull, read, run  # noqa: E402

SCENES, PICTURES, OUT = ROOT / "scenes", ROOT / "scenes/pictures", ROOT / "out/pictures"
SHARED = pathlib.Path(os.environ.get("LULL_SHARED", ROOT.parent / "shared")) / "pbrt-scenes"
FONTS = "/usr/share/fonts/truetype/dejavu/DejaVuSans%s.ttf"
PAPER, INK, FAINT = (250, 249, 246), (40, 42, 46), (120, 122, 126)


def render(name, scene, **options):
    """Renders unless that has been done; returns the report and the picture."""
    report = Renders(OUT, SCENES / scene).render(name, **options)
    return report, Image.open(OUT / f"{name}.png").convert("RGB")


def sheet(rows, scale=2):
    """Returns rows of crops of one size, each given as (lines of text, image), their pixels enlarged."""
    rows = [[(words, image.resize((image.width * scale, image.height * scale), Image.NEAREST)) for words, image in row] for row in rows]
    gap, line = 10 if scale > 1 else 6, 17
    font = ImageFont.truetype(FONTS % "", 12)
    lines, first = rows[0][0]
    text = len(lines) * line + 6
    column, height = first.width + gap, first.height + text + gap
    picture = Image.new("RGB", (max(map(len, rows)) * column + gap, len(rows) * height + gap), PAPER)
    draw = ImageDraw.Draw(picture)
    for y, row in enumerate(rows):
        for x, (words, image) in enumerate(row):
            left, top = gap + x * column, gap + y * height
            for k, words_of_line in enumerate(words):
                draw.text((left, top + 2 + k * line), words_of_line, fill=INK, font=font)
            picture.paste(image, (left, top + text))
    return picture


def labelled_crops(name, rows, scale=2):
    """Returns the sheet of renders of one block, given as (title, scene, options), with their samples and CPU seconds."""
    def labelled(place, title, scene, options):
        file = "room" if scene == "room" else "scene"
        report, image = render(f"{name}-{place}", f"{scene}/{file}.pbrt", **options)
        block, = report["blocks"]
        seconds = block["seconds"] + block["criterionSeconds"]
        return [title, f"{block['spp']:,} spp, {seconds:.{1 if seconds < 9.5 else 0}f} s"], image
    return sheet([[labelled(f"{y}{x}", *how) for x, how in enumerate(row)] for y, row in enumerate(rows)], scale)


def strip():
    """One block of glossy in four qualities; the reference has other samples."""
    block = dict(resolution="400x400", crop="0,0.5,0.5,1")
    ways = {"--spp 20": dict(spp=20), "--denoise: at its stop": dict(denoise=True), "default rule: at its stop": {},
            "reference": dict(spp=2000, seed=1)}
    labelled_crops("strip", [[(title, "glossy", {**block, **how}) for title, how in ways.items()]], scale=1).save(
        PICTURES / "strip.jpg", quality=93, subsampling=0)


def caution():
    """One block of cornell by the default rule and by `denoised`, each with several thresholds."""
    size = dict(resolution="100x100")
    picture = labelled_crops("caution", [
        [(f"--caution {c}{' (default)' * (c == '1')}", "cornell", dict(size, caution=c)) for c in ("0.5", "1", "2")],
        [(title, "cornell", dict(size, denoise=True, stop=f"denoised:{limit}"))
         for limit, title in (("6", "--denoise, denoised:6"), ("3.1", "--denoise (3.1)"), ("1.5", "--denoise, denoised:1.5"))]])
    picture.save(PICTURES / "caution.png", optimize=True)


def remedies():
    """Pairs of noise and remedy."""
    caustic, dark, room = (dict(resolution=size, crop=crop) for size, crop in (
        ("400x400", "0.55,0.8,0.62,0.87"), ("200x200", "0,0.5,0.5,1"), ("300x200", "105,205,75,175px")))
    labelled_crops("remedies", [
        [("path", "caustic", dict(caustic, spp=128)), ("path", "dark", dict(dark, spp=128)),
         ("--denoise --spp 4", "room", dict(room, denoise=True, spp=4))],
        [("bdpt, --denoise", "caustic", dict(caustic, spp=128, integrator="bdpt", denoise=True)),
         ("--denoise", "dark", dict(dark, spp=128, denoise=True)), ("--denoise: at its stop", "room", dict(room, denoise=True))]]
    ).save(PICTURES / "remedies.jpg", quality=92)


TITLES = {  # of the gallery, in its order
    "direct": "direct light", "textured": "texture hides noise", "cornell": "indirect light", "gltf": "a glTF model",
    "glossy": "blurred reflections", "many-lights": "67 lamps", "dark": "a dark room, a door", "caustic": "light through glass"}
GALLERY = dict(resolution="240x240", block=120, denoise=True, max_spp=300)
# Viridis at equal steps: as the program's own map of samples.
VIRIDIS = [(68, 1, 84), (72, 40, 120), (62, 74, 137), (49, 104, 142), (38, 130, 142), (31, 158, 137), (53, 183, 121),
           (110, 206, 88), (181, 222, 43), (253, 231, 37)]


def colour(spp, least, most):
    t = (math.log(spp / least) / math.log(most / least) if most > least else 0) * (len(VIRIDIS) - 1)
    i = min(int(t), len(VIRIDIS) - 2)
    return tuple(round(a + (t - i) * (b - a)) for a, b in zip(VIRIDIS[i], VIRIDIS[i + 1]))


def samples_map(blocks, scale, side, every, font):
    """Draws the blocks in the colours of their samples, with the numbers."""
    picture = Image.new("RGB", (side, side), PAPER)
    draw = ImageDraw.Draw(picture)
    for block in blocks:
        x, y, w, h = (block[key] * scale for key in ("x", "y", "width", "height"))
        fill = colour(block["spp"], min(every), max(every))
        draw.rectangle([x, y, x + w - 1, y + h - 1], fill=fill, outline=PAPER)
        ink = INK if sum(fill) > 330 else (255, 255, 255)
        draw.text((x + w / 2, y + h / 2), str(block["spp"]), fill=ink, font=font, anchor="mm")
    return picture


def gallery():
    """All scenes, denoised, in pairs of image and map, with a line of words above each."""
    renders = {n: render(n, next((SCENES / n).glob("scene.[pg]*")), **GALLERY) for n in TITLES}
    bold, plain, small = (ImageFont.truetype(FONTS % style, size) for style, size in (("-Bold", 15), ("", 13), ("", 12)))
    columns, gap, text, side = 2, 14, 46, 240
    pair = 2 * side + 4
    picture = Image.new("RGB", (columns * (pair + gap) + gap, -(-len(renders) // columns) * (side + text + gap) + gap), PAPER)
    draw = ImageDraw.Draw(picture)
    every = [block["spp"] for report, _ in renders.values() for block in report["blocks"]]
    for place, (name, (report, image)) in enumerate(renders.items()):
        x = gap + place % columns * (pair + gap)
        y = gap + place // columns * (side + text + gap)
        totals = report["totals"]
        open_blocks = totals["blocks"] - totals["cleanBlocks"]
        draw.text((x, y + 4), name, fill=INK, font=bold)
        draw.text((x, y + 24), TITLES[name], fill=FAINT, font=plain)
        draw.text((x + pair, y + 4), f"{totals['threadSeconds']:.0f} s of CPU time", fill=INK, font=bold, anchor="ra")
        draw.text((x + pair, y + 24), f"{open_blocks} of {totals['blocks']} not clean at {GALLERY['max_spp']} spp" if open_blocks
                  else "all blocks clean", fill=FAINT, font=plain, anchor="ra")
        picture.paste(image, (x, y + text))
        picture.paste(samples_map(report["blocks"], side / image.width, side, every, small), (x + side + 4, y + text))
    picture.save(PICTURES / "gallery.png", optimize=True)


def report():
    """A screenshot of the report of cornell."""
    with tempfile.TemporaryDirectory() as folder:
        page, picture = pathlib.Path(folder) / "r.html", pathlib.Path(folder) / "page.png"
        lull.render(SCENES / "cornell/scene.pbrt", resolution="200x200", block=100, output=page.with_suffix(".exr"), report=page)
        run("chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=1400,1070",
            f"--screenshot={picture}", page.as_uri())
        Image.open(picture).convert("RGB").save(PICTURES / "report.jpg", quality=80)


def room():
    """The room, denoised, by night within ten minutes."""
    for name, scene, how in (("day", "room", dict(resolution="600x400")), ("night", "room-night", dict(time="10m"))):
        render(f"room-{name}", f"room/{scene}.pbrt", denoise=True, **how)[1].save(PICTURES / f"room-{name}.jpg", quality=92)


# The stop is by a model trained without staircase2, the threshold the mean of the observers. In stopping/data:
#   lull train *.h5 --human human.csv --leave-out p3d_staircase2-view0_part6 --threads 1 -o out.h5
#   lull evaluate staircase2-view0.h5 --human human.csv --stop learned:out.h5 --blocks stops.csv
STAIRS = {20: "20 spp", 2380: "default rule: 2,380 spp", 2886: "observers: 2,886 spp", 10000: "reference"}
WALL = {300: "the stop", 2333: "the human threshold"}
GAIN = 8  # of differences


def brightened(image):
    """Returns a picture of an EXR, three stops brighter."""
    rgb = np.clip(8 * read(image), 0, 1)
    srgb = np.where(rgb <= 0.0031308, 12.92 * rgb, 1.055 * rgb ** (1 / 2.4) - 0.055)
    return Image.fromarray(np.round(255 * srgb).astype(np.uint8))


def difference(image, reference):
    """Returns the difference of two pictures, several times as large, around grey."""
    a, b = (np.asarray(picture, np.float64) for picture in (image, reference))
    return Image.fromarray(np.clip(128 + GAIN * (a - b), 0, 255).astype(np.uint8))


def stairs_sheet(images, denoised):
    """Returns crops, given by their sample counts, and one denoised at its stop, as (spp, image); below, their differences from
    the last."""
    shown = [(STAIRS[spp], image) for spp, image in images.items()]
    *shown, (_, reference) = [shown[0], (f"--denoise: {denoised[0]:,} spp", denoised[1]), *shown[1:]]
    return sheet([[([title], image) for title, image in shown],
                  [([f"difference, {GAIN} times"], difference(image, reference)) for _, image in shown]])


def observed_images(name, counts, scene, **options):
    """Returns images as the observers saw them, by sample count, each rendered on from the one with fewer."""
    return {spp: render(f"{name}-{spp}", SHARED / scene, resolution="800x800", estimator="pbrt-v3", sampler="random", spp=spp,
                        threads=1, checkpoint=OUT / f"{name}.h5", keep_checkpoint=True, resume=True, **options)[1]
            for spp in counts}


def observed():
    """A quarter of block 5 of staircase2, and 150x110 pixels of block 15 of pavilion by night, brighter."""
    stairs = observed_images("stairs", STAIRS, "staircase2/scene.pbrt", crop="0.3125,0.4375,0.275,0.4")
    report, block = render("stairs-denoised", SHARED / "staircase2/scene.pbrt", resolution="800x800", crop="0.25,0.5,0.25,0.5",
                           denoise=True)
    stairs_sheet(stairs, (report["blocks"][0]["spp"], block.crop((50, 20, 150, 120)))).save(PICTURES / "stops.png", optimize=True)
    observed_images("wall", WALL, "pavilion/night-view2.pbrt", substitute=True, crop="0.75,0.9375,0.75,0.8875")
    sheet([[([f"{spp:,} spp: {WALL[spp]}"], brightened(OUT / f"wall-{spp}.exr")) for spp in WALL]]
          ).save(PICTURES / "night-block.jpg", quality=92)


EARLY = [("arcsphere", "arcsphere/scene.pbrt", 8, 1900, 4866), ("arcsphere", "arcsphere/scene.pbrt", 0, 1140, 2733),
         ("day-view2", "pavilion/day-view2.pbrt", 15, 260, 753), ("coffee-splash", "coffee-splash/scene.pbrt", 3, 980, 1602),
         ("staircase2", "staircase2/scene.pbrt", 0, 2340, 3686)]  # name, file, block, stop, human threshold


def early():
    """The middles of blocks that stop long before their human thresholds: at both, and denoised at the stop of --denoise."""
    rows = []
    for scene, file, block, stop, human in EARLY:
        x, y = 200 * (block % 4) + 50, 200 * (block // 4) + 60
        name = f"{scene}-{block}"
        options = dict(crop=f"{x / 800},{(x + 100) / 800},{y / 800},{(y + 80) / 800}", substitute="pavilion" in file)
        at = observed_images(name, (stop, human), file, **options)
        report, denoised = render(f"{name}-denoised", SHARED / file, resolution="800x800", threads=1, denoise=True, **options)
        rows.append([([name, f"stop: {stop:,} spp"], at[stop]), (["", f"human threshold: {human:,} spp"], at[human]),
                     (["", f"--denoise: {report['blocks'][0]['spp']:,} spp"], denoised)])
    sheet(rows).save(PICTURES / "early-blocks.jpg", quality=90)


WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 420, 300, 60, 24, 12, 44  # of decision.svg and its margins, in pixels
LAST = 5000  # spp of the right border


def place(spp, value):
    return (LEFT + spp / LAST * (WIDTH - LEFT - RIGHT), TOP + (1 - value) * (HEIGHT - BOTTOM - TOP))


def mark(spp, label, color, y):
    """Returns a vertical line at spp with a label at its right side."""
    x = place(spp, 0)[0]
    return (f'<path d="M{x:.1f} {TOP}V{HEIGHT - BOTTOM}" stroke="{color}"/>'
            f'<text x="{x + 6:.1f}" y="{y}" fill="{color}">{label}</text>')


def decision():
    """Estimates for the block of stops.png by a model trained without staircase2, with its stop and the human threshold."""
    data = ROOT / "stopping/data"
    with tempfile.TemporaryDirectory() as folder:
        model, curves = f"{folder}/model.h5", f"{folder}/curves.csv"
        lull.program.run("train", sorted(data.glob("*.h5")), dict(human=data / "human.csv", threads=1, output=model,
                                                                  leave_out="p3d_staircase2-view0_part6"), False)
        lull.evaluate(data / "staircase2-view0.h5", human=data / "human.csv", stop=f"learned:{model}", curves=curves)
        with open(curves) as file:
            rows = [row for row in csv.DictReader(file) if int(row["block"]) == 5 and int(row["spp"]) <= LAST]
    stop, human = int(rows[0]["stop"]), int(rows[0]["human"])
    line = " ".join("%.1f,%.1f" % place(int(r["spp"]), float(r["value"])) for r in rows)
    limit = place(0, float(rows[0]["threshold"]))[1]
    grid = "".join(f'<path d="M{place(s, 0)[0]:.0f} {TOP}V{HEIGHT - BOTTOM}" stroke="#ddd"/>'
                   f'<text x="{place(s, 0)[0]:.0f}" y="{HEIGHT - BOTTOM + 17}" text-anchor="middle">{s:,}</text>'
                   for s in range(0, LAST + 1, 1000))
    grid += "".join(f'<path d="M{LEFT} {place(0, v)[1]:.0f}H{WIDTH - RIGHT}" stroke="#ddd"/>'
                    f'<text x="{LEFT - 6}" y="{place(0, v)[1] + 4:.0f}" text-anchor="end">{name}</text>'
                    for v, name in ((0, "none"), (.5, "half"), (1, "all")))
    (PICTURES / "decision.svg").write_text(f"""\
<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}"
 font-family="sans-serif" font-size="13" fill="#444">
<style>@media (prefers-color-scheme: dark) {{ svg {{ fill: #bbb }} rect {{ fill: #0d1117 }} [stroke="#ddd"] {{ stroke: #333 }}
 [stroke="#246"] {{ stroke: #79c0ff }} [fill="#246"] {{ fill: #79c0ff }} [stroke="#c33"] {{ stroke: #ff7b72 }}
 [fill="#c33"] {{ fill: #ff7b72 }} [stroke="#777"] {{ stroke: #999 }} [fill="#777"] {{ fill: #999 }} }}</style>
<rect width="{WIDTH}" height="{HEIGHT}" fill="#fff"/>
{grid}
<path d="M{LEFT} {limit:.1f}H{WIDTH - RIGHT}" stroke="#777" stroke-dasharray="5 4"/>
<text x="{LEFT + 6}" y="{limit + 16:.1f}" fill="#777">below half: votes to stop</text>
{mark(stop, f"stop: {stop:,}", "#246", TOP + 46)}
{mark(human, f"observers: {human:,}", "#c33", TOP + 16)}
<polyline points="{line}" fill="none" stroke="#246" stroke-width="2"/>
<text x="{(WIDTH + LEFT) / 2:.0f}" y="{HEIGHT - 6}" text-anchor="middle">samples per pixel</text>
<text transform="translate(15 {(HEIGHT - BOTTOM) / 2 + 6:.0f}) rotate(-90)" text-anchor="middle">observers who see noise, estimate</text>
</svg>
""")


def take_steps(steps):
    """Enables the add-on in Blender and takes steps, each when the effect of the one before has been drawn; a step that returns
    False is repeated."""
    import bpy
    pause = 3  # seconds

    def take_step():
        if steps[0]() is not False:
            steps.pop(0)
        return pause if steps else None

    bpy.context.preferences.view.show_splash = False
    bpy.ops.preferences.addon_enable(module="lull_engine")
    bpy.app.timers.register(take_step, first_interval=pause)


def f12():
    """The result of F12 in Blender, of the glTF scene."""
    import bpy
    side, folder = 480, tempfile.mkdtemp()

    def start():
        bpy.data.batch_remove(bpy.data.objects)
        np.bool = bool  # Blender 3.4's importer names it, NumPy 1.24 no more
        bpy.ops.import_scene.gltf(filepath=str(SCENES / "gltf/scene.glb"))
        scene = bpy.context.scene
        scene.camera = next(o for o in scene.objects if o.type == 'CAMERA')
        scene.render.engine, scene.render.resolution_x, scene.render.resolution_y = 'LULL', side, side
        scene.lull.time = "1m"
        bpy.context.preferences.view.render_display_type = 'SCREEN'
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            bpy.ops.render.render('INVOKE_DEFAULT')

    def is_done():
        return not bpy.app.is_job_running('RENDER')

    def take():
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            bpy.ops.screen.screenshot(filepath=f"{folder}/f12.png")
        Image.open(f"{folder}/f12.png").convert("RGB").save(PICTURES / "blender-f12.jpg", quality=88)

    take_steps([start, is_done, take, bpy.ops.wm.quit_blender])


def panel():
    """The add-on's panel of render properties, in Blender."""
    import bpy

    def largest_area():
        return max(bpy.context.window_manager.windows[0].screen.areas, key=lambda area: area.width * area.height)

    def open_panels():
        from lull_engine import panels
        for panel in panels.CLASSES:
            bpy.utils.unregister_class(panel)
            panel.bl_options = set()
            bpy.utils.register_class(panel)
        bpy.context.scene.render.engine = 'LULL'
        largest_area().type = 'PROPERTIES'

    def choose():
        largest_area().spaces[0].context = "RENDER"

    def take():
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=largest_area()):
            bpy.ops.screen.screenshot_area(filepath=str(PICTURES / "blender-panel.png"))

    take_steps([open_panels, choose, take, bpy.ops.wm.quit_blender])


if __name__ == "__main__":
    makers = {maker.__name__: maker
              for maker in (strip, caution, remedies, gallery, report, room, decision, observed, early, panel, f12)}
    names = sys.argv[sys.argv.index("--") + 1 if "--" in sys.argv else 1:]
    if not names or set(names) - set(makers):
        sys.exit(__doc__)
    for name in names:
        makers[name]()
