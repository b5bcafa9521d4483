// @ts-check
// The module of WebAssembly: questions and answers over its memory. It runs in a worker, and in node for tests.

/** @typedef {{task: 'check' | 'run', model: string, files: Record<string, string>, scene?: string, costly?: boolean}} Question */
/** @typedef {{severity: 'error' | 'warning', message: string, file: string, line: number | null, column: number | null, help: string | null}} Diagnostic */
/** @typedef {{name?: string, scenes: string[], scene?: string, diagnostics: Diagnostic[], error?: string, waits: boolean, summary?: string, warnings: string[], files: Record<string, string>}} Answer */

/** Why an instance stopped. Nothing of it is used again. */
export class Stopped extends Error {}

export class Engine {
  /** @param {WebAssembly.Module} module @param {(stage: string, fraction: number) => void} told of progress */
  constructor(module, told) {
    /** What the instance said of its end. */
    this.last = '';
    const page = {
      seconds: () => performance.now() / 1000,
      progress: (/** @type {number} */ at, /** @type {number} */ length, /** @type {number} */ fraction) => told(this.text(at, length), fraction),
      panicked: (/** @type {number} */ at, /** @type {number} */ length) => {
        this.last = `an internal error, please report it with the model: ${this.text(at, length)}`;
      },
      exhausted: (/** @type {number} */ bytes) => {
        this.last = `the model takes more memory than a page has (${((this.memory.buffer.byteLength + bytes) / 1e9).toFixed(1)} GB): ask for fewer outputs or rows, or run it with \`mbint run\``;
      },
    };
    /** @type {any} */
    this.functions = new WebAssembly.Instance(module, { page }).exports;
    /** @type {WebAssembly.Memory} */
    this.memory = this.functions.memory;
  }

  /** @param {number} at @param {number} length */
  text(at, length) {
    // Functions of addresses are signed in JavaScript.
    return new TextDecoder().decode(new Uint8Array(this.memory.buffer, at >>> 0, length >>> 0));
  }

  /** @param {Question} question @returns {Answer} */
  ask(question) {
    const bytes = new TextEncoder().encode(JSON.stringify(question));
    try {
      const at = this.functions.allocate(bytes.length) >>> 0;
      new Uint8Array(this.memory.buffer, at, bytes.length).set(bytes);
      const answer = this.functions.ask(at, bytes.length) >>> 0;
      const length = new DataView(this.memory.buffer).getUint32(answer, true);
      const text = this.text(answer + 4, length);
      this.functions.release(answer);
      return JSON.parse(text);
    } catch (error) {
      const deep = error instanceof RangeError ? 'the model is too deep for a page: run it with `mbint run`' : String(error);
      throw new Stopped(this.last || deep);
    }
  }
}
