// What a height above sea level means: against the height an aircraft has now, against the ground, against its floor.
import {isNumber} from './format.js';

export const LARGE_DESCENT_M = 50;  // more is asked about again

const metres = (value) => `${Number(value.toFixed(value === Math.round(value) || Math.abs(value) >= 100 ? 0 : 1))} m`;

// The highest of what the aircraft know of their ground; null if none knows.
export function knownGround(aircraft) {
  const heights = aircraft.map((one) => one.ground_m).filter(isNumber);
  return heights.length > 0 ? Math.max(...heights) : null;
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
// more, empty if it need not. present: of what it is compared with, which `than` names; ground: null if it is not known;
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
