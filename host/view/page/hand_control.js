// Lets the user move simulated hands: keys, mouse and gamepads together say how each hand should move. A worker
// (hand_worker.js) makes wishes of it and sends them, independent of how long the page draws.
import { toast, isTyping } from './controls.js';
import { HandKeys } from './hand_keys.js';
import { HandMouse } from './hand_mouse.js';
import { HandPads } from './hand_pads.js';
import { SIDES } from './hand_wisher.js';
import { along, nearestAxes } from './hand_views.js';
import { showMode, showHandsHeld } from './hand_panel.js';

const EVERY_MS = 20;
const PACES_M_PER_S = [0.01, 0.02, 0.04, 0.08, 0.15], FIRST_PACE = 2; // speed of the device's tip
const WHY_LOST = 'it was free for too long, or the device went';

export class HandControl {
  /**
   * @param latest newest data from the host. @param panels its `picture` is the view that draws the thread. @param run
   * calls a function; errors are attributed to this part of the page. @param fail tells that this part has failed.
   * @param signal ends the worker and the listeners, also if this constructor throws.
   */
  constructor({ link, latest, panels, run, fail, signal }) {
    Object.assign(this, { link, latest, panels, mine: {}, pace: FIRST_PACE, axes: null });
    this.worker = new Worker('./hand_worker.js', { type: 'module' });
    signal.addEventListener('abort', () => this.worker.terminate());
    this.worker.onmessage = ({ data }) => run((it) => it.hear(data));
    this.worker.onerror = (event) => fail(new Error(event.message || 'hand_worker.js did not load'));
    this.keys = new HandKeys({ jaws: (side) => this.jaws(side), pace: (step) => this.setPace(step), letGo: () => this.letGo(), changed: () => run((it) => it.step()) });
    this.pads = new HandPads();
    this.mouse = new HandMouse(document.getElementById('scene'), { panes: () => this.panes, handAt: (side) => this.seenAt(side),
      move: (side, by_W) => this.worker.postMessage({ move: { side, by_W } }), jaws: (side) => this.jaws(side), changed: () => run((it) => it.step()) });
    addEventListener('keydown', (event) => { if (event.code === 'KeyM' && !isTyping(event) && !document.querySelector('dialog[open]')) this.toggle(); }, { signal });
    addEventListener('blur', () => this.letGo(), { signal });
    addEventListener('pagehide', () => this.letGo(), { signal });
    document.addEventListener('visibilitychange', () => { if (document.hidden) this.letGo(); }, { signal });
    document.getElementById('hands-toggle').addEventListener('click', () => this.toggle(), { signal });
    for (const side of SIDES) document.getElementById(`jaws-${side}`).addEventListener('click', () => this.jaws(side), { signal });
    this.timer = setInterval(() => run((it) => it.step()), EVERY_MS);
    showMode(false);
  }

  dispose() {
    clearInterval(this.timer);
    this.end();
    this.keys.dispose();
    this.mouse.dispose();
  }

  get isOn() { return SIDES.some((side) => this.mine[side]); }
  get panes() { return this.panels.picture?.panes ?? []; }
  /** World position of a hand that this page has taken, else null. */
  seenAt(side) { return this.mine[side] ? this.latest.now?.hands?.[SIDES.indexOf(side)]?.p_W ?? null : null; }

  toggle() {
    if (this.isOn) this.end();
    else if (this.latest.isReplay) return;
    else if (!this.link.isOpen) toast('hands: refused – not connected to the host', true);
    else this.worker.postMessage({ take: this.link.token });
  }

  /** Takes the worker's word: which hands were taken, or lost. */
  hear({ taken, lost }) {
    if (taken) return this.#begin(taken);
    if (lost === 'connection') {
      if (this.isOn) toast('hands: the connection is lost, they have let go', true);
      this.mine = {};
    } else if (this.mine[lost]) {
      delete this.mine[lost];
      toast(`${lost} hand: ${WHY_LOST}. M ${this.isOn ? 'gives the other one back, and M again takes both' : 'takes it again'}`, true);
    }
    if (!this.isOn) this.forget();
  }

  #begin(taken) {
    this.mine = {};
    const refused = SIDES.map((side) => taken[side]).filter((answer) => !answer.accepted);
    for (const side of SIDES) if (taken[side].accepted) this.mine[side] = { grip: taken[side].grip, deadMan: false };
    if (!this.isOn) toast(`hands: refused – ${refused[0].text}`, true);
    else if (refused.length) toast(refused[0].text, true);
    this.keys.on(this.isOn);
    showMode(this.isOn);
  }

  /** Gives the taken hands back. */
  end() {
    this.worker.postMessage({ end: true });
    this.forget();
  }

  forget() {
    this.mine = {};
    this.keys.on(false);
    this.mouse.release();
    showMode(false);
  }

  jaws(side) { if (this.mine[side]) this.mine[side].grip = !this.mine[side].grip; }
  setPace(step) { this.pace = Math.max(0, Math.min(PACES_M_PER_S.length - 1, this.pace + step)); }

  /** Releases all keys and buttons and informs the device at once. */
  letGo() {
    this.keys.release();
    this.mouse.release();
    this.step();
  }

  /** Tells the worker what the user holds now. */
  step() {
    const pads = this.pads.read(), pane = this.panes[0], isWatched = document.hasFocus() && !document.hidden, input = {};
    if (pane) this.axes = nearestAxes(pane);
    for (const side of SIDES) {
      const keys = this.keys.move(side), pad = pads[side], hand = this.mine[side];
      if (!hand) continue;
      const way = keys.map((k, i) => (isWatched ? Math.max(-1, Math.min(1, k + pad.move[i])) * PACES_M_PER_S[this.pace] : 0));
      if (pad.jaws && isWatched) this.jaws(side);
      hand.deadMan = isWatched && (this.keys.deadMan(side) || pad.deadMan || this.mouse.deadMan(side));
      input[side] = { velocity: this.axes ? along(this.axes, way) : [0, 0, 0], dead: hand.deadMan, grip: hand.grip, isDragged: this.mouse.deadMan(side) };
    }
    if (!this.isOn) return;
    if (this.link.isOpen) this.worker.postMessage({ input });
    else { this.end(); toast('hands: the connection is lost, they have let go', true); }
  }

  /** Shows what each taken hand does, and passes its force to the gamepad's rumble. */
  show(maxForce_N) {
    const hands = this.latest.now?.hands ?? [], share = (i) => Math.hypot(...(hands[i]?.f_device ?? [0])) / maxForce_N;
    showHandsHeld(this.mine, hands, PACES_M_PER_S[this.pace]);
    this.pads.rumble({ left: this.mine.left ? share(0) : 0, right: this.mine.right ? share(1) : 0 });
  }
}
