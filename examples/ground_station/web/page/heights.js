// What a height above sea level means: against the height an aircraft has now, against the ground, against its floor.
import {isNumber} from './format.js';
import {distance} from './geo.js';
import {placeOf} from './model.js';

export const LARGE_DESCENT_M = 50;  // more is asked about again

const metres = (value) => `${Number(value.toFixed(value === Math.round(value) || Math.abs(value) >= 100 ? 0 : 1))} m`;

const GROUND_HOLDS_M = 5000;  // from home: an aircraft knows the height of the ground only there

// The highest ground at these points, by what the aircraft know of the ground at their homes. null: none knows a ground;
// NaN: the points are too far from the home of each that knows one.
export function knownGround(aircraft, points) {
  const known = aircraft.filter((one) => isNumber(one.ground_m));
  if (known.length === 0) return null;
  const homeOf = (one) => (one.home ? {lat: one.home.latitude_deg, lng: one.home.longitude_deg} : placeOf(one));
  const isNear = (home) => home === null || points.every((point) => distance(home, point) <= GROUND_HOLDS_M);
  const near = known.filter((one) => isNear(homeOf(one)));
  return near.length > 0 ? Math.max(...near.map((one) => one.ground_m)) : NaN;
}

function againstPresent(altitude, present, than) {
  const change = altitude - present;
  if (Math.abs(change) < 0.5) return `as high as ${than}`;
  return `${metres(Math.abs(change))} ${change < 0 ? 'lower' : 'higher'} than ${than}`;
}

function againstGround(altitude, ground) {
  const above = altitude - ground;
  return `${metres(Math.abs(above))} ${above < 0 ? 'BELOW' : 'above'} the ground, which is at ${metres(ground)}`;
}

// What is to be known of an altitude before it is sent: `says` for a person, and `asks`, why it must be confirmed once
// more, empty if it need not. present: of what it is compared with, which `than` names; ground: see knownGround;
// floors: [[name, altitude], ...] of those who are to fly there.
export function describeHeight({altitude, present, than, ground, floors = []}) {
  if (!isNumber(altitude)) return {says: '', asks: ''};
  const parts = [];
  const asks = [];
  if (isNumber(present)) {
    parts.push(againstPresent(altitude, present, than));
    if (present - altitude > LARGE_DESCENT_M) asks.push(`a descent of ${metres(present - altitude)}`);
  }
  if (isNumber(ground)) {
    parts.push(againstGround(altitude, ground));
    if (altitude <= ground) asks.push('a point that is not above the ground');
  } else if (ground !== null && ground !== undefined) {
    parts.push('the height of the ground is not known there');
  }
  let says = `${metres(altitude)} above sea level${parts.length > 0 ? `: ${parts.join(', ')}` : ''}.`;
  const low = floors.filter(([, floor]) => isNumber(floor) && altitude < floor - 0.05);
  if (low.length > 0) {
    const names = low.length > 3 ? `${low.length} aircraft` : low.map(([name]) => name).join(', ');
    says += ` ▲ Below the floor of ${names} (${metres(Math.max(...low.map(([, floor]) => floor)))}): it will be declined.`;
    asks.push('a height below the floor');
  }
  return {says, asks: asks.length > 0 ? `This is ${asks.join(' and ')}.` : ''};
}
