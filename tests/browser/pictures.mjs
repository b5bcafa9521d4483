// Pictures of reports and of the studio for the book. REPORTS names the folder of the results, PICTURES that of the pictures.
import { join } from 'node:path';
import { launch, open, studioOf } from './browser.mjs';

const shots = [
  { name: 'report_four_bar', of: 'four_bar', scheme: 'light', time: 0.62, point: 'coupler.tracer', exaggerate: '10' },
  { name: 'report_four_bar_dark', of: 'four_bar', scheme: 'dark', time: 0.62, point: 'coupler.tracer', exaggerate: '10' },
  { name: 'report_six_axis_arm', of: 'six_axis_arm', scheme: 'light', time: 0.5, exaggerate: '1' },
  { name: 'report_door', of: 'door', scheme: 'dark', time: 1.2, scene: 'windy', exaggerate: '1' },
];
const browser = await launch();
for (const { name, of, scheme, time, point, scene, exaggerate } of shots) {
  const { page, context } = await open(browser, join(process.env.REPORTS, of, 'report.html'), { colorScheme: scheme, viewport: { width: 1280, height: 860 } });
  if (scene) await page.locator('#scenes button', { hasText: scene }).click();
  if (point) await page.selectOption('#swept select', { label: point });
  if (exaggerate !== '1') await page.selectOption('#exaggerate select', { label: `× ${exaggerate}` });
  await page.evaluate((time) => mbint.current().clock.seek(time), time);
  await page.waitForTimeout(800);
  await page.screenshot({ path: join(process.env.PICTURES, `${name}.png`), timeout: 240_000 });
  await context.close();
}
const { program, address } = await studioOf('models/slider_crank.yaml');
const page = await browser.newPage({ colorScheme: 'light', viewport: { width: 1500, height: 860 } });
await page.goto(address);
await page.waitForFunction(() => document.querySelector('#stage-name').textContent.startsWith('bounds as') && studio.stage.view, null, { timeout: 240_000 });
await page.evaluate(() => studio.clock().seek(1.2));
await page.focus('#parameter-0');
await page.keyboard.press('End');
await page.waitForFunction(() => document.querySelector('#bounds path.sample') && studio.stage.movie.sampled);
await page.waitForTimeout(800);
await page.screenshot({ path: join(process.env.PICTURES, 'studio.png'), timeout: 240_000 });
await browser.close();
program.kill('SIGINT');
