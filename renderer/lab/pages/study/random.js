"use strict";
// Random numbers that a seed decides, so that a session can be played again from its answers.

// FNV-1a, 32 bits (Fowler, Noll, Vo).
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
