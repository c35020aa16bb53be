// The page's trace memory and frame reader, as plain functions.
import assert from 'node:assert/strict';
import test from 'node:test';
import { C, TICKS_PER_BIN, WIDTH, readFrame } from '../../host/view/page/frame.js';
import { TraceStore } from '../../host/view/page/trace_store.js';
import { commonName } from '../../host/view/page/knot_panel.js';

function rows(first, count, value = () => 0) {
  const block = new Float64Array(count * WIDTH);
  for (let i = 0; i < count; ++i) { block[i * WIDTH] = first + i; block[i * WIDTH + C.left] = value(first + i); }
  return block;
}

test('a spike of one tick is in the series at every width', () => {
  const store = new TraceStore();
  store.addRows(rows(0, 30_000, (tick) => (tick === 12_345 ? 7 : 1)));
  for (const pixels of [3, 100, 999, 40_000]) {
    const [, left] = store.series(0, 30_000, pixels, [C.left]);
    assert.equal(Math.max(...left), 7);
    assert.equal(Math.min(...left.filter((v) => v !== null)), 1);
  }
});

test('a hole in the ticks is a hole in the line', () => {
  const store = new TraceStore();
  store.addRows(rows(0, 100));
  store.addRows(rows(200, 100));
  assert.ok(store.series(0, 300, 400, [C.left])[1].includes(null)); // as they are
  assert.ok(store.series(0, 300, 30, [C.left])[1].includes(null)); // thinned
});

test('bins stand in for ticks that are gone, and only for those', () => {
  const store = new TraceStore();
  const bins = new Float32Array(2 * 2 * WIDTH);
  [0, 1].forEach((number, i) => { bins[2 * i * WIDTH] = number; bins[(2 * i + 1) * WIDTH + C.left] = 9; });
  store.addBins(bins);
  store.addRows(rows(TICKS_PER_BIN, 50, () => 2));
  const [x, left] = store.series(0, 100, 10, [C.left]);
  assert.equal(Math.max(...left.filter((v, i) => v !== null && x[i] < 50)), 9);
  assert.equal(Math.max(...left.filter((_, i) => x[i] >= 50)), 2);
});

test('memory is fixed: the oldest go', () => {
  const store = new TraceStore();
  for (let i = 0; i < 70; ++i) store.addRows(rows(i * 1000, 1000));
  assert.equal(store.rowEnd - store.rowBegin, 60_000);
  assert.equal(store.tickOfRow(store.rowBegin), 10_000);
  assert.equal(store.nearest(33_333)[0], 33_333);
  assert.equal(store.nearest(5)[0], 10_000);
});

test('the histogram leaves lost periods out', () => {
  const store = new TraceStore();
  const block = rows(0, 3);
  [1000, 5000, 7_000_000].forEach((ns, i) => { block[i * WIDTH + C.wakeup_ns] = ns; });
  block[2 * WIDTH + C.flags] = 1;
  store.addRows(block);
  assert.deepEqual(store.histogram(C.wakeup_ns, [2000, 10_000], 0), { counts: [1, 1, 0], max: 5000 });
});

test('what is no frame is refused', () => {
  assert.throws(() => readFrame(new ArrayBuffer(4)));
  assert.throws(() => readFrame(new ArrayBuffer(64)));
  const cut = new DataView(new ArrayBuffer(24));
  cut.setUint32(0, 0x3146474c, true);
  cut.setUint32(8, 3, true);
  cut.setUint32(12, 800, true);
  assert.throws(() => readFrame(cut.buffer), /cut-off/);
});

test('knots have the names that people give them, in the words of the recogniser', () => {
  assert.equal(commonName('3_1#3_1', 'amphichiral'), 'square (reef)');
  assert.equal(commonName('3_1#3_1', 'left'), 'granny');
  assert.equal(commonName('4_1', 'amphichiral'), 'figure-eight');
  assert.equal(commonName('7_4', 'right'), '');
});
