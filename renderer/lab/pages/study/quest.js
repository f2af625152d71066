"use strict";
// QUEST (Watson and Pelli, Perception & Psychophysics 33(2), 1983): what is known of a threshold is
// a probability density over its logarithm, and each answer multiplies it by the psychometric
// function. The intensity is the amplitude of the noise, which falls with the root of the samples:
// x = -log10(spp) / 2.

// Slope of the Weibull function for contrast, share of slips, chance of a right guess.
const questModel = {beta: 3.5, slips: 0.01, guess: 0.5};

const intensityOf = spp => -0.5 * Math.log10(spp);

// The probability of a right answer at intensity x for threshold t: 82 % at x = t.
function rightProbability(x, t) {
  const {beta, slips, guess} = questModel;
  return slips * guess + (1 - slips) * (1 - (1 - guess) * Math.exp(-(10 ** (beta * (x - t)))));
}

// Starts with a density as wide as the ladder, around `centre`, a place on it in [0, 1].
function startQuest(levels, centre) {
  const high = intensityOf(levels[0]), low = intensityOf(levels[levels.length - 1]);
  const span = high - low, points = 8 * levels.length;
  const grid = countUpTo(points + 1).map(i => low - span / 4 + 1.5 * span * i / points);
  const middle = high - span * centre, width = span / 2;
  return {grid, logs: grid.map(t => -0.5 * ((t - middle) / width) ** 2)};
}

function addAnswer(quest, x, isRight) {
  quest.logs = quest.logs.map((v, i) => {
    const p = rightProbability(x, quest.grid[i]);
    return v + Math.log(isRight ? p : 1 - p);
  });
}

// Returns mean and standard deviation of the density, which vary less than its mode does where
// answers are few (King-Smith et al., Vision Research 34(7), 1994).
function questEstimate(quest) {
  const highest = Math.max(...quest.logs), weights = quest.logs.map(v => Math.exp(v - highest));
  const sum = weights.reduce((a, b) => a + b);
  const mean = weights.reduce((a, w, i) => a + w * quest.grid[i], 0) / sum;
  const variance = weights.reduce((a, w, i) => a + w * (quest.grid[i] - mean) ** 2, 0) / sum;
  return {mean, deviation: Math.sqrt(variance)};
}

// Returns the level to ask at: the one nearest to the estimate, but never the reference itself.
function questLevel(quest, levels) {
  const {mean} = questEstimate(quest);
  let best = 0;
  for (let i = 0; i + 1 < levels.length; ++i)
    if (Math.abs(intensityOf(levels[i]) - mean) < Math.abs(intensityOf(levels[best]) - mean)) best = i;
  return best;
}

// Returns the threshold in spp, within the ladder, and its standard deviation in octaves.
function questThreshold(quest, levels) {
  const {mean, deviation} = questEstimate(quest);
  const spp = Math.min(levels[levels.length - 1], Math.max(levels[0], 10 ** (-2 * mean)));
  return {spp: Math.round(spp), octaves: 2 * deviation / Math.log10(2)};
}
