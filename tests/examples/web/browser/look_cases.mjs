// Whether everything can be read and hit: in each theme, on small screens, with fingers, with many aircraft.
import assert from 'node:assert/strict';
import {startFixture} from './fixture_cases.mjs';
import {FleetPage, openBrowser} from './page.mjs';
import {becomes} from './processes.mjs';

const THEMES = ['light', 'dark', 'contrast', 'night'];
const PHONE = {viewport: {width: 390, height: 844}, hasTouch: true, isMobile: true, deviceScaleFactor: 2};

// Of everything on the page that can be read: its contrast by WCAG 2.2 against what is behind it. Returns what has less
// than `least`, and what is old in a colour of what is fresh.
function unreadable(page, least) {
  return page.evaluate((limit) => {
    const root = getComputedStyle(document.documentElement);
    const rgb = (colour) => {
      if (colour.startsWith('#')) return [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16)).concat(1);
      const [red, green, blue, alpha = 1] = colour.match(/[\d.]+/g).map(Number);
      return [red, green, blue, alpha];
    };
    const variable = (name) => rgb(root.getPropertyValue(`--${name}`).trim());
    const luminance = (colour) => {
      const [red, green, blue] = colour.slice(0, 3).map((one) => one / 255).map((one) => (one <= 0.04045 ? one / 12.92 : ((one + 0.055) / 1.055) ** 2.4));
      return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
    };
    const contrast = (a, b) => {
      const [low, high] = [luminance(a), luminance(b)].sort((x, y) => x - y);
      return (high + 0.05) / (low + 0.05);
    };
    const behind = (element) => {
      for (let one = element; one; one = one.parentElement) {
        if (one.id === 'map' || one.classList.contains('map-frame')) return variable('map');
        const colour = rgb(getComputedStyle(one).backgroundColor);
        if (colour[3] === 1) return colour;
      }
      return variable('page');
    };
    const bad = [];
    let looked = 0;
    const fresh = ['text', 'up'].map((name) => variable(name).join());
    for (const element of document.querySelectorAll('body *')) {
      const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim() !== '');
      if (!own && element.tagName !== 'INPUT') continue;
      if (!element.checkVisibility({checkOpacity: true, checkVisibilityCSS: true}) || element.closest('.visually-hidden')) continue;
      looked += 1;
      const style = getComputedStyle(element);
      let opacity = 1;
      for (let one = element; one; one = one.parentElement) opacity *= Number(getComputedStyle(one).opacity);
      const value = contrast(rgb(style.color), behind(element));
      const name = `${element.tagName}.${element.className} “${(element.textContent || element.value).trim().slice(0, 30)}”`;
      if (value < limit || opacity < 1) bad.push(`${name}: ${value.toFixed(2)} at ${opacity}`);
      if (element.closest('.old') && fresh.includes(rgb(style.color).join())) bad.push(`${name} is old in a colour of what is fresh`);
    }
    // What is drawn on the canvas.
    for (const name of ['grid-text', 'trail', 'footprint', 'area', 'draft', 'target', 'old', 'text', 'route']) {
      const value = contrast(variable(name), variable('map'));
      if (value < limit) bad.push(`--${name} on the map: ${value.toFixed(2)}`);
    }
    return {bad, looked};
  }, least);
}

async function canBeReadInEveryTheme(programs) {
  const {fixture, url} = await startFixture(programs, 6);
  await openBrowser({viewport: {width: 1280, height: 1000}, colorScheme: 'light'});
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  await page.waitForSelector('.pictures figure:nth-child(6) img');
  for (const line of ['stale uav2', 'lost uav3', 'beatless uav4', 'problems 2', 'radio held', 'decline uav5 too low', 'orders uav1']) fixture.tell(line);
  await fleet.rowBecomes('uav3', (row) => /LOST/.test(row.state), 'is LOST');
  await fleet.rowBecomes('uav4', (row) => /STALE/.test(row.state), 'is STALE');
  await becomes(async () => /OLD/.test(await fleet.text('.pictures figure:nth-child(3)')), 'a picture is old');
  await page.keyboard.press('n');  // a draft of a search area
  await page.keyboard.press('Escape');
  const inEachTheme = async (what, selected) => {
    for (const theme of THEMES) {
      while ((await fleet.data('theme')) !== theme || (await fleet.text('#theme-name')) === 'auto') await page.keyboard.press('t');
      for (const node of selected) {
        await fleet.select(node);
        await page.keyboard.press('g');
        await page.fill('#order-altitude', '50');
        await page.keyboard.press('Enter');
        const {bad, looked} = await unreadable(page, theme === 'contrast' ? 7 : 4.5);
        assert.ok(looked > 100, `only ${looked} texts were looked at`);
        assert.deepEqual(bad, [], `${what}, ${theme}, ${node} selected`);
        await page.keyboard.press('Escape');
      }
      // States differ by sign, word and frame, not by colour alone.
      const shapes = await page.evaluate(() => ['uav1', 'uav2', 'uav3'].map((name) => {
        const {cells} = [...document.querySelectorAll('#fleet tbody tr')].find((one) => one.cells[0].textContent === name);
        const style = getComputedStyle(cells[1]);
        return `${cells[1].textContent} ${style.outlineStyle}`;
      }));
      if (what === 'live') assert.deepEqual(shapes, ['● UP none', '◐ STALE dashed', '✕ LOST solid'], theme);
    }
  };
  await inEachTheme('live', ['uav1', 'uav2', 'uav3', 'uav4']);
  await fixture.end();
  await becomes(() => page.isVisible('#banner'), 'everything is old');
  await inEachTheme('not connected', ['uav1', 'uav3']);
}

async function canBeHitWithFingers(programs) {
  const {fixture, url} = await startFixture(programs, 3);
  for (const options of [PHONE, {...PHONE, viewport: {width: 1280, height: 800}}]) {
    await openBrowser(options);
    const fleet = await FleetPage.open(url);
    const {page} = fleet;
    assert.equal(await page.evaluate(() => matchMedia('(pointer: coarse)').matches), true);
    await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is UP');
    await fleet.select('uav1');
    await page.click('#act-goto');
    await page.locator('#area-panel summary').click();
    const small = await page.evaluate(() => [...document.querySelectorAll('button, input, a, summary, tbody tr, .handle, .aircraft .touch, figure')]
      .filter((one) => one.checkVisibility({checkVisibilityCSS: true}) && !one.closest('#targets'))
      .map((one) => ({name: `${one.tagName}#${one.id}.${one.getAttribute('class') ?? ''}`, box: one.getBoundingClientRect()}))
      .filter(({box}) => box.width < 44 || box.height < 44)
      .map(({name, box}) => `${name}: ${box.width} x ${box.height}`));
    assert.deepEqual(small, [], `at ${options.viewport.width}`);
    assert.deepEqual(fleet.errors, []);
    await page.context().close();
  }
  fixture.tell('silence');
}

async function cutsNothingOnAPhone(programs) {
  const {fixture, url} = await startFixture(programs, 5);
  await openBrowser(PHONE);
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  for (const line of ['beatless uav2', 'lost uav3', 'problems 2', 'radio held', 'decline uav1 50 m above sea level is 380 m below the ground and below the floor of 460 m']) fixture.tell(line);
  await fleet.rowBecomes('uav3', (row) => /LOST/.test(row.state), 'is LOST');
  await fleet.select('uav1');
  await page.click('#act-goto');
  await page.fill('#order-altitude', '50');
  await page.click('#order-send');
  await page.locator('#area-panel summary').click();
  const cut = () => page.evaluate(() => {
    const width = document.documentElement.clientWidth;
    const found = [];
    if (document.documentElement.scrollWidth > width) found.push(`the page is ${document.documentElement.scrollWidth} wide`);
    for (const one of document.querySelectorAll('body *')) {
      if (one.closest('#map, .visually-hidden, dialog, .pictures') || !one.checkVisibility({checkVisibilityCSS: true})) continue;
      const box = one.getBoundingClientRect();
      if (box.width === 0) continue;
      const name = `${one.tagName}#${one.id}.${one.className} “${one.textContent.trim().slice(0, 30)}”`;
      if (box.left < -0.5 || box.right > width + 0.5) found.push(`${name} from ${box.left} to ${box.right}`);
      if (one.scrollWidth > one.clientWidth + 1 && getComputedStyle(one).overflowX !== 'visible' && one.tagName !== 'INPUT')
        found.push(`${name} shows ${one.clientWidth} of ${one.scrollWidth}`);
    }
    return found;
  });
  assert.deepEqual(await cut(), []);
  const tops = await page.evaluate(() => ['.map-pane', '.panel.fleet', '#selected-text', '.pictures'].map((one) => document.querySelector(one).getBoundingClientRect().top));
  assert.deepEqual(tops, [...tops].sort((a, b) => a - b), 'map, fleet, what to do with it, and then the pictures');
  await fixture.end();
  await becomes(() => page.isVisible('#banner'), 'the banner is shown');
  assert.deepEqual(await cut(), [], 'nor when the connection is lost');
  assert.deepEqual(fleet.errors, []);
}

async function fitsTheMapToANewSizeUnlessItWasMoved(programs) {
  const {url} = await startFixture(programs, 3);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state) && !row.old, 'is UP');
  // How much of the map's width or height the search area takes, whichever is more, and whether all of it is seen.
  const shown = () => page.evaluate(() => {
    const map = document.getElementById('map').getBoundingClientRect();
    const boxes = [...document.querySelectorAll('.handle')].map((one) => one.getBoundingClientRect());
    const xs = boxes.map((one) => one.x + one.width / 2);
    const ys = boxes.map((one) => one.y + one.height / 2);
    const inside = Math.min(...xs) >= map.left && Math.max(...xs) <= map.right && Math.min(...ys) >= map.top && Math.max(...ys) <= map.bottom;
    return {inside, share: Math.max((Math.max(...xs) - Math.min(...xs)) / map.width, (Math.max(...ys) - Math.min(...ys)) / map.height)};
  });
  await becomes(async () => (await shown()).inside, 'the area is seen');
  await page.setViewportSize({width: 700, height: 600});
  await becomes(async () => (await shown()).inside, async () => `it is seen on a small screen: ${JSON.stringify(await shown())}`);
  await page.setViewportSize({width: 1900, height: 1100});
  await becomes(async () => (await shown()).share > 0.5, async () => `it makes use of a large one: ${JSON.stringify(await shown())}`);
  await page.focus('#map');
  await page.keyboard.press('+');
  await page.keyboard.press('ArrowLeft');
  const centreAndScale = () => page.evaluate(() => {
    const map = document.getElementById('map').getBoundingClientRect();
    const [middle, corner] = [...document.querySelectorAll('.handle')].map((one) => one.getBoundingClientRect());
    return [middle.x - map.x - map.width / 2, middle.x - corner.x].map(Math.round);
  });
  const before = await centreAndScale();
  await page.setViewportSize({width: 1400, height: 900});
  await becomes(() => page.evaluate(() => document.querySelector('#map canvas').clientWidth < 1100), 'the map has its new size');
  const after = await centreAndScale();
  assert.equal(after[1], before[1], 'what a person has zoomed stays so');
  assert.deepEqual(fleet.errors, []);
}

async function showsFirstWhatNeedsAttention(programs) {
  const {fixture, url} = await startFixture(programs, 20);
  await openBrowser();
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await becomes(async () => (await fleet.rows()) === 20, 'there are twenty rows');
  fixture.tell('stale uav12');
  fixture.tell('lost uav17');
  const names = () => page.evaluate(() => [...document.querySelectorAll('#fleet tbody tr')].map((row) => row.cells[0].textContent));
  await becomes(async () => (await names()).slice(0, 3).join() === 'uav17,uav12,uav1', async () => `LOST first, then STALE: ${await names()}`);
  await page.keyboard.press('j');
  assert.match(await fleet.text('#selected-title'), /^uav17/, 'keys go the same way');
  const sizes = await page.evaluate(() => {
    const scroll = document.querySelector('.fleet .scroll');
    return {hidden: scroll.scrollHeight - scroll.clientHeight, events: document.querySelector('.events').getBoundingClientRect().height};
  });
  assert.ok(sizes.hidden <= 0 || sizes.events <= 100, `the table of the aircraft comes before the events: ${JSON.stringify(sizes)}`);
  const overlaps = () => page.evaluate(() => {
    const boxes = [...document.querySelectorAll('.aircraft .label')].filter((one) => one.checkVisibility({checkVisibilityCSS: true}))
      .map((one) => ({name: one.textContent, box: one.getBoundingClientRect()}));
    const found = [];
    boxes.forEach((a, i) => boxes.slice(i + 1).forEach((b) => {
      if (a.box.left < b.box.right && a.box.right > b.box.left && a.box.top < b.box.bottom && a.box.bottom > b.box.top) found.push(`${a.name} and ${b.name}`);
    }));
    const map = document.getElementById('map').getBoundingClientRect();
    for (const {name, box} of boxes)
      if (box.left < map.left || box.right > map.right || box.top < map.top || box.bottom > map.bottom) found.push(`${name} and the edge of the map`);
    return {found, shown: boxes.map((one) => one.name)};
  });
  for (let i = 0; i < 20; i++) {
    const {found, shown} = await overlaps();
    assert.deepEqual(found, [], 'no label covers another');
    assert.ok(i > 10 || shown.length >= 15, `only ${shown} have a place`);
    for (const name of [/^uav17 LOST/, /^uav12 STALE/]) assert.ok(shown.some((one) => name.test(one)), `${name} is among ${shown}`);
    if (i === 10) for (let zoom = 0; zoom < 2; zoom++) await page.click('.leaflet-control-zoom-out');
    const before = await fleet.data('snapshot');
    await becomes(async () => (await fleet.data('snapshot')) !== before, 'time goes on');
  }
  assert.deepEqual(fleet.errors, []);
}

async function cutsNothingOnAPhoneHeldSideways(programs) {
  const {url} = await startFixture(programs, 3);
  await openBrowser({...PHONE, viewport: {width: 844, height: 390}});
  const fleet = await FleetPage.open(url);
  const {page} = fleet;
  await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state), 'is UP');
  await fleet.select('uav1');
  await page.click('#act-goto');
  const cut = await page.evaluate(() => [...document.querySelectorAll('#order input, #order button, #order h2')].filter((one) => {
    one.scrollIntoView({block: 'center'});
    const {left, top, right, bottom} = one.getBoundingClientRect();
    return ![[left + 2, top + 2], [right - 2, bottom - 2]].every(([x, y]) => one.contains(document.elementFromPoint(x, y)));
  }).map((one) => one.id));
  assert.deepEqual(cut, [], 'all of the form can be reached');
  await page.tap('#order-cancel');

  // A tap on the map opens the form beside it.
  await page.evaluate(() => window.scrollTo(0, 0));
  await page.locator('.map-pane').scrollIntoViewIfNeeded();
  const map = await page.locator('#map').boundingBox();
  await page.touchscreen.tap(map.x + map.width / 2, map.y + 20);
  await becomes(() => page.isVisible('#order'), 'the form is open');
  const [form, title, after] = await Promise.all(['#order', '#order-title', '#map'].map((one) => page.locator(one).boundingBox()));
  assert.ok(form.x >= after.x + after.width, `beside the map: ${JSON.stringify({form, after})}`);
  assert.ok(title.y >= 0 && title.y + title.height <= 390, `its title is in sight: ${JSON.stringify(title)}`);
  const seen = Math.min(390, after.y + after.height) - Math.max(0, after.y);
  assert.ok(seen >= 0.8 * after.height, `the map is in sight: ${seen} of ${after.height}`);
  assert.deepEqual(fleet.errors, []);
}

// Of an aircraft that was tapped, what can be done with it is in sight, without scrolling.
async function keepsWhatCanBeOrderedInSightOnAPhone(programs) {
  const {url} = await startFixture(programs, 1);
  for (const viewport of [PHONE.viewport, {width: 844, height: 390}]) {
    await openBrowser({...PHONE, viewport});
    const fleet = await FleetPage.open(url);
    const {page} = fleet;
    await fleet.rowBecomes('uav1', (row) => /UP/.test(row.state), 'is UP');
    await page.evaluate(() => window.scrollTo(0, 0));
    const marker = await fleet.marker('uav1');
    await page.touchscreen.tap(marker.x, marker.y);
    await becomes(async () => /^uav1/.test(await fleet.text('#selected-title')), 'it is selected');
    for (const one of ['#selected-title', '#act-goto', '#act-home']) {
      const box = await page.locator(one).boundingBox();
      assert.ok(box.y >= 0 && box.y + box.height <= viewport.height, `${one} is in sight at ${viewport.width}: ${JSON.stringify(box)}`);
    }
    await page.tap('#act-goto');
    await becomes(() => page.isVisible('#order'), 'it can be tapped');
    assert.deepEqual(fleet.errors, []);
    await page.context().close();
  }
}

export const cases = {
  keeps_what_can_be_ordered_in_sight_on_a_phone: keepsWhatCanBeOrderedInSightOnAPhone,
  cuts_nothing_on_a_phone_held_sideways: cutsNothingOnAPhoneHeldSideways,
  can_be_read_in_every_theme: canBeReadInEveryTheme,
  can_be_hit_with_fingers: canBeHitWithFingers,
  cuts_nothing_on_a_phone: cutsNothingOnAPhone,
  fits_the_map_to_a_new_size_unless_it_was_moved: fitsTheMapToANewSizeUnlessItWasMoved,
  shows_first_what_needs_attention: showsFirstWhatNeedsAttention,
};
