"use strict";
// Leads through the screens: welcome, check of the display, the task, a pause, the end.

const view = isStaircase
  ? {make: makeStaircaseView, show: showStaircase, layOut: layOutStaircase}
  : {make: makeAdjustView, show: showAdjust, layOut: layOutAdjust};

const ownText = texts.own || "";
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
  if (replay(session).round !== round) showRound();
  else if (now - begunWork > timing.breakAfter) pause("break");
  return true;
}

function undo() {
  if (!session.events.length) return;
  session.events.pop();
  delete session.finished;
  lastEvent = performance.now();
  if (screenName !== "task") showScreen("task");
  say("said.undo");
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
  else view.show(state);
}

function showRound() {
  const {isDown} = replay(session);
  putText(byId("round-title"), isDown ? "round.down" : "round");
  putTexts(byId("round-text"), isDown ? "round.down.text" : "round.text");
  showScreen("round");
}

// Only where both pictures can be seen as a whole.
function goOn() {
  if (!arrangement()) { pause("window"); return; }
  showScreen("task");
  view.layOut();
  lastEvent = begunWork = performance.now();
  if (!isStaircase) flicker(false);
  keep();
}

// Pauses, for a break or because the "window" has become too small, or for no reason.
function pause(reason) {
  store.save(sessions);
  putText(byId("pause-title"), reason === "break" ? "pause.break" : "pause");
  byId("pause-why").hidden = !reason;
  byId("pause-why").classList.toggle("warning", reason === "window");
  byId("full-pause").hidden = reason !== "window";
  if (reason === "break") putText(byId("pause-why"), "pause.why");
  if (reason === "window") putText(byId("pause-why"), "window.small", {...windowSize(), needed: neededText()});
  putText(byId("pause-kept"), "pause.kept", {name: session.observer});
  showScreen("pause");
}

function finish() {
  putText(byId("end-title"), "end", {name: session.observer});
  showScreen("end");
}

const toggleFullScreen = () => document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen();

// Whoever comes reads the researcher's text first.
function begin() {
  session = null;
  if (ownText) showScreen("own");
  else welcome();
}

function welcome() {
  byId("known").replaceChildren(...sessions.map(s => make("li", {},
    make("button", {type: "button", click: () => { session = s; s.finished ? finish() : goOn(); }},
      textOf(s.finished ? "known.finished" : "known.begun", {name: s.observer})),
    " " + textOf("known.when", {when: new Date(s.started).toLocaleString(texts.language), count: s.events.length}))));
  byId("known-part").hidden = !sessions.length;
  byId("name").value = "";
  showScreen("welcome");
  drawExample();
}

function enterName(event) {
  event.preventDefault();
  const name = byId("name").value.trim();
  const known = sessions.some(s => s.observer === name);
  byId("name-problem").textContent = known ? textOf("name.taken", {name}) : "";
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
  session.person = personFacts();
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
  else if (event.key === "p" || event.key === "P") pause();
}

function start() {
  putAllTexts();
  document.title = textOf("document", {viewpoint: study.viewpoint});
  for (const element of document.querySelectorAll(".adjust")) element.hidden = isStaircase;
  for (const element of document.querySelectorAll(".staircase")) element.hidden = !isStaircase;
  byId("storage").hidden = store.works;
  view.make();
  makeCheck();
  makePractice();
  putTexts(byId("time"), "welcome.time", {minutes: guessMinutes()});
  byId("own-elements").append(...elementsOf(ownText));
  byId("agree").addEventListener("click", welcome);
  byId("name-form").addEventListener("submit", enterName);
  byId("check-form").addEventListener("submit", endCheck);
  byId("undo").addEventListener("click", undo);
  byId("undo-end").addEventListener("click", undo);
  byId("pause-button").addEventListener("click", () => pause());
  for (const id of ["full", "full-pause"]) byId(id).addEventListener("click", toggleFullScreen);
  for (const id of ["go-on", "round-on"]) byId(id).addEventListener("click", goOn);
  for (const id of ["other", "other-end"]) byId(id).addEventListener("click", begin);
  byId("download").addEventListener("click", () => downloadAnswers(session));
  addEventListener("keydown", taskKeys);
  addEventListener("keyup", e => { if (screenName === "task" && e.key === " ") e.preventDefault(); });
  addEventListener("resize", () => {
    if (screenName !== "task") return;
    if (arrangement()) view.layOut();
    else pause("window");
  });
  document.addEventListener("visibilitychange", () => { if (document.hidden && screenName === "task") pause(); });
  begin();
}

start();
