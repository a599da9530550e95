// Cases over the real programs: a ground station and aircraft, joined by DDS over loopback.
import assert from 'node:assert/strict';
import {FleetPage, openBrowser} from './page.mjs';
import {becomes, freeDomain, Program} from './processes.mjs';

// Each aircraft is two processes, as it is in the air; here the second one only if it is wanted.
export async function startFleet({bin, root}, count, {vision = false, groundArguments = []} = {}) {
  const domain = String(freeDomain());
  const swarm = `${root}/examples/swarm`;
  const common = (name, node) => ['--config', `${swarm}/${name}.yaml`, '--node', node, '--domain', domain];
  const uavs = [];
  const visions = [];
  const startUav = (i) => uavs.push(new Program(`${bin}/uav`, [...common('uav', `uav${i}`), '--world', `${swarm}/world.yaml`]));
  for (let i = 1; i <= count; i++) {
    startUav(i);
    if (vision)
      visions.push(new Program(`${bin}/vision`, [...common('vision', `uav${i}.vision`), '--world', `${swarm}/world.yaml`]));
  }
  const ground = new Program(`${bin}/ground`, ['--config', `${root}/examples/ground_station/ground.yaml`, '--domain', domain,
    '--web', '0', '--search-area', '47.3977', '8.5456', '400', '600', '510', ...groundArguments]);
  const [url] = await ground.says(/http:\S+/);
  return {uavs, visions, ground, url, startUav};
}

async function showsAKilledAircraftAsOld(programs) {
  const {uavs, visions, url} = await startFleet(programs, 2, {vision: true});
  await openBrowser();
  const fleet = await FleetPage.open(url);
  for (const node of ['uav1', 'uav2'])
    await fleet.rowBecomes(node, (row) => /UP/.test(row.state) && !row.old && !row.marked, 'is UP and fresh');
  const picture = fleet.page.locator('.pictures figure', {hasText: 'uav2'});
  await becomes(async () => (await picture.count()) === 1 && (await picture.locator('img').evaluate((image) => image.naturalWidth)) > 0,
    'a picture of uav2 is shown');
  await becomes(async () => !/OLD/.test(await picture.textContent()), 'it is fresh');
  await Promise.all([uavs[1].end(), visions[1].end()]);
  const stale = await fleet.rowBecomes('uav2', (row) => /STALE/.test(row.state), 'becomes STALE');
  assert.ok(stale.old && stale.marked, 'what is shown of it is marked as old');
  const lost = await fleet.rowBecomes('uav2', (row) => /LOST/.test(row.state), 'becomes LOST');
  assert.ok(lost.age > stale.age, 'its age grows');
  await fleet.rowBecomes('uav2', (row) => row.age > lost.age + 1, 'goes on growing old');
  assert.match(await picture.textContent(), /OLD/);
  const marker = await fleet.marker('uav2');
  assert.match(marker.classes, /lost/);
  assert.match(marker.label, /LOST \d/);
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is not touched by that');
  await becomes(async () => /uav2.*LOST/.test(await fleet.text('#events')), 'the log of events tells of it');
  assert.deepEqual(fleet.errors, []);
}

async function commandsAnAircraft(programs) {
  const {ground, url} = await startFleet(programs, 1);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  await fleet.select('uav1');
  // All that is shown of the first command, in order.
  await page.evaluate(() => {
    window.progress = [];
    new MutationObserver(() => {
      const item = [...document.querySelectorAll('#commands li[data-command]')].at(-1);
      const now = item?.dataset.progress;
      if (now && window.progress[window.progress.length - 1] !== now) window.progress.push(now);
    }).observe(document.getElementById('commands'), {subtree: true, childList: true, attributes: true});
  });
  const marker = await fleet.marker('uav1');
  await page.mouse.click(marker.x + 40, marker.y - 30);
  assert.equal(await page.isVisible('#order'), true);
  const point = [Number(await page.inputValue('#order-latitude')), Number(await page.inputValue('#order-longitude'))];
  assert.equal(await page.locator('#commands li[data-command]').count(), 0, 'nothing is sent before it is confirmed');
  await page.fill('#order-speed', '20');
  await page.click('#order-send');
  await becomes(async () => (await page.locator('#commands li[data-progress="done"]').count()) === 1,
    async () => `the command is done; ${await fleet.text('#commands')}; ${await fleet.text('#order-error')}`);
  const progress = await page.evaluate(() => window.progress);
  const order = ['sent', 'delivered', 'accepted', 'done'];
  assert.deepEqual(progress, order.filter((one) => progress.includes(one)), 'in this order');
  assert.equal(progress[progress.length - 1], 'done');
  const [latitude, longitude] = (await fleet.text('#selected-text')).match(/-?\d+\.\d+/g).map(Number);
  const away = Math.hypot((latitude - point[0]) * 111195, (longitude - point[1]) * 75270);
  assert.ok(away < 150, `the aircraft is ${away} m from where it was sent`);
  await page.keyboard.press('Escape');
  await page.keyboard.press('h');
  await page.keyboard.press('Enter');
  await becomes(async () => (await page.locator('#commands li[data-command]').count()) === 2, 'there is a second command');
  await becomes(async () => /(accepted|done)/.test(await page.locator('#commands li[data-command]').first().getAttribute('data-progress')),
    async () => `it is called home; ${await fleet.text('#commands')}`);
  // An open page does not keep the ground station from ending in order.
  // Its verdict on the flight is no matter of the page: a flight of four seconds has too few poses to judge.
  assert.equal(typeof await ground.end('SIGINT'), 'number', `ended by a signal: ${ground.output.slice(-500)}`);
  assert.match(ground.output, /^(Passed|Failed)$/m, 'the ground station gave its verdict');
  await becomes(async () => (await fleet.data('live')) === 'false', 'the page notices');
  assert.deepEqual(fleet.errors, []);
}

// A point and a search area inside the ground: each is declined by the aircraft itself.
async function declinesWhatIsTooLow(programs) {
  const {url} = await startFleet(programs, 1);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  await fleet.select('uav1');
  await becomes(async () => /m above the ground/.test(await fleet.text('#selected-text')), 'the height of the ground is known');
  await page.keyboard.press('g');
  await page.fill('#order-altitude', '50');
  await page.click('#order-send');
  await page.click('#order-send');
  const why = '50 m above sea level is 380 m below the ground and below the floor of 460 m';
  await becomes(async () => (await fleet.text('#commands li[data-command]')).includes(`declined: ${why}`), async () => `it is declined: ${await fleet.text('#commands')}`);
  // The first area comes a while after the aircraft.
  await becomes(async () => (await page.locator('#commands li[data-area="1"]', {hasText: '1 of 1 fly area 1'}).count()) === 1,
    async () => `the first area is flown: ${await fleet.text('#commands')}`);
  await page.keyboard.press('a');
  await page.fill('#area-altitude_m', '100');
  await page.click('#area-send');
  await page.click('#area-send');
  const whyNot = '100 m above sea level is 330 m below the ground and below the floor of 460 m';
  await becomes(async () => (await fleet.text('#events')).includes(`declines the search area: ${whyNot}`), async () => `so is the area: ${await fleet.text('#events')}`);
  await becomes(async () => (await fleet.text('#commands li[data-area="2"]')).includes(`0 of 1 fly area 2; declined by uav1: ${whyNot}; flying area 1`), async () => `and its outcome is in the list: ${await fleet.text('#commands')}`);
  await page.keyboard.press('Escape');
  await page.keyboard.press('s');
  await page.keyboard.press('Enter');
  await becomes(async () => (await fleet.text('#commands li[data-command]')).includes(`declined: search area: ${whyNot}`), 'it does not search another area than the one that was sent');
  assert.deepEqual(fleet.errors, []);
}

// An aircraft that a person has called home, is killed, and comes back.
async function leavesAnAircraftThatIsBackToThePerson(programs) {
  const {uavs, url, startUav} = await startFleet(programs, 1, {groundArguments: ['--search', '*']});
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /TRANSIT|SEARCH/.test(row.mission), 'was sent searching');
  await fleet.select('uav1');
  await page.keyboard.press('h');
  await page.keyboard.press('Enter');
  await fleet.rowBecomes('uav1', (row) => /HOME/.test(row.mission), 'flies home');
  await uavs[0].end();
  await fleet.rowBecomes('uav1', (row) => /STALE|LOST/.test(row.state), 'is gone');
  startUav(1);
  await becomes(async () => /uav1.*is back without orders/.test(await fleet.text('#events')), async () => `an event says so: ${await fleet.text('#events')}`);
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && /IDLE/.test(row.mission) && /back without orders/.test(row.mission), 'waits');
  assert.equal(await page.locator('#commands li[data-command]').count(), 2, 'nothing was sent to it');
  assert.deepEqual(fleet.errors, []);
}

export const cases = {
  declines_what_is_too_low: declinesWhatIsTooLow,
  leaves_an_aircraft_that_is_back_to_the_person: leavesAnAircraftThatIsBackToThePerson,
  shows_a_killed_aircraft_as_old: showsAKilledAircraftAsOld,
  commands_an_aircraft: commandsAnAircraft,
};
