// WebSocket to the server: receives frames, sends small JSON messages, and reconnects by itself.
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
    // The host's silence is measured in timer rounds as well as in ms. While the page itself is busy, messages wait in
    // the browser although the host is not silent. After such a pause only one round is counted before these messages
    // are handled.
    this.rounds = 0;
    setInterval(() => { ++this.rounds; }, WATCH_MS);
  }

  /** Time since the host's last frame, ms; 0 while frames arrive. */
  get silent_ms() { return this.rounds >= SILENT_ROUNDS ? performance.now() - this.lastFrame : 0; }

  connect() {
    this.socket = new WebSocket(`ws://${location.host}/socket`);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onopen = () => {
      this.isOpen = true;
      if (this.token) this.send({ token: this.token }); // pages that send the token cannot be displaced by other clients
    };
    this.socket.onmessage = ({ data }) => {
      const frame = readFrame(data);
      this.lastFrame = performance.now();
      this.rounds = 0;
      this.send({ seen: frame.number }); // the server sends no more than a few frames without this acknowledgement, so that no backlog builds up
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

  /** Sends a command. @returns a promise of {accepted, text}. */
  command(command) { return this.request({ command }); }

  /** Sends a request that gets an answer. @returns a promise of the answer. */
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

/**
 * The token: contained in the page when only this machine can load it, else from #token= in the address, stored for
 * this tab.
 */
function readToken() {
  const given = new URLSearchParams(location.hash.slice(1)).get('token');
  let kept = given;
  try {
    if (given) sessionStorage.setItem('ligature-token', given); else kept = sessionStorage.getItem('ligature-token');
    if (given) history.replaceState(null, '', location.pathname);
  } catch { /* storage is disabled in this browser: the token stays in the address */ }
  return document.querySelector('meta[name=ligature-token]').content || kept || '';
}
