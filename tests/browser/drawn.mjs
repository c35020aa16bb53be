// What a sound page draws, for the tests: looked for in the pixels of its canvases and the text of its panels.
const PATIENCE_MS = 60_000, EVERY_MS = 100;

/** Waits until the page draws everything: the thread (3-D, or flat without WebGL), traces, histogram, knot, panels. */
export async function isSound(page, webgl) {
  let wrong = [];
  for (const until_ms = Date.now() + PATIENCE_MS; Date.now() < until_ms; await new Promise((resolve) => setTimeout(resolve, EVERY_MS))) {
    wrong = await page.evaluate(missing, webgl);
    if (!wrong.length) return;
  }
  throw new Error(`never drawn: ${wrong.join('; ')}`);
}

/** Waits until the thread is drawn in two dimensions. */
export function isDrawnFlat(page) { return page.waitForFunction(() => ligature.panels?.parts.flat.value && !document.getElementById('flat')?.hidden).then(() => inkOf(page)); }

async function inkOf(page) {
  for (const until_ms = Date.now() + PATIENCE_MS; (await page.evaluate(missing, false)).includes('the thread');) {
    if (Date.now() > until_ms) throw new Error('the thread is not drawn in the flat view');
    await new Promise((resolve) => setTimeout(resolve, EVERY_MS));
  }
}

/** Runs in the page: removes what the parts have written, so that only a part that works again can write it. */
export function erase() {
  for (const id of ['knot-name', 'knot-note', 'events']) document.getElementById(id).replaceChildren();
  document.getElementById('scale-bar').hidden = true;
  const diagram = document.getElementById('knot-diagram');
  diagram.getContext('2d').clearRect(0, 0, diagram.width, diagram.height);
}

/** Runs in the page: gives each part that works what the host has told so far. */
export function tellAgain() {
  try { for (const part of Object.values(ligature.panels.parts)) part.text(ligature.panels.told); } catch { /* part.js is broken */ }
}

/** Runs in the page. @returns the names of what is neither drawn nor written. */
function missing(webgl) {
  const $ = (id) => document.getElementById(id), page = window.ligature, parts = page?.panels?.parts, wrong = [];
  if (!parts) return ['the thread', 'all parts'];
  const ink = (canvas, isInk) => {
    if (!canvas?.width || !canvas.height || canvas.hidden) return 0;
    const small = Object.assign(document.createElement('canvas'), { width: 450, height: 300 }), context = small.getContext('2d', { willReadFrequently: true });
    context.drawImage(canvas, 0, 0, small.width, small.height);
    const { data } = context.getImageData(0, 0, small.width, small.height);
    let count = 0;
    for (let i = 0; i < data.length; i += 4) if (isInk(data[i], data[i + 1], data[i + 2], data[i + 3])) ++count;
    return count;
  };
  const isThread = (r, g, b) => r > 120 && g > 0.75 * r && b < 0.88 * g; // neither the orange hand, nor white or blue
  const isOpaque = (r, g, b, a) => a > 60;
  const expect = (name, isThere) => { if (!isThere) wrong.push(name); };
  if (webgl) parts.scene.value?.drawNow(); // WebGL keeps a picture only until it has been shown
  expect('the thread', ink($(webgl ? 'canvas' : 'flat'), isThread) > 60);
  for (const { what, value } of Object.values(parts)) expect(what.name, value || (!webgl && what.name === '3-D view'));
  for (const note of document.querySelectorAll('.part-note:not([hidden])')) expect(note.textContent, !webgl && note.dataset.part === '3-D view');
  const plots = [...document.querySelectorAll('#plots canvas')];
  expect('four plots', plots.length === 4 && plots.every((canvas) => ink(canvas, isOpaque) > 100));
  expect('drawing of the knot', ink($('knot-diagram'), isOpaque) > 100);
  expect('name of the knot', $('knot-name').textContent === '31');
  expect('one picture', document.querySelectorAll('.scene > canvas.picture:not([hidden])').length === 1);
  expect('scale bar', !$('scale-bar').hidden);
  expect('events', $('events').children.length);
  expect('windows', $('windows').children.length === 8);
  expect('each parameter once', $('parameters').children.length === (page.panels.told.offer?.parameters.length ?? -1));
  expect('throws', $('throws').children.length <= 1);
  return wrong;
}
