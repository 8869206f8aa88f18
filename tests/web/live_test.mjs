// `hopscotch run --serve`: the page of a run that is on, and an operator who clicks on it.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { colours, open, start } from './browser.mjs';

const [program] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'hopscotch-live-'));
const out = join(folder, 'out');
const scenario = join(folder, 'plain.yaml');
writeFileSync(scenario, 'name: plain\nslabs:\n  - {x_m: [-1.0, 60.0]}\ngoal: {x_m: 50.0}\n');

try {
  const run = start(program, ['run', scenario, '--state', 'truth', '--serve', '--port', '0', '--no-pictures', '--out', out], /page: (http:\/\/127\.0\.0\.1:\d+\/)/);
  const [, url] = await run.matched;
  const { browser, page, complaints } = await open(url, { width: 1280, height: 800 });
  await page.waitForFunction(() => Number(document.body.dataset.frames) > 60, null, { timeout: 60000 });

  await page.click('[data-mode=hold]');
  await page.waitForFunction(() => /accepted: the robot comes to a stand/.test(document.getElementById('answers').textContent), null, { timeout: 60000 });
  await page.waitForFunction(() => /hold/.test(document.getElementById('now').textContent), null, { timeout: 60000 });
  await page.waitForTimeout(1000);

  // About 35 cm ahead of the robot as the camera starts; a little more or less where that misses.
  const box = await page.locator('#canvas').boundingBox();
  let verdict = '';
  for (const [x, y] of [[0.557, 0.645], [0.557, 0.637], [0.557, 0.653], [0.552, 0.641], [0.552, 0.649]]) {
    await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
    await page.waitForFunction(() => document.querySelector('#proposal button'), null, { timeout: 60000 });
    verdict = await page.textContent('#proposal');
    if (/Certificate/.test(verdict)) break;
    await page.click('#proposal button:not(#send)');
  }
  assert.match(verdict, /Certificate/, verdict);
  assert.ok(await page.locator('#proposal .bar').count() >= 5);
  const painted = await colours(page);
  assert.ok(painted > 100, `the picture is nearly empty: ${painted} colours`);
  await page.screenshot({ path: 'live.png' });

  await page.click('#send');
  await page.waitForFunction(() => /accepted: the robot is held and jumps there/.test(document.getElementById('answers').textContent), null, { timeout: 60000 });
  await page.click('[data-mode=jump]');
  await page.waitForFunction(() => /accepted: the robot jumps on/.test(document.getElementById('answers').textContent), null, { timeout: 60000 });
  await page.waitForFunction(() => /takeoff|flight|landing/.test(document.getElementById('now').textContent), null, { timeout: 60000 });
  await page.click('[data-mode=stop]');
  const ended = await run.ended;
  assert.equal(ended.code, 0, ended.output);
  await page.waitForFunction(() => /stopped after/.test(document.getElementById('outcome').textContent), null, { timeout: 10000 });
  const result = JSON.parse(readFileSync(join(out, 'result.json'), 'utf8'));
  assert.ok(result.jumps.some((jump) => jump.target.source === 'operator'), 'the clicked target was flown');
  // The server goes with the run; what the page asked at that moment may have failed.
  assert.deepEqual(complaints.filter((text) => !/api\/since|ERR_CONNECTION/.test(text)), []);
  await browser.close();
} finally {
  rmSync(folder, { recursive: true, force: true });
}
console.log('live: passed');
