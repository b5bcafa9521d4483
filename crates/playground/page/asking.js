// @ts-check
// A worker that is asked one question at a time, and is replaced where it stops or is stopped.

/** @typedef {import('./engine.js').Question} Question */
/** @typedef {import('./engine.js').Answer} Answer */

export class Asking {
  /** @param {WebAssembly.Module} module */
  constructor(module) {
    this.module = module;
    /** @type {Worker | null} */
    this.worker = null;
    /** Ends the question that is being answered. @type {((why: Error) => void) | null} */
    this.end = null;
  }

  begun() {
    const worker = new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
    worker.postMessage({ module: this.module });
    return worker;
  }

  /** An older question is given up. @param {Question} question @param {(stage: string, fraction: number) => void} [told] @returns {Promise<Answer>} */
  ask(question, told = () => {}) {
    this.stop('another question came');
    const worker = this.worker || this.begun();
    this.worker = worker;
    return new Promise((resolve, reject) => {
      const ended = () => {
        this.end = null;
        worker.onmessage = null;
        worker.onerror = null;
      };
      this.end = (why) => {
        ended();
        worker.terminate();
        this.worker = null;
        reject(why);
      };
      worker.onerror = (event) => this.end?.(new Error(event.message || 'the worker could not be started'));
      worker.onmessage = ({ data }) => {
        if (data.stage !== undefined) return told(data.stage, data.fraction);
        if (data.stopped !== undefined) return this.end?.(new Error(data.stopped));
        ended();
        resolve(data.answer);
      };
      worker.postMessage({ question });
    });
  }

  /** Gives up what is being answered. @param {string} why */
  stop(why) {
    this.end?.(new Error(why));
  }
}
