"use strict";
// Shows the whole image beside its reference, and lets the observer point at blocks.

const adjustView = {block: 0, flicker: false, isAsked: false, cells: []};
const holdTime = 500;  // ms that a finger is held to go a step back

// Says where a block is in words, for those who do not see it.
function placeName(block) {
  const b = study.blocks[block];
  const columns = [...new Set(study.blocks.map(o => o.x))], rows = [...new Set(study.blocks.map(o => o.y))];
  return `row ${rows.indexOf(b.y) + 1}, column ${columns.indexOf(b.x) + 1}`;
}

function makeAdjustView() {
  for (const side of ["noisy", "reference"]) {
    const stage = byId(side);
    study.blocks.forEach((b, block) => {
      const canvas = make("canvas", {width: b.width, height: b.height, "aria-hidden": "true"});
      const cell = make(side === "noisy" ? "button" : "div", {class: "cell", "data-block": block,
        click: e => point(block, e.shiftKey ? "-" : "+"), contextmenu: e => e.preventDefault(), mouseenter: () => markBlock(block), mouseleave: () => markBlock(-1)}, canvas);
      if (side === "noisy") {
        cell.tabIndex = block ? -1 : 0;
        cell.setAttribute("aria-label", "Block in " + placeName(block));
        cell.addEventListener("focus", () => { moveTo(block); if (cell.matches(":focus-visible")) markBlock(block); });
        cell.addEventListener("blur", () => markBlock(-1));
        stepBackWhenHeld(cell, block);
      }
      stage.append(cell);
      (adjustView.cells[block] = adjustView.cells[block] || {})[side] = {cell, canvas};
    });
  }
  showProgress("Second", 100);  // as long as it will be, so that its height is known before the task
  byId("noisy").addEventListener("keydown", adjustKeys);
  byId("same").addEventListener("click", bothLookTheSame);
  byId("flicker").addEventListener("click", () => flicker());
}

// A finger has no shift key: held, it goes a step back, and is no click then.
function stepBackWhenHeld(cell, block) {
  let timer = 0, wasHeld = false;
  cell.addEventListener("pointerdown", e => {
    wasHeld = false;
    if (e.pointerType === "touch") timer = setTimeout(() => { wasHeld = true; point(block, "-"); }, holdTime);
  });
  for (const end of ["pointerup", "pointercancel", "pointerleave"]) cell.addEventListener(end, () => clearTimeout(timer));
  cell.addEventListener("click", e => { if (wasHeld) { wasHeld = false; e.stopImmediatePropagation(); } }, true);
}

const sameAgain = "Everywhere? Then press again";

// Asks once more, as this ends the round.
function askIfSame(isAsked) {
  adjustView.isAsked = isAsked;
  byId("same").textContent = isAsked ? sameAgain : "Both look the same";
  byId("same").classList.toggle("asked", isAsked);
}

function bothLookTheSame() {
  if (!adjustView.isAsked) {
    askIfSame(true);
    say(sameAgain);
  } else if (addEvent("same")) {
    askIfSame(false);
    say("");
  }
}

function layOutAdjust() {
  const {size, stacked} = arrangement() || {size: 1 / devicePixelRatio, stacked: true};
  const width = study.width * size, height = study.height * size;
  byId("stages").classList.toggle("stacked", stacked);
  for (const side of ["noisy", "reference"]) {
    byId(side).style.width = width + "px";
    byId(side).style.height = height + "px";
  }
  alignStages();
  study.blocks.forEach((b, block) => {
    for (const {cell} of Object.values(adjustView.cells[block]))
      Object.assign(cell.style, {left: b.x * size + "px", top: b.y * size + "px", width: b.width * size + "px", height: b.height * size + "px"});
  });
}

const alignStages = () => ["noisy", "reference"].forEach(side => alignToDisplay(byId(side)));

// Frames a block on both sides: a thin line around it, as one across it would hide its noise.
function markBlock(block) {
  adjustView.cells.forEach((sides, i) => Object.values(sides).forEach(({cell}) => cell.classList.toggle("marked", i === block)));
}

// Makes a block the one that Tab comes back to.
function moveTo(block) {
  adjustView.cells[adjustView.block].noisy.cell.tabIndex = -1;
  adjustView.block = block;
  adjustView.cells[block].noisy.cell.tabIndex = 0;
}

function adjustKeys(event) {
  const to = blockByKey(study.blocks, study.blocks[adjustView.block], event);
  if (to !== null) {
    if (to >= 0) adjustView.cells[to].noisy.cell.focus();
  } else if (event.key === "Backspace") {
    event.preventDefault();
    point(adjustView.block, "-");
  } else if (event.key === "Enter") {
    event.preventDefault();  // nor when the key is held
    if (!event.repeat) point(adjustView.block, "+");
  }
}

function point(block, direction) {
  if (adjustView.flicker) flicker();
  askIfSame(false);
  if (addEvent(direction, block)) say(placeName(block) + (direction === "-" ? ": one step back" : ": one step better"));
}

// Shows the reference in place of the noisy picture, or the noisy one again.
function flicker(on = !adjustView.flicker) {
  adjustView.flicker = on;
  byId("flicker").setAttribute("aria-pressed", on);
  byId("noisy").parentElement.classList.toggle("flickering", on);
  byId("noisy-caption").textContent = on ? "the reference" : "the picture to judge";
  if (on) say("the reference is shown");
  showAdjust(replay(session));
}

function showProgress(look, count) {
  byId("progress-text").textContent = `${look} look: ${count} answers so far`;
}

function showAdjust(state) {
  const top = study.levels.length - 1;
  showProgress(["First", "Second", "Last"][Math.min(2, state.round)], session.events.filter(e => e[0] !== "same").length);
  byId("progress").value = Math.min(0.95, state.round / 2);
  alignStages();
  const drawn = state.entries.map((entry, block) => {
    const level = shownLevel(study, entry);
    drawPicture(adjustView.cells[block].reference.canvas, block, top);
    return drawPicture(adjustView.cells[block].noisy.canvas, block, adjustView.flicker ? top : level);
  });
  // Load the pictures that the next click on each block may show.
  const near = state.entries.map(entry => shownLevel(study, entry));
  Promise.all(drawn).then(() => {
    forgetPictures((block, level) => level === top || Math.abs(level - near[block]) <= 2);
    near.forEach((level, block) => { for (const l of [level + 1, level - 1]) if (l >= 0 && l <= top) pictureOf(block, l); });
  });
}
