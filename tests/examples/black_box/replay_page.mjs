// The page of a ground station while a recording of the demo is played:
//   node replay_page.mjs URL [FILE.png]
// Run it where playwright-core is, beside page.mjs. With a file: a picture of it, after a while.
import assert from 'node:assert/strict';
import {closeBrowser, FleetPage, openBrowser} from './page.mjs';
import {becomes} from './processes.mjs';

const [url, file] = process.argv.slice(2);
let status = 0;
try {
  await openBrowser({viewport: {width: 1100, height: 700}});
  const fleet = await FleetPage.open(url);
  for (const uav of ['replay.uav1', 'replay.uav2', 'replay.uav3'])
    await fleet.rowBecomes(uav, (row) => /UP/.test(row.state) && !row.old, 'is shown as it flew');
  await becomes(() => fleet.page.isVisible('#replay'), 'the replay is announced');
  assert.match(await fleet.text('#replay'), /^▶ REPLAY of a recording, not live: .*replay\.uav1/);
  if (file) {
    await fleet.page.keyboard.press('f');
    await fleet.page.waitForTimeout(Number(process.argv[4] ?? '20') * 1000);
    await fleet.page.screenshot({path: file});
  }
  assert.deepEqual(fleet.errors, []);
  console.log('the page shows the replay');
} catch (error) {
  console.error(error);
  status = 1;
}
await closeBrowser();
process.exit(status);
