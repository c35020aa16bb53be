// `ligature-host stream` read by the client library of Foxglove's maker (npm: @foxglove/ws-protocol), and its limits.
//   node stream_test.mjs --host BIN --python PYTHON --rig SCRIPT --modules DIR     (inside scripts/private-net)
import assert from 'node:assert/strict';
import { createSocket } from 'node:dgram';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { Program, arguments_ } from './support.mjs';

const { host, python, rig: rigScript, modules } = arguments_();
const require = createRequire(join(modules, 'x.js'));
const { FoxgloveClient } = require('@foxglove/ws-protocol'), { WebSocket } = require('ws');
const PATIENCE_MS = Number(process.env.LIGATURE_PATIENCE_MS ?? 60_000);
const decoder = new TextDecoder();

/** Waits for a promise, with a limit that only ends a hang. */
function soon(promise, what) {
  let timer;
  const late = new Promise((_, reject) => { timer = setTimeout(() => reject(new Error(`never came: ${what}`)), PATIENCE_MS); });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

/** A viewer that has subscribed to these topics. @returns {client, info, channels, next}; next(topic) gives a message. */
async function viewer(at, topics) {
  const client = new FoxgloveClient({ ws: new WebSocket(at, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]) });
  const once = (name) => new Promise((resolve) => { client.on(name, resolve); });
  const [info, channels] = await soon(Promise.all([once('serverInfo'), once('advertise')]), 'serverInfo and advertise');
  const topicOf = new Map(), queues = new Map(), waiting = new Map();
  client.on('message', ({ subscriptionId, timestamp, data }) => {
    const topic = topicOf.get(subscriptionId);
    const message = { timestamp, data: JSON.parse(decoder.decode(data)) };
    if (waiting.has(topic)) { waiting.get(topic)(message); waiting.delete(topic); } else queues.get(topic).push(message);
  });
  for (const topic of topics) {
    queues.set(topic, []);
    topicOf.set(client.subscribe(channels.find((channel) => channel.topic === topic).id), topic);
  }
  const next = (topic) => {
    const queue = queues.get(topic);
    return queue.length > 0 ? Promise.resolve(queue.shift()) : soon(new Promise((resolve) => { waiting.set(topic, resolve); }), topic);
  };
  return { client, info, channels, next, queues };
}

/** The HTTP status with which the WebSocket is refused. */
function refusal(at, protocols, headers = {}) {
  return soon(new Promise((resolve, reject) => {
    const socket = new WebSocket(at, protocols, { headers });
    socket.on('unexpected-response', (_, response) => resolve(response.statusCode));
    socket.on('open', () => { socket.close(); resolve(101); });
    socket.on('error', (error) => reject(error));
  }), 'an answer');
}

const udp = createSocket('udp4');
await new Promise((resolve) => { udp.bind(0, '127.0.0.1', resolve); });
const datagrams = [];
let heardDatagram = () => {};
udp.on('message', (data) => { datagrams.push(data); heardDatagram(); });

const rig = new Program(python, [rigScript]);
await rig.says(/ready/);
const stream = new Program(host, ['stream', '--port', '0', '--udp', `127.0.0.1:${udp.address().port}`]);
const at = await stream.says(/ws:\S+/);

const steps = {
  'the maker\'s client gets every tick once, in order and evenly spaced': async () => {
    const { client, info, channels, next } = await viewer(at, ['/rig', '/left']);
    assert.match(info.name, /^ligature-host/);
    assert.deepEqual(channels.map((channel) => channel.topic), ['/rig', '/left', '/right', '/thread', '/events']);
    let before = await next('/rig');
    for (let i = 0; i < 300; ++i) {
      const now = await next('/rig');
      assert.equal(now.data.tick, before.data.tick + 1);
      assert.equal(now.timestamp - before.timestamp, 1_000_000n);
      before = now;
    }
    const left = await next('/left');
    assert.equal(typeof left.data.device_f_x_N, 'number');
    const fields = JSON.parse(channels.find((channel) => channel.topic === '/left').schema).properties;
    assert.deepEqual(new Set(Object.keys(left.data)), new Set(Object.keys(fields)));
    client.close();
  },
  'the thread comes as a line, and events as they happen': async () => {
    const { client, next } = await viewer(at, ['/thread', '/events']);
    const { data } = await next('/thread');
    assert.equal(data.entities[0].lines[0].points.length, 120);
    assert.equal(data.entities[0].frame_id, 'W');
    rig.tell('fault 11');
    assert.equal((await next('/events')).data.text, 'fault 11');
    client.close();
  },
  'what is no longer wanted no longer comes': async () => {
    const { client, next, queues } = await viewer(at, ['/rig', '/thread']);
    await next('/rig');
    client.unsubscribe(0);
    await next('/thread');
    queues.get('/rig').length = 0;
    for (let i = 0; i < 20; ++i) await next('/thread');
    const late = queues.get('/rig').length;
    for (let i = 0; i < 20; ++i) await next('/thread');
    assert.equal(queues.get('/rig').length, late);
    client.close();
  },
  'other web sites, other hosts and other protocols are refused': async () => {
    const protocol = FoxgloveClient.SUPPORTED_SUBPROTOCOL;
    assert.equal(await refusal(at, [protocol], { origin: 'https://app.foxglove.dev' }), 101);
    assert.equal(await refusal(at, [protocol], { origin: 'https://hostile.example' }), 403);
    assert.equal(await refusal(at, [protocol], { host: 'rebind.example' }), 403);
    assert.equal(await refusal(at, ['other.v1']), 400);
  },
  'a viewer that does not read is no burden and delays nobody': async () => {
    const idle = new WebSocket(at, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
    await soon(new Promise((resolve) => { idle.on('open', resolve); }), 'open');
    idle.send(JSON.stringify({ op: 'subscribe', subscriptions: [0, 1, 2, 3].map((id) => ({ id, channelId: id })) }));
    idle.pause();
    const { client, next } = await viewer(at, ['/rig']);
    const first = await next('/rig');
    for (let i = 0; i < 3000; ++i) await next('/rig');
    assert.ok((await next('/rig')).data.tick >= first.data.tick + 3000);
    assert.ok(stream.peakMemory_kB() < 100_000, `${stream.peakMemory_kB()} kB`);
    idle.terminate();
    client.close();
  },
  'each tick is one UDP datagram for PlotJuggler': async () => {
    datagrams.length = 0;
    while (datagrams.length < 50) await soon(new Promise((resolve) => { heardDatagram = resolve; }), 'a datagram');
    const ticks = datagrams.map((data) => JSON.parse(data.toString()));
    for (let i = 1; i < ticks.length; ++i) {
      assert.equal(ticks[i].rig.tick, ticks[i - 1].rig.tick + 1);
      assert.ok(Math.abs(ticks[i].timestamp - ticks[i - 1].timestamp - 1e-3) < 1e-6);
    }
    assert.equal(typeof ticks[0].right.device_f_x_N, 'number');
  },
  'SIGTERM ends it': async () => { assert.equal(await soon(stream.stop(), 'its end'), 0); },
};

let failed = 0;
for (const [name, step] of Object.entries(steps)) {
  try {
    await step();
    console.log(`ok   ${name}`);
  } catch (error) {
    failed = 1;
    console.log(`FAIL ${name}\n${error.stack}`);
  }
}
udp.close();
await rig.stop();
process.exit(failed);
