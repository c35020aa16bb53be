// Keys that move the hands. They are identified by their place on the keyboard, not by their label. A direction is
// [right, up, away] in the picture.
import { takenKeys } from './controls.js';

export const KEYS = {
  left: { KeyA: [-1, 0, 0], KeyD: [1, 0, 0], KeyS: [0, -1, 0], KeyW: [0, 1, 0], KeyQ: [0, 0, -1], KeyE: [0, 0, 1] },
  right: { KeyJ: [-1, 0, 0], KeyL: [1, 0, 0], KeyK: [0, -1, 0], KeyI: [0, 1, 0], KeyU: [0, 0, -1], KeyO: [0, 0, 1] },
};
const DEAD_MAN = { left: 'ShiftLeft', right: 'Semicolon' }, // not both Shift keys: while both are pressed, some systems report the release of one only
  JAWS = { KeyF: 'left', KeyH: 'right' }, PACE = { Comma: -1, Period: 1 };
const ALL = [...Object.values(KEYS).flatMap(Object.keys), ...Object.values(DEAD_MAN), ...Object.keys(JAWS), ...Object.keys(PACE)];
const IS_TEXT = 'input[type=text], textarea';

export class HandKeys {
  /**
   * @param tell {jaws(side), pace(step), letGo(), changed()}: callbacks; letGo: the state of the keys is uncertain,
   * release everything; changed: another key is down or up.
   */
  constructor(tell) {
    this.tell = tell;
    this.held = new Set();
    this.ending = new AbortController();
    const listen = (type, what) => addEventListener(type, what, { capture: true, signal: this.ending.signal });
    listen('keydown', (event) => this.down(event));
    listen('keyup', (event) => this.up(event));
    this.on(false);
  }

  /** Switches the keys on or off; while on, they have no other function. */
  on(isOn) {
    this.isOn = isOn;
    this.held.clear();
    for (const code of ALL) if (isOn) takenKeys.add(code); else takenKeys.delete(code);
  }

  release() { this.held.clear(); }
  dispose() { this.on(false); this.ending.abort(); }

  down(event) {
    if (!this.isOn || !ALL.includes(event.code)) return;
    // With these keys pressed, the system may not report the release of another key.
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches?.(IS_TEXT)) return this.tell.letGo();
    event.preventDefault();
    this.up({ shiftKey: event.shiftKey }); // finds a Shift release that was not reported
    if (event.repeat) return;
    this.held.add(event.code);
    if (JAWS[event.code]) this.tell.jaws(JAWS[event.code]);
    if (PACE[event.code]) this.tell.pace(PACE[event.code]);
    this.tell.changed();
  }

  up({ code, shiftKey }) {
    const before = this.held.size;
    this.held.delete(code);
    if (!shiftKey) this.held.delete(DEAD_MAN.left);
    if (this.held.size !== before) this.tell.changed();
  }

  /** Direction of the pressed keys. @returns [right, up, away], each -1 .. 1. */
  move(side) {
    const sum = [0, 0, 0];
    for (const [code, way] of Object.entries(KEYS[side])) if (this.held.has(code)) way.forEach((w, i) => { sum[i] += w; });
    return sum;
  }

  deadMan(side) { return this.held.has(DEAD_MAN[side]); }
}
