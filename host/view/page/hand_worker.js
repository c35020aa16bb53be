// Web Worker that sends the wishes for the hands, 50 times a second, by a connection of its own. While the page draws a
// slow picture, its own timers wait; a worker's do not, so that the device hears from it in time (after 0.2 s without a
// wish it releases the dead-man).
import { readFrame } from './frame.js';
import { HandWisher, SIDES } from './hand_wisher.js';

const EVERY_MS = 20, SEEN_EVERY_MS = 100, AGAIN_MS = 50;
let socket = null, token = '', seen = null, wisher = new HandWisher(), waiting = new Map(), timers = [];

const send = (message) => { if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify({ ...message, token })); };
const now = () => performance.now();

/**
 * Takes the hands that are free. Tells the page for each hand whether it has it, with the server's answer. Does nothing
 * while hands are being taken or held already, so that the page and this worker never mean different hands.
 */
function take(given) {
  if (socket) return;
  token = given;
  socket = new WebSocket(`ws://${location.host}/socket`);
  socket.binaryType = 'arraybuffer';
  const mine = socket;
  mine.onopen = async () => {
    timers = [setInterval(sendWish, EVERY_MS), setInterval(acknowledge, SEEN_EVERY_MS)];
    const answers = await Promise.all(SIDES.map((side, i) => ask(mine, side, i + 1)));
    if (mine !== socket) return;
    const told = (side, { text, grip }) => (wisher.hands[side] ? { accepted: true, grip } : { accepted: false, text: text || 'the device has gone' });
    postMessage({ taken: Object.fromEntries(SIDES.map((side, i) => [side, told(side, answers[i])])) });
    if (wisher.isEmpty) end();
  };
  mine.onmessage = ({ data }) => onFrame(readFrame(data));
  mine.onclose = () => { if (mine === socket) { end(); postMessage({ lost: 'connection' }); } };
}

/** Asks for a hand. A hand that another page is just giving back is free within a moment. @returns the server's answer. */
async function ask(mine, side, id) {
  let answer = await request({ hand: 'take', side }, id);
  while (answer.soon && mine === socket) {
    await new Promise((resolve) => setTimeout(resolve, AGAIN_MS));
    if (mine === socket) answer = await request({ hand: 'take', side }, id);
  }
  return answer;
}

function request(message, id) {
  return new Promise((resolve) => { waiting.set(id, resolve); send({ ...message, id }); });
}

function onFrame({ number, text }) {
  seen = number;
  for (const answer of text?.answers ?? []) {
    const side = SIDES[answer.id - 1];
    if (answer.accepted && side) wisher.take(side, answer, now());
    waiting.get(answer.id)?.(answer);
    waiting.delete(answer.id);
  }
  const lost = text?.hands ? wisher.hear(text.hands) : [];
  for (const side of lost) postMessage({ lost: side });
  if (lost.length && wisher.isEmpty) end();
}

/** The server sends no more than a few frames without this. Few are enough: only the hands' positions matter here. */
function acknowledge() { if (seen !== null) socket.send(JSON.stringify({ seen })); seen = null; }

function sendWish() { if (!wisher.isEmpty) send({ wish: wisher.wish(now()) }); }

/** Gives the hands back and closes the connection. */
function end() {
  for (const timer of timers) clearInterval(timer);
  for (const side of SIDES) if (wisher.hands[side]) send({ hand: 'leave', side });
  const old = socket;
  socket = null;
  old?.close();
  for (const resolve of waiting.values()) resolve({ accepted: false, text: 'not connected to the host' });
  timers = [];
  seen = null;
  waiting = new Map();
  wisher = new HandWisher();
}

onmessage = ({ data }) => {
  if (data.take !== undefined) take(data.take);
  else if (data.end) end();
  else if (data.move) wisher.move(data.move.side, data.move.by_W);
  else if (data.input && wisher.obey(data.input, now())) sendWish(); // a button does not wait for the timer
};
