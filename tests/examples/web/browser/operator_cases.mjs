// What an operator must not overlook; over the scripted fleet of web_fixture.
import assert from 'node:assert/strict';
import {startFixture} from './fixture_cases.mjs';
import {FleetPage, openBrowser} from './page.mjs';
import {becomes} from './processes.mjs';

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
  const row = await fleet.rowBecomes('uav1', (one) => /STALE/.test(one.state) && /only its positions come/.test(one.mission), 'says what is missing');
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

// Apart from the problems, with a sign, in the title of the tab, and with a sound if that is wanted.
async function raisesAlarmsInTheOperatorsWords(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  for (const node of ['uav1', 'uav2', 'uav3']) await fleet.rowBecomes(node, (row) => /UP/.test(row.state), 'is UP');
  await becomes(() => page.isHidden('#alarms-panel'), async () => `there is none: ${await fleet.text('#alarms')}`);
  assert.equal(await page.title(), 'Rabit ground station');
  fixture.tell('battery uav2 9');
  fixture.tell('lost uav1');
  await becomes(async () => /uav1is LOST: it has not been heard for .*uav2battery 9 %: it has to land soon$/.test(await fleet.text('#alarms')),
    async () => `both are told, the worst first: ${await fleet.text('#alarms')}`);
  assert.equal(await fleet.text('#alarms-title'), '■ 2 alarms');
  assert.equal(await page.title(), '■ 2 alarms · Rabit ground station');
  assert.equal(await fleet.text('#sound'), 'Sound off');
  await page.click('#sound');
  assert.equal(await fleet.text('#sound'), 'Sound on');
  await page.click('#sound');
  assert.equal(await fleet.text('#sound'), 'Sound off');
  fixture.tell('up uav1');
  await becomes(async () => (await page.title()).startsWith('■ 1 alarm · '), async () => `one is over: ${await page.title()}`);
  assert.deepEqual(fleet.errors, []);
}

async function saysWhichNumberOfTheSearchAreaIsWrong(programs) {
  const {url} = await startFixture(programs, 1);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await page.keyboard.press('a');
  await page.fill('#area-latitude_deg', '91');
  await becomes(async () => /^The latitude must be a number from -90 to 90/.test(await fleet.text('#area-error')),
    async () => `it says so: ${await fleet.text('#area-error')}`);
  await page.fill('#area-latitude_deg', '47.4');
  await becomes(async () => (await fleet.text('#area-error')) === '', 'it is right again');
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
  raises_alarms_in_the_operators_words: raisesAlarmsInTheOperatorsWords,
  says_which_number_of_the_search_area_is_wrong: saysWhichNumberOfTheSearchAreaIsWrong,
  cuts_no_button_in_the_table: cutsNoButtonInTheTable,
  puts_a_replay_that_is_over_last: putsAReplayThatIsOverLast,
  forgets_a_lost_aircraft_until_it_is_heard_again: forgetsALostAircraftUntilItIsHeardAgain,
  ranks_no_aircraft_by_an_old_battery: ranksNoAircraftByAnOldBattery,
  marks_a_low_battery: marksALowBattery,
  tells_how_many_fly_the_search_area: tellsHowManyFlyTheSearchArea,
  tells_what_is_declined_and_who_is_back_without_orders: tellsWhatIsDeclinedAndWhoIsBackWithoutOrders,
  says_what_is_missing: saysWhatIsMissing,
};
