"""Works through a study of `lull study`, as an observer who sees noise by a rule."""
import json
import pathlib
import time

# A person takes time to look; a program that plays one says that it did.
LOOK = """(() => { let now = lastEvent + 1e6; performance.now = () => now += %d; timing.breakAfter = 1e12; })()"""


class Participant:
    """Uses the page by mouse or by keys. `threshold(block, kind)` is in spp; looks last `look` ms."""

    def __init__(self, browser, page, threshold, keys=False, look=700):
        self.browser, self.keys, self.threshold = browser, keys, threshold
        self.seen = {}  # (round, block): the threshold of this time
        self.time = LOOK % look
        browser.open(pathlib.Path(page))
        browser.evaluate(self.time)
        self.levels, self.blocks = browser.evaluate("[study.levels, study.blocks]")

    def tab_to(self, selector):
        for _ in range(40):
            if self.browser.evaluate(f"document.activeElement.matches('{selector}')"):
                return
            self.browser.press("Tab")
        raise SystemExit("Tab does not reach " + selector)

    def press(self, selector):
        """Presses a button."""
        if self.keys:
            self.tab_to(selector)
            self.browser.press("Enter")
        else:
            self.browser.click(selector)

    def begin(self, name):
        self.tab_to("#name")
        self.browser.call("Input.insertText", text=name)
        self.browser.press("Enter")
        self.expect("check")
        if self.keys:
            self.tab_to("input[name=tones]")
            self.browser.press(" ")
        else:
            self.browser.click("input[name=tones]")
        self.press("#begin")
        self.practise()
        self.expect("task")

    def practise(self):
        """Does the trials that teach what noise is."""
        self.expect("practice")
        for _ in range(3):
            side = self.browser.evaluate("practice.noisySide") + 1
            self.press(f"#practice figure:nth-child({side}) button")
            self.press("#practice-next")

    def press_same(self):
        """Says that both pictures look the same, and again when asked; goes on to the next round."""
        self.press("#same")
        self.press("#same")
        if self.browser.evaluate("screenName === 'round'"):
            self.press("#round-on")

    def expect(self, screen):
        self.browser.wait_for(f"screenName === '{screen}'")

    def click_block(self, block, back=False):
        if self.keys:
            self.tab_to(".cell")
            self.go_to(block)
            self.browser.press("Backspace" if back else "Enter")
            return
        b = self.browser.evaluate(
            f"(() => {{ const r = adjustView.cells[{block}].noisy.cell.getBoundingClientRect();"
            " return [r.x + r.width / 2, r.y + r.height / 2]; })()")
        for kind in ("mousePressed", "mouseReleased"):
            self.browser.call("Input.dispatchMouseEvent", type=kind, x=b[0], y=b[1], button="left",
                              clickCount=1, modifiers=8 if back else 0)

    def go_to(self, block):
        """Moves by arrow keys."""
        for _ in range(100):
            at, to = (self.blocks[i] for i in (
                self.browser.evaluate("+document.activeElement.dataset.block"), block))
            if at["x"] != to["x"]:
                self.browser.press("ArrowRight" if at["x"] < to["x"] else "ArrowLeft")
            elif at["y"] != to["y"]:
                self.browser.press("ArrowDown" if at["y"] < to["y"] else "ArrowUp")
            else:
                return
        raise SystemExit("arrow keys do not reach the block")

    def sees(self, round_number, block, kind, level):
        if level == len(self.levels) - 1:
            return False  # the reference
        key = (round_number, block)
        if key not in self.seen:
            self.seen[key] = self.threshold(block, kind)
        return self.levels[level] < self.seen[key]

    def state(self):
        return self.browser.evaluate(
            "(s => s.finished ? null : {round: s.round,"
            " entries: s.entries.map(e => [e.kind, shownLevel(study, e)])})(replay(session))")

    def look(self, most=10 ** 9):
        """Answers until the end, or `most` times; returns whether that was the end."""
        given = 0
        while given < most:
            state = self.state()
            if state is None:
                return True
            noisy = [i for i, (kind, level) in enumerate(state["entries"])
                     if self.sees(state["round"], i, kind, level)]
            for block in noisy[:most - given]:
                self.click_block(block)
            given += max(1, len(noisy))
            if not noisy:
                self.press_same()
        return self.state() is None

    def save(self, folder):
        """Saves the answers and returns the file."""
        folder = pathlib.Path(folder)
        before = {file: file.stat().st_mtime_ns for file in folder.glob("*.json")}
        session, self.browser.session = self.browser.session, None
        self.browser.call("Browser.setDownloadBehavior", behavior="allow",
                          downloadPath=str(folder.resolve()))
        self.browser.session = session
        self.press("#download")
        for _ in range(200):
            for file in folder.glob("*.json"):
                if before.get(file) == file.stat().st_mtime_ns:
                    continue
                try:
                    json.loads(file.read_text())
                    return file
                except json.JSONDecodeError:
                    pass
            time.sleep(0.05)
        raise SystemExit("no answers were saved")
