// @ts-check
import { Assist } from './assist.js';
import { Clock } from './clock.js';
import { Bounds } from './curves.js';
import { element } from './data.js';
import { Editor } from './editor.js';
import { Problems } from './problems.js';
import { Refused, language, latest, listen, post } from './server.js';
import { Sliders } from './sliders.js';
import { Stage } from './stage.js';
// The studio: the text on the left, the mechanism in the middle, its bounds on the right.

/** @typedef {{path: string, name: string, uri: string}} File */
/** @typedef {{file: File, text: string, unsaved: boolean, scroll: number}} Open */

/** How long nothing is typed before the text is sent, ms. */
const PAUSE = 120;

const STAGES = { nominal: 'the nominal motion', coarse: 'coarse bounds, by polynomials of degree one', asked: 'bounds as the model asks for them' };

const byId = (/** @type {string} */ id) => /** @type {HTMLElement} */ (document.getElementById(id));
const save = /** @type {HTMLButtonElement} */ (byId('save'));
const report = /** @type {HTMLButtonElement} */ (byId('report'));
const progress = /** @type {HTMLProgressElement} */ (byId('progress'));

/** @type {Map<string, Open>} */
const files = new Map();
/** @type {File[]} */
let named = [];
let current = '';
/** The model as it could be read last. @type {any} */
let model = null;
/** @type {Record<string, import('./overlay.js').Problem[]>} */
let diagnostics = {};
/** Changes on the disk that were told, by path. @type {Map<string, number>} */
const followed = new Map();
let clock = new Clock(0);
/** @type {{number: number, curves: any} | null} */
let nominal = null;

const editor = new Editor(byId('editor'), () => typed());
const assist = new Assist(editor, () => files.get(current)?.file.uri || '', sent, (place) => go(place.uri, place.range));
const problems = new Problems(byId('problems'), go, (uri, edits) => change(uri, edits));
const sliders = new Sliders(byId('sliders'), (values) => sampled(values));
const stage = new Stage(byId('stage'), () => sliders.values);
const bounds = new Bounds(byId('bounds'), byId('outputs'));

/** Says something across the page. @param {string} text @param {HTMLElement[]} [more] */
function notice(text, more = []) {
  const holder = byId('notice');
  holder.hidden = text === '';
  holder.replaceChildren(text, ...more);
}

/** @param {string} label @param {() => void} act */
function button(label, act) {
  const made = element('button', { type: 'button' }, [label]);
  made.addEventListener('click', act);
  return made;
}

// The text.

/** @type {ReturnType<typeof setTimeout> | undefined} */
let waiting;
/** The last text that was sent, and when that has arrived. */
let arrived = Promise.resolve();

function typed() {
  const open = files.get(current);
  if (!open) return;
  open.text = editor.text;
  open.unsaved = true;
  tabs();
  clearTimeout(waiting);
  waiting = setTimeout(send, PAUSE);
}

function send() {
  const open = files.get(current);
  waiting = undefined;
  if (!open) return arrived;
  const { file, text } = open;
  arrived = arrived.then(async () => {
    const { unsaved } = await post('text', { path: file.path, text });
    if (open.text === text) open.unsaved = unsaved;
    tabs();
  }).catch((error) => notice(error.message));
  return arrived;
}

/** Resolves when the studio has the text as it is. */
async function sent() {
  if (waiting !== undefined) {
    clearTimeout(waiting);
    await send();
  }
  await arrived;
}

function tabs() {
  const own = files.get(current);
  save.disabled = !own?.unsaved;
  const made = named.map((file) => {
    const tab = element('button', { type: 'button', title: file.path, 'aria-pressed': String(file.path === current) }, [`${file.name}${files.get(file.path)?.unsaved ? ' •' : ''}`]);
    tab.addEventListener('click', () => show(file));
    return tab;
  });
  byId('files').replaceChildren(...made);
}

/** Shows a file. @param {File} file */
async function show(file) {
  const before = files.get(current);
  if (before) before.scroll = editor.area.scrollTop;
  await sent();
  if (!files.has(file.path)) {
    try {
      const { text, unsaved } = await post('open', { path: file.path });
      files.set(file.path, { file, text, unsaved, scroll: 0 });
    } catch (error) {
      return notice(/** @type {Error} */ (error).message);
    }
  }
  current = file.path;
  const open = /** @type {Open} */ (files.get(current));
  editor.show(open.text, open.scroll);
  mark();
  tabs();
  outline();
}

/** The file of an address of the language server. @param {string} uri */
const fileOf = (uri) => named.find((file) => file.uri === uri);

/** @param {string} uri @param {any} range */
async function go(uri, range) {
  const file = fileOf(uri);
  if (!file) return;
  if (file.path !== current) await show(file);
  editor.select(range);
}

/** Makes changes of the language server in a file. @param {string} uri @param {any[]} edits */
async function change(uri, edits) {
  const file = fileOf(uri);
  if (!file) return;
  if (file.path !== current) await show(file);
  editor.edit(edits);
}

async function store() {
  await sent();
  const open = files.get(current);
  if (!open) return;
  try {
    await post('save', { path: open.file.path });
    open.unsaved = false;
    notice('');
  } catch (error) {
    const { message, status } = /** @type {Refused} */ (error);
    notice(`${message} `, status === 409 ? [button('Load it from the disk', () => load(open))] : []);
  }
  tabs();
}

/** Takes a text from the disk again. @param {Open} open */
async function load(open) {
  const { text, unsaved } = await post('load', { path: open.file.path });
  Object.assign(open, { text, unsaved });
  notice('');
  if (open.file.path === current) editor.show(text);
  tabs();
}

async function format() {
  await sent();
  const uri = files.get(current)?.file.uri;
  if (!uri) return;
  const edits = await language('formatting', { textDocument: { uri }, options: { tabSize: 2, insertSpaces: true } }).catch((error) => notice(error.message));
  if (edits?.length) editor.edit(edits);
}

async function outline() {
  // Diagnostics may come before the first file is shown.
  const uri = files.get(current)?.file.uri;
  if (!uri) return;
  /** @type {any[]} */
  const symbols = (await language('documentSymbol', { textDocument: { uri } }).catch(() => null)) || [];
  const select = /** @type {HTMLSelectElement} */ (byId('outline').querySelector('select'));
  /** @type {any[]} */
  const places = [];
  /** @type {(own: any[], depth: number) => HTMLElement[]} */
  const options = (own, depth) => own.flatMap((symbol) => {
    places.push(symbol);
    const option = element('option', { value: String(places.length - 1) }, [`${'\u2003'.repeat(depth)}${symbol.name}`]);
    return [option, ...(depth < 1 ? options(symbol.children || [], depth + 1) : [])];
  });
  const made = options(symbols, 0);
  select.replaceChildren(element('option', { value: '' }, ['Outline']), ...made);
  select.onchange = () => {
    const symbol = places[Number(select.value)];
    if (select.value !== '' && symbol) editor.select(symbol.selectionRange);
    select.value = '';
  };
}

function mark() {
  const own = files.get(current);
  editor.mark((own && diagnostics[own.file.uri]) || []);
}

function list() {
  problems.show(named.flatMap(({ uri, name }) => (diagnostics[uri] || []).map((problem) => ({ uri, name, problem }))));
}

/** Texts that another program has changed on the disk. @param {Record<string, {change: number, text: string | null}>} found */
function follow(found) {
  for (const [path, { change: number, text }] of Object.entries(found)) {
    const open = files.get(path);
    if (!open || followed.get(path) === number) continue;
    followed.set(path, number);
    if (text === null || open.unsaved) {
      notice(`${open.file.name} has changed on the disk, and your text is not saved. `, [button('Load it from the disk', () => load(open))]);
    } else if (open.text !== text) {
      open.text = text;
      if (path === current) editor.show(text, editor.area.scrollTop, editor.area.selectionStart);
    }
  }
}

// The sample of the sliders.

const simulate = latest(
  async (/** @type {{number: number, values: number[]}} */ question) => {
    const begun = performance.now();
    if (nominal?.number !== question.number) {
      const values = model.parameters.map((/** @type {any} */ own) => own.nominal);
      nominal = { number: question.number, curves: await post('sample', { number: question.number, values }) };
    }
    const sample = await post('sample', question);
    return { sample, took: performance.now() - begun };
  },
  ({ sample, took }) => {
    if (sliders.isNominal) return;
    bounds.overlay({ sample, nominal: nominal?.curves || null });
    sliders.tell(`simulated in ${took < 1000 ? `${took.toFixed(0)} ms` : `${(took / 1000).toFixed(1)} s`}${sample.stopped ? ', stops before the end' : ''}`);
  },
  (error) => sliders.tell(error.message),
);

/** @param {number[] | null} values */
function sampled(values) {
  if (!model) return;
  if (!values) {
    bounds.overlay(null);
    stage.follow(null);
    sliders.tell('');
    return;
  }
  simulate({ number: model.number, values: [...values] });
  if (stage.movie) stage.sample([...values]);
}

// What the studio says.

/** @param {any} found */
function showModel(found) {
  if (found.files) {
    const isFirst = named.length === 0;
    named = found.files;
    if (isFirst) show(named[0]);
    tabs();
  }
  const isWrong = found.state === 'wrong';
  document.body.classList.toggle('wrong', isWrong);
  byId('state').textContent = isWrong ? `The text has errors${model ? ': the picture and the bounds are of the last text without' : ''}` : '';
  if (found.error) notice(found.error);
  if (isWrong) return;
  const isOther = model?.name !== found.name;
  model = found;
  document.title = `${model.name} – mbint studio`;
  byId('name').textContent = model.name;
  const scenes = byId('scenes');
  scenes.hidden = model.scenes.length === 0;
  const select = /** @type {HTMLSelectElement} */ (scenes.querySelector('select'));
  select.replaceChildren(...model.scenes.map((/** @type {string} */ name) => element('option', name === model.scene ? { selected: '' } : {}, [name])));
  select.onchange = () => post('scene', { scene: select.value }).catch((error) => notice(error.message));
  const { time } = clock;
  clock.pause();
  clock = new Clock(model.duration);
  if (!isOther) clock.seek(time);
  report.disabled = true;
  bounds.curves = null;
  sliders.show(model.parameters);
}

/** @param {any} found */
function showMechanism(found) {
  if (found.number !== model?.number) return;
  stage.show(found, clock);
  if (!sliders.isNominal && found.motion) sampled(sliders.values);
}

/** @param {any} found */
function showBounds(found) {
  if (found.number !== model?.number) return;
  byId('stage-name').textContent = STAGES[/** @type {keyof STAGES} */ (found.stage)];
  bounds.number = found.number;
  if (found.html) bounds.show(found.html, clock);
  else bounds.say(found.error, found.waits ? [button('Run it', () => post('allow').catch((error) => notice(error.message)))] : []);
  report.disabled = !(found.stage === 'asked' && found.html);
}

/** @param {any} found */
function showProgress(found) {
  progress.hidden = !found || found.number !== model?.number;
  if (!found || progress.hidden) return;
  progress.value = found.fraction;
  progress.title = STAGES[/** @type {keyof STAGES} */ (found.stage)];
}

save.addEventListener('click', store);
byId('format').addEventListener('click', format);
report.addEventListener('click', () => open('report', '_blank', 'noopener'));
addEventListener('beforeunload', (event) => {
  if ([...files.values()].some(({ unsaved }) => unsaved)) event.preventDefault();
});
addEventListener('keydown', (event) => {
  if ((event.ctrlKey || event.metaKey) && event.key === 's') store();
  else if (event.altKey && event.shiftKey && event.code === 'KeyF') format();
  else return;
  event.preventDefault();
});

listen(
  (topics) => {
    if ('model' in topics) showModel(topics.model);
    if ('diagnostics' in topics) {
      diagnostics = topics.diagnostics;
      mark();
      list();
      outline();
    } else if ('model' in topics) list();
    if ('disk' in topics) follow(topics.disk);
    if ('mechanism' in topics) showMechanism(topics.mechanism);
    if ('bounds' in topics) showBounds(topics.bounds);
    if ('progress' in topics) showProgress(topics.progress);
  },
  () => notice('The studio has ended: what is typed from now on cannot be saved here.'),
);

Object.assign(globalThis, { studio: { editor, stage, sliders, bounds, files, clock: () => clock, model: () => model } });
