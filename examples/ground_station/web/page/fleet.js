// The table of the aircraft, and the line about the selected one.
import {ageText, ageWithUnit, fixed, isNumber, STATES} from './format.js';
import {byId, element, keepList, setAttribute, setClass, setText} from './dom.js';
import {destinationsOf, wayLeft} from './destinations.js';
import {batteryLevel} from './model.js';
import {kilo} from './radio.js';

const BATTERY_SIGNS = {'': '', warning: '▲ ', alarm: '■ '};
const MOST_NAMED = 3;  // on a button
const COLUMNS = ['name', 'state', 'age number', 'rtt number', 'delivery number', 'battery number', 'altitude number', 'speed number', 'mission'];

export class FleetTable {
  // onSelect(node, keepsMarks), onForget(node), onMark(node).
  constructor(model, {onSelect, onForget, onMark}) {
    Object.assign(this, {model, onSelect, onForget, onMark});
    this.body = byId('fleet').tBodies[0];
    this.rows = new Map();
    this.body.addEventListener('keydown', (event) => this.onKey(event));
  }

  update() {
    const {model} = this;
    keepList(this.body, this.rows, model.byUrgency, (one) => one.node, (one) => this.make(one), (row, one) => this.fill(row, one));
    byId('fleet-empty').hidden = model.aircraft.length > 0;
    // Exactly one row can be reached by Tab: the selected one, else the first.
    const reachable = this.rows.get(model.selected) ?? this.rows.get(model.byUrgency[0]?.node);
    for (const row of this.rows.values()) setAttribute(row.root, 'tabindex', row === reachable ? '0' : '-1');
  }

  make(aircraft) {
    const root = element('tr');
    const cells = COLUMNS.map((name) => {
      const cell = element('td', name);
      root.append(cell);
      return cell;
    });
    setText(cells[0], aircraft.node);
    const mission = element('span');
    const why = element('span', 'why');
    cells[8].append(mission, why);
    root.addEventListener('click', ({ctrlKey, metaKey}) => (ctrlKey || metaKey ? this.onMark : this.onSelect)(aircraft.node));
    return {root, cells, mission, why, forget: null};
  }

  // A row of an aircraft that is LOST can be dismissed.
  offerForget(row, aircraft, isLost) {
    if (isLost === (row.forget !== null)) return;
    if (row.forget) {
      row.forget.remove();
      row.forget = null;
      return;
    }
    row.forget = element('button', 'forget', 'Forget');
    row.forget.type = 'button';
    setAttribute(row.forget, 'aria-label', `Forget ${aircraft.node} until it is heard again`);
    row.forget.addEventListener('click', (event) => {
      event.stopPropagation();
      this.onForget(aircraft.node);
    });
    row.cells[8].append(row.forget);
  }

  fill(row, aircraft) {
    const {root, cells, mission: doing, why} = row;
    const {model} = this;
    const state = model.state(aircraft);
    const {pose, mission, health} = aircraft;
    const fresh = model.isPoseFresh(aircraft);
    const mark = (cell, name, isFresh) => setClass(cell, isFresh ? name : `${name} old`);
    this.offerForget(row, aircraft, state === 'lost');
    const marked = model.markedNodes.has(aircraft.node);
    setClass(root, `${model.shownState(aircraft) === 'stale' && state === 'up' ? 'stale' : state}${marked ? ' marked' : ''}`);
    setAttribute(root, 'aria-selected', String(aircraft.node === model.selected));
    setText(cells[1], `${STATES[state].sign} ${STATES[state].word}`);
    // Where one thing is there and another is not, state and age would seem to contradict each other.
    const missing = model.missing(aircraft);
    setAttribute(cells[1], 'title', missing);
    const special = /^bad position/.test(missing) ? 'bad position' : /positions? comes?$/.test(missing) ? missing : aircraft.without_orders ? 'back without orders' : '';
    setText(why, [aircraft.replay ? 'replay' : '', special].filter((one) => one).join(' · '));
    setText(cells[2], pose ? `${fresh ? '' : '! '}${ageText(model.age(pose.age_s))}` : '–');
    mark(cells[2], 'age number', fresh);
    setText(cells[3], isNumber(aircraft.round_trip_s) ? fixed(aircraft.round_trip_s * 1000, 1) : '–');
    mark(cells[3], 'rtt number', state === 'up');
    setText(cells[4], aircraft.delivery_rate > 0 ? kilo(aircraft.delivery_rate) : '–');
    mark(cells[4], 'delivery number', state === 'up');
    const level = batteryLevel(health?.battery_percent);
    setText(cells[5], health ? BATTERY_SIGNS[level] + fixed(health.battery_percent, 0) : '–');
    mark(cells[5], `battery number ${level}`.trim(), !health || model.isFresh(aircraft, 'health'));
    setText(cells[6], pose ? fixed(pose.altitude_m, 0) : '–');
    mark(cells[6], 'altitude number', fresh);
    setText(cells[7], pose ? fixed(pose.speed_mps, 1) : '–');
    mark(cells[7], 'speed number', fresh);
    setText(doing, mission ? mission.mode.toUpperCase() + (mission.target ? ` ${mission.target}` : '') : '–');
    mark(cells[8], 'mission', !mission || model.isFresh(aircraft, 'mission'));
    setAttribute(cells[8], 'title', mission?.text ?? '');
  }

  // Arrow keys choose an aircraft, with Shift they keep the marks.
  onKey(event) {
    if (event.target instanceof HTMLButtonElement) return;
    const step = {ArrowDown: 1, ArrowUp: -1}[event.key];
    const names = this.model.byUrgency.map((one) => one.node);
    let next = null;
    if (step) {
      const at = names.indexOf(this.model.selected);
      next = at < 0 ? names[0] : names[Math.min(names.length - 1, Math.max(0, at + step))];
    } else if (event.key === 'Enter' || event.key === ' ') {
      next = names.find((name) => this.rows.get(name)?.root === document.activeElement);
    }
    if (!next) return;
    event.preventDefault();
    this.onSelect(next, event.shiftKey);
    this.focus(next);
  }
  focus(node) {
    const row = this.rows.get(node ?? this.model.byUrgency[0]?.node);
    row?.root.focus();
    row?.root.scrollIntoView({block: 'nearest'});
  }
}

// Each button says which aircraft it is for.
function nameReceivers(name, nodes, mostNamed = MOST_NAMED) {
  setText(byId(`act-${name}-who`), nodes.length > mostNamed ? `${nodes.length} aircraft` : nodes.join(', '));
  setAttribute(byId(`act-${name}`), 'title', nodes.join(', '));
}

export function showSelected(model) {
  const aircraft = model.selectedAircraft;
  const known = aircraft !== null;
  const {marked} = model;
  for (const name of ['goto', 'centre']) byId(`act-${name}`).disabled = !known;
  for (const name of ['search', 'home']) byId(`act-${name}`).disabled = !known && marked.length === 0;
  const all = model.thoseWithAMission.map(({node}) => node);
  byId('act-all-home').disabled = all.length === 0;
  nameReceivers('goto', known ? [aircraft.node] : []);
  for (const name of ['search', 'home']) nameReceivers(name, model.receivers);
  nameReceivers('all-home', all, 0);
  setText(byId('marked-text'), marked.length > 0 ? `✓ Search and Home are for those that are marked: ${marked.join(', ')}.` : '');
  if (!known) {
    setText(byId('selected-title'), 'No aircraft selected');
    setText(byId('selected-text'), 'Choose one in the list or on the map.');
    return;
  }
  const state = model.state(aircraft);
  setText(byId('selected-title'), `${aircraft.node} ${STATES[state].sign} ${STATES[state].word}`);
  const said = [];
  const missing = model.missing(aircraft);
  if (missing) said.push(missing);
  if (state !== 'up' && aircraft.reason && model.fleetFresh) said.push(aircraft.reason);
  if (aircraft.without_orders) said.push('back without orders: it has started anew and was told nothing since');
  if (aircraft.mission?.area_declined) said.push(`▲ declines the search area: ${aircraft.mission.area_declined}`);
  if (aircraft.pose) {
    const {latitude_deg: latitude, longitude_deg: longitude} = aircraft.pose;
    const age = model.isPoseFresh(aircraft) ? '' : ` (${ageWithUnit(model.age(aircraft.pose.age_s))} ago)`;
    said.push(`${fixed(latitude, 5)}, ${fixed(longitude, 5)}${age}`);
    if (isNumber(aircraft.ground_m) && isNumber(aircraft.pose.altitude_m))
      said.push(`${fixed(aircraft.pose.altitude_m - aircraft.ground_m, 0)} m above the ground`);
  }
  if (aircraft.mission?.text)
    said.push(aircraft.mission.text + (model.isFresh(aircraft, 'mission') ? '' : ` (${ageWithUnit(model.age(aircraft.mission.age_s))} ago)`));
  if (aircraft.mission?.partner) said.push(`with ${aircraft.mission.partner}`);
  if (aircraft.health?.wants_home) said.push(`goes home by itself: ${aircraft.health.reason}`);
  for (const {node, kind, left} of destinationsOf(model)) if (node === aircraft.node && left !== null) said.push(`${kind}: ${wayLeft(left)} left`);
  // What a small screen leaves out of the table.
  if (isNumber(aircraft.round_trip_s)) said.push(`RTT ${fixed(aircraft.round_trip_s * 1000, 1)} ms`);
  if (aircraft.path) said.push(`over ${aircraft.path}`);
  setText(byId('selected-text'), said.join(' · '));
}
