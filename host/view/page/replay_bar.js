// Playback bar of a recording: play, speed, scrub, jump to marks. Its background shows forces and knots of the whole
// recording.
import { isTyping, toast } from './controls.js';
import { withKnotName } from './knot_panel.js';
import { offerRecordings } from './recordings_list.js';

const $ = (id) => document.getElementById(id);
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];
const KIND = { state: 1, fault: 2, grasp: 3, release: 4, limit: 5, change: 6, knot: 100 };
const TINT = { [KIND.fault]: '#ff5c47', [KIND.grasp]: '#2fbf8f', [KIND.release]: '#9aa6b6', [KIND.knot]: '#cc79a7', [KIND.change]: '#f0e442' };

export class ReplayBar {
  /** @param signal ends the listeners. */
  constructor(link, signal) {
    this.link = link;
    this.state = { position_s: 0, duration_s: 0, playing: false, speed: 1 };
    this.marks = [];
    $('speed').replaceChildren(...SPEEDS.map((speed) => new Option(`${speed}×`, speed, speed === 1, speed === 1)));
    $('play').addEventListener('click', () => this.toggle(), { signal });
    $('speed').addEventListener('change', () => link.send({ speed: Number($('speed').value) }), { signal });
    $('scrub').addEventListener('input', () => { this.scrubbed = performance.now(); this.seek(Number($('scrub').value)); }, { signal });
    $('previous').addEventListener('click', () => this.jump(-1), { signal });
    $('next').addEventListener('click', () => this.jump(1), { signal });
    for (const id of ['compare', 'align']) $(id).addEventListener('change', () => this.#compare(), { signal });
    $('open').addEventListener('change', () => this.#open(), { signal });
    addEventListener('keydown', (event) => this.#key(event), { capture: true, signal });
    const resizes = new ResizeObserver(() => this.#drawOverview());
    resizes.observe($('overview'));
    signal.addEventListener('abort', () => resizes.disconnect());
  }

  get isOn() { return !$('replay').hidden; }

  #key(event) {
    if (!this.isOn || isTyping(event) || document.querySelector('dialog[open]')) return;
    const actions = { Enter: () => this.toggle(), ' ': () => this.toggle(), ArrowLeft: () => this.seek(this.state.position_s - (event.shiftKey ? 5 : 0.5)),
      ArrowRight: () => this.seek(this.state.position_s + (event.shiftKey ? 5 : 0.5)), '[': () => this.jump(-1), ']': () => this.jump(1) };
    if (!actions[event.key]) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    actions[event.key]();
  }

  toggle() { this.link.send({ play: !this.state.playing }); }
  seek(t_s) { this.link.send({ seek_s: Math.min(Math.max(t_s, 0), this.state.duration_s) }); }

  jump(direction) {
    const at = this.state.position_s, kind = KIND[$('mark-kind').value], marks = this.marks.filter((m) => (kind ? m.kind === kind : TINT[m.kind]));
    const mark = direction > 0 ? marks.find((m) => m.t_s > at + 0.02) : marks.findLast((m) => m.t_s < at - 0.3);
    if (mark) this.seek(mark.t_s);
  }

  /** Plays another recording of the folder, for all pages. */
  async #open() {
    const answer = await this.link.request({ open: $('open').value });
    if (!answer.accepted) toast(`open: refused – ${answer.text}`, true);
  }

  showFile(name) { offerRecordings(this.link, name); }

  /** Requests a comparison; the result is sent to all pages as topic 'compare'. */
  #compare() { this.link.send({ compare: $('compare').value, align: $('align').value }); }

  /** Topic 'compare': the list of recordings, and the one that is compared with this one. */
  setCompare({ files, file, align, offset_ticks, why }) {
    const names = [...new Set([...files, ...(file ? [file] : [])])];
    $('compare').replaceChildren(new Option('compare with…', ''), ...names.map((name) => new Option(name, name)));
    $('compare').value = file;
    if (file) $('align').value = align;
    $('compare-note').textContent = file && offset_ticks === null ? 'reading…' : why;
  }

  /** Knots of the recording up to now, for the strip. @param tick number of the displayed tick. */
  knotsUntil(tick, period_s) {
    const at = this.state.position_s, first = { label: '0_1 none', from: tick - at / period_s };
    return [first, ...this.marks.filter((m) => m.kind === KIND.knot && m.t_s <= at)
      .map((m) => ({ label: m.text.replace('knot ', ''), from: tick + (m.t_s - at) / period_s }))];
  }

  update(state) {
    this.state = state;
    $('scrub').max = state.duration_s;
    if (!(performance.now() - this.scrubbed < 300)) $('scrub').value = state.position_s;
    $('play').textContent = state.playing ? 'Hold' : 'Play';
    $('speed').value = state.speed;
    $('clock').textContent = `${state.position_s.toFixed(2)} / ${state.duration_s.toFixed(2)} s${state.survey < 1 ? ` · reading ${Math.round(100 * state.survey)} %` : ''}`;
  }

  setMarks(marks) {
    this.marks = marks.marks;
    this.forces = [marks.left_N, marks.right_N];
    $('marks').replaceChildren(...this.marks.filter((m) => TINT[m.kind]).slice(0, 400).map((mark) => {
      const button = document.createElement('button');
      button.title = `${mark.t_s.toFixed(2)} s: ${withKnotName(mark.text)}`;
      button.tabIndex = -1;
      button.style.left = `calc(8px + (100% - 16px) * ${mark.t_s / this.state.duration_s})`;
      button.style.setProperty('--tint', TINT[mark.kind]);
      button.addEventListener('click', () => this.seek(mark.t_s));
      return button;
    }));
    this.#drawOverview();
  }

  #drawOverview() {
    const canvas = $('overview'), ctx = canvas.getContext('2d');
    canvas.width = canvas.clientWidth;
    canvas.height = canvas.clientHeight;
    if (!this.forces) return;
    const most = Math.max(0.1, ...this.forces.flat());
    this.forces.forEach((force, hand) => {
      ctx.fillStyle = hand ? '#e69f0099' : '#56b4e999';
      force.forEach((f, i) => ctx.fillRect((i * canvas.width) / force.length, canvas.height * (1 - f / most), Math.ceil(canvas.width / force.length), (canvas.height * f) / most));
    });
  }
}
