// Tests of what the page offers besides the picture and the traces, with a fake rig: numbers and their copies, undo, the
// exercise, saved files, recordings, throws, and the facts of the scene as it runs.
//   node tools_test.mjs [--browser firefox] [--webgl off] --host BIN --python BIN --rig SCRIPT --modules DIR --out DIR     (inside scripts/private-net)
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync, statSync } from 'node:fs';
import { join } from 'node:path';
import { Browser, Program, arguments_, until } from './support.mjs';

const { host, python, rig: rigScript, out, browser: kind, webgl } = arguments_();
rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
const rig = new Program(python, [rigScript]);
const browser = await Browser.start({ kind, webgl: webgl !== 'off' });
let view, page, replay;

/** Remembers what the page gives to the browser as files, and what it copies. */
function remember() {
  window.saved = [];
  const make = URL.createObjectURL;
  URL.createObjectURL = (blob) => { saved.push(blob); return make(blob); };
  document.addEventListener('copy', (event) => { window.copied = event.clipboardData.getData('text/plain'); });
}

/** Opens the page without its help. */
async function open(url) {
  page = await browser.open(url);
  await until(page, () => window.ligature?.firstThread_ms && ligature.panels?.parts.help.value && ligature.traces && ligature.panels.parts.copying.value);
  await page.evaluate(() => document.getElementById('help').close());
  await page.evaluate(remember);
}

/** Chooses an entry of the list of files to save. @returns the text or the size of the file. */
async function saves(what, asText) {
  const before = await page.evaluate(() => saved.length);
  await page.selectOption('#save', what);
  await page.waitForFunction((n) => saved.length > n, before);
  return page.evaluate((text) => (text ? saved.at(-1).text() : saved.at(-1).size), asText);
}

/** At each size the labels of the plots are inside of them, and times have their unit. */
async function labelsFit() {
  for (const [width, height] of [[1400, 900], [900, 600], [390, 844]]) {
    await page.setViewportSize({ width, height });
    await page.waitForFunction((n) => ligature.draws > n + 5, await page.evaluate(() => ligature.draws));
    await until(page, () => ligature.traces.plots.every(({ plot, box }) => Math.abs(plot.width - Math.max(200, box.clientWidth)) < 2 && plot.axes[1]._values));
    const wrong = await page.evaluate(() => ligature.traces.plots.flatMap(({ plot, title }) => {
      const c = document.createElement('canvas').getContext('2d');
      c.font = '11px sans-serif';
      const wide = Math.max(...plot.axes[1]._values.filter(Boolean).map((v) => c.measureText(v).width));
      const labels = plot.axes[0]._values.filter(Boolean), at = plot.axes[0]._splits[labels.length - 1];
      const end = plot.over.offsetLeft + plot.valToPos(at, 'x') + c.measureText(labels.at(-1) ?? '').width / 2;
      return [plot.height > plot.root.parentElement.clientHeight + 1 ? `${title}: ${plot.height} px high in ${plot.root.parentElement.clientHeight}` : '', wide > plot.axes[1]._size - 9 ? `${title}: ${wide} px of ${plot.axes[1]._size}` : '', end > plot.width + 1 ? `${title}: ${labels.at(-1)} ends at ${end} of ${plot.width}` : '', / s$/.test(labels.at(-1) ?? '') ? '' : `${title}: ${labels}`].filter(Boolean);
    }));
    assert.deepEqual(wrong, [], `${width}x${height}`);
  }
  await page.setViewportSize({ width: 1280, height: 800 });
}

const steps = {
  'forces have three digits, and a copy of them all': async () => {
    await rig.says(/ready/);
    view = new Program(host, ['view', '--port', '0', '--recordings', out]);
    await open(await view.says(/open (\S+)/));
    rig.tell('arm');
    await until(page, () => parseFloat(document.getElementById('hand-left').textContent) > 0.1);
    rig.tell('quiet'); // the numbers stand still
    await until(page, () => !document.getElementById('stale').hidden);
    const shown = await page.evaluate(() => document.getElementById('hand-left').textContent);
    assert.match(shown, /^(\d\.\d\d|0\.0*[1-9]\d\d) N · holds node 40/);
    await page.evaluate(() => getSelection().selectAllChildren(document.getElementById('hand-left')));
    await page.keyboard.press('Control+c');
    const [copied, force] = await page.evaluate(() => [copied, Math.hypot(...ligature.latest.now.hands[0].f_device)]);
    assert.equal(copied.split(' N · ')[0], String(force));
    assert.match(copied, /holds node 40/);
    await page.evaluate(() => getSelection().removeAllRanges());
  },
  'the tick under the mouse is copied exactly': async () => {
    const over = await page.locator('.plot .u-over').first().boundingBox();
    await page.mouse.move(over.x + over.width / 2, over.y + over.height / 2);
    await until(page, () => document.getElementById('cursor').dataset.row);
    await page.keyboard.press('Control+c');
    const { copied, row, shown } = await page.evaluate(() => ({ copied, shown: document.getElementById('cursor').textContent, row: JSON.parse(document.getElementById('cursor').dataset.row).map(Number) }));
    const left = row[4];
    assert.ok(copied.includes(`left ${left} N`), `${copied}: ${left}`);
    assert.ok(shown.includes(`left ${left === 0 ? '0' : left.toPrecision(3)} N`), `${shown}: ${left}`);
    await page.mouse.move(5, 5);
    rig.tell('go');
    await until(page, () => document.getElementById('stale').hidden);
  },
  'both hands have one scale of force': async () => {
    rig.tell('spike 9'); // of the left hand
    await until(page, () => ligature.traces.plots[0].plot.scales.y.max > 5);
    const [left, right] = await page.evaluate(() => ligature.traces.plots.slice(0, 2).map(({ plot }) => [plot.scales.y.min, plot.scales.y.max]));
    assert.deepEqual(left, right);
  },
  'labels of the axes are inside, and times have their unit': () => labelsFit(),
  'the histogram is drawn, pixel by pixel at each size, and its labels are apart': async () => {
    for (const [width, height] of [[1280, 800], [900, 600], [390, 844], [1400, 900]]) {
      await page.setViewportSize({ width, height });
      await page.waitForFunction(() => {
        const canvas = document.querySelector('.histogram canvas'), { clientWidth: w, clientHeight: h } = canvas.parentElement;
        if (canvas.width !== Math.round(w * devicePixelRatio) || canvas.height !== Math.round(h * devicePixelRatio)) return false;
        const copy = Object.assign(document.createElement('canvas'), { width: canvas.width, height: canvas.height }).getContext('2d', { willReadFrequently: true });
        copy.drawImage(canvas, 0, 0);
        const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
        let bars = 0;
        for (let i = 0; i < data.length; i += 4) if (data[i] === 0x7b && data[i + 1] === 0x8d) ++bars;
        return bars > 200;
      });
      const overlaps = await page.evaluate(async () => {
        const { Histogram } = await import('./histogram.js'), fill = CanvasRenderingContext2D.prototype.fillText, texts = [];
        CanvasRenderingContext2D.prototype.fillText = function (text, x, y) { texts.push([text, x, y, this.measureText(text).width]); fill.call(this, text, x, y); };
        ligature.panels.parts.histogram.value.draw(ligature.store, 0, 1e-3);
        CanvasRenderingContext2D.prototype.fillText = fill;
        const labels = texts.filter(([text]) => /^[<≥]/.test(text));
        return labels.slice(1).filter(([, x, , w], i) => x - w / 2 < labels[i][1] + labels[i][3] / 2).map(([text]) => text).concat(Histogram ? [] : ['none'], labels.length < 4 ? ['too few'] : []);
      });
      assert.deepEqual(overlaps, [], `${width}x${height}`);
    }
    await page.setViewportSize({ width: 1280, height: 800 });
  },
  'a changed parameter is undone, step by step, and only while it holds': async () => {
    await page.click('#change-open');
    assert.ok(await page.isDisabled('#undo'));
    for (const value of ['0.75', '1.5']) {
      await page.fill('[data-key="contact.friction"] input[type=text]', value);
      await page.keyboard.press('Enter');
      await page.getByText(`friction: contact.friction=${value}`).waitFor();
    }
    await page.getByText('Undo friction: 1.5 → 0.75').click();
    await rig.says(/command set contact.friction[\s\S]*command set contact.friction[\s\S]*command set contact.friction/);
    await page.waitForFunction(() => document.querySelector('[data-key="contact.friction"] input[type=text]').value === '0.75');
    await page.getByText('Undo friction: 0.75 → 0.3').click();
    await page.waitForFunction(() => document.querySelector('[data-key="contact.friction"] input[type=text]').value === '0.3');
    await page.waitForFunction(() => document.getElementById('undo').disabled && document.getElementById('undo').textContent === 'Undo');
    await page.fill('[data-key="contact.friction"] input[type=text]', '0.6');
    await page.keyboard.press('Enter');
    await page.getByText('Undo friction: 0.6 → 0.3').waitFor();
    rig.tell('friction 0.9'); // somebody else
    await page.waitForFunction(() => document.querySelector('[data-key="contact.friction"] input[type=text]').value === '0.9');
    await page.waitForFunction(() => document.getElementById('undo').disabled);
    await page.click('#change-close');
  },
  'an exercise measures time, force and thread until the knot is tied': async () => {
    rig.tell('unknot');
    rig.tell('arm');
    await until(page, () => document.getElementById('knot-name').dataset.type === '0_1');
    await page.click('#exercise-open');
    await page.selectOption('#target', { label: 'trefoil (overhand)' });
    await page.click('#exercise-begin');
    await page.getByText('trefoil (overhand): not yet').waitFor();
    rig.tell('spike 12');
    await until(page, () => /left 1\d\.\d N/.test(document.querySelector('#scores li').textContent));
    rig.tell('knot');
    await until(page, () => document.querySelector('#scores li').dataset.done === 'true');
    const line = await page.locator('#scores li').innerText();
    assert.match(line, /^trefoil \(overhand\): tied, 3_1 \w+ · [\d.]+ s · peak force left 1\d\.\d N, right [\d.]+ N · drawn through [\d.]+ mm$/);
    await page.screenshot({ path: join(out, 'exercise.png') });
    await page.click('#exercise-close');
  },
  'a square knot has two throws: each with its view, its tightness, and its colour': async () => {
    rig.tell('square');
    await until(page, () => document.getElementById('knot-name').dataset.type === '3_1#3_1' && ligature.latest.knot.throws?.length === 2);
    assert.match(await page.locator('#knot-note').innerText(), /square \(reef\)[\s\S]*tightness: \d+ and \d+ diameters/);
    if (webgl !== 'off') {
      await until(page, () => document.querySelectorAll('#throws .throw').length === 2 && [...document.querySelectorAll('#throws .throw')].every((e) => /\d+ d$/.test(e.querySelector('b').textContent) && / (mm|m)$/.test(e.querySelector('.scale-bar').textContent)));
    }
    // The picture follows one throw and does not stand on the straight piece between the two.
    const middles = await page.evaluate(async () => { const { middleOf, throwsOf } = await import('./throws.js'), { shape, knot } = ligature.latest; return throwsOf(knot, shape).map((nodes) => middleOf(shape.p_W, nodes)); });
    await page.evaluate(() => document.getElementById('follow').click());
    const near = (at) => Math.min(...middles.map((m) => Math.hypot(...m.map((x, j) => x - at[j]))));
    const where = () => page.evaluate(() => ligature.scene.controls?.target.toArray() ?? ligature.scene.at);
    for (let at = await where(); !at || near(at) > 0.2; at = await where()) await page.waitForTimeout(100); // the test's own time limit ends it
    await page.screenshot({ path: join(out, 'throws.png') });
    await page.evaluate(() => document.getElementById('follow').click());
  },
  'desk, length and grippers are those of the scene as it runs': async () => {
    await until(page, () => ligature.scene.facts.desk_height_m === 0 && ligature.scene.facts.length_m === 5);
    rig.tell('set suture.length_m=4');
    rig.tell('set world.desk_height_m=-0.25');
    await until(page, () => ligature.scene.facts.desk_height_m === -0.25 && ligature.scene.facts.length_m === 4);
    assert.equal(await page.evaluate(() => ligature.scene.facts.gripper_m), 0.12);
    if (webgl === 'off') return;
    // The drawn gripper lies along the capsule that the thread collides with: from the tip towards the person.
    const [tip, end] = await page.evaluate(async () => {
      const { Box3 } = await import('./three.module.js'), { hands } = ligature.scene, box = new Box3();
      hands[0].tool.updateWorldMatrix(true, true);
      for (const jaw of hands[0].jaws) box.expandByObject(jaw);
      return [[...hands[0].tool.position], [...box.min, ...box.max]];
    });
    assert.ok(Math.abs(end[4] - tip[1]) < 0.02 && end[1] < tip[1] - 0.1 && Math.abs((end[0] + end[3]) / 2 - tip[0]) < 0.01, `${tip}: ${end}`);
  },
  'a camera that was placed while the picture had no size sees the thread': async () => {
    if (webgl === 'off') return;
    const distance = await page.evaluate(async () => {
      const { Scene } = await import('./scene.js'), ending = new AbortController();
      const scene = new Scene(document.getElementById('scene'), { ...ligature.panels.choice, follow: false }, () => {}, ending.signal);
      scene.update(ligature.latest.shape, ligature.latest.now, ligature.latest.knot); // its canvas is still hidden
      const far = scene.camera.position.distanceTo(scene.controls.target);
      ending.abort();
      return far;
    });
    assert.ok(distance > 0.1 && distance < 100, `${distance} m`);
  },
  'a picture, a film and the ticks are saved': async () => {
    assert.ok(await saves('picture') > 3000);
    await page.selectOption('#save', 'film');
    await page.waitForFunction(() => /film [1-9]/.test(document.getElementById('film-end').textContent));
    const before = await page.evaluate(() => saved.length);
    await page.click('#film-end');
    await page.waitForFunction((n) => saved.length > n, before);
    const film = await page.evaluate(async () => { const video = document.createElement('video'), head = new Uint8Array(await saved.at(-1).arrayBuffer()); return { size: head.length, isWebm: head[0] === 0x1a && head[1] === 0x45, plays: video.canPlayType(saved.at(-1).type) }; });
    assert.ok(film.size > 3000 && film.isWebm && film.plays, JSON.stringify(film));
    await page.click('#windows button[value="1"]');
    const [head, ...lines] = (await saves('csv', true)).trim().split('\n').map((line) => line.split(','));
    assert.ok(lines.length > 900 && lines.length <= 1000, `${lines.length} ticks`);
    const rows = await page.evaluate((first) => { const r = []; for (let i = ligature.store.rowFrom(first); i < ligature.store.rowEnd; ++i) r.push([...ligature.store.row(i)]); return r; }, Number(lines[0][0]));
    lines.forEach((line, k) => line.forEach((cell, i) => assert.equal(Number(cell), rows[k][i], `${head[i]} of tick ${line[0]}`)));
    assert.ok(head.includes('left_device_f_N') && head.includes('wakeup_latency_ns'));
  },
  'the recordings of the folder are listed, and a replay plays any of them': async () => {
    for (const name of ['one', 'two']) {
      rig.tell(name === 'one' ? 'knot' : 'unknot');
      execFileSync(host, ['record', '--out', join(out, `${name}.lcmlog`), '--force', '--duration', '3', '--quiet']);
    }
    await page.click('#record');
    await page.locator('#recordings li', { hasText: 'one.lcmlog' }).waitFor();
    await page.locator('#recordings li', { hasText: 'two.lcmlog' }).waitFor();
    const said = await page.locator('#recordings li', { hasText: 'two.lcmlog' }).innerText();
    const bytes = statSync(join(out, 'two.lcmlog')).size;
    assert.ok(said.includes(`${(bytes / 1e6).toPrecision(3)} MB`), `${said}: ${bytes}`);
    await page.screenshot({ path: join(out, 'recordings.png') });
    await page.click('#record-dialog button[value=cancel]');
    await page.close();
    replay = new Program(host, ['replay', join(out, 'one.lcmlog'), '--port', '0']);
    await open(await replay.says(/open (\S+)/));
    await until(page, () => document.getElementById('knot-name').dataset.type === '3_1' && document.getElementById('open').value === 'one.lcmlog');
    await page.selectOption('#open', 'two.lcmlog');
    await until(page, () => document.getElementById('knot-name').dataset.type === '0_1' && document.title.startsWith('two.lcmlog'));
    const refused = await page.evaluate(() => ligature.link.request({ open: '../two.lcmlog' }));
    assert.equal(refused.accepted, false);
  },
  'a replay shows the whole run': async () => {
    await page.click('#windows button[value="run"]');
    await until(page, () => { const { plot } = ligature.traces.plots[0], { duration_s } = ligature.panels.told.replay; return plot.scales.x.max - plot.scales.x.min >= 0.99 * duration_s && plot.data[1].filter((v) => v !== null).length > 500; });
    await page.screenshot({ path: join(out, 'whole-run.png') });
    assert.ok(readFileSync(join(out, 'whole-run.png')).length > 10_000);
    await page.click('#windows button[value="10"]');
    await labelsFit();
  },
};

let failed = 0;
for (const [name, step] of Object.entries(steps)) {
  const began = Date.now();
  try {
    await step();
    console.log(`ok   ${name} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
  } catch (error) {
    ++failed;
    console.log(`FAIL ${name}\n${error.stack}`);
    await page?.screenshot({ path: join(out, `failure-${failed}.png`) }).catch(() => {});
    if (!page) break;
  }
}
if (browser.complaints.length) { ++failed; console.log('FAIL console is quiet\n', browser.complaints.join('\n')); }
await browser.stop();
view?.stop();
replay?.stop();
rig.stop();
process.exitCode = failed ? 1 : 0;
