// @ts-check
import { Clock } from './clock.js';
import { length, options, player } from './controls.js';
import { element, readData } from './data.js';
import { Movie } from './motion.js';
import { Window, bringToLife } from './plots.js';
import { addSlopes } from './slopes.js';
import { View } from './view.js';
// The page: one scene at a time, its mechanism and its plots under one clock.

/** @typedef {{clock: Clock, view: View | null, movie: Movie | null, plots: import('./plots.js').Plot[], stage: HTMLElement | null}} Running */

const scenes = readData();
/** @type {Map<number, Running>} */
const running = new Map();
let current = 0;

/** The mechanism's part of a scene, in place of its still picture. @param {HTMLElement} article @param {Movie} movie @param {Clock} clock */
function stageOf(article, movie, clock) {
  const canvas = /** @type {HTMLCanvasElement} */ (element('canvas', { tabindex: '0', role: 'img', 'aria-label': 'The mechanism. Drag to turn or move it, turn the wheel to come nearer.' }));
  const gl = canvas.getContext('webgl2', { antialias: true, alpha: false, preserveDrawingBuffer: true });
  const still = article.querySelector('.still');
  // It stays in view beside longer plots, and within its own row.
  const pinned = element('div', { class: 'pinned' });
  const stage = element('section', { class: 'stage' }, [pinned]);
  const picture = element('div', { class: 'picture' });
  still?.after(stage);
  let view = null;
  // One configuration does not play.
  const players = clock.duration > 0 ? [player(clock)] : [];
  if (gl) {
    view = new View(picture, movie, clock, gl, canvas);
    still?.classList.add('replaced');
    const note = `${movie.times.length} of ${movie.rows} computed instants; straight lines between them are off by ${length(movie.between)} at most.`;
    const notes = clock.duration > 0 ? [element('small', { class: 'note' }, [note])] : [];
    pinned.append(picture, ...players, options(view), ...notes);
  } else {
    pinned.append(...players, element('small', { class: 'note' }, ['This browser shows no WebGL: the mechanism is drawn at its start only.']));
  }
  return { view, stage };
}

/** Buttons for the outputs of a scene, where it has several. @param {HTMLElement} article @param {string[]} outputs */
function outputSwitch(article, outputs) {
  const figures = [...article.querySelectorAll('figure[data-output]')];
  if (figures.length < 2) return;
  const show = (/** @type {number} */ chosen) => {
    figures.forEach((figure, place) => figure.classList.toggle('hidden', chosen >= 0 && place !== chosen));
    buttons.forEach((button, place) => button.setAttribute('aria-pressed', String(place - 1 === chosen)));
  };
  const buttons = ['all outputs', ...outputs].map((name, place) => {
    const button = element('button', { type: 'button', title: name }, [name]);
    button.addEventListener('click', () => show(place - 1));
    return button;
  });
  article.querySelector('.plots')?.prepend(element('nav', { class: 'switch', 'aria-label': 'Outputs' }, buttons));
  show(0);
}

/** @param {number} number */
function start(number) {
  const scene = scenes[number];
  const article = /** @type {HTMLElement} */ (document.querySelector(`.scene[data-scene="${number}"]`));
  const clock = new Clock(scene.duration);
  const movie = scene.motion ? new Movie(scene.motion) : null;
  const { view, stage } = movie ? stageOf(article, movie, clock) : { view: null, stage: null };
  outputSwitch(article, scene.outputs);
  const plots = bringToLife(article, clock, new Window(0, scene.duration));
  addSlopes(plots, scene.derivatives);
  return { clock, view, movie, plots, stage };
}

/** @param {number} number */
function show(number) {
  const before = running.get(current);
  before?.clock.pause();
  document.querySelectorAll('.scene').forEach((article, place) => article.classList.toggle('hidden', place !== number));
  document.querySelectorAll('#scenes button').forEach((button, place) => button.setAttribute('aria-pressed', String(place === number)));
  const now = running.get(number) || start(number);
  running.set(number, now);
  if (before && current !== number) now.clock.seek(before.clock.time);
  current = number;
  now.view?.changed();
}

/** A checkbox of the scene that is shown. @param {string} id */
const press = (id) => /** @type {HTMLElement | null} */ (document.querySelector(`.scene:not(.hidden) [id="${id}"]`))?.click();

/** Keys that mean the same everywhere but where they are typed into something. @param {KeyboardEvent} event */
function key(event) {
  const { clock, view } = /** @type {Running} */ (running.get(current));
  const target = /** @type {Element} */ (event.target);
  if (event.ctrlKey || event.metaKey || event.altKey || target.matches('input:not([type="checkbox"]), select, textarea')) return;
  /** @type {Record<string, () => void>} */
  const acts = {
    ' ': () => clock.toggle(),
    ArrowLeft: () => clock.step(-0.005),
    ArrowRight: () => clock.step(0.005),
    PageUp: () => clock.step(-0.1),
    PageDown: () => clock.step(0.1),
    Home: () => clock.step(-1),
    End: () => clock.step(1),
    0: () => view?.resetCamera(),
    g: () => press('ghosts'),
    t: () => press('traced'),
    f: () => press('forces'),
  };
  const act = acts[event.key];
  if (!act || (event.key === ' ' && target.matches('button, summary, input'))) return;
  event.preventDefault();
  act();
}

function begin() {
  document.documentElement.classList.add('alive');
  if (scenes.length > 1) {
    const buttons = scenes.map(({ name }, number) => {
      const button = element('button', { type: 'button', title: name }, [name]);
      button.addEventListener('click', () => show(number));
      return button;
    });
    document.getElementById('scenes')?.append(...buttons);
  }
  document.addEventListener('keydown', key);
  show(0);
  // Nothing moves by itself: who wants to see motion asks for it, and so does who wants less of it.
  Object.assign(globalThis, { mbint: { scenes, running, show, current: () => running.get(current) } });
}

if (scenes.length > 0) begin();
