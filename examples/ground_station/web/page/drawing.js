// What is drawn on the canvas of the map, from the bottom up.
import {corners, ellipse, metresPerDegreeOfLatitude, metresPerDegreeOfLongitude, moved} from './geo.js';
import {wayLeft} from './destinations.js';
import {isNumber, STAGES, ageWithUnit} from './format.js';
import {placesAround} from './labels.js';
import {project} from './canvas.js';

const CELL_PX = 90;             // a cell of the grid is at least this wide
const SHOWN_AFTER_LOSS_S = 60;  // a camera's view that is older is not drawn any more
const SIGMAS = 2;               // of the ellipse
const TEXT_PX = 14;             // the height of a text on the canvas

function niceAtLeast(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= value);
}

// Squares whose sides are a round number of metres, labelled in degrees where no other text is. Returns that number.
export function drawGrid(painter, space) {
  const {map, size, context, colours} = painter;
  const middle = map.getCenter();
  const latitude = Math.round(middle.lat);  // so that the lines stay in place while the map is moved
  const pixelsPerDegree = Math.abs(painter.at({lat: middle.lat, lng: middle.lng + 1})[0] - painter.at(middle)[0]);
  const metresPerPixel = metresPerDegreeOfLongitude(latitude) / pixelsPerDegree;
  const cell = niceAtLeast(CELL_PX * metresPerPixel);
  const bounds = map.getBounds();
  const digits = Math.max(0, Math.min(6, Math.ceil(Math.log10(metresPerDegreeOfLatitude / cell)) + 1));
  context.lineWidth = 1;
  context.setLineDash([]);
  context.strokeStyle = colours.grid;
  context.fillStyle = colours['grid-text'];
  const eachLine = (from, to, step, line) => {
    if ((to - from) / step > 200) return;
    for (let i = Math.ceil(from / step); i * step <= to; i++) line(i * step);
  };
  context.beginPath();
  const labels = [];
  eachLine(bounds.getSouth(), bounds.getNorth(), cell / metresPerDegreeOfLatitude, (lat) => {
    const y = Math.round(painter.at({lat, lng: middle.lng})[1]) + 0.5;
    context.moveTo(0, y);
    context.lineTo(size.x, y);
    labels.push([`${lat.toFixed(digits)}°`, 4, y - 2 - TEXT_PX]);
  });
  eachLine(bounds.getWest(), bounds.getEast(), cell / metresPerDegreeOfLongitude(latitude), (lng) => {
    const x = Math.round(painter.at({lat: middle.lat, lng})[0]) + 0.5;
    context.moveTo(x, 0);
    context.lineTo(x, size.y);
    labels.push([`${lng.toFixed(digits)}°`, x + 3, 1]);
  });
  context.stroke();
  context.globalAlpha = 0.9;
  for (const [text, x, y] of labels)
    if (space.place([[x, y]], painter.textWidth(text), TEXT_PX) === 0) context.fillText(text, x, y + TEXT_PX - 3);
  context.globalAlpha = 1;
  return cell;
}

// A draft and an area that no aircraft flies have dashed lines; outcome: how many aircraft fly it.
export function drawArea(painter, area, {isDraft = false, isFlown = false, outcome = ''}, space) {
  const colour = isDraft ? painter.colours.draft : painter.colours.area;
  const places = corners(area).map((corner) => painter.at(corner));
  painter.path(places, true);
  painter.fill(colour, isDraft ? 0.08 : isFlown ? 0.05 : 0.02);
  painter.stroke(colour, 2, isDraft ? [6, 4] : isFlown ? [] : [12, 5, 2, 5]);
  const name = isDraft ? 'New search area, not sent' : `Search area ${area.number}, ${outcome}`;
  const text = `${name}  ${Math.round(area.north_m)} × ${Math.round(area.east_m)} m`;
  // Above its upper edge, else inside, else below: two areas may have one corner.
  const width = painter.textWidth(text);
  const [[left, bottom], [, top]] = places;
  const rows = [top - 7 - TEXT_PX, top + 5, bottom + 5, bottom - 7 - TEXT_PX].map((y) => [left + 2, y]);
  const at = space.place(rows, width, TEXT_PX);
  if (at < 0) space.block(...rows[0], width, TEXT_PX);
  const [x, y] = rows[Math.max(0, at)];
  painter.label(text, x, y + TEXT_PX - 3, colour);
}

export function drawFence(painter, fence) {
  if (!fence) return;
  const steps = 72;
  const middle = {lat: fence.latitude_deg, lng: fence.longitude_deg};
  const around = [...Array(steps).keys()].map((i) => {
    const angle = (2 * Math.PI * i) / steps;
    return painter.at(moved(middle, fence.radius_m * Math.cos(angle), fence.radius_m * Math.sin(angle)));
  });
  painter.path(around, true);
  painter.stroke(painter.colours.area, 1.5, [2, 5]);
}

export function drawTrails(painter, trails, model) {
  for (const [node, trail] of trails) {
    if (trail.length < 2) continue;
    const aircraft = model.find(node);
    const fresh = aircraft && model.isPoseFresh(aircraft);
    const {context} = painter;
    context.beginPath();
    trail.forEach((point, i) => (i === 0 || point.isStart ? context.moveTo(...painter.place(point)) : context.lineTo(...painter.place(point))));
    painter.stroke(fresh ? painter.colours.trail : painter.colours.old, node === model.selected ? 2.5 : 1.5, fresh ? [] : [2, 4]);
  }
}

export function drawFootprints(painter, model) {
  for (const aircraft of model.aircraft) {
    const age = model.age(aircraft.camera?.age_s);
    if (!(age <= SHOWN_AFTER_LOSS_S)) continue;
    const points = aircraft.camera.corners.map(([lat, lng]) => ({lat, lng}));
    if (!points.every(({lat, lng}) => isNumber(lat) && isNumber(lng))) continue;
    const fresh = model.isFresh(aircraft, 'camera');
    const colour = fresh ? painter.colours.footprint : painter.colours.old;
    painter.path(points.map((point) => painter.at(point)), true);
    if (fresh) painter.fill(colour, aircraft.node === model.selected ? 0.16 : 0.07);
    painter.stroke(colour, 1, fresh ? [] : [3, 4]);
  }
}

// A text beside a point, where it covers no other one; none where there is no place for it.
function labelBeside(painter, space, text, [x, y], gap, colour) {
  const width = painter.textWidth(text);
  const places = placesAround(x, y, width, TEXT_PX, gap);
  const at = space.place(places, width, TEXT_PX);
  if (at >= 0) painter.label(text, places[at][0], places[at][1] + TEXT_PX - 3, colour);
}

// Where aircraft were sent: a pin, a dashed line to it, and the way that is left.
export function drawDestinations(painter, destinations, space) {
  const {context} = painter;
  for (const {node, kind, to, from, left, fresh} of destinations) {
    const colour = fresh ? painter.colours.route : painter.colours.old;
    const [x, y] = painter.at(to);
    if (from) {
      painter.path([painter.at(from), [x, y]], false);
      painter.stroke(colour, 2, [7, 5]);
    }
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x - 6, y - 13);
    context.arc(x, y - 15, 6.5, Math.PI - 0.3, 0.3);
    context.closePath();
    painter.fill(painter.colours.halo, 1);
    painter.stroke(colour, 2.5);
    context.beginPath();
    context.arc(x, y - 15, 2, 0, 2 * Math.PI);
    painter.fill(colour, 1);
    const name = kind === 'home' ? `${node} home` : node;
    labelBeside(painter, space, `${name} ${wayLeft(left)}${fresh || left === null ? '' : ' (old)'}`.trim(), [x, y - 12], 10, colour);
  }
}

// Texts keep away from what is drawn at these places.
export function blockTargets(painter, targets, space) {
  for (const {latitude_deg: lat, longitude_deg: lng} of targets) {
    if (!isNumber(lat) || !isNumber(lng)) continue;
    const [x, y] = painter.at({lat, lng});
    space.block(x - 6, y - 6, 12, 12);
  }
}

export function drawTargets(painter, targets, space) {
  for (const target of targets) {
    if (!isNumber(target.latitude_deg) || !isNumber(target.longitude_deg)) continue;
    const middle = {lat: target.latitude_deg, lng: target.longitude_deg};
    const colour = target.fresh ? painter.colours.target : painter.colours.old;
    if (isNumber(target.sigma_major_m) && isNumber(target.sigma_minor_m)) {
      const outline = ellipse(middle, SIGMAS * target.sigma_major_m, SIGMAS * target.sigma_minor_m,
        target.sigma_heading_rad ?? 0);
      painter.path(outline.map((point) => painter.at(point)), true);
      painter.fill(colour, 0.12);
      painter.stroke(colour, 1.5, target.fresh ? [] : [3, 3]);
    }
    const [x, y] = painter.at(middle);
    const old = target.fresh || !isNumber(target.age) ? '' : `, last seen ${ageWithUnit(target.age)} ago`;
    painter.context.textAlign = 'center';
    painter.label(STAGES[target.stage] ?? '?', x, y + 4, colour);
    painter.context.textAlign = 'left';
    labelBeside(painter, space, `${target.name} ${target.stage}${old}`, [x, y], 9, colour);
  }
}

// Keeps where each aircraft has been. An incarnation's way begins anew: its poses are counted from 1.
export class Trails {
  static LONGEST = 600;
  static STEP_S = 0.5;
  trails = new Map();

  add(map, aircraft, now) {
    const {pose} = aircraft;
    if (!pose || !isNumber(pose.latitude_deg) || !isNumber(pose.longitude_deg)) return;
    let trail = this.trails.get(aircraft.node);
    if (!trail) this.trails.set(aircraft.node, (trail = []));
    const last = trail[trail.length - 1];
    const point = project(map, {lat: pose.latitude_deg, lng: pose.longitude_deg});
    if (last && last.x === point.x && last.y === point.y) return;
    point.at = now;
    point.number = pose.number;
    point.isStart = last !== undefined && pose.number < last.number;
    // The last point moves with the aircraft until it is STEP_S away from the one before.
    if (trail.length > 1 && !point.isStart && !last.isStart && now - trail[trail.length - 2].at < Trails.STEP_S) trail[trail.length - 1] = point;
    else trail.push(point);
    if (trail.length > Trails.LONGEST) trail.shift();
  }
  clear() {
    this.trails.clear();
  }
}
