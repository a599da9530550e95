// The map of the page; over the scripted fleet of web_fixture.
import assert from 'node:assert/strict';
import {startFixture} from './fixture_cases.mjs';
import {FleetPage, openBrowser} from './page.mjs';
import {becomes} from './processes.mjs';

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

export const cases = {
  begins_the_trail_of_a_restarted_aircraft_anew: beginsTheTrailOfARestartedAircraftAnew,
  keeps_the_aircraft_on_the_map_if_the_area_is_far: keepsTheAircraftOnTheMapIfTheAreaIsFar,
  fits_the_map_to_where_the_fleet_is: fitsTheMapToWhereTheFleetIs,
  fits_the_map_to_lost_aircraft_if_there_are_no_others: fitsTheMapToLostAircraftIfThereAreNoOthers,
  fits_the_map_to_two_aircraft_that_are_far_apart: fitsTheMapToTwoAircraftThatAreFarApart,
  marks_a_target_that_nobody_sees: marksATargetThatNobodySees,
  keeps_the_map_usable_with_a_bad_position: keepsTheMapUsableWithABadPosition,
  keeps_a_destination_on_the_map_until_it_is_done: keepsADestinationOnTheMapUntilItIsDone,
};
