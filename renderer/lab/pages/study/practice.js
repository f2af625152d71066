"use strict";
// Shows noise: an example, and three trials, less noisy each, after which the page says which
// picture had the noise. Nothing of this is kept.

const noiseOfBlocks = study.blocks.map(b => b.noise[0]);
const practice = {block: noiseOfBlocks.indexOf(Math.max(...noiseOfBlocks)), trial: 0, noisySide: 0, isAnswered: false, then: null};
const practiceLevels = [0, 1 / 6, 1 / 3].map(share => Math.floor(share * (study.levels.length - 1)));

// Draws the noisiest block on two canvases.
function drawPractice(canvases, level, noisySide) {
  canvases.forEach((canvas, side) => {
    sizeCanvas(canvas, practice.block);
    drawPicture(canvas, practice.block, side === noisySide ? level : study.levels.length - 1);
  });
  canvases.forEach(alignToDisplay);
}

const practiceCanvases = () => [...document.querySelectorAll("#practice canvas")];
const drawExample = () => drawPractice([...document.querySelectorAll("#example canvas")], 0, 0);

function showPractice() {
  practice.isAnswered = false;
  practice.noisySide = Math.random() < 0.5 ? 0 : 1;
  drawPractice(practiceCanvases(), practiceLevels[practice.trial], practice.noisySide);
  byId("practice-title").textContent = `Practice: ${practice.trial + 1} of ${practiceLevels.length}`;
  byId("practice-said").textContent = "Which one is noisier? Click or tap it.";
  for (const caption of document.querySelectorAll("#practice figcaption")) caption.textContent = "\u00a0";
  byId("practice-next").hidden = true;
}

function answerPractice(side) {
  if (practice.isAnswered) return;
  practice.isAnswered = true;
  document.querySelectorAll("#practice figcaption").forEach((caption, i) => { caption.textContent = i === practice.noisySide ? "with noise" : "without"; });
  byId("practice-said").textContent = side === practice.noisySide ? "Yes, that is the noisy one." : "No, it is the other one: look at its grain.";
  byId("practice-next").hidden = false;
  byId("practice-next").focus();
}

function startPractice(then) {
  Object.assign(practice, {trial: 0, then});
  showScreen("practice");
  showPractice();
}

function nextPractice() {
  if (++practice.trial < practiceLevels.length) showPractice();
  else practice.then();
}

function makePractice() {
  document.querySelectorAll("#practice figure button").forEach((button, side) => button.addEventListener("click", () => answerPractice(side)));
  byId("practice-next").addEventListener("click", nextPractice);
  byId("practice-skip").addEventListener("click", () => practice.then());
}
