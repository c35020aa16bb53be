// A proxy between browser and host that breaks one file of the page: it throws when loaded (`load`), or all functions
// and constructors that it exports throw (`make`), or all methods of its classes (`run`). Other requests pass unchanged.
import { createServer, request } from 'node:http';
import { connect } from 'node:net';

export const WAYS = ['load', 'make', 'run'];

export class Saboteur {
  /** @param to address of the host as "name:port". */
  static async between(to) {
    const self = new Saboteur();
    self.to = to;
    self.broken = null;
    self.server = createServer((asked, answer) => self.#serve(asked, answer));
    self.server.on('upgrade', (asked, socket) => self.#pipe(asked, socket));
    await new Promise((resolve) => self.server.listen(0, '127.0.0.1', resolve));
    self.url = `http://127.0.0.1:${self.server.address().port}/`;
    return self;
  }

  /** @param file e.g. "scene.js", or null for none. @param way one of WAYS. */
  breaks(file, way) { this.broken = file && { file, way }; }

  stop() { this.server.closeAllConnections(); this.server.close(); }

  async #serve(asked, answer) {
    const path = asked.url.split('?')[0].slice(1), isReal = asked.url.includes('real');
    const { status, headers, body } = await this.#fetch(asked);
    const isBroken = !isReal && this.broken?.file === path;
    const text = isBroken ? broken(path, this.broken.way, body.toString()) : body;
    delete headers['content-length'];
    answer.writeHead(status, headers).end(text);
  }

  #fetch(asked) {
    const [hostname, port] = this.to.split(':');
    return new Promise((resolve, reject) => {
      request({ hostname, port, path: asked.url, headers: asked.headers }, (response) => {
        const parts = [];
        response.on('data', (part) => parts.push(part));
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

function broken(path, way, text) {
  if (way === 'load' || !/^export /m.test(text)) return `throw new Error('sabotage of ${path}');`;
  const names = [...text.matchAll(/^export (?:async )?(?:function|class|const) (\w+)/gm)].map((m) => m[1]);
  const throwing = `() => { throw new Error('sabotage of ${path}'); }`;
  const helpers = `const isClass = (v) => typeof v === 'function' && /^class/.test(Function.prototype.toString.call(v));
function methods(type) {
  for (const name of Object.getOwnPropertyNames(type.prototype)) if (name !== 'constructor') {
    const { get } = Object.getOwnPropertyDescriptor(type.prototype, name);
    Object.defineProperty(type.prototype, name, get ? { get: ${throwing} } : { value: ${throwing} });
  }
  return type;
}
const spoil = (v) => (typeof v !== 'function' ? v : ${way === 'run' ? 'isClass(v) ? methods(v) : v' : `isClass(v) ? class { constructor() { throw new Error('sabotage of ${path}'); } } : ${throwing}`});
`;
  return `import * as real from './${path}?real';\n${helpers}${names.map((name) => `export const ${name} = spoil(real.${name});`).join('\n')}\n`;
}

/** @returns the WAYS that have an effect on this file, from what it exports. */
export function waysFor(text) {
  if (!/^export /m.test(text)) return ['load'];
  return [...(/^export (?:async )?(function|class)/m.test(text) ? ['load', 'make'] : ['load']), ...(/^export class/m.test(text) ? ['run'] : [])];
}
