// Everything except state and commands: collects what the host sends and passes it to the parts, each of which may fail
// alone.
import { Part } from './part.js';
import { allParts } from './part_list.js';
import { TraceStore } from './trace_store.js';

export class Panels {
  /** @param page the object that main.js exposes to tests; main.js updates its `latest`. */
  constructor(page, link) {
    Object.assign(this, { page, link, latest: page.latest, told: {}, events: [], isNew: true });
    page.store = this.store = new TraceStore();
    page.beside = this.beside = new TraceStore();
    page.panels = this;
    page.draws = 0;
    this.choice = { window_s: 10, third: 'tick time', components: false, isPaused: false, colour: 'plain', follow: false, stereo: 'off', view: 'iso' };
    this.parts = {};
    this.period_s = 1e-3;
    for (const [key, what] of Object.entries(allParts(this))) this.parts[key] = new Part(what);
    for (const part of Object.values(this.parts)) part.start(this.told);
    Object.defineProperties(page, { scene: { get: () => this.picture }, traces: { get: () => this.parts.traces.value } });
    // Asks for the next picture first, so that an exception in draw() does not end drawing for good.
    const next = (time) => { requestAnimationFrame(next); this.draw(time); };
    requestAnimationFrame(next);
  }

  /** The part that draws the thread now (3-D or flat), or null. */
  get picture() { return this.parts.scene.value ?? this.parts.flat.value; }

  onFrame(frame) {
    const { latest } = this;
    if (frame.now.epoch !== this.epoch) {
      this.epoch = frame.now.epoch;
      this.store.clear();
      this.events.length = 0;
      delete this.told.knot;
      latest.knot = null;
      for (const part of Object.values(this.parts)) part.run((value) => part.what.forget?.(value));
    }
    if (frame.bins) this.store.addBins(frame.bins);
    if (frame.rows) this.store.addRows(frame.rows);
    if (frame.beside !== undefined && frame.beside !== this.besideEpoch) { this.besideEpoch = frame.beside; this.beside.clear(); }
    if (frame.besideBins) this.beside.addBins(frame.besideBins);
    if (frame.besideRows) this.beside.addRows(frame.besideRows);
    if (frame.text) this.onText(frame.text);
    this.isNew = true;
  }

  onText(text) {
    if (text.events) this.events.push(...text.events);
    this.events.splice(0, this.events.length - 40);
    Object.assign(this.told, text);
    delete this.told.answers;
    delete this.told.events; // kept in this.events
    if (text.status) this.period_s = text.status.period_s;
    if (text.knot) this.latest.knot = text.knot;
    for (const part of Object.values(this.parts)) part.text(text);
  }

  draw(time) {
    const isNew = this.isNew;
    this.isNew = false;
    for (const part of Object.values(this.parts)) {
      if (isNew && part.what.update) part.run(part.what.update);
      part.draw(time);
    }
    ++this.page.draws;
  }
}
