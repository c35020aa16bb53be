// STOP, and the check that the page itself is alive. This classic script imports nothing, so that a failure of another
// file cannot disable it. It is loaded first, and uses its own WebSocket when the page's does not answer.
'use strict';
(() => {
  const PATIENCE_MS = 300; // how long the page's own connection may take to answer before STOP is sent by a second one
  const ROUND_MS = 500, SILENT_ROUNDS = 4;
  const $ = (id) => document.getElementById(id);
  const isReplay = () => document.body.classList.contains('is-replay');
  let link = null, rounds = 0, hasLived = false;

  /**
   * Interface for the other scripts: beat() is called after each state that was shown and proves that they are alive.
   */
  window.ligatureGuard = { useLink: (given) => { link = given; }, beat: () => { rounds = 0; hasLived = true; }, stop };

  /** Sends STOP. @returns {{accepted, text}} */
  async function stop() {
    let answered = null;
    try {
      if (link?.isOpen) answered = link.command('stop'); // sent immediately on the page's connection
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

  /** Reads the token as link.js does; needed here in case link.js is not loaded. */
  function token() {
    const given = new URLSearchParams(location.hash.slice(1)).get('token');
    let kept = null;
    try { kept = sessionStorage.getItem('ligature-token'); } catch { /* storage is disabled in this browser */ }
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

  // Capture phase, registered first: the space bar stops the rig, whatever has the focus.
  addEventListener('keydown', (event) => {
    if (event.code !== 'Space' || isReplay()) return;
    if (!event.repeat) stop();
    if (isText(event.target)) return; // in a text field the space is also typed
    event.preventDefault();
    event.stopImmediatePropagation();
  }, { capture: true });
  addEventListener('keyup', (event) => { if (event.code === 'Space' && !isReplay() && !isText(event.target)) event.preventDefault(); }, { capture: true });
  addEventListener('click', (event) => {
    if (!event.target.closest?.('#stop')) return;
    event.stopImmediatePropagation();
    stop();
  }, { capture: true });

  // Replaces the state by UNKNOWN when the other scripts no longer update it.
  setInterval(() => {
    if (document.hidden || isReplay() || ++rounds < SILENT_ROUNDS) return;
    $('state').dataset.state = 'none';
    $('state-name').textContent = 'UNKNOWN';
    $('state-note').textContent = `${hasLived ? 'this page has failed' : 'the page is loading or has failed'}: reload it. STOP works`;
  }, ROUND_MS);
})();
