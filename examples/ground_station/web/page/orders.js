// Sends a command to one aircraft, after a person has confirmed it.
import {byId, setText} from './dom.js';
import {distance} from './geo.js';
import {fixed, isNumber, STATES} from './format.js';

const DEFAULT_SPEED_MPS = 12;
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
    for (const id of ['latitude', 'longitude']) byId(`order-${id}`).addEventListener('input', () => this.showPoint());
  }

  get isOpen() {
    return !this.form.hidden;
  }

  // kind: goto, home or search. point: where to; without one a Goto begins at the aircraft.
  open(kind, point = null) {
    const aircraft = this.model.selectedAircraft;
    if (!aircraft) {
      this.say('Select an aircraft first.');
      return;
    }
    if (!this.isOpen) this.cameFrom = document.activeElement;
    this.kind = kind;
    this.node = aircraft.node;
    const titles = {goto: `Send ${this.node} to a point`, home: `Call ${this.node} home?`, search: `Let ${this.node} search?`};
    setText(byId('order-title'), titles[kind]);
    byId('order-fields').hidden = kind !== 'goto';
    setText(byId('order-send'), {goto: 'Send', home: 'Call home', search: 'Start search'}[kind]);
    setText(byId('order-error'), '');
    for (const {input} of this.fields) input.removeAttribute('aria-invalid');
    if (kind === 'goto') {
      const {pose} = aircraft;
      const from = point ?? (pose ? {lat: pose.latitude_deg, lng: pose.longitude_deg} : null);
      byId('order-latitude').value = from ? fixed(from.lat, 6) : '';
      byId('order-longitude').value = from ? fixed(from.lng, 6) : '';
      byId('order-altitude').value = isNumber(pose?.altitude_m) ? fixed(pose.altitude_m, 0) : '';
      if (!byId('order-speed').value) byId('order-speed').value = String(DEFAULT_SPEED_MPS);
    }
    this.form.hidden = false;
    this.update();
    this.showPoint();
    if (kind === 'goto' && !point) {
      byId('order-latitude').focus();
      byId('order-latitude').select();
    } else {
      byId('order-send').focus();
    }
  }

  close() {
    if (!this.isOpen) return;
    const hadFocus = this.form.contains(document.activeElement);
    this.form.hidden = true;
    this.map.showGoingTo(null);
    if (hadFocus) (this.cameFrom?.isConnected ? this.cameFrom : byId('map')).focus();
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

  // What the person should know before it is sent.
  update() {
    if (!this.isOpen) return;
    const aircraft = this.model.find(this.node);
    const said = [];
    const state = aircraft ? this.model.shownState(aircraft) : 'lost';
    if (state !== 'up') said.push(`${STATES[state].sign} ${this.node} is ${STATES[state].word}: it may get this late or not at all.`);
    if (this.kind === 'goto' && this.point && aircraft?.pose) {
      const from = {lat: aircraft.pose.latitude_deg, lng: aircraft.pose.longitude_deg};
      said.push(`${Math.round(distance(from, this.point))} m from where it is${state === 'up' ? '' : ' said to have been'}.`);
    }
    setText(byId('order-note'), said.join(' '));
  }

  async send() {
    let values = {};
    if (this.kind === 'goto') {
      values = readNumbers(this.fields, byId('order-error'));
      if (!values) return;
    }
    const {kind, node} = this;
    byId('order-send').disabled = true;
    try {
      await this.connection.request({type: 'order', kind, node, ...values});
      this.say(`${kind} for ${node} was given to the ground station.`);
      this.close();
    } catch (error) {
      setText(byId('order-error'), error.message);
    } finally {
      byId('order-send').disabled = false;
    }
  }
}
