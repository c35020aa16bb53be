// What the chosen scene looks like before it is loaded: its start shape, facts, and what its file says about it.
const $ = (id) => document.getElementById(id);
const MARGIN_PX = 16, DEPTH = [0.35, 0.25]; // how far a point that is 1 m further away is drawn to the right and up
const THREAD = '#e8ecf2', GROUND = '#1b212b', DESK = '#9aa6b6';

/** @param preview {about, facts, desk_height_m or null, points: [[x, y, z] ..]}, or undefined: there is none. */
export function showPreview(preview) {
  $('preview').hidden = !preview;
  if (!preview) return;
  const { about, facts, points } = preview;
  $('preview-facts').textContent = points.length ? facts : 'This scene cannot be loaded. ';
  $('preview-about').textContent = about;
  $('preview-shape').hidden = points.length < 2;
  if (points.length > 1) draw($('preview-shape'), points, preview.desk_height_m);
}

/** Maps points, oblique from the front, into the canvas at one scale. */
function place(points, { width, height }) {
  const flat = points.map(([x, y, z]) => [x + DEPTH[0] * y, z + DEPTH[1] * y]);
  const [low, high] = [Math.min, Math.max].map((pick) => [0, 1].map((k) => flat.reduce((best, p) => pick(best, p[k]), flat[0][k])));
  const size = [high[0] - low[0], high[1] - low[1]];
  const scale = Math.min((width - 2 * MARGIN_PX) / (size[0] || 1e-9), (height - 2 * MARGIN_PX) / (size[1] || 1e-9));
  return flat.map(([x, z]) => [width / 2 + scale * (x - low[0] - size[0] / 2), height / 2 - scale * (z - low[1] - size[1] / 2)]);
}

/** Pieces further away are drawn first, each with a rim, so that it is seen which strand lies in front. */
function draw(canvas, points, desk_height_m) {
  const g = canvas.getContext('2d'), hasDesk = desk_height_m !== null;
  const corners = hasDesk ? deskUnder(points, desk_height_m) : [];
  const placed = place([...points, ...corners], canvas), desk = placed.slice(points.length);
  g.clearRect(0, 0, canvas.width, canvas.height);
  g.lineJoin = 'round';
  if (hasDesk) { trace(g, [...desk, desk[0]]); g.strokeStyle = DESK; g.lineWidth = 1.5; g.stroke(); }
  const pieces = points.slice(1).map((p, i) => ({ y: p[1] + points[i][1], ends: [placed[i], placed[i + 1]] }));
  for (const { ends } of pieces.sort((a, b) => b.y - a.y)) {
    for (const [colour, width, cap] of [[GROUND, 9, 'butt'], [THREAD, 3.5, 'round']]) { trace(g, ends); Object.assign(g, { strokeStyle: colour, lineWidth: width, lineCap: cap }); g.stroke(); }
  }
}

/** Corners of a square of the desk below the thread. */
function deskUnder(points, height_m) {
  const [low, high] = [Math.min, Math.max].map((pick) => [0, 1].map((k) => points.reduce((best, p) => pick(best, p[k]), points[0][k])));
  const half_m = 0.6 * Math.max(high[0] - low[0], high[1] - low[1], 1e-3), x = (low[0] + high[0]) / 2, y = (low[1] + high[1]) / 2;
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([i, k]) => [x + i * half_m, y + k * half_m, height_m]);
}

function trace(g, line) {
  g.beginPath();
  line.forEach(([x, y], i) => (i ? g.lineTo(x, y) : g.moveTo(x, y)));
}
