// Wires the page: frames in, panels and pictures out.
import { COLUMNS } from './frame.js';
import { Link } from './link.js';
import { Scene } from './scene.js';
import { SCALE_CSS } from './colouring.js';
import { TraceStore } from './trace_store.js';
import { THIRD, Traces, WINDOWS_S, describeRow } from './traces.js';
import { KnotPanel } from './knot_panel.js';
import { ReplayBar } from './replay_bar.js';
import { setUpChange, showOffer } from './change_panel.js';
import { isTyping, setUpControls, setUpRecording, showRecording } from './controls.js';
import { drawDiagram } from './knot_diagram.js';
import { setNames } from './names.js';
import { sceneFacts, showAge, showHands, showState, showStatus } from './state_panel.js';

const $ = (id) => document.getElementById(id);
const store = new TraceStore(), beside = new TraceStore(), scene = new Scene($('canvas')), knots = new KnotPanel();
const latest = { now: null, shape: null, knot: null, epoch: null, isReplay: false, isNew: false };
const events = [];
const page = { frames: 0, draws: 0, firstThread_ms: null, latest, store, beside, scene, columns: COLUMNS }; // what tests and the curious look at
window.ligature = page;

const traces = new Traces($('plots'), store, (row) => {
  $('cursor').textContent = describeRow(row, traces.period_s, traces.third, traces.besideRow(row));
  $('cursor').dataset.row = row ? JSON.stringify([...row].map((v) => (Object.is(v, -0) ? '-0' : v))) : ''; // JSON knows no -0
});
traces.beside = { store: beside, offset_ticks: null, name: '' };
const link = new Link(onFrame), replay = new ReplayBar(link);
page.traces = traces;
page.link = link;

function onFrame(frame) {
  ++page.frames;
  if (frame.now.epoch !== latest.epoch) {
    latest.epoch = frame.now.epoch;
    store.clear();
    knots.clear();
    events.length = 0;
    if (traces.isPaused) traces.pause(false);
  }
  latest.now = frame.now;
  latest.heard = performance.now();
  if (frame.shape) { latest.shape = frame.shape; page.firstThread_ms ??= performance.now(); }
  if (frame.bins) store.addBins(frame.bins);
  if (frame.rows) store.addRows(frame.rows);
  if (frame.beside !== undefined && frame.beside !== latest.beside) { latest.beside = frame.beside; beside.clear(); }
  if (frame.besideBins) beside.addBins(frame.besideBins);
  if (frame.besideRows) beside.addRows(frame.besideRows);
  if (frame.text) onText(frame.text);
  latest.isNew = true;
  checkAge();
}

/** At each frame and by a timer: how old the picture is must not wait until it is drawn. */
function checkAge() {
  const isOld = showAge(latest.now?.age_ms ?? -1, link.silent_ms, latest);
  if (isOld && !page.isOld) page.staleAt_ms = Math.max(latest.now?.age_ms ?? 0, link.silent_ms);
  page.isOld = isOld;
}
setInterval(checkAge, 20);

function onText({ view, status, offer, unreadable, recording, knot, replay: position, marks, compare, events: more }) {
  if (view) showView(view);
  if (status) {
    showStatus(status);
    scene.setFacts(sceneFacts(status));
    traces.period_s = status.period_s;
    traces.limit_N = status.max_force_N;
  }
  if (offer) showOffer(offer);
  if (position) replay.update(position);
  if (marks) replay.setMarks(marks);
  if (knot) {
    const isOfBefore = latest.isReplay && Math.abs(latest.now.tick - knot.tick) * traces.period_s > 1; // a jump: the next is on its way
    if (latest.isReplay && !isOfBefore) knots.seed(replay.knotsUntil(knot.tick, traces.period_s));
    latest.knot = knot;
    if (!isOfBefore) knots.update(knot, traces.period_s);
  }
  if (unreadable) latest.unreadable = unreadable;
  if (recording) showRecording(recording);
  if (compare) { replay.setCompare(compare); traces.compareWith(compare); tracesDue = 0; }
  if (more) showEvents(more);
}

function showView(view) {
  setNames(view.names);
  latest.isReplay = view.mode === 'replay';
  document.body.classList.toggle('is-replay', latest.isReplay);
  $('replay').hidden = !latest.isReplay;
  $('controls').hidden = latest.isReplay;
  document.title = latest.isReplay ? `${view.file} – Ligature` : 'Ligature';
  for (const button of $('controls').children) button.disabled = !view.may_command;
  if (!view.may_command && !latest.isReplay) $('controls').title = 'This view may only look';
}

function showEvents(more) {
  events.push(...more);
  events.splice(0, events.length - 40);
  $('events').replaceChildren(...events.slice(-12).reverse().map((event) => {
    const item = document.createElement('li');
    item.textContent = `${(event.tick * traces.period_s).toFixed(2)} s ${event.text}`;
    if (event.kind === 2) item.className = 'fault-event';
    return item;
  }));
}

let tracesDue = 0, diagramDue = 0;
function draw(time) {
  requestAnimationFrame(draw);
  if (latest.isNew) {
    latest.isNew = false;
    showState(latest.now);
    const row = store.rowEnd > store.rowBegin ? store.row(store.rowEnd - 1) : null;
    showHands(latest.now, row);
    showLegend(scene.update(latest.shape, latest.now, latest.knot?.core));
  }
  if (time >= diagramDue && latest.shape) {
    page.crossings = drawDiagram($('knot-diagram'), latest.shape.p_W, latest.knot?.core, scene.camera);
    diagramDue = time + 200;
  }
  scene.draw(time);
  ++page.draws;
  if (time >= tracesDue) {
    traces.draw();
    tracesDue = time + (traces.window_s <= 10 ? 50 : 200); // long windows move slowly: no need to redraw them often
  }
}

function showLegend(legend) {
  $('legend').hidden = !legend;
  const text = legend ? `${legend.title}|${legend.low ?? ''}|${legend.high ?? ''}` : '';
  if ($('legend').dataset.text === text) return;
  $('legend').dataset.text = text;
  $('legend').innerHTML = legend ? `<b>${legend.title}</b>${legend.low ? `<i style="background:${SCALE_CSS}"></i><span>${legend.low}<span></span>${legend.high}</span>` : ''}` : '';
}

function setWindow(seconds) {
  traces.window_s = seconds;
  tracesDue = 0;
  for (const button of $('windows').children) button.classList.toggle('on', Number(button.value) === seconds);
}

function setUpTraces() {
  for (const seconds of WINDOWS_S) {
    const button = document.createElement('button');
    button.value = seconds;
    button.textContent = seconds < 60 ? `${seconds}s` : `${seconds / 60}min`;
    button.addEventListener('click', () => setWindow(seconds));
    $('windows').append(button);
  }
  setWindow(10);
  $('pause').addEventListener('click', togglePause);
  $('components').addEventListener('change', () => traces.showComponents($('components').checked));
  traces.showComponents(false);
  for (const name of Object.keys(THIRD)) $('third').add(new Option(name, name));
  $('third').addEventListener('change', () => { traces.showThird($('third').value); tracesDue = 0; });
}

function togglePause() {
  traces.pause(!traces.isPaused);
  $('pause').classList.toggle('on', traces.isPaused);
  $('pause').textContent = traces.isPaused ? 'Run' : 'Pause';
  tracesDue = 0;
}

function setUpScene() {
  for (const button of document.querySelectorAll('[data-view]')) button.addEventListener('click', () => scene.view(button.dataset.view));
  $('follow').addEventListener('change', () => { scene.follow = $('follow').checked; });
  $('colour').addEventListener('change', () => { scene.colour = $('colour').value; latest.isNew = true; });
  $('stereo').addEventListener('change', () => { scene.setStereo($('stereo').value); });
}

function setUpKeys() {
  const step = (by) => setWindow(WINDOWS_S[Math.min(Math.max(WINDOWS_S.indexOf(traces.window_s) + by, 0), WINDOWS_S.length - 1)]);
  const keys = { 1: () => scene.view('front'), 2: () => scene.view('side'), 3: () => scene.view('top'), 4: () => scene.view('iso'), f: () => scene.view('fit'),
    k: () => $('follow').click(), p: togglePause, c: () => { if (!latest.isReplay) $('change-open').click(); }, '+': () => step(1), '-': () => step(-1), '?': openHelp };
  addEventListener('keydown', (event) => { if (!isTyping(event) && !document.querySelector('dialog[open]')) keys[event.key.toLowerCase()]?.(); });
}

function openHelp() { if (!$('help').open) $('help').showModal(); }

function setUpHelp() {
  $('help-open').addEventListener('click', openHelp);
  $('help').addEventListener('close', () => localStorage.setItem('ligature-help-seen', '1'));
  if (!localStorage.getItem('ligature-help-seen')) openHelp();
}

setUpControls(link, () => latest.isReplay);
setUpRecording(link);
setUpChange(link);
setUpTraces();
setUpScene();
setUpKeys();
setUpHelp();
requestAnimationFrame(draw);
