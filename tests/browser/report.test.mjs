// Reports in a browser. REPORTS names a folder with results of four_bar, six_axis_arm, door, shapes.yaml, hostile.yaml and bouncing_ball.yaml, and `all` of every other
// model and example.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, readdirSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { columns, launch, open } from './browser.mjs';

const reports = process.env.REPORTS;
const report = (name) => join(reports, name, 'report.html');
let browser;

before(async () => {
  browser = await launch();
});
after(() => browser.close());

const canvas = (page) => page.evaluate(() => document.querySelector('.scene:not(.hidden) canvas').toDataURL());
const frames = (page, count) =>
  page.evaluate((count) => new Promise((done) => {
    const next = () => (count-- > 0 ? requestAnimationFrame(next) : done());
    next();
  }), count);
const seek = async (page, time) => {
  await page.evaluate((time) => mbint.current().clock.seek(time), time);
  await frames(page, 3);
};

test('reports are small, open from the disk, ask for nothing and say nothing wrong', async () => {
  for (const name of ['four_bar', 'six_axis_arm', 'door']) {
    assert.ok(statSync(report(name)).size < 2_000_000, `${name}: ${statSync(report(name)).size}`);
    const { page, wrong, context } = await open(browser, report(name));
    await frames(page, 3);
    assert.ok(await page.evaluate(() => mbint.current().view.drawings > 0), name);
    assert.deepEqual(wrong, [], name);
    await context.close();
  }
});

/** Stack-ups of dimensions alone: nothing moves, and pictures have no time. */
const stacks = ['bearing_gap', 'bearing_gap_design', 'overrunning_clutch', 'stack_to_price'];

/** Faults of a report in which nothing was touched: an empty view, figures without courses, numbers that are none. */
const empty = (page, isStack) => page.evaluate((isStack) => {
  const wrong = [];
  for (const [number, scene] of mbint.scenes.entries()) {
    mbint.show(number);
    const { view, plots } = mbint.current();
    const article = document.querySelector(`.scene[data-scene="${number}"]`);
    const note = (what) => wrong.push(`${scene.name}: ${what}`);
    if (!scene.motion !== isStack) note(isStack ? 'a motion' : 'no motion');
    view?.draw();
    const canvas = article.querySelector('canvas');
    const gl = canvas?.getContext('webgl2');
    if (isStack) {
      if (canvas) note('a view');
      for (const part of ['.bar', '.limit']) if (!article.querySelector(`figure ${part}`)) note(`no ${part}`);
    } else if (!gl || canvas.width * canvas.height === 0) note('no view');
    else {
      const pixels = new Uint32Array(canvas.width * canvas.height);
      gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(pixels.buffer));
      if (new Set(pixels).size < 2) note('an empty view');
    }
    const figures = [...article.querySelectorAll('figure')];
    if (figures.length !== scene.outputs.length) note(`${figures.length} figures of ${scene.outputs.length}`);
    for (const figure of figures) {
      const drawn = [...figure.querySelectorAll('.data path, .data polyline, .data line')].some((part) => part.getTotalLength() > 0);
      if (!drawn) note(`an empty plot of ${figure.textContent.slice(0, 40)}`);
    }
    if (!isStack && plots.length < figures.length) note('a figure without its cursor');
    const texts = [...article.querySelectorAll('.readout, .player, .options, .note')].map((part) => part.textContent);
    if (texts.some((text) => /NaN|Infinity|undefined/.test(text))) note(`a number that is none: ${texts.find((text) => /NaN|Infinity|undefined/.test(text))}`);
    if ([...article.querySelectorAll('.overlay *')].some((part) => [...part.attributes].some(({ value }) => value.includes('NaN')))) note('a cursor that is nowhere');
    if (figures.length === 0 && !article.querySelector('table')) note('no result');
  }
  return wrong;
}, isStack);

test('every shipped model and every example has a view and plots, and says nothing wrong', async () => {
  const names = readdirSync(join(reports, 'all'));
  assert.ok(names.length > 55, String(names.length));
  const faults = [];
  for (const name of names) {
    const { page, wrong, context } = await open(browser, join(reports, 'all', name, 'report.html'));
    await frames(page, 2);
    faults.push(...[...wrong, ...(await empty(page, stacks.includes(name)))].map((fault) => `${name}: ${fault}`));
    // What is wrong when it plays, or a key is pressed.
    await page.keyboard.press('Space');
    await page.keyboard.press('End');
    await frames(page, 2);
    faults.push(...wrong.map((fault) => `${name}: ${fault}`));
    await context.close();
  }
  assert.deepEqual([...new Set(faults)], []);
});

test('a response has its own cursor, over frequencies', async () => {
  const { page, wrong, context } = await open(browser, join(reports, 'all', 'modes', 'report.html'));
  const svg = page.locator('figure:not(.hidden) .plot svg').first();
  const box = await svg.boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.3 * box.height);
  assert.match(await page.locator('figure:not(.hidden) .readout .at').first().textContent(), /^frequency = \d.* Hz$/);
  assert.equal(await page.locator('#play').count(), 0);
  assert.deepEqual(wrong, []);
  await context.close();
});

test('the picture changes while it plays, and stands still when paused', async () => {
  const { page, wrong, context } = await open(browser, report('four_bar'));
  await frames(page, 3);
  const first = await canvas(page);
  await page.click('#play');
  await page.waitForFunction(() => mbint.current().clock.time > 0.1);
  await page.keyboard.press('Space').catch(() => {});
  await page.evaluate(() => mbint.current().clock.pause());
  await frames(page, 3);
  const paused = await canvas(page);
  assert.notEqual(paused, first);
  const drawings = await page.evaluate(() => mbint.current().view.drawings);
  await page.waitForTimeout(400);
  assert.equal(await canvas(page), paused);
  assert.equal(await page.evaluate(() => mbint.current().view.drawings), drawings);
  assert.deepEqual(wrong, []);
  await context.close();
});

test('scrubbing moves the cursor of every plot', async () => {
  const { page, context } = await open(browser, report('four_bar'));
  const places = () => page.evaluate(() => [...document.querySelectorAll('.cursor')].map((line) => Number(line.getAttribute('x1'))));
  const at = async (time) => {
    await page.fill('#scrub', String(time));
    await page.dispatchEvent('#scrub', 'input');
    return places();
  };
  const [first, last] = [await at(0.5), await at(1.5)];
  assert.ok(first.length >= 5, String(first.length));
  assert.ok(first.every((place, number) => last[number] > place + 50), `${first} ${last}`);
  // The cursor is where the figure's own scale has the time.
  const scales = await page.evaluate(() => mbint.current().plots.flatMap(({ data }) => data.panels.map(({ x }) => x)));
  scales.forEach((x, number) => {
    const px = x.from_px + ((1.5 - x.min) / (x.max - x.min)) * (x.to_px - x.from_px);
    assert.ok(Math.abs(px - last[number]) < 0.6, `${px} ${last[number]}`);
  });
  await context.close();
});

test('derivatives at the cursor are those that mbint gradient writes', async () => {
  const folder = join(reports, 'gradient');
  execFileSync(process.env.MBINT, ['gradient', 'models/four_bar.yaml', '--quiet', '--output', folder]);
  const table = columns(join(folder, 'gradients.csv'));
  const { page, context } = await open(browser, report('four_bar'));
  const shown = () => page.evaluate(() => {
    const { plots } = mbint.current();
    const holder = document.querySelector('.slopes');
    const plot = plots.find(({ readout }) => readout.nextElementSibling === holder);
    const entries = [...holder.querySelectorAll('.slope')];
    return { output: plot.data.output, slopes: entries.map((entry) => [entry.querySelector('.name').textContent, entry.querySelector('b').textContent]) };
  });
  for (const row of [20, 63, 150]) {
    await seek(page, table.t[row]);
    const { output, slopes } = await shown();
    assert.ok(slopes.length > 1, String(slopes));
    for (const [name, text] of slopes) {
      const [, unit] = text.split(' ');
      // The table is in SI.
      const exact = table[`${output}.${name}`][row] * (unit.endsWith('/mm') ? 1e-3 : 1);
      const found = Number(text.split(' ')[0].replace('·10', 'e').replace(/[⁰¹²³⁴⁵⁶⁷⁸⁹]/g, (digit) => String('⁰¹²³⁴⁵⁶⁷⁸⁹'.indexOf(digit))).replace('⁻', '-'));
      assert.ok(Math.abs(found - exact) <= 6e-3 * Math.abs(exact), `${output} by ${name}, row ${row}: ${text}, not ${exact}`);
    }
  }
  await context.close();
});

test('a point is where bounds.csv has it', async () => {
  const { page, context } = await open(browser, report('four_bar'));
  const table = columns(join(reports, 'four_bar', 'bounds.csv'));
  for (const row of [0, 37, 100, 163]) {
    const place = await page.evaluate((time) => {
      const { movie, view } = mbint.current();
      const tracer = view.mechanism.named.find(({ name }) => name === 'coupler.tracer');
      return view.mechanism.where(movie.at(time), tracer.anchor);
    }, table.t[row]);
    for (const [axis, name] of ['tracer_x', 'tracer_y'].entries()) {
      const truth = table[`${name}.nominal`][row];
      assert.ok(Math.abs(place[axis] - truth) < 1e-5, `${name} at ${table.t[row]}: ${place[axis]} instead of ${truth}`);
    }
  }
  await context.close();
});

test('samples and polynomials stay within the bounds, and agree with each other', async () => {
  const { page, context } = await open(browser, report('four_bar'));
  const table = columns(join(reports, 'four_bar', 'bounds.csv'));
  const row = 60;
  const [samples, ghosts] = await page.evaluate((time) => {
    const { movie, view } = mbint.current();
    const tracer = view.mechanism.named.find(({ name }) => name === 'coupler.tracer');
    const x = (instant) => view.mechanism.where(instant, tracer.anchor)[0];
    const values = movie.samples.map(({ values }) => movie.xi(values));
    return [movie.samples.map((_, sample) => x(movie.at(time, sample))), values.map((xi) => x(movie.anywhere(time, xi)))];
  }, table.t[row]);
  const [lower, upper] = ['lower', 'upper'].map((side) => table[`tracer_x.chebyshev.${side}`][row]);
  const slack = 1e-6 + 0.02 * (upper - lower);
  samples.forEach((x, number) => {
    assert.ok(x > lower - slack && x < upper + slack, `${lower} ${x} ${upper}`);
    assert.ok(Math.abs(x - ghosts[number]) < slack, `${x} ${ghosts[number]}`);
  });
  // Corners of the box are among them: they reach most of the way to the bounds.
  assert.ok(Math.max(...samples) - Math.min(...samples) > 0.8 * (upper - lower));
  await context.close();
});

/** Height of a ball on a spring without loss: parabolas, and in contact y = −(u/ω) sin ωτ − (g/ω²)(1 − cos ωτ). */
const height = (stiffness, from, time) => {
  const [g, omega, speed] = [9.81, Math.sqrt(stiffness), Math.sqrt(2 * 9.81 * from)];
  const fall = speed / g;
  if (time < fall) return from - 0.5 * g * time * time;
  const contact = (Math.PI + 2 * Math.atan(g / (speed * omega))) / omega;
  const within = (time - fall) % (contact + 2 * fall);
  if (within < contact) return -(speed / omega) * Math.sin(omega * within) - (g / omega ** 2) * (1 - Math.cos(omega * within));
  return speed * (within - contact) - 0.5 * g * (within - contact) ** 2;
};

test('the ghost of a slider bounces at its own times', async () => {
  const { page, context } = await open(browser, report('bouncing_ball'));
  const times = Array.from({ length: 400 }, (_, row) => 0.005 * row);
  const places = [[1, 1], [-1, -1], [0.37, -0.61]];
  const at = (exaggeration) => page.evaluate(([times, places, exaggeration]) => {
    const { movie } = mbint.current();
    movie.exaggeration = exaggeration;
    const of = ([stiffness, from]) => movie.parameters.map(({ name }) => (name === 'K' ? stiffness : from));
    return places.map((place) => times.map((time) => movie.anywhere(time, of(place)).pose[1]));
  }, [times, places, exaggeration]);
  const [once, tenfold] = [await at(1), await at(10)];
  places.forEach(([stiffness, from], place) => times.forEach((time, row) => {
    const [own, nominal] = [height(1e5 + 5e3 * stiffness, 1 + 0.02 * from, time), height(1e5, 1, time)];
    // At fixed times polynomials are off by 6 mm.
    assert.ok(Math.abs(once[place][row] - own) < 1e-3, `${time} s: ${once[place][row]} instead of ${own}`);
    const shown = nominal + 10 * (own - nominal);
    assert.ok(Math.abs(tenfold[place][row] - shown) < 1.2e-2, `${time} s: ${tenfold[place][row]} instead of ${shown}`);
  }));
  await context.close();
});

test('a slider moves a ghost, a swept region appears, and so does what is hidden', async () => {
  const { page, wrong, context } = await open(browser, report('four_bar'));
  await frames(page, 3);
  let before = await canvas(page);
  const changes = async (what, act) => {
    await act();
    await frames(page, 3);
    const now = await canvas(page);
    assert.notEqual(now, before, what);
    before = now;
  };
  await changes('slider', async () => {
    await page.fill('.parameter', '1');
    await page.dispatchEvent('.parameter', 'input');
  });
  await changes('swept', () => page.selectOption('#swept select', { label: 'coupler.tracer' }));
  await changes('samples', () => page.click('#ghosts'));
  const button = page.locator('.readout button').first();
  await button.click();
  assert.equal(await button.getAttribute('aria-pressed'), 'false');
  assert.ok(await page.evaluate(() => document.querySelectorAll('.plot .off').length > 0));
  assert.deepEqual(wrong, []);
  await context.close();
});

test('the worst functions of excitations play beside the nominal motion', async () => {
  const { page, wrong, context } = await open(browser, report('all/half_car_on_a_road'));
  await frames(page, 3);
  const names = await page.locator('#worst select option').allTextContents();
  assert.equal(names[0], 'nothing');
  assert.ok(names.some((name) => /^heave at [0-9.]+ s$/.test(name)) && names.includes('hardest'), names.join());
  await seek(page, 0.4);
  const before = await canvas(page);
  await page.selectOption('#worst select', { label: 'hardest' });
  await frames(page, 3);
  const worst = await canvas(page);
  assert.notEqual(worst, before);
  await seek(page, 0.6);
  assert.notEqual(await canvas(page), worst);
  await page.selectOption('#worst select', { label: 'nothing' });
  await seek(page, 0.4);
  assert.equal(await canvas(page), before);
  assert.deepEqual(wrong, []);
  await context.close();
});

test('values with units stand under the plot, and a stretch of time fills it', async () => {
  const { page, context } = await open(browser, report('four_bar'));
  const svg = page.locator('figure:not(.hidden) .plot svg').first();
  const box = await svg.boundingBox();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.3 * box.height);
  assert.match(await page.locator('figure:not(.hidden) .readout .value').first().textContent(), /\d.*(rad|deg|°)/);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.3 * box.height, { steps: 3 });
  await page.mouse.up();
  assert.ok(await page.evaluate(() => mbint.current().plots[0].shown.to - mbint.current().plots[0].shown.from < 0.5));
  assert.ok(await page.locator('.plot svg.zoomed').count() > 0);
  await context.close();
});

test('keys play, step and go to the ends', async () => {
  const { page, context } = await open(browser, report('six_axis_arm'));
  const time = () => page.evaluate(() => mbint.current().clock.time);
  await page.keyboard.press('End');
  const end = await time();
  await page.keyboard.press('ArrowLeft');
  assert.ok((await time()) < end);
  await page.keyboard.press('Home');
  assert.equal(await time(), 0);
  await page.keyboard.press('Space');
  assert.ok(await page.evaluate(() => mbint.current().clock.playing));
  await page.keyboard.press('Space');
  const before = await canvas(page);
  await page.focus('canvas');
  await page.keyboard.press('ArrowUp');
  await frames(page, 3);
  assert.notEqual(await canvas(page), before);
  await context.close();
});

test('scenes are a switch away', async () => {
  const { page, wrong, context } = await open(browser, report('door'));
  const names = await page.locator('#scenes button').allTextContents();
  assert.ok(names.length > 3, String(names));
  for (const name of names) {
    await page.locator('#scenes button', { hasText: new RegExp(`^${name}$`) }).click();
    await frames(page, 3);
    assert.equal(await page.locator('.scene:not(.hidden)').count(), 1);
    assert.ok(await page.evaluate(() => mbint.current().view.drawings > 0), name);
  }
  assert.deepEqual(wrong, []);
  await context.close();
});

test('forces are arrows on demand, as long as bounds.csv has them', async () => {
  const { page, wrong, context } = await open(browser, report('shapes'));
  const table = columns(join(reports, 'shapes', 'bounds.csv'));
  for (const row of [0, 7, 20]) {
    const forces = await page.evaluate((time) => mbint.current().movie.forcesAt(time), table.t[row]);
    const pin = forces.find(({ name, reaction }) => name === 'pin' && reaction);
    const size = Math.hypot(...pin.force);
    const truth = table['pin_force.nominal'][row];
    assert.ok(Math.abs(size - truth) < 2e-3 * truth, `${size} N instead of ${truth} N`);
    assert.ok(forces.some(({ name, reaction }) => name === 'spring' && !reaction));
  }
  assert.ok(!(await page.locator('.bar.force').isVisible()));
  assert.ok(await page.locator('.gravity').isVisible());
  let before = await canvas(page);
  for (const box of ['traced', 'forces']) {
    await page.click(`#${box}`);
    await frames(page, 3);
    const now = await canvas(page);
    assert.notEqual(now, before, box);
    before = now;
  }
  assert.match(await page.locator('.bar.force').textContent(), /^\d+(\.\d+)? k?N$/);
  // The tip of an arrow says whose it is.
  const tip = await page.evaluate(() => {
    const { view } = mbint.current();
    const { place } = view.tips.find(({ name }) => name === 'pin');
    return view.camera.pixel(place, view.canvas.clientWidth, view.canvas.clientHeight);
  });
  await page.locator('canvas').hover({ position: { x: tip[0], y: tip[1] } });
  assert.match(await page.locator('.tip').textContent(), /^pin .* N$/);
  await page.keyboard.press('f');
  assert.equal(await page.locator('#forces').isChecked(), false);
  assert.deepEqual(wrong, []);
  await context.close();
});

test('traces are the nominal paths of points', async () => {
  const { page, context } = await open(browser, report('four_bar'));
  assert.equal(await page.evaluate(() => mbint.current().view.traces.length), 0);
  await page.click('#traced');
  const table = columns(join(reports, 'four_bar', 'bounds.csv'));
  const paths = await page.evaluate(() => mbint.current().view.traces.map(({ points }) => points));
  // The tracer's is among them: it passes everywhere that bounds.csv has it.
  const passes = (points, x, y) => points.some((_, at) => at % 3 === 0 && Math.hypot(points[at] - x, points[at + 1] - y) < 5e-3);
  const rows = [0, 20, 55, 80];
  const tracer = paths.filter((points) => rows.every((row) => passes(points, table['tracer_x.nominal'][row], table['tracer_y.nominal'][row])));
  assert.ok(tracer.length >= 1, `${paths.length} paths`);
  await context.close();
});

test('bodies look as their shapes say, and keep within the view', async () => {
  const { page, wrong, context } = await open(browser, report('shapes'), { viewport: { width: 390, height: 800 } });
  await frames(page, 3);
  const [kinds, bars, inside] = await page.evaluate(() => {
    const { view, movie } = mbint.current();
    const { mechanism, camera, canvas } = view;
    const pixels = mechanism.visuals.flatMap((visual) => mechanism.corners(movie.at(0), visual)).map((place) => camera.pixel(place, canvas.clientWidth, canvas.clientHeight));
    const within = pixels.every(([x, y]) => x >= 0 && y >= 0 && x <= canvas.clientWidth && y <= canvas.clientHeight);
    return [mechanism.visuals.map(({ shape }) => shape), movie.drawing.bodies.length - 1 - [...mechanism.shown].filter((body) => body > 0).length, within];
  });
  for (const kind of ['box', 'cylinder', 'sphere', 'capsule', 'mesh', 'plane']) assert.ok(kinds.includes(kind), `${kind} is not among ${kinds}`);
  assert.equal(bars, 0, 'bodies that are drawn as bars');
  assert.ok(inside, 'a shape is out of view');
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is wider than the window');
  assert.deepEqual(wrong, []);
  await context.close();
});

test('beside short plots, the mechanism covers no table', async () => {
  const { page, context } = await open(browser, report('shapes'), { viewport: { width: 1280, height: 700 } });
  await page.evaluate(() => scrollTo(0, 400));
  await frames(page, 3);
  const [stage, table] = await page.evaluate(() => ['.pinned', 'table'].map((part) => document.querySelector(part).getBoundingClientRect()).map(({ top, bottom }) => [top, bottom]));
  assert.ok(stage[1] <= table[0], `${stage} ${table}`);
  await context.close();
});

test('dark, narrow, and with less motion', async () => {
  const { page, wrong, context } = await open(browser, report('four_bar'), { colorScheme: 'dark', reducedMotion: 'reduce', viewport: { width: 380, height: 700 } });
  await frames(page, 3);
  const paper = await page.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number));
  assert.ok(Math.max(...paper) < 60, String(paper));
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is wider than the window');
  const drawings = await page.evaluate(() => mbint.current().view.drawings);
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => mbint.current().view.drawings), drawings, 'nothing moves by itself');
  assert.equal(await page.evaluate(() => getComputedStyle(document.querySelector('button')).transitionDuration), '0s');
  assert.deepEqual(wrong, []);
  await context.close();
});

test('without WebGL, without scripts and in print there are pictures', async () => {
  const plain = await launch(['--disable-gpu', '--disable-3d-apis']);
  const { page, wrong, context } = await open(plain, report('four_bar'));
  assert.ok(await page.locator('.still img').isVisible());
  assert.ok(await page.locator('#scrub').isVisible());
  assert.deepEqual(wrong.filter((text) => !/webgl/i.test(text)), []);
  await context.close();
  await plain.close();
  const silent = await open(browser, report('door'), { javaScriptEnabled: false });
  assert.ok(await silent.page.locator('.still img').first().isVisible());
  assert.equal(await silent.page.locator('.scene:visible').count(), await silent.page.locator('.scene').count());
  await silent.context.close();
  const print = await open(browser, report('four_bar'));
  await print.page.emulateMedia({ media: 'print' });
  assert.ok(await print.page.locator('.still img').isVisible());
  assert.ok(!(await print.page.locator('canvas').isVisible()));
  assert.equal(await print.page.locator('figure:visible').count(), await print.page.locator('figure').count());
  await print.context.close();
});

test('hostile names are text', async () => {
  const { page, wrong, context } = await open(browser, report('hostile'));
  await frames(page, 3);
  const summary = JSON.parse(readFileSync(join(reports, 'hostile', 'summary.json'), 'utf8'));
  assert.equal(await page.locator('h1').textContent(), summary.model);
  assert.equal(await page.title(), `${summary.model} – mbint`);
  assert.match(await page.locator('.description').textContent(), /<\/style><\/title><script>/);
  const buttons = await page.locator('.switch button').allTextContents();
  summary.outputs.forEach(({ name }) => assert.ok(buttons.includes(name), name));
  const parameters = await page.locator('.parameters tbody th').allTextContents();
  assert.ok(parameters.some((name) => name.length >= 300 && name.endsWith('_end')), String(parameters.map((name) => name.length)));
  assert.match(await page.locator('.model code').first().textContent(), /<\/script><\/code><\/pre><script>alert\(3\)/);
  assert.equal(await page.locator('img:not(.still img)').count(), 0);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is wider than the window');
  assert.deepEqual(wrong, []);
  await context.close();
});
