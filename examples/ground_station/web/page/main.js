// Puts the parts of the page together: snapshots come in by the connection, are kept in the model, and are shown once for
// each frame of the screen. Between snapshots everything goes on growing old by the page's own clock.
import {Connection} from './connection.js';
import {Model} from './model.js';
import {FleetMap} from './map.js';
import {FleetTable, showSelected} from './fleet.js';
import {Orders} from './orders.js';
import {SearchAreaEditor} from './area.js';
import {CommandList, EventList, Pictures, ProblemList, TargetList} from './lists.js';
import {RadioPanel} from './radio.js';
import {Alarms} from './alarms.js';
import {listenForKeys} from './keys.js';
import {ageWithUnit, STATES} from './format.js';
import {byId, element, keepList, setClass, setText} from './dom.js';

const AGEING_MS = 200;
const MEASURE_MS = 1000;
const MOST_REPLAYED = 6;  // named in the bar

const model = new Model();
const say = (text) => setText(byId('live'), text);
const select = (node, keepsMarks = false) => {
  const ended = keepsMarks ? [] : model.marked;
  model.select(node, keepsMarks);
  if (ended.length > 0) say(`${node} is selected. Not marked any more: ${ended.join(', ')}.`);
  show(false);
};

const map = new FleetMap(model, {
  onClick: (point) => {
    if (model.selectedAircraft) orders.open('goto', point.wrap());
    else say('Select an aircraft first.');
  },
  onSelect: (node) => select(node),
});
const connection = new Connection(receive, (connected) => {
  model.connected = connected;
  show(false);
});
const mark = (node) => {
  if (!node) return;
  model.mark(node);
  say(`${node} is ${model.markedNodes.has(node) ? 'marked' : 'not marked'}.`);
  show(false);
};
const table = new FleetTable(model, {
  onSelect: select,
  onMark: mark,
  onForget: (node) => {
    model.forget(node);
    say(`${node} is forgotten until it is heard again.`);
    show(false);
    table.focus();
  },
});
const orders = new Orders(model, connection, map, say);
const area = new SearchAreaEditor(model, connection, map, say);
const lists = [new Alarms(model, say), new CommandList(model), new TargetList(model), new RadioPanel(model), new ProblemList(model), new EventList(model, say), new Pictures(model, (node) => select(node))];

// What handling takes, for the line at the top: snapshots since the last look, and the longest one.
const measured = {since: performance.now(), received: 0, skipped: 0, longestMs: 0, text: ''};
let waiting = false;
let shownAt = 0;

function receive(snapshot, takenAt) {
  model.take(snapshot, takenAt);
  if (waiting) return;
  waiting = true;
  const draw = () => {
    if (!waiting) return;
    waiting = false;
    const began = performance.now();
    show(true);
    measured.longestMs = Math.max(measured.longestMs, performance.now() - began);
    connection.seen();
  };
  requestAnimationFrame(draw);
  // A page in the background is drawn seldom; its data must not wait for that.
  if (document.hidden) setTimeout(draw, 50);
}

// What was recorded must not be taken for what is there now, whatever else the page shows.
function showReplay() {
  const {replayed} = model;
  const banner = byId('replay');
  banner.hidden = replayed.length === 0;
  const others = replayed.length - MOST_REPLAYED;
  const names = replayed.slice(0, MOST_REPLAYED).join(', ') + (others > 0 ? ` and ${others} more` : '');
  if (replayed.length > 0) setText(banner, `▶ REPLAY of a recording, not live: ${names}`);
}

const counts = new Map();
function showCounts() {
  const byState = {up: 0, stale: 0, lost: 0, waiting: 0};
  for (const aircraft of model.aircraft) if (!model.isOverReplay(aircraft)) byState[model.state(aircraft)] += 1;
  keepList(byId('counts'), counts, Object.keys(byState).filter((state) => state !== 'waiting' || byState.waiting > 0),
    (state) => state, (state) => ({root: element('span', `state ${state}`)}),
    ({root}, state) => {
      setText(root, `${STATES[state].sign} ${byState[state]} ${STATES[state].word}`);
      setClass(root, `state ${state}${byState[state] === 0 ? ' none' : ''}`);
    });
}

function showLink() {
  const {live, staleness, snapshot} = model;
  document.body.classList.toggle('not-live', !live);
  const banner = byId('banner');
  if (live) {
    banner.hidden = true;
  } else {
    const age = snapshot ? `Everything shown is old: ${ageWithUnit(Math.floor(staleness))}.` : 'Nothing is known yet.';
    const how = connection.isStranger ? 'It has another token now: open the address that it says on its terminal.' : 'Trying to connect.';
    setText(banner, `✕ No connection to the ground station. ${age} ${how}`);
    banner.hidden = snapshot === null && performance.now() < 2000;
  }
  const now = performance.now();
  if (now - measured.since >= MEASURE_MS) {
    const seconds = (now - measured.since) / 1000;
    measured.text = `${((model.received - measured.received) / seconds).toFixed(0)}/s, ${model.skipped} skipped, ` +
      `${measured.longestMs.toFixed(0)} ms to show`;
    Object.assign(measured, {since: now, received: model.received, longestMs: 0});
  }
  const link = byId('link');
  setText(link, live ? `● live ${staleness.toFixed(1)} s · ${measured.text}` : '✕ not connected');
  setClass(link, live ? 'link' : 'link state lost');
  // For whoever watches the page by program.
  const {dataset} = document.documentElement;
  dataset.live = String(live);
  dataset.snapshot = String(snapshot?.number ?? 0);
  dataset.received = String(model.received);
  dataset.skipped = String(model.skipped);
  dataset.age = staleness.toFixed(3);
}

function show(isNewSnapshot) {
  shownAt = performance.now();
  setText(byId('station'), model.snapshot?.node ?? '');
  showCounts();
  showLink();
  showReplay();
  table.update();
  showSelected(model);
  orders.update();
  area.update();
  for (const list of lists) list.update();
  map.update(isNewSnapshot);
}

function showTheme() {
  setText(byId('theme-name'), window.rabitTheme.chosen());
}
function nextTheme() {
  window.rabitTheme.next();
  showTheme();
}
const step = (by, keepsMarks = false) => {
  const names = model.byUrgency.map((one) => one.node);
  if (names.length === 0) return;
  const at = names.indexOf(model.selected);
  const next = names[at < 0 ? 0 : (at + by + names.length) % names.length];
  select(next, keepsMarks);
  table.focus(next);
};
const help = () => byId('keys').showModal();
const allHome = () => orders.open('home', null, model.thoseWithAMission.map(({node}) => node));
const centre = () => map.centre(model.selectedAircraft);

listenForKeys([
  {key: 'j', what: 'Select the next aircraft', run: () => step(1)},
  {key: 'k', what: 'Select the one before', run: () => step(-1)},
  {key: 'J', what: 'Select the next aircraft, and keep the marks', run: () => step(1, true)},
  {key: 'K', what: 'Select the one before, and keep the marks', run: () => step(-1, true)},
  {key: 'g', what: 'Send the selected aircraft to a point', run: () => orders.open('goto')},
  {key: 's', what: 'Let it search', run: () => orders.open('search')},
  {key: 'h', what: 'Call it home', run: () => orders.open('home')},
  {key: 'x', what: 'Mark it, or unmark it: Search and Home are for all that are marked. An order and a selection end the marks', run: () => mark(model.selected)},
  {key: 'H', what: 'Call all aircraft home', run: allHome},
  {key: 'c', what: 'Centre the map on it', run: centre},
  {key: 'f', what: 'Fit the map to the fleet and the search area', run: () => map.fit()},
  {key: 'm', what: 'Go to the map, which the arrow keys move', run: () => byId('map').focus()},
  {key: 'a', what: 'Go to the numbers of the search area', run: () => area.focus()},
  {key: 'n', what: 'Put the search area into the middle of the map', run: () => area.placeHere()},
  {key: 't', what: 'Next theme: auto, light, dark, contrast (sunlight), night (red)', run: nextTheme},
  {key: '?', what: 'Show the keys', run: help},
  {key: 'Escape', what: 'Cancel', run: () => (orders.isOpen ? orders.close() : document.activeElement?.blur())},
]);
byId('act-goto').addEventListener('click', () => orders.open('goto'));
byId('act-search').addEventListener('click', () => orders.open('search'));
byId('act-home').addEventListener('click', () => orders.open('home'));
byId('act-all-home').addEventListener('click', allHome);
byId('act-centre').addEventListener('click', centre);
byId('fit').addEventListener('click', () => map.fit());
byId('theme').addEventListener('click', nextTheme);
byId('help').addEventListener('click', help);
showTheme();
show(false);
setInterval(() => {
  if (!waiting && performance.now() - shownAt >= AGEING_MS) show(false);
}, AGEING_MS);
