// What an operator must not be led to do, or to overlook; over the scripted fleet of web_fixture.
import assert from 'node:assert/strict';
import {startFixture} from './fixture_cases.mjs';
import {FleetPage, openBrowser} from './page.mjs';
import {becomes} from './processes.mjs';

async function asksAgainBeforeALargeDescent(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && /SEARCH/.test(row.mission), 'is UP and has said how high the ground is');
  await fleet.select('uav1');
  const note = () => fleet.text('#order-note');
  const openAt = async (altitude) => {
    await page.click('#act-goto');
    await page.fill('#order-altitude', String(altitude));
  };
  await openAt(490);
  assert.match(await page.textContent('#order label:has(#order-altitude)'), /above sea level/);
  assert.match(await note(), /490 m above sea level: 1\d m lower than it is now, 60 m above the ground, which is at 430 m\./);
  await page.click('#order-send');
  await fixture.says(/order 0 uav1 \S+ \S+ 490\n/, 'a small descent is not asked about');
  await becomes(() => page.isHidden('#order'), 'the form is closed');

  await openAt(50);
  assert.match(await note(), /50 m above sea level: 45\d m lower than it is now, 380 m BELOW the ground/);
  assert.match(await note(), /▲ Below the floor of uav1 \(460 m\): it will be declined\./);
  await page.focus('#order-altitude');
  await page.keyboard.press('Enter');
  assert.match(await fleet.text('#order-again'), /a descent of 45\d m and a point that is not above the ground and a height below the floor.*Is it meant so\?/);
  await page.keyboard.press('Enter');
  await becomes(() => page.isHidden('#order'), 'Enter alone does not answer the question: it cancels');
  await openAt(50);
  await page.click('#order-send');
  await page.fill('#order-altitude', '60');
  assert.equal(await fleet.text('#order-again'), '', 'another altitude is another question');
  await page.click('#order-send');
  assert.equal((fixture.output.match(/order/g) ?? []).length, 1, 'nothing else was sent');
  await page.click('#order-send');
  await fixture.says(/order 0 uav1 \S+ \S+ 60\n/, 'it is sent when it was confirmed');

  // The search area likewise.
  await page.keyboard.press('a');
  assert.match(await page.textContent('#area label:has(#area-altitude_m)'), /above sea level/);
  await page.fill('#area-altitude_m', '100');
  await becomes(async () => /100 m above sea level: 410 m lower than the wanted area, 330 m BELOW the ground/.test(await fleet.text('#area-note')), async () => `the note says it: ${await fleet.text('#area-note')}`);
  assert.match(await fleet.text('#area-note'), /▲ Below the floor of uav1, uav2, uav3 \(460 m\): it will be declined\./);
  await page.click('#area-send');
  assert.match(await fleet.text('#area-again'), /a descent of 410 m.*Is it meant so\?/);
  assert.doesNotMatch(fixture.output, /area/, 'nothing is sent before it is confirmed');
  await page.click('#area-send');
  await fixture.says(/area \S+ \S+ 400 600 100\n/);
  assert.deepEqual(fleet.errors, []);
}

async function tellsWhatIsDeclinedAndWhoIsBackWithoutOrders(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  await fleet.rowBecomes('uav2', (row) => /UP/.test(row.state), 'is UP');
  await fleet.select('uav2');
  fixture.tell('decline uav2 100 m above sea level is below the floor of 460 m');
  await becomes(async () => /declines the search area: 100 m above sea level is below the floor of 460 m/.test(await fleet.text('#selected-text')), 'the line of the aircraft says it');
  await becomes(async () => /uav2.*declines the search area: 100 m/.test(await fleet.text('#events')), 'an event says it');
  fixture.tell('orders uav2');
  await becomes(async () => /uav2.*is back without orders/.test(await fleet.text('#events')), 'an event says that it is back');
  await fleet.rowBecomes('uav2', (row) => /back without orders/.test(row.mission), 'is marked');
  assert.deepEqual(fleet.errors, []);
}

async function saysWhatIsMissing(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  fixture.tell('beatless uav1');
  const row = await fleet.rowBecomes('uav1', (one) => /STALE/.test(one.state) && /beats missing, poses arriving/.test(one.mission), 'says what is missing');
  assert.ok(row.age < 5, 'its poses arrive');
  await fleet.select('uav2');
  await page.keyboard.press('h');
  assert.equal(await page.isEnabled('#order-send'), true);
  fixture.tell('silence');
  await becomes(async () => /^▲ The gateway of the ground station is silent/.test(await fleet.text('#order-note')), async () => `the gateway comes first: ${await fleet.text('#order-note')}`);
  await fixture.end();
  await becomes(async () => /^✕ There is no connection to the ground station: nothing can be sent\.$/.test(await fleet.text('#order-note')), async () => `the ground station comes first: ${await fleet.text('#order-note')}`);
  assert.equal(await page.isEnabled('#order-send'), false, 'Send is off');
  await page.keyboard.press('Escape');
  await page.keyboard.press('n');
  assert.equal(await page.isEnabled('#area-send'), false, 'a search area cannot be sent either');
  assert.match(await fleet.text('#area-note'), /^✕ There is no connection/);
  assert.deepEqual(fleet.errors, []);
}

// How many dots of that colour the canvas of the map has around a place on it.
function dots(page, colour, x, y, radius) {
  return page.evaluate(([name, left, top, around]) => {
    const [red, green, blue] = [1, 3, 5].map((i) => parseInt(getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim().slice(i, i + 2), 16));
    const canvas = document.querySelector('#map canvas');
    const ratio = canvas.width / canvas.clientWidth;
    const size = Math.round(2 * around * ratio);
    const {data} = canvas.getContext('2d').getImageData((left - around) * ratio, (top - around) * ratio, size, size);
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      if (Math.abs(data[i] - red) + Math.abs(data[i + 1] - green) + Math.abs(data[i + 2] - blue) < 12) count += 1;
    return count;
  }, [colour, x, y, radius]);
}

async function keepsADestinationOnTheMapUntilItIsDone(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && /SEARCH/.test(row.mission), 'is UP');
  await fleet.select('uav1');
  const box = await page.locator('#map').boundingBox();
  const [x, y] = [box.width - 160, 120];
  assert.equal(await dots(page, 'route', x, y - 8, 16), 0, 'nothing is there yet');
  await page.mouse.click(box.x + x, box.y + y);
  await page.click('#order-send');
  await becomes(() => page.isHidden('#order'), 'the form is closed');
  await becomes(async () => (await dots(page, 'route', x, y - 8, 16)) > 20, 'a pin stands there');
  await becomes(async () => /^uav1 goto \d+ m$/.test(await page.getAttribute('#map', 'data-destinations')), 'with the way that is left');
  const marker = await fleet.marker('uav1');
  const middle = [(marker.x - box.x + x) / 2, (marker.y - box.y + y) / 2];
  assert.ok((await dots(page, 'route', ...middle, 24)) > 20, 'a line leads there');
  fixture.tell('progress 2');  // accepted
  await becomes(async () => /accepted/.test(await fleet.text('#commands [aria-current]')), 'it is accepted');
  assert.ok((await dots(page, 'route', x, y - 8, 16)) > 20, 'the pin stays');
  assert.match(await fleet.text('#selected-text'), /goto: \d+ m left/);
  fixture.tell('progress 3');  // done
  await becomes(async () => (await dots(page, 'route', x, y - 8, 16)) === 0, 'it goes when the command is done');
  assert.equal(await page.getAttribute('#map', 'data-destinations'), '');
  // Home has a place as well.
  await page.keyboard.press('h');
  await page.keyboard.press('Enter');
  await becomes(async () => /^uav1 home \d+ m$/.test(await page.getAttribute('#map', 'data-destinations')), 'the way home is shown');
  // All steps are events, with the number that the list of commands has.
  await becomes(async () => {
    const events = await fleet.text('#events');
    return ['delivered', 'accepted', 'done'].every((step) => events.includes(`command 1 (goto) ${step}`));
  }, 'every step is an event');
  assert.match(await page.locator('#commands li[data-command]').last().textContent(), /^1uav1goto/);
  assert.deepEqual(fleet.errors, []);
}

async function putsTheOrderWhereItCoversNothing(programs) {
  const {url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  await fleet.select('uav1');
  const map = await page.locator('#map').boundingBox();
  for (const [atX, atY] of [[60, map.height - 60], [map.width - 60, map.height - 60], [map.width - 60, 60], [80, 60], [map.width / 2, map.height / 2]]) {
    await page.keyboard.press('c');  // the aircraft is in the middle
    await page.keyboard.press('Escape');
    // Drag the map so that it comes there.
    await page.mouse.move(map.x + map.width / 2 + 40, map.y + map.height / 2 + 90);
    await page.mouse.down();
    await page.mouse.move(map.x + atX + 40, map.y + atY + 90, {steps: 4});
    await page.mouse.up();
    await page.keyboard.press('g');
    const form = await page.locator('#order').boundingBox();
    const marker = await fleet.marker('uav1');
    assert.ok(marker.x < form.x || marker.x > form.x + form.width || marker.y < form.y || marker.y > form.y + form.height,
      `the form covers the aircraft at ${atX}, ${atY}`);
    await page.keyboard.press('Escape');
  }
  assert.deepEqual(fleet.errors, []);
}

async function asksAgainBeforeAFarPoint(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  await fleet.select('uav1');
  await page.click('#act-goto');
  await page.fill('#order-latitude', '47.43');
  await page.click('#order-send');
  await fixture.says(/order 0 uav1 47.43 /, 'a point 4 km away is not asked about');
  await becomes(() => page.isHidden('#order'), 'the form is closed');
  await page.click('#act-goto');
  await page.fill('#order-latitude', '-47.4');
  await page.click('#order-send');
  assert.match(await fleet.text('#order-again'), /The point is 1054\d km away from uav1\. Is it meant so\?/);
  assert.equal((fixture.output.match(/order/g) ?? []).length, 1, 'it is not sent before it is confirmed');
  await page.click('#order-send');
  await fixture.says(/order 0 uav1 -47.4 /, 'it is sent when it was confirmed');
  assert.deepEqual(fleet.errors, []);
}

async function keepsWhatWasTypedForThisOrderAlone(programs) {
  const {url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav2', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  await fleet.select('uav1');
  await page.click('#act-goto');
  await page.fill('#order-altitude', '600');
  await page.fill('#order-speed', '7');
  const latitude = await page.inputValue('#order-latitude');
  const box = await page.locator('#map').boundingBox();
  const clickMap = () => page.mouse.click(box.x + box.width - 100, box.y + 60);
  await clickMap();
  assert.notEqual(await page.inputValue('#order-latitude'), latitude, 'another point');
  assert.deepEqual([await page.inputValue('#order-altitude'), await page.inputValue('#order-speed')], ['600', '7'], 'for another point it stays');
  await fleet.select('uav2');
  await clickMap();
  assert.match(await fleet.text('#order-title'), /uav2/);
  assert.deepEqual([await page.inputValue('#order-altitude'), await page.inputValue('#order-speed')], ['501', '12'], 'another aircraft gets its own');
  await page.fill('#order-speed', '9');
  await page.keyboard.press('Escape');
  await page.click('#act-goto');
  assert.equal(await page.inputValue('#order-speed'), '12', 'what was cancelled is forgotten');
  assert.deepEqual(fleet.errors, []);
}

async function showsAndKeepsTheFocus(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state), 'is UP');
  // What is drawn around the focused element, and how far inside of its edge.
  const outline = () => page.evaluate(() => {
    const style = getComputedStyle(document.activeElement);
    return {width: parseFloat(style.outlineWidth), offset: parseFloat(style.outlineOffset), style: style.outlineStyle};
  });
  await page.keyboard.press('m');
  const ofMap = await outline();
  assert.ok(ofMap.style === 'solid' && ofMap.offset <= -ofMap.width, `the frame of the map cuts nothing off: ${JSON.stringify(ofMap)}`);
  await becomes(async () => {
    await page.keyboard.press('Tab');
    return page.evaluate(() => document.activeElement.classList.contains('centre'));
  }, 'Tab reaches the handle of the area');
  const ofHandle = await outline();
  assert.ok(ofHandle.style === 'solid' && ofHandle.width >= 3, JSON.stringify(ofHandle));
  const focused = () => page.evaluate(() => document.activeElement.id || document.activeElement.tagName);
  await fleet.select('uav1');
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press('h');
  await page.keyboard.press('Enter');
  await fixture.says(/order 1 uav1/);
  await becomes(() => page.isHidden('#order'), 'the form is closed');
  await becomes(async () => (await focused()) === 'map', async () => `the focus is on the map: ${await focused()}`);
  await page.click('#act-home');
  await page.click('#order-send');
  await becomes(() => page.isHidden('#order'), 'the form is closed');
  await becomes(async () => (await focused()) === 'act-home', async () => `the focus is where it was: ${await focused()}`);
  await page.keyboard.press('a');
  await page.fill('#area-north_m', '300');
  await page.keyboard.press('Enter');
  await fixture.says(/area \S+ \S+ 300 600/);
  await becomes(async () => (await focused()) === 'SUMMARY', async () => `the focus is on the search area: ${await focused()}`);
  assert.deepEqual(fleet.errors, []);
}

// The aircraft whose markers are within the map.
async function onTheMap(fleet, nodes) {
  const box = await fleet.page.locator('#map').boundingBox();
  const inside = [];
  for (const node of nodes) {
    const marker = await fleet.marker(node);
    if (marker && marker.x >= box.x && marker.x <= box.x + box.width && marker.y >= box.y && marker.y <= box.y + box.height) inside.push(node);
  }
  return inside.join();
}

async function fitsTheMapToLostAircraftIfThereAreNoOthers(programs) {
  const {fixture, url} = await startFixture(programs, 2, 'noarea');
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await becomes(() => fleet.marker('uav2'), 'it is on the map');
  fixture.tell('lost uav1');
  fixture.tell('lost uav2');
  await fleet.rowBecomes('uav1', (row) => /LOST/.test(row.state), 'is LOST');
  await fleet.rowBecomes('uav2', (row) => /LOST/.test(row.state), 'is LOST');
  await page.reload();
  await becomes(async () => await onTheMap(fleet, ['uav1', 'uav2']) === 'uav1,uav2', 'both are on the map');
  await becomes(async () => /^\d+ m$/.test(await fleet.text('.leaflet-control-scale-line')), 'the map is fitted');
  assert.deepEqual(fleet.errors, []);
}

async function fitsTheMapToTwoAircraftThatAreFarApart(programs) {
  const {fixture, url} = await startFixture(programs, 2, 'noarea');
  fixture.tell('far uav2');
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await becomes(() => fleet.marker('uav2'), 'it is somewhere');
  await becomes(async () => {
    await page.click('#fit');
    return await onTheMap(fleet, ['uav1', 'uav2']) === 'uav1,uav2' && /^\d+ km$/.test(await fleet.text('.leaflet-control-scale-line'));
  }, async () => `the map shows both at 60 km: ${await onTheMap(fleet, ['uav1', 'uav2'])} ${await fleet.text('.leaflet-control-scale-line')}`);
  assert.deepEqual(fleet.errors, []);
}

async function asksAgainIfThePositionIsNotKnown(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  fixture.tell('noplace uav1');
  await becomes(async () => /bad position/.test((await fleet.marker('uav1')).label), 'its place is not known any more');
  await fleet.select('uav1');
  await page.click('#act-goto');
  await page.fill('#order-latitude', '47.43');
  await page.fill('#order-longitude', '8.5456');
  await page.click('#order-send');
  assert.match(await fleet.text('#order-again'), /The position of uav1 is not known\. Is it meant so\?/);
  assert.doesNotMatch(await fleet.text('#order-note'), /from where it is/);
  assert.doesNotMatch(fixture.output, /order/, 'it is not sent before it is confirmed');
  await page.click('#order-send');
  await fixture.says(/order 0 uav1 47.43 /, 'it is sent when it was confirmed');
  assert.deepEqual(fleet.errors, []);
}

async function ranksNoAircraftByAnOldBattery(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  // Both have to be UP: the order of others does not depend on a battery.
  const rows = async () => (await fleet.page.locator('#fleet tbody tr').allTextContents()).join(' ');
  fixture.tell('battery uav2 9');
  await becomes(async () => /uav2.*UP.*uav1.*UP/.test(await rows()), async () => `the low battery is first: ${await rows()}`);
  fixture.tell('noheart uav2');
  await becomes(async () => /uav1.*UP.*uav2.*UP/.test(await rows()), async () => `it is not known any more: ${await rows()}`);
  assert.deepEqual(fleet.errors, []);
}

async function fitsTheMapToWhereTheFleetIs(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  fixture.tell('nofix uav2');
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await becomes(() => fleet.marker('uav2'), 'its marker is somewhere');
  await page.click('#fit');
  const seen = () => onTheMap(fleet, ['uav1', 'uav2', 'uav3']);
  await becomes(async () => (await seen()) === 'uav1,uav3', async () => `one without a fix does not widen the map: ${await seen()}`);
  assert.match(await fleet.text('.leaflet-control-scale-line'), /^\d+ m$/);
  assert.deepEqual(fleet.errors, []);
}

async function forgetsALostAircraftUntilItIsHeardAgain(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav2', (row) => /UP/.test(row.state), 'is UP');
  assert.equal(await page.locator('button.forget').count(), 0, 'one that is there cannot be forgotten');
  fixture.tell('lost uav2');
  await fleet.rowBecomes('uav2', (row) => /LOST/.test(row.state), 'is LOST');
  await page.click('button.forget');
  await becomes(async () => (await fleet.row('uav2')) === null && (await fleet.marker('uav2')) === null, 'it is gone');
  const before = await fleet.data('snapshot');
  await becomes(async () => Number(await fleet.data('snapshot')) > Number(before) + 5, 'time goes on');
  assert.equal(await fleet.row('uav2'), null, 'it stays away');
  await page.keyboard.press('H');
  assert.equal(await fleet.text('#order-title'), 'Call uav1, uav2 home?', 'it may still fly');
  await page.keyboard.press('Escape');
  fixture.tell('up uav2');
  await fleet.rowBecomes('uav2', (row) => /UP/.test(row.state), 'is back');
  assert.deepEqual(fleet.errors, []);
}

async function marksALowBattery(programs) {
  const {fixture, url} = await startFixture(programs, 4);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  const names = () => page.locator('#fleet tbody td.name').allTextContents();
  await becomes(async () => (await names()).join() === 'uav1,uav2,uav3,uav4', 'by name');
  fixture.tell('battery uav2 24');
  fixture.tell('battery uav3 9');
  fixture.tell('lost uav4');
  await becomes(async () => (await names()).join() === 'uav4,uav3,uav2,uav1', async () => `what needs attention is first: ${await names()}`);
  const battery = (i) => page.locator('#fleet tbody td.battery').nth(i);
  assert.equal(await battery(1).textContent(), '■ 9');
  assert.match(await battery(1).getAttribute('class'), /\balarm\b/);
  assert.equal(await battery(2).textContent(), '▲ 24');
  assert.match(await battery(2).getAttribute('class'), /\bwarning\b/);
  const colour = (i) => battery(i).evaluate((cell) => getComputedStyle(cell).color);
  assert.equal(new Set([await colour(1), await colour(2), await colour(3)]).size, 3, 'in colours of their own');
  assert.deepEqual(fleet.errors, []);
}

async function marksATargetThatNobodySees(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  const row = (name) => page.locator('#targets tbody tr', {hasText: name}).first();
  const isOld = async (name) => /\bold\b/.test((await row(name).getAttribute('class')) ?? '');
  await becomes(async () => (await row('uav1').count()) === 1 && !(await isOld('uav1')), 'it is seen');
  fixture.tell('unseen uav1 29');
  await becomes(async () => /^29|^30/.test(await row('uav1').locator('td.age').textContent()), 'its age is shown');
  fixture.tell('unseen uav1 1140');
  await becomes(async () => /^! 19 min/.test(await row('uav1').locator('td.age').textContent()), 'its age is marked');
  assert.equal(await isOld('uav1'), true);
  assert.equal(await isOld('uav2'), false);
  assert.deepEqual(fleet.errors, []);
}

async function dropsOrdersThatDiedWithTheAircraft(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && /SEARCH/.test(row.mission), 'is UP');
  await fleet.select('uav1');
  await page.keyboard.press('h');
  await page.keyboard.press('Enter');
  await becomes(async () => /^uav1 home/.test(await page.getAttribute('#map', 'data-destinations')), 'the way home is shown');
  fixture.tell('orders uav1');
  await becomes(async () => (await page.getAttribute('#map', 'data-destinations')) === '', 'a new life does not follow it');
  assert.deepEqual(fleet.errors, []);
}

async function ordersSeveralAircraftAtOnce(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav3', (row) => /UP/.test(row.state), 'is UP');
  await page.keyboard.press('H');
  assert.equal(await fleet.text('#order-title'), 'Call uav1, uav2, uav3 home?');
  assert.doesNotMatch(fixture.output, /order/, 'nothing is sent before it is confirmed');
  await page.keyboard.press('Enter');
  for (const node of ['uav1', 'uav2', 'uav3']) await fixture.says(new RegExp(`order 1 ${node} `), `${node} is called home`);
  await becomes(async () => (await page.locator('#commands li[data-command]').count()) === 3, 'each has a command of its own');
  fixture.tell('progress 4 the battery is low');
  await becomes(async () => /uav\d.*declined: the battery is low/.test(await fleet.text('#commands li[data-command]')), 'with an outcome of its own');

  assert.equal(await fleet.text('#act-all-home-who'), '3 aircraft');
  // Some of them: marked by a key, and by Ctrl and a click.
  await fleet.select('uav1');
  await page.keyboard.press('x');
  await page.locator('#fleet tbody tr', {hasText: 'uav3'}).first().click({modifiers: ['Control']});
  assert.match(await fleet.text('#marked-text'), /marked: uav1, uav3\.$/);
  assert.match(await page.getAttribute('#fleet tbody tr:nth-child(3)', 'class'), /\bmarked\b/);
  assert.equal(await fleet.text('#act-home-who'), 'uav1, uav3', 'the button says for which');
  assert.match((await fleet.marker('uav3')).classes, /\bmarked\b/, 'and so does the map');
  await page.keyboard.press('s');
  assert.equal(await fleet.text('#order-title'), 'Let uav1, uav3 search?');
  assert.equal(await fleet.text('#order-send'), 'Let uav1, uav3 search');
  await page.click('#order-send');
  for (const node of ['uav1', 'uav3']) await fixture.says(new RegExp(`order 2 ${node} `), `${node} is told to search`);
  await becomes(async () => (await page.locator('#commands li[data-command]').count()) === 5, 'and no other');
  await becomes(async () => (await fleet.text('#marked-text')) === '', 'the marks end with the order');
  assert.doesNotMatch((await fleet.marker('uav3')).classes, /\bmarked\b/);
  assert.equal(await fleet.text('#act-home-who'), 'uav1', 'the next one is for the selected one');
  // A point is for one.
  await page.keyboard.press('g');
  assert.equal(await fleet.text('#order-title'), 'Send uav1 to a point');
  await page.keyboard.press('Escape');
  // A selection ends the marks: what follows is for the aircraft that was chosen last.
  await page.keyboard.press('x');
  await page.keyboard.press('J');
  await page.keyboard.press('x');
  assert.match(await fleet.text('#marked-text'), /marked: uav1, uav2\.$/, 'with Shift the marks are kept');
  await fleet.select('uav3');
  assert.equal(await fleet.text('#marked-text'), '');
  await page.keyboard.press('h');
  assert.equal(await fleet.text('#order-title'), 'Call uav3 home?');
  await page.keyboard.press('Escape');
  // A second mark takes the first one back.
  await page.keyboard.press('x');
  await page.locator('#fleet tbody tr', {hasText: 'uav3'}).first().click({modifiers: ['Control']});
  assert.equal(await fleet.text('#marked-text'), '');
  assert.deepEqual(fleet.errors, []);
}

// An area that all aircraft decline is not in force, whatever was sent.
async function tellsHowManyFlyTheSearchArea(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  const areas = () => page.getAttribute('#map', 'data-areas');
  await becomes(async () => (await areas()) === '1: 3 of 3', async () => `all fly the first area: ${await areas()}`);
  for (const node of ['uav1', 'uav2', 'uav3']) fixture.tell(`decline ${node} 60 m outside of the geofence`);
  await becomes(async () => /uav3.*declines the search area/.test(await fleet.text('#events')), 'they decline what comes');
  await page.keyboard.press('a');
  await page.fill('#area-north_m', '300');
  await page.click('#area-send');
  await fixture.says(/area \S+ \S+ 300 600/);
  const item = () => fleet.text('#commands li[data-area="2"] .what');
  const outcome = '▲ 0 of 3 fly area 2; declined by uav1, uav2, uav3: 60 m outside of the geofence; flying area 1';
  await becomes(async () => (await page.locator('#commands li[data-area="2"]').count()) === 1 && (await item()) === outcome, 'the list has its outcome');
  await becomes(async () => (await areas()) === '1: 3 of 3, 2: 0 of 3', async () => `both areas are on the map: ${await areas()}`);
  await becomes(async () => /0 of 3 fly area 2; declined by uav1, uav2, uav3/.test(await fleet.text('#events')), 'an event says it');
  assert.doesNotMatch(await fleet.text('#events'), /is in force/);
  assert.match(await fleet.text('#area-summary'), /^2: 300 × 600 m at 510 m, 0 of 3 fly it$/);
  assert.deepEqual(fleet.errors, []);
}

async function keepsTheMapUsableWithABadPosition(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav2', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  fixture.tell('badplace uav2');
  await fleet.rowBecomes('uav2', (row) => /bad position/.test(row.mission) && row.old, 'has a bad position');
  await becomes(async () => /uav2.*bad position: latitude must be from -90 to 90, not 95/.test(await fleet.text('#events')), 'an event says it');
  await becomes(async () => /▲ Bad position: uav2/.test(await fleet.text('#off-map')), 'the map says it');
  assert.match((await fleet.marker('uav2')).label, /^uav2 bad position/, 'its marker stays at its last good position');
  await page.keyboard.press('f');
  assert.equal(await onTheMap(fleet, ['uav1', 'uav3']), 'uav1,uav3');
  assert.match(await fleet.text('.leaflet-control-scale-line'), /^\d+ m$/, 'the map is not widened');
  fixture.tell('goodplace uav2');
  await fleet.rowBecomes('uav2', (row) => !/bad position/.test(row.mission) && !row.old, 'is good again');
  await becomes(async () => /uav2.*has a good position again/.test(await fleet.text('#events')), 'an event says that, too');
  // One that was never anywhere else: nobody knows that it is wrong, but no aircraft gets there.
  const outliers = await page.evaluate(async () => {
    const {withoutOutliers} = await import('/map.js');
    const near = [{lat: 47.4, lng: 8.5}, {lat: 47.41, lng: 8.5}];
    return [withoutOutliers([...near, {lat: 85, lng: 8.5}]).length, withoutOutliers([near[0], {lat: 85, lng: 8.5}]).length];
  });
  assert.deepEqual(outliers, [2, 2], 'of two nobody knows which one is wrong');
  assert.deepEqual(fleet.errors, []);
}

async function asksAgainOutsideOfTheGeofence(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state), 'is UP');
  assert.doesNotMatch(await fleet.text('#legend'), /geofence/);
  fixture.tell('fence 500');
  await becomes(async () => /dotted circle: geofence/.test(await fleet.text('#legend')), 'the map has the fence');
  await fleet.select('uav1');
  const sendTo = async (latitude) => {
    await page.click('#act-goto');
    await page.fill('#order-latitude', String(latitude));
    await page.fill('#order-longitude', '8.5456');
    await page.click('#order-send');
  };
  await sendTo(47.3977 + 0.003);
  await fixture.says(/order 0 uav1 47.4007/, 'a point inside is not asked about');
  await becomes(() => page.isHidden('#order'), 'the form is closed');
  await sendTo(47.3977 + 0.009);
  assert.match(await fleet.text('#order-again'), /The point is 50\d m outside of the geofence: uav1 will decline it\. Is it meant so\?/);
  await page.keyboard.press('Escape');
  // The search area likewise.
  await page.keyboard.press('a');
  await page.fill('#area-north_m', '2000');
  await page.click('#area-send');
  assert.match(await fleet.text('#area-again'), /The area is 5\d\d m outside of the geofence: aircraft will decline it\./);
  assert.doesNotMatch(fixture.output, /area/);
  assert.deepEqual(fleet.errors, []);
}

// A search area that is 3336 km away, by one wrong digit.
async function asksAgainBeforeAFarSearchArea(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && /SEARCH/.test(row.mission), 'is UP and has said how high the ground is');
  await fleet.rowBecomes('uav3', (row) => /SEARCH/.test(row.mission), 'has said so, too');
  await page.keyboard.press('a');
  assert.match(await fleet.text('#area-note'), /80 m above the ground, which is at 430 m/);
  await page.fill('#area-latitude_deg', '17.3977');
  assert.match(await fleet.text('#area-note'), /510 m above sea level: as high as the wanted area, the height of the ground is not known there\./);
  await page.click('#area-send');
  assert.match(await fleet.text('#area-again'), /The area is 3336 km away from uav1, uav2, uav3\. Is it meant so\?/);
  assert.doesNotMatch(fixture.output, /area/, 'nothing is sent before it is confirmed');
  await page.keyboard.press('Enter');
  assert.doesNotMatch(fixture.output, /area/, 'Enter alone does not confirm it');
  await page.keyboard.press('a');
  await page.fill('#area-latitude_deg', '47.41');
  await page.click('#area-send');
  await fixture.says(/area 47\.41 /, 'a near one is not asked about');

  // The order to search leads there as well.
  fixture.tell('fararea');
  await becomes(async () => /3: 400/.test(await fleet.text('#area-summary')), async () => `the far area is in force: ${await fleet.text('#area-summary')}`);
  await fleet.select('uav2');
  await page.keyboard.press('s');
  await page.keyboard.press('Enter');
  assert.match(await fleet.text('#order-again'), /The search area is 3336 km away from uav2\. Is it meant so\?/);
  assert.doesNotMatch(fixture.output, /order/);
  assert.deepEqual(fleet.errors, []);
}

async function keepsTheAircraftOnTheMapIfTheAreaIsFar(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  fixture.tell('fararea');
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  const shown = () => onTheMap(fleet, ['uav1', 'uav2', 'uav3']);
  await becomes(async () => (await shown()) === 'uav1,uav2,uav3', async () => `all that are UP are on the map: ${await shown()}`);
  await becomes(async () => /▲ Off the map: search area 2 \(3336 km away\)/.test(await fleet.text('#off-map')), async () => `the page says what is not: ${await fleet.text('#off-map')}`);
  fixture.tell('far uav2');
  await page.click('#fit');
  await becomes(async () => {
    await page.keyboard.press('f');
    return (await shown()) === 'uav1,uav2,uav3';
  }, async () => `one that is 60 km away is on it as well: ${await shown()}`);
  await fleet.select('uav1');
  await page.keyboard.press('c');
  await page.focus('#map');
  for (let i = 0; i < 12; i++) await page.keyboard.press('+');
  await becomes(async () => /Off the map: .*uav2/.test(await fleet.text('#off-map')), async () => `it says which aircraft are off: ${await fleet.text('#off-map')}`);
  assert.deepEqual(fleet.errors, []);
}

// A tool posted a pose once, and left.
async function callsHomeThoseThatHaveAMission(programs) {
  const {fixture, url} = await startFixture(programs, 3, 'poser');
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  for (const node of ['uav1', 'uav2']) await fleet.rowBecomes(node, (row) => /SEARCH/.test(row.mission), 'has a mission');
  await fleet.rowBecomes('uav3', (row) => /UP/.test(row.state), 'is there');
  fixture.tell('lost uav2');
  await fleet.rowBecomes('uav2', (row) => /LOST/.test(row.state), 'is LOST');
  fixture.tell('problems 3');
  await becomes(async () => (await page.locator('#problems li').count()) === 3, 'each has a problem');
  await page.click('button.forget');
  await becomes(async () => (await page.locator('#problems li').count()) === 2 && /2 problems/.test(await fleet.text('#problems-title')), 'its problem is dismissed with it');
  await page.keyboard.press('H');
  assert.equal(await fleet.text('#order-title'), 'Call uav1, uav2 home?');
  assert.match(await fleet.text('#order-note'), /Also for what was dismissed from the list: uav2\./);
  assert.deepEqual(fleet.errors, []);
}

async function putsAReplayThatIsOverLast(programs) {
  const {fixture, url} = await startFixture(programs, 2);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  fixture.tell('replay uav1');
  await fleet.rowBecomes('uav1', (row) => /replay/.test(row.mission), 'is marked as a replay');
  fixture.tell('lost uav1');
  await fleet.rowBecomes('uav1', (row) => /LOST/.test(row.state) && /replay/.test(row.mission), 'is still marked when it is over');
  assert.deepEqual(await page.locator('#fleet tbody td.name').allTextContents(), ['uav2', 'uav1']);
  assert.match(await fleet.text('#counts'), /1 UP.*0 LOST/, 'no aircraft is missing');
  await page.keyboard.press('H');
  assert.equal(await fleet.text('#order-title'), 'Call uav2 home?');
  assert.deepEqual(fleet.errors, []);
}

// Its new place has no line to where the one before was last.
async function beginsTheTrailOfARestartedAircraftAnew(programs) {
  const {url} = await startFixture(programs, 1);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const starts = await fleet.page.evaluate(async () => {
    const {Trails} = await import('/drawing.js');
    const trails = new Trails();
    const map = {project: ([latitude, longitude]) => ({x: longitude, y: latitude})};
    [7, 8, 9, 1, 2, 3].forEach((number, i) => trails.add(map, {node: 'uav1', pose: {latitude_deg: i, longitude_deg: i, number}}, 0.6 * i));
    return trails.trails.get('uav1').map(({number, isStart}) => `${number}${isStart ? ' begins' : ''}`);
  });
  assert.deepEqual(starts, ['7', '8', '9', '1 begins', '2', '3']);
  assert.deepEqual(fleet.errors, []);
}

// In the widest letters, on a screen that leaves the table the least room.
async function cutsNoButtonInTheTable(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser({viewport: {width: 1024, height: 768}});
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  while ((await fleet.data('theme')) !== 'contrast') await page.keyboard.press('t');
  fixture.tell('battery uav2 9');
  fixture.tell('lost uav2');
  await becomes(() => page.isVisible('button.forget'), 'it can be dismissed');
  const cut = await page.evaluate(() => {
    const button = document.querySelector('button.forget').getBoundingClientRect();
    const table = document.querySelector('.fleet .scroll').getBoundingClientRect();
    return button.right - table.right;
  });
  assert.ok(cut <= 0, `${cut} pixels of it are cut off`);
  assert.deepEqual(fleet.errors, []);
}

export const cases = {
  begins_the_trail_of_a_restarted_aircraft_anew: beginsTheTrailOfARestartedAircraftAnew,
  cuts_no_button_in_the_table: cutsNoButtonInTheTable,
  asks_again_before_a_far_search_area: asksAgainBeforeAFarSearchArea,
  keeps_the_aircraft_on_the_map_if_the_area_is_far: keepsTheAircraftOnTheMapIfTheAreaIsFar,
  calls_home_those_that_have_a_mission: callsHomeThoseThatHaveAMission,
  puts_a_replay_that_is_over_last: putsAReplayThatIsOverLast,
  asks_again_before_a_far_point: asksAgainBeforeAFarPoint,
  keeps_what_was_typed_for_this_order_alone: keepsWhatWasTypedForThisOrderAlone,
  shows_and_keeps_the_focus: showsAndKeepsTheFocus,
  fits_the_map_to_where_the_fleet_is: fitsTheMapToWhereTheFleetIs,
  forgets_a_lost_aircraft_until_it_is_heard_again: forgetsALostAircraftUntilItIsHeardAgain,
  fits_the_map_to_lost_aircraft_if_there_are_no_others: fitsTheMapToLostAircraftIfThereAreNoOthers,
  fits_the_map_to_two_aircraft_that_are_far_apart: fitsTheMapToTwoAircraftThatAreFarApart,
  asks_again_if_the_position_is_not_known: asksAgainIfThePositionIsNotKnown,
  ranks_no_aircraft_by_an_old_battery: ranksNoAircraftByAnOldBattery,
  marks_a_low_battery: marksALowBattery,
  marks_a_target_that_nobody_sees: marksATargetThatNobodySees,
  drops_orders_that_died_with_the_aircraft: dropsOrdersThatDiedWithTheAircraft,
  orders_several_aircraft_at_once: ordersSeveralAircraftAtOnce,
  tells_how_many_fly_the_search_area: tellsHowManyFlyTheSearchArea,
  keeps_the_map_usable_with_a_bad_position: keepsTheMapUsableWithABadPosition,
  asks_again_outside_of_the_geofence: asksAgainOutsideOfTheGeofence,
  asks_again_before_a_large_descent: asksAgainBeforeALargeDescent,
  tells_what_is_declined_and_who_is_back_without_orders: tellsWhatIsDeclinedAndWhoIsBackWithoutOrders,
  says_what_is_missing: saysWhatIsMissing,
  keeps_a_destination_on_the_map_until_it_is_done: keepsADestinationOnTheMapUntilItIsDone,
  puts_the_order_where_it_covers_nothing: putsTheOrderWhereItCoversNothing,
};
