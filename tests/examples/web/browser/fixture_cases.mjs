// Cases over the scripted fleet of web_fixture.
import assert from 'node:assert/strict';
import {closeBrowser, FleetPage, openBrowser} from './page.mjs';
import {becomes, Program} from './processes.mjs';

export async function startFixture({bin}, aircraft, ...rest) {
  const fixture = new Program(`${bin}/web_fixture`, [String(aircraft), ...rest]);
  const [url] = await fixture.says(/https?:\S+/);
  return {fixture, url};
}

const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];

// One entry for each snapshot that the page shows, until there are so many.
function watch(page, howMany) {
  return page.evaluate((count) => new Promise((resolve) => {
    const root = document.documentElement;
    const seen = [];
    const observer = new MutationObserver(() => {
      const number = Number(root.dataset.snapshot);
      if (seen.length > 0 && seen[seen.length - 1].number === number) return;
      seen.push({number, age: Number(root.dataset.age), old: document.querySelectorAll('#fleet td.age.old').length});
      if (seen.length < count) return;
      observer.disconnect();
      resolve(seen);
    });
    observer.observe(root, {attributes: true, attributeFilter: ['data-snapshot']});
  }), howMany);
}

async function followsTwentyAircraft(programs) {
  const {url} = await startFixture(programs, 20);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  await becomes(async () => (await fleet.rows()) === 20, 'there are twenty rows');
  await fleet.page.waitForSelector('.pictures figure:nth-child(20) img');
  const before = await Promise.all([1, 7, 20].map((i) => fleet.marker(`uav${i}`)));
  const seen = await watch(fleet.page, 100);
  const shown = seen.length;
  const made = seen[shown - 1].number - seen[0].number + 1;
  console.log(`${shown} of ${made} snapshots shown; age when shown: median ${median(seen.map((one) => one.age))} s, ` +
    `largest ${Math.max(...seen.map((one) => one.age))} s; ${await fleet.text('#link')}`);
  // A busy machine makes the page skip any number, but what it shows is of now: a page that falls behind shows what grows
  // older and older.
  assert.ok(median(seen.slice(-50).map((one) => one.age)) < 1, 'what is shown is old');
  assert.equal(median(seen.map((one) => one.old)), 0, 'aircraft are shown as old');
  const after = await Promise.all([1, 7, 20].map((i) => fleet.marker(`uav${i}`)));
  before.forEach((marker, i) => assert.ok(Math.hypot(marker.x - after[i].x, marker.y - after[i].y) > 5, `${marker.label} did not move`));
  assert.deepEqual(fleet.errors, []);
}

async function showsHostileTextsAsText(programs) {
  const {fixture, url} = await startFixture(programs, 3, 'hostile');
  await openBrowser();
  const fleet = await FleetPage.open(url);
  await fleet.select('uav1');
  await fleet.page.keyboard.press('h');
  await fleet.page.keyboard.press('Enter');
  fixture.tell('lost uav1');
  const markup = '<img src=x onerror=';
  for (const place of ['#selected-text', '#commands', '#radio-held', '#problems', '#events']) {
    await becomes(async () => (await fleet.text(place)).includes(markup), `${place} shows the text as it is`);
  }
  await becomes(async () => (await fleet.text('#targets')).includes('<b>uav</b>'), 'the list of targets shows the text');
  await becomes(async () => (await fleet.text('#fleet')).includes('<svg onload='), 'the table shows the text');
  await watch(fleet.page, 10);
  assert.equal(await fleet.page.evaluate(() => window.pwned), undefined, 'a script of the network ran');
  assert.equal(await fleet.page.locator('img[src="x"], #events script, #events img, #problems script, #problems img, #radio-held script, #radio-held img, td b, td svg').count(), 0);
  // What has no way to run would be stopped by the policy as well.
  const blocked = await fleet.page.evaluate(() => new Promise((resolve) => {
    document.addEventListener('securitypolicyviolation', (event) => resolve(event.effectiveDirective), {once: true});
    const script = document.createElement('script');
    script.textContent = 'window.pwned = 2';
    document.body.append(script);
  }));
  assert.match(blocked, /script-src/);
  assert.equal(await fleet.page.evaluate(() => window.pwned), undefined);
}

async function showsTheProblemsThatThereAreNow(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state), 'is shown');
  assert.equal(await page.isVisible('#problems-panel'), false, 'where nothing is wrong there is no panel');
  fixture.tell('problems 25');
  await becomes(async () => /25 problems/.test(await fleet.text('#problems-title')), 'they are counted');
  assert.equal(await page.isVisible('#problems-panel'), true);
  assert.equal(await page.locator('#problems li').count(), 20);
  assert.match(await fleet.text('#problems li'), /uav1.*subscribe Pse: uav1 does not publish `Pse`/);
  assert.match(await fleet.text('#problems-more'), /and 5 more/);
  fixture.tell('problems 1');
  await becomes(async () => /1 problem$/.test(await fleet.text('#problems-title')), 'what is gone goes');
  assert.equal(await page.locator('#problems li').count(), 1);
  await watch(page, 30);
  assert.equal(await page.isVisible('#problems-panel'), true, 'what is still there does not scroll away');
  fixture.tell('silence');
  await becomes(async () => /old/.test(await fleet.text('#problems-title')), 'they are marked as old');
  assert.deepEqual(fleet.errors, []);
}

async function showsAReplayAcrossThePage(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state), 'is shown');
  assert.equal(await page.isVisible('#replay'), false);
  fixture.tell('replay uav2');
  await becomes(() => page.isVisible('#replay'), 'the replay is announced');
  assert.equal(await fleet.text('#replay'), '▶ REPLAY of a recording, not live: uav2');
  const {width} = await page.locator('#replay').boundingBox();
  assert.equal(width, page.viewportSize().width, 'across the page');
  fixture.tell('silence');
  await becomes(async () => /STALE/.test((await fleet.row('uav1')).state), 'the fleet falls silent');
  assert.equal(await page.isVisible('#replay'), true, 'what is old was a replay still');
  assert.deepEqual(fleet.errors, []);
}

async function showsWhatTheRadioHoldsBack(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && row.delivery === '3.21', 'is shown with its delivery rate');
  const summary = () => fleet.text('#radio-summary');
  await becomes(async () => (await summary()) === 'not limited · 1.2 kB/s used', 'an unlimited radio takes one short line');
  assert.equal(await fleet.text('#radio-classes'), '');
  assert.equal(await page.isVisible('#radio-list'), false);
  fixture.tell('radio held');
  const list = () => fleet.text('#radio-held');
  await becomes(async () => /posted, 6\.\d\/s sent/.test(await list()), async () => `the stream is held back: ${await list()}`);
  assert.match(await summary(), /^budget 5\.0 kB\/s · 4\.9 kB\/s used · ▲ held back: \d+\.\d posts\/s, 3 queue messages$/);
  assert.equal(await fleet.text('#radio-classes'), 'kB/s: presence 0.40 · telemetry 4.24 · discovery 0.30');
  assert.match(await fleet.text('#radio-held li'), /^uav2\/MissionControl3 wait, 2 expired$/, 'commands come first');
  assert.equal(await page.isVisible('#radio-list'), true);
  fixture.tell('radio free');
  await becomes(async () => (await summary()) === 'not limited · 1.2 kB/s used', 'what is gone goes');
  await becomes(async () => !(await page.isVisible('#radio-list')), async () => `nothing is held back: ${await list()}`);
  fixture.tell('silence');
  await becomes(async () => /ago\)$/.test(await summary()), 'it is marked as old');
  assert.match(await page.getAttribute('#radio-panel', 'class'), /\bold\b/);
  assert.deepEqual(fleet.errors, []);
}

async function sendsADraggedSearchArea(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  const numbers = () => page.evaluate(() => Object.fromEntries(['latitude_deg', 'longitude_deg', 'north_m', 'east_m'].map((name) => [name, Number(document.getElementById(`area-${name}`).value)])));
  const drag = async (selector, x, y) => {
    const box = await page.locator(selector).boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await page.mouse.down();
    await page.mouse.move(box.x + x / 2, box.y + y / 2, {steps: 4});
    await page.mouse.move(box.x + box.width / 2 + x, box.y + box.height / 2 + y, {steps: 4});
    await page.mouse.up();
  };
  await becomes(async () => (await numbers()).north_m === 400, 'the area in force is shown');
  const first = await numbers();
  await drag('.handle.centre', 60, -40);
  const moved = await numbers();
  assert.ok(moved.latitude_deg > first.latitude_deg && moved.longitude_deg > first.longitude_deg, 'it moved north-east');
  assert.deepEqual([moved.north_m, moved.east_m], [400, 600], 'its size stayed');
  await drag('.handle.corner >> nth=1', 50, 30);  // the north-western corner, inwards
  const resized = await numbers();
  assert.ok(resized.north_m < 400 && resized.east_m < 600, 'it became smaller');
  assert.ok(resized.latitude_deg < moved.latitude_deg && resized.longitude_deg > moved.longitude_deg, 'its far corner stayed');
  await watch(page, 5);
  assert.match(await fleet.text('#area-note'), /Not sent yet/);
  assert.doesNotMatch(fixture.output, /area/, 'nothing is sent before it is confirmed');
  assert.deepEqual(await numbers(), resized, 'what arrives meanwhile does not undo the draft');
  await page.click('#area-send');
  const [, ...sent] = await fixture.says(/area (\S+) (\S+) (\S+) (\S+)/);
  const expected = [resized.latitude_deg, resized.longitude_deg, resized.north_m, resized.east_m];
  sent.forEach((text, i) => assert.ok(Math.abs(Number(text) - expected[i]) <= 1e-4 * Math.abs(expected[i]), `${text} is not ${expected[i]}`));
  await becomes(async () => /Area 2/.test(await fleet.text('#area-note')), 'the new area is in force');
  assert.equal(await page.isDisabled('#area-send'), true);
  assert.deepEqual(fleet.errors, []);
}

async function recoversFromAReloadAndARestart(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is shown');
  const {page} = fleet;
  await page.reload();
  await fleet.isLive();
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is shown again');
  assert.ok((await page.locator('#events li').count()) > 0, 'the events from before are there');
  await page.waitForSelector('.pictures figure img');
  await page.evaluate(() => (window.sameDocument = true));

  await fixture.end();
  await becomes(async () => (await fleet.data('live')) === 'false', 'the page notices the loss');
  const first = await fleet.rowBecomes('uav1', (row) => row.old && row.marked && /STALE/.test(row.state), 'is shown as old');
  await fleet.rowBecomes('uav1', (row) => row.old && row.age >= first.age + 1, 'grows old by the clock of the page');
  assert.match(await fleet.text('#banner'), /No connection.*old/);
  assert.equal(await page.isVisible('#banner'), true);
  assert.match((await fleet.marker('uav1')).classes, /stale/);
  await becomes(async () => /OLD/.test(await fleet.text('.pictures figure')), 'the picture is marked as old');
  await fleet.select('uav1');
  await page.keyboard.press('h');
  await page.keyboard.press('Enter');
  assert.match(await fleet.text('#order-note'), /nothing can be sent/);
  assert.equal(await page.isVisible('#order'), true, 'Enter sends nothing');
  await page.keyboard.press('Escape');

  await startFixture(programs, 3, 'plain', new URL(url).port);
  await fleet.isLive();
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is fresh again');
  assert.equal(await page.isVisible('#banner'), false);
  assert.equal(await page.evaluate(() => window.sameDocument), true, 'without a reload');
  assert.deepEqual(fleet.errors, []);
}

async function asksForItsTokenAndOpensWithIt(programs) {
  const {fixture, url} = await startFixture(programs, 3, 'secured');
  const plain = new URL('/', url).href;
  const context = await openBrowser({ignoreHTTPSErrors: true});
  const stranger = await context.newPage();
  const answer = await stranger.goto(plain);
  assert.equal(answer.status(), 401);
  assert.match(await stranger.textContent('body'), /open the address/);
  assert.equal((await stranger.goto(url.replace(/.$/, 'x'))).status(), 401);
  await stranger.close();

  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  assert.equal(page.url(), plain, 'the token stays in no address');
  assert.equal(await page.evaluate(() => document.cookie), '', 'no script reads the cookie');
  await page.waitForSelector('.pictures figure img');
  await fleet.rowBecomes('uav2', (row) => /UP/.test(row.state) && !row.old, 'is shown');
  await fleet.select('uav2');
  await page.keyboard.press('h');
  await page.keyboard.press('Enter');
  await fixture.says(/order \d uav2 /, 'that the order came');
  await page.reload();
  await fleet.isLive();
  assert.deepEqual(fleet.errors, []);

  await fixture.end();
  await becomes(async () => (await fleet.data('live')) === 'false', 'the page notices the loss');
  const again = await startFixture(programs, 3, 'secured', new URL(url).port);
  await becomes(async () => /open the address/.test(await fleet.text('#banner')), 'the page says that the token is another');
  const anew = await FleetPage.open(again.url);
  await anew.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is shown');
}

async function worksByKeyboardAlone(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  const press = async (...keys) => {
    for (const key of keys) await page.keyboard.press(key);
  };
  const type = async (text) => {
    await press('Control+a');
    await page.keyboard.type(text);
  };
  await fleet.rowBecomes('uav2', (row) => /UP/.test(row.state), 'is there');
  // The table is reached by Tab, and an aircraft chosen by the arrows.
  await becomes(async () => {
    await press('Tab');
    return page.evaluate(() => document.activeElement.closest('#fleet tbody') !== null);
  }, 'Tab reaches the table');
  await press('ArrowDown', 'ArrowDown');
  assert.match(await fleet.text('#selected-title'), /^uav2/);
  await press('k');
  assert.match(await fleet.text('#selected-title'), /^uav1/);
  await press('j');
  // Sends it to typed coordinates.
  await press('g');
  await type('91');
  await press('Enter');
  assert.match(await fleet.text('#order-error'), /latitude/, 'what is out of range is refused by the page');
  await type('47.41');
  await press('Tab');
  await type('8.55');
  await press('Enter');
  await fixture.says(/order 0 uav2 47.41 8.55/);
  await becomes(() => page.isHidden('#order'), 'the form is closed');
  await press('h');
  await press('Escape');
  assert.equal(await page.isHidden('#order'), true, 'Escape cancels');
  await press('h', 'Enter');
  await fixture.says(/order 1 uav2/);
  await becomes(() => page.isHidden('#order'), 'the form is closed');
  await press('s', 'Enter');
  await fixture.says(/order 2 uav2/);
  await becomes(() => page.isHidden('#order'), 'the form is closed');
  assert.equal((fixture.output.match(/order/g) ?? []).length, 3, 'nothing else was sent');
  // The search area by numbers, then by its handle.
  await press('a', 'Tab', 'Tab');
  await type('250');
  await press('Enter');
  await fixture.says(/area \S+ \S+ 250 600/);
  await becomes(async () => /Area 2/.test(await fleet.text('#area-note')), 'the new area is in force');
  await press('m');
  await becomes(async () => {
    await press('Tab');
    return page.evaluate(() => document.activeElement.classList.contains('centre'));
  }, 'Tab reaches the handle of the area');
  await press('ArrowUp', 'Shift+ArrowUp');
  const latitude = Number(await page.inputValue('#area-latitude_deg'));
  assert.ok(Math.abs((latitude - 47.3977) * 111195 - 110) < 1, `110 m to the north, not ${latitude}`);
  // Help says all this.
  await press('?');
  assert.equal(await page.isVisible('#keys'), true);
  assert.equal(await page.locator('#keys-list dt').count() >= 10, true);
  await press('Escape');
  assert.equal(await page.isVisible('#keys'), false);
  assert.deepEqual(fleet.errors, []);
}

// WCAG 2.2, relative luminance and contrast.
function contrast(a, b) {
  const luminance = (colour) => {
    const [red, green, blue] = [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16) / 255)
      .map((value) => (value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4));
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  };
  const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
  return (high + 0.05) / (low + 0.05);
}

async function hasThemesThatLast(programs) {
  const {url} = await startFixture(programs, 3);
  await openBrowser({colorScheme: 'dark'});
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  const themeBecomes = (theme) => becomes(async () => (await fleet.data('theme')) === theme, `the theme is ${theme}`);
  await themeBecomes('dark');  // as the system prefers
  await page.emulateMedia({colorScheme: 'light'});
  await themeBecomes('light');
  const devtools = await page.context().newCDPSession(page);
  await devtools.send('Emulation.setEmulatedMedia', {features: [{name: 'prefers-contrast', value: 'more'}]});
  await themeBecomes('contrast');
  await devtools.send('Emulation.setEmulatedMedia', {features: []});
  const least = {light: [4.5, 4.5], dark: [4.5, 4.5], contrast: [7, 7], night: [4.5, 2.2]};
  for (const theme of ['light', 'dark', 'contrast', 'night']) {
    await page.keyboard.press('t');
    assert.equal(await fleet.data('theme'), theme);
    const colours = await page.evaluate(() => {
      const style = getComputedStyle(document.documentElement);
      return Object.fromEntries(['panel', 'text', 'quiet', 'up', 'stale', 'lost', 'accent', 'on-accent', 'select'].map((name) => {
        const value = style.getPropertyValue(`--${name}`).trim();
        return [name, value];
      }));
    });
    for (const name of ['text', 'up', 'stale', 'lost'])
      assert.ok(contrast(colours[name], colours.panel) >= least[theme][0], `${theme}: ${name} has ${contrast(colours[name], colours.panel)}`);
    assert.ok(contrast(colours.quiet, colours.panel) >= least[theme][1], `${theme}: quiet has ${contrast(colours.quiet, colours.panel)}`);
    assert.ok(contrast(colours['on-accent'], colours.accent) >= 4.5, `${theme}: buttons`);
    assert.ok(contrast(colours.text, colours.select) >= 3.5, `${theme}: the selected row`);
  }
  await page.reload();
  await fleet.isLive();
  assert.equal(await fleet.data('theme'), 'night', 'the choice outlives a reload');
  // A state is told by a word, and what is old by a sign, not by colour alone.
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.marked, 'is shown');
  await closeBrowser();
}

export const cases = {
  follows_twenty_aircraft: followsTwentyAircraft,
  shows_hostile_texts_as_text: showsHostileTextsAsText,
  shows_the_problems_that_there_are_now: showsTheProblemsThatThereAreNow,
  shows_what_the_radio_holds_back: showsWhatTheRadioHoldsBack,
  shows_a_replay_across_the_page: showsAReplayAcrossThePage,
  sends_a_dragged_search_area: sendsADraggedSearchArea,
  recovers_from_a_reload_and_a_restart: recoversFromAReloadAndARestart,
  asks_for_its_token_and_opens_with_it: asksForItsTokenAndOpensWithIt,
  works_by_keyboard_alone: worksByKeyboardAlone,
  has_themes_that_last: hasThemesThatLast,
};
