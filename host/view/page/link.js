// The WebSocket to the server: frames in, small JSON messages out; comes back by itself when the server does.
import { readFrame } from './frame.js';

const RETRY_MS = 500, WATCH_MS = 40, SILENT_ROUNDS = 3;

export class Link {
  /** @param onFrame called with each frame. */
  constructor(onFrame) {
    this.onFrame = onFrame;
    this.lastFrame = performance.now();
    this.isOpen = false;
    this.waiting = new Map();
    this.nextId = 1;
    this.token = readToken();
    this.connect();
    // Rounds and not only milliseconds: while the page itself is busy, messages wait too, and that is not the host's
    // silence. After a pause of ours one round passes, and what has come in between is handled before the next.
    this.rounds = 0;
    setInterval(() => { ++this.rounds; }, WATCH_MS);
  }

  /** How long the host has said nothing, ms; 0 while it talks. */
  get silent_ms() { return this.rounds >= SILENT_ROUNDS ? performance.now() - this.lastFrame : 0; }

  connect() {
    this.socket = new WebSocket(`ws://${location.host}/socket`);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onopen = () => {
      this.isOpen = true;
      if (this.token) this.send({ token: this.token }); // who shows it keeps its place, however many come
    };
    this.socket.onmessage = ({ data }) => {
      const frame = readFrame(data);
      this.lastFrame = performance.now();
      this.rounds = 0;
      this.send({ seen: frame.number }); // without it the server soon sends no more: nothing queues up for us
      for (const answer of frame.text?.answers ?? []) this.settle(answer);
      this.onFrame(frame);
    };
    this.socket.onclose = () => {
      this.isOpen = false;
      for (const id of [...this.waiting.keys()]) this.settle({ id, accepted: false, text: 'the host is gone' });
      setTimeout(() => this.connect(), RETRY_MS);
    };
  }

  send(message) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** Sends a command; resolves with {accepted, text}. */
  command(command) { return this.request({ command }); }

  /** Sends a request that is answered. */
  request(message) {
    const id = this.nextId++;
    return new Promise((resolve) => {
      if (!this.isOpen) return resolve({ accepted: false, text: 'not connected to the host' });
      this.waiting.set(id, resolve);
      this.send({ ...message, id, token: this.token });
    });
  }

  settle(answer) {
    this.waiting.get(answer.id)?.(answer);
    this.waiting.delete(answer.id);
  }
}

/** From the page when this machine alone can ask for it, else from #token= of the address, kept for this tab. */
function readToken() {
  const given = new URLSearchParams(location.hash.slice(1)).get('token');
  if (given) {
    sessionStorage.setItem('ligature-token', given);
    history.replaceState(null, '', location.pathname);
  }
  return document.querySelector('meta[name=ligature-token]').content || sessionStorage.getItem('ligature-token') || '';
}
