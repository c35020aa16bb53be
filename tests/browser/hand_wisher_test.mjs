// Tests of the wishes that the page's worker sends, on a clock of the test. Run by `node --test`.
import assert from 'node:assert/strict';
import test from 'node:test';
import { HandWisher, PAGE_SILENT_MS } from '../../host/view/page/hand_wisher.js';

const SCALE = 20, PAGE = 7;

function taken() {
  const wisher = new HandWisher();
  wisher.hear(told([0, 0, 0]));
  wisher.take('left', { page: PAGE, p_W: [0, 0, 0], grip: false }, 0);
  return wisher;
}

function told(p_W, page = PAGE, scale = SCALE) { return { scale, left: { page, p_W }, right: { page: 0 } }; }
function held({ velocity = [0, 0, 0], dead = false, grip = false, isDragged = false }) { return { left: { velocity, dead, grip, isDragged } }; }

test('a hand moves at its pace for as long as the key is down', () => {
  const wisher = taken();
  wisher.obey(held({ velocity: [0.01, 0, 0] }), 0);
  for (let t = 20; t <= 500; t += 20) { wisher.hear(told([0.01 * SCALE * t / 1000, 0, 0])); wisher.wish(t); }
  wisher.obey(held({}), 500);
  assert.ok(Math.abs(wisher.wish(900).left.p[0] - 0.01 * SCALE * 0.5) < 1e-12);
});

test('a slow picture does not release the dead-man, and does not stop the hand', () => {
  const wisher = taken();
  wisher.obey(held({ velocity: [0.01, 0, 0], dead: true }), 0);
  for (let t = 20; t <= PAGE_SILENT_MS; t += 20) assert.equal(wisher.wish(t).left.dead, true, `${t} ms`);
  assert.ok(wisher.wish(PAGE_SILENT_MS).left.p[0] > 0.19);
});

test('a page that has failed lets go and stands still, until the dead-man is pressed anew', () => {
  const wisher = taken();
  wisher.obey(held({ velocity: [0.01, 0, 0], dead: true }), 0);
  assert.equal(wisher.wish(PAGE_SILENT_MS + 1).left.dead, false);
  const at = wisher.wish(PAGE_SILENT_MS + 100).left.p[0];
  wisher.obey(held({ dead: true }), PAGE_SILENT_MS + 200);
  assert.deepEqual(wisher.wish(PAGE_SILENT_MS + 220).left, { p: [at, 0, 0], dead: false, grip: false });
  wisher.obey(held({}), PAGE_SILENT_MS + 240);
  wisher.obey(held({ dead: true }), PAGE_SILENT_MS + 260);
  assert.equal(wisher.wish(PAGE_SILENT_MS + 280).left.dead, true);
});

test('the target stays near the hand, and farther ahead while the mouse drags', () => {
  const wisher = taken();
  wisher.move('left', [3, 0, 0]);
  assert.ok(Math.abs(wisher.wish(0).left.p[0] - 0.015 * SCALE) < 1e-12);
  wisher.obey(held({ isDragged: true }), 0);
  wisher.move('left', [3, 0, 0]);
  assert.ok(Math.abs(wisher.wish(0).left.p[0] - 0.06 * SCALE) < 1e-12);
});

test('a hand that another page has is lost, and a new scale begins at the hand', () => {
  const wisher = taken();
  wisher.move('left', [0.1, 0, 0]);
  assert.deepEqual(wisher.hear(told([0.5, 0.5, 0.5], PAGE, 1)), []);
  assert.deepEqual(wisher.wish(0).left.p, [0.5, 0.5, 0.5]);
  assert.deepEqual(wisher.hear(told([0, 0, 0], PAGE + 1)), ['left']);
  assert.deepEqual(wisher.wish(20), {});
});

test('a change of a button is told, a movement is not', () => {
  const wisher = taken();
  assert.equal(wisher.obey(held({ velocity: [0.01, 0, 0] }), 0), false);
  assert.equal(wisher.obey(held({ dead: true }), 10), true);
  assert.equal(wisher.obey(held({ dead: true, grip: true }), 20), true);
});
