// Sends a command to one aircraft, or to several at once, after a person has confirmed it.
import {byId, setText} from './dom.js';
import {corners, distance} from './geo.js';
import {fixed, isNumber, STATES} from './format.js';
import {askedOfDistance} from './far.js';
import {outsideOf} from './fence.js';
import {describeHeight, knownGround} from './heights.js';
import {fixOf, placeOf} from './model.js';

const DEFAULT_SPEED_MPS = 12;
const MOST_NAMED = 4;  // in a title
const CLEAR_PX = 34;  // around what the form must not cover
const FIELDS = [
  ['latitude', 'latitude_deg', -90, 90],
  ['longitude', 'longitude_deg', -180, 180],
  ['altitude', 'altitude_m', -500, 10000],
  ['speed', 'speed_mps', 0.1, 50],
];

// Reads number fields. Returns null, and marks the first that is wrong, if one is.
export function readNumbers(fields, error) {
  const values = {};
  let wrong = null;
  for (const {input, name, low, high, what} of fields) {
    const text = input.value.trim();
    const value = Number(text);
    const good = text !== '' && Number.isFinite(value) && value >= low && value <= high;
    input.setAttribute('aria-invalid', String(!good));
    if (!good && !wrong) wrong = {input, reason: `${what} must be a number from ${low} to ${high}`};
    values[name] = value;
  }
  setText(error, wrong?.reason ?? '');
  wrong?.input.focus();
  return wrong ? null : values;
}

export class Orders {
  constructor(model, connection, map, say) {
    Object.assign(this, {model, connection, map, say});
    this.form = byId('order');
    this.fields = FIELDS.map(([id, name, low, high]) => (
      {input: byId(`order-${id}`), name, low, high, what: `The ${id}`}));
    this.form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.send();
    });
    byId('order-cancel').addEventListener('click', () => this.close());
    this.typed = new Set();  // fields that a person has filled in for this order
    this.form.addEventListener('input', ({target}) => {
      this.typed.add(target.id);
      this.askedAbout = null;
      this.showPoint();
    });
  }

  get isOpen() {
    return !this.form.hidden;
  }

  // kind: goto, home or search. point: where to; without one a Goto begins at the aircraft. nodes: who gets it; without
  // them those that are marked, or the selected one. A Goto is for the selected one alone: two do not fit at one point.
  open(kind, point = null, nodes = null) {
    const aircraft = this.model.selectedAircraft;
    const receivers = nodes ?? (kind !== 'goto' ? this.model.receivers : aircraft ? [aircraft.node] : []);
    if (receivers.length === 0) {
      this.say('Select an aircraft first.');
      return;
    }
    if (!this.isOpen) this.cameFrom = document.activeElement;
    if (!this.isOpen || this.kind !== kind || this.node !== receivers[0]) this.typed.clear();
    this.kind = kind;
    this.nodes = receivers;
    [this.node] = receivers;
    byId('order-fields').hidden = kind !== 'goto';
    this.askedAbout = null;
    setText(byId('order-error'), '');
    for (const {input} of this.fields) input.removeAttribute('aria-invalid');
    if (kind === 'goto') {
      const {pose} = aircraft;
      const from = point ?? placeOf(aircraft);
      byId('order-latitude').value = from ? fixed(from.lat, 6) : '';
      byId('order-longitude').value = from ? fixed(from.lng, 6) : '';
      // What was typed for this order holds for another point as well.
      if (!this.typed.has('order-altitude')) byId('order-altitude').value = isNumber(pose?.altitude_m) ? fixed(pose.altitude_m, 0) : '';
      if (!this.typed.has('order-speed')) byId('order-speed').value = String(DEFAULT_SPEED_MPS);
    }
    this.form.hidden = false;
    this.update();
    this.showPoint();
    if (kind === 'goto' && !point) {
      byId('order-latitude').focus({preventScroll: true});
      byId('order-latitude').select();
    } else {
      byId('order-send').focus({preventScroll: true});
    }
    // On a small screen the form stands beside the map or below it: no more is scrolled than it takes to see it.
    this.form.scrollIntoView({block: 'nearest'});
  }

  close(hadFocus = this.form.contains(document.activeElement)) {
    if (!this.isOpen) return;
    this.form.hidden = true;
    this.map.showGoingTo(null);
    const back = this.cameFrom?.isConnected && this.cameFrom !== document.body ? this.cameFrom : byId('map');
    if (hadFocus) back.focus();
  }

  get point() {
    const [lat, lng] = ['latitude', 'longitude'].map((id) => byId(`order-${id}`).value.trim());
    if (lat === '' || lng === '' || !(Math.abs(lat) <= 90) || !(Math.abs(lng) <= 180)) return null;
    return {lat: Number(lat), lng: Number(lng)};
  }
  showPoint() {
    this.map.showGoingTo(this.kind === 'goto' ? this.point : null);
    this.update();
  }

  // What is to be known of the altitude in the form, see describeHeight.
  get height() {
    const aircraft = this.model.find(this.node);
    const typed = byId('order-altitude').value.trim();
    if (this.kind !== 'goto' || !aircraft || typed === '') return {says: '', asks: ''};
    const fresh = this.model.isPoseFresh(aircraft);
    return describeHeight({
      altitude: Number(typed), present: aircraft.pose?.altitude_m, than: fresh ? 'it is now' : 'it is said to have been',
      ground: knownGround([aircraft], this.point ? [this.point] : []), floors: [[this.node, aircraft.floor_m]],
    });
  }

  // What is asked about again before it is sent; empty if nothing is.
  get question() {
    return [this.height.asks, this.distanceAsked, this.fenceAsked].filter((one) => one).join(' ');
  }
  get fenceAsked() {
    const outside = this.kind === 'goto' && this.point ? outsideOf(this.model.snapshot?.fence, [this.point]) : '';
    return outside && `The point is ${outside}: ${this.node} will decline it.`;
  }
  get distanceAsked() {
    const {area} = this.model.snapshot ?? {};
    if (this.kind === 'search' && area) return askedOfDistance(this.model, this.nodes, corners(area), 'The search area');
    return this.kind === 'goto' && this.point ? askedOfDistance(this.model, [this.node], [this.point], 'The point') : '';
  }

  get who() {
    return this.nodes.length > MOST_NAMED ? `${this.nodes.length} aircraft` : this.nodes.join(', ');
  }
  // Who may get it late or not at all.
  get doubtful() {
    const states = this.nodes.map((node) => [node, this.stateOf(node)]).filter(([, state]) => state !== 'up');
    if (states.length > MOST_NAMED) return [`▲ ${states.length} of them are not UP: they may get this late or not at all.`];
    return states.map(([node, state]) => `${STATES[state].sign} ${node} is ${STATES[state].word}: it may get this late or not at all.`);
  }
  stateOf(node) {
    const aircraft = this.model.find(node);
    return aircraft ? this.model.shownState(aircraft) : 'lost';
  }

  // What the person should know before it is sent. What stands between the page and the aircraft comes first: while that is
  // broken nobody knows how the aircraft is.
  update() {
    if (!this.isOpen) return;
    const {live, fleetFresh} = this.model;
    const titles = {goto: `Send ${this.who} to a point`, home: `Call ${this.who} home?`, search: `Let ${this.who} search?`};
    setText(byId('order-title'), titles[this.kind]);
    const again = this.askedAbout !== null;
    byId('order-send').disabled = !live || this.sending === true;
    setText(byId('order-send'), again ? 'Send it all the same' : {goto: `Send ${this.who}`, home: `Call ${this.who} home`, search: `Let ${this.who} search`}[this.kind]);
    byId('order-send').classList.toggle('danger', again);
    setText(byId('order-again'), again ? `▲ ${this.askedAbout} Is it meant so?` : '');
    if (!live) {
      setText(byId('order-note'), '✕ There is no connection to the ground station: nothing can be sent.');
      this.keepClear();
      return;
    }
    if (!fleetFresh) {
      setText(byId('order-note'), '▲ The gateway of the ground station is silent: nobody knows whether this will arrive.');
      this.keepClear();
      return;
    }
    const aircraft = this.model.find(this.node);
    const said = [];
    if (this.kind === 'goto') said.push(this.height.says);
    const state = this.stateOf(this.node);
    said.unshift(...this.doubtful);
    const dismissed = this.nodes.filter((node) => this.model.forgotten.has(node));
    if (dismissed.length > 0) said.push(`Also for what was dismissed from the list: ${dismissed.join(', ')}.`);
    if (this.nodes.length > MOST_NAMED) said.push(`For ${this.nodes.join(', ')}.`);
    const from = fixOf(aircraft);
    if (this.kind === 'goto' && this.point && from) {
      said.push(`${Math.round(distance(from, this.point))} m from where it is${state === 'up' ? '' : ' said to have been'}.`);
    }
    setText(byId('order-note'), said.filter((one) => one).join(' '));
    this.keepClear();
  }

  // The form stands in the first corner of the map where it covers neither the aircraft nor the point.
  keepClear() {
    const frame = this.form.parentElement.getBoundingClientRect();
    const {width, height} = this.form.getBoundingClientRect();
    const points = [this.kind === 'goto' ? this.point : null, placeOf(this.model.find(this.node))].filter((one) => one);
    const places = points.map((point) => this.map.map.latLngToContainerPoint(point));
    const corners = {'bottom-left': [0, 1], 'bottom-right': [1, 1], 'top-right': [1, 0], 'top-left': [0, 0]};
    const covers = (name) => {
      const [right, bottom] = corners[name];
      const left = right ? frame.width - width - CLEAR_PX : CLEAR_PX;
      const top = bottom ? frame.height - height - CLEAR_PX : CLEAR_PX;
      return places.some(({x, y}) => x > left - CLEAR_PX && x < left + width + CLEAR_PX && y > top - CLEAR_PX && y < top + height + CLEAR_PX);
    };
    const now = this.form.dataset.corner ?? 'bottom-left';
    const best = [now, ...Object.keys(corners)].find((name) => !covers(name)) ?? now;
    if (this.form.dataset.corner !== best) this.form.dataset.corner = best;
  }

  async send() {
    let values = {};
    if (this.kind === 'goto') {
      values = readNumbers(this.fields, byId('order-error'));
      if (!values) return;
    }
    if (!this.model.live || this.sending) return;
    // A large descent or a long way is asked about again, and Enter does not answer that by itself.
    const {question} = this;
    if (question && this.askedAbout === null) {
      this.askedAbout = question;
      this.update();
      byId('order-cancel').focus();
      return;
    }
    const {kind, nodes} = this;
    // The button loses the focus while it is disabled.
    const hadFocus = this.form.contains(document.activeElement);
    this.sending = true;
    this.update();
    try {
      const outcomes = await Promise.allSettled(nodes.map((node) => this.connection.request({type: 'order', kind, node, ...values})));
      const failed = outcomes.map(({reason}, i) => ({node: nodes[i], reason})).filter(({reason}) => reason);
      if (failed.length > 0) {
        // Only those that did not get it are asked for again.
        this.nodes = failed.map(({node}) => node);
        [this.node] = this.nodes;
        const what = ({node, reason}) => (nodes.length > 1 ? `${node}: ${reason.message}` : reason.message);
        throw new Error(failed.map(what).join('; '));
      }
      this.say(`${kind} for ${nodes.join(', ')} was given to the ground station.`);
      this.model.endMarks();
      this.close(hadFocus);
    } catch (error) {
      setText(byId('order-error'), error.message);
    } finally {
      this.sending = false;
      this.update();
      if (hadFocus && this.isOpen) byId('order-send').focus();
    }
  }
}
