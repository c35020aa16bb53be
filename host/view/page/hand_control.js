// Lets the user move simulated hands: keys, mouse and gamepads together give one target position per hand (a "wish"),
// sent 50 times a second. After 0.2 s without a wish the device releases its dead-man.
import { toast, isTyping } from './controls.js';
import { HandKeys } from './hand_keys.js';
import { HandMouse } from './hand_mouse.js';
import { HandPads } from './hand_pads.js';
import { along, nearestAxes } from './hand_views.js';
import { showMode, showHandsHeld } from './hand_panel.js';

const EVERY_MS = 20, LONGEST_STEP_S = 0.06;
const SIDES = ['left', 'right'];
const PACES_M_PER_S = [0.01, 0.02, 0.04, 0.08, 0.15], FIRST_PACE = 2; // speed of the device's tip
const LEAD_M = { steady: 0.015, dragged: 0.06 }; // how far a target may be ahead of the hand, so that a target out of reach does not run away

export class HandControl {
  /**
   * @param latest newest data from the host. @param panels its `picture` is the view that draws the thread. @param run
   * calls a function; errors are attributed to this part of the page.
   */
  constructor({ link, latest, panels, run }) {
    Object.assign(this, { link, latest, panels, told: null, mine: {}, pace: FIRST_PACE, axes: null, last_ms: performance.now() });
    this.keys = new HandKeys({ jaws: (side) => this.jaws(side), pace: (step) => this.setPace(step), letGo: () => this.letGo() });
    this.pads = new HandPads();
    this.mouse = new HandMouse(document.getElementById('scene'), { panes: () => this.panes, handAt: (side) => this.seenAt(side),
      move: (side, by) => this.move(side, by), jaws: (side) => this.jaws(side), changed: () => run((it) => it.step()) });
    this.ending = new AbortController();
    const { signal } = this.ending;
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
    this.ending.abort();
    this.end();
    this.keys.dispose();
    this.mouse.dispose();
  }

  get isOn() { return SIDES.some((side) => this.mine[side]); }
  get panes() { return this.panels.picture?.panes ?? []; }
  /** World position of a hand that this page has taken, else null. */
  seenAt(side) { return this.mine[side] ? this.latest.now?.hands?.[SIDES.indexOf(side)]?.p_W ?? null : null; }

  async toggle() {
    if (this.isOn) { this.end(); return; }
    if (this.latest.isReplay) return;
    const answers = await Promise.all(SIDES.map((side) => this.link.request({ hand: 'take', side })));
    answers.forEach((answer, i) => {
      if (answer.accepted) this.mine[SIDES[i]] = { page: answer.page, target: answer.p_W, grip: answer.grip, deadMan: false };
    });
    const refused = answers.filter((answer) => !answer.accepted);
    if (!this.isOn) toast(`hands: refused – ${refused[0].text}`, true);
    else if (refused.length) toast(refused[0].text, true);
    this.keys.on(this.isOn);
    showMode(this.isOn);
    this.hear(this.told);
  }

  /** Gives the taken hands back. */
  end() {
    for (const side of SIDES) if (this.mine[side]) this.link.send({ hand: 'leave', side, token: this.link.token });
    this.forget();
  }

  forget() {
    this.mine = {};
    this.keys.on(false);
    this.mouse.release();
    showMode(false);
  }

  /** Takes the server's statement of which page has which hand. */
  hear(told) {
    this.told = told;
    if (!told) return;
    for (const side of SIDES) {
      const hand = this.mine[side];
      if (!hand || told[side].page === hand.page) continue;
      delete this.mine[side];
      toast(`${side} hand: it was free for too long, or the device went. M takes it again`, true);
    }
    if (this.scale !== told.scale) for (const side of SIDES) if (this.mine[side] && told[side].p_W) this.mine[side].target = [...told[side].p_W];
    this.scale = told.scale;
    if (!this.isOn) this.forget();
  }

  jaws(side) { if (this.mine[side]) this.mine[side].grip = !this.mine[side].grip; }
  setPace(step) { this.pace = Math.max(0, Math.min(PACES_M_PER_S.length - 1, this.pace + step)); }

  /** Releases all keys and buttons and informs the device at once. */
  letGo() {
    this.keys.release();
    this.mouse.release();
    this.step();
  }

  /** Moves the target of a hand. @param by_W displacement in world metres. */
  move(side, by_W) {
    const hand = this.mine[side];
    if (!hand) return;
    hand.target = hand.target.map((x, i) => x + by_W[i]);
    const from = this.told?.[side]?.p_W, far = from ? Math.hypot(...hand.target.map((x, i) => x - from[i])) : 0;
    const most = (this.mouse.deadMan(side) ? LEAD_M.dragged : LEAD_M.steady) * this.scale;
    if (far > most) hand.target = hand.target.map((x, i) => from[i] + ((x - from[i]) * most) / far);
  }

  step() {
    const now = performance.now(), step_s = Math.min((now - this.last_ms) / 1000, LONGEST_STEP_S), pads = this.pads.read(), pane = this.panes[0];
    this.last_ms = now;
    if (pane) this.axes = nearestAxes(pane);
    const isWatched = document.hasFocus() && !document.hidden, wish = {};
    for (const side of SIDES) {
      const keys = this.keys.move(side), pad = pads[side], hand = this.mine[side], isPressed = this.keys.deadMan(side) || pad.deadMan || this.mouse.deadMan(side);
      const speed = PACES_M_PER_S[this.pace] * (this.scale ?? 0), way = keys.map((k, i) => Math.max(-1, Math.min(1, k + pad.move[i])));
      const by_W = this.axes ? along(this.axes, way.map((w) => w * speed * step_s)) : [0, 0, 0];
      if (!hand) continue;
      if (isWatched && way.some((w) => w)) this.move(side, by_W);
      if (pad.jaws && isWatched) this.jaws(side);
      hand.deadMan = isPressed && isWatched;
      wish[side] = { p: hand.target, dead: hand.deadMan, grip: hand.grip };
    }
    if (!this.isOn) return;
    if (this.link.isOpen) this.link.send({ wish, token: this.link.token });
    else { this.forget(); toast('hands: the connection is lost, they have let go', true); }
  }

  /** Shows what each taken hand does, and passes its force to the gamepad's rumble. */
  show(maxForce_N) {
    const hands = this.latest.now?.hands ?? [], share = (i) => Math.hypot(...(hands[i]?.f_device ?? [0])) / maxForce_N;
    showHandsHeld(this.mine, hands, PACES_M_PER_S[this.pace]);
    this.pads.rumble({ left: this.mine.left ? share(0) : 0, right: this.mine.right ? share(1) : 0 });
  }
}
