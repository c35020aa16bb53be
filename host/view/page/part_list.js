// The parts of the page: where each shows its failure, and which data it gets. Each is a module of its own, loaded when
// it is made.
import { exact, three } from './numbers.js';

const $ = (id) => document.getElementById(id);
const HANDS_MS = 100, DIAGRAM_MS = 200, TRACES_MS = 50, LONG_TRACES_MS = 200, LONG_WINDOW_S = 10, HISTOGRAM_S = 60;

/**
 * Loads a part's module. A browser never loads a failed module again, and a new address helps only this file and not the
 * files that it imports. If one of those failed, only a reload of the page helps.
 */
async function load(file, attempt) {
  if (!attempt) return import(`./${file}`);
  return import(`./${file}?try=${attempt}`).catch((error) => { throw new Error(`${error.message}. Reload the page if this stays`); });
}

/** @param panels shared by the parts: the trace stores, the host's data and the user's choices. */
export function allParts(panels) {
  return { ...pictures(panels), ...knots(panels), ...plots(panels), ...tools(panels), ...hands(panels) };
}

function pictures(panels) {
  const { latest, choice } = panels;
  const isWanted = (key) => key === 'scene' || !panels.parts.scene.value; // the flat view is used while there is no 3-D view
  const picture = (key, name, file, className) => ({
    name, place: () => $('scene-notes'),
    make: async (attempt, signal) => new (await load(file, attempt))[className]($('scene'), choice, (why) => panels.parts[key].fail(new Error(why)), signal),
    text: (value, { status, scene }) => {
      if (status) value.setForce(status.max_force_N);
      if (scene !== undefined) value.setFacts(scene);
    },
    update: (value) => {
      if (!isWanted(key)) return;
      const legend = value.update(latest.shape, latest.now, latest.knot); // not inside run(): each part fails for itself
      panels.parts.sceneTools.run((t) => t.showLegend(legend));
    },
    draw: (value, time) => {
      value.show(isWanted(key));
      if (!isWanted(key)) return;
      value.draw(time);
      panels.parts.sceneTools.run((t) => t.showScale(latest.shape ? value.metresPerPixel : 0));
    },
  });
  return { scene: picture('scene', '3-D view', 'scene.js', 'Scene'), flat: picture('flat', 'flat view', 'flat_view.js', 'FlatView') };
}

function knots(panels) {
  const { latest, page } = panels;
  let due = 0;
  return {
    knot: {
      name: 'name of the knot', place: () => $('scene-notes'),
      make: async (attempt) => new (await load('knot_panel.js', attempt)).KnotPanel(),
      forget: (value) => value.clear(),
      text: (value, { knot }) => { if (knot) showKnot(panels, value, knot); },
    },
    diagram: {
      name: 'drawing of the knot', place: () => $('scene-notes'),
      make: (attempt) => load('knot_diagram.js', attempt),
      dispose: () => { $('knot-diagram').hidden = true; },
      draw: (value, time) => {
        const camera = panels.picture?.camera;
        if (time < due || !latest.shape || !camera) return;
        due = time + DIAGRAM_MS;
        page.crossings = value.drawDiagram($('knot-diagram'), latest.shape.p_W, latest.knot?.core, camera);
      },
    },
  };
}

/** Updates the knot panel. In a recording: not during a jump, and with the earlier knots on the strip. */
function showKnot(panels, value, knot) {
  const { latest } = panels, period_s = panels.period_s;
  if (latest.isReplay && Math.abs(latest.now.tick - knot.tick) * period_s > 1) return; // belongs to the time before the jump; the next one follows soon
  const earlier = latest.isReplay && panels.parts.replay.run((bar) => bar.knotsUntil(knot.tick, period_s));
  if (earlier) value.seed(earlier);
  value.update(knot, period_s);
}

function plots(panels) {
  let due = 0, histogramDue = 0;
  panels.hurryTraces = () => { due = histogramDue = 0; };
  return {
    traces: {
      name: 'traces', place: () => $('trace-notes'),
      make: async (attempt, signal) => {
        const { Traces, describeRow } = await load('traces.js', attempt);
        const traces = new Traces($('plots'), panels.store, panels.beside, panels.choice, (row) => {
          const said = (digits) => describeRow(row, traces.period_s, traces.third, traces.besideRow(row), digits);
          $('cursor').textContent = said(three);
          $('cursor').dataset.exact = said(exact);
          $('cursor').dataset.row = row ? JSON.stringify([...row].map((v) => (Object.is(v, -0) ? '-0' : v))) : ''; // JSON has no -0
        }, signal);
        panels.hurryTraces();
        return traces;
      },
      forget: (value) => { if (value.isPaused) panels.parts.traceTools.run((t) => t.togglePause()); },
      text: (value, { status, compare, marks, replay }) => {
        if (marks) value.marks = marks;
        if (replay) value.replay = replay;
        if (status) Object.assign(value, { period_s: status.period_s, limit_N: status.max_force_N });
        if (compare) { value.compareWith(compare); panels.hurryTraces(); }
      },
      draw: (value, time) => {
        if (time < due) return;
        value.draw();
        due = time + (value.window_s <= LONG_WINDOW_S ? TRACES_MS : LONG_TRACES_MS); // long windows move slowly and are drawn less often
      },
    },
    histogram: {
      name: 'wake-up latency', place: () => $('trace-notes'),
      make: async (attempt, signal) => new (await load('histogram.js', attempt)).Histogram($('plots'), panels.hurryTraces, signal),
      draw: (value, time) => {
        if (time < histogramDue) return;
        histogramDue = time + TRACES_MS;
        const last_60_s = (panels.store.lastTick ?? 0) + 1 - HISTOGRAM_S / panels.period_s;
        value.draw(panels.store, panels.parts.traces.value?.histogramFrom ?? last_60_s, panels.period_s);
      },
    },
  };
}

function tools(panels) {
  const { link } = panels;
  const part = (name, file, make, more = {}) => ({ name, place: () => $('banner-notes'), make: async (attempt, signal) => make(await load(file, attempt), signal), ...more });
  return {
    sceneTools: part('view buttons', 'scene_tools.js', ({ SceneTools }, signal) => new SceneTools(panels, signal)),
    traceTools: part('trace buttons', 'trace_tools.js', ({ TraceTools }, signal) => new TraceTools(panels, signal)),
    replay: part('replay bar', 'replay_bar.js', ({ ReplayBar }, signal) => new ReplayBar(link, signal), {
      text: (value, { view, replay, marks, compare }) => {
        if (view?.mode === 'replay') value.showFile(view.file);
        if (replay) value.update(replay);
        if (marks) value.setMarks(marks);
        if (compare) value.setCompare(compare);
      },
    }),
    change: part('scene and parameters', 'change_panel.js', (module, signal) => { module.setUpChange(link, signal); return module; }, { text: (value, { offer }) => { if (offer) value.showOffer(offer); } }),
    recording: part('recording', 'recording.js', (module, signal) => { module.setUpRecording(link, signal); return module; }, { text: (value, { recording }) => { if (recording) value.showRecording(recording); } }),
    events: part('events', 'events.js', (module) => module, { text: (value) => value.showEvents(panels.events, panels.period_s) }),
    saving: part('saving', 'saving.js', ({ Saving }, signal) => new Saving(panels, signal), { dispose: (value) => value?.dispose(), draw: (value, time) => value.draw(time) }),
    copying: part('copying', 'copying.js', ({ setUpCopying }) => setUpCopying(() => $('cursor').dataset.exact ?? ''), { dispose: (end) => end?.() }),
    exercise: exercise(panels, part),
    help: part('help', 'help.js', ({ Help }, signal) => new Help(signal)),
  };
}

function exercise(panels, part) {
  let due = 0;
  return part('exercise', 'exercise.js', ({ Exercise }, signal) => new Exercise(panels, signal), {
    dispose: (value) => value?.dispose(),
    forget: (value) => value.forget(),
    draw: (value, time) => { if (time >= due) { due = time + HANDS_MS; value.show(); } },
  });
}

function hands(panels) {
  const { link, latest } = panels;
  let due = 0, maxForce_N = 3.3;
  return {
    hands: {
      name: 'moving hands', place: () => $('scene-notes'),
      make: async (attempt, signal) => new (await load('hand_control.js', attempt)).HandControl({ link, latest, panels, run: (use) => panels.parts.hands.run(use), fail: (error) => panels.parts.hands.fail(error), signal }),
      dispose: (value) => value?.dispose(),
      text: (value, { status }) => { if (status) maxForce_N = status.max_force_N; },
      draw: (value, time) => { if (time >= due) { due = time + HANDS_MS; value.show(maxForce_N); } },
    },
  };
}
