// A browser with the page in it, and what the tests read from it.
import {mkdtempSync, rmSync} from 'node:fs';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {chromium} from 'playwright-core';
import {becomes} from './processes.mjs';

let context = null;
let profile = null;

export async function openBrowser(options = {}) {
  profile = mkdtempSync(join(tmpdir(), 'ground-web-test-'));
  context = await chromium.launchPersistentContext(profile, {
    executablePath: '/usr/bin/chromium',
    headless: true,
    chromiumSandbox: false,
    viewport: {width: 1280, height: 800},
    args: ['--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-background-networking',
      '--disable-component-update', '--disable-sync'],
    timeout: 180_000,
    ...options,
  });
  context.setDefaultTimeout(180_000);  // of each action: only keeps a broken test from hanging
  return context;
}

export async function closeBrowser() {
  await context?.close();
  context = null;
  if (profile) rmSync(profile, {recursive: true, force: true, maxRetries: 5});
  profile = null;
}

// The page at that address, live. Anything that it complains of fails the test.
export class FleetPage {
  static async open(url) {
    const page = context.pages()[0] ?? (await context.newPage());
    const fleet = new FleetPage(page);
    page.on('pageerror', (error) => fleet.errors.push(error.message));
    page.on('console', (message) => {
      // A connection that is lost is logged by the browser itself.
      if (message.type() === 'error' && !/WebSocket|ERR_CONNECTION|net::/.test(message.text())) fleet.errors.push(message.text());
    });
    page.on('requestfailed', (request) => fleet.unanswered.push(`${request.url()}: ${request.failure()?.errorText}`));
    await page.goto(url);
    // One with a token hands over to the page itself.
    await page.waitForURL(({search}) => search === '');
    await fleet.isLive();
    return fleet;
  }
  errors = [];
  unanswered = [];
  constructor(page) {
    this.page = page;
  }

  data(name) {
    return this.page.evaluate((key) => document.documentElement.dataset[key], name);
  }
  async isLive() {
    await becomes(async () => (await this.data('live')) === 'true', async () =>
      `the page is live; ${this.errors} ${this.unanswered} ${await this.text('#banner')}`);
  }
  text(selector) {
    return this.page.textContent(selector);
  }
  // The row of an aircraft: {state, age, old, delivery, ...}, or null.
  row(node) {
    return this.page.evaluate((name) => {
      const row = [...document.querySelectorAll('#fleet tbody tr')].find((one) => one.cells[0].textContent === name);
      if (!row) return null;
      const [, state, age, , delivery, , altitude, , mission] = [...row.cells].map((cell) => cell.textContent);
      return {state, age: parseFloat(age.replace('! ', '')), old: row.cells[2].classList.contains('old'), marked: age.startsWith('!'), altitude, mission, delivery};
    }, node);
  }
  async rowBecomes(node, condition, what) {
    return becomes(async () => {
      const row = await this.row(node);
      return row && condition(row) ? row : null;
    }, async () => `${node} ${what}; it is ${JSON.stringify(await this.row(node))}`);
  }
  rows() {
    return this.page.locator('#fleet tbody tr').count();
  }
  // Where a marker is on the screen, by its label.
  marker(node) {
    return this.page.evaluate((name) => {
      const marker = [...document.querySelectorAll('.leaflet-marker-icon.aircraft')].find((one) =>
        one.querySelector('.label').textContent.split(' ')[0] === name);
      if (!marker) return null;
      const box = marker.getBoundingClientRect();
      return {x: box.x, y: box.y, label: marker.querySelector('.label').textContent, classes: marker.className};
    }, node);
  }
  select(node) {
    return this.page.locator('#fleet tbody tr', {hasText: node}).first().click();
  }
}
