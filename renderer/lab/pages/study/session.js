"use strict";
// Keeps the sessions of all observers in the browser, and makes the file of answers.
// A session is {id, observer, seed, started, finished?, display {}, events []}.

// By all that the page says of the study, as answers are played again by it.
const storageName = `lull-judge:${study.id}:${hashText(byId("study").textContent)}`;

const store = {
  works: true,
  load() {
    try {
      return JSON.parse(localStorage.getItem(storageName)) || [];
    } catch {
      this.works = false;
      return [];
    }
  },
  save(sessions) {
    try {
      localStorage.setItem(storageName, JSON.stringify(sessions));
    } catch {
      this.works = false;
    }
  },
};

function startSession(observer) {
  return {id: [...crypto.getRandomValues(new Uint8Array(8))].map(b => b.toString(16).padStart(2, "0")).join(""),
    observer, seed: hashText(study.id + "\n" + observer), started: new Date().toISOString(), display: {}, events: []};
}

const replay = session => replayAdjustment(study, session);

// Returns the mean of a block's answers in spp, the repeated one included.
function thresholdOf(answers, block) {
  const spp = answers.filter(a => a.block === block && a.kind !== "catch").map(a => study.levels[a.level]);
  return spp.reduce((a, b) => a + b, 0) / spp.length;
}

// Returns the contents of the file of answers; lull study --collect reads it (observer_answers.h).
function answersOf(session) {
  const {answers} = replay(session);
  return {format: "lull-judge-answers", version: 1,
    study: {id: study.id, viewpoint: study.viewpoint, procedure: "adjust", blocks: study.blocks.length, levels: study.levels},
    observer: session.observer, session: session.id, seed: session.seed, started: session.started, finished: session.finished,
    seconds: session.events.reduce((sum, event) => sum + event[event.length - 1], 0) / 1000,
    display: session.display,
    thresholds: study.blocks.map((_, block) => thresholdOf(answers, block)), answers};
}

const fileName = text => text.replace(/[^\p{L}\p{N}._-]+/gu, "_");

const downloadAnswers = session => saveText(`${fileName(study.viewpoint)}.${fileName(session.observer)}.json`, "application/json",
  JSON.stringify(answersOf(session)) + "\n");
