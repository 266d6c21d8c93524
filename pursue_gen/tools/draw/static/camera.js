// From metres of the map to pixels of the picture, and back.

export const camera = { x: 0, y: 0, scale: 60 }; // the middle in metres, pixels per metre
const SMALLEST = 0.5;
const LARGEST = 2000;

export function size() {
  const box = document.getElementById("plan").getBoundingClientRect();
  return { width: box.width || 600, height: box.height || 400, left: box.left, top: box.top };
}

export function toScreen(x, y) {
  const { width, height } = size();
  return { x: width / 2 + (x - camera.x) * camera.scale, y: height / 2 - (y - camera.y) * camera.scale };
}

// Of a point in the window.
export function toMap(clientX, clientY) {
  const { width, height, left, top } = size();
  const x = camera.x + (clientX - left - width / 2) / camera.scale;
  return { x, y: camera.y - (clientY - top - height / 2) / camera.scale };
}

export function pan(dx, dy) {
  camera.x -= dx / camera.scale;
  camera.y += dy / camera.scale;
}

// Nearer by a factor; what is under the point of the window stays there.
export function zoom(factor, clientX, clientY) {
  const before = toMap(clientX, clientY);
  camera.scale = Math.min(Math.max(camera.scale * factor, SMALLEST), LARGEST);
  const after = toMap(clientX, clientY);
  camera.x += before.x - after.x;
  camera.y += before.y - after.y;
}

export function corners(floor) {
  if (!floor) return [];
  const [cos, sin] = [Math.cos(floor.yaw), Math.sin(floor.yaw)];
  const ends = [[0, 0], [floor.width, 0], [floor.width, floor.height], [0, floor.height]];
  return ends.map(([a, b]) => ({ x: floor.x + cos * a - sin * b, y: floor.y + sin * a + cos * b }));
}

// All these points, with a margin for words.
export function fit(points) {
  const { width, height } = size();
  const xs = points.length ? points.map((one) => one.x) : [-4, 4];
  const ys = points.length ? points.map((one) => one.y) : [-3, 3];
  const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  camera.x = (left + right) / 2;
  camera.y = (low + high) / 2;
  const room = Math.min((width - 120) / Math.max(right - left, 2), (height - 110) / Math.max(high - low, 2));
  camera.scale = Math.min(Math.max(room, SMALLEST), LARGEST);
}
