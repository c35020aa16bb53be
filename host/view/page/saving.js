// Saves what the page shows as a file: a picture, a film, the traces as CSV.
import { toast } from './controls.js';
import { ticksAsCsv } from './csv.js';
import { drawCaption } from './caption.js';

const $ = (id) => document.getElementById(id);
const FILM_EVERY_MS = 50, KEPT_MS = 60_000;
const FILM_KINDS = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm', 'video/mp4'];

export class Saving {
  /** @param signal ends the listeners. */
  constructor(panels, signal) {
    this.panels = panels;
    const acts = { picture: () => this.#picture(), film: () => this.startFilm(), csv: () => this.#csv() };
    $('save').addEventListener('change', () => { const act = acts[$('save').value]; $('save').value = ''; act?.(); }, { signal });
    $('film-end').addEventListener('click', () => this.endFilm(), { signal });
  }

  dispose() { this.film?.recorder.stop(); $('film-end').hidden = true; }

  /** Draws the picture of the thread with its caption on a canvas. @returns whether there is a picture. */
  #compose(canvas) {
    const { picture, latest } = this.panels;
    if (!picture?.canvas.width) return false;
    picture.drawNow?.(); // WebGL keeps a picture only until it has been shown
    if (canvas.width !== picture.canvas.width || canvas.height !== picture.canvas.height) Object.assign(canvas, { width: picture.canvas.width, height: picture.canvas.height });
    const context = canvas.getContext('2d');
    context.drawImage(picture.canvas, 0, 0);
    drawCaption(context, { name: $('knot-name').textContent, note: $('knot-note').textContent, legend: $('legend').innerText, metresPerPixel: (picture.metresPerPixel * picture.canvas.clientWidth) / canvas.width,
      when: `${$('scene-file')?.textContent ?? ''} · ${((latest.now?.tick ?? 0) * this.panels.period_s).toFixed(2)} s` });
    return true;
  }

  #picture() {
    const canvas = document.createElement('canvas');
    if (!this.#compose(canvas)) return toast('picture: nothing is drawn yet', true);
    canvas.toBlob((blob) => this.#keep(blob, 'png'));
  }

  startFilm() {
    const kind = FILM_KINDS.find((type) => window.MediaRecorder?.isTypeSupported(type)), canvas = document.createElement('canvas');
    if (!kind) return toast('film: this browser cannot record one', true);
    if (this.film || !this.#compose(canvas)) return;
    const recorder = new MediaRecorder(canvas.captureStream(1000 / FILM_EVERY_MS), { mimeType: kind }), parts = [];
    recorder.ondataavailable = ({ data }) => parts.push(data);
    recorder.onstop = () => { if (this.film?.isWanted) this.#keep(new Blob(parts, { type: kind }), kind.includes('webm') ? 'webm' : 'mp4'); this.film = null; };
    this.film = { recorder, canvas, due: 0, began: performance.now(), isWanted: false };
    recorder.start(1000);
    $('film-end').hidden = false;
  }

  endFilm() {
    if (!this.film) return;
    this.film.isWanted = true;
    $('film-end').hidden = true;
    this.film.recorder.stop();
  }

  draw(time) {
    if (!this.film || time < this.film.due) return;
    this.film.due = time + FILM_EVERY_MS;
    this.#compose(this.film.canvas);
    $('film-end').textContent = `■ film ${Math.floor((performance.now() - this.film.began) / 1000)} s`;
  }

  #csv() {
    const { store, choice, period_s } = this.panels, traces = this.panels.parts.traces.value;
    const to = (traces?.end ?? store.lastTick ?? -1) + 1, wanted = Math.round((choice.window_s === 'run' ? Infinity : choice.window_s) / period_s);
    const { text, count } = ticksAsCsv(store, to - wanted, to);
    if (!count) return toast('CSV: there are no ticks yet', true);
    this.#keep(new Blob([text], { type: 'text/csv' }), 'csv', `${count} ticks${count < wanted ? '; the page has no more, a recording has all' : ''}`);
  }

  /** Gives the file to the browser, which saves or asks. */
  #keep(blob, ending, what = '') {
    const tick = this.panels.latest.now?.tick ?? 0, scene = ($('scene-file')?.textContent ?? '').split(/[.,]/)[0] || 'ligature';
    const link = Object.assign(document.createElement('a'), { href: URL.createObjectURL(blob), download: `${scene}-${tick}.${ending}` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), KEPT_MS);
    toast(`saved ${link.download}${what && `: ${what}`}`);
  }
}
