// Draws the knot as a diagram: its strands as the camera sees them, with gaps where they pass under, and the sign of
// each crossing.
const MOST_POINTS = 160, GAP_PX = 6, MARGIN_PX = 14, MOST_SQUEEZED = 3;

/**
 * @param core first and last node of the knot; undefined: nothing is drawn.
 * @returns {{x, y, sign}[]} the crossings in the picture.
 */
export function drawDiagram(canvas, p_W, core, camera) {
  canvas.hidden = !core;
  if (!core) return [];
  const points = seen(p_W, core, camera), crossings = crossingsOf(points);
  const ctx = canvas.getContext('2d'), place = fit(points, canvas);
  ctx.clearRect(0, 0, canvas.width, canvas.height);
  ctx.lineJoin = ctx.lineCap = 'round';
  ctx.strokeStyle = '#e9cf9b';
  ctx.lineWidth = 2.5;
  for (const piece of pieces(points, crossings, place)) {
    ctx.beginPath();
    piece.forEach(([x, y], i) => (i ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
    ctx.stroke();
  }
  ctx.font = 'bold 14px sans-serif';
  ctx.textAlign = 'center';
  for (const crossing of crossings) {
    const [x, y] = place(crossing.x, crossing.y);
    ctx.fillStyle = crossing.sign > 0 ? '#2fbf8f' : '#cc79a7';
    ctx.fillText(crossing.sign > 0 ? '+' : '−', x + 10, y - 6);
    ctx.beginPath(); ctx.arc(x, y, 2.2, 0, 2 * Math.PI); ctx.fill();
  }
  return crossings;
}

/** The core's nodes projected to the camera's plane; larger depth is nearer. */
function seen(p, [first, last], camera) {
  const m = camera.matrixWorldInverse.elements, step = Math.max(1, Math.ceil((last - first) / MOST_POINTS)), points = [];
  for (let i = first; i <= last; i += i + step > last && i < last ? last - i : step) {
    const [x, y, z] = [p[3 * i], p[3 * i + 1], p[3 * i + 2]];
    const at = [0, 1, 2].map((r) => m[r] * x + m[r + 4] * y + m[r + 8] * z + m[r + 12]);
    points.push([at[0] / -at[2], at[1] / -at[2], at[2]]);
  }
  return points;
}

/** Crossings of the projected edges: which edges, where along them, the sign, and which passes over. */
export function crossingsOf(points) {
  const found = [];
  for (let i = 0; i + 1 < points.length; ++i) {
    const [a, b] = [points[i], points[i + 1]], d = [b[0] - a[0], b[1] - a[1]];
    for (let k = i + 2; k + 1 < points.length; ++k) {
      const [u, v] = [points[k], points[k + 1]], e = [v[0] - u[0], v[1] - u[1]];
      const turn = d[0] * e[1] - d[1] * e[0];
      if (turn === 0) continue;
      const s = ((u[0] - a[0]) * e[1] - (u[1] - a[1]) * e[0]) / turn, t = ((u[0] - a[0]) * d[1] - (u[1] - a[1]) * d[0]) / turn;
      if (s < 0 || s >= 1 || t < 0 || t >= 1) continue;
      const isFirstOver = a[2] + s * (b[2] - a[2]) > u[2] + t * (v[2] - u[2]);
      found.push({ x: a[0] + s * d[0], y: a[1] + s * d[1], sign: (turn > 0) === isFirstOver ? 1 : -1, under: isFirstOver ? k + t : i + s });
    }
  }
  return found;
}

function fit(points, canvas) {
  const x = points.map((p) => p[0]), y = points.map((p) => p[1]);
  const [left, right, low, high] = [Math.min(...x), Math.max(...x), Math.min(...y), Math.max(...y)];
  const full = [(canvas.width - 2 * MARGIN_PX) / (right - left || 1), (canvas.height - 2 * MARGIN_PX) / (high - low || 1)];
  const [sx, sy] = full.map((s) => Math.min(s, MOST_SQUEEZED * Math.min(...full))); // different scales in x and y do not change the crossings
  return (px, py) => [canvas.width / 2 + sx * (px - (left + right) / 2), canvas.height / 2 - sy * (py - (low + high) / 2)];
}

/** Cuts the strand into pieces, with a gap around each under-pass. */
function pieces(points, crossings, place) {
  const line = points.map(([x, y]) => place(x, y)), along = [0];
  for (let i = 1; i < line.length; ++i) along.push(along[i - 1] + Math.hypot(line[i][0] - line[i - 1][0], line[i][1] - line[i - 1][1]));
  const lengthAt = (u) => { const i = Math.min(Math.floor(u), line.length - 2); return along[i] + (u - i) * (along[i + 1] - along[i]); };
  const at = (length) => {
    let i = along.findIndex((l) => l >= length);
    if (i <= 0) i = i < 0 ? line.length - 1 : 1;
    const share = (length - along[i - 1]) / (along[i] - along[i - 1] || 1);
    return [0, 1].map((j) => line[i - 1][j] + share * (line[i][j] - line[i - 1][j]));
  };
  const cuts = crossings.map((c) => lengthAt(c.under)).sort((a, b) => a - b), out = [];
  let from = 0;
  for (const until of [...cuts, along.at(-1) + GAP_PX]) {
    const end = until - GAP_PX;
    if (end > from) out.push([at(from), ...line.filter((_, i) => along[i] > from && along[i] < end), at(end)]);
    from = until + GAP_PX;
  }
  return out;
}
