"use strict";
// Leads through the screens: welcome, check of the display, the task, a pause, the end.

const view = isStaircase
  ? {make: makeStaircaseView, show: showStaircase, layOut: layOutStaircase}
  : {make: makeAdjustView, show: showAdjust, layOut: layOutAdjust};

const ownText = JSON.parse(byId("own-text").textContent);
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
  else if (now - begunWork > timing.breakAfter) pause(true);
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

// Saves, and shows what comes next.
function keep() {
  const state = replay(session);
  if (state.finished && !session.finished) session.finished = new Date().toISOString();
  store.save(sessions);
  byId("storage").hidden = store.works;
  byId("undo").disabled = !session.events.length;
  if (state.finished) finish();
  else view.show(state);
}

function goOn() {
  showScreen("task");
  view.layOut();
  lastEvent = begunWork = performance.now();
  if (!isStaircase) flicker(false);
  keep();
}

function pause(isBreak) {
  store.save(sessions);
  byId("pause-title").textContent = isBreak ? "Time for a break" : "A pause";
  byId("pause-why").hidden = !isBreak;
  byId("paused-name").textContent = session.observer;
  showScreen("pause");
}

function finish() {
  byId("end-name").textContent = session.observer;
  showScreen("end");
}

// Whoever comes reads the researcher's text first.
function begin() {
  session = null;
  if (ownText) showScreen("own");
  else welcome();
}

function welcome() {
  byId("known").replaceChildren(...sessions.map(s => make("li", {},
    make("button", {type: "button", click: () => { session = s; s.finished ? finish() : goOn(); }},
      s.finished ? `The answers of ${s.observer}` : `Go on as ${s.observer}`),
    ` begun ${new Date(s.started).toLocaleString()}, ${s.events.length} answers`)));
  byId("known-part").hidden = !sessions.length;
  byId("name").value = "";
  showScreen("welcome");
  drawExample();
}

function enterName(event) {
  event.preventDefault();
  const name = byId("name").value.trim();
  const known = sessions.some(s => s.observer === name);
  byId("name-problem").textContent = known ? `${name} has begun already; choose another name, or go on above.` : "";
  byId("name").setAttribute("aria-invalid", known);
  if (known || !name) { byId("name").focus(); return; }
  showZoom();
  showScreen("check");
}

function endCheck(event) {
  event.preventDefault();
  session = startSession(byId("name").value.trim());
  session.display = displayFacts();
  sessions.push(session);
  startPractice(goOn);
}

function taskKeys(event) {
  if (screenName !== "task" || event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.key === " ") {  // flickers wherever the focus is, and presses no button
    event.preventDefault();
    if (!isStaircase && !event.repeat) flicker();
  } else if (isStaircase && (event.key === "ArrowLeft" || event.key === "ArrowRight")) {
    event.preventDefault();
    if (!event.repeat) choose(event.key === "ArrowLeft" ? 0 : 1);
  } else if (event.key === "u" || event.key === "U") undo();
  else if (event.key === "p" || event.key === "P") pause(false);
}

function start() {
  document.title = `Where is noise? \u2013 ${study.viewpoint}`;
  for (const element of document.querySelectorAll(".adjust")) element.hidden = isStaircase;
  for (const element of document.querySelectorAll(".staircase")) element.hidden = !isStaircase;
  byId("storage").hidden = store.works;
  view.make();
  makeCheck();
  makePractice();
  byId("minutes").textContent = guessMinutes();
  byId("own-elements").append(...elementsOf(ownText));
  byId("agree").addEventListener("click", welcome);
  byId("name-form").addEventListener("submit", enterName);
  byId("check-form").addEventListener("submit", endCheck);
  byId("undo").addEventListener("click", undo);
  byId("undo-end").addEventListener("click", undo);
  byId("pause-button").addEventListener("click", () => pause(false));
  byId("full").addEventListener("click", () => document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen());
  for (const id of ["go-on", "round-on"]) byId(id).addEventListener("click", goOn);
  for (const id of ["other", "other-end"]) byId(id).addEventListener("click", begin);
  byId("download").addEventListener("click", () => downloadAnswers(session));
  addEventListener("keydown", taskKeys);
  addEventListener("keyup", e => { if (screenName === "task" && e.key === " ") e.preventDefault(); });
  addEventListener("resize", () => { if (screenName === "task") view.layOut(); });
  document.addEventListener("visibilitychange", () => { if (document.hidden && screenName === "task") pause(false); });
  begin();
}

start();
