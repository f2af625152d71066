"""Tests the pages of renders and comparisons: they open from disk, and blocks that are clicked or reached by keys show their
curves."""
import csv
import io
import json
import pathlib
import subprocess
import tempfile
import xml.etree.ElementTree

from browser import check, check_widths

SCENE = """LookAt 0 0 -3  0 0 0  0 1 0
Camera "perspective" "float fov" [40]
Film "image" "integer xresolution" [120] "integer yresolution" [80]
Sampler "random"
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Shape "sphere"
WorldEnd
"""

# Counts the charts in an element that have something drawn on them.
DRAWN = """[...document.querySelectorAll('%s canvas')].filter(c => {
    const p = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
    return p.some(v => v > 0); }).length"""


def check_blocks(browser, name, charts):
    title = "document.getElementById('block-title').textContent"
    check(browser.evaluate("(spp => spp[view.block] === Math.max(...spp))(data.images[0].blocks.map(b => b.spp))"),
          name + ": begins with a block that took the most samples")
    browser.click("[data-block=\"4\"]")
    check(browser.evaluate(title).startswith("Block 4 "), name + ": a click chooses a block")
    check(browser.evaluate(DRAWN % "#block-charts") == charts, f"{name}: it has {charts} curves")
    browser.evaluate("document.querySelector('.stage svg').focus()")
    browser.press("ArrowRight")
    check(browser.evaluate(title).startswith("Block 5 "), name + ": arrow keys choose the next")
    browser.press("ArrowUp")
    check(browser.evaluate(title).startswith("Block 2 "), name + ": and the one above")
    check(browser.evaluate("[...document.images].filter(i => i.getAttribute('src'))"
                           ".every(i => i.complete && i.naturalWidth === 120)"),
          name + ": pictures are there")


def choose(browser, label, value):
    browser.evaluate(f"""(() => {{ const s = document.querySelector('[aria-label="{label}"]');
        s.value = '{value}'; s.dispatchEvent(new Event('change')); }})()""")


def check_fit(browser, name):
    choose(browser, "Zoom", "0")
    check_widths(browser, name)


def check_dark(browser):
    colour = "getComputedStyle(document.body).backgroundColor"
    check(browser.evaluate(colour) == "rgb(255, 255, 255)", "the page is light")
    browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark"}])
    check(browser.evaluate(colour) == "rgb(22, 22, 22)", "and dark where the browser wants that")
    browser.call("Emulation.setEmulatedMedia", features=[])


def check_saved(browser, name, charts, tables):
    """Each chart can be saved as SVG and CSV, each table as CSV."""
    browser.evaluate("""window.saved = []; saveText = (...file) => saved.push(file);
        document.querySelectorAll('.save').forEach(b => b.click())""")
    saved = browser.evaluate("saved")
    svgs = [text for _, kind, text in saved if kind == "image/svg+xml"]
    csvs = [text for _, kind, text in saved if kind == "text/csv"]
    check((len(svgs), len(csvs)) == (charts, charts + tables), f"{name}: {len(svgs)} SVG and {len(csvs)} CSV files")
    for text in svgs:
        svg = xml.etree.ElementTree.fromstring(text)
        check("NaN" not in text and "undefined" not in text and len(svg) > 10, f"{name}: an SVG of {len(svg)} parts")
    for text in csvs:
        rows = list(csv.reader(io.StringIO(text)))
        check(len(rows) > 1 and {len(row) for row in rows} == {len(rows[0])}, f"{name}: a CSV of {len(rows)} rows")


def check_sentences(browser):
    """What the first sentence says of a render, whose blocks have so many samples."""
    for totals, spp, rule, sentence in (
            ({"cleanBlocks": 2, "blocksAtCap": 0}, [20, 40], "lnoise:1",
             "Rendered in 5\u00a0s: all 2 blocks are clean, at 20 to 40 samples per pixel."),
            ({"cleanBlocks": 0, "blocksAtCap": 2}, [80, 80], "lnoise:1",
             "Rendered in 5\u00a0s: 0 of 2 blocks are clean; 2 at the cap of 80 samples per pixel, still noisy."),
            ({"cleanBlocks": 1, "blocksAtCap": 0, "timeUp": True}, [20, 40], "lnoise:1",
             "Rendered in 5\u00a0s: 1 of 2 blocks is clean; 1 out of time."),
            ({"cleanBlocks": 0, "blocksAtCap": 2}, [80, 80], "fixed:80",
             "Rendered in 5\u00a0s: 80 samples per pixel, without a stopping rule.")):
        data = {"cap": 80, "provenance": {"criterion": rule}, "images": [{"blocks": [{"spp": s} for s in spp]}],
                "totals": {"blocks": 2, "seconds": 5, "interrupted": False, **totals}}
        said = browser.evaluate(f"sayRender({json.dumps(data)})")
        check(said == sentence, "a first sentence: " + said)


def check_decisions(browser):
    """The votes that stopped a block are marked, numbered, and said."""
    browser.evaluate("chooseBlock(data.blocks.findIndex(b => b.end === 'clean'))")
    chart = "document.querySelector('#block-charts .chart')"
    said = browser.evaluate(chart + ".querySelector('.note').textContent")
    check(said == "3 checks in a row below 1. The block is clean.", "decisions: " + said)
    check(browser.evaluate(chart + ".textContent.includes('votes to stop')"), "decisions: votes have a legend")
    browser.evaluate(f"window.saved = []; saveText = (...file) => saved.push(file); {chart}.querySelector('.save').click()")
    texts = [text.text for text in xml.etree.ElementTree.fromstring(browser.evaluate("saved[0][2]")).iter() if text.attrib.get("font-weight") == "600"]
    check(texts[1:] == ["1", "2", "3"], f"decisions: votes are numbered: {texts}")
    for threshold, value, votes, sentence in ((1, [0.5, 1.5], [1, 0], "At the last check not below 1."),
                                              (3.1, [4, 3], [0, 0], "At the last check below 3.1.")):
        said = browser.evaluate("sayDecision(%s)" % json.dumps({"threshold": threshold, "value": value, "votes": votes}))
        check(said == sentence, "decisions: " + said)


def check_labels(browser):
    """Keys of the data are in words."""
    for rule, label in (("learned", "default rule"), ("learned:paper, caution 2", "model paper, caution 2"), ("dammertz:0.02", "dammertz, 0.02"),
                        ("denoised:3.1", "visible difference of the denoised image below 3.1"), ("thresholds:a, b.csv:c", "sample counts of a, b.csv:c")):
        said = browser.evaluate(f"ruleLabel({json.dumps(rule)})")
        check(said == label, f"labels: {rule} is {said}")
    page = browser.evaluate("document.body.innerText")
    for word in ("lnoise:1", "maxDepth", "criterion"):
        check(word not in page, f"labels: no {word}")
    check("stopping rule: masked noise below 1 L*" in page, "labels: the rule in the subtitle")


def check_savings(browser):
    """Savings compare with the highest sample count of a block of the image, not with the cap."""
    data = {"cap": 10000, "blocks": [{"width": 2, "height": 1}, {"width": 4, "height": 1}],
            "images": [{"blocks": [{"spp": 50, "seconds": 1}, {"spp": 100, "seconds": 3}]}]}
    saved = browser.evaluate(f"savingsOf({json.dumps(data)})")
    check((saved["most"], round(6 * saved["samples"], 9), round(5 * saved["seconds"], 9)) == (100, 1, 1), f"savings: {saved}")


def check_two(browser):
    """A divider that is dragged, and images that take turns."""
    upper = "document.querySelector('.canvas img:nth-child(2)')"
    place = browser.evaluate("(() => { const r = document.querySelector('.divider').getBoundingClientRect(),"
                             " c = document.querySelector('.canvas').getBoundingClientRect();"
                             " return [r.x + 12, r.y + 30, c.x + c.width / 4]; })()")
    for kind, x in (("mousePressed", place[0]), ("mouseMoved", place[2]), ("mouseReleased", place[2])):
        browser.call("Input.dispatchMouseEvent", type=kind, x=x, y=place[1], button="left", buttons=1, clickCount=1)
    check(abs(browser.evaluate("view.divide") - 0.25) < 0.01, "compare: the divider can be dragged")
    browser.press("ArrowRight")
    check(abs(browser.evaluate("view.divide") - 0.27) < 0.01, "compare: and moved by keys")
    check("27%" in browser.evaluate(upper + ".style.clipPath"), "compare: it parts the images")
    choose(browser, "Show", "flicker")
    for hidden in ("true", "false"):
        browser.wait_for(f"{upper}.hidden === {hidden}")
    check(browser.evaluate(upper + ".style.clipPath + view.overlay") == "none", "compare: two images take turns, with nothing over them")
    for mode in ("side", "one"):
        choose(browser, "Show", mode)


def check_eyes(browser):
    """The eyes of a pair take turns at the same place; by hand alone for those who want less motion."""
    shown = ("[...document.querySelector('.canvas').querySelectorAll('img')].map(i => [i.hidden, i.getBoundingClientRect().x -"
             " document.querySelector('.canvas').getBoundingClientRect().x])")
    browser.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}])
    choose(browser, "Show", "eyes")
    width = browser.evaluate("document.querySelector('.canvas').clientWidth")
    caption = "stages[0].caption.textContent"
    check(browser.evaluate(caption) == "left eye" and browser.evaluate(shown + "[1][0]"), "a pair: the left eye's image comes first")
    browser.click("#turn")
    (_, left), (is_hidden, right) = browser.evaluate(shown)
    check((left, is_hidden, round(right)) == (0, False, -width), "a pair: a button puts the right eye's in its place")
    browser.call("Emulation.setEmulatedMedia", features=[])
    choose(browser, "Show", "eyes")
    for eye in ("left", "right"):
        browser.wait_for(f"{caption} === '{eye} eye'")
    check_fit(browser, "a pair")


def test(browser, lull):
    with tempfile.TemporaryDirectory() as directory:
        folder = pathlib.Path(directory)
        (folder / "scene.pbrt").write_text(SCENE)
        (folder / "human.csv").write_text("scene;20;40;60;80;20;40;\n")
        for command in (
                "render scene.pbrt --stop lnoise:1 --cap 80 --report render.html -o r.exr",
                "compare scene.pbrt --stop lnoise:1 --human human.csv --snapshots --cap 80"
                " --curves --report compare.html",
                "render scene.pbrt --spp 4 --stereo 0.2,3 --report pair.html -o pair.exr"):
            subprocess.run([lull, *command.split(), "--block", "40", "--quiet"], cwd=folder,
                           check=True, stdout=subprocess.DEVNULL)

        browser.open(folder / "render.html")
        check_blocks(browser, "render", 3)
        check(browser.evaluate("document.title").startswith(folder.name), "render: its title is the scene")
        check(browser.evaluate("byId('sentence').textContent").startswith("Rendered in"), "render: a sentence says what")
        check(browser.evaluate("[document.querySelector('.canvas').clientWidth, document.querySelector('[aria-label=Zoom]').value]") == [120, "1"],
              "render: it opens at 100 %")
        check(browser.evaluate("[...document.querySelectorAll('#block-charts .u-value')].every(v => /\\d/.test(v.textContent))"),
              "render: legends have numbers before anybody points at them")
        texts = "document.querySelectorAll('.stage:not([hidden]) svg text').length"
        check(browser.evaluate(texts) == 0, "render: nothing is over the image at first")
        choose(browser, "Overlay", "spp:image")
        check(browser.evaluate(texts) == 6, "render: the samples can be")
        check_decisions(browser)
        check_labels(browser)
        check_savings(browser)
        check_saved(browser, "render", 3, 1)
        check_dark(browser)
        check_fit(browser, "render")
        check_sentences(browser)
        browser.open(folder / "pair.html")
        check_eyes(browser)
        browser.open(folder / "compare.html")
        check_two(browser)
        check_blocks(browser, "compare", 3)
        choose(browser, "Overlay", "spp:human")
        check(browser.evaluate("document.querySelector('.stage svg').textContent.includes('80')"),
              "compare: the map has the samples of each block")
        check(browser.evaluate("document.querySelectorAll('#summary thead th').length === 4 &&"
                               " document.querySelectorAll('#summary tbody tr').length > 10"),
              "compare: the table has three images and their figures")
        check(browser.evaluate(DRAWN % "#error-charts") == 2, "compare: two charts of error are drawn")
        choose(browser, "Error", "flip")
        check(browser.evaluate(DRAWN % "#error-charts") == 2, "compare: and again for another error")
        check_fit(browser, "compare")
