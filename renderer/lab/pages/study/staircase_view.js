"use strict";
// Shows a block beside its reference and asks which of both has the noise.

function makeStaircaseView() {
  putText(byId("progress-text"), "progress.trial", {trial: 1000, count: 1000});  // as long as it will be
  ["left", "right"].forEach((id, side) => byId(id).addEventListener("click", () => choose(side)));
}

let choosing = false;  // whether the pictures of the next trial are on their way, or a cross is shown
let fixating = 0;      // the timer of that

function choose(side) {
  if (!choosing) addEvent("a", side);
}

function layOutStaircase() {
  const {trial} = replay(session);
  if (!trial) return;
  const canvases = ["left", "right"].map(id => byId(id).firstElementChild);
  for (const canvas of canvases) sizeCanvas(canvas, trial.block);
  canvases.forEach(alignToDisplay);
}

function showStaircase(state) {
  const {trial} = state, top = study.levels.length - 1;
  putText(byId("progress-text"), "progress.trial", {trial: state.count + 1, count: state.of});
  byId("progress").value = state.count / state.of;
  layOutStaircase();
  choosing = true;
  clearTimeout(fixating);
  byId("pair").classList.add("waiting");
  const drawn = Promise.all(["left", "right"].map((id, side) =>
    drawPicture(byId(id).firstElementChild, trial.block, side === trial.noisySide ? trial.level : top)));
  fixating = setTimeout(() => drawn.then(() => {
    choosing = false;
    byId("pair").classList.remove("waiting");
    lastEvent = performance.now();  // from here on the pictures are seen
    forgetPictures((block, level) => level === top);
  }), timing.fixation);
}
