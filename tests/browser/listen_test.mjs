// `view --listen` on an address of a private network: who may see the page, and who may send commands.
//   node listen_test.mjs --host BIN --python PYTHON --rig SCRIPT --modules DIR --out DIR     (inside
// scripts/private-net)
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { request } from 'node:http';
import { Program, arguments_, clientOf } from './support.mjs';

const { host, python, rig: rigScript, out } = arguments_();
const ADDRESS = '10.77.0.1', TOKEN = 'a-token-of-the-lab-0123456789';
mkdirSync(out, { recursive: true });
execFileSync('ip', ['address', 'add', `${ADDRESS}/32`, 'dev', 'lo']);
writeFileSync(join(out, 'token'), `${TOKEN}\n`, { mode: 0o600 });
const rig = new Program(python, [rigScript]);

/** Sends GET / with these headers. @returns {status, body}. */
function get(at, headers = {}) {
  const [hostname, port] = at.split(':');
  return new Promise((resolve, reject) => {
    const asked = request({ hostname, port, path: '/', headers: { host: at, ...headers } }, (response) => {
      let body = '';
      response.on('data', (data) => { body += data; });
      response.on('end', () => resolve({ status: response.statusCode, body }));
    });
    asked.on('error', reject);
    asked.end();
  });
}

async function answerTo(at, message) {
  const peer = await clientOf(at);
  peer.send(JSON.stringify({ id: 1, ...message }));
  const text = await peer.text();
  peer.end();
  return text;
}

async function started(args) {
  const view = new Program(host, ['view', '--listen', ADDRESS, '--port', '0', ...args]);
  return [view, new URL(await view.says(/open (\S+)/)).host];
}

const steps = {
  'without a token file: pages may look, nobody may command': async () => {
    const [view, at] = await started([]);
    assert.match(view.heard, /pages may look, not command/);
    const page = await get(at);
    assert.equal(page.status, 200);
    assert.match(page.body, /name="ligature-token" content=""/);
    assert.match(await answerTo(at, { command: 'arm', token: '' }), /may only look/);
    assert.match(await answerTo(at, { record: 'start', name: 'x', token: '' }), /"accepted":false/);
    assert.equal(await view.stop(), 0);
  },
  'with one: its first line commands, and the page does not carry it': async () => {
    const [view, at] = await started(['--token-file', join(out, 'token')]);
    const page = await get(at);
    assert.match(page.body, /name="ligature-token" content=""/);
    assert.ok(!page.body.includes(TOKEN));
    assert.match(await answerTo(at, { command: 'arm', token: '' }), /token is not the one/);
    assert.match(await answerTo(at, { command: 'arm', token: `${TOKEN}x` }), /token is not the one/);
    assert.ok(!rig.heard.includes('command arm'));
    assert.match(await answerTo(at, { command: 'arm', token: TOKEN }), /"accepted":true/);
    await rig.says(/command arm/);
    assert.equal(await view.stop(), 0);
  },
  'another name for us and another site are turned away': async () => {
    const [view, at] = await started(['--token-file', join(out, 'token')]);
    assert.equal((await get(at, { host: 'rebind.example' })).status, 403);
    const headers = { connection: 'Upgrade', upgrade: 'websocket', 'sec-websocket-version': '13', 'sec-websocket-key': 'dGhlIHNhbXBsZSBub25jZQ==' };
    assert.equal((await get(at, { ...headers, origin: 'http://hostile.example' })).status, 403);
    assert.equal(await view.stop(), 0);
  },
};

let failed = 0;
await rig.says(/ready/);
for (const [name, step] of Object.entries(steps)) {
  try {
    await step();
    console.log(`ok   ${name}`);
  } catch (error) {
    failed = 1;
    console.log(`FAIL ${name}\n${error.stack}`);
  }
}
await rig.stop();
process.exit(failed);
