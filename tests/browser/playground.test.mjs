// The playground: the module in node, whose results have the bytes of the program MBINT, and the page in Chromium.
// PLAYGROUND is the book's folder, or one with the playground's files alone.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, normalize, resolve } from 'node:path';
import { after, before, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { Engine, Stopped } from '../../crates/playground/page/engine.js';
import { launch } from './browser.mjs';

const program = resolve(process.env.MBINT || 'target/release/mbint');
const place = process.env.PLAYGROUND;
const files = JSON.parse(readFileSync(join(place, 'playground/models.json'), 'utf8'));
const module = await WebAssembly.compile(readFileSync(join(place, 'playground/mbint.wasm')));
const scratch = mkdtempSync(join(tmpdir(), 'mbint-playground-'));
after(() => rmSync(scratch, { recursive: true, force: true }));

const ask = (model, more = {}) => new Engine(module, () => {}).ask({ task: 'run', model, files, ...more });

/** Runs the program; what is unresolved or violated is a result. */
const native = (model, folder, more = []) => new Promise((done, failed) => {
  execFile(program, ['run', model, '--quiet', '--output', folder, ...more], (error) => (!error || [3, 4].includes(error.code) ? done() : failed(error)));
});

test('the module asks its host for nothing but a clock and to be told', () => {
  const asked = WebAssembly.Module.imports(module).map(({ module, name }) => `${module}.${name}`);
  assert.deepEqual(asked.sort(), ['page.exhausted', 'page.panicked', 'page.progress', 'page.seconds']);
});

// A study with Taylor and a scan, contact, a beam, explicit steps, an included part, robots; kinds of analyses.
const models = ['slider_crank', 'four_bar', 'geneva', 'cam', 'chain', 'slider_crank_flexible', 'quarter_cars', 'planetary_gear', 'double_wishbone'];
for (const model of [...models.map((name) => `models/${name}.yaml`), 'models/arm.urdf', 'models/crane.xml']) {
  test(`${model} has the bytes of the program`, async () => {
    const folder = join(scratch, model.replaceAll('/', '_'));
    await native(model, folder);
    const answer = ask(model);
    assert.deepEqual(answer.diagnostics.filter(({ severity }) => severity === 'error'), []);
    const tables = Object.keys(answer.files).filter((name) => name.endsWith('.csv'));
    assert.ok(tables.length > 0, 'no tables');
    for (const name of tables) assert.equal(answer.files[name], readFileSync(join(folder, name), 'utf8'), name);
  });
}

test('a scene has the bytes of the program', async () => {
  const folder = join(scratch, 'scene');
  await native('models/door.yaml', folder, ['--scene', 'windy']);
  assert.equal(ask('models/door.yaml', { scene: 'windy' }).files['bounds.csv'], readFileSync(join(folder, 'windy/bounds.csv'), 'utf8'));
});

test('the whole report is that of the program', async () => {
  const folder = join(scratch, 'report');
  await native('models/slider_crank.yaml', folder);
  assert.equal(ask('models/slider_crank.yaml').files['report.html'], readFileSync(join(folder, 'report.html'), 'utf8'));
});

test('errors have places, and what cannot be run says so', () => {
  const text = files['models/pendulum.yaml'];
  const wrong = ask('models/pendulum.yaml', { files: { ...files, 'models/pendulum.yaml': text.replace('bodies:', 'bodys:') } });
  assert.ok(wrong.diagnostics.some(({ severity, line, help }) => severity === 'error' && line > 0 && /bodies/.test(help)), JSON.stringify(wrong.diagnostics));
  assert.equal(wrong.summary, undefined);
  const missing = ask('models/quarter_cars.yaml', { files: { 'models/quarter_cars.yaml': files['models/quarter_cars.yaml'] } });
  assert.match(missing.diagnostics[0].message, /there is no such file/);
});

test('memory that cannot be had stops an instance with a reason, and another one answers', () => {
  const engine = new Engine(module, () => {});
  const whole = engine.functions.allocate;
  engine.functions = { ...engine.functions, allocate: () => whole(0x7fffffff) };
  assert.throws(() => engine.ask({ task: 'check', model: 'models/pendulum.yaml', files }), (error) => error instanceof Stopped && /takes more memory than a page has/.test(error.message));
  assert.equal(ask('models/pendulum.yaml', { task: 'check' }).name, 'pendulum');
});

/** Serves the folder on loopback. */
const server = createServer((request, response) => {
  const path = join(place, normalize(decodeURIComponent(new URL(request.url, 'http://a').pathname)));
  const types = { '.html': 'text/html; charset=utf-8', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm', '.json': 'application/json', '.svg': 'image/svg+xml' };
  if (!existsSync(path)) return response.writeHead(404).end();
  response.writeHead(200, { 'content-type': types[extname(path)] || 'application/octet-stream' }).end(readFileSync(path));
});
const inBook = { skip: existsSync(join(place, 'playground.html')) ? false : 'the book is not built' };
let browser;
let page;
let address;
const wrong = [];

before(async () => {
  if (inBook.skip) return;
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  address = `http://127.0.0.1:${server.address().port}`;
  browser = await launch();
  page = await (await browser.newContext({ viewport: { width: 1500, height: 950 } })).newPage();
  page.setDefaultTimeout(60_000);
  page.on('pageerror', (error) => wrong.push(error.message));
  page.on('dialog', (dialog) => wrong.push(dialog.message()));
  page.on('request', (request) => !request.url().startsWith(address) && !/^(data|blob|about):/.test(request.url()) && wrong.push(request.url()));
});
after(async () => {
  await browser?.close();
  server.close();
});

const results = (shown) => page.waitForFunction((shown) => document.querySelector('#mbint-playground .results iframe')?.srcdoc.includes(shown) && document.querySelector('#mbint-playground .bar button:nth-of-type(2)').disabled, shown);

test("README's study runs in the page in 3 s, with the program's bytes", inBook, async () => {
  const folder = join(scratch, 'page');
  await native('models/slider_crank.yaml', folder);
  await page.goto(`${address}/playground.html`);
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await results('<title>slider_crank');
  const seconds = parseFloat(await page.textContent('#mbint-playground .state'));
  console.log(`# slider_crank in Chromium: ${seconds} s; module ${(gzipSync(readFileSync(join(place, 'playground/mbint.wasm')), { level: 9 }).length / 1e6).toFixed(2)} MB by gzip`);
  // The limit is 3 s on an idle machine; the gate's has other work.
  assert.ok(seconds > 0 && seconds < 10, `${seconds} s`);
  const report = await page.evaluate(() => document.querySelector('#mbint-playground iframe').srcdoc);
  assert.equal(report, readFileSync(join(folder, 'report.html'), 'utf8'));
  const frame = page.frames().find((frame) => frame !== page.mainFrame());
  await frame.waitForFunction(() => mbint.current().view.drawings > 0);
  await page.getByRole('tab', { name: 'Summary' }).click();
  assert.match(await page.textContent('#mbint-playground .summary pre'), /^slider_crank: 3 joint coordinates/);
  assert.deepEqual(wrong, []);
});

test('a text is checked while it is typed, and hostile names do nothing', inBook, async () => {
  const name = '</textarea></script><script>alert(1)</script><img src=x onerror=alert(2)>';
  const hostile = `model: hostile # ${name}
description: "${name}"
bodies: { b: { mass: 1, coordinates: [x] } }
initial: { b.x: 0, b.vx: 1 }
outputs: { x: b.x }
simulation: { duration: 1, step: 0.01 }
`;
  await page.goto(`${address}/playground.html#text=${encodeURIComponent(hostile)}`);
  await page.waitForFunction(() => globalThis.playground?.editor?.text.startsWith('model:'));
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await results('<title>hostile');
  await page.fill('#mbint-playground textarea', `model: "${name}"\nbodys: { "${name}": {} }\n`);
  await page.waitForFunction(() => document.querySelector('#mbint-playground .problems').textContent.includes('bodys'));
  const text = await page.textContent('#mbint-playground .problems');
  assert.ok(text.includes(name.slice(0, 40)) && /2:1.*bodys/s.test(text), text);
  assert.deepEqual(wrong, []);
});

test('Stop ends a run, and the next run has a fresh worker', inBook, async () => {
  const long = files['models/half_car.yaml'];
  await page.goto(`${address}/playground.html#text=${encodeURIComponent(long)}`);
  await page.reload();
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await page.waitForFunction(() => !document.querySelector('#mbint-playground progress').hidden && document.querySelector('#mbint-playground progress').value > 0);
  await page.getByRole('button', { name: 'Stop' }).click();
  await page.waitForFunction(() => document.querySelector('#mbint-playground .state').textContent === 'stopped');
  await page.selectOption('#mbint-playground select', 'models/pendulum.yaml');
  await page.getByRole('button', { name: 'Run', exact: true }).click();
  await results('<title>pendulum');
  assert.deepEqual(wrong, []);
});

test('a model of a guide runs by its button', inBook, async () => {
  await page.goto(`${address}/guides/statics.html`);
  await page.locator('.run-model').first().click();
  await page.waitForURL(/playground\.html/);
  await results('<!DOCTYPE html>');
  assert.deepEqual(wrong, []);
});
