// Finds places for the texts on the map, so that none covers another.

const MARGIN_PX = 1;

export class LabelSpace {
  taken = [];
  // size: of the map, {x, y}. Outside of it no place is free.
  constructor(size) {
    this.size = size;
  }

  // Takes a rectangle, whatever is there.
  block(x, y, width, height) {
    this.taken.push({left: x, top: y, right: x + width, bottom: y + height});
  }
  isFree({left, top, right, bottom}) {
    return left >= 0 && top >= 0 && right <= this.size.x && bottom <= this.size.y && !this.taken.some((one) => left < one.right + MARGIN_PX && right > one.left - MARGIN_PX &&
      top < one.bottom + MARGIN_PX && bottom > one.top - MARGIN_PX);
  }
  // Takes the first free one of these places, each [x, y] of the upper left corner of a text of that size. Returns its
  // number; -1 if none is free.
  place(places, width, height) {
    const at = places.findIndex(([x, y]) => this.isFree({left: x, top: y, right: x + width, bottom: y + height}));
    if (at >= 0) this.block(...places[at], width, height);
    return at;
  }
}

// The places beside a symbol, the usual one first.
export function placesAround(x, y, width, height, gap) {
  const rows = [0, -1, 1, -2, 2];
  return [
    ...rows.map((row) => [x + gap, y - height / 2 + row * height]),
    ...rows.map((row) => [x - gap - width, y - height / 2 + row * height]),
    [x - width / 2, y - gap - height],
    [x - width / 2, y + gap],
  ];
}
