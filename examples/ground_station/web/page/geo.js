// Metres and degrees, as the aircraft reckon (examples/swarm/Geo.h).
const METRES_PER_DEGREE = (6371008.8 * Math.PI) / 180;

export const metresPerDegreeOfLatitude = METRES_PER_DEGREE;
export function metresPerDegreeOfLongitude(latitude) {
  return METRES_PER_DEGREE * Math.max(Math.cos((latitude * Math.PI) / 180), 1e-6);
}

export function moved(point, northM, eastM) {
  return {
    lat: point.lat + northM / METRES_PER_DEGREE,
    lng: point.lng + eastM / metresPerDegreeOfLongitude(point.lat),
  };
}
export function offset(from, to) {
  return {
    north: (to.lat - from.lat) * METRES_PER_DEGREE,
    east: (to.lng - from.lng) * metresPerDegreeOfLongitude(from.lat),
  };
}
export function distance(from, to) {
  const {north, east} = offset(from, to);
  return Math.hypot(north, east);
}

// The corners of a search area: south-west, north-west, north-east, south-east.
export function corners(area) {
  const middle = {lat: area.latitude_deg, lng: area.longitude_deg};
  const n = area.north_m / 2;
  const e = area.east_m / 2;
  return [[-n, -e], [n, -e], [n, e], [-n, e]].map(([north, east]) => moved(middle, north, east));
}

// An ellipse as points: half axes in metres, heading of the major one clockwise from north.
export function ellipse(middle, major, minor, heading) {
  const points = [];
  for (let i = 0; i < 36; i++) {
    const angle = (i / 36) * 2 * Math.PI;
    const along = major * Math.cos(angle);
    const across = minor * Math.sin(angle);
    points.push(moved(middle, along * Math.cos(heading) - across * Math.sin(heading),
      along * Math.sin(heading) + across * Math.cos(heading)));
  }
  return points;
}
