// Decodes a binary frame of the server (host/view/frame.hpp): "LGF1", u32 number, then sections of u32 kind, u32 size
// and payload, padded to 8 bytes. Typed arrays refer to the message without copying.

export const COLUMNS = ['tick', 'leftX', 'leftY', 'leftZ', 'left', 'rightX', 'rightY', 'rightZ', 'right', 'wakeup_ns',
  'control_ns', 'execution_ns', 'flags', 'state', 'fault', 'kinetic_J', 'potential_J', 'maxStretch', 'minGap_m',
  'contacts', 'leftNode', 'rightNode', 'leftWorld', 'rightWorld', 'leftPort_J', 'rightPort_J', 'leftDissipated_J', 'rightDissipated_J',
  'leftBusLoad', 'rightBusLoad', 'leftHeat', 'rightHeat', 'leftLimits', 'rightLimits',
  'leftClutch', 'rightClutch', 'degradation', 'threadDone_ns', 'timeLost',
  'leftPropagation', 'rightPropagation'];
export const C = Object.fromEntries(COLUMNS.map((name, i) => [name, i]));
export const WIDTH = COLUMNS.length;
export const TICKS_PER_BIN = 50;
export const BIN_NUMBER_PART = 2 ** 20; // equals kBinNumberPart in host/view/trace_row.hpp
const SECTION = { now: 1, shape: 2, rows: 3, bins: 4, text: 5, beside: 6, besideRows: 7, besideBins: 8 };
const MAGIC = 0x3146474c; // "LGF1", little-endian

/**
 * @returns {{number, now, shape?, rows?, bins?, text?, beside?, besideRows?, besideBins?}}. @throws Error when the
 * buffer is no valid frame.
 */
export function readFrame(buffer) {
  const view = new DataView(buffer);
  if (buffer.byteLength < 8 || view.getUint32(0, true) !== MAGIC) throw new Error('not a frame');
  const frame = { number: view.getUint32(4, true) };
  for (let at = 8; at + 8 <= buffer.byteLength;) {
    const kind = view.getUint32(at, true), size = view.getUint32(at + 4, true), start = at + 8;
    if (start + size > buffer.byteLength) throw new Error('cut-off frame');
    if (kind === SECTION.now) frame.now = readNow(new Float64Array(buffer, start, size / 8));
    else if (kind === SECTION.shape) frame.shape = readShape(buffer, start, size);
    else if (kind === SECTION.rows) frame.rows = new Float64Array(buffer, start, size / 8);
    else if (kind === SECTION.bins) frame.bins = new Float32Array(buffer, start, size / 4);
    else if (kind === SECTION.text) frame.text = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, start, size)));
    else if (kind === SECTION.beside) frame.beside = new Float64Array(buffer, start, 1)[0];
    else if (kind === SECTION.besideRows) frame.besideRows = new Float64Array(buffer, start, size / 8);
    else if (kind === SECTION.besideBins) frame.besideBins = new Float32Array(buffer, start, size / 4);
    at = start + Math.ceil(size / 8) * 8;
  }
  return frame;
}

/**
 * Section `now`: the epoch (a number that changes when earlier data must be discarded), age of the newest ticks in ms
 * (-1: none yet), and the newest tick.
 */
function readNow(v) {
  const now = { epoch: v[0], age_ms: v[1] };
  if (v.length < 6) return now;
  Object.assign(now, { tick: v[2], state: v[3], fault: v[4], flags: v[5], hands: [] });
  for (let at = 6; at + 13 <= v.length; at += 13) {
    now.hands.push({ p_W: v.slice(at, at + 3), f_device: v.slice(at + 3, at + 6), f_world: v.slice(at + 6, at + 9),
      grip: v[at + 9] !== 0, deadMan: v[at + 10] !== 0, node: v[at + 11], age: v[at + 12] });
  }
  return now;
}

function readShape(buffer, start, size) {
  const head = new Float64Array(buffer, start, 4);
  const n = (size - 32) / 20, floats = (from, count) => new Float32Array(buffer, start + 32 + 4 * from, count);
  return { tick: head[0], radius_m: head[1], grasped: [head[2], head[3]], p_W: floats(0, 3 * n), tension_N: floats(3 * n, n), turn_rad: floats(4 * n, n) };
}
