// Gamepads with the standard layout. One gamepad moves both hands: one stick each; trigger = dead-man, bumper = jaws.
// With two gamepads each moves one hand, with either trigger and bumper.
const IDLE = 0.12, PRESSED = 0.5, RUMBLE_MS = 120, LEAST_FORCE = 0.02;
const SIDES = ['left', 'right'];
const BUTTONS = { bumper: [4, 5], trigger: [6, 7], away: { left: 12, right: 3 }, near: { left: 13, right: 0 } };

export class HandPads {
  constructor() { this.before = {}; }

  get pads() { return [...(navigator.getGamepads?.() ?? [])].filter((pad) => pad?.connected && pad.mapping === 'standard').slice(0, 2); }

  /**
   * @returns {left: {move: [right, up, away], deadMan, jaws: pressed since the last call}, right: the same}. A
   * disconnected gamepad counts as nothing pressed.
   */
  read() {
    const pads = this.pads;
    return Object.fromEntries(SIDES.map((side, i) => [side, this.#of(pads.length > 1 ? pads[i] : pads[0], side, pads.length > 1)]));
  }

  #of(pad, side, isAlone) {
    if (!pad) return { move: [0, 0, 0], deadMan: false, jaws: false };
    const i = SIDES.indexOf(side), at = isAlone ? 0 : 2 * i, pressed = (n) => (pad.buttons[n]?.value ?? 0) > PRESSED;
    const any = (which) => (isAlone ? which.some(pressed) : pressed(which[i]));
    const depth = isAlone ? -past(pad.axes[3]) : pressed(BUTTONS.away[side]) - pressed(BUTTONS.near[side]);
    const closes = any(BUTTONS.bumper), jaws = closes && !this.before[side];
    this.before[side] = closes;
    return { move: [past(pad.axes[at]), -past(pad.axes[at + 1]), depth], deadMan: any(BUTTONS.trigger), jaws };
  }

  /** @param left, right force of each hand as a share of the limit, 0 .. 1. */
  rumble({ left, right }) {
    const pads = this.pads, play = (pad, strong, weak) => {
      if (Math.max(strong, weak) < LEAST_FORCE) return;
      pad?.vibrationActuator?.playEffect?.('dual-rumble', { duration: RUMBLE_MS, strongMagnitude: Math.min(1, strong), weakMagnitude: Math.min(1, weak) })
        .catch(() => {}); // this gamepad cannot rumble
    };
    if (pads.length > 1) { play(pads[0], left, left); play(pads[1], right, right); } else play(pads[0], left, right);
  }
}

/** Dead zone: a released stick does not return exactly to 0. */
function past(value = 0) { return Math.abs(value) < IDLE ? 0 : value; }
