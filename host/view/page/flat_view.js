// Draws the thread without WebGL, in two dimensions from two sides, nearer strands over farther ones.
import { colourThread } from './colouring.js';
import { NO_FACTS } from './scene_facts.js';
import { followed, middleOf } from './throws.js';

const HAND_CSS = ['#56b4e9', '#e69f00'], DRAW_MS = 40, AXES = 'xyz';
/**
 * Per view: which axis points right, which up, and which (with which sign) towards the viewer. Same names as the
 * buttons of the 3-D view.
 */
const SIDES = { front: { right: 0, up: 2, near: 1, sign: -1 }, side: { right: 1, up: 2, near: 0, sign: 1 }, top: { right: 0, up: 1, near: 2, sign: 1 } };

export class FlatView {
  /** @param signal aborted when the picture is no longer wanted. */
  constructor(host, choice, onLost, signal) {
    this.choice = choice;
    this.canvas = Object.assign(document.createElement('canvas'), { id: 'flat', className: 'picture', hidden: true });
    this.context = this.canvas.getContext('2d');
    if (!this.context) throw new Error('this browser draws on no canvas');
    this.facts = NO_FACTS;
    this.maxForce_N = 3.3;
    this.box = null;
    this.due = 0;
    this.panes = []; // where each picture is drawn and how it maps to the world; as in scene.js
    host.prepend(this.canvas);
    signal.addEventListener('abort', () => this.canvas.remove());
  }

  show(on) { this.canvas.hidden = !on; }
  setForce(maxForce_N) { this.maxForce_N = maxForce_N || this.maxForce_N; }
  setFacts(facts) { this.facts = facts ?? NO_FACTS; this.isDirty = true; }
  setStereo() {} // stereo needs depth
  view() { this.box = null; }

  /** Takes a new shape. @returns the legend. */
  update(shape, now, knot) {
    if (!shape) return null;
    Object.assign(this, { shape, now, knot, isDirty: true });
    const { colours, legend } = colourThread(this.choice.colour, shape, this.facts, knot);
    this.colours = colours;
    return legend;
  }

  get sides() {
    const first = SIDES[this.choice.view] ? this.choice.view : 'front';
    return [first, first === 'side' ? 'front' : 'side'];
  }

  /**
   * A camera for the left picture, in the form that knot_diagram.js needs: so far away that the projection is nearly
   * parallel.
   */
  get camera() {
    if (!this.shape) return null;
    const box = this.#frame(), { right, up, near, sign } = SIDES[this.sides[0]], m = new Array(16).fill(0);
    m[4 * right] = m[4 * up + 1] = 1;
    m[4 * near + 2] = sign;
    m[12] = -box.centre[right];
    m[13] = -box.centre[up];
    m[14] = -sign * box.centre[near] - 100 * Math.max(...box.size);
    m[15] = 1;
    return { matrixWorldInverse: { elements: m } };
  }

  /**
   * The box to be shown: the thread and all its earlier places, or with `follow` one throw of the knot alone (without
   * a knot, the held nodes).
   */
  #frame() {
    const p = this.shape.p_W, pieces = this.choice.follow ? followed(this.knot, this.shape, this.at ?? [0, 0, 0]) : [];
    const nodes = pieces.flatMap(([first, last]) => [...range(first, last + 1)]);
    if (nodes.length) this.at = middleOf(p, pieces[0]);
    const box = boxOf(p, nodes.length ? nodes : range(0, p.length / 3));
    if (nodes.length) return widened(box, 12 * this.shape.radius_m);
    this.box = this.box ? joined(this.box, box) : box;
    return widened(this.box, 12 * this.shape.radius_m);
  }

  /** Redraws at most every DRAW_MS. */
  draw(time) {
    const { canvas } = this, ratio = devicePixelRatio;
    const width = Math.round(canvas.clientWidth * ratio), height = Math.round(canvas.clientHeight * ratio);
    const isResized = canvas.width !== width || canvas.height !== height;
    if (!this.shape || !width || !height || time < this.due || !(this.isDirty || isResized)) return;
    this.due = time + DRAW_MS;
    this.isDirty = false;
    if (isResized) { canvas.width = width; canvas.height = height; }
    const c = this.context, box = this.#frame(), isWide = width > height;
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    const [w, h] = [canvas.clientWidth / (isWide ? 2 : 1), canvas.clientHeight / (isWide ? 1 : 2)];
    const scale = Math.min(...this.sides.map((s) => Math.min((0.8 * w) / box.size[SIDES[s].right], (0.58 * h) / box.size[SIDES[s].up])));
    this.metresPerPixel = 1 / scale;
    this.panes = [];
    this.sides.forEach((name, i) => this.#pane(name, { x: isWide ? i * w : 0, y: isWide ? 0 : i * h, w, h }, box, scale));
    c.fillStyle = '#c9d2de'; // labels on both sides of the line between the two pictures, where the page shows no text over them
    c.font = '12px sans-serif';
    this.sides.forEach((name, i) => {
      c.textAlign = i && isWide ? 'left' : 'right';
      c.fillText(`${name}: ${AXES[SIDES[name].right]} →, ${AXES[SIDES[name].up]} ↑`, isWide ? w + (i ? 10 : -10) : w - 14, isWide ? h - 10 : h + (i ? 18 : -10));
    });
  }

  #pane(name, { x, y, w, h }, box, scale) {
    const c = this.context, side = SIDES[name];
    const middle = h > w ? 0.5 : 0.55; // a low pane has the page's buttons over its upper part
    const place = (at) => [x + w / 2 + scale * (at[side.right] - box.centre[side.right]), y + middle * h - scale * (at[side.up] - box.centre[side.up])];
    const axis = (which, sign) => [0, 1, 2].map((j) => (j === which ? sign : 0));
    this.panes.push({ x, y, w, h, place, right: axis(side.right, 1), up: axis(side.up, 1), away: axis(side.near, -side.sign), metresPerPixel: () => 1 / scale });
    c.save();
    c.beginPath(); c.rect(x, y, w, h); c.clip();
    c.fillStyle = '#222a35';
    c.fillRect(x, y, w, h);
    const { desk_height_m: deskHeight_m } = this.facts;
    if (deskHeight_m !== null && side.up === 2) {
      const level = place([0, 0, deskHeight_m])[1];
      c.fillStyle = '#3a4452';
      c.fillRect(x, level, w, y + h - level);
    }
    for (const p of this.facts.fixed) { const [u, v] = place(p); polygon(c, [[u, v - 6], [u + 6, v], [u, v + 6], [u - 6, v]], '#b8c2cf'); }
    this.#thread(side, place, Math.max(1.6, 2 * scale * this.shape.radius_m));
    this.now?.hands?.forEach((hand, i) => this.#hand(hand, i, side, place, 0.3 * Math.min(w, h) / this.maxForce_N));
    c.strokeStyle = '#323b49';
    c.strokeRect(x - 0.5, y - 0.5, w + 1, h + 1);
    c.restore();
  }

  /**
   * Draws edges from back to front, each with a dark rim, so that an over-passing strand visibly cuts the one below.
   */
  #thread({ near, sign }, place, thick) {
    const c = this.context, { p_W: p } = this.shape, n = p.length / 3, at = (i) => place([p[3 * i], p[3 * i + 1], p[3 * i + 2]]);
    const depth = (i) => sign * (p[3 * i + near] + p[3 * i + 3 + near]);
    for (const i of [...range(0, n - 1)].sort((a, b) => depth(a) - depth(b))) {
      const [from, to] = [at(i), at(i + 1)];
      c.lineCap = 'butt';
      stroke(c, from, to, '#05070a', thick + 2.4);
      c.lineCap = 'round';
      stroke(c, from, to, css(this.colours, i), thick);
    }
  }

  #hand(hand, i, side, place, pixelsPerNewton) {
    const c = this.context, [u, v] = place(hand.p_W), size = hand.grip ? 6 : 9;
    if (hand.deadMan) { c.strokeStyle = '#2fbf8f'; c.lineWidth = 2; c.beginPath(); c.arc(u, v, 15, 0, 2 * Math.PI); c.stroke(); }
    c.fillStyle = c.strokeStyle = HAND_CSS[i];
    c.lineWidth = 2.5;
    c.beginPath();
    if (i === 0) c.arc(u, v, size, 0, 2 * Math.PI); else c.rect(u - size, v - size, 2 * size, 2 * size);
    if (hand.grip) c.fill(); else c.stroke();
    const f = [pixelsPerNewton * hand.f_device[side.right], -pixelsPerNewton * hand.f_device[side.up]], length = Math.hypot(...f);
    if (length < 2) return;
    const [ex, ey] = [f[0] / length, f[1] / length], tip = [u + f[0], v + f[1]];
    stroke(c, [u, v], tip, HAND_CSS[i], 3);
    polygon(c, [[tip[0] + 9 * ex, tip[1] + 9 * ey], [tip[0] - 5 * ey, tip[1] + 5 * ex], [tip[0] + 5 * ey, tip[1] - 5 * ex]], HAND_CSS[i]);
  }
}

function stroke(c, from, to, colour, width) {
  c.strokeStyle = colour;
  c.lineWidth = width;
  c.beginPath(); c.moveTo(...from); c.lineTo(...to); c.stroke();
}

function polygon(c, points, colour) {
  c.fillStyle = colour;
  c.beginPath();
  points.forEach((p, i) => (i ? c.lineTo(...p) : c.moveTo(...p)));
  c.fill();
}

/** Linear RGB to sRGB, as a CSS colour. */
function css(colours, i) {
  return `rgb(${[0, 1, 2].map((j) => { const v = colours[3 * i + j]; return Math.round(255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055)); }).join()})`;
}

function* range(from, to) { for (let i = from; i < to; ++i) yield i; }

function boxOf(p, nodes) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const i of nodes) for (let j = 0; j < 3; ++j) { low[j] = Math.min(low[j], p[3 * i + j]); high[j] = Math.max(high[j], p[3 * i + j]); }
  return { low, high };
}

function joined(a, b) { return { low: a.low.map((v, j) => Math.min(v, b.low[j])), high: a.high.map((v, j) => Math.max(v, b.high[j])) }; }

function widened({ low, high }, least) {
  return { centre: low.map((v, j) => (v + high[j]) / 2), size: low.map((v, j) => Math.max(high[j] - v, least)) };
}
