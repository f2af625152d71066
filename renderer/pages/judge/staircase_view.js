"use strict";
// Shows a block beside its reference and asks which of both has the noise.

function makeStaircaseView() {
  ["left", "right"].forEach((id, side) => byId(id).addEventListener("click", () => choose(side)));
}

let choosing = false;  // whether the pictures of the next trial are on their way

function choose(side) {
  if (!choosing) addEvent("a", side);
}

function layOutStaircase() {
  const {trial} = replay(session);
  if (!trial) return;
  const b = study.blocks[trial.block], size = pixelSize();
  for (const id of ["left", "right"])
    Object.assign(byId(id).firstElementChild.style, {width: b.width * size + "px", height: b.height * size + "px"});
}

function showStaircase(state) {
  const {trial} = state, top = study.levels.length - 1;
  byId("progress-text").textContent = `${state.count + 1} of ${state.of}`;
  byId("progress").value = state.count / state.of;
  layOutStaircase();
  choosing = true;
  Promise.all(["left", "right"].map((id, side) =>
    drawPicture(byId(id).firstElementChild, trial.block, side === trial.noisySide ? trial.level : top))).then(() => {
      choosing = false;
      forgetPictures((block, level) => level === top);
    });
}
