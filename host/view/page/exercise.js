// An exercise for trainees: a knot to tie, and how it went: the knot's name, the time, the largest force, and how much
// thread was drawn through the knot.
import { C } from './frame.js';
import { showPanel } from './controls.js';
import { commonName } from './knot_panel.js';
import { exact, three } from './numbers.js';

const $ = (id) => document.getElementById(id);
const HELD_S = 0.5; // a knot counts when it has been named for this long
const AGAIN_TICKS = 5000; // the newest ticks are read again, because a slow page gets some of them late

/** The knots to choose from; handedness null: either. */
export const TARGETS = [['3_1', null], ['4_1', null], ['3_1#3_1', 'amphichiral'], ['3_1#3_1', 'left'], ['3_1#5_1', 'mixed'], ['0_1', null]]
  .map(([type, handedness]) => ({ type, handedness, name: type === '0_1' ? 'no knot (untie)' : commonName(type, handedness) }));

export function isTarget(target, knot) {
  const isGranny = target.type === '3_1#3_1' && target.handedness === 'left'; // of either hand
  return knot?.type === target.type && (target.handedness === null || knot.handedness === target.handedness || (isGranny && knot.handedness === 'right'));
}

/** Length of the thread beyond the knot, m, at its shorter end: what was drawn through. null without a knot. */
export function drawnThrough(shape, knot) {
  if (!knot?.core || !shape) return null;
  const p = shape.p_W, n = p.length / 3, [first, last] = knot.core;
  const length = (from, to) => { let sum = 0; for (let i = from; i < Math.min(to, n - 1); ++i) sum += Math.hypot(p[3 * i + 3] - p[3 * i], p[3 * i + 4] - p[3 * i + 1], p[3 * i + 5] - p[3 * i + 2]); return sum; };
  return Math.min(length(0, first), length(last, n - 1));
}

/** One attempt, from the tick at which it began. */
export class Attempt {
  constructor(target, tick) { Object.assign(this, { target, begun: tick, read: tick, peak_N: [0, 0], since: null, done: null }); }

  /** @param latest {now, knot, shape}. @returns whether the attempt has just succeeded. */
  take(store, latest, period_s) {
    if (!this.done && store.lastTick > this.begun) {
      const from = Math.max(this.begun, this.read - AGAIN_TICKS) + 1, end = store.lastTick + 1;
      const [, ...forces] = store.series(from, end, 1, [C.left, C.right]);
      this.peak_N = this.peak_N.map((peak, hand) => Math.max(peak, ...forces[hand]));
      this.read = end - 1;
    }
    const { knot } = latest;
    if (!knot || knot.tick <= this.begun || this.done) return false;
    if (!isTarget(this.target, knot)) { this.since = null; return false; }
    this.since ??= knot.tick;
    if ((knot.tick - this.since) * period_s < HELD_S) return false;
    this.done = { knot: `${knot.type} ${knot.handedness}`, time_s: (this.since - this.begun) * period_s, drawn_m: drawnThrough(latest.shape, knot) };
    return true;
  }

  /** What is known so far, as shown. @param digits three or exact. */
  describe(tick, period_s, digits) {
    const time_s = this.done?.time_s ?? (Math.max(this.read, tick) - this.begun) * period_s;
    const drawn = this.done && this.done.drawn_m !== null ? ` · drawn through ${digits(1000 * this.done.drawn_m)} mm` : '';
    return `${this.target.name}: ${this.done ? `tied, ${this.done.knot}` : 'not yet'} · ${digits(time_s)} s · peak force left ${digits(this.peak_N[0])} N, right ${digits(this.peak_N[1])} N${drawn}`;
  }
}

export class Exercise {
  /** @param signal ends the listeners. */
  constructor(panels, signal) {
    this.panels = panels;
    this.attempt = null;
    this.count = 0;
    $('target').replaceChildren(...TARGETS.map(({ name }, i) => new Option(name, i)));
    const toggle = (on) => showPanel('exercise', on);
    $('exercise-open').addEventListener('click', () => toggle($('exercise').hidden), { signal });
    $('exercise-close').addEventListener('click', () => toggle(false), { signal });
    $('exercise-begin').addEventListener('click', () => this.begin(), { signal });
  }

  dispose() { $('exercise').hidden = true; }

  begin() {
    const { tick } = this.panels.latest.now ?? {};
    if (tick === undefined) return;
    this.attempt = new Attempt(TARGETS[Number($('target').value)], tick);
    this.line = $('scores').appendChild(document.createElement('li'));
    ++this.count;
  }

  /** Ticks of another run are no continuation of the attempt. */
  forget() { this.attempt = null; }

  show() {
    if (!this.attempt || this.attempt.done) return;
    const { store, latest, period_s } = this.panels;
    this.attempt.take(store, latest, period_s);
    const tick = latest.now?.tick ?? 0;
    this.line.textContent = this.attempt.describe(tick, period_s, three);
    this.line.dataset.exact = this.attempt.describe(tick, period_s, exact);
    this.line.dataset.done = Boolean(this.attempt.done);
    this.line.scrollIntoView?.({ block: 'nearest' });
  }
}
