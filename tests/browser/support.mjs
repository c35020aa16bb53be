// Child processes, a browser and raw WebSocket clients for the tests of the page.
import { spawn } from 'node:child_process';
import { createServer } from 'node:http';
import { connect } from 'node:net';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';

// Longest wait for a condition; long, because shared machines can be slow.
const PATIENCE_MS = Number(process.env.LIGATURE_PATIENCE_MS ?? 60_000);

export function arguments_() {
  const given = {};
  for (let i = 2; i < process.argv.length; i += 2) given[process.argv[i].replace(/^--/, '')] = process.argv[i + 1];
  return given;
}

/** Waits until a condition holds in the page. */
export function until(page, condition) { return page.waitForFunction(condition, null, { timeout: PATIENCE_MS }); }

const children = [];
process.once('exit', () => children.forEach((child) => child.kill('SIGKILL')));  // else ctest waits for them after an error

/** A child process whose output is stored; it ends with this one. */
export class Program {
  constructor(command, args) {
    this.heard = '';
    this.child = spawn(command, args, { stdio: ['pipe', 'pipe', 'inherit'] });
    children.push(this.child);
    this.child.stdout.on('data', (data) => { this.heard += data; this.news?.(); });
    this.end_ = new Promise((resolve) => this.child.on('exit', (code) => { this.news?.(); resolve(code); }));
  }

  /** Waits for output that matches the pattern. @returns its first group, or the whole match. */
  async says(pattern) {
    const until_ms = Date.now() + PATIENCE_MS;
    for (;;) {
      const found = this.heard.match(pattern);
      if (found) return found[1] ?? found[0];
      const left_ms = until_ms - Date.now();
      if (left_ms <= 0 || this.child.exitCode !== null) throw new Error(`never said ${pattern}: ${this.heard}`);
      await new Promise((resolve) => { this.news = resolve; setTimeout(resolve, left_ms); });
    }
  }

  tell(line) { this.child.stdin.write(`${line}\n`); }
  /** Ends the process with SIGTERM. @returns its exit code. */
  stop() { this.child.kill('SIGTERM'); return this.end_; }
  ended() { return this.end_; }
  peakMemory_kB() { return Number(readFileSync(`/proc/${this.child.pid}/status`, 'utf8').match(/VmHWM:\s+(\d+)/)[1]); }
}

function startChromium({ chromium }, webgl) {
  const drawing = webgl ? ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'] : ['--disable-gpu', '--disable-3d-apis'];
  return chromium.launch({
    executablePath: process.env.LIGATURE_CHROMIUM ?? '/usr/bin/chromium', headless: true,
    args: ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync', ...drawing],
  });
}

/** Headless Firefox has no WebGL; for WebGL it runs on a virtual screen, whose number Xvfb chooses and prints. */
async function startFirefox({ _bidiFirefox: firefox }, webgl) {
  const screen = webgl ? new Program('Xvfb', ['-displayfd', '1', '-screen', '0', '1600x1000x24', '-nolisten', 'tcp']) : null;
  const env = screen ? { ...process.env, DISPLAY: `:${await screen.says(/^(\d+)\n/)}`, LIBGL_ALWAYS_SOFTWARE: '1' } : process.env;
  const options = {
    executablePath: process.env.LIGATURE_FIREFOX ?? '/usr/bin/firefox-esr', headless: !screen, env,
    firefoxUserPrefs: webgl ? { 'webgl.force-enabled': true } : { 'webgl.disabled': true },
  };
  const started = await firefox.launch(options).catch((error) => {
    if (!/unknown command/.test(error.message)) throw error;
    const remedy = 'apt install firefox-esr, with the -security suite of your Debian among apt\'s sources';
    throw new Error(`${error.message.split('\n')[0]}: this Firefox is too old; remedy: ${remedy}`);
  });
  if (screen) started.on('disconnected', () => screen.stop());
  return started;
}

export class Browser {
  /** @param kind 'chromium', or 'firefox', driven by WebDriver BiDi. @param webgl whether pages have WebGL. */
  static async start({ kind = 'chromium', webgl = true } = {}) {
    const { modules } = arguments_(), playwright = createRequire(join(modules, 'x.js'))('playwright-core');
    const browser = new Browser();
    browser.complaints = [];
    browser.servers = [];
    browser.process = await (kind === 'firefox' ? startFirefox(playwright, webgl) : startChromium(playwright, webgl));
    browser.context = await browser.process.newContext({ viewport: { width: 1280, height: 800 } });
    return browser;
  }

  /** Sets the size of later pages and of the reused page (sheet()). */
  async resize(width, height) {
    this.viewport = { width, height };
    await (await this.sheet()).setViewportSize(this.viewport);
  }

  /** A page that is reused and whose console errors are allowed. */
  async sheet() {
    this.sheet_ ??= await this.context.newPage();
    this.sheet_.setDefaultTimeout(PATIENCE_MS);
    return this.sheet_;
  }

  /** Opens a new page; any console error in it is a failure of the test. */
  async open(url) {
    const page = await this.context.newPage();
    page.setDefaultTimeout(PATIENCE_MS);
    if (this.viewport) await page.setViewportSize(this.viewport);
    page.on('pageerror', (error) => this.complaints.push(`${error.stack}`));
    page.on('console', (message) => { if (['error', 'warning'].includes(message.type()) && !/GPU stall|ReadPixels/.test(message.text())) this.complaints.push(message.text()); });
    await page.goto(url);
    return page;
  }

  async openHtml(url) {
    const page = await this.context.newPage();
    await page.goto(url);
    return page;
  }

  /** Serves one page from another port, i.e. another origin. @returns the port. */
  serve(html) {
    const server = createServer((_, response) => response.setHeader('Content-Type', 'text/html').end(html));
    this.servers.push(server);
    return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(server.address().port)));
  }

  async stop() {
    for (const server of this.servers) server.close();
    await this.process.close();
  }
}

/** A WebSocket client on a plain socket, which can break the protocol as no browser does. */
export function clientOf(at, { reads = true } = {}) {
  const [hostname, port] = at.split(':');
  const socket = connect(Number(port), hostname);
  let received = Buffer.alloc(0), news = () => {}, isClosed = false;
  socket.on('error', () => {});
  socket.on('close', () => { isClosed = true; news(); });
  socket.on('data', (data) => { received = Buffer.concat([received, data]); news(); });
  socket.write(`GET /socket HTTP/1.1\r\nHost: ${at}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n`);
  const waitFor = async (condition) => {
    const until_ms = Date.now() + PATIENCE_MS;
    while (!condition()) {
      if (Date.now() > until_ms) throw new Error('the peer waited in vain');
      await new Promise((resolve) => { news = resolve; setTimeout(resolve, 500); });
    }
  };
  const peer = {
    /** Sends one masked text frame. */
    send(text) {
      const payload = Buffer.from(text), mask = Buffer.from([1, 2, 3, 4]);
      const head = payload.length < 126 ? Buffer.from([0x81, 0x80 | payload.length]) : Buffer.from([0x81, 0xfe, payload.length >> 8, payload.length & 255]);
      socket.write(Buffer.concat([head, mask, payload.map((byte, i) => byte ^ mask[i % 4])]));
    },
    /** Sends the header of a text frame of the given length, and one megabyte of data. */
    sendHeaderOf(size) {
      const head = Buffer.alloc(14);
      head.set([0x81, 0xff]);
      head.writeBigUInt64BE(BigInt(size), 2);
      socket.write(Buffer.concat([head, Buffer.alloc(1 << 20)]));
    },
    closed: () => waitFor(() => isClosed),
    /** Waits until an answer has arrived. @returns everything received, as text. */
    text: async () => { await waitFor(() => received.includes('"answers"')); return received.toString('latin1'); },
    end: () => socket.destroy(),
  };
  return waitFor(() => received.includes('\r\n\r\n') || isClosed).then(() => { if (!reads) socket.pause(); return peer; });
}
