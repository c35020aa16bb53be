// State display and commands. They come first and depend on no drawing code. Everything else (panels.js) is loaded
// separately, receives each frame after them, and may fail without affecting them.
import { COLUMNS, WIDTH } from './frame.js';
import { Link } from './link.js';
import { setUpControls } from './controls.js';
import { setNames } from './names.js';
import { showAge, showHands, showState, showStatus } from './state_panel.js';

const WATCH_MS = 20, LAG_KEPT_MS = 2000, MOST_WAITING = 300, RETRY_MS = 5000;
const $ = (id) => document.getElementById(id);
const latest = { now: null, shape: null, knot: null, epoch: null, row: null, isReplay: false };
const page = { frames: 0, firstThread_ms: null, latest, columns: COLUMNS, troubles: {} }; // for tests and the browser's console
window.ligature = page;

/** Calls `what`. An error is stored and printed on the console, and does not affect other parts. */
function attempt(name, what) {
  try { return what(); } catch (error) {
    if (page.troubles[name] !== error.message) console.warn(`${name}: ${error.message}`);
    page.troubles[name] = error.message;
    return undefined;
  }
}

const link = new Link(onFrame);
page.link = link;
window.ligatureGuard?.useLink(link);

let panels = null, waiting = [];

function onFrame(frame) {
  ++page.frames;
  attempt('words', () => { if (frame.text?.view) setNames(frame.text.view.names); });
  latest.now = frame.now;
  if (frame.rows) latest.row = frame.rows.subarray(-WIDTH);
  if (frame.now.epoch !== latest.epoch) { latest.epoch = frame.now.epoch; latest.row = frame.rows ? latest.row : null; }
  latest.unreadable = frame.text?.unreadable ?? latest.unreadable;
  if (frame.shape) { latest.shape = frame.shape; page.firstThread_ms ??= performance.now(); }
  showNow();
  attempt('view', () => { if (frame.text?.view) showView(frame.text.view); });
  attempt('status', () => showStatus(frame.text?.status));
  attempt('hands', () => showHands(latest.now, latest.row));
  if (panels) attempt('panels', () => panels.onFrame(frame));
  else if (waiting.push(frame) > MOST_WAITING) waiting.shift();
}

let heartbeat = performance.now(), lag_ms = 0, lagAt_ms = 0;

/** Called for each frame and by a timer: the state and its age must not wait for drawing. */
function showNow() {
  attempt('state', () => {
    if (latest.now) showState(latest.now);
    const isOld = showAge(latest.now?.age_ms ?? -1, link.silent_ms, lag_ms, latest);
    if (isOld && !page.isOld) page.staleAt_ms = Math.max(latest.now?.age_ms ?? 0, link.silent_ms);
    page.isOld = isOld;
    window.ligatureGuard?.beat();
  });
}

/**
 * Measures how late this page's timer is (largest delay of the last seconds). A large delay means a slow computer and
 * says nothing about the rig.
 */
function watch() {
  const now = performance.now(), late_ms = now - heartbeat - WATCH_MS;
  heartbeat = now;
  if (late_ms > lag_ms || now - lagAt_ms > LAG_KEPT_MS) { lag_ms = Math.max(0, late_ms); lagAt_ms = now; }
  page.lag_ms = lag_ms;
  showNow();
}
setInterval(watch, WATCH_MS);

function showView(view) {
  latest.isReplay = view.mode === 'replay';
  document.body.classList.toggle('is-replay', latest.isReplay);
  $('replay').hidden = !latest.isReplay;
  $('controls').hidden = latest.isReplay;
  document.title = latest.isReplay ? `${view.file} – Ligature` : 'Ligature';
  for (const button of $('controls').children) button.disabled = !view.may_command;
  if (!view.may_command && !latest.isReplay) $('controls').title = 'This view may only look';
}

attempt('buttons', () => setUpControls(link, () => latest.isReplay));

async function loadPanels(tries) {
  try {
    const { Panels } = await import(tries ? `./panels.js?try=${tries}` : './panels.js');
    panels = new Panels(page, link);
    document.querySelector('#scene > .part-note')?.remove();
    const missed = waiting;
    waiting = [];
    for (const frame of missed) attempt('panels', () => panels.onFrame(frame));
  } catch (error) {
    attempt('panels', () => { throw error; });
    const note = document.querySelector('#scene .part-note') ?? $('scene').appendChild(document.createElement('p'));
    note.className = 'part-note';
    note.textContent = `Pictures did not load: ${error.message}${tries ? '. Reload the page if this stays' : ''}. Next try in ${RETRY_MS / 1000} s. State and STOP work.`;
    setTimeout(loadPanels, RETRY_MS, tries + 1);
  }
}
loadPanels(0);
