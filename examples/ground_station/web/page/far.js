// Places that are far from the aircraft that shall fly there, or whose distance nobody knows.
import {wayLeft} from './destinations.js';
import {distance} from './geo.js';
import {fixOf} from './model.js';

// A place that is farther from an aircraft is asked about again: this, or so many sides of the wanted search area.
const FAR_M = 5000;
const FAR_SIDES = 10;
const MOST_NAMED = 4;

// Why these points are asked about again before those aircraft are sent there; empty if they need not. what: the name of
// the points. An aircraft whose position is not known counts only if no position is known.
export function askedOfDistance(model, nodes, points, what) {
  if (points.length === 0) return '';
  const known = nodes.map((node) => ({node, place: fixOf(model.find(node))})).filter(({place}) => place);
  if (known.length === 0) return nodes.length === 1 ? `The position of ${nodes[0]} is not known.` : 'The position of no aircraft is known.';
  const {area} = model.snapshot ?? {};
  const limit = Math.max(FAR_M, FAR_SIDES * Math.max(area?.north_m ?? 0, area?.east_m ?? 0));
  const far = known.map(({node, place}) => ({node, metres: Math.max(...points.map((point) => distance(place, point)))}))
    .filter(({metres}) => metres > limit);
  if (far.length === 0) return '';
  const names = far.length > MOST_NAMED ? `${far.length} aircraft` : far.map(({node}) => node).join(', ');
  return `${what} is ${wayLeft(Math.max(...far.map(({metres}) => metres)))} away from ${names}.`;
}
