// Buttons, keys and legend of the picture, for both the 3-D and the flat view.
import { SCALE_CSS } from './colouring.js';
import { isTyping, toast } from './controls.js';
import { roundLength } from './round_length.js';

const $ = (id) => document.getElementById(id);

export class SceneTools {
  /** @param signal ends the listeners. */
  constructor(panels, signal) {
    const { choice } = panels;
    const pictures = (use) => { for (const key of ['scene', 'flat']) panels.parts[key].run(use); panels.isNew = true; };
    const view = (name) => { choice.view = name; pictures((p) => p.view(name)); };
    for (const button of document.querySelectorAll('[data-view]')) button.addEventListener('click', () => view(button.dataset.view), { signal });
    $('follow').addEventListener('change', () => { choice.follow = $('follow').checked; pictures(() => {}); }, { signal });
    $('colour').addEventListener('change', () => { choice.colour = $('colour').value; pictures(() => {}); }, { signal });
    const refused = (error) => toast(`stereo: ${error.message}`, true); // its file is loaded only when it is chosen
    $('stereo').addEventListener('change', () => { choice.stereo = $('stereo').value; pictures((p) => p.setStereo(choice.stereo)?.catch(refused)); }, { signal });
    $('tools-open').addEventListener('click', () => $('tools-open').setAttribute('aria-expanded', $('tools').classList.toggle('is-open')), { signal });
    const keys = { 1: () => view('front'), 2: () => view('side'), 3: () => view('top'), 4: () => view('iso'), f: () => view('fit'),
      k: () => $('follow').click(), c: () => { if (!panels.latest.isReplay) $('change-open').click(); } };
    addEventListener('keydown', (event) => { if (!isTyping(event) && !document.querySelector('dialog[open]')) keys[event.key.toLowerCase()]?.(); }, { signal });
  }

  /** Shows a scale bar of a round length, 40 to 100 pixels long. */
  showScale(metresPerPixel) {
    const bar = $('scale-bar');
    bar.hidden = !(metresPerPixel > 0);
    if (bar.hidden) return;
    const { length_m, text } = roundLength(100 * metresPerPixel);
    bar.style.width = `${length_m / metresPerPixel}px`;
    bar.firstElementChild.textContent = text;
  }

  showLegend(legend) {
    $('legend').hidden = !legend;
    const text = legend ? `${legend.title}|${legend.low ?? ''}|${legend.high ?? ''}` : '';
    if ($('legend').dataset.text === text) return;
    $('legend').dataset.text = text;
    $('legend').innerHTML = legend ? `<b>${legend.title}</b>${legend.low ? `<i style="background:${SCALE_CSS}"></i><span>${legend.low}<span></span>${legend.high}</span>` : ''}` : '';
  }
}
