// Where words stand in the picture, so that none covers another or a place.

const AROUND = [[0, 1], [0, -1], [1, 0], [-1, 0], [1, 1], [-1, 1], [1, -1], [-1, -1]];
const RINGS = [0, 14, 32, 54, 80, 110, 150, 200];
const ALONG = [0.5, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74, 0.18, 0.82];
const paper = document.createElement("canvas").getContext("2d");

export function width(words, bold) {
  paper.font = `${bold ? "bold " : ""}13px "DejaVu Sans", Verdana, Helvetica, Arial, sans-serif`;
  return paper.measureText(words).width;
}

function covers(a, b) {
  return a.x < b.x + b.w && b.x < a.x + a.w && a.y < b.y + b.h && b.y < a.y + a.h;
}

// Does a line from a to b touch a box? (Liang and Barsky's clipping.)
function crosses({ a, b }, box) {
  const sides = [
    [a.x - b.x, a.x - box.x], [b.x - a.x, box.x + box.w - a.x],
    [a.y - b.y, a.y - box.y], [b.y - a.y, box.y + box.h - a.y],
  ];
  let [from, to] = [0, 1];
  for (const [p, q] of sides) {
    if (p === 0 && q < 0) return false;
    if (p < 0) from = Math.max(from, q / p);
    if (p > 0) to = Math.min(to, q / p);
  }
  return from <= to;
}

export class Taken {
  // `lines` are ways, which words had better not cover; the size is that of the picture, in which words stay.
  constructor(lines, { width, height }) {
    this.boxes = [];
    this.lines = lines;
    this.inside = (x, y, w = 0, h = 0) => x >= 0 && y >= 0 && x + w <= width && y + h <= height;
  }

  add(box) {
    this.boxes.push(box);
    return box;
  }

  isFree(box) {
    return !this.boxes.some((other) => covers(box, other));
  }

  // A box of this size beside a point, as near as there is room; `far`: it is not right beside it.
  beside(x, y, w, h, gap) {
    const seen = this.inside(x, y), fits = (box) => this.isFree(box) && (!seen || this.inside(box.x, box.y, w, h));
    for (const [dx, dy] of AROUND) {
      const box = { x: x - w / 2 + dx * (w / 2 + gap), y: y - h / 2 + dy * (h / 2 + gap), w, h, far: false };
      if (fits(box) && !this.lines.some((line) => crosses(line, box))) return this.add(box);
    }
    for (const ring of RINGS) {
      for (const [dx, dy] of AROUND) {
        const away = gap + ring;
        const box = { x: x - w / 2 + dx * (w / 2 + away), y: y - h / 2 + dy * (h / 2 + away), w, h, far: ring > 0 };
        if (fits(box)) return this.add(box);
      }
    }
    for (let down = gap + RINGS[RINGS.length - 1]; ; down += h) {
      const box = { x: x - w / 2, y: y + down, w, h, far: true };
      if (this.isFree(box)) return this.add(box);
    }
  }

  // A box of this size on a line; null where there is no room.
  on(a, b, w, h) {
    for (const part of ALONG) {
      const box = { x: a.x + part * (b.x - a.x) - w / 2, y: a.y + part * (b.y - a.y) - h / 2, w, h };
      if (this.isFree(box)) return this.add(box);
    }
    return null;
  }
}
