"use strict";
// Leads through the screens: welcome, check of the display, practice, the task, a pause, the end.

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

let sessions = store.load();
let session = null;     // the one under way
let lastEvent = 0;      // when the last answer was given, or the task went on
let begunWork = 0;      // when the task went on after the last pause

// Adds an answer, unless it came before anybody could have looked. Returns whether it was taken.
function addEvent(...event) {
  const now = performance.now();
  if (now - lastEvent < timing.shortest) return false;
  const {round} = replay(session);
  session.events.push([...event, Math.round(now - lastEvent)]);
  lastEvent = now;
  keep();
  if (screenName !== "task") return true;
  if (replay(session).round !== round) showScreen("round");
  else if (now - begunWork > timing.breakAfter) pause("break");
  return true;
}

function undo() {
  if (!session.events.length) return;
  session.events.pop();
  delete session.finished;
  lastEvent = performance.now();
  if (screenName !== "task") showScreen("task");
  say("the last answer was taken back");
  keep();
}

// Saves, and shows the next screen.
function keep() {
  const state = replay(session);
  if (state.finished && !session.finished) session.finished = new Date().toISOString();
  store.save(sessions);
  byId("storage").hidden = store.works;
  byId("undo").disabled = !session.events.length;
  if (state.finished) finish();
  else showAdjust(state);
}

// Only where both pictures can be seen as a whole.
function goOn() {
  if (!arrangement()) { pause("window"); return; }
  showScreen("task");
  layOutAdjust();
  lastEvent = begunWork = performance.now();
  flicker(false);
  keep();
}

// Pauses, for a break or because the "window" has become too small, or for no reason.
function pause(reason) {
  store.save(sessions);
  byId("pause-title").textContent = reason === "break" ? "Time for a break" : "A pause";
  byId("pause-why").hidden = !reason;
  byId("pause-why").classList.toggle("warning", reason === "window");
  byId("full-pause").hidden = reason !== "window";
  if (reason === "break") byId("pause-why").textContent = "You have looked for some minutes: look out of a window for a while, as tired eyes see less noise.";
  if (reason === "window") byId("pause-why").textContent = tooSmallText();
  byId("pause-kept").textContent = `Your answers, ${session.observer}, are kept in this browser. You can close the page, and go on another day.`;
  showScreen("pause");
}

function finish() {
  byId("end-title").textContent = "Thank you, " + session.observer;
  showScreen("end");
}

const toggleFullScreen = () => document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen();

function welcome() {
  session = null;
  byId("known").replaceChildren(...sessions.map(s => make("li", {},
    make("button", {type: "button", click: () => { session = s; s.finished ? finish() : goOn(); }},
      (s.finished ? "The answers of " : "Continue as ") + s.observer),
    ` begun ${new Date(s.started).toLocaleString("en")}, ${s.events.length} answers`)));
  byId("known-part").hidden = !sessions.length;
  byId("name").value = "";
  showScreen("welcome");
  drawExample();
}

function enterName(event) {
  event.preventDefault();
  const name = byId("name").value.trim();
  const known = sessions.some(s => s.observer === name);
  byId("name-problem").textContent = known ? name + " has begun already; choose another name, or go on above." : "";
  byId("name").setAttribute("aria-invalid", known);
  if (known || !name) { byId("name").focus(); return; }
  showZoom();
  showWindow();
  showScreen("check");
}

function endCheck(event) {
  event.preventDefault();
  if (!arrangement()) { showWindow(); return; }
  session = startSession(byId("name").value.trim());
  session.display = displayFacts();
  sessions.push(session);
  startPractice(goOn);
}

function taskKeys(event) {
  if (screenName !== "task" || event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.key === " ") {  // flickers wherever the focus is, and presses no button
    event.preventDefault();
    if (!event.repeat) flicker();
  } else if (event.key === "u" || event.key === "U") undo();
  else if (event.key === "p" || event.key === "P") pause();
}

function start() {
  document.title = "Where is noise? \u2013 " + study.viewpoint;
  byId("storage").hidden = store.works;
  makeAdjustView();
  makeCheck();
  makePractice();
  byId("time").textContent = `Sit as you usually do, in a room without glare. It takes ${guessMinutes()}; there are breaks, and you can pause at any time. Your answers stay in this browser until you save them as a file at the end. Nothing is sent.`;
  byId("name-form").addEventListener("submit", enterName);
  byId("check-form").addEventListener("submit", endCheck);
  byId("undo").addEventListener("click", undo);
  byId("undo-end").addEventListener("click", undo);
  byId("pause-button").addEventListener("click", () => pause());
  for (const id of ["full", "full-pause"]) byId(id).addEventListener("click", toggleFullScreen);
  for (const id of ["go-on", "round-on"]) byId(id).addEventListener("click", goOn);
  for (const id of ["other", "other-end"]) byId(id).addEventListener("click", welcome);
  byId("download").addEventListener("click", () => downloadAnswers(session));
  addEventListener("keydown", taskKeys);
  addEventListener("keyup", e => { if (screenName === "task" && e.key === " ") e.preventDefault(); });
  addEventListener("resize", () => {
    if (screenName !== "task") return;
    if (arrangement()) layOutAdjust();
    else pause("window");
  });
  document.addEventListener("visibilitychange", () => { if (document.hidden && screenName === "task") pause(); });
  welcome();
}

start();
