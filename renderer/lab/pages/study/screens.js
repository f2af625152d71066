"use strict";
// Which screen is shown, and how time goes by.

let screenName = "";

// In ms: an answer that comes sooner was not to what is shown; the work after which eyes need a break.
const timing = {shortest: 150, breakAfter: 5 * 60e3};

function showScreen(name) {
  screenName = name;
  for (const section of document.querySelectorAll("main > section")) section.hidden = section.id !== name;
  document.body.classList.toggle("judging", ["practice", "task", "round", "pause"].includes(name));
  (byId(name).querySelector("h1[tabindex]") || byId(name)).focus();
  scrollTo(0, 0);
}

// Tells those who do not see it.
function say(text) {
  byId("said").textContent = text;
}

// Says how long it may take: a guess, by 1.2 s a step on half of the ladder and 3 s a look at a block.
function guessMinutes() {
  const blocks = study.blocks.length, steps = blocks * (1 + study.repeats) * study.levels.length / 2;
  const seconds = 1.2 * steps + 6 * blocks;
  return `about ${Math.ceil(seconds / 60 + 2)} to ${Math.ceil(1.7 * seconds / 60 + 4)} minutes`;
}
