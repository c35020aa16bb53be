// List of the last events, newest first, at the bottom of the page.
import { withKnotName } from './knot_panel.js';

const SHOWN = 12, FAULT = 2;

export function showEvents(events, period_s) {
  document.getElementById('events').replaceChildren(...events.slice(-SHOWN).reverse().map((event) => {
    const item = document.createElement('li');
    item.textContent = `${(event.tick * period_s).toFixed(2)} s ${withKnotName(event.text)}`;
    if (event.kind === FAULT) item.className = 'fault-event';
    return item;
  }));
}
