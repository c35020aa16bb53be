// Checks of the page's layout, for the tests: nothing covers STOP, sticks out of its box, or overlaps.
import assert from 'node:assert/strict';

/** Checks, with each panel and dialog open at this page size, that STOP is not covered and nothing overflows. */
export async function fits(page, width, height) {
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
