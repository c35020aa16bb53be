// Buttons and keys of the traces. The user's choices are stored in panels.choice, so that traces that are restarted
// keep them.
import { isTyping } from './controls.js';

const $ = (id) => document.getElementById(id);
/** 'run': the whole of a recording. */
export const WINDOWS_S = [1, 5, 10, 30, 60, 300, 600, 'run'];

export class TraceTools {
  /** @param signal ends the listeners. */
  constructor(panels, signal) {
    this.panels = panels;
    const traces = (use) => { panels.parts.traces.run(use); panels.hurryTraces(); };
    this.traces = traces;
    $('windows').replaceChildren(...WINDOWS_S.map((s) => {
      const button = Object.assign(document.createElement('button'), { value: s, textContent: s === 'run' ? s : s < 60 ? `${s} s` : `${s / 60} min` });
      button.addEventListener('click', () => this.setWindow(s));
      return button;
    }));
    this.setWindow(panels.choice.window_s);
    $('pause').addEventListener('click', () => this.togglePause(), { signal });
    $('components').addEventListener('change', () => { panels.choice.components = $('components').checked; traces((t) => t.showComponents(panels.choice.components)); }, { signal });
    $('third').addEventListener('change', () => { panels.choice.third = $('third').value; traces((t) => t.showThird(panels.choice.third)); }, { signal });
    const keys = { p: () => this.togglePause(), '+': () => this.#step(1), '-': () => this.#step(-1) };
    addEventListener('keydown', (event) => { if (!isTyping(event) && !document.querySelector('dialog[open]')) keys[event.key.toLowerCase()]?.(); }, { signal });
  }

  setWindow(seconds) {
    this.panels.choice.window_s = seconds;
    this.traces((t) => { t.window_s = seconds; });
    for (const button of $('windows').children) button.classList.toggle('on', button.value === String(seconds));
  }

  togglePause() {
    this.traces((t) => {
      t.pause(!t.isPaused);
      $('pause').classList.toggle('on', t.isPaused);
      $('pause').textContent = t.isPaused ? 'Run' : 'Pause';
    });
  }

  #step(by) {
    const at = WINDOWS_S.indexOf(this.panels.choice.window_s) + by;
    const last = WINDOWS_S.length - (this.panels.latest.isReplay ? 1 : 2); // a live rig has no whole run
    this.setWindow(WINDOWS_S[Math.min(Math.max(at, 0), last)]);
  }
}
