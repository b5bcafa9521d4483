// @ts-check
import { digits, element } from './data.js';
// The buttons and sliders below the mechanism.

/** @typedef {import('./clock.js').Clock} Clock */
/** @typedef {import('./view.js').View} View */

/** @param {string} label @param {string} title @param {() => void} act */
function button(label, title, act) {
  const made = element('button', { type: 'button', title, 'aria-label': title }, [label]);
  made.addEventListener('click', act);
  return made;
}

/** @param {string} label @param {string[]} options @param {(chosen: number) => void} act @param {number} [chosen] */
function choice(label, options, act, chosen = 0) {
  const select = /** @type {HTMLSelectElement} */ (element('select', {}, options.map((name, place) => element('option', { value: String(place) }, [name]))));
  select.selectedIndex = chosen;
  select.addEventListener('change', () => act(select.selectedIndex));
  return element('label', {}, [element('span', {}, [label]), select]);
}

/** @param {string} id @param {string} label @param {boolean} checked @param {(checked: boolean) => void} act */
function checkbox(id, label, checked, act) {
  const box = /** @type {HTMLInputElement} */ (element('input', { type: 'checkbox', id }));
  box.checked = checked;
  box.addEventListener('change', () => act(box.checked));
  return element('label', {}, [box, label]);
}

/** Play, scrub, step, speed. @param {Clock} clock */
export function player(clock) {
  const play = button('▶', 'Play (space)', () => clock.toggle());
  play.id = 'play';
  const scrub = /** @type {HTMLInputElement} */ (element('input', { type: 'range', id: 'scrub', min: '0', max: String(clock.duration), step: 'any', value: '0', 'aria-label': 'Time' }));
  scrub.addEventListener('input', () => {
    const wanted = Number(scrub.value);
    // What listens to the pause puts the slider back.
    clock.pause();
    clock.seek(wanted);
  });
  const time = element('output', { class: 'time' });
  const speeds = [0.02, 0.05, 0.1, 0.25, 0.5, 1, 2, 4];
  const speed = choice('Speed', speeds.map((factor) => `× ${factor}`), (place) => (clock.speed = speeds[place]), speeds.indexOf(clock.speed));
  const update = () => {
    play.textContent = clock.playing ? '❚❚' : '▶';
    play.setAttribute('aria-label', clock.playing ? 'Pause (space)' : 'Play (space)');
    scrub.value = String(clock.time);
    scrub.setAttribute('aria-valuetext', `${digits(clock.time)} s`);
    time.textContent = `${clock.time.toFixed(Math.max(0, Math.min(20, 3 - Math.floor(Math.log10(clock.duration)))))} s`;
  };
  clock.listen(update);
  update();
  return element('div', { class: 'player' }, [
    button('«', 'To the start (Home)', () => clock.step(-1)),
    button('‹', 'A step back (←)', () => clock.step(-0.005)),
    play,
    button('›', 'A step on (→)', () => clock.step(0.005)),
    scrub,
    time,
    speed,
  ]);
}

/** Controls of the uncertainty's display. @param {View} view */
export function options(view) {
  const { movie, mechanism } = view;
  const holder = element('div', { class: 'options' });
  if (movie.samples.length > 0) {
    const ghosts = checkbox('ghosts', `${movie.samples.length} samples`, view.ghosts, (ghosts) => view.set({ ghosts }));
    const scale = element('span', { class: 'scale' });
    const tell = (/** @type {number} */ axis) => {
      const { lower, upper, unit } = movie.parameters[axis];
      scale.replaceChildren(digits(lower), element('i', { 'aria-hidden': 'true' }), `${digits(upper)} ${unit}`);
    };
    tell(0);
    const colors = choice('by', movie.parameters.map(({ name }) => name), (axis) => {
      view.set({ colorBy: axis });
      tell(axis);
    });
    const factors = [1, 2, 5, 10, 20, 50, 100];
    const exaggerate = choice('Deviations', factors.map((factor) => `× ${factor}`), (place) => view.set({ exaggeration: factors[place] }));
    exaggerate.id = 'exaggerate';
    holder.append(element('div', { class: 'row' }, [ghosts, colors, scale, exaggerate]));
  }
  const names = ['nothing', ...mechanism.named.map(({ name }) => name)];
  const swept = choice('Swept by', names, (place) => view.set({ swept: place - 1 }));
  swept.id = 'swept';
  const traced = checkbox('traced', 'Traces of points', view.traced, (traced) => view.set({ traced }));
  const forces = checkbox('forces', 'Forces', view.forces, (forces) => view.set({ forces }));
  const shown = [...(movie.duration > 0 ? [traced] : []), ...(movie.forces.length > 0 ? [forces] : [])];
  holder.append(element('div', { class: 'row' }, [swept, ...shown, button('⤢', 'Whole mechanism (0)', () => view.resetCamera())]));
  if (movie.worst.length > 0) {
    const named = movie.worst.map(({ name, time }) => (time === undefined ? name : `${name} at ${digits(time)} s`));
    const worst = choice('Worst functions for', ['nothing', ...named], (place) => view.set({ worst: place - 1 }));
    worst.id = 'worst';
    holder.append(element('div', { class: 'row' }, [worst]));
  }
  if (movie.polynomials) holder.append(sliders(view));
  return holder;
}

/** One ghost that follows two parameters. @param {View} view */
function sliders(view) {
  const { parameters, polynomials } = view.movie;
  const holder = element('fieldset', { class: 'what-if' }, [element('legend', {}, ['What if'])]);
  const nominal = parameters.map(({ nominal: value, lower, upper }) => (upper > lower ? (2 * value - lower - upper) / (upper - lower) : 0));
  const xi = [...nominal];
  /** @type {(() => void)[]} */
  const updates = [];
  const act = () => view.set({ xi: xi.some((x, axis) => x !== nominal[axis]) ? [...xi] : null });
  [0, 1].slice(0, parameters.length).forEach((first, place) => {
    let axis = first;
    const slider = /** @type {HTMLInputElement} */ (element('input', { type: 'range', min: '-1', max: '1', step: '0.01', class: 'parameter', 'aria-label': `Value of parameter ${place + 1}` }));
    const value = element('output');
    const update = () => {
      const { lower, upper, unit, nominal: known } = parameters[axis];
      const now = lower + (0.5 + 0.5 * xi[axis]) * (upper - lower);
      slider.value = String(xi[axis]);
      const percent = known === 0 || Math.abs(now - known) < 1e-9 * (upper - lower) ? '' : ` (${now >= known ? '+' : '−'}${digits(Math.abs((100 * (now - known)) / known))} %)`;
      value.textContent = `${digits(now)} ${unit}${percent}`;
      slider.setAttribute('aria-valuetext', value.textContent);
    };
    slider.addEventListener('input', () => {
      xi[axis] = Number(slider.value);
      update();
      act();
    });
    const which = choice('', parameters.map(({ name }) => name), (chosen) => {
      xi[axis] = nominal[axis];
      axis = chosen;
      updates.forEach((each) => each());
      act();
    }, axis);
    which.querySelector('select')?.setAttribute('aria-label', `Parameter ${place + 1}`);
    updates.push(update);
    update();
    holder.append(element('div', { class: 'row' }, [which, slider, value]));
  });
  const reset = button('Reset', 'All parameters nominal', () => {
    nominal.forEach((x, axis) => (xi[axis] = x));
    updates.forEach((each) => each());
    act();
  });
  const error = polynomials ? `by polynomials, at most ${length(polynomials.error)} from the simulated samples` : '';
  holder.append(element('div', { class: 'row' }, [reset, element('small', {}, [error])]));
  return holder;
}

/** A length for people. @param {number} metres */
export function length(metres) {
  if (metres < 1e-9) return 'under 1 nm';
  const [unit, factor] = metres < 1e-6 ? ['nm', 1e9] : metres < 1e-3 ? ['µm', 1e6] : metres < 1 ? ['mm', 1e3] : ['m', 1];
  return `${digits(metres * Number(factor))} ${unit}`;
}
