// Plots of forces and timing over time (uPlot).
import uPlot from './uPlot.esm.js';
import { C } from './frame.js';
import { stateName } from './names.js';
import { axisLabels, describeTime, labelRoom } from './times.js';
import { BESIDE, wholeRun } from './whole_run.js';

/**
 * Choices for the third plot: two columns, their names and SI unit, the factor to the displayed unit, and the smallest
 * height of the axis.
 */
export const THIRD = {
  'tick time': { names: ['whole', 'control'], si: 'ns', columns: [C.execution_ns, C.control_ns], factor: 1e-3, unit: 'µs: whole, control only', least: 100, isTime: true },
  'thread time': { names: ['done', 'loop'], si: 'ns', columns: [C.threadDone_ns, C.execution_ns], factor: 1e-3, unit: 'µs after the wake-up: thread done, loop done', least: 100, isTime: true },
  'time lost': { names: ['share'], si: '', columns: [C.timeLost, C.timeLost], factor: 100, unit: '% of a tick in which the thread stood still', least: 1 },
  tension: { names: ['left', 'right'], si: 'N', columns: [C.leftWorld, C.rightWorld], factor: 1, unit: 'N, of the thread at the left hand; grey right', least: 1 },
  passivity: { names: ['left', 'right'], si: 'J', columns: [C.leftPort_J, C.rightPort_J], factor: 1000, unit: 'mJ, account of the device port: left; grey right', least: 1 },
  'taken out': { names: ['left', 'right'], si: 'J', columns: [C.leftDissipated_J, C.rightDissipated_J], factor: 1000, unit: 'mJ, by the passivity controller: left; grey right', least: 1 },
  'bus load': { names: ['left', 'right'], si: '', columns: [C.leftBusLoad, C.rightBusLoad], factor: 100, unit: '% of a period: left; grey right', least: 100 },
  'motor heat': { names: ['left', 'right'], si: '', columns: [C.leftHeat, C.rightHeat], factor: 100, unit: '% of the continuous limit: left; grey right', least: 100 },
  energy: { names: ['potential', 'kinetic'], si: 'J', columns: [C.potential_J, C.kinetic_J], factor: 1, unit: 'J: potential, kinetic', least: 1e-3 },
  stretch: { names: ['longest edge'], si: '', columns: [C.maxStretch, C.maxStretch], factor: 100, unit: '%, of the longest edge', least: 0.1 },
  gap: { names: ['smallest'], si: 'm', columns: [C.minGap_m, C.minGap_m], factor: 1000, unit: 'mm, smallest of the thread with itself; below zero: overlap', least: 1 },
  propagation: { names: ['left', 'right'], si: '', columns: [C.leftPropagation, C.rightPropagation], factor: 1, unit: 'condition of the paper: 1 A, 2 B, 3 C; left; grey right', least: 3.2 },
  contacts: { names: ['in action'], si: '', columns: [C.contacts, C.contacts], factor: 1, unit: 'number in action', least: 4 },
};
const FORCES = [C.left, C.leftX, C.leftY, C.leftZ, C.right, C.rightX, C.rightY, C.rightZ];
const FAR = 1e8; // gaps above 1e8 m are not drawn: 1e9 m means that nothing is near
const FLAG = { lost: 1, missed: 2, limited: [16, 32], full: 64 };
const AXIS = { x: '#ff9d7a', y: '#7fd1ae', z: '#b9a5ff' };
const GREY = '#9aa6b6', VALUES_PX = 50; // VALUES_PX: width of the axis of values

export class Traces {
  /**
   * Offers the choices of THIRD in the page's list. @param beside trace store of the second recording.
   * @param choice {window_s, third, components}. @param onCursor called with the row under the cursor, or null.
   * @param signal aborted when the traces are no longer wanted, also if this constructor throws.
   */
  constructor(host, store, beside, choice, onCursor, signal) {
    const { window_s, third } = choice;
    Object.assign(this, { host, store, onCursor, window_s, period_s: 1e-3, limit_N: null, end: null, third: { title: third, ...THIRD[third] } });
    this.forceRange = [0, 0.1];
    this.position_s = null; // where the recording is, on a plot of all of it
    this.beside = { store: beside, offset_ticks: null, name: '' };
    this.plots = [];
    this.signal = signal;
    this.plots.push(this.#plot('left force', 'N', [0, 1, 2, 3], '#56b4e9', 0));
    this.plots.push(this.#plot('right force', 'N', [4, 5, 6, 7], '#e69f00', 1));
    this.plots.push(this.#plot(third, this.third.unit, [8, 9], '#e8ecf2', null));
    this.showComponents(choice.components);
    const resizes = new ResizeObserver(() => this.resize());
    signal.addEventListener('abort', () => resizes.disconnect());
    resizes.observe(host);
    this.resize();
    const list = document.getElementById('third');
    list.replaceChildren(...Object.keys(THIRD).map((name) => new Option(name, name)));
    list.value = third;
  }

  #box(title, unit) {
    const box = document.createElement('div');
    box.className = 'plot';
    box.innerHTML = `<h2>${title} <em>${unit}</em></h2>`;
    this.host.append(box);
    this.signal.addEventListener('abort', () => box.remove());
    return box;
  }

  #plot(title, unit, columns, colour, hand) {
    const box = this.#box(title, unit);
    const names = ['|F|', 'x', 'y', 'z'];
    const series = [{}, ...columns.map((_, i) => ({
      stroke: i === 0 ? colour : hand === null ? GREY : AXIS[names[i]], width: i === 0 ? 1.6 : 1,
      dash: hand !== null && i ? [[], [6, 3], [2, 2], [8, 2, 2, 2]][i] : undefined, points: { show: false },
    })), { stroke: '#ff9ad5', width: 1.3, dash: [6, 4], points: { show: false }, show: false }]; // the second recording
    const axis = { stroke: GREY, grid: { stroke: '#2b3441', width: 1 }, ticks: { stroke: '#2b3441', size: 4 }, font: '11px sans-serif' };
    const plot = new uPlot({
      width: 400, height: 150, series, legend: { show: false }, padding: [8, 8, 0, 0],
      cursor: { sync: { key: 'ligature' }, drag: { x: false, y: false }, points: { size: 6 } },
      scales: { x: { time: false, auto: false }, y: { range: (_, low, high) => (hand === null ? niceRange(low, high, this.third.least) : this.forceRange) } },
      axes: [{ ...axis, size: 24, values: (u, marks) => axisLabels(marks, (t) => u.width - u.valToPos(t, 'x') - VALUES_PX), space: () => labelRoom(this.end_s ?? 0, (this.shown_s ?? 10) / 10) }, { ...axis, size: VALUES_PX, space: 18 }],
      hooks: {
        draw: [(u) => this.#drawMarks(u, hand)],
        setCursor: [(u) => { if (u === this.pointed) this.#readCursor(u); }],
      },
    }, series.map(() => [0]), box);
    this.signal.addEventListener('abort', () => plot.destroy());
    plot.over.addEventListener('pointerenter', () => { this.pointed = plot; });
    plot.over.addEventListener('pointerleave', () => { this.pointed = null; this.onCursor(null); });
    return { plot, columns, hand, box, title };
  }

  #readCursor(u) {
    const t_s = u.cursor.left >= 0 ? u.posToVal(u.cursor.left, 'x') : null;
    this.onCursor(t_s === null ? null : this.store.nearest(Math.round(t_s / this.period_s)));
  }

  /** Draws marks of limits, deadline misses and faults, and the force limit as a line. */
  #drawMarks(u, hand) {
    const { ctx, bbox } = u, flags = this.data?.[11], faults = this.data?.[12], degraded = this.data?.[13], x = this.data?.[0];
    if (!x) return;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = '#ff5c4740';
    for (let i = 0; i < x.length; ++i) { // consecutive ticks with a fault form one band
      if (!faults[i]) continue;
      const first = i;
      while (i + 1 < x.length && (faults[i + 1] || faults[i + 1] === undefined)) ++i; // undefined: only the second recording has this x
      const from = u.valToPos(x[first], 'x', true), until = u.valToPos(x[i], 'x', true);
      ctx.fillRect(from, bbox.top, Math.max(2, until - from), bbox.height);
    }
    for (let i = 0; i < x.length; ++i) {
      if (hand === null && (degraded[i] || flags[i] & FLAG.full)) { // the solver gave up accuracy
        ctx.fillStyle = '#f0e442';
        ctx.fillRect(u.valToPos(x[i], 'x', true) - 1, bbox.top + bbox.height - 6, 2, 6);
      }
      if (!flags[i]) continue;
      const at = u.valToPos(x[i], 'x', true);
      if (hand === null && flags[i] & (FLAG.lost | FLAG.missed)) triangle(ctx, at, bbox.top + 1, '#ff5c47', 6);
      if (hand !== null && flags[i] & FLAG.limited[hand]) triangle(ctx, at, bbox.top + 1, '#f0e442', 5);
    }
    if (this.position_s !== null) {
      ctx.fillStyle = '#e8ecf2';
      ctx.fillRect(u.valToPos(this.position_s, 'x', true) - 1, bbox.top, 2, bbox.height);
    }
    const level = hand !== null ? this.limit_N : this.third.isTime ? this.period_s * 1e6 : null;
    const y = level ? u.valToPos(level, 'y', true) : -1;
    if (y > bbox.top && y < bbox.top + bbox.height) {
      ctx.strokeStyle = '#f0e44299';
      ctx.setLineDash([5, 5]);
      ctx.beginPath(); ctx.moveTo(bbox.left, y); ctx.lineTo(bbox.left + bbox.width, y); ctx.stroke();
    }
    ctx.restore();
  }

  resize() {
    for (const { plot, box } of this.plots) plot.setSize({ width: Math.max(200, box.clientWidth), height: Math.max(70, box.clientHeight) });
  }

  showComponents(on) {
    for (const { plot, columns, hand } of this.plots)
      if (hand !== null) for (let i = 1; i < columns.length; ++i) plot.setSeries(i + 1, { show: on });
  }

  showThird(name) {
    this.third = { title: name, ...THIRD[name] };
    this.plots[2].title = name;
    this.#writeTitles();
  }

  /** Topic 'compare': which recording is compared with this one, and the offset in ticks. */
  compareWith({ file, offset_ticks }) {
    Object.assign(this.beside, { name: file, offset_ticks: file ? offset_ticks : null });
    for (const { plot } of this.plots) plot.setSeries(plot.series.length - 1, { show: this.isComparing });
    this.#writeTitles();
  }

  get isComparing() { return this.beside?.offset_ticks != null; }

  /** Row of the second recording that corresponds to this row, or null. */
  besideRow(row) {
    const wanted = row && this.isComparing ? row[C.tick] - this.beside.offset_ticks : null;
    const found = wanted === null ? null : this.beside.store.nearest(wanted);
    return found?.[C.tick] === wanted ? found : null;
  }

  #writeTitles() {
    for (const { box, title, hand } of this.plots) {
      const heading = box.querySelector('h2');
      heading.innerHTML = `${title} <em>${hand === null ? this.third.unit : 'N'}</em>`;
      if (this.isComparing) heading.querySelector('em').append(` – dashed: ${this.beside.name}`);
    }
  }

  /** Stops the traces at this moment, or lets them run. */
  pause(on) { this.end = on ? this.store.lastTick : null; }
  get isPaused() { return this.end !== null; }

  /**
   * The plots' data: x, this recording's columns, the columns for marks, and from index BESIDE on the second
   * recording's columns: |F| left, |F| right, and the first column of the third plot.
   */
  #series(from, end, pixels) {
    const own = this.store.series(from, end, pixels, [...FORCES, ...this.third.columns, C.flags, C.fault, C.degradation]);
    if (!this.isComparing) return [...own, ...[0, 1, 2].map(() => new Array(own[0].length).fill(null))];
    const by = this.beside.offset_ticks;
    const other = this.beside.store.series(from - by, end - by, pixels, [C.left, C.right, this.third.columns[0]]);
    other[0] = Array.from(other[0], (tick) => tick + by);
    const isSameGrid = other[0].length === own[0].length && other[0].every((x, i) => Math.abs(x - own[0][i]) < 1e-3);
    return isSameGrid ? [...own, ...other.slice(1)] : uPlot.join([own, other]);
  }

  /** One vertical scale for both hands, so that equal forces have equal heights. */
  #commonRange(data) {
    let low = 0, high = 0;
    for (const { plot, columns, hand } of this.plots) {
      if (hand === null) continue;
      const seen = [...columns.map((c) => c + 1), BESIDE + hand].filter((_, i) => plot.series[i + 1].show);
      for (const k of seen) for (const v of data[k]) { if (v < low) low = v; if (v > high) high = v; }
    }
    return niceRange(low, high, 0.1);
  }

  /** The data of the chosen window up to tick `end`, times in s and the third plot in its unit. */
  #window(end) {
    const from = end - (this.window_s === 'run' ? 10 : this.window_s) / this.period_s;
    const data = this.#series(from, end, this.plots[0].plot.bbox.width / devicePixelRatio);
    data[0] = Array.from(data[0], (tick) => tick * this.period_s);
    for (const k of [9, 10, BESIDE + 2]) data[k] = Array.from(data[k], (v) => (v == null || v > FAR && !this.third.isTime ? v === undefined ? v : null : v * this.third.factor));
    return { data, from_s: from * this.period_s, end_s: end * this.period_s };
  }

  draw() {
    const end = (this.end ?? this.store.lastTick ?? 0) + 1, now_s = (end - 1) * this.period_s;
    const whole = this.window_s === 'run' ? wholeRun(this.marks, this.replay, now_s) : null, { data, from_s, end_s } = whole ?? this.#window(end);
    Object.assign(this, { data, end_s, shown_s: end_s - from_s, position_s: whole ? now_s : null });
    this.forceRange = this.#commonRange(data);
    for (const [i, { plot, columns }] of this.plots.entries()) {
      plot.batch(() => {
        plot.setData([data[0], ...columns.map((c) => data[c + 1]), data[BESIDE + i]], false);
        plot.setScale('x', { min: from_s, max: end_s });
      });
      if (plot === this.pointed) this.#readCursor(plot);
    }
    this.histogramFrom = Math.max(from_s / this.period_s, end - 60 / this.period_s);
  }
}

function triangle(ctx, x, y, colour, size) {
  ctx.fillStyle = colour;
  ctx.beginPath(); ctx.moveTo(x - size, y); ctx.lineTo(x + size, y); ctx.lineTo(x, y + 1.6 * size); ctx.fill();
}

function niceRange(low, high, least) {
  const top = Math.max(least, (high ?? 0) * 1.12), bottom = (low ?? 0) < 0 ? low * 1.12 : 0;
  return [bottom, top];
}

/**
 * The values of a tick in SI units. @param digits `three` for the page or `exact` for a copy, which is identical to the
 * exported values (numbers.js).
 */
export function describeRow(row, period_s, third, other, digits) {
  if (!row) return '';
  const beside = other ? ` · other: left ${digits(other[C.left])} N, right ${digits(other[C.right])} N` : '';
  const fault = row[C.fault] ? ` fault ${row[C.fault]}` : '';
  const more = third.names.map((name, i) => `${name} ${digits(row[third.columns[i]])}${third.si && ` ${third.si}`}`).join(', ');
  return `${describeTime(row[C.tick], period_s)} · left ${digits(row[C.left])} N · right ${digits(row[C.right])} N · `
    + `tick ${row[C.tick]} ${stateName(row[C.state])}${fault} · ${third.title}: ${more}${beside}`;
}
