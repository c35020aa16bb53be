// Drags a hand in the picture with the mouse: movement in the picture's plane, wheel for depth, right button for the
// jaws. The dragging button is the dead-man.
const NEAR_PX = 34, DEPTH_PER_NOTCH_PX = 25, NOTCH = 100, HIDE_MENU_MS = 500;
const SIDES = ['left', 'right'];

export class HandMouse {
  /**
   * @param host the element that contains the pictures.
   * @param tell {panes(), handAt(side): p_W or null when this page does not have the hand, move(side, by_W),
   * jaws(side), changed()}.
   */
  constructor(host, tell) {
    Object.assign(this, { host, tell, side: null });
    this.ending = new AbortController();
    const listen = (type, what, more = {}) => host.addEventListener(type, what, { capture: true, signal: this.ending.signal, ...more });
    listen('pointerdown', (event) => this.down(event));
    listen('mousedown', (event) => { if (this.side && event.button === 2) { this.tell.jaws(this.side); this.noMenu_ms = performance.now() + HIDE_MENU_MS; } });
    listen('contextmenu', (event) => { if (this.side || performance.now() < this.noMenu_ms) event.preventDefault(); });
    listen('pointermove', (event) => this.move(event));
    listen('wheel', (event) => this.turn(event), { passive: false });
    for (const type of ['pointerup', 'pointercancel', 'lostpointercapture']) listen(type, (event) => { if (event.pointerId === this.pointer && !(event.buttons & 1)) this.release(); });
  }

  deadMan(side) { return this.side === side; }
  dispose() { this.ending.abort(); }

  release() {
    if (!this.side) return;
    this.side = this.pointer = null;
    this.tell.changed();
  }

  down(event) {
    if (event.button !== 0 || !event.target.matches('canvas')) return;
    const grabbed = this.under(event);
    if (!grabbed) return;
    Object.assign(this, grabbed, { pointer: event.pointerId, at: [event.clientX, event.clientY] });
    event.stopImmediatePropagation(); // keeps the camera from moving
    event.preventDefault();
    event.target.setPointerCapture(event.pointerId);
    this.tell.changed();
  }

  /** @returns {side, pane} of the hand drawn nearest to the pointer, or null beyond NEAR_PX. */
  under(event) {
    const box = this.host.getBoundingClientRect(), at = [event.clientX - box.left, event.clientY - box.top];
    let nearest = null, least = NEAR_PX;
    for (const pane of this.tell.panes()) for (const side of SIDES) {
      const p = this.tell.handAt(side), [u, v] = p ? pane.place(p) : [Infinity, Infinity], far = Math.hypot(u - at[0], v - at[1]);
      const isInside = at[0] >= pane.x && at[0] < pane.x + pane.w && at[1] >= pane.y && at[1] < pane.y + pane.h;
      if (isInside && far < least) { least = far; nearest = { side, pane }; }
    }
    return nearest;
  }

  move(event) {
    if (!this.side || event.pointerId !== this.pointer) return;
    event.stopImmediatePropagation();
    const scale = this.pane.metresPerPixel(this.tell.handAt(this.side) ?? [0, 0, 0]);
    const [dx, dy] = [scale * (event.clientX - this.at[0]), -scale * (event.clientY - this.at[1])];
    this.at = [event.clientX, event.clientY];
    this.tell.move(this.side, this.pane.right.map((r, i) => r * dx + this.pane.up[i] * dy));
  }

  turn(event) {
    if (!this.side) return;
    event.stopImmediatePropagation(); // no zoom while a hand is dragged
    event.preventDefault();
    const far = (-event.deltaY / NOTCH) * DEPTH_PER_NOTCH_PX * this.pane.metresPerPixel(this.tell.handAt(this.side) ?? [0, 0, 0]);
    this.tell.move(this.side, this.pane.away.map((a) => a * far));
  }
}
