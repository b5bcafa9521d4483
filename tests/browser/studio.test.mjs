// The studio in a browser. MBINT is the program.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { launch, studioOf } from './browser.mjs';

const CRANK = `model: crank
description: "</title><script>document.title = 'taken over'</script>"
parameters: { l: { value: 0.2, unit: m, tolerance: 1% }, torque: { value: 0.3, unit: N*m, tolerance: 5% } }
bodies:
  crank: { mass: 1, inertia: 0.01, points: { A: [0, 0], B: [l, 0] } }
  rod: { mass: 1, inertia: 0.02, points: { B: [0, 0], C: [0.5, 0] } }
  slider: { mass: 1, coordinates: [x] }
joints:
  A: { revolute: [ground, crank.A] }
  B: { revolute: [crank.B, rod.B] }
  C: { revolute: [rod.C, slider] }
effects: { drive: { torque: { on: crank, value: torque } } }
initial: { crank.angle: 60 deg, crank.angular_velocity: 0 }
outputs: { x: slider.x }
simulation: { duration: 0.4, step: 4e-3, output_step: 0.02 }
bounds: { chebyshev: { order: 2 } }
`;

let browser;
let folder;
let studio;
let page;
let file;
/** What the page should not do. */
const wrong = [];

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'mbint-studio-'));
  file = join(folder, 'crank.yaml');
  writeFileSync(file, CRANK);
  const { program, address } = await studioOf(file);
  studio = program;
  browser = await launch();
  page = await (await browser.newContext({ viewport: { width: 1700, height: 900 } })).newPage();
  page.setDefaultTimeout(60_000);
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && !message.text().includes('GPU stall') && wrong.push(message.text()));
  page.on('pageerror', (error) => wrong.push(error.message));
  page.on('request', (request) => !request.url().startsWith(address) && !request.url().startsWith('data:') && wrong.push(request.url()));
  await page.goto(address);
});

after(async () => {
  await browser?.close();
  studio?.kill();
  rmSync(folder, { recursive: true, force: true });
});

const problems = () => page.evaluate(() => [...document.querySelectorAll('#problems li')].map((row) => row.textContent));
const number = () => page.evaluate(() => studio.model()?.number || 0);

/** When the bounds of a model behind that of a number are there. */
const settled = (after) => page.waitForFunction((after) => studio.editor.text !== '' && studio.model()?.number > after && studio.stage.number === studio.model().number && studio.bounds.number === studio.model().number && document.querySelector('#stage-name').textContent.startsWith('bounds as') && !document.body.classList.contains('wrong'), after);

/** Where a named point is seen. */
const seen = (name) => page.evaluate((name) => {
  const { view } = studio.stage;
  const { anchor } = view.mechanism.named.find((own) => own.name === name);
  const { left, top } = view.canvas.getBoundingClientRect();
  const [x, y] = view.camera.pixel(view.mechanism.where(view.movie.at(studio.clock().time), anchor), view.canvas.clientWidth, view.canvas.clientHeight);
  return [left + x, top + y];
}, name);

test('the page shows the text, the mechanism, its bounds and nothing from elsewhere', async () => {
  await settled(0);
  assert.equal(await page.evaluate(() => studio.editor.text), CRANK);
  assert.ok(await page.evaluate(() => studio.stage.view.drawings > 0));
  assert.equal(await page.evaluate(() => document.querySelectorAll('#bounds figure .data path').length > 1), true);
  assert.deepEqual(await page.evaluate(() => [...document.querySelectorAll('.parameter label')].map((label) => label.textContent)), ['l', 'torque']);
  assert.equal(await page.title(), 'crank – mbint studio');
  assert.deepEqual(wrong, []);
});

test('a typo is underlined, listed and put right', async () => {
  const before = await number();
  const at = CRANK.indexOf('crank.A]');
  await page.evaluate((at) => studio.editor.area.setSelectionRange(at + 2, at + 3), at);
  await page.focus('#editor textarea');
  await page.keyboard.press('Delete');
  await page.waitForSelector('#problems .fix');
  const [problem] = await problems();
  assert.match(problem, /crank\.yaml:9:27 unknown body `crnk`/);
  assert.equal(await page.textContent('.line .error'), 'crnk');
  await page.waitForSelector('.wrong');
  assert.match(await page.textContent('#state'), /has errors/);
  await page.click('#problems .fix');
  await settled(before);
  assert.deepEqual(await problems(), []);
  assert.equal(await page.evaluate(() => studio.editor.text), CRANK);
});

test('names are proposed while typing, and explained under the pointer', async () => {
  const before = await number();
  await page.evaluate(() => {
    const at = studio.editor.text.indexOf('slider.x') + 8;
    studio.editor.area.setSelectionRange(at, at);
  });
  await page.focus('#editor textarea');
  await page.keyboard.type(' + ro');
  await page.waitForSelector('.proposals li');
  assert.match(await page.textContent('.proposals'), /rod/);
  await page.keyboard.press('Escape');
  for (let key = 0; key < 5; key++) await page.keyboard.press('Backspace');
  assert.equal(await page.evaluate(() => studio.editor.text), CRANK);
  await settled(before);
  const [x, y] = await page.evaluate(() => {
    const { editor } = studio;
    const [x, y] = editor.pixel(editor.position(editor.text.indexOf('value: torque') + 8));
    const { left, top } = editor.holder.getBoundingClientRect();
    return [left + x + 3, top + y - 8];
  });
  await page.mouse.move(x, y);
  await page.waitForSelector('.hint:not([hidden])');
  assert.match(await page.textContent('.hint'), /0\.285 to 0\.315/);
  await page.mouse.move(5, 5);
});

test('a point is dragged, and the joints stay closed', async () => {
  const [x, y] = await seen('crank.B');
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 40, y + 10, { steps: 3 });
  await page.waitForFunction(() => studio.stage.last?.pose[2] > 1.2);
  await page.mouse.up();
  const gap = await page.evaluate(() => {
    const { pose } = studio.stage.last;
    const at = (body, x) => [pose[3 * body] + x * Math.cos(pose[3 * body + 2]), pose[3 * body + 1] + x * Math.sin(pose[3 * body + 2])];
    const apart = ([a, b], [c, d]) => Math.hypot(a - c, b - d);
    return Math.max(apart(at(0, 0), [0, 0]), apart(at(0, 0.2), at(1, 0)), apart(at(1, 0.5), at(2, 0)), Math.abs(pose[7]));
  });
  assert.ok(gap < 1e-10, String(gap));
  await page.click('text=Back to the motion');
  assert.equal(await page.evaluate(() => studio.stage.movie.held), null);
});

test('a slider simulates its sample, over the bounds and in the picture', async () => {
  await page.evaluate(() => studio.clock().seek(0.4));
  const before = await seen('crank.B');
  await page.focus('#parameter-1');
  await page.keyboard.press('End');
  await page.waitForFunction(() => document.querySelectorAll('#bounds path.sample').length > 0 && studio.stage.movie.sampled);
  assert.match(await page.textContent('#sliders'), /0\.315 N\*m \(\+5 %\)/);
  assert.notDeepEqual(await seen('crank.B'), before);
  await page.click('text=Nominal >> nth=0');
  await page.waitForFunction(() => document.querySelectorAll('#bounds path.sample').length === 0);
  assert.deepEqual(await seen('crank.B'), before);
});

test('the text is saved when asked, and not over a change of another program', async () => {
  await page.evaluate(() => studio.editor.area.setSelectionRange(0, 0));
  await page.focus('#editor textarea');
  await page.keyboard.type('# mine');
  await page.keyboard.press('Enter');
  assert.equal(readFileSync(file, 'utf8'), CRANK);
  await page.keyboard.press('Control+s');
  await page.waitForFunction(() => document.querySelector('#save').disabled);
  assert.equal(readFileSync(file, 'utf8'), `# mine\n${CRANK}`);
  // A text that is not changed would follow the file.
  await page.keyboard.type('# again ');
  await page.waitForFunction(() => !document.querySelector('#save').disabled);
  writeFileSync(file, `# other\n${CRANK}`);
  await Promise.all([page.waitForResponse((answer) => answer.url().endsWith('/save') && answer.status() === 409), page.keyboard.press('Control+s')]);
  await page.waitForSelector('#notice:not([hidden])');
  // By the refused save, or by the look at the file, whichever comes first.
  assert.match(await page.textContent('#notice'), /has changed on the disk/);
  assert.equal(readFileSync(file, 'utf8'), `# other\n${CRANK}`);
  await page.click('text=Load it from the disk');
  await page.waitForFunction(() => studio.editor.text.startsWith('# other'));
});

test('hostile texts are texts, and a page without a model goes on', async () => {
  const before = await number();
  await page.evaluate(() => studio.editor.replace(0, studio.editor.text.length, '"<img src=x onerror=alert(1)>": { <script>alert(2)</script>: [ }'));
  await page.waitForFunction(() => document.querySelectorAll('#problems li').length > 0);
  assert.equal(await page.evaluate(() => document.querySelectorAll('#problems img, #problems script, .sheet img, .sheet script').length), 0);
  await page.evaluate((text) => studio.editor.replace(0, studio.editor.text.length, text), CRANK);
  await settled(before);
  // A refused save is a failed request of the browser's log.
  assert.deepEqual(wrong.filter((text) => !/409/.test(text)), []);
});

test('the end of the studio is told', async () => {
  studio.kill('SIGINT');
  await page.waitForFunction(() => document.querySelector('#notice').textContent.includes('has ended'));
});
