// The map: aircraft as markers, everything else on a canvas. No tiles: there is no internet in the field.
/* global L */
import {ageWithUnit, STATES} from './format.js';
import {CanvasLayer} from './canvas.js';
import {destinationsOf, wayLeft} from './destinations.js';
import {areasToDraw, countOf} from './areas.js';
import {blockTargets, drawArea, drawDestinations, drawFence, drawFootprints, drawGrid, drawTargets, drawTrails, Trails} from './drawing.js';
import {byId, element, setAttribute, setText} from './dom.js';
import {LabelSpace, placesAround} from './labels.js';
import {corners, distance, moved} from './geo.js';
import {fixOf, placeOf} from './model.js';
import {pageNow} from './connection.js';

const SYMBOL_PX = 22;  // what the name of an aircraft keeps away from
const OUTLIER_M = 50000;  // farther than any aircraft flies from its search area
const IMPOSSIBLE_M = 500000;  // from the middle of the fleet: no aircraft gets there
const FENCE_SIZES = 4;  // a fence that is more of these wide than all else is left out
const MOST_NAMED = 4;
const SVG = 'http://www.w3.org/2000/svg';

function svg(tag, attributes) {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}

function makeSymbol() {
  const root = element('div');
  const picture = svg('svg', {viewBox: '-14 -14 28 28', 'aria-hidden': 'true'});
  const turned = svg('g', {});
  turned.append(svg('path', {class: 'shape', d: 'M0-11 8 10 0 5-8 10Z'}));
  picture.append(svg('circle', {class: 'touch', r: 22}), svg('circle', {class: 'ring', r: 13}), svg('circle', {class: 'mark', r: 17}), turned, svg('path', {class: 'cross', d: 'M-7-7 7 7M7-7-7 7'}));
  const label = element('span', 'label');
  root.append(picture, label);
  return {root, turned, label};
}

const middleOf = ({latitude_deg: lat, longitude_deg: lng}) => ({lat, lng});
const isPresent = (model) => (one) => model.state(one) !== 'lost';

// The places without those that no aircraft of the fleet can be at: with three or more of them, those that are much farther
// from the middle one than aircraft fly.
export function withoutOutliers(places) {
  if (places.length < 3) return places;
  const middle = (values) => values.sort((a, b) => a - b)[Math.floor(values.length / 2)];
  const centre = {lat: middle(places.map(({lat}) => lat)), lng: middle(places.map(({lng}) => lng))};
  const near = places.filter((place) => distance(centre, place) <= IMPOSSIBLE_M);
  return near.length > 0 ? near : places;
}

// What the map is fitted to: all aircraft that are not LOST and have a fix and a good position; the search areas, unless they
// are far from all of them; and the geofence, if it is not much larger than these. If nothing remains, all places that are
// known.
function placesToFit(model, {fence}) {
  const all = (places) => places.filter((place) => place);
  const present = withoutOutliers(all(model.aircraft.filter(isPresent(model)).map(fixOf)));
  const isNearby = (area) => present.length === 0 || present.some((place) => distance(middleOf(area), place) <= OUTLIER_M);
  const places = [...present, ...areasToDraw(model).filter(isNearby).flatMap(corners)];
  const known = [places, all(model.aircraft.map(fixOf)), all(model.aircraft.map(placeOf))].find(({length}) => length > 0) ?? [];
  if (!fence || known.length === 0) return known;
  const around = [[1, 0], [-1, 0], [0, 1], [0, -1]].map(([north, east]) =>
    moved(middleOf(fence), north * fence.radius_m, east * fence.radius_m));
  const size = Math.max(...known.map((place) => distance(place, known[0])));
  const isNear = Math.max(...known.map((place) => distance(place, middleOf(fence)))) <= OUTLIER_M;
  return isNear && 2 * fence.radius_m <= FENCE_SIZES * size ? [...known, ...around] : known;
}

export class FleetMap {
  // onClick(latlng), onSelect(node).
  constructor(model, {onClick, onSelect}) {
    this.model = model;
    this.onSelect = onSelect;
    this.markers = new Map();
    this.trails = new Trails();
    this.fitted = false;
    this.moved = false;  // by a person, since it was fitted
    this.map = L.map('map', {
      zoomAnimation: false, fadeAnimation: false, markerZoomAnimation: false, inertia: false, attributionControl: false,
      zoomSnap: 0.5, minZoom: 3, maxZoom: 22, center: [0, 0], zoom: 3, doubleClickZoom: false, keyboardPanDelta: 60,
    });
    L.control.scale({imperial: false, maxWidth: 160}).addTo(this.map);
    this.areaToDraw = () => [null, false];
    this.layer = new CanvasLayer((painter) => this.draw(painter)).addTo(this.map);
    this.map.on('click', (event) => onClick(event.latlng));
    this.map.on('movestart zoomstart', () => (this.moved = this.moved || !this.fitting));
    new ResizeObserver(() => this.resize()).observe(byId('map'));
  }

  // What was fitted is fitted to the new size; what a person has moved stays where he put it.
  resize() {
    this.map.invalidateSize({pan: false});
    if (this.fitted && !this.moved) this.fit();
  }

  draw(painter) {
    const space = new LabelSpace(painter.size);
    this.blockControls(space);
    const cell = drawGrid(painter, space);
    const [area, isDraft] = this.areaToDraw();
    drawFence(painter, this.model.snapshot?.fence);
    const areas = areasToDraw(this.model);
    for (const one of areas) drawArea(painter, one, {isFlown: one.flown_by > 0, outcome: `${countOf(one)} fly it`}, space);
    if (isDraft) drawArea(painter, area, {isDraft}, space);
    drawFootprints(painter, this.model);
    drawTrails(painter, this.trails.trails, this.model);
    const {targets} = this.model;
    this.placeLabels(space);
    blockTargets(painter, targets, space);
    drawDestinations(painter, this.destinations, space);
    drawTargets(painter, targets, space);
    if (this.goingTo) this.drawGoingTo(painter);
    // For whoever watches the page by program: what is drawn cannot be read.
    const text = this.destinations.map(({node, kind, left}) => `${node} ${kind} ${wayLeft(left)}`).join(', ');
    setAttribute(byId('map'), 'data-destinations', text);
    setAttribute(byId('map'), 'data-areas', areas.map((one) => `${one.number}: ${countOf(one)}`).join(', '));
    const size = cell >= 1000 ? `${cell / 1000} km` : `${cell} m`;
    setText(byId('legend'), `Grid ${size} · ellipses 2σ · north up${this.fenceLegend}`);
    setText(byId('off-map'), this.offMap);
  }

  // No text is put under the buttons, the scale and the legend.
  blockControls(space) {
    const frame = byId('map').getBoundingClientRect();
    for (const one of document.querySelectorAll('.leaflet-control, .legend span')) {
      const {left, top, width, height} = one.getBoundingClientRect();
      space.block(left - frame.left, top - frame.top, width, height);
    }
  }

  get fenceLegend() {
    const {fence} = this.model.snapshot ?? {};
    if (!fence) return '';
    const bounds = this.map.getBounds();
    const isInside = (corner) => distance(middleOf(fence), corner) < fence.radius_m;
    const allInside = [bounds.getNorthWest(), bounds.getNorthEast(), bounds.getSouthWest(), bounds.getSouthEast()].every(isInside);
    return allInside ? ' · inside of the geofence' : ' · dotted circle: geofence';
  }

  // Aircraft and areas that are not on the part of the map that is shown; empty if all are.
  get offMap() {
    const {model} = this;
    const bounds = this.map.getBounds();
    const away = model.aircraft.filter(isPresent(model)).filter((one) => fixOf(one) && !bounds.contains(fixOf(one))).map(({node}) => node);
    const names = away.length > MOST_NAMED ? [`${away.length} aircraft`] : away;
    for (const area of areasToDraw(model)) {
      if (bounds.intersects(corners(area))) continue;
      const metres = Math.min(...model.aircraft.map(fixOf).filter((one) => one).map((place) => distance(place, middleOf(area))));
      names.push(`search area ${area.number}${Number.isFinite(metres) && metres > OUTLIER_M ? ` (${wayLeft(metres)} away)` : ''}`);
    }
    const bad = model.aircraft.filter((one) => one.bad_position && isPresent(model)(one)).map(({node}) => node);
    const said = names.length > 0 ? [`▲ Off the map: ${names.join(', ')}`] : [];
    if (bad.length > 0) said.push(`▲ Bad position: ${bad.length > MOST_NAMED ? `${bad.length} aircraft` : bad.join(', ')}`);
    return said.join(' · ');
  }

  get destinations() {
    return destinationsOf(this.model);
  }

  // The names of the aircraft: of the selected one first, then of those that need attention. One for which there is no
  // place is left out, but for the selected one's.
  placeLabels(space) {
    const {model} = this;
    const shown = model.byUrgency.filter(({node}) => this.markers.has(node))
      .sort((a, b) => Number(b.node === model.selected) - Number(a.node === model.selected));
    const at = new Map(shown.map(({node}) => [node, this.map.latLngToContainerPoint(this.markers.get(node).marker.getLatLng())]));
    for (const {x, y} of at.values()) space.block(x - SYMBOL_PX / 2, y - SYMBOL_PX / 2, SYMBOL_PX, SYMBOL_PX);
    for (const {node} of shown) {
      const known = this.markers.get(node);
      const {label} = known.symbol;
      if (known.measured !== label.textContent) {
        known.measured = label.textContent;
        known.size = [label.offsetWidth, label.offsetHeight];
      }
      const [width, height] = known.size;
      const {x, y} = at.get(node);
      const places = placesAround(x, y, width, height, SYMBOL_PX / 2 + 1);
      const place = space.place(places, width, height);
      const [left, top] = places[Math.max(0, place)];
      if (place < 0 && node === model.selected) space.block(left, top, width, height);
      label.style.left = `${left - x}px`;
      label.style.top = `${top - y}px`;
      label.classList.toggle('no-place', place < 0 && node !== model.selected);
    }
  }

  drawGoingTo(painter) {
    const [x, y] = painter.at(this.goingTo);
    const {context, colours} = painter;
    context.beginPath();
    context.arc(x, y, 9, 0, 2 * Math.PI);
    context.moveTo(x - 14, y);
    context.lineTo(x + 14, y);
    context.moveTo(x, y - 14);
    context.lineTo(x, y + 14);
    painter.stroke(colours.draft, 2);
  }

  // A point that an aircraft is about to be sent to; null: none.
  showGoingTo(point) {
    this.goingTo = point;
    this.layer.paint();
  }

  update(isNewSnapshot) {
    const {model} = this;
    if (model.newLife && isNewSnapshot) this.trails.clear();
    const shown = model.aircraft.filter(placeOf);
    if (isNewSnapshot) for (const aircraft of shown) if (model.isPoseFresh(aircraft)) this.trails.add(this.map, aircraft, pageNow());
    const present = new Set();
    for (const aircraft of shown) {
      present.add(aircraft.node);
      this.place(aircraft);
    }
    for (const [node, {marker}] of this.markers) {
      if (present.has(node)) continue;
      marker.remove();
      this.markers.delete(node);
    }
    if (!this.fitted && shown.length > 0) this.fit();
    this.layer.paint();
  }

  place(aircraft) {
    const {model} = this;
    let known = this.markers.get(aircraft.node);
    const {pose} = aircraft;
    if (!known) {
      const symbol = makeSymbol();
      const icon = L.divIcon({className: 'aircraft', html: symbol.root, iconSize: [0, 0]});
      const marker = L.marker([pose.latitude_deg, pose.longitude_deg], {icon, keyboard: false}).addTo(this.map);
      marker.on('click', () => this.onSelect(aircraft.node));
      this.markers.set(aircraft.node, (known = {marker, symbol}));
    }
    known.marker.setLatLng([pose.latitude_deg, pose.longitude_deg]);
    const state = model.shownState(aircraft);
    const selected = aircraft.node === model.selected;
    const shape = known.marker.getElement();
    for (const name of Object.keys(STATES)) shape.classList.toggle(name, name === state);
    shape.classList.toggle('selected', selected);
    const marked = model.markedNodes.has(aircraft.node);
    shape.classList.toggle('marked', marked);
    setAttribute(known.symbol.turned, 'transform', `rotate(${(((pose.yaw_rad ?? 0) * 180) / Math.PI).toFixed(0)})`);
    const age = model.age(pose.age_s);
    const word = aircraft.bad_position && model.state(aircraft) === 'up' ? 'bad position' : state === 'up' ? '' : STATES[state].word;
    const how = word ? `${word} ${ageWithUnit(age)}` : '';
    setText(known.symbol.label, [aircraft.node, marked ? '✓' : '', how].filter((one) => one).join(' '));
  }

  fit() {
    const points = placesToFit(this.model, this.model.snapshot ?? {}).map(({lat, lng}) => [lat, lng]);
    if (points.length === 0) return;
    this.fitted = true;
    this.moved = false;
    this.fitting = true;
    const {x, y} = this.map.getSize();
    const padding = Math.min(50, x / 8, y / 8);
    this.map.fitBounds(points, {padding: [padding, padding], maxZoom: 18, animate: false});
    this.fitting = false;
  }

  centre(aircraft) {
    const place = placeOf(aircraft);
    if (place) this.map.panTo(place, {animate: false});
  }
}
