// Unit tests of the page's trace store and frame reader.
import assert from 'node:assert/strict';
import test from 'node:test';
import { BIN_NUMBER_PART, C, TICKS_PER_BIN, WIDTH, readFrame } from '../../host/view/page/frame.js';
import { TraceStore } from '../../host/view/page/trace_store.js';
import { axisLabels, describeTime, labelRoom } from '../../host/view/page/times.js';
import { judgeAge } from '../../host/view/page/state_panel.js';
import { colourThread, scaleEnd } from '../../host/view/page/colouring.js';
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
  assert.ok(store.series(0, 300, 400, [C.left])[1].includes(null)); // one point per tick; null: ticks 100 to 199
  assert.ok(store.series(0, 300, 30, [C.left])[1].includes(null)); // ten ticks per point
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

// Tick numbers after a year at 1 kHz, and near the limits of 31 and 32 bits.
for (const start of [31_536_000_000, 2 ** 31 - 100, 2 ** 32 - 100]) {
  test(`ticks are exact from ${start} on`, () => {
    const store = new TraceStore(), first = Math.floor(start / TICKS_PER_BIN);
    const bins = new Float32Array(4 * 2 * WIDTH);
    for (let i = 0; i < 4; ++i) {
      bins[2 * i * WIDTH] = (first + i) % BIN_NUMBER_PART;
      bins[(2 * i + 1) * WIDTH] = Math.floor((first + i) / BIN_NUMBER_PART);
      bins[(2 * i + 1) * WIDTH + C.left] = i;
    }
    store.addBins(bins);
    for (let i = 0; i < 4; ++i) assert.equal(store.tickOfBin(i), (first + i) * TICKS_PER_BIN);
    const from = (first + 4) * TICKS_PER_BIN;
    store.addRows(rows(from, 500, (tick) => (tick === from + 77 ? 7 : 1)));
    assert.equal(store.nearest(from + 77.4)[C.left], 7);
    assert.equal(store.lastTick, from + 499);
    const [x, left] = store.series(from, from + 500, 500, [C.left]);
    assert.equal(x[left.indexOf(7)], from + 77);
    const [wideX, wide] = store.series(first * TICKS_PER_BIN, from + 500, 70, [C.left]); // ten ticks per point
    assert.ok(Math.abs(wideX[wide.indexOf(7)] - (from + 77)) <= 10);
    assert.ok(Math.abs(wideX[wide.indexOf(3)] - (first + 3) * TICKS_PER_BIN) <= 10);
    assert.equal(store.histogram(C.wakeup_ns, [1], from + 100).counts[0], 400);
    assert.match(describeTime(from + 77, 1e-3), new RegExp(`^t ${Math.floor((from + 77) / 1000)}\\.${String((from + 77) % 1000).padStart(3, '0')} s`));
  });
}

test('rows and bins are found after more than 2^31 of them', () => {
  const store = new TraceStore();
  for (const count of [2 ** 30, 2 ** 31 - 50, 2 ** 32 - 50]) {
    store.rowEnd = count - 60_000;
    for (let i = 0; i < 60; ++i) store.addRows(rows(count + 1000 * i, 1000));
    assert.equal(store.nearest(count + 12_345)[0], count + 12_345);
  }
});

test('labels of a time axis differ, have their unit, and have room', () => {
  for (const [end_s, step_s] of [[12, 1], [10, 0.1], [31_536_000, 2], [31_536_000, 0.1], [4_294_967, 0.01]]) {
    const labels = axisLabels([0, 1, 2, 3].map((i) => end_s + i * step_s));
    assert.equal(new Set(labels).size, 4, labels.join());
    labels.forEach((label, i) => assert.ok(Math.abs(parseFloat(label) - (end_s + i * step_s)) < 1e-6, label));
    assert.match(labels[3], / s$/);
    assert.ok(labelRoom(end_s, step_s) >= 6 * labels[2].length);
  }
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
  assert.equal(commonName('3_1#5_1', 'mixed'), "surgeon's");
  assert.equal(commonName('4_1', 'amphichiral'), 'figure-eight');
  assert.equal(commonName('7_4', 'right'), '');
});

test('a slow computer is told apart from a silent rig and a silent host', () => {
  const live = { isReplay: false };
  assert.deepEqual(judgeAge(30, 0, 5, live), { text: '', isOld: false, isSlow: false });
  for (const age_ms of [130, 250, 400]) { // ages of the data on a page that draws two to four pictures per second
    assert.equal(judgeAge(age_ms, 0, 5, live).isOld, true); // the page's own lag is 5 ms, so the data come late
    const slow = judgeAge(age_ms, 0, 400, live);
    assert.deepEqual([slow.isOld, slow.isSlow], [false, true]);
  }
  // Whatever the page's own lag, data or host messages older than a second are reported.
  for (const lag_ms of [0, 400, 5000, 1e9]) {
    assert.match(judgeAge(1200, 0, lag_ms, live).text, lag_ms < 1000 ? /^Old picture/ : /Old picture/);
    assert.match(judgeAge(30, 1200, lag_ms, live).text, /^No word from the host/);
  }
  assert.equal(judgeAge(-1, 0, 400, live).isOld, true);
});

test('the scale of curvature fits the thread: it is not painted in one colour', () => {
  // A suture of radius 0.15 mm, in a bow whose curvature increases.
  const n = 100, p_W = new Float32Array(3 * n), bent = 0.15e-3;
  for (let i = 0, angle = 0, x = 0, z = 0; i < n; ++i) {
    p_W.set([x, 0, z], 3 * i);
    x += 2e-3 * Math.cos(angle); z += 2e-3 * Math.sin(angle); angle += 0.001 * i;
  }
  const shape = { p_W, radius_m: bent, grasped: [-1, -1], tension_N: new Float32Array(n), turn_rad: new Float32Array(n) };
  const { colours, legend } = colourThread('curvature', shape);
  assert.ok(Math.max(...colours) - Math.min(...colours) > 0.5, `${Math.min(...colours)} .. ${Math.max(...colours)}`);
  assert.equal(legend.high, '50.0 1/m');
  for (const [largest, most, end] of [[49, 3333, 50], [51, 3333, 100], [101, 3333, 200], [3000, 3333, 3333], [0, 3333, 5]])
    assert.equal(scaleEnd(largest, most), end);
});
