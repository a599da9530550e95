// The circle that aircraft may be sent into; they decline points and areas outside of it.
import {distance} from './geo.js';
import {wayLeft} from './destinations.js';

// Why aircraft will decline these points; empty if they are inside, or if there is no fence.
export function outsideOf(fence, points) {
  if (!fence) return '';
  const outside = Math.max(...points.map((point) => distance({lat: fence.latitude_deg, lng: fence.longitude_deg}, point))) - fence.radius_m;
  return outside > 0 ? `${wayLeft(Math.max(1, outside))} outside of the geofence` : '';
}
