// Where the aircraft fly because somebody sent them there: each stays on the map until its command is done.
import {distance} from './geo.js';
import {isNumber} from './format.js';

const FOLLOWED_S = 60;  // an order of an aircraft that was LOST for longer is not known to be followed any more
const UNDER_WAY = new Set(['sent', 'delivered', 'accepted', 'in doubt']);

// The destination of the last command of each aircraft, if that is under way and leads to a place that is known:
// {node, kind, number, to, from, left, fresh}; from and left (metres) are null if nobody knows where the aircraft is.
export function destinationsOf(model) {
  const last = new Map();
  for (const command of model.snapshot?.commands ?? []) last.set(command.node, command);
  const found = [];
  for (const command of last.values()) {
    if (!UNDER_WAY.has(command.progress)) continue;
    const aircraft = model.find(command.node);
    if (!aircraft || aircraft.without_orders) continue;
    if (model.state(aircraft) === 'lost' && !(model.age(aircraft.pose?.age_s) <= FOLLOWED_S)) continue;
    const place = {goto: command, home: aircraft.home}[command.kind];
    if (!place || !isNumber(place.latitude_deg) || !isNumber(place.longitude_deg)) continue;
    const to = {lat: place.latitude_deg, lng: place.longitude_deg};
    const {pose} = aircraft;
    const from = pose && isNumber(pose.latitude_deg) && isNumber(pose.longitude_deg) ? {lat: pose.latitude_deg, lng: pose.longitude_deg} : null;
    found.push({node: command.node, kind: command.kind, number: command.number, to, from,
      left: from ? distance(from, to) : null, fresh: model.isPoseFresh(aircraft)});
  }
  return found;
}

export function wayLeft(metres) {
  if (!isNumber(metres)) return '';
  return metres >= 10000 ? `${(metres / 1000).toFixed(0)} km` : metres >= 1000 ? `${(metres / 1000).toFixed(1)} km` : `${Math.round(metres)} m`;
}
