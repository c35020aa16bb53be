// A proxy between browser and host that breaks files of the page: one throws when it is loaded (`load`), or all
// functions, constructors and methods that it exports throw from the start (`make`), or from a moment on while the page
// runs (breakNow). What is exported can be healed again (heal). Other requests pass unchanged, except that waits of a
// second and more are short in the page, so that a test need not wait for a part's next try.
import { createServer, request } from 'node:http';
import { connect } from 'node:net';

const HURRY = `{ const wait = setTimeout; window.setTimeout = (what, ms, ...more) => wait(what, ms >= 1000 ? ms / 50 : ms, ...more); }`;

export class Saboteur {
  /** @param to address of the host as "name:port". */
  static async between(to) {
    const self = new Saboteur();
    Object.assign(self, { to, broken: null, wrapsAll: false });
    self.server = createServer((asked, answer) => self.#serve(asked, answer));
    self.server.on('upgrade', (asked, socket) => self.#pipe(asked, socket));
    await new Promise((resolve) => self.server.listen(0, '127.0.0.1', resolve));
    self.url = `http://127.0.0.1:${self.server.address().port}/`;
    return self;
  }

  /** What is loaded from now on. @param file e.g. "scene.js", or null for none. @param way `load` or `make`. */
  breaks(file, way) { this.broken = file && { file, way }; }

  /** Breaks a file of a page that was loaded with `wrapsAll`. */
  breakNow(page, file) { return page.evaluate((name) => { Object.assign(window, { sabotage: name, sabotaged: 0 }); }, file); }

  /** Ends the sabotage: for what is loaded from now on, and for what this page has loaded. */
  heal(page) {
    this.broken = null;
    return page.evaluate(() => { window.sabotage = ''; });
  }

  stop() { this.server.closeAllConnections(); this.server.close(); }

  async #serve(asked, answer) {
    const [path, query = ''] = asked.url.slice(1).split('?');
    if (path === 'hurry.js') return answer.writeHead(200, { 'content-type': 'text/javascript' }).end(HURRY);
    const { status, headers, body } = await this.#fetch(asked);
    delete headers['content-length'];
    answer.writeHead(status, headers).end(/html/.test(headers['content-type']) ? hurried(body) : this.#altered(path, query, body));
  }

  #altered(path, query, body) {
    const isBroken = this.broken?.file === path;
    if (query.includes('real') || !path.endsWith('.js') || !(isBroken || this.wrapsAll)) return body;
    const text = body.toString();
    if (isBroken && (this.broken.way === 'load' || !canRun(text))) return throwing(path, text);
    return canRun(text) ? wrapped(path, query, isBroken ? path : '', text) : body;
  }

  /** Asks the host, which ends a connection after 10 s; then asks again, as a browser does. */
  async #fetch(asked) {
    for (let tries = 0; ; ++tries) try { return await this.#ask(asked); } catch (error) { if (tries === 10) throw error; }
  }

  #ask(asked) {
    const [hostname, port] = this.to.split(':');
    return new Promise((resolve, reject) => {
      request({ hostname, port, path: asked.url, headers: asked.headers }, (response) => {
        const parts = [];
        response.on('data', (part) => parts.push(part)).on('error', reject);
        response.on('end', () => resolve({ status: response.statusCode, headers: response.headers, body: Buffer.concat(parts) }));
      }).on('error', reject).end();
    });
  }

  #pipe(asked, socket) {
    const [hostname, port] = this.to.split(':'), there = connect(Number(port), hostname);
    const lines = asked.rawHeaders.flatMap((_, i, all) => (i % 2 ? [] : [`${all[i]}: ${all[i + 1]}`]));
    there.write(`GET ${asked.url} HTTP/1.1\r\n${lines.join('\r\n')}\r\n\r\n`);
    there.pipe(socket).pipe(there);
    for (const end of [there, socket]) end.on('error', () => { there.destroy(); socket.destroy(); });
  }
}

/** @returns whether the file exports something that can throw when it is used; if not, it can only fail to load. */
export function canRun(text) { return /^export (?:(?:async )?(?:function|class)\b|\{)/m.test(text); }

function hurried(body) { return body.toString().replace('<script', '<script src="hurry.js"></script>\n<script'); }

function exportedBy(text) {
  const lists = [...text.matchAll(/^export \{([^}]*)\}/gm)].flatMap((m) => m[1].split(',').map((name) => name.trim().split(' as ').at(-1)));
  return [...lists, ...[...text.matchAll(/^export (?:async )?(?:function|class|const) (\w+)/gm)].map((m) => m[1])].filter(Boolean);
}

/** A module with the same exports that throws when it is loaded. */
function throwing(path, text) {
  return `throw new Error('sabotage of ${path}');\n${exportedBy(text).map((name) => `export ${name === 'default' ? 'default 0' : `const ${name} = 0`};`).join('\n')}\n`;
}

/** A module with the same exports, each wrapped. A try of its own gets a real module of its own, as without sabotage. */
function wrapped(path, query, atFirst, text) {
  const isOurs = !/three|uPlot|Orbit/.test(path);
  return `import * as real from './${path}?real&${query}';
const spoil = (${spoiler})('${path}', '${atFirst}', ${isOurs});
${exportedBy(text).map((name) => (name === 'default' ? 'export default spoil(real.default);' : `export const ${name} = spoil(real.${name});`)).join('\n')}
`;
}

/**
 * Runs in the page. @param atFirst the file that is broken until the page's variable `sabotage` names another one or
 * none. @returns a function that wraps an export of file `path`: it throws while that file is broken.
 */
function spoiler(path, atFirst, isOurs) {
  const check = () => {
    if ((globalThis.sabotage ?? atFirst) !== path) return;
    globalThis.sabotaged = (globalThis.sabotaged ?? 0) + 1;
    throw new Error(`sabotage of ${path}`);
  };
  const guarded = (real) => function guard(...given) { check(); return real.apply(this, given); };
  const spoilMethods = ({ prototype }) => {
    for (const [name, { get, value }] of Object.entries(Object.getOwnPropertyDescriptors(prototype)))
      if (get) Object.defineProperty(prototype, name, { get: guarded(get) });
      else if (name !== 'constructor' && typeof value === 'function') prototype[name] = guarded(value);
  };
  const construct = (type, given, target) => {
    check();
    const made = Reflect.construct(type, given, target);
    // Libraries (uPlot, the renderer of three.js) keep methods in the object.
    if (!isOurs) for (const [name, value] of Object.entries(made)) if (typeof value === 'function') made[name] = guarded(value);
    return made;
  };
  return (value) => {
    if (typeof value !== 'function') return value;
    if (isOurs && /^class/.test(Function.prototype.toString.call(value))) spoilMethods(value);
    return new Proxy(value, { construct, apply: (real, self, given) => { check(); return Reflect.apply(real, self, given); } });
  };
}
