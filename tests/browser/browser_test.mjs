// Tests of the web page of `ligature-host view` in a real browser: first with a fake rig, then with a recording of it.
//   node browser_test.mjs [--browser firefox] [--webgl off] --host BIN --python BIN --rig SCRIPT --modules DIR --out DIR     (inside scripts/private-net)
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { exportedName } from '../../host/view/page/csv.js';
import { Browser, Program, arguments_, clientOf, until } from './support.mjs';

const { host, python, rig: rigScript, out, browser: kind, webgl } = arguments_();
mkdirSync(out, { recursive: true });
rmSync(join(out, 'page.lcmlog'), { force: true });
const rig = new Program(python, [rigScript]);
const browser = await Browser.start({ kind, webgl: webgl !== 'off' });
let view, page, replay;

const steps = {
  'opens, and says how long the first thread took': async () => {
    await rig.says(/ready/);
    view = new Program(host, ['view', '--port', '0', '--recordings', out]);
    page = await browser.open(await view.says(/open (\S+)/));
    await page.waitForFunction(() => ligature.firstThread_ms);
    const first_ms = await page.evaluate(() => ligature.firstThread_ms);
    console.log(`    first thread after ${first_ms.toFixed(0)} ms`);
    await page.locator('#help').waitFor({ state: 'visible' }); // shown at the first visit
    await page.screenshot({ path: join(out, 'help.png') });
    await page.click('#help button');
  },
  'arms, and the force is drawn': async () => {
    await page.click('#arm');
    await until(page, () => document.getElementById('state').dataset.state === 'FORCE');
    await page.getByText('arm: done').waitFor();
    await until(page, () => ligature.store.rowEnd > ligature.store.rowBegin + 1500);
    await until(page, () => parseFloat(document.getElementById('hand-left').textContent) > 0.1);
  },
  'the knot appears and its label turns 3_1': async () => {
    assert.equal(await page.locator('#knot-name').getAttribute('data-type'), '0_1');
    rig.tell('knot');
    await until(page, () => document.getElementById('knot-name').dataset.type === '3_1');
    assert.match(await page.locator('#knot-name').getAttribute('data-handedness'), /left|right/);
    await page.selectOption('#colour', 'knot');
    await page.click('#follow');
    await page.waitForTimeout(300);
    // The knot's crossings in this view are marked, each with its sign.
    await until(page, () => (ligature.crossings ?? []).length >= 2 && ligature.crossings.every((c) => Math.abs(c.sign) === 1));
    await page.screenshot({ path: join(out, 'knot.png') });
    await page.selectOption('#colour', 'tension');
    await page.getByText('5.00 N').or(page.getByText(/4\.\d+ N/)).first().waitFor();
    for (const mode of ['anaglyph', 'side']) {
      await page.selectOption('#stereo', mode);
      await page.waitForTimeout(400);
      await page.screenshot({ path: join(out, `stereo-${mode}.png`) });
    }
    await page.selectOption('#stereo', 'off');
    await page.selectOption('#third', 'bus load');
    await page.selectOption('#third', 'passivity');
  },
  'a spike of one tick is seen in every window': async () => {
    rig.tell('spike 12');
    await until(page, () => ligature.latest.now.flags !== undefined
      && ligature.store.histogram(4, [9], 0).max > 9);
    for (const seconds of [1, 10, 60, 600]) {
      const seen = await page.evaluate((s) => {
        const end = ligature.store.lastTick + 1, spike = (() => { for (let i = ligature.store.rowBegin; i < ligature.store.rowEnd; ++i) if (ligature.store.row(i)[4] > 9) return ligature.store.tickOfRow(i); })();
        return Math.max(...ligature.store.series(Math.min(spike, end - s * 1000), end, 300, [4])[1].filter((v) => v !== null));
      }, seconds);
      assert.ok(seen > 9, `${seconds} s: ${seen}`);
    }
  },
  'records under a name, and nothing is lost': async () => {
    await page.click('#record');
    await page.fill('#record-name', 'page');
    await page.fill('#record-notes', 'a note');
    await page.click('#record-dialog button[value=start]');
    await page.getByText('■ page.lcmlog').waitFor();
    const from = await page.evaluate(() => ligature.store.lastTick);
    await page.waitForFunction((tick) => ligature.store.lastTick > tick + 1000, from);
    await page.click('#record');
    await page.getByText(/recorded: page.lcmlog/).waitFor();
    const report = JSON.parse(execFileSync(host, ['report', join(out, 'page.lcmlog'), '--json']));
    assert.equal(report.ticks_lost, 0);
    assert.ok(report.ticks_recorded > 1000);
  },
  'limits, clutch and what the solver gave up are named': async () => {
    rig.tell('limit 33');
    rig.tell('clutch 1');
    rig.tell('degrade 2');
    await until(page, () => /clutch: tool parked · limited: peak force, passivity/.test(document.getElementById('hand-left').textContent));
    await page.getByText('solver: too many contacts: shallowest only guarded').waitFor();
    await page.click('#change-open');
    await page.locator('[data-command="unclutch left"]').waitFor();
    await page.click('#change-close');
    await page.screenshot({ path: join(out, 'limits.png') });
    rig.tell('propagation 1 3');
    await until(page, () => document.getElementById('hand-left').textContent.includes('A: springs') && document.getElementById('hand-right').textContent.includes('C: rigid'));
    await page.selectOption('#third', 'propagation');
    await until(page, () => ligature.traces.plots[2].plot.data.slice(1, 3).map((values) => values.findLast((v) => v != null)).join() === '1,3');
    await page.selectOption('#third', 'tick time');
    for (const line of ['limit 0', 'clutch 0', 'degrade 0', 'propagation 0 0']) rig.tell(line);
    await until(page, () => !/A: |C: /.test(document.querySelector('.hands').textContent));
    await until(page, () => document.getElementById('degraded').hidden);
  },
  'the space bar stops, whatever has the focus': async () => {
    await page.focus('#colour');
    await page.keyboard.press('Space');
    await rig.says(/command stop/);
    await until(page, () => document.getElementById('state').dataset.state === 'IDLE');
    await page.getByText('stop: done').first().waitFor();
  },
  'the space bar stops while a note is being typed, and the note gets its blank': async () => {
    await page.click('#arm');
    await until(page, () => document.getElementById('state').dataset.state === 'FORCE');
    await page.click('#record');
    await page.focus('#record-notes');
    await page.keyboard.type('a b');
    await until(page, () => document.getElementById('state').dataset.state === 'IDLE');
    assert.equal(await page.inputValue('#record-notes'), 'a b');
    await page.click('#record-dialog button[value=cancel]');
  },
  'scenes and parameters: acknowledged, or refused with the reason': async () => {
    await page.click('#change-open');
    await page.fill('[data-key="contact.friction"] input[type=text]', '0.75');
    await page.keyboard.press('Enter');
    await page.getByText('friction: contact.friction=0.75').waitFor();
    await page.fill('[data-key="contact.friction"] input[type=text]', '3');
    await page.keyboard.press('Enter');
    await page.getByText('friction: refused – contact.friction: found 3, allowed 0 .. 2').waitFor();
    await page.waitForFunction(() => document.querySelector('[data-key="contact.friction"] input[type=text]').value === '0.75');
    await page.selectOption('#scenes', 'fake.toml');
    await page.getByText('This one hangs.').waitFor();
    await page.selectOption('#scenes', 'desk.toml');
    await page.getByText('This one lies on a desk.').waitFor();
    assert.ok(await page.evaluate(() => { // the shape is drawn
      const canvas = document.getElementById('preview-shape');
      return canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some((v) => v > 200);
    }));
    await page.screenshot({ path: join(out, 'change.png') });
    await page.click('#load-scene');
    await page.getByText('load scene: scene desk.toml loaded').waitFor();
    await until(page, () => document.getElementById('scene-file').textContent.startsWith('desk.toml'));
    await page.selectOption('#model', 'paper-2');
    await page.fill('#nodes', '35');
    await page.click('#load-scene');
    await rig.says(/command load-scene desk.toml suture.model=paper-2 suture.nodes=35/);
    await page.selectOption('#model', '');
    await page.fill('#nodes', '');
    await page.click('#arm');
    await until(page, () => document.getElementById('state').dataset.state === 'FORCE');
    await page.click('#load-scene');
    await page.getByText('load scene: refused – force may flow: disarm first').waitFor();
    await page.click('#stop');
    await until(page, () => document.getElementById('state').dataset.state === 'IDLE');
    await page.click('#change-close');
  },
  'a fault shows its number, meaning and remedy; arming is refused with the reason': async () => {
    rig.tell('fault 30');
    await until(page, () => document.getElementById('state').dataset.state === 'FAULT');
    assert.match(await page.locator('#fault').innerText(), /30.*periods[\s\S]*reset/i);
    await page.click('#arm');
    await page.getByText(/arm: refused – fault 30/).waitFor();
    await page.screenshot({ path: join(out, 'fault.png') });
    await page.click('#reset-fault');
    await until(page, () => document.getElementById('state').dataset.state === 'IDLE');
  },
  'old data is shown as old, and fresh data as fresh again': async () => {
    rig.tell('quiet');
    await until(page, () => !document.getElementById('stale').hidden);
    // The warning appears at the first frame or timer after 120 ms without data. The delay is printed but not limited,
    // since wall time varies on a shared machine.
    const { age_ms, pace_ms } = await page.evaluate(() => ({ age_ms: ligature.staleAt_ms, pace_ms: ligature.scene.pace ?? 0 }));
    console.log(`    shown as old at ${age_ms.toFixed(0)} ms, one picture takes ${pace_ms.toFixed(0)} ms`);
    assert.ok(age_ms >= 120, `${age_ms} ms`);
    await page.screenshot({ path: join(out, 'stale.png') });
    rig.tell('go');
    await until(page, () => document.getElementById('stale').hidden);
  },
  'a page of another site cannot connect, frame or read us': async () => {
    const url = new URL(page.url());
    const hostile = await browser.openHtml(`http://${url.hostname}:${await browser.serve('<!doctype html><title>hostile</title>')}/`);
    const outcome = await hostile.evaluate((at) => new Promise((resolve) => {
      const socket = new WebSocket(`ws://${at}/socket`);
      socket.onopen = () => { socket.send(JSON.stringify({ command: 'arm', id: 1, token: '' })); resolve('open'); };
      socket.onerror = () => resolve('refused');
    }), url.host);
    assert.equal(outcome, 'refused');
    const readable = await hostile.evaluate((at) => fetch(`http://${at}/`).then((r) => r.text()).then(() => true, () => false), url.host);
    assert.equal(readable, false);
    assert.ok(!rig.heard.includes('command arm\ncommand arm\ncommand arm'));
    await hostile.close();
    const headers = await page.request.get(page.url()).then((r) => r.headers());
    assert.match(headers['content-security-policy'], /frame-ancestors 'none'/);
    const rebound = await page.request.get(page.url(), { headers: { host: 'rebind.example' } });
    assert.equal(rebound.status(), 403);
  },
  'wrong token, malformed and oversized messages and a peer that never reads do no harm': async () => {
    const { host: at } = new URL(page.url());
    const before = rig.heard.length;
    const wrong = await clientOf(at);
    wrong.send(JSON.stringify({ command: 'arm', id: 3, token: 'x'.repeat(32) }));
    assert.match(await wrong.text((t) => t.answers), /token/);
    const odd = await clientOf(at);
    odd.send('{"command":');
    await odd.closed();
    const large = await clientOf(at);
    large.sendHeaderOf(100_000_000);
    await large.closed();
    const token = await page.evaluate(() => document.querySelector('meta[name=ligature-token]').content);
    const deaf = [];
    while (deaf.length < 50) {
      deaf.push(await clientOf(at, { reads: false }));
      deaf.at(-1).send(JSON.stringify({ token })); // without the token only 16 clients may stay
    }
    const drawn = await page.evaluate(() => ligature.frames);
    await page.waitForFunction((n) => ligature.frames > n + 30, drawn);
    console.log(`    host peak memory ${(view.peakMemory_kB() / 1024).toFixed(0)} MB with 50 deaf peers`);
    // AddressSanitizer keeps freed memory back, so that its later use is seen.
    assert.ok(view.peakMemory_kB() < (process.env.LIGATURE_SANITIZE ? 1200 : 300) * 1024);
    deaf.forEach((peer) => peer.end());
    assert.equal(rig.heard.slice(before).includes('command arm'), false);
  },
  'a hand obeys only who has the token, one page at a time, and is let go with its connection': async () => {
    const { host: at } = new URL(page.url()), wishes = () => rig.heard.split('\n').filter((line) => line.startsWith('wish'));
    const token = await page.evaluate(() => document.querySelector('meta[name=ligature-token]').content);
    const asks = async (message) => { const peer = await clientOf(at); peer.send(JSON.stringify({ id: 4, token, ...message })); return { peer, told: await peer.text() }; };
    const take = { hand: 'take', side: 'left' }, wish = { wish: { left: { p: [0, 0, 0], dead: true, grip: true } } };
    rig.tell('hands');
    let first;
    while (!(first = await asks(take)).told.includes('"accepted":true')) first.peer.end(); // until the view has heard of the hand
    await rig.says(/wish left/);
    const before = wishes().length;
    for (const wrong of [take, wish, { hand: 'leave', side: 'left' }]) assert.match((await asks({ ...wrong, token: 'x'.repeat(32) })).told, /token/);
    assert.match((await asks(take)).told, /somebody else has the left hand/);
    const second = await clientOf(at);
    second.send(JSON.stringify({ token, ...wish })); // it has no hand
    second.send(JSON.stringify({ id: 5, token, hand: 'leave', side: 'left' }));
    assert.match(await second.text(), /this page does not have that hand/);
    assert.equal(wishes().length, before);
    first.peer.end();
    await rig.says(/wish left leaves/);
    assert.ok(!rig.heard.includes("stranger's wish"));
  },
  'ticks are exact after a year, and where 31 and 32 bits end': async () => {
    for (const start of [2 ** 31 - 3000, 2 ** 32 - 3000, 31_536_000_000]) {
      rig.tell(`restart ${start}`);
      await page.waitForFunction((from) => ligature.store.lastTick > from + 5000 && ligature.store.tickOfRow(ligature.store.rowBegin) >= from && ligature.store.binEnd - ligature.store.binBegin > 80, start);
      const { now, rows, bins } = await page.evaluate(() => {
        const { store, latest } = ligature, all = (begin, end, tick) => Array.from({ length: end - begin }, (_, i) => tick(begin + i));
        return { now: latest.now.tick, rows: all(store.rowBegin, store.rowEnd, (i) => store.tickOfRow(i)), bins: all(store.binBegin, store.binEnd, (i) => store.tickOfBin(i)) };
      });
      assert.equal(now, rows.at(-1));
      rows.forEach((tick, i) => assert.equal(tick, rows[0] + i));
      bins.forEach((tick, i) => assert.equal(tick, bins[0] + 50 * i));
      assert.equal(bins[0], Math.floor(rows[0] / 50) * 50);
      await page.click('#windows button[value="1"]');
      await page.waitForFunction(() => { const { plot } = ligature.traces.plots[0]; return plot.axes[0]._values?.length > 1 && plot.data[0].at(-1) > ligature.store.lastTick / 1000 - 2; });
      const labels = await page.evaluate(() => ligature.traces.plots[0].plot.axes[0]._values.filter((v) => v));
      assert.equal(new Set(labels).size, labels.length, labels.join());
      labels.forEach((label) => assert.ok(Math.abs(parseFloat(label) - start / 1000) < 3600, label));
      const over = await page.locator('.plot .u-over').first().boundingBox();
      await page.mouse.move(over.x + over.width / 2, over.y + over.height / 2);
      const read = await page.waitForFunction(() => { const c = document.getElementById('cursor'); return c.dataset.row && [JSON.parse(c.dataset.row)[0], c.textContent]; }).then((handle) => handle.jsonValue());
      assert.ok(read[1].startsWith(`t ${Math.floor(read[0] / 1000)}.${String(read[0] % 1000).padStart(3, '0')} s`), read.join(': '));
      await page.screenshot({ path: join(out, `tick-${start}.png`) });
      await page.mouse.move(5, 5);
    }
  },
  'goes on with a restarted firmware': async () => {
    rig.tell('restart');
    await until(page, () => ligature.store.lastTick !== null && ligature.store.lastTick < 5000);
  },
  'reads on a tablet': async () => {
    await page.setViewportSize({ width: 820, height: 1180 });
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.ok(wide <= 0, `${wide} px too wide`);
    await page.screenshot({ path: join(out, 'tablet.png') });
    await page.close();
  },
  'a recording replays: scrubbing, labels, events, and values equal to the exported ones': async () => {
    const log = join(out, 'run.lcmlog'), forces = join(out, 'forces.csv'), ticks = join(out, 'ticks.csv');
    rig.tell('unknot');
    const recorder = new Program(host, ['record', '--out', log, '--force', '--duration', '6', '--quiet']);
    await new Promise((resolve) => setTimeout(resolve, 2000));
    rig.tell('fault 11');
    rig.tell('knot');
    await recorder.ended();
    execFileSync(host, ['export', log, '--forces', forces, '--ticks', ticks]);
    replay = new Program(host, ['replay', log, '--port', '0']);
    page = await browser.open(await replay.says(/open (\S+)/));
    await page.waitForFunction(() => ligature.firstThread_ms);
    await page.locator('#help').waitFor({ state: 'visible' }); // another origin, hence a first visit
    await page.evaluate(() => document.getElementById('help').close());
    await until(page, () => document.querySelectorAll('#marks button').length >= 2);
    const titles = await page.locator('#marks button').evaluateAll((all) => all.map((b) => b.title).join('\n'));
    assert.match(titles, /fault 11/);
    assert.match(titles, /knot 3_1/);
    await page.click('#play');
    await page.locator('#marks button', { hasText: '' }).last().evaluate((b) => b.click());
    await until(page, () => document.getElementById('knot-name').dataset.type === '3_1' && document.getElementById('state').dataset.state === 'FAULT');
    await page.locator('#scrub').fill('1');
    await until(page, () => document.getElementById('knot-name').dataset.type === '0_1' && document.getElementById('state').dataset.state === 'IDLE');
    const rows = await page.evaluate(() => { const r = []; for (let i = ligature.store.rowBegin; i < ligature.store.rowEnd; ++i) r.push([...ligature.store.row(i)]); return r; });
    assert.ok(rows.length > 500);
    const columns = await page.evaluate(() => ligature.columns);
    compare(rows, columns, forces, ticks);
    await page.screenshot({ path: join(out, 'replay.png') });
    // The values shown at the cursor are compared with the exported numbers.
    await page.click('#windows button[value="1"]');
    const box = await page.locator('.plot .u-over').first().boundingBox();
    await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
    await until(page, () => document.getElementById('cursor').dataset.row);
    await page.selectOption('#third', 'passivity');
    await until(page, () => { const c = document.getElementById('cursor'); return c.dataset.row && c.dataset.exact.includes(`passivity: left ${JSON.parse(c.dataset.row)[ligature.columns.indexOf('leftPort_J')]} J`); });
    await page.selectOption('#third', 'tick time');
    await page.mouse.move(box.x + box.width / 2 + 3, box.y + box.height / 2);
    compare([JSON.parse(await page.locator('#cursor').getAttribute('data-row')).map(Number)], columns, forces, ticks);
  },
  'another recording is drawn dashed over it, with its own exported values': async () => {
    const forces = join(out, 'other.csv'), ticks = join(out, 'other-ticks.csv');
    execFileSync(host, ['export', join(out, 'page.lcmlog'), '--forces', forces, '--ticks', ticks]);
    await page.selectOption('#compare', 'page.lcmlog');
    await page.waitForFunction(() => ligature.traces.isComparing && ligature.beside.rowEnd > ligature.beside.rowBegin + 500);
    await page.click('#windows button[value="10"]');
    await page.waitForFunction(() => ligature.traces.plots.every(({ plot }) => plot.series.at(-1).show && plot.data.at(-1).some((v) => v !== null && v !== undefined)));
    const rows = await page.evaluate(() => { const r = []; for (let i = ligature.beside.rowBegin; i < ligature.beside.rowEnd; ++i) r.push([...ligature.beside.row(i)]); return r; });
    compare(rows, await page.evaluate(() => ligature.columns), forces, ticks);
    await page.screenshot({ path: join(out, 'compare.png') });
    await page.selectOption('#compare', '');
    await page.waitForFunction(() => !ligature.traces.isComparing);
    assert.equal(await replay.stop(), 0);
    assert.equal(await view.stop(), 0);
  },
};

function table(file) {
  const [head, ...lines] = readFileSync(file, 'utf8').trim().split('\n').map((line) => line.split(','));
  return { head, lines: new Map(lines.map((line) => [Number(line[0]), line])) };
}

/** Compares every column of each row shown with the exported files, bit by bit. */
function compare(rows, columns, ...files) {
  const tables = files.map(table);
  for (const row of rows) {
    columns.forEach((name, i) => {
      const wanted = exportedName(name), from = tables.find(({ head }) => head.includes(wanted));
      const line = from?.lines.get(row[0]);
      assert.ok(line, `${wanted} of tick ${row[0]} is not in the export`);
      assert.equal(row[i], Number(line[from.head.indexOf(wanted)]), `${wanted} of tick ${row[0]}`);
    });
  }
}

let failed = 0;
for (const [name, step] of Object.entries(steps)) {
  const began = Date.now();
  try {
    await step();
    console.log(`ok   ${name} (${((Date.now() - began) / 1000).toFixed(1)} s)`);
  } catch (error) {
    ++failed;
    console.log(`FAIL ${name}\n${error.stack}\n${rig.heard}`);
    await page?.screenshot({ path: join(out, 'failure.png') }).catch(() => {});
    break; // later steps depend on this one
  }
}
if (browser.complaints.length) { ++failed; console.log('FAIL console is quiet\n', browser.complaints.join('\n')); }
await browser.stop();
view?.stop();
replay?.stop();
rig.stop();
process.exitCode = failed ? 1 : 0;
