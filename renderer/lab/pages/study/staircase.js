"use strict";
// The procedure of staircases: one block at a time beside its reference, and the observer says which
// of both has the noise. Everything follows from the study, the seed and the events
// ["a", side, ms], with side 0 for the left one. Each block has a track of `study.answers` answers,
// repeated ones a second track; easy trials between them, the noisiest block at the lowest level,
// show whether the observer looks. Trials of all tracks are mixed.

function planStaircase(study, seed) {
  const random = makeRandom(seed), blocks = countUpTo(study.blocks.length);
  const repeated = shuffled(blocks, random).slice(0, countOf(study.repeats, blocks.length));
  const tracks = [...blocks.map(block => ({block, kind: "asked"})), ...repeated.map(block => ({block, kind: "repeat"}))];
  for (const track of tracks) track.centre = 0.35 + 0.3 * random();
  const noise = study.blocks.map(b => b.noise[0]), easy = noise.indexOf(Math.max(...noise));
  const trials = [];
  for (let i = 0; i < study.answers; ++i)
    trials.push(...shuffled(countUpTo(tracks.length), random).map(track => ({track})));
  const catches = study.catches > 0 ? Math.max(4, Math.round(study.catches * trials.length)) : 0;
  for (let i = 0; i < catches; ++i)
    trials.splice(Math.floor((i + random()) * trials.length / catches), 0, {easy});
  for (const trial of trials) trial.noisySide = random() < 0.5 ? 0 : 1;
  return {tracks, trials};
}

// Returns where a session stands: {count, of, trial: {block, level, noisySide}, answers, finished}.
function replayStaircase(study, session) {
  const {tracks, trials} = planStaircase(study, session.seed), answers = [];
  const quests = tracks.map(track => startQuest(study.levels, track.centre));
  const taken = tracks.map(() => []), times = tracks.map(() => 0);
  const ask = trial => trial.track === undefined
    ? {block: trial.easy, level: 0, noisySide: trial.noisySide}
    : {block: tracks[trial.track].block, level: questLevel(quests[trial.track], study.levels), noisySide: trial.noisySide};
  session.events.forEach(([, side, ms], i) => {
    const trial = trials[i], asked = ask(trial), isRight = side === asked.noisySide;
    if (trial.track === undefined) {
      answers.push({block: asked.block, kind: "catch", failed: !isRight, seconds: ms / 1000});
      return;
    }
    addAnswer(quests[trial.track], intensityOf(study.levels[asked.level]), isRight);
    taken[trial.track].push([asked.level, isRight ? 1 : 0]);
    times[trial.track] += ms;
  });
  const finished = session.events.length >= trials.length;
  if (finished)
    tracks.forEach(({block, kind}, i) => answers.push({block, kind, ...questThreshold(quests[i], study.levels),
      trials: taken[i], seconds: times[i] / 1000}));
  return {count: session.events.length, of: trials.length, trial: finished ? null : ask(trials[session.events.length]), answers, finished};
}
