// @ts-check
import { Asking } from './asking.js';
import { element } from './data.js';
import { Editor } from './editor.js';
import { Results } from './results.js';
// The playground of the book: a model is chosen or comes with the address, is edited, checked while it is typed, and run.

/** @typedef {import('./engine.js').Answer} Answer */
/** @typedef {import('./engine.js').Diagnostic} Diagnostic */
/** @typedef {{text: string, folder: string, name: string}} Sheet a text, and where it is among the files */

/** A text is checked when nothing is typed for so long, ms. */
const PAUSE = 250;

/** The model that is shown first. */
const FIRST = 'models/slider_crank.yaml';

/** Examples of the book name files from here. */
const EXAMPLE = 'docs/examples/example.yaml';

class Playground {
  /** @param {HTMLElement} holder @param {WebAssembly.Module} module @param {Record<string, string>} files */
  constructor(holder, module, files) {
    this.files = files;
    this.path = FIRST;
    this.checking = new Asking(module);
    this.running = new Asking(module);
    this.timer = 0;
    const models = Object.keys(files).filter((path) => /^models\/[^/]*$/.test(path));
    this.models = select('Model', models.map((path) => [path, path.replace('models/', '').replace('.yaml', '')]));
    this.scenes = select('Scene', []);
    this.scene = label('Scene', this.scenes);
    this.scene.hidden = true;
    this.run = button('Run', 'primary');
    this.stop = button('Stop');
    this.link = button('Link');
    this.link.title = 'Puts this text into the address, to be passed on';
    this.state = element('span', { class: 'state', role: 'status' });
    this.bar = /** @type {HTMLProgressElement} */ (element('progress', { max: '1', value: '0' }));
    const sheet = element('div', { class: 'editor' });
    this.problems = element('div', { class: 'problems' });
    this.results = new Results(element('section', { class: 'results', 'aria-label': 'Results' }));
    holder.replaceChildren(
      element('div', { class: 'bar' }, [label('Model', this.models), this.scene, this.run, this.stop, this.link, this.bar, this.state]),
      element('div', { class: 'sides' }, [element('section', { class: 'text', 'aria-label': 'Text' }, [sheet, this.problems]), this.results.holder]),
    );
    this.editor = new Editor(sheet, () => this.typed());
    this.models.addEventListener('change', () => this.open(this.models.value, this.files[this.models.value]));
    this.scenes.addEventListener('change', () => this.results.age());
    this.run.addEventListener('click', () => this.start(false));
    this.stop.addEventListener('click', () => this.running.stop('stopped'));
    this.link.addEventListener('click', () => history.replaceState(null, '', `#text=${encodeURIComponent(this.editor.text)}`));
    this.editor.area.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter' || !(event.ctrlKey || event.metaKey)) return;
      event.preventDefault();
      this.start(false);
    });
    addEventListener('hashchange', () => this.fromAddress());
    this.busy(false);
    this.fromAddress();
  }

  /** What the address asks for: `#NAME` a shipped model, `#text=…` a text, `#run=…` one that is run at once. */
  fromAddress() {
    const asked = decoded(location.hash.slice(1));
    const [, kind, text] = asked.match(/^(text|run)=([^]*)$/) || [];
    const path = [`models/${asked}.yaml`, `models/${asked}`].find((path) => path in this.files) || FIRST;
    if (kind) this.open(EXAMPLE, text);
    else this.open(path, this.files[path]);
    if (kind === 'run') this.start(false);
  }

  /** @param {string} path @param {string} text */
  open(path, text) {
    this.running.stop('stopped');
    this.path = path;
    this.models.value = path in this.files ? path : '';
    this.editor.show(text);
    this.results.clear();
    this.tell('');
    this.check();
  }

  typed() {
    this.results.age();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.check(), PAUSE);
  }

  /** @param {'check' | 'run'} task @param {boolean} costly @returns {import('./engine.js').Question} */
  question(task, costly) {
    const files = { ...this.files, [this.path]: this.editor.text };
    return { task, model: this.path, files, costly, ...(this.scenes.value ? { scene: this.scenes.value } : {}) };
  }

  async check() {
    const text = this.editor.text;
    const answer = await this.checking.ask(this.question('check', false)).catch((/** @type {Error} */ error) => error);
    if (text !== this.editor.text) return;
    if (answer instanceof Error) this.tell(answer.message, true);
    else this.read(answer);
  }

  /** @param {Answer} answer */
  read(answer) {
    const { diagnostics, scenes, scene } = answer;
    const own = diagnostics.filter(({ file, line }) => line !== null && file === this.path);
    this.editor.mark(own.map((found) => this.marked(found)));
    const rows = diagnostics.map((found) => this.problem(found));
    this.problems.replaceChildren(...(rows.length ? [element('ul', {}, rows)] : []));
    if (answer.name === undefined) return;
    const known = [...this.scenes.options].map((option) => option.value);
    if (known.join('\n') === scenes.join('\n')) return;
    this.scenes.replaceChildren(...scenes.map((name) => option(name, name)));
    if (scene !== undefined) this.scenes.value = scene;
    this.scene.hidden = scenes.length === 0;
  }

  /** The word at the place of a diagnostic. @param {Diagnostic} found */
  marked({ line, column, severity, message }) {
    const start = { line: Number(line) - 1, character: Number(column) - 1 };
    const rest = [...(this.editor.text.split('\n')[start.line] || '')].slice(start.character).join('');
    const [word] = rest.match(/^(?:[\w.]+|"[^"]*"|'[^']*')/) || [rest.slice(0, 1)];
    const end = { line: start.line, character: start.character + word.length };
    return { range: { start, end }, severity: severity === 'warning' ? 2 : 1, message };
  }

  /** @param {Diagnostic} found */
  problem(found) {
    const { severity, message, file, line, column, help } = found;
    const place = line === null ? file : `${file === this.path ? '' : `${file}:`}${line}:${column}`;
    const jump = element('button', { type: 'button', class: 'jump' }, [element('b', {}, [severity]), ' ', element('code', {}, [place]), ` ${message}`]);
    if (line !== null && file === this.path) jump.addEventListener('click', () => this.editor.select(this.marked(found).range));
    return element('li', { class: severity }, [jump, ...(help ? [element('small', {}, [help])] : [])]);
  }

  /** Runs the text. @param {boolean} costly whether it may take long */
  async start(costly) {
    const { text } = this.editor;
    this.busy(true);
    this.tell('reading');
    const begun = performance.now();
    const told = (/** @type {string} */ stage, /** @type {number} */ fraction) => {
      this.tell(stage);
      this.bar.value = fraction;
    };
    const answer = await this.running.ask(this.question('run', costly), told).catch((/** @type {Error} */ error) => error);
    if (this.running.end) return;
    this.busy(false);
    if (answer instanceof Error) return this.tell(answer.message, answer.message !== 'stopped');
    this.read(answer);
    const seconds = ((performance.now() - begun) / 1000).toFixed(2);
    if (answer.summary === undefined) {
      this.tell(answer.error || 'the text has errors: see below it', true);
      if (answer.waits) this.offer();
      return;
    }
    this.results.show(answer);
    if (text !== this.editor.text) this.results.age();
    this.tell(`${seconds} s`);
  }

  /** Offers to run what takes long. */
  offer() {
    const anyway = button('Run it anyway', 'primary');
    anyway.addEventListener('click', () => this.start(true));
    this.state.append(' ', anyway);
  }

  /** @param {boolean} is */
  busy(is) {
    this.stop.disabled = !is;
    this.bar.hidden = !is;
    this.bar.value = 0;
  }

  /** @param {string} text @param {boolean} [isWrong] */
  tell(text, isWrong = false) {
    this.state.textContent = text;
    this.state.classList.toggle('wrong', isWrong);
  }
}

/** @param {string} text */
function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

/** @param {string} text @param {string} [kind] */
const button = (text, kind = '') => /** @type {HTMLButtonElement} */ (element('button', { type: 'button', class: kind }, [text]));

/** @param {string} value @param {string} name */
const option = (value, name) => element('option', { value }, [name]);

/** @param {string} name @param {string[][]} options */
const select = (name, options) => /** @type {HTMLSelectElement} */ (element('select', { 'aria-label': name }, options.map(([value, shown]) => option(value, shown))));

/** @param {string} text @param {HTMLElement} of */
const label = (text, of) => element('label', {}, [`${text} `, of]);

/** The module and the shipped models, which are beside this script; null where the book was built without them. */
async function parts() {
  const [engine, models] = await Promise.all(['mbint.wasm', 'models.json'].map((name) => fetch(new URL(name, import.meta.url))));
  if (!engine.ok || !models.ok) return null;
  // Not every server knows the type of a module.
  return { module: await WebAssembly.compile(await engine.arrayBuffer()), files: await models.json() };
}

const holder = document.getElementById('mbint-playground');
if (holder) {
  for (const name of ['editor.css', 'playground.css']) document.head.append(element('link', { rel: 'stylesheet', href: String(new URL(name, import.meta.url)) }));
  const found = await parts();
  if (found) Object.assign(globalThis, { playground: new Playground(holder, found.module, found.files) });
}
