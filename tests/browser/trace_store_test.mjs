// Unit tests of the page's trace store and frame reader.
import assert from 'node:assert/strict';
import test from 'node:test';
import { BIN_NUMBER_PART, C, TICKS_PER_BIN, WIDTH, readFrame } from '../../host/view/page/frame.js';
import { TraceStore } from '../../host/view/page/trace_store.js';
import { axisLabels, describeTime, labelRoom } from '../../host/view/page/times.js';
import { judgeAge } from '../../host/view/page/state_panel.js';
import { colourThread, scaleEnd } from '../../host/view/page/colouring.js';
import { commonName, tightness, withKnotName } from '../../host/view/page/knot_panel.js';
import { Attempt, drawnThrough, isTarget } from '../../host/view/page/exercise.js';
import { exact, three } from '../../host/view/page/numbers.js';
import { roundLength } from '../../host/view/page/round_length.js';

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

test('bins that are wider than a cell leave no stripes', () => {
  const store = new TraceStore(), bins = new Float32Array(20 * 2 * WIDTH);
  for (let i = 0; i < 20; ++i) { bins[2 * i * WIDTH] = i; bins[2 * i * WIDTH + C.left] = bins[(2 * i + 1) * WIDTH + C.left] = i; }
  store.addBins(bins);
  const [x, left] = store.series(0, 1000, 100, [C.left]); // ten ticks per cell, 50 per bin
  assert.ok(!left.includes(null), left.join());
  left.forEach((v, i) => assert.equal(v, Math.floor(x[i] / TICKS_PER_BIN)));
});

test('a spike in ticks that a slow page did not get is drawn from its bin, at every width', () => {
  const store = new TraceStore(), bins = new Float32Array(6 * 2 * WIDTH);
  for (let i = 0; i < 6; ++i) { bins[2 * i * WIDTH] = i; bins[(2 * i + 1) * WIDTH + C.left] = i === 2 ? 9 : 1; }
  store.addRows(rows(0, 100, () => 1));
  store.addRows(rows(150, 150, () => 1)); // not 100 .. 149
  store.addBins(bins);
  for (const pixels of [1, 10, 100, 1000]) assert.equal(Math.max(...store.series(0, 300, pixels, [C.left])[1]), 9, `${pixels} pixels`);
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

test('a label of a time axis that would be cut off is left out', () => {
  assert.deepEqual(axisLabels([339.4, 339.6, 339.8, 340], (t) => 300 * (340.01 - t)), ['339.4', '339.6', '339.8 s', null]);
  assert.deepEqual(axisLabels([1, 2], () => 50), ['1', '2 s']);
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

test('tightness is that of the throws, and events name their knot', () => {
  assert.equal(tightness({ core_diameters: 400, throws: [{ diameters: 31.2 }, { diameters: 94.6 }] }), 'tightness: 31 and 95 diameters of thread');
  assert.equal(tightness({}), '');
  assert.equal(withKnotName('knot 3_1#3_1 amphichiral'), 'knot 3_1#3_1 amphichiral, square (reef)');
  assert.equal(withKnotName('left grasps node 7'), 'left grasps node 7');
});

test('an exercise: the target, the largest force, the time and the thread drawn through', () => {
  const store = new TraceStore(), shape = { p_W: Float32Array.from({ length: 150 }, (_, i) => (i % 3 ? 0 : i / 3 * 1e-3)) };
  const knot = (type, handedness, tick) => ({ type, handedness, tick, core: [10, 20] });
  assert.ok(isTarget({ type: '3_1#3_1', handedness: 'left' }, knot('3_1#3_1', 'right', 0)), 'a granny of the other hand');
  assert.ok(!isTarget({ type: '3_1#3_1', handedness: 'amphichiral' }, knot('3_1#3_1', 'right', 0)));
  assert.ok(Math.abs(drawnThrough(shape, knot('3_1', 'left', 0)) - 0.01) < 1e-6);
  const attempt = new Attempt({ type: '3_1', handedness: null, name: 'overhand' }, 99);
  store.addRows(rows(0, 5000, (tick) => (tick === 50 ? 9 : tick === 4321 ? 2.5 : 1))); // the first peak is before the attempt
  const after = (k) => attempt.take(store, { knot: k, shape }, 1e-3);
  assert.ok(!after(knot('3_1', 'left', 2000)) && !after(knot('0_1', 'none', 2300)) && !after(knot('3_1', 'left', 3099)), 'named too shortly');
  assert.ok(!after(knot('3_1', 'left', 3400)) && after(knot('3_1', 'left', 3700)));
  assert.equal(attempt.describe(5000, 1e-3, three), 'overhand: tied, 3_1 left · 3.00 s · peak force left 2.50 N, right 0 N · drawn through 10.0 mm');
});

test('numbers have three digits, and exact ones read back as the same', () => {
  for (const [value, text] of [[0, '0'], [0.0140001, '0.0140'], [1.0368, '1.04'], [1234.5, '1235'], [-3.3333, '-3.33'], [1e-9, '1.00e-9']]) assert.equal(three(value), text);
  for (const value of [1 / 3, 1e-300, -0]) assert.ok(Object.is(Number(exact(value)), value));
});

test('scale bars have round lengths', () => {
  for (const [most, text] of [[0.0031, '2 mm'], [0.05, '50 mm'], [7, '5 m'], [0.9e-3, '500 µm'], [1e-3, '1 mm']]) {
    const bar = roundLength(most);
    assert.equal(bar.text, text);
    assert.ok(bar.length_m <= most * 1.0001 && bar.length_m > most / 2.51);
  }
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

/** A thread of n nodes along x; the lengths of its segments alternate between 1 mm and 3 mm. */
function unequal(n) {
  const p_W = new Float32Array(3 * n), at = [0];
  for (let i = 1; i < n; ++i) at.push(at[i - 1] + (i % 2 ? 1e-3 : 3e-3));
  at.forEach((x, i) => { p_W[3 * i] = x; });
  return { p_W, at, radius_m: 0.15e-3, grasped: [-1, -1], tension_N: new Float32Array(n), turn_rad: new Float32Array(n) };
}
const ofNode = ({ colours }, i) => [...colours.subarray(3 * i, 3 * i + 3)];

test('stretch of unequal segments is that of the force in them, and its scale fits', () => {
  const shape = unequal(40), facts = { length_m: 0.08, equal_segments: false, EA_N: 71 };
  const even = colourThread('stretch', { ...shape, tension_N: new Float32Array(40).fill(0.71) }, facts);
  for (let i = 1; i < 40; ++i) assert.deepEqual(ofNode(even, i), ofNode(even, 0)); // one strain, one colour
  assert.deepEqual([even.legend.low, even.legend.high], ['−1.00 %', '+1.00 %']);
  const rising = colourThread('stretch', { ...shape, tension_N: Float32Array.from({ length: 40 }, (_, i) => i * 1e-3) }, facts);
  assert.ok(Math.max(...rising.colours) - Math.min(...rising.colours) > 0.3);
  assert.equal(rising.legend.high, '+0.100 %');
  assert.match(colourThread('stretch', shape, { ...facts, EA_N: null }).legend.title, /not known/);
});

test('stretch of equal segments is their length over that at rest', () => {
  const n = 21, p_W = new Float32Array(3 * n);
  for (let i = 0; i < n; ++i) p_W[3 * i] = 0.1 * i * (1 + 0.001 * i);
  const { legend } = colourThread('stretch', { ...unequal(n), p_W }, { length_m: 2, equal_segments: true, EA_N: null });
  assert.equal(legend.high, '+5.00 %'); // the last segment: 0.1 * (20 + 0.4 - 19 - 0.361) / 0.1 - 1 = 3.9 %
});

test('an even twist has one colour on unequal segments', () => {
  const shape = unequal(40), turn_rad = Float32Array.from(shape.at, (x) => 19 * x);
  const { colours, legend } = colourThread('twist', { ...shape, turn_rad });
  for (let i = 1; i < 40; ++i) ofNode({ colours }, i).forEach((v, j) => assert.ok(Math.abs(v - colours[j]) < 1e-3));
  assert.equal(legend.high, '+20.0 rad/m');
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
