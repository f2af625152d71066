"use strict";
// The procedure of adjustment: the image beside its reference, and each block one level better
// whenever the observer points at it. All of this follows from the study, the seed and the events:
//   ["+", block, ms]  still different there     ["-", block, ms]  one step back
//   ["same", ms]      both pictures look the same
// where ms is the time since the event before. Taking back is leaving out the last event.
//
// In each round every block is an entry {kind, start, clicks, net, ms}:
//   asked   counts: from a start level that is low, but not always the lowest
//   repeat  asked a second time, in a later round, to see how alike the answers are
//   catch   shows the reference on both sides: whoever points there does not look
// A block that was left alone above the lowest level is asked again from there, as its threshold
// may lie below where it started.

// Random numbers that a seed decides, so that a session can be played again from its answers: FNV-1a, 32 bits (Fowler, Noll, Vo).
function hashText(text) {
  let hash = 0x811c9dc5;
  for (const byte of new TextEncoder().encode(text)) hash = Math.imul(hash ^ byte, 0x01000193);
  return hash >>> 0;
}

// Returns a function that gives the next number in [0, 1): a Weyl sequence with the finalizer of
// MurmurHash3 (Appleby).
function makeRandom(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x9e3779b9) >>> 0;
    let h = state;
    h = Math.imul(h ^ (h >>> 16), 0x85ebca6b);
    h = Math.imul(h ^ (h >>> 13), 0xc2b2ae35);
    return ((h ^ (h >>> 16)) >>> 0) / 2 ** 32;
  };
}

const countUpTo = n => [...Array(n).keys()];

// Fisher and Yates.
function shuffled(list, random) {
  const result = [...list];
  for (let i = result.length - 1; i > 0; --i) {
    const k = Math.floor(random() * (i + 1));
    [result[i], result[k]] = [result[k], result[i]];
  }
  return result;
}

// Returns how many of n a share is: at least one of three or more, unless the share is 0.
const countOf = (share, n) => share > 0 && n >= 3 ? Math.max(1, Math.round(share * n)) : 0;

function planAdjustment(study, seed) {
  const random = makeRandom(seed), blocks = countUpTo(study.blocks.length);
  const order = shuffled(blocks, random);
  const catches = countOf(study.catches, order.length);
  const repeats = Math.min(countOf(study.repeats, order.length), order.length - catches);
  const highest = Math.floor((study.levels.length - 1) / 6);
  const start = () => Math.floor(random() * (highest + 1));
  const starts = [blocks.map(start), blocks.map(start)];
  return {caught: order.slice(0, catches), repeated: order.slice(catches, catches + repeats), starts};
}

const makeEntry = (kind, start) => ({kind, start, clicks: 0, net: 0, ms: 0});

// Returns the level that a block shows.
function shownLevel(study, entry) {
  const top = study.levels.length - 1;
  return entry.kind === "catch" ? top : Math.min(top, entry.start + entry.net);
}

function firstRound(study, plan) {
  return plan.starts[0].map((start, b) => plan.caught.includes(b) ? makeEntry("catch", 0) : makeEntry("asked", start));
}

// Says whether an entry may have begun above its threshold.
const isOpen = entry => entry.kind !== "catch" && entry.clicks === 0 && entry.start > 0;

// Returns the entries of the round after `entries`, or null if nothing is left to ask.
function nextRound(plan, entries, round) {
  const next = entries.map((entry, b) => {
    if (isOpen(entry)) return makeEntry(entry.kind, 0);
    if (round === 0 && plan.caught.includes(b)) return makeEntry("asked", plan.starts[1][b]);
    if (round === 0 && plan.repeated.includes(b)) return makeEntry("repeat", plan.starts[1][b]);
    return makeEntry("catch", 0);
  });
  return next.some(entry => entry.kind !== "catch") ? next : null;
}

function closeRound(study, entries, round, answers) {
  entries.forEach((entry, block) => {
    if (isOpen(entry)) return;
    const answer = {block, round, kind: entry.kind, clicks: entry.clicks, seconds: entry.ms / 1000};
    if (entry.kind === "catch") answer.failed = entry.net > 0;
    else Object.assign(answer, {start: entry.start, level: shownLevel(study, entry)});
    answers.push(answer);
  });
}

// Returns where a session stands: {round, entries, answers, finished}.
function replayAdjustment(study, session) {
  const plan = planAdjustment(study, session.seed), top = study.levels.length - 1;
  const state = {round: 0, entries: firstRound(study, plan), answers: [], finished: false};
  for (const [what, block, ms] of session.events) {
    if (what === "same") {
      closeRound(study, state.entries, state.round, state.answers);
      const next = nextRound(plan, state.entries, state.round);
      state.finished = next === null;
      if (next) { state.entries = next; ++state.round; }
      continue;
    }
    const entry = state.entries[block];
    ++entry.clicks;
    entry.ms += ms;
    const step = what === "+" ? 1 : -1;
    if (entry.kind === "catch") entry.net = Math.max(0, entry.net + step);
    else entry.net = Math.min(top - entry.start, Math.max(-entry.start, entry.net + step));
  }
  return state;
}
