// STOP works even if drawing fails: with WebGL and without it, and with each file of the page broken in each way, the
// page stops a rig in FORCE, and never shows a state that the rig is not in.
//   node stop_test.mjs --browser chromium|firefox --host BIN --python BIN --rig SCRIPT --page DIR --modules DIR --out DIR
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { Browser, Program, arguments_, until } from './support.mjs';
import { Saboteur, waysFor } from './saboteur.mjs';

const { host, python, rig: rigScript, out, page: pageFolder, browser: kind, parts = '' } = arguments_();
mkdirSync(out, { recursive: true });
const rig = new Program(python, [rigScript]);
await rig.says(/ready/);
const view = new Program(host, ['view', '--port', '0', '--recordings', out]);
const own = new URL(await view.says(/open (\S+)/));
const saboteur = await Saboteur.between(own.host);
const CORE = ['guard.js', 'main.js', 'link.js', 'frame.js', 'names.js', 'numbers.js', 'state_panel.js', 'controls.js'];
// The flat view, and what makes the parts of the page.
const DRAW_THE_THREAD = ['flat_view.js', 'colouring.js', 'scene_facts.js', 'throws.js', 'panels.js', 'part.js', 'part_list.js', 'trace_store.js'];
let failures = 0, cases = 0, arms = 0;

/** Opens the page on a rig in FORCE, checks its state display, and stops. @param file the broken file, or null. */
async function stops(browser, name, file, look) {
  ++cases;
  const began = Date.now(), mayNotKnow = CORE.includes(file), heard = rig.heard.length;
  const page = await browser.sheet();
  // Repeatedly, because a late second STOP of the previous page may disarm the rig again.
  const arming = setInterval(() => { ++arms; rig.tell('arm'); }, 500);
  try {
    await page.goto(saboteur.url);
    await shows(page, mayNotKnow ? ['FORCE', 'UNKNOWN'] : ['FORCE']);
    clearInterval(arming);
    await armed(); // a rig that obeys the last `arm` after STOP would be in FORCE again
    await look(page);
    const before = rig.heard.length;
    if (cases % 2) await page.keyboard.press('Space'); else await page.click('#stop');
    await says(() => /command stop/.test(rig.heard.slice(before)), 'STOP');
    assert.equal((rig.heard.slice(heard).match(/command (?!stop)\S+/g) ?? []).join(), '', 'nothing else was commanded');
    const said = await shows(page, mayNotKnow ? ['IDLE', 'UNKNOWN'] : ['IDLE']);
    console.log(`ok   ${name}: ${said} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
  } catch (error) {
    clearInterval(arming);
    ++failures;
    console.log(`FAIL ${name}\n${error.stack}`);
    await page.screenshot({ path: join(out, `failure-${kind}-${cases}.png`) }).catch(() => {});
  }
}

/** Waits until the page shows one of these states. @returns that state. */
async function shows(page, states) {
  await page.waitForFunction((wanted) => document.readyState === 'complete' && wanted.includes(document.getElementById('state-name').textContent), states);
  return page.evaluate(() => document.getElementById('state-name').textContent);
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

const isOurs = (name) => name.endsWith('.js') && (!parts || parts.split(',').includes(name));
for (const webgl of [false, true]) {
  const browser = await Browser.start({ kind, webgl });
  for (const [width, height] of webgl ? [[1400, 900], [900, 600]] : [[1400, 900], [1024, 768], [900, 600], [390, 844]]) {
    await browser.resize(width, height);
    await stops(browser, `${kind}, WebGL ${webgl ? 'on' : 'off'}, ${width}x${height}`, null, (page) => draws(page, webgl, `${kind}-${webgl ? 'webgl' : 'flat'}-${width}x${height}`));
  }
  // With WebGL only the files that draw with it; the others were tested without WebGL, which is faster.
  const files = webgl ? ['scene.js', 'tube.js', 'hands.js', 'three.module.js'] : [...readdirSync(pageFolder), 'uPlot.esm.js'];
  for (const file of files.filter(isOurs)) {
    // In Firefox, and for third-party files, one way of breaking a file is enough.
    const ways = kind === 'firefox' || file.includes('three') || file.includes('uPlot') ? ['load'] : waysFor(readFileSync(join(pageFolder, file), 'utf8'));
    for (const way of ways) {
      saboteur.breaks(file, way);
      await stops(browser, `${file} throws, ${way}`, file, (page) => tells(page, file, webgl));
    }
  }
  saboteur.breaks(null);
  await browser.stop();
}

/** Checks that thread and traces are drawn, and that no part reports an error except the one that needs WebGL. */
async function draws(page, webgl, name) {
  await until(page, () => window.ligature?.traces && ligature.store.rowEnd > 500 && ligature.scene?.shape);
  await page.waitForFunction((id) => document.getElementById(id)?.width > 100, webgl ? 'canvas' : 'flat');
  rig.tell('knot');
  await until(page, () => document.getElementById('knot-name').dataset.type === '3_1');
  await page.waitForFunction((n) => ligature.draws > n + 5, await page.evaluate(() => ligature.draws));
  const notes = await page.evaluate(() => [...document.querySelectorAll('.part-note:not([hidden])')].map((n) => n.dataset.part));
  assert.deepEqual(notes, webgl ? [] : ['3-D view']);
  if (!webgl) assert.ok(await page.evaluate(inked) > 200, 'the thread is seen in the flat view');
  await page.evaluate(() => document.getElementById('help').close());
  await page.click('#help-open');
  assert.equal(await page.evaluate(() => document.getElementById('help').scrollTop), 0, 'the help opens at its head');
  await page.evaluate(() => document.getElementById('help').close());
  const { width, height } = page.viewportSize();
  await fits(page, width, height);
  await page.screenshot({ path: join(out, `${name}.png`) });
  await page.evaluate(() => document.getElementById('help').show()); // STOP stays reachable beside the dialog
  rig.tell('unknot');
}

/** Checks, with each panel and dialog open at this page size, that STOP is not covered and nothing overflows. */
async function fits(page, width, height) {
  for (const open of ['', 'change', 'exercise', 'tools', 'help', 'record-dialog', 'hand-panel']) {
    await page.evaluate((id) => {
      for (const box of document.querySelectorAll('dialog[open]')) box.close();
      for (const panel of ['change', 'exercise', 'hand-panel']) document.getElementById(panel).hidden = id !== panel;
      document.getElementById('tools').classList.toggle('is-open', id === 'tools');
      document.getElementById(id)?.show?.();
      for (const side of ['left', 'right']) Object.assign(document.getElementById(`jaws-${side}`), { hidden: false, textContent: `${side} jaws: close` });
    }, open);
    const found = await page.evaluate(outside);
    assert.deepEqual(found, [], `${width}x${height} with ${open || 'nothing'} open`);
  }
  await page.evaluate(() => { document.getElementById('hand-panel').hidden = true; });
}

/** @returns what covers STOP, what is wider than the page, and what overflows its box. */
function outside() {
  const wrong = [], box = (e) => e.getBoundingClientRect(), name = (e) => e.id || e.className || e.tagName;
  const stop = document.getElementById('stop'), r = box(stop);
  for (const [x, y] of [[0.1, 0.2], [0.5, 0.5], [0.9, 0.8]]) {
    const top = document.elementFromPoint(r.left + x * r.width, r.top + y * r.height);
    if (!stop.contains(top)) wrong.push(`STOP is under ${top ? name(top) : 'nothing: outside the window'}`);
  }
  if (document.documentElement.scrollWidth > innerWidth) wrong.push(`${document.documentElement.scrollWidth - innerWidth} px too wide`);
  for (const panel of document.querySelectorAll('header, .scene, .traces, .change, dialog, .trace-tools')) {
    const p = box(panel);
    if (!p.width) continue;
    for (const e of panel.querySelectorAll('button, input, select, label, h2, .overlay')) {
      const b = box(e);
      if (b.width && (b.left < p.left - 1 || b.right > p.right + 1)) wrong.push(`${name(e)} (${e.textContent.slice(0, 20)}) sticks out of ${name(panel)}`);
    }
  }
  document.getElementById('scene-file').textContent = 'suture-3-0-knot.toml, firmware 0.1.0'; // as long as a shipped one
  for (const e of document.querySelectorAll('#facts, #state-name, #state-note')) if (e.scrollHeight > e.clientHeight + 1 && getComputedStyle(e).overflow === 'hidden') wrong.push(`${name(e)} is cut off below`);
  const ink = document.createElement('canvas').getContext('2d');
  for (const e of document.querySelectorAll('.change input[placeholder], .change select')) {
    const style = getComputedStyle(e), room = e.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight) - (e.options ? 20 : 0); // a list has its arrow
    ink.font = `${style.fontSize} ${style.fontFamily}`;
    const text = e.placeholder ?? e.selectedOptions[0]?.text ?? '', wide = ink.measureText(text).width;
    if (box(e).width && wide > room + 1) wrong.push(`${name(e)}: '${text}' has ${Math.round(wide)} px in ${Math.round(room)}`);
  }
  const overlays = ['.top-left', '.top-right', '.hands', '.corner'].map((s) => document.querySelector(s));
  overlays.forEach((a, i) => overlays.slice(i + 1).forEach((b) => {
    const [p, q] = [box(a), box(b)];
    if (p.width && q.width && p.left < q.right - 1 && q.left < p.right - 1 && p.top < q.bottom - 1 && q.top < p.bottom - 1) wrong.push(`${name(a)} and ${name(b)} overlap`);
  }));
  return wrong;
}

/** Waits until the flat view shows the thread. */
async function isDrawn(page) {
  for (const until_ms = Date.now() + 60_000; await page.evaluate(inked) <= 200;) {
    if (Date.now() > until_ms) throw new Error('the thread is not drawn in the flat view');
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
}

/** Number of pixels of the flat view with about the thread's colour. */
function inked() {
  const canvas = document.getElementById('flat');
  if (!canvas?.width || !canvas.height) return 0;
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) if (data[i] > 200 && data[i + 1] > 150 && data[i + 2] < 200 && data[i] > data[i + 2] + 40) ++count;
  return count;
}

/** Checks that an error is shown and, without WebGL, that the thread is still drawn unless the broken file draws it. */
async function tells(page, file, webgl) {
  if (CORE.includes(file)) return;
  if (!webgl && !DRAW_THE_THREAD.includes(file)) await isDrawn(page);
  await until(page, () => document.querySelector('.part-note:not([hidden])') || Object.keys(window.ligature?.troubles ?? {}).length);
}

console.log(`${cases} cases, ${failures} failures`);
saboteur.stop();
await view.stop();
await rig.stop();
process.exitCode = failures ? 1 : 0;
