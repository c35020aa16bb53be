// STOP and the watch over the page itself. A classic script that imports nothing, so that no other file of the page can
// take it down: it listens before the others are loaded, and sends by a socket of its own where theirs does not answer.
'use strict';
(() => {
  const PATIENCE_MS = 300; // the page's own connection answers within this, or STOP goes by a second one
  const ROUND_MS = 500, SILENT_ROUNDS = 4;
  const $ = (id) => document.getElementById(id);
  const isReplay = () => document.body.classList.contains('is-replay');
  let link = null, rounds = 0, hasLived = false;

  /** The other scripts tell that they live: with each state that they have shown. */
  window.ligatureGuard = { useLink: (given) => { link = given; }, beat: () => { rounds = 0; hasLived = true; }, stop };

  /** @returns {{accepted, text}} */
  async function stop() {
    let answered = null;
    try {
      if (link?.isOpen) answered = link.command('stop'); // sent here and now
    } catch { answered = null; }
    const patience = new Promise((resolve) => setTimeout(resolve, PATIENCE_MS, null));
    let answer = answered && await Promise.race([Promise.resolve(answered).catch(() => null), patience]);
    if (!answer?.accepted) answer = await bySocketOfItsOwn();
    say(`stop: ${answer.accepted ? answer.text || 'done' : `refused – ${answer.text}`}`, !answer.accepted);
    return answer;
  }

  function bySocketOfItsOwn() {
    return new Promise((resolve) => {
      const lost = () => resolve({ accepted: false, text: 'it did not reach the host. Let go of the dead-man' });
      let socket;
      try { socket = new WebSocket(`ws://${location.host}/socket`); } catch { return lost(); }
      socket.binaryType = 'arraybuffer';
      socket.onopen = () => socket.send(JSON.stringify({ command: 'stop', id: 1, token: token() }));
      socket.onmessage = ({ data }) => {
        const found = new TextDecoder('latin1').decode(data).match(/"answers":\[\{"accepted":(true|false).*?"text":"((?:[^"\\]|\\.)*)"/);
        if (!found) return socket.send(JSON.stringify({ seen: new DataView(data).getUint32(4, true) }));
        resolve({ accepted: found[1] === 'true', text: found[2] });
        socket.close();
      };
      socket.onclose = lost;
    });
  }

  /** As link.js has it; here for the time before it is there, or without it. */
  function token() {
    const given = new URLSearchParams(location.hash.slice(1)).get('token');
    let kept = null;
    try { kept = sessionStorage.getItem('ligature-token'); } catch { /* a browser that keeps nothing */ }
    return given || document.querySelector('meta[name=ligature-token]').content || kept || '';
  }

  function say(text, refused) {
    const box = document.createElement('div');
    box.className = refused ? 'toast refused' : 'toast';
    box.textContent = text;
    $('toasts').append(box);
    setTimeout(() => box.remove(), 4000);
  }

  function isText(target) { return target.tagName === 'TEXTAREA' || (target.tagName === 'INPUT' && target.type === 'text'); }

  // In the capture phase and before anything else: space stops, whatever has the focus.
  addEventListener('keydown', (event) => {
    if (event.code !== 'Space' || isReplay()) return;
    if (!event.repeat) stop();
    if (isText(event.target)) return; // the blank is written as well
    event.preventDefault();
    event.stopImmediatePropagation();
  }, { capture: true });
  addEventListener('keyup', (event) => { if (event.code === 'Space' && !isReplay() && !isText(event.target)) event.preventDefault(); }, { capture: true });
  addEventListener('click', (event) => {
    if (!event.target.closest?.('#stop')) return;
    event.stopImmediatePropagation();
    stop();
  }, { capture: true });

  // A state that nobody keeps up to date must not stand there as if it were true.
  setInterval(() => {
    if (document.hidden || isReplay() || ++rounds < SILENT_ROUNDS) return;
    $('state').dataset.state = 'none';
    $('state-name').textContent = 'UNKNOWN';
    $('state-note').textContent = `${hasLived ? 'this page has failed' : 'the page is loading or has failed'}: reload it. STOP works`;
  }, ROUND_MS);
})();
