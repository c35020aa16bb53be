// STOP works even if drawing fails: with WebGL and without it, with each file of the page broken in each way, and after
// the browser has taken WebGL away, the page stops a rig in FORCE and never shows a state that the rig is not in. When
// the cause of a failure is gone, the page draws everything again by itself.
//   node stop_test.mjs --browser chromium|firefox --host BIN --python BIN --rig SCRIPT --page DIR --modules DIR --out DIR
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { Browser, Program, arguments_, until } from './support.mjs';
import { Saboteur, canRun } from './saboteur.mjs';
import { erase, isDrawnFlat, isSound, tellAgain } from './drawn.mjs';
import { fits } from './layout.mjs';

const { host, python, rig: rigScript, out, page: pageFolder, browser: kind, parts = '' } = arguments_();
mkdirSync(out, { recursive: true });
const rig = new Program(python, [rigScript]);
await rig.says(/ready/);
const view = new Program(host, ['view', '--port', '0', '--recordings', out]);
const own = new URL(await view.says(/open (\S+)/));
const saboteur = await Saboteur.between(own.host);

const texts = Object.fromEntries(readdirSync(pageFolder).filter((name) => name.endsWith('.js')).map((name) => [name, readFileSync(join(pageFolder, name), 'utf8')]));
const LIBRARIES = ['uPlot.esm.js', 'three.module.js', 'OrbitControls.js'];
const CORE = ['guard.js', 'main.js', 'link.js', 'frame.js', 'names.js', 'numbers.js', 'state_panel.js', 'controls.js'];
const NEEDS_WEBGL = ['tube.js', 'hands.js', 'throw_views.js', 'throws.js', 'three.module.js', 'OrbitControls.js'];
// The flat view, and what makes the parts of the page.
const DRAW_THE_THREAD = ['flat_view.js', 'colouring.js', 'scene_facts.js', 'throws.js', 'panels.js', 'part.js', 'part_list.js', 'trace_store.js'];
// With WebGL only these are broken while the page runs: they draw. There each case takes longer.
const DRAWS = [...NEEDS_WEBGL, 'scene.js', 'scene_tools.js', 'flat_view.js', 'colouring.js', 'round_length.js', 'knot_diagram.js', 'traces.js', 'histogram.js', 'uPlot.esm.js'];
// Called only by a click or a key, or in a recording: in a page that merely draws they can only fail to load, or, the
// second list, to start.
const ONLY_WHEN_USED = ['OrbitControls.js', 'caption.js', 'csv.js', 'recordings_list.js', 'whole_run.js'];
const ONLY_AT_START = ['controls.js', 'copying.js', 'hand_mouse.js', 'hand_wisher.js', 'help.js', 'part_list.js', 'replay_bar.js', 'trace_tools.js'];
const files = [...Object.keys(texts), ...LIBRARIES].filter((name) => !parts || parts.split(',').includes(name));
const runs = (file) => LIBRARIES.includes(file) || canRun(texts[file]);
/** Whether another file imports this one: a browser does not load it again, whatever the part does. */
const isImported = (file) => LIBRARIES.includes(file) || Object.values(texts).some((text) => text.includes(`from './${file}'`));
let failures = 0, cases = 0, arms = 0;

/**
 * Checks with the rig in FORCE that the page says so, and that it stops the rig. @param file the broken file, or null.
 * @param opens whether the page is opened first. @param look called in FORCE. @param after called after STOP.
 */
async function stops(browser, name, { file = null, opens = true, look, after = () => {} }) {
  ++cases;
  const began = Date.now(), mayNotKnow = CORE.includes(file), heard = rig.heard.length, page = await browser.sheet();
  const arm = () => { ++arms; rig.tell('arm'); };
  arm();
  const arming = setInterval(arm, 500); // repeatedly: a late second STOP of the previous page may disarm the rig again
  try {
    if (opens) await page.goto(saboteur.url);
    await shows(page, mayNotKnow && saboteur.broken ? ['FORCE', 'UNKNOWN'] : ['FORCE']);
    clearInterval(arming);
    await armed(); // a rig that obeys the last `arm` after STOP would be in FORCE again
    await look(page);
    const before = rig.heard.length;
    if (cases % 2) await page.keyboard.press('Space'); else await page.click('#stop');
    await says(() => /command stop/.test(rig.heard.slice(before)), 'STOP');
    assert.equal((rig.heard.slice(heard).match(/command (?!stop)\S+/g) ?? []).join(), '', 'nothing else was commanded');
    const said = await shows(page, mayNotKnow ? ['IDLE', 'UNKNOWN', 'OLD'] : ['IDLE']);
    await after(page);
    console.log(`ok   ${name}: ${said} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
    return true;
  } catch (error) {
    clearInterval(arming);
    ++failures;
    console.log(`FAIL ${name}\n${error.stack}`);
    await page.screenshot({ path: join(out, `failure-${kind}-${cases}.png`) }).catch(() => {});
    return false;
  }
}

/** Waits until the page shows one of these states; `OLD`: any, marked as old. @returns that state. */
async function shows(page, states) {
  await page.waitForFunction((wanted) => document.readyState === 'complete'
    && (wanted.includes(document.getElementById('state-name').textContent) || (wanted.includes('OLD') && !document.getElementById('stale').hidden)), states);
  return page.evaluate(() => `${document.getElementById('state-name').textContent}${document.getElementById('stale').hidden ? '' : ', old'}`);
}

/** Waits until the rig has obeyed every `arm` told so far. */
const armed = () => says(() => (rig.heard.match(/^armed$/gm) ?? []).length >= arms, 'each arm');

async function says(isHeard, what) {
  const until_ms = Date.now() + 60_000;
  while (!isHeard()) {
    if (Date.now() > until_ms) throw new Error(`the rig never heard ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 10));
  }
}

/** A sound page at each size. */
async function sizes(browser, webgl) {
  for (const [width, height] of webgl ? [[1400, 900], [900, 600]] : [[1400, 900], [1024, 768], [390, 844], [900, 600]]) {
    await browser.resize(width, height);
    const look = (page) => draws(page, webgl, `${kind}-${webgl ? 'webgl' : 'flat'}-${width}x${height}`);
    await stops(browser, `${kind}, WebGL ${webgl ? 'on' : 'off'}, ${width}x${height}`, { look });
  }
}

/** Checks that everything is drawn, and that the page's layout is right with each panel open. */
async function draws(page, webgl, name) {
  await isSound(page, webgl);
  await page.waitForFunction((n) => ligature.draws > n + 5, await page.evaluate(() => ligature.draws));
  await page.evaluate(() => document.getElementById('help').close());
  await page.click('#help-open');
  assert.equal(await page.evaluate(() => document.getElementById('help').scrollTop), 0, 'the help opens at its head');
  await page.evaluate(() => document.getElementById('help').close());
  const { width, height } = page.viewportSize();
  await fits(page, width, height);
  await page.screenshot({ path: join(out, `${name}.png`) });
  await page.evaluate(() => document.getElementById('help').show()); // STOP stays reachable beside the dialog
}

/** Pages that are opened with one file broken, which is healed after STOP. */
async function brokenFromTheStart(browser, webgl) {
  // With WebGL only the files that draw with it; the others were tested without WebGL, which is faster.
  for (const file of files.filter((name) => !webgl || name === 'scene.js' || NEEDS_WEBGL.includes(name))) {
    // What throws when it is called is broken below, except what is called only at the start, and STOP's own files.
    for (const way of runs(file) && [...CORE, ...ONLY_AT_START].includes(file) ? ['load', 'make'] : ['load']) {
      saboteur.breaks(file, way);
      const after = (page) => (way === 'load' && isImported(file) ? asksForReload(page, file) : recovers(page, file, webgl));
      await stops(browser, `${file} throws, ${way}`, { file, look: (page) => tells(page, file, webgl), after });
    }
  }
}

/** A page that draws, in which one file after the other throws for a while. */
async function brokenWhileRunning(browser, webgl) {
  const page = await browser.sheet();
  let opens = true;
  saboteur.wrapsAll = true;
  const isCalled = (name) => runs(name) && ![...ONLY_WHEN_USED, ...ONLY_AT_START].includes(name);
  for (const file of files.filter((name) => isCalled(name) && (webgl ? DRAWS.includes(name) : !NEEDS_WEBGL.includes(name)))) {
    const isNew = opens, look = async () => {
      if (isNew) await isSound(page, webgl);
      await page.evaluate(erase);
      await saboteur.breakNow(page, file);
      await page.evaluate(tellAgain);
      await until(page, () => window.sabotaged > 0);
      await tells(page, file, webgl);
      if (file === 'exercise.js') await waitsLonger(page);
    };
    const isWell = await stops(browser, `${file} throws while running`, { file, opens, look, after: () => recovers(page, file, webgl) });
    opens = !isWell || [...CORE, 'part.js'].includes(file); // a page does not get over a lost connection, or a try that could not begin
  }
  if (!opens) await actsOnce(page);
  saboteur.wrapsAll = false;
}

/** Checks that a broken file is told and, without WebGL, that the thread is still drawn unless the file draws it. */
async function tells(page, file, webgl) {
  if (CORE.includes(file)) return;
  if (!webgl && !DRAW_THE_THREAD.includes(file)) await isDrawnFlat(page);
  await until(page, () => [...[...document.querySelectorAll('.part-note:not([hidden])')].map((note) => note.textContent), ...Object.values(window.ligature?.troubles ?? {})]
    .some((text) => /sabotage of|did not load/.test(text)));
}

/** Checks that the waits of a part grow that had worked for long and now cannot be made again. */
async function waitsLonger(page) {
  await page.evaluate(() => { ligature.panels.parts.exercise.made_ms = -1e6; });
  await until(page, () => /^exercise: .* Next try in (4|8|16|32) s/.test(ligature.panels.parts.exercise.note.textContent));
}

/** Heals the file, and waits until the page draws everything again. */
async function recovers(page, file, webgl) {
  await saboteur.heal(page);
  if (CORE.includes(file)) return;
  await page.evaluate(tellAgain);
  await isSound(page, webgl);
  await page.evaluate(() => { for (const name of Object.keys(ligature.troubles)) delete ligature.troubles[name]; });
}

/** A file that failed to load and that another one imports: the page asks its user to reload it. */
async function asksForReload(page, file) {
  await saboteur.heal(page);
  if (!CORE.includes(file)) await until(page, () => [...document.querySelectorAll('.part-note:not([hidden])')].some((note) => note.textContent.includes('Reload the page')));
}

/** Checks that no part which was started again listens twice: each switch changes once. */
async function actsOnce(page) {
  const click = (id) => page.evaluate((it) => document.getElementById(it).click(), id), key = (it) => () => page.keyboard.press(it);
  await page.evaluate(() => document.getElementById('help').close()); // keys do nothing while a dialog is open
  for (const [name, act, isOn] of [
    ['scene and parameters', () => click('change-open'), () => !document.getElementById('change').hidden],
    ['exercise', () => click('exercise-open'), () => !document.getElementById('exercise').hidden],
    ['pause', () => click('pause'), () => document.getElementById('pause').textContent === 'Run'],
    ['key P', key('p'), () => document.getElementById('pause').textContent === 'Run'],
    ['key K', key('k'), () => document.getElementById('follow').checked],
    ['key C', key('c'), () => !document.getElementById('change').hidden],
  ]) {
    ++cases;
    const seen = [];
    for (let i = 0; i < 2; ++i) { await act(); seen.push(await page.evaluate(isOn)); }
    if (seen.join() === 'true,false') continue;
    ++failures;
    console.log(`FAIL ${name}: pressed twice, it is ${seen.join(', then ')}`);
  }
}

/** The browser takes WebGL away and for a time gives no other; then it gives it back. */
async function losesWebGL(browser) {
  const look = async (page) => {
    await isSound(page, true);
    await page.evaluate(lose);
    await until(page, () => [...document.querySelectorAll('.part-note:not([hidden])')].some((note) => note.dataset.part === '3-D view'));
    await isDrawnFlat(page);
    await page.screenshot({ path: join(out, `${kind}-lost.png`) });
  };
  const after = async (page) => {
    await page.evaluate(() => window.giveBack());
    await isSound(page, true);
    assert.ok(await page.evaluate(() => ligature.panels.parts.scene.attempt > 1 && !ligature.scene.renderer.getContext().isContextLost()));
  };
  await stops(browser, `${kind} takes WebGL away`, { look, after });
}

/** Runs in the page: loses the context of its 3-D view. */
function lose() {
  const { getContext } = HTMLCanvasElement.prototype, lost = ligature.scene.renderer.getContext().getExtension('WEBGL_lose_context');
  HTMLCanvasElement.prototype.getContext = function none(type, ...more) { return type === 'webgl2' ? null : getContext.call(this, type, ...more); };
  window.giveBack = () => {
    HTMLCanvasElement.prototype.getContext = getContext;
    lost.restoreContext();
  };
  lost.loseContext();
}

rig.tell('knot');
for (const webgl of [false, true]) {
  const browser = await Browser.start({ kind, webgl });
  await sizes(browser, webgl);
  if (webgl) await losesWebGL(browser);
  await brokenFromTheStart(browser, webgl);
  saboteur.breaks(null);
  await brokenWhileRunning(browser, webgl);
  await browser.stop();
}
console.log(`${cases} cases, ${failures} failures`);
saboteur.stop();
await view.stop();
await rig.stop();
process.exitCode = failures ? 1 : 0;
