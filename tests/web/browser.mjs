// What the page tests share: the program as a child, and Chromium that watches for complaints.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';

const kBrowsers = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];

// Starts the program; resolves once its output matches, with the match.
export function start(program, args, pattern) {
  const child = spawn(program, args, { stdio: ['ignore', 'pipe', 'pipe'] });
  process.once('exit', () => child.kill('SIGKILL'));  // a failed test leaves nothing behind
  let output = '';
  const ended = new Promise((resolve) => { child.on('close', (code) => resolve({ code, output })); });
  const matched = new Promise((resolve, reject) => {
    const look = (data) => {
      output += data;
      const match = output.match(pattern);
      if (match) resolve(match);
    };
    child.stdout.on('data', look);
    child.stderr.on('data', look);
    child.on('close', (code) => reject(new Error(`ended with ${code}: ${output}`)));
  });
  return { child, ended, matched };
}

export function finish(program, args) {
  const run = start(program, args, /$never/);
  run.matched.catch(() => {});  // its end is what is waited for
  return run.ended;
}

// A page whose console complaints, failed requests and requests to elsewhere are collected.
export async function open(url, viewport) {
  const executablePath = kBrowsers.find(existsSync);
  assert.ok(executablePath, 'no Chromium on this machine');
  const browser = await chromium.launch({
    executablePath,
    args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
      '--disable-component-update', '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  const page = await browser.newPage({ viewport });
  const complaints = [];
  page.on('console', (message) => {
    // The software renderer of a machine without a graphics card warns that reading back is slow.
    if (message.type() === 'error' || (message.type() === 'warning' && !message.text().includes('GPU stall'))) {
      complaints.push(message.text());
    }
  });
  page.on('pageerror', (error) => complaints.push(String(error)));
  page.on('requestfailed', (request) => complaints.push(`failed: ${request.url()}`));
  page.on('request', (request) => {
    if (!request.url().startsWith(url)) complaints.push(`asked elsewhere: ${request.url()}`);
  });
  await page.goto(url);
  await page.waitForSelector('body[data-ready=yes]', { timeout: 60000 });
  return { browser, page, complaints };
}

// Number of different colours of every 7th pixel of the canvas: an empty picture has few.
export function colours(page) {
  return page.evaluate(() => {
    const source = document.getElementById('canvas');
    const copy = document.createElement('canvas');
    copy.width = source.width;
    copy.height = source.height;
    const context = copy.getContext('2d');
    context.drawImage(source, 0, 0);
    const data = context.getImageData(0, 0, copy.width, copy.height).data;
    const seen = new Set();
    for (let i = 0; i < data.length; i += 28) seen.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
    return seen.size;
  });
}
