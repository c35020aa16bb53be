// The parts of the page: where each shows its failure, and which data it gets. Each is a module of its own, loaded when
// it is made.
import { exact, three } from './numbers.js';

const $ = (id) => document.getElementById(id);
const HANDS_MS = 100, DIAGRAM_MS = 200, TRACES_MS = 50, LONG_TRACES_MS = 200, LONG_WINDOW_S = 10;

const load = (file, attempt) => import(`./${file}${attempt ? `?try=${attempt}` : ''}`);

/** @param panels shared by the parts: the trace stores, the host's data and the user's choices. */
export function allParts(panels) {
  return { ...pictures(panels), ...knots(panels), ...plots(panels), ...tools(panels), ...hands(panels) };
}

function pictures(panels) {
  const { latest, choice } = panels;
  const isWanted = (key) => key === 'scene' || !panels.parts.scene.value; // the flat view is used while there is no 3-D view
  const picture = (key, name, file, className) => ({
    name, place: () => $('scene-notes'),
    make: async (attempt) => new (await load(file, attempt))[className]($('scene'), choice, (why) => panels.parts[key].fail(new Error(why))),
    dispose: (value) => value?.dispose(),
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
  let due = 0;
  panels.hurryTraces = () => { due = 0; };
  return {
    traces: {
      name: 'traces', place: () => $('trace-notes'),
      make: async (attempt) => {
        const { Traces, describeRow } = await load('traces.js', attempt);
        const traces = new Traces($('plots'), panels.store, panels.beside, panels.choice, (row) => {
          const said = (digits) => describeRow(row, traces.period_s, traces.third, traces.besideRow(row), digits);
          $('cursor').textContent = said(three);
          $('cursor').dataset.exact = said(exact);
          $('cursor').dataset.row = row ? JSON.stringify([...row].map((v) => (Object.is(v, -0) ? '-0' : v))) : ''; // JSON has no -0
        });
        panels.hurryTraces();
        return traces;
      },
      dispose: (value) => value?.dispose(),
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
        panels.parts.histogram.run((histogram) => histogram.draw(panels.store, value.histogramFrom, panels.period_s));
        due = time + (value.window_s <= LONG_WINDOW_S ? TRACES_MS : LONG_TRACES_MS); // long windows move slowly and are drawn less often
      },
    },
    histogram: {
      name: 'wake-up latency', place: () => $('trace-notes'),
      make: async (attempt) => new (await load('histogram.js', attempt)).Histogram($('plots'), panels.hurryTraces),
      dispose: (value) => value?.dispose(),
    },
  };
}

function tools(panels) {
  const { link, latest } = panels;
  const part = (name, file, make, more = {}) => ({ name, place: () => $('banner-notes'), make: async (attempt) => make(await load(file, attempt)), ...more });
  return {
    sceneTools: part('view buttons', 'scene_tools.js', ({ SceneTools }) => new SceneTools(panels)),
    traceTools: part('trace buttons', 'trace_tools.js', ({ TraceTools }) => new TraceTools(panels)),
    replay: part('replay bar', 'replay_bar.js', ({ ReplayBar }) => new ReplayBar(link), {
      text: (value, { view, replay, marks, compare }) => {
        if (view?.mode === 'replay') value.showFile(view.file);
        if (replay) value.update(replay);
        if (marks) value.setMarks(marks);
        if (compare) value.setCompare(compare);
      },
    }),
    change: part('scene and parameters', 'change_panel.js', (module) => { module.setUpChange(link); return module; }, { text: (value, { offer }) => { if (offer) value.showOffer(offer); } }),
    recording: part('recording', 'recording.js', (module) => { module.setUpRecording(link); return module; }, { text: (value, { recording }) => { if (recording) value.showRecording(recording); } }),
    events: part('events', 'events.js', (module) => module, { text: (value) => value.showEvents(panels.events, panels.period_s) }),
    saving: part('saving', 'saving.js', ({ Saving }) => new Saving(panels), { dispose: (value) => value?.dispose(), draw: (value, time) => value.draw(time) }),
    copying: part('copying', 'copying.js', ({ setUpCopying }) => setUpCopying(() => $('cursor').dataset.exact ?? ''), { dispose: (end) => end?.() }),
    exercise: exercise(panels, part),
    help: part('help', 'help.js', ({ Help }) => new Help(() => latest.isReplay)),
  };
}

function exercise(panels, part) {
  let due = 0;
  return part('exercise', 'exercise.js', ({ Exercise }) => new Exercise(panels), {
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
      make: async (attempt) => new (await load('hand_control.js', attempt)).HandControl({ link, latest, panels, run: (use) => panels.parts.hands.run(use), fail: (error) => panels.parts.hands.fail(error) }),
      dispose: (value) => value?.dispose(),
      text: (value, { status }) => { if (status) maxForce_N = status.max_force_N; },
      draw: (value, time) => { if (time >= due) { due = time + HANDS_MS; value.show(maxForce_N); } },
    },
  };
}
