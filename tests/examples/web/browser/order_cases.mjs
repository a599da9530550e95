// Orders of an operator, and the questions before them; over the scripted fleet of web_fixture.
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

export const cases = {
  asks_again_before_a_far_search_area: asksAgainBeforeAFarSearchArea,
  calls_home_those_that_have_a_mission: callsHomeThoseThatHaveAMission,
  asks_again_before_a_far_point: asksAgainBeforeAFarPoint,
  keeps_what_was_typed_for_this_order_alone: keepsWhatWasTypedForThisOrderAlone,
  shows_and_keeps_the_focus: showsAndKeepsTheFocus,
  asks_again_if_the_position_is_not_known: asksAgainIfThePositionIsNotKnown,
  drops_orders_that_died_with_the_aircraft: dropsOrdersThatDiedWithTheAircraft,
  orders_several_aircraft_at_once: ordersSeveralAircraftAtOnce,
  asks_again_outside_of_the_geofence: asksAgainOutsideOfTheGeofence,
  asks_again_before_a_large_descent: asksAgainBeforeALargeDescent,
  puts_the_order_where_it_covers_nothing: putsTheOrderWhereItCoversNothing,
};
