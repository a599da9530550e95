// The layer of the map on which everything is drawn that is not an aircraft or a handle. One canvas: trails of twenty
// aircraft are thousands of points, ten times a second.
/* global L */

const COLOURS = ['grid', 'grid-text', 'halo', 'trail', 'footprint', 'area', 'draft', 'target', 'old', 'text', 'route'];

export const CanvasLayer = L.Layer.extend({
  // draw(painter) is called whenever the canvas must be painted anew.
  initialize(draw) {
    this.drawAll = draw;
  },
  onAdd(map) {
    this.canvas = L.DomUtil.create('canvas', '', map.getPane('overlayPane'));
    this.canvas.style.pointerEvents = 'none';
    this.readColours();
    document.documentElement.addEventListener('themechange', () => this.readColours());
    map.on('move zoomend viewreset resize', this.paint, this);
    this.paint();
  },
  readColours() {
    const style = getComputedStyle(document.documentElement);
    this.colours = {};
    for (const name of COLOURS) this.colours[name] = style.getPropertyValue(`--${name}`).trim();
    this.font = `12px ${getComputedStyle(document.body).fontFamily}`;
    if (this._map) this.paint();
  },
  paint() {
    const map = this._map;
    const size = map.getSize();
    const ratio = window.devicePixelRatio || 1;
    const width = Math.round(size.x * ratio);
    const height = Math.round(size.y * ratio);
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      this.canvas.style.width = `${size.x}px`;
      this.canvas.style.height = `${size.y}px`;
    }
    L.DomUtil.setPosition(this.canvas, map.containerPointToLayerPoint([0, 0]));
    const context = this.canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, size.x, size.y);
    context.font = this.font;
    this.drawAll(new Painter(context, map, size, this.colours));
  },
});

// A point of the map once for all zooms, so that a trail is projected when it grows and not whenever it is painted.
export function project(map, point) {
  return map.project([point.lat, point.lng], 0);
}

class Painter {
  constructor(context, map, size, colours) {
    Object.assign(this, {context, map, size, colours});
    this.scale = map.getZoomScale(map.getZoom(), 0);
    this.origin = map.getPixelBounds().min;
  }
  place(projected) {
    return [projected.x * this.scale - this.origin.x, projected.y * this.scale - this.origin.y];
  }
  at(point) {
    return this.place(project(this.map, point));
  }
  path(places, close) {
    const {context} = this;
    context.beginPath();
    places.forEach(([x, y], i) => (i === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
    if (close) context.closePath();
  }
  stroke(colour, width, dash = []) {
    const {context} = this;
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.setLineDash(dash);
    context.stroke();
  }
  fill(colour, alpha) {
    this.context.globalAlpha = alpha;
    this.context.fillStyle = colour;
    this.context.fill();
    this.context.globalAlpha = 1;
  }
  textWidth(text) {
    return this.context.measureText(text).width;
  }
  label(text, x, y, colour) {
    const {context} = this;
    context.setLineDash([]);
    context.lineWidth = 3;
    context.strokeStyle = this.colours.halo;
    context.strokeText(text, x, y);
    context.fillStyle = colour;
    context.fillText(text, x, y);
  }
}
