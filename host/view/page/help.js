// The help, by itself on the first visit.
import { isTyping } from './controls.js';

const SEEN = 'ligature-help-seen';

export class Help {
  constructor() {
    this.box = document.getElementById('help');
    document.getElementById('help-open').addEventListener('click', () => this.open());
    this.box.addEventListener('close', () => keep(SEEN));
    addEventListener('keydown', (event) => {
      if (event.key === '?' && !isTyping(event)) this.open();
      if (event.key === 'Escape') for (const open of document.querySelectorAll('dialog[open]')) open.close('cancel');
    });
    if (!isKept(SEEN)) this.open();
  }

  open() { if (!this.box.open && !document.querySelector('dialog[open]')) this.box.show(); } // not modal: STOP stays within reach
}

// A browser that keeps nothing throws here: the help then opens each time.
function keep(key) { try { localStorage.setItem(key, '1'); } catch { /* not kept */ } }
function isKept(key) { try { return localStorage.getItem(key) !== null; } catch { return false; } }
