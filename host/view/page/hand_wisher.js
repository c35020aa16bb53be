// The wishes for the hands that this page has taken: where each hand should be, its jaws, its dead-man. No browser API
// is used here, so that a test can run it on a clock of its own.
export const SIDES = ['left', 'right'];
const LONGEST_STEP_S = 0.06;
/** How far a target may be ahead of the hand, device metres, so that a target out of reach does not run away. */
const LEAD_M = { steady: 0.015, dragged: 0.06 };
/** After so long without a word from the page's own scripts a key may have been released unseen. */
export const PAGE_SILENT_MS = 1000;

export class HandWisher {
  constructor() { this.hands = {}; this.scale = 0; this.told = null; }

  get isEmpty() { return !SIDES.some((side) => this.hands[side]); }

  /** @param answer {page, p_W, grip} of the server. */
  take(side, { page, p_W, grip }, now_ms) {
    this.hands[side] = { page, target: p_W, grip, velocity: [0, 0, 0], isPressed: false, mustRelease: false };
    this.heard_ms = this.stepped_ms = now_ms;
  }

  /**
   * Takes the server's statement of which page has which hand (HandDesk::told). @returns the hands that this page has
   * lost.
   */
  hear(told) {
    const lost = SIDES.filter((side) => this.hands[side] && told[side].page !== this.hands[side].page);
    for (const side of lost) delete this.hands[side];
    const isNewScale = this.scale !== told.scale;
    this.told = told;
    this.scale = told.scale;
    if (isNewScale) for (const side of SIDES) if (this.hands[side] && told[side].p_W) this.hands[side].target = [...told[side].p_W];
    return lost;
  }

  /**
   * Takes what the user holds now. @param input {left?: {velocity: [x, y, z] of the device's tip along the world's
   * axes, m/s, dead, grip, isDragged}, right?}. @returns whether a button changed.
   */
  obey(input, now_ms) {
    this.step(now_ms); // with the velocity until now
    this.heard_ms = now_ms;
    let isChanged = false;
    for (const side of SIDES) {
      const hand = this.hands[side], wanted = input[side];
      if (!hand || !wanted) continue;
      isChanged ||= hand.isPressed !== wanted.dead || hand.grip !== wanted.grip;
      if (!wanted.dead) hand.mustRelease = false;
      Object.assign(hand, { velocity: wanted.velocity, isPressed: wanted.dead, grip: wanted.grip, isDragged: wanted.isDragged });
    }
    return isChanged;
  }

  /** Moves the target of a hand. @param by_W displacement in world metres. */
  move(side, by_W) {
    const hand = this.hands[side];
    if (!hand) return;
    hand.target = hand.target.map((x, i) => x + by_W[i]);
    const from = this.told?.[side]?.p_W, far = from ? Math.hypot(...hand.target.map((x, i) => x - from[i])) : 0;
    const most = (hand.isDragged ? LEAD_M.dragged : LEAD_M.steady) * this.scale;
    if (far > most) hand.target = hand.target.map((x, i) => from[i] + ((x - from[i]) * most) / far);
  }

  /** Moves the targets by what has passed. While the page is silent, hands stand still and the dead-man is released. */
  step(now_ms) {
    const step_s = Math.min((now_ms - this.stepped_ms) / 1000, LONGEST_STEP_S);
    this.stepped_ms = now_ms;
    const isDeaf = now_ms - this.heard_ms > PAGE_SILENT_MS;
    for (const side of SIDES) {
      const hand = this.hands[side];
      if (!hand) continue;
      if (isDeaf) Object.assign(hand, { velocity: [0, 0, 0], mustRelease: true });
      if (hand.velocity.some((v) => v)) this.move(side, hand.velocity.map((v) => v * this.scale * step_s));
    }
  }

  /** @returns the wish to send now. */
  wish(now_ms) {
    this.step(now_ms);
    return Object.fromEntries(SIDES.filter((side) => this.hands[side]).map((side) => {
      const { target, grip, isPressed, mustRelease } = this.hands[side];
      return [side, { p: target, dead: isPressed && !mustRelease, grip }];
    }));
  }
}
