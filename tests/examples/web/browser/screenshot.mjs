// Makes the picture of the page that the README shows, of a real fleet that searches:
//   screenshot.mjs FOLDER_OF_PROGRAMS ROOT FILE.png [THEME [SECONDS [AIRCRAFT [WIDTHxHEIGHT]]]]
// Run it where playwright-core is: in the folder build/release/tests/examples/web/browser, after ctest -L web.
import {startFleet} from './fleet_cases.mjs';
import {closeBrowser, FleetPage, openBrowser} from './page.mjs';
import {becomes, endAll} from './processes.mjs';

const [bin, root, file, theme = 'light', seconds = '90', aircraft = '4', size = '1280x800'] = process.argv.slice(2);
const [width, height] = size.split('x').map(Number);
let status = 0;
try {
  const {url} = await startFleet({bin, root}, Number(aircraft), {vision: true, groundArguments: ['--search', '*']});
  await openBrowser({viewport: {width, height}});
  const fleet = await FleetPage.open(url);
  while ((await fleet.data('theme')) !== theme || (await fleet.text('#theme-name')) === 'auto') await fleet.page.keyboard.press('t');
  await becomes(async () => (await fleet.rows()) === Number(aircraft), 'all aircraft are there');
  await fleet.select('uav2');
  await fleet.page.keyboard.press('f');
  await fleet.page.waitForTimeout(Number(seconds) * 1000);
  await fleet.page.screenshot({path: file});
  console.log(await fleet.text('#link'), fleet.errors);
} catch (error) {
  console.error(error);
  status = 1;
}
await closeBrowser();
await endAll();
process.exit(status);
