// `hopscotch view`: the page of a finished run.
import assert from 'node:assert/strict';
import { mkdtempSync, rmSync } from 'node:fs';
import http from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { colours, finish, open, start } from './browser.mjs';

const [program, scenarios] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), 'hopscotch-view-'));
const run = join(folder, 'run');

function ask(url, options) {
  return new Promise((resolve, reject) => {
    const request = http.request(url, options, (reply) => {
      reply.resume();
      reply.on('end', () => resolve(reply.statusCode));
    });
    request.on('error', reject);
    request.end(options.body ?? '');
  });
}

try {
  const made = await finish(program, ['run', join(scenarios, 'rising-boxes.yaml'), '--state', 'truth', '--jumps', '3', '--no-pictures', '--out', run]);
  assert.equal(made.code, 0, made.output);

  const server = start(program, ['view', run, '--port', '0'], /http:\/\/127\.0\.0\.1:(\d+)\//);
  const [url, port] = await server.matched;

  // Nobody but our own page on this machine.
  assert.equal(await ask(`${url}api/about`, { headers: { Host: 'evil.example' } }), 403);
  assert.equal(await ask(`${url}../../../../etc/passwd`, {}), 404);
  assert.equal(await ask(`${url}api/command`, { method: 'POST', body: '{"mode":"hold"}' }), 409, 'a finished run takes no commands');
  const second = await finish(program, ['view', run, '--port', port]);
  assert.equal(second.code, 3, second.output);
  assert.match(second.output, /port \d+ is in use/);

  const { browser, page, complaints } = await open(url, { width: 1280, height: 800 });
  assert.ok(Number(await page.evaluate(() => document.querySelectorAll('#slider')[0].max)) >= 0);
  await page.waitForFunction(() => Number(document.getElementById('slider').max) > 2);
  assert.match(await page.textContent('#outcome'), /stopped after .* 3 of 3 jumps landed/);
  assert.equal(await page.isHidden('#operator'), true);

  // In the middle of the second flight.
  await page.evaluate(() => {
    const slider = document.getElementById('slider');
    slider.value = String(0.62 * Number(slider.max));
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  });
  await page.waitForFunction(() => document.querySelectorAll('#margins .bar').length >= 6);
  await page.waitForFunction(() => document.querySelectorAll('#decision tr.chosen').length === 1);
  const painted = await colours(page);
  assert.ok(painted > 100, `the picture is nearly empty: ${painted} colours`);
  await page.screenshot({ path: 'view.png' });

  const clock = await page.textContent('#clock');
  await page.click('#play');
  await page.waitForFunction((before) => document.getElementById('clock').textContent !== before, clock);
  const drawn = await page.evaluate(() => Number(document.body.dataset.pictures));
  assert.ok(drawn > 3);

  await page.setViewportSize({ width: 390, height: 844 });
  await page.waitForTimeout(500);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 390, `wider than a phone: ${wide}`);
  await page.screenshot({ path: 'view-phone.png' });
  assert.deepEqual(complaints, []);
  await browser.close();

  server.child.kill('SIGINT');
  assert.equal((await server.ended).code, 0);
} finally {
  rmSync(folder, { recursive: true, force: true });
}
console.log('view: passed');
