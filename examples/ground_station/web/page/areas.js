// Search areas and their outcome: the wanted one, and those that aircraft fly.
import {isNumber} from './format.js';

const MOST_NAMED = 4;

const namesOf = (nodes) => (nodes.length > MOST_NAMED ? `${nodes.length} aircraft` : nodes.join(', '));

// The number of aircraft that fly an area, as `0 of 3`.
export function countOf(area) {
  return `${area.flown_by} of ${area.answers.length}`;
}
// True if all aircraft fly it. An area that no aircraft has heard of is flown by none.
export function isFlownByAll(area) {
  return area.answers.length > 0 && area.flown_by === area.answers.length;
}

// The areas to draw: those that any aircraft flies, and the wanted one, which is the last.
export function areasToDraw(model) {
  const areas = model.snapshot?.areas ?? [];
  return areas.filter((area, i) => i === areas.length - 1 || area.flown_by > 0)
    .filter(({latitude_deg: latitude, longitude_deg: longitude}) => isNumber(latitude) && isNumber(longitude));
}

// One text for each outcome but the good one: `declined by uav1, uav2: 1.2 km outside of the geofence; they fly area 1`.
export function outcomesOf(area) {
  const groups = new Map();
  for (const answer of area.answers) {
    if (answer.progress === 'flown') continue;
    const key = `${answer.progress}|${answer.reason}|${answer.flies}`;
    groups.set(key, {...answer, nodes: [...(groups.get(key)?.nodes ?? []), answer.node]});
  }
  return [...groups.values()].map(({progress, reason, flies, nodes}) => {
    const what = {sent: 'not answered by', replaced: 'replaced at'}[progress] ?? `${progress} by`;
    const now = flies > 0 ? `; flying area ${flies}` : progress === 'declined' ? '; without an area' : '';
    return `${what} ${namesOf(nodes)}${reason ? `: ${reason}` : ''}${now}`;
  });
}
