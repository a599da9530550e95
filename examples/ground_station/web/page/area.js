// The search area: a draft that is moved and resized by mouse, keys or numbers, and then sent.
/* global L */
import {byId, setText} from './dom.js';
import {countOf, outcomesOf} from './areas.js';
import {askedOfDistance} from './far.js';
import {outsideOf} from './fence.js';
import {corners, moved, offset} from './geo.js';
import {fixed, isNumber} from './format.js';
import {describeHeight, knownGround} from './heights.js';
import {readNumbers} from './orders.js';

// Names and ranges of Uav::SearchArea.
const FIELDS = [
  ['latitude_deg', -90, 90, 6, 'The latitude'],
  ['longitude_deg', -180, 180, 6, 'The longitude'],
  ['north_m', 10, 20000, 0, 'The side to the north'],
  ['east_m', 10, 20000, 0, 'The side to the east'],
  ['altitude_m', -500, 10000, 0, 'The altitude'],
  ['speed_mps', 0.1, 50, 1, 'The speed'],
  ['lane_m', 5, 1000, 0, 'The lane'],
];
const DEFAULTS = {north_m: 400, east_m: 600, altitude_m: 500, speed_mps: 16, lane_m: 60};
const STEP_M = 10;
const ARROWS = {ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowRight: [0, 1], ArrowLeft: [0, -1]};
// The corners in the order of corners(): signs of north and east.
const SIGNS = [[-1, -1], [1, -1], [1, 1], [-1, 1]];
const CORNER_NAMES = ['South-west', 'North-west', 'North-east', 'South-east'];

const limit = (value) => Math.min(20000, Math.max(10, value));

export class SearchAreaEditor {
  constructor(model, connection, fleetMap, say) {
    Object.assign(this, {model, connection, fleetMap, say});
    this.draft = null;
    this.handles = [];
    this.fields = FIELDS.map(([name, low, high, digits, what]) => (
      {name, low, high, digits, what, input: byId(`area-${name}`)}));
    for (const {input} of this.fields) input.addEventListener('input', () => this.takeFields());
    byId('area').addEventListener('submit', (event) => {
      event.preventDefault();
      this.send();
    });
    byId('area-discard').addEventListener('click', () => this.discard());
    byId('area-here').addEventListener('click', () => this.placeHere());
    fleetMap.areaToDraw = () => [this.draft, this.draft !== null];
  }

  get area() {
    return this.draft ?? this.model.snapshot?.area ?? null;
  }

  // How many aircraft fly the wanted area, and why the others do not.
  get outcome() {
    const last = this.model.snapshot?.areas?.at(-1);
    return last ? [`${countOf(last)} fly it`, ...outcomesOf(last)].join('; ') : '';
  }

  // Once for each snapshot.
  update() {
    const wanted = this.model.snapshot?.area;
    if (!this.draft && wanted && wanted.number !== this.shownNumber) {
      this.shownNumber = wanted.number;
      this.fillFields(wanted);
      this.placeHandles();
    }
    const {live, fleetFresh} = this.model;
    byId('area-send').disabled = this.draft === null || this.sending === true || !live;
    const again = this.askedAbout != null && this.draft !== null;
    setText(byId('area-send'), again ? 'Send it all the same' : 'Send area');
    byId('area-send').classList.toggle('danger', again);
    setText(byId('area-again'), again ? `▲ ${this.askedAbout} Is it meant so?` : '');
    byId('area-discard').disabled = this.draft === null;
    const panel = byId('area-panel');
    panel.classList.toggle('draft', this.draft !== null);
    const {area} = this;
    const size = area ? `${Math.round(area.north_m)} × ${Math.round(area.east_m)} m at ${Math.round(area.altitude_m)} m` : 'none';
    setText(byId('area-summary'), this.draft ? `▲ new, not sent: ${size}` : area ? `${area.number}: ${size}, ${countOf(this.model.snapshot.areas.at(-1))} fly it` : size);
    if (this.draft && !live) setText(byId('area-note'), '✕ There is no connection to the ground station: nothing can be sent.');
    else if (this.draft && !fleetFresh) setText(byId('area-note'), '▲ The gateway of the ground station is silent: nobody knows whether this will arrive.');
    else if (this.draft) setText(byId('area-note'), `Not sent yet. An area that aircraft fly is drawn with a full line. ${this.height.says}`);
    else if (wanted) setText(byId('area-note'), `Area ${wanted.number}: ${this.outcome}. ${this.height.says} Drag its handles on the map, or change the numbers.`);
    else setText(byId('area-note'), 'There is none. “Here” puts one into the middle of the map.');
  }

  // What is to be known of the altitude, see describeHeight.
  get height() {
    const {model} = this;
    const wanted = model.snapshot?.area;
    const poses = model.aircraft.map((one) => one.pose?.altitude_m).filter(isNumber);
    return describeHeight({
      altitude: this.area?.altitude_m,
      ...(!this.draft ? {} : wanted ? {present: wanted.altitude_m, than: 'the wanted area'}
        : {present: poses.length > 0 ? Math.min(...poses) : undefined, than: 'the lowest aircraft'}),
      ground: knownGround(model.aircraft, this.area ? corners(this.area) : []),
      floors: model.aircraft.map((one) => [one.node, one.floor_m]),
    });
  }

  // What is asked about again before it is sent; empty if nothing is.
  get question() {
    if (!this.draft) return '';
    const {model} = this;
    const points = corners(this.draft);
    const outside = outsideOf(model.snapshot?.fence, points);
    const flying = model.aircraft.filter((one) => model.state(one) !== 'lost').map(({node}) => node);
    const far = askedOfDistance(model, flying, points, 'The area');
    return [this.height.asks, far, outside && `The area is ${outside}: aircraft will decline it.`].filter((one) => one).join(' ');
  }

  change(values) {
    const from = this.area ?? DEFAULTS;
    const draft = {};
    for (const {name} of this.fields) draft[name] = values[name] ?? from[name] ?? DEFAULTS[name];
    this.draft = draft;
    byId('area-panel').open = true;
    this.fillFields(draft);
    this.redraw();
  }
  redraw() {
    this.askedAbout = null;
    setText(byId('area-error'), '');
    this.placeHandles();
    this.fleetMap.layer.paint();
    this.update();
  }

  // Where its numbers are typed.
  focus() {
    byId('area-panel').open = true;
    byId('area-latitude_deg').focus();
  }

  discard() {
    this.draft = null;
    this.shownNumber = undefined;
    for (const {input} of this.fields) input.removeAttribute('aria-invalid');
    this.redraw();
  }

  placeHere() {
    const {lat, lng} = this.fleetMap.map.getCenter();
    this.change({latitude_deg: lat, longitude_deg: lng});
  }

  fillFields(area) {
    for (const {input, name, digits} of this.fields) {
      if (document.activeElement === input && this.draft) continue;  // somebody types there
      input.value = isNumber(area[name]) ? String(Number(fixed(area[name], digits))) : '';
    }
  }
  // What was typed becomes the draft when all of it is good; it is checked again when it is sent.
  takeFields() {
    const values = {};
    let wrong = '';
    for (const {input, name, low, high, what} of this.fields) {
      const value = Number(input.value);
      const good = input.value.trim() !== '' && value >= low && value <= high;
      input.setAttribute('aria-invalid', String(!good));
      if (!good && !wrong) wrong = `${what} must be a number from ${low} to ${high}`;
      values[name] = value;
    }
    if (wrong) {
      setText(byId('area-error'), `${wrong}; the map shows the area as it was before`);
      return;
    }
    this.draft = values;
    this.redraw();
  }

  async send() {
    if (!this.draft) return;
    const values = readNumbers(this.fields, byId('area-error'));
    if (!values || !this.model.live || this.sending) return;
    const {question} = this;
    if (question && this.askedAbout == null) {
      this.askedAbout = question;
      this.update();
      byId('area-discard').focus();
      return;
    }
    // The button loses the focus when it is disabled.
    const hadFocus = byId('area').contains(document.activeElement);
    this.sending = true;
    this.update();
    try {
      await this.connection.request({type: 'area', ...values});
      this.say('The search area was given to the ground station.');
      this.draft = null;
      this.redraw();
    } catch (error) {
      setText(byId('area-error'), error.message);
    } finally {
      this.sending = false;
      this.update();
      if (hadFocus) (this.draft ? byId('area-send') : byId('area-panel').querySelector('summary')).focus();
    }
  }

  // Handles: one in the middle moves the area, one in each corner resizes it; the opposite corner stays.
  placeHandles() {
    const {area} = this;
    if (!area) return;
    if (this.handles.length === 0) {
      this.addHandle('centre', 'Search area: arrow keys move it', (point) => this.change({latitude_deg: point.lat, longitude_deg: point.lng}));
      SIGNS.forEach((signs, i) => this.addHandle('corner', `${CORNER_NAMES[i]} corner of the search area: arrow keys move it`,
        (point) => this.moveCorner(i, point)));
    }
    const places = [{lat: area.latitude_deg, lng: area.longitude_deg}, ...corners(area)];
    this.handles.forEach((handle, i) => {
      handle.setLatLng(places[i]);
      handle.getElement().classList.toggle('draft', this.draft !== null);
    });
  }

  addHandle(kind, title, onMove) {
    const touched = window.matchMedia('(pointer: coarse)').matches;
    const size = touched ? 44 : kind === 'centre' ? 16 : 12;
    const icon = L.divIcon({className: `handle ${kind}`, iconSize: [size, size]});
    const handle = L.marker([0, 0], {icon, draggable: true, keyboard: true, title, autoPan: true, zIndexOffset: -1000}).addTo(this.fleetMap.map);
    handle.on('drag', () => onMove(handle.getLatLng()));
    const shape = handle.getElement();
    shape.setAttribute('role', 'button');
    shape.setAttribute('aria-label', title);
    shape.addEventListener('keydown', (event) => {
      const direction = ARROWS[event.key];
      if (!direction) return;
      event.preventDefault();
      event.stopPropagation();
      const step = event.shiftKey ? 10 * STEP_M : STEP_M;
      onMove(moved(handle.getLatLng(), direction[0] * step, direction[1] * step));
    });
    this.handles.push(handle);
  }

  moveCorner(i, point) {
    const opposite = corners(this.area)[(i + 2) % 4];
    const {north, east} = offset(opposite, point);
    const [signNorth, signEast] = SIGNS[i];
    const northM = limit(north * signNorth);
    const eastM = limit(east * signEast);
    const middle = moved(opposite, (signNorth * northM) / 2, (signEast * eastM) / 2);
    this.change({latitude_deg: middle.lat, longitude_deg: middle.lng, north_m: northM, east_m: eastM});
  }
}
