// A person at the page, for test_hands.py: opens the page in Chromium and holds keys, as told by lines on standard input.
//   open             opens the page, chooses the front view, takes both hands by M
//   keys CODE,..     these keys are down, all others up (KeyboardEvent.code; "none": none)
//   tap CODE         one key, down and up
//   haste            the key M twice, before any answer can come; then the page has the hands, or says why not
//   pads JSON        these gamepads are there: [{"axes": [..], "pressed": [buttons]}, ..], objects as the Gamepad API has
//   rumbled          waits until a gamepad was told to vibrate
//   close | blur | cut | freeze    the tab is closed | another window comes to the front | all connections are closed
//                    | nothing passes through them any more
//   heal             the opposite of blur and freeze
//   busy MS          from now on the page's own scripts stand still for so long after each picture; 0: no more
//   tells WHAT       waits until the page tells what the picture's age comes from: fresh, slow, rig, host (TELLS)
//   unwarned         fails if the picture was called old since the last `busy`
//   draw PATH        a picture of the page
// Each is answered by "done N" with N the number of the line, or by "failed N REASON".
//   node hands_page.mjs --to HOST:PORT --modules DIR [--webgl off] [--size WxH]
import { connect, createServer } from 'node:net';
import { createInterface } from 'node:readline';
import { Browser, arguments_, until } from './support.mjs';

/** A proxy between browser and host whose connections can be cut or frozen. */
class Wire {
  static async to(address) {
    const wire = new Wire(), [hostname, port] = address.split(':');
    wire.pairs = new Set();
    wire.server = createServer((socket) => {
      const there = connect(Number(port), hostname), pair = [socket, there];
      wire.pairs.add(pair);
      socket.pipe(there).pipe(socket);
      for (const end of pair) end.on('error', () => {}).on('close', () => { wire.pairs.delete(pair); for (const other of pair) other.destroy(); });
    });
    await new Promise((resolve) => wire.server.listen(0, '127.0.0.1', resolve));
    wire.url = `http://127.0.0.1:${wire.server.address().port}/`;
    return wire;
  }

  cut() { for (const pair of this.pairs) for (const end of pair) end.resetAndDestroy(); }
  freeze() { for (const [a, b] of this.pairs) { a.unpipe(b); b.unpipe(a); a.pause(); b.pause(); } }
  heal() { for (const [a, b] of this.pairs) a.pipe(b).pipe(a); }
  stop() { this.cut(); this.server.close(); }
}

const { to, webgl, size = '1280x800' } = arguments_();
const [width, height] = size.split('x').map(Number);
const wire = await Wire.to(to);
const browser = await Browser.start({ webgl: webgl !== 'off' });
browser.viewport = { width, height };
let page = null, other = null, held = new Set();

const TELLS = {
  fresh: () => document.getElementById('stale').hidden && document.getElementById('slow').hidden,
  slow: () => document.getElementById('stale').hidden && /^slow picture: this computer .*; the rig is heard$/.test(document.getElementById('slow').textContent),
  rig: () => /^Old picture: no ticks for .*The rig may be in any state/.test(document.getElementById('stale').textContent),
  host: () => /^No word from the host/.test(document.getElementById('stale').textContent),
};

const acts = {
  async open() {
    if (!page) {
      page = await browser.open(wire.url);
      const devtools = await browser.context.newCDPSession(page);
      await devtools.send('Emulation.setFocusEmulationEnabled', { enabled: false }); // the page must notice other windows
      await page.bringToFront();
    }
    await until(page, () => window.ligature?.latest.now?.hands && ligature.panels?.parts.hands.value && ligature.scene?.panes?.length);
    await page.evaluate(() => document.getElementById('help').close());
    await until(page, () => document.hasFocus());
    await page.keyboard.press('Digit1');
    // A hand may still be in the previous page's possession, or its device be absent for a moment.
    const hasBoth = () => { const { mine } = ligature.panels.parts.hands.value; return !!mine.left && !!mine.right; };
    for (;;) {
      if (await page.evaluate(hasBoth)) return;
      await page.keyboard.press('KeyM');
      await Promise.race([until(page, hasBoth), new Promise((resolve) => setTimeout(resolve, 1000))]);
    }
  },
  async keys(list) {
    const wanted = new Set(list === 'none' ? [] : list.split(','));
    for (const code of [...held].filter((c) => !wanted.has(c))) { held.delete(code); await page.keyboard.up(code); }
    for (const code of [...wanted].filter((c) => !held.has(c))) { held.add(code); await page.keyboard.down(code); }
  },
  async pads(list) {
    await page.evaluate((pads) => {
      const buttons = (pressed) => Array.from({ length: 17 }, (_, i) => ({ value: pressed.includes(i) ? 1 : 0 }));
      const vibrationActuator = { async playEffect(kind, { strongMagnitude }) { if (strongMagnitude > 0) window.rumbled = kind; } };
      window.pads = pads.map(({ axes = [0, 0, 0, 0], pressed = [] }) => ({ connected: true, mapping: 'standard', axes, buttons: buttons(pressed), vibrationActuator }));
      Object.defineProperty(navigator, 'getGamepads', { value: () => window.pads, configurable: true });
    }, JSON.parse(list));
  },
  async rumbled() { await until(page, () => window.rumbled === 'dual-rumble'); },
  async haste() {
    await page.evaluate(() => { for (let i = 0; i < 2; ++i) document.body.dispatchEvent(new KeyboardEvent('keydown', { code: 'KeyM', bubbles: true })); });
    const heard = await page.waitForFunction(() => (ligature.panels.parts.hands.value.isOn ? 'on' : document.querySelector('.toast.refused')?.textContent));
    if (/given back/.test(await heard.jsonValue())) throw new Error(await heard.jsonValue());
  },
  async tap(code) { await page.keyboard.press(code); },
  async close() { await page.close(); page = null; held = new Set(); },
  async blur() { other ??= await browser.context.newPage(); await other.bringToFront(); await until(page, () => !document.hasFocus()); },
  cut() { wire.cut(); },
  freeze() { wire.freeze(); },
  async heal() { wire.heal(); await page.bringToFront(); },
  async busy(ms) {
    await page.evaluate((busy_ms) => {
      clearInterval(window.busyTimer);
      window.warnings = [];
      window.watcher ??= new MutationObserver(() => { const { hidden, textContent } = document.getElementById('stale'); if (!hidden) window.warnings.push(textContent); });
      window.watcher.observe(document.getElementById('stale'), { attributes: true, childList: true });
      if (busy_ms) window.busyTimer = setInterval(() => { const end = performance.now() + busy_ms; while (performance.now() < end); }, 20);
    }, Number(ms));
  },
  async tells(what) { await until(page, TELLS[what]); },
  async unwarned() {
    const warnings = await page.evaluate(() => window.warnings);
    if (warnings.length) throw new Error(`${warnings.length} warnings: ${warnings[0]}`);
  },
  async draw(path) { await page.screenshot({ path }); },
};

console.log(`ready ${wire.url}`);
let number = 0;
for await (const line of createInterface({ input: process.stdin })) {
  const [act, argument] = line.trim().split(' ');
  ++number;
  try {
    await acts[act](argument);
    console.log(`done ${number}`);
  } catch (error) { console.log(`failed ${number} ${act}: ${error.message.split('\n')[0]}`); }
}
for (const complaint of browser.complaints) console.log(`complaint ${complaint}`);
await browser.stop();
wire.stop();
