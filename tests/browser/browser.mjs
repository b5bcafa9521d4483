// A browser for the checks: Chromium, with WebGL computed by the processor.
import { spawn } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { resolve } from 'node:path';
import { chromium } from 'playwright-core';

const executablePath = process.env.CHROMIUM || '/usr/bin/chromium';
const args = ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

/** @param {string[]} [more] */
export const launch = (more = []) => chromium.launch({ executablePath, args: [...args, ...more] });

/** Opens a page from the disk, and notes what it should not do. */
export async function open(browser, file, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1200, height: 800 }, ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(120_000);
  const wrong = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && !message.text().includes('GPU stall') && wrong.push(message.text()));
  page.on('pageerror', (error) => wrong.push(error.message));
  page.on('dialog', (dialog) => wrong.push(dialog.message()));
  page.on('request', (request) => !/^(file|data):/.test(request.url()) && wrong.push(request.url()));
  let files = 0;
  page.on('request', (request) => request.url().startsWith('file:') && ++files > 1 && wrong.push(request.url()));
  await page.goto(`file://${file}`);
  return { page, wrong, context };
}

/** Columns of a table of bounds, by heading. */
export function columns(file) {
  const [head, ...rows] = readFileSync(file, 'utf8').trim().split('\n').map((line) => line.split(','));
  return Object.fromEntries(head.map((name, place) => [name, rows.map((row) => Number(row[place]))]));
}

/** Serves a model in the studio of MBINT: the process, and the address of its page. */
export async function studioOf(model) {
  const program = spawn(resolve(process.env.MBINT || 'target/release/mbint'), ['studio', model, '--no-open'], { stdio: ['ignore', 'pipe', 'inherit'] });
  const address = await new Promise((done) => program.stdout.on('data', (text) => /^http/.test(String(text)) && done(String(text).split('\n')[0])));
  return { program, address };
}
