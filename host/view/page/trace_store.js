// Data of the traces: every tick of the last minute, and for the last ten minutes bins of 50 ticks with their smallest
// and largest values. Memory is fixed.
import { BIN_NUMBER_PART, C, TICKS_PER_BIN, WIDTH } from './frame.js';

const ROWS = 60_000, BINS = 12_000;

export class TraceStore {
  constructor() {
    this.rows = new Float64Array(ROWS * WIDTH);
    this.bins = new Float32Array(BINS * 2 * WIDTH);
    this.clear();
  }

  clear() { this.rowEnd = 0; this.binEnd = 0; }

  addRows(block) {
    for (let at = 0; at < block.length; at += WIDTH)
      this.rows.set(block.subarray(at, at + WIDTH), (this.rowEnd++ % ROWS) * WIDTH);
  }

  addBins(block) {
    for (let at = 0; at < block.length; at += 2 * WIDTH)
      this.bins.set(block.subarray(at, at + 2 * WIDTH), (this.binEnd++ % BINS) * 2 * WIDTH);
  }

  get rowBegin() { return Math.max(0, this.rowEnd - ROWS); }
  get binBegin() { return Math.max(0, this.binEnd - BINS); }
  row(i) { const at = (i % ROWS) * WIDTH; return this.rows.subarray(at, at + WIDTH); }
  tickOfRow(i) { return this.rows[(i % ROWS) * WIDTH]; }
  /** A bin's number is sent as two floats (host/view/trace_row.hpp): a single float would be exact for 9 days only. */
  tickOfBin(i) { const at = (i % BINS) * 2 * WIDTH; return (this.bins[at] + this.bins[at + WIDTH] * BIN_NUMBER_PART) * TICKS_PER_BIN; }
  get lastTick() { return this.rowEnd > this.rowBegin ? this.tickOfRow(this.rowEnd - 1) : null; }

  /** First row whose tick is at least `tick`. */
  rowFrom(tick) { return lowerBound(this.rowBegin, this.rowEnd, (i) => this.tickOfRow(i) >= tick); }
  binFrom(tick) { return lowerBound(this.binBegin, this.binEnd, (i) => this.tickOfBin(i) >= tick); }

  /** The row of the tick nearest to `tick`, or null. */
  nearest(tick) {
    const i = this.rowFrom(tick);
    const close = [i - 1, i].filter((k) => k >= this.rowBegin && k < this.rowEnd);
    if (!close.length) return null;
    return this.row(close.reduce((a, b) => (Math.abs(this.tickOfRow(a) - tick) <= Math.abs(this.tickOfRow(b) - tick) ? a : b)));
  }

  /**
   * Reduces columns over ticks [from, to) to at most `pixels` cells, two points each: the smallest and the largest
   * value, so that a spike of one tick is never hidden. With fewer ticks than pixels the ticks themselves are returned.
   * Missing ticks become null, a gap in the line.
   * @returns [x in ticks, ...one array per column].
   */
  series(from, to, pixels, columns) {
    const first = this.rowFrom(from), last = this.rowFrom(to);
    const isWhole = first < last && last - first === this.tickOfRow(last - 1) - this.tickOfRow(first) + 1;
    if (to - from <= pixels && isWhole && this.tickOfRow(first) <= from + TICKS_PER_BIN) return this.#exact(first, last, columns);
    const cells = Math.max(1, Math.min(Math.floor(pixels), to - from));
    const low = columns.map(() => new Float64Array(cells).fill(Infinity));
    const high = columns.map(() => new Float64Array(cells).fill(-Infinity));
    const cellOf = (tick) => Math.min(cells - 1, Math.max(0, Math.floor(((tick - from) / (to - from)) * cells)));
    const put = (cell, at, lows, highs, highAt) => {
      for (let k = 0; k < columns.length; ++k) {
        const c = columns[k];
        if (lows[at + c] < low[k][cell]) low[k][cell] = lows[at + c];
        if (highs[highAt + c] > high[k][cell]) high[k][cell] = highs[highAt + c];
      }
    };
    for (let i = this.binFrom(from); i < this.binEnd && this.tickOfBin(i) < to; ++i) {
      const at = (i % BINS) * 2 * WIDTH, tick = this.tickOfBin(i), end = Math.min(tick + TICKS_PER_BIN, to);
      if (!this.#lacksRows(tick, end)) continue;
      for (let cell = cellOf(tick); cell <= cellOf(end - 1); ++cell) put(cell, at, this.bins, this.bins, at + WIDTH); // a bin may be wider than a cell
    }
    for (let i = first; i < last; ++i) {
      const at = (i % ROWS) * WIDTH;
      put(cellOf(this.tickOfRow(i)), at, this.rows, this.rows, at);
    }
    return assemble(from, to, cells, low, high);
  }

  /** Whether rows of these ticks are missing: too old, or skipped because this page is slow. */
  #lacksRows(from, to) {
    const first = this.rowFrom(from);
    return first >= this.rowEnd || this.tickOfRow(first) !== from || this.rowFrom(to) - first < to - from;
  }

  #exact(first, last, columns) {
    const out = [[], ...columns.map(() => [])];
    for (let i = first; i < last; ++i) {
      const tick = this.tickOfRow(i);
      if (i > first && tick > this.tickOfRow(i - 1) + 1) {
        out[0].push(tick - 0.5);
        for (let k = 1; k < out.length; ++k) out[k].push(null);
      }
      out[0].push(tick);
      const row = this.row(i);
      columns.forEach((c, k) => out[k + 1].push(row[c]));
    }
    return out;
  }

  /** Counts a column's values in each interval between `bounds`, for ticks from `from` on; skips lost periods. */
  histogram(column, bounds, from) {
    const counts = new Array(bounds.length + 1).fill(0);
    let max = 0;
    for (let i = this.rowFrom(from); i < this.rowEnd; ++i) {
      const row = this.row(i);
      if (row[C.flags] & 1) continue;
      const value = row[column];
      if (value > max) max = value;
      let k = 0;
      while (k < bounds.length && value >= bounds[k]) ++k;
      ++counts[k];
    }
    return { counts, max };
  }
}

function assemble(from, to, cells, low, high) {
  const x = new Array(2 * cells), out = [x, ...low.map(() => new Array(2 * cells))];
  const step = (to - from) / cells;
  for (let cell = 0; cell < cells; ++cell) {
    x[2 * cell] = from + (cell + 0.25) * step;
    x[2 * cell + 1] = from + (cell + 0.75) * step;
    for (let k = 0; k < low.length; ++k) {
      const empty = low[k][cell] === Infinity;
      out[k + 1][2 * cell] = empty ? null : low[k][cell];
      out[k + 1][2 * cell + 1] = empty ? null : high[k][cell];
    }
  }
  return out;
}

function lowerBound(begin, end, isEnough) {
  while (begin < end) {
    const middle = Math.floor((begin + end) / 2); // a shift would be limited to 32 bits
    if (isEnough(middle)) end = middle; else begin = middle + 1;
  }
  return begin;
}
