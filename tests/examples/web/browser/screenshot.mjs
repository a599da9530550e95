// Makes the pictures of the page that the README shows, of a real fleet that searches, with one aircraft on its way to a
// point:
//   screenshot.mjs FOLDER_OF_PROGRAMS ROOT FILE.png [THEME [SECONDS [AIRCRAFT [WIDTHxHEIGHT]]]]
// SECONDS go by before the order. A width below 600 is a phone. Run it where playwright-core is: in the folder
// build/release/tests/examples/web/browser, after ctest -L web.
import {startFleet} from './fleet_cases.mjs';
import {closeBrowser, FleetPage, openBrowser} from './page.mjs';
import {becomes, endAll} from './processes.mjs';

const [bin, root, file, theme = 'light', seconds = '90', aircraft = '4', size = '1280x800'] = process.argv.slice(2);
const [width, height] = size.split('x').map(Number);
const phone = width < 600 ? {hasTouch: true, isMobile: true, deviceScaleFactor: 1} : {};
let status = 0;
try {
  const {url} = await startFleet({bin, root}, Number(aircraft), {vision: true, groundArguments: ['--search', '*']});
  await openBrowser({viewport: {width, height}, ...phone});
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  while ((await fleet.data('theme')) !== theme || (await fleet.text('#theme-name')) === 'auto') await page.keyboard.press('t');
  await becomes(async () => (await fleet.rows()) === Number(aircraft), 'all aircraft are there');
  await fleet.select('uav2');
  await page.keyboard.press('f');
  await page.waitForTimeout(Number(seconds) * 1000);
  await page.keyboard.press('g');
  await page.fill('#order-latitude', '47.3988');
  await page.fill('#order-longitude', '8.5494');
  await page.click('#order-send');
  await becomes(async () => (await page.locator('#commands li[data-progress="accepted"]', {hasText: 'goto'}).count()) === 1, 'it is on its way');
  await page.waitForTimeout(2000);
  await page.evaluate(() => {
    document.activeElement?.blur();
    window.scrollTo(0, 0);
  });
  await page.waitForTimeout(500);
  await page.screenshot({path: file});
  console.log(await fleet.text('#link'), fleet.errors);
} catch (error) {
  console.error(error);
  status = 1;
}
await closeBrowser();
await endAll();
process.exit(status);
