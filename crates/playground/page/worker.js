// @ts-check
import { Engine } from './engine.js';
// A worker: it is given the module, then questions. What it says is progress, an answer, or why it stopped; then the
// page ends it.

/** Progress that comes faster is not told, ms. */
const PAUSE = 60;

/** @type {Engine | null} */
let engine = null;
let told = 0;

self.addEventListener('message', ({ data }) => {
  try {
    if (data.module) {
      engine = new Engine(data.module, (stage, fraction) => {
        const now = performance.now();
        if (fraction > 0 && now - told < PAUSE) return;
        told = now;
        self.postMessage({ stage, fraction });
      });
      return;
    }
    self.postMessage({ answer: engine?.ask(data.question) });
  } catch (error) {
    self.postMessage({ stopped: error instanceof Error ? error.message : String(error) });
  }
});
