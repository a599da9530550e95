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
  await becomes(async () => /100 m above sea level: 410 m lower than the area in force, 330 m BELOW the ground/.test(await fleet.text('#area-note')), async () => `the note says it: ${await fleet.text('#area-note')}`);
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
  assert.match(await fleet.text('#commands li:last-child'), /^1uav1goto/);
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

export const cases = {
  asks_again_before_a_large_descent: asksAgainBeforeALargeDescent,
  tells_what_is_declined_and_who_is_back_without_orders: tellsWhatIsDeclinedAndWhoIsBackWithoutOrders,
  says_what_is_missing: saysWhatIsMissing,
  keeps_a_destination_on_the_map_until_it_is_done: keepsADestinationOnTheMapUntilItIsDone,
  puts_the_order_where_it_covers_nothing: putsTheOrderWhereItCoversNothing,
};
