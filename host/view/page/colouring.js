// Colours of the thread, computed from its shape, facts of the scene and the knot. The scale runs from blue-black to yellow (like cividis),
// readable with all forms of colour vision and in grey.
import { throwsOf } from './throws.js';

const PLAIN = srgb(0xe9, 0xcf, 0x9b), ACCENT = srgb(0xff, 0x6a, 0x3d), HELD = [srgb(0x56, 0xb4, 0xe9), srgb(0xe6, 0x9f, 0x00)];
const SCALE = [[0x2f, 0x4d, 0x8f], [0x57, 0x6b, 0x9a], [0x83, 0x8c, 0x8e], [0xb8, 0xa9, 0x72], [0xff, 0xe5, 0x4a]].map((c) => srgb(...c));
export const SCALE_CSS = 'linear-gradient(90deg, #2f4d8f, #576b9a, #838c8e, #b8a972, #ffe54a)';

function srgb(...rgb) { return rgb.map((v) => ((v / 255 + 0.055) / 1.055) ** 2.4); }

function onScale(share) {
  const at = Math.min(Math.max(share, 0), 0.9999) * (SCALE.length - 1), k = Math.floor(at), t = at - k;
  return SCALE[k].map((v, j) => v + (SCALE[k + 1][j] - v) * t);
}

/**
 * Colours per node, n x 3, linear RGB, and the legend. @returns {{colours: Float32Array, legend: null | {title, low,
 * high}}}.
 */
export function colourThread(mode, shape, facts = {}, knot = null) {
  const p = shape.p_W, n = p.length / 3, colours = new Float32Array(p.length);
  const paint = (i, c) => colours.set(c, 3 * i);
  let legend = null;
  for (let i = 0; i < n; ++i) paint(i, PLAIN);
  if (mode === 'curvature') {
    const bends = Array.from({ length: n }, (_, i) => curvature(p, i, n)), most = scaleEnd(Math.max(...bends), 1 / (2 * shape.radius_m));
    for (let i = 0; i < n; ++i) paint(i, onScale(bends[i] / most));
    legend = { title: 'curvature', low: '0', high: `${format(most)} 1/m` };
  } else if (mode === 'stretch') {
    const strain = strainOf(shape, n, facts);
    if (strain) legend = paintBothWays(strain, 'stretch', 1, (most) => [`−${format(100 * most)} %`, `+${format(100 * most)} %`], paint);
    else legend = { title: 'stretch: not known of this thread; tension shows it' };
  } else if (mode === 'twist') {
    legend = paintBothWays(twistOf(shape, n), 'twist', 1 / shape.radius_m, (most) => [`−${format(most)} rad/m`, `+${format(most)} rad/m`], paint);
  } else if (mode === 'tension') {
    const most = Math.max(1e-9, ...shape.tension_N.map(Math.abs));
    for (let i = 0; i < n; ++i) paint(i, onScale(Math.max(0, i ? Math.max(shape.tension_N[i - 1], shape.tension_N[i]) : shape.tension_N[0]) / most));
    legend = { title: 'tension', low: '0', high: `${format(most)} N` };
  } else if (mode === 'contact') {
    for (const i of touching(p, n, shape.radius_m)) paint(i, ACCENT);
    legend = { title: 'orange: strand within a tenth of its diameter of another' };
  } else if (mode === 'knot') {
    const throws = throwsOf(knot, shape);
    for (const [first, last] of throws) for (let i = first; i <= last; ++i) paint(i, ACCENT);
    legend = { title: `orange: shortest piece${throws.length > 1 ? 's that hold a throw' : ' that holds the knot'}` };
  }
  shape.grasped.forEach((node, hand) => { if (node >= 0 && node < n) paint(node, HELD[hand]); });
  return { colours, legend };
}

/**
 * Paints the nodes on a scale whose middle is 0. @param perSegment values of the segments; a node has the mean of its
 * two. @param limit largest end of the scale. @param ends texts for the ends.
 */
function paintBothWays(perSegment, title, limit, ends, paint) {
  const last = perSegment.length - 1, most = scaleEnd(Math.max(...perSegment.map(Math.abs)), limit, 1e-9);
  for (let i = 0; i <= last + 1; ++i) paint(i, onScale(0.5 + (perSegment[Math.max(i - 1, 0)] + perSegment[Math.min(i, last)]) / 2 / (2 * most)));
  const [low, high] = ends(most);
  return { title, low, high };
}

/**
 * Strain of each segment, or null. Equal segments have a known rest length. Those of a rod that moves its nodes along the
 * thread have not: there the strain is tension / EA.
 */
function strainOf({ p_W: p, tension_N }, n, { length_m, equal_segments, EA_N }) {
  if (equal_segments) return length_m > 0 ? Array.from({ length: n - 1 }, (_, i) => (distance(p, i, i + 1) * (n - 1)) / length_m - 1) : null;
  return EA_N > 0 ? Array.from({ length: n - 1 }, (_, i) => tension_N[i] / EA_N) : null;
}

/** Twist of each segment, rad/m: the turn of the material from end to end, per length. */
function twistOf({ p_W: p, turn_rad }, n) {
  return Array.from({ length: n - 1 }, (_, i) => (turn_rad[i + 1] - turn_rad[i]) / (distance(p, i, i + 1) || 1));
}

/**
 * Upper end of a scale: 1, 2 or 5 times a power of ten, at most `most`, so that it does not change with every small
 * change of the data.
 */
export function scaleEnd(largest, most, smallest = 1e-3) {
  const least = Math.max(largest, smallest * most), ten = 10 ** Math.floor(Math.log10(least));
  return Math.min(most, [1, 2, 5, 10].map((k) => k * ten).find((end) => end >= least) ?? most);
}

function distance(p, a, b) { return Math.hypot(p[3 * a] - p[3 * b], p[3 * a + 1] - p[3 * b + 1], p[3 * a + 2] - p[3 * b + 2]); }

/** Curvature at a node, 1/m: turning angle / mean length of its two edges. */
function curvature(p, i, n) {
  if (i === 0 || i === n - 1) return 0;
  const a = distance(p, i - 1, i), b = distance(p, i, i + 1);
  let dot = 0;
  for (let j = 0; j < 3; ++j) dot += (p[3 * i + j] - p[3 * i - 3 + j]) * (p[3 * i + 3 + j] - p[3 * i + j]);
  const angle = Math.acos(Math.min(1, Math.max(-1, dot / (a * b || 1))));
  return (2 * angle) / (a + b || 1);
}

/**
 * Nodes of edges that come within 1.1 diameters of another edge that is not adjacent along the thread. A grid of cells
 * keeps the cost linear.
 */
function touching(p, n, radius) {
  let longest = 0;
  for (let i = 0; i + 1 < n; ++i) longest = Math.max(longest, distance(p, i, i + 1));
  const reach = 2.2 * radius, size = reach + longest, apart = Math.max(2, Math.ceil((3 * reach) / (longest || 1)));
  const cells = new Map(), found = new Set();
  const cellOf = (i, j) => Math.floor((p[3 * i + j] + p[3 * i + 3 + j]) / 2 / size);
  for (let i = 0; i + 1 < n; ++i) {
    const c = [0, 1, 2].map((j) => cellOf(i, j));
    for (let k = 0; k < 27; ++k) {
      const others = cells.get(`${c[0] + (k % 3) - 1},${c[1] + (Math.floor(k / 3) % 3) - 1},${c[2] + Math.floor(k / 9) - 1}`) ?? [];
      for (const o of others) if (i - o > apart && edgeDistance(p, i, o) < reach) [i, i + 1, o, o + 1].forEach((m) => found.add(m));
    }
    const key = c.join();
    if (cells.has(key)) cells.get(key).push(i); else cells.set(key, [i]);
  }
  return found;
}

/**
 * Smallest distance between edges i and k: closest points of two segments (Ericson, Real-Time Collision Detection
 * 5.1.9).
 */
function edgeDistance(p, i, k) {
  const d1 = [], d2 = [], r = [];
  for (let j = 0; j < 3; ++j) {
    d1.push(p[3 * i + 3 + j] - p[3 * i + j]); d2.push(p[3 * k + 3 + j] - p[3 * k + j]); r.push(p[3 * i + j] - p[3 * k + j]);
  }
  const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2], clamp = (v) => Math.min(1, Math.max(0, v));
  const a = dot(d1, d1), e = dot(d2, d2), f = dot(d2, r), c = dot(d1, r), b = dot(d1, d2), denominator = a * e - b * b;
  let s = denominator > 1e-12 * a * e ? clamp((b * f - c * e) / denominator) : 0;
  const t = clamp((b * s + f) / (e || 1));
  s = clamp((b * t - c) / (a || 1));
  return Math.hypot(...[0, 1, 2].map((j) => r[j] + s * d1[j] - t * d2[j]));
}

function format(value) { return value >= 100 ? value.toFixed(0) : value.toPrecision(3); }
