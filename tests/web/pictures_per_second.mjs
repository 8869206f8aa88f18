// How fast the page draws a run of fifty leaps: pictures a second while it plays, and what its own scripts take of
// the time. A measurement, no test: on a machine without a graphics card most of a picture is the software renderer.
// Usage: node pictures_per_second.mjs PROGRAM [WIDTH HEIGHT]
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { finish, open, start } from './browser.mjs';

const [program, width = '1280', height = '800'] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'hopscotch-pictures-'));
const kSeconds = 10;

try {
  const scenario = join(folder, 'fifty.yaml');
  writeFileSync(scenario, 'name: fifty\nslabs: [{x_m: [-1.0, 40.0], y_m: [-10.0, 10.0]}]\ngoal: {jumps: 50}\n');
  const run = join(folder, 'run');
  const made = await finish(program, ['run', scenario, '--perception', 'truth', '--no-pictures', '--out', run]);
  if (made.code !== 0) throw new Error(made.output);
  const server = start(program, ['view', run, '--port', '0'], /http:\/\/127\.0\.0\.1:(\d+)\//);
  const [url] = await server.matched;
  const { browser, page } = await open(url, { width: Number(width), height: Number(height) });
  await page.waitForFunction(() => Number(document.getElementById('slider').max) > 40);
  const session = await page.context().newCDPSession(page);
  await session.send('Performance.enable');
  const sample = async () => {
    const { metrics } = await session.send('Performance.getMetrics');
    const value = (name) => metrics.find((metric) => metric.name === name).value;
    const pictures = await page.evaluate(() => Number(document.body.dataset.pictures));
    return { pictures, seconds: value('Timestamp'), script: value('ScriptDuration') };
  };
  await page.click('#play');
  await page.waitForTimeout(1000);
  const before = await sample();
  await page.waitForTimeout(1000 * kSeconds);
  const after = await sample();
  const pictures = after.pictures - before.pictures;
  console.log(JSON.stringify({
    pictures_per_second: pictures / (after.seconds - before.seconds),
    script_ms_a_picture: (1000 * (after.script - before.script)) / pictures,
  }));
  await browser.close();
  server.child.kill('SIGINT');
  await server.ended;
} finally {
  rmSync(folder, { recursive: true, force: true });
}
