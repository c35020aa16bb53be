// Shows the knot's name and properties, and a strip with its changes over time.
const $ = (id) => document.getElementById(id);
const COMMON = { '0_1': 'no knot', '3_1': 'trefoil (overhand)', '4_1': 'figure-eight', '5_1': 'cinquefoil', '5_2': 'three-twist', '6_1': 'stevedore',
  '3_1#3_1 left': 'granny', '3_1#3_1 right': 'granny', '3_1#3_1 amphichiral': 'square (reef)', '3_1#5_1 mixed': "surgeon's" };
/** Common name of a knot, or ''. */
export function commonName(type, handedness) { return COMMON[`${type} ${handedness}`] ?? COMMON[type] ?? ''; }
/** The text of an event, with the knot's common name when it is about a knot. */
export function withKnotName(text) {
  const [, type, handedness] = text.match(/^knot (\S+) (\S+)$/) ?? [], name = type && commonName(type, handedness);
  return name ? `${text}, ${name}` : text;
}

/** Length of each throw in diameters of the thread, without the thread between them. */
export function tightness(knot) {
  const lengths = (knot.throws ?? []).map(({ diameters }) => diameters.toFixed(0));
  return lengths.length ? `tightness: ${lengths.join(' and ')} diameters of thread` : '';
}

const TINTS = ['#56b4e9', '#e69f00', '#2fbf8f', '#cc79a7', '#f0e442', '#d55e00'];
const STRIP_S = 120;

export class KnotPanel {
  constructor() { this.history = []; this.tints = new Map([['0_1', '#3a4658'], ['unknown', '#8a8f98']]); }

  clear() { this.history = []; }

  /**
   * Fills the strip from the recording, before the first knot arrives. @param past [{label, from}], `from` is a tick
   * number.
   */
  seed(past) {
    if (!this.history.length) this.history = past.map(({ label, from }) => ({ label, type: label.split(' ')[0], from }));
  }

  update(knot, period_s) {
    if (!knot) return;
    const name = $('knot-name');
    name.dataset.type = knot.type;
    name.dataset.handedness = knot.handedness;
    name.innerHTML = knot.type.split('#').map((part) => part.replace(/_(\d+)/, '<sub>$1</sub>')).join(' # ');
    const hand = ['left', 'right'].includes(knot.handedness) ? `${knot.handedness}-handed` : knot.handedness === 'none' ? '' : knot.handedness;
    const common = commonName(knot.type, knot.handedness);
    const least = knot.type === 'unknown' ? null : knot.type.split('#').reduce((sum, part) => sum + (part === '0_1' ? 0 : parseInt(part, 10)), 0);
    $('knot-note').textContent = [hand, common, knot.type === '0_1' || knot.crossings === null ? '' : `crossings ${knot.crossings}${least === null ? '' : ` (least ${least})`}`,
      tightness(knot)].filter(Boolean).join(' · ');
    const label = `${knot.type} ${knot.handedness}`, last = this.history.at(-1);
    if (last && knot.tick < last.from) this.history = [];
    if (this.history.at(-1)?.label !== label) this.history.push({ label, type: knot.type, from: knot.tick });
    if (this.history.length > 500) this.history.shift();
    this.#strip(knot.tick, STRIP_S / period_s);
  }

  #tint(type) {
    if (!this.tints.has(type)) this.tints.set(type, TINTS[(this.tints.size - 2) % TINTS.length]);
    return this.tints.get(type);
  }

  /** Draws the strip, newest at the right end. */
  #strip(now, span) {
    const canvas = $('knot-strip'), ctx = canvas.getContext('2d');
    canvas.width = canvas.clientWidth;
    ctx.fillStyle = '#1b212b';
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.font = '10px sans-serif';
    this.history.forEach(({ type, from }, i) => {
      const until = this.history[i + 1]?.from ?? now, x = canvas.width * (1 - (now - from) / span), end = canvas.width * (1 - (now - until) / span);
      if (end < 0) return;
      ctx.fillStyle = this.#tint(type);
      ctx.fillRect(Math.max(0, x), 0, Math.max(1, end - Math.max(0, x)), canvas.height);
      ctx.fillStyle = type === '0_1' ? '#c9d2de' : '#101418';
      if (end - Math.max(0, x) > 26) ctx.fillText(type, Math.max(0, x) + 3, 11);
    });
  }
}
