// The help dialog; opens by itself on the first visit.
import { isTyping } from './controls.js';

const SEEN = 'ligature-help-seen';

export class Help {
  /** @param signal ends the listeners. */
  constructor(signal) {
    this.box = document.getElementById('help');
    document.getElementById('help-open').addEventListener('click', () => this.open(), { signal });
    this.box.addEventListener('close', () => keep(SEEN), { signal });
    addEventListener('keydown', (event) => {
      if (event.key === '?' && !isTyping(event)) this.open();
      if (event.key === 'Escape') for (const open of document.querySelectorAll('dialog[open]')) open.close('cancel');
    }, { signal });
    if (!isKept(SEEN)) this.open();
  }

  open() {
    if (this.box.open || document.querySelector('dialog[open]')) return;
    this.box.show(); // not modal: STOP stays usable
    this.box.scrollTop = 0; // the focused button is at the end, and a small page would show the end first
  }
}

// localStorage may be disabled and throw; the help then opens on each visit.
function keep(key) { try { localStorage.setItem(key, '1'); } catch { /* storage is disabled */ } }
function isKept(key) { try { return localStorage.getItem(key) !== null; } catch { return false; } }
