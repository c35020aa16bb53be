// Buttons and keys that command the rig. Each press is answered: done, or refused with the reason.
const $ = (id) => document.getElementById(id);
const COMMANDS = { arm: 'arm', disarm: 'disarm', stop: 'stop', 'reset-thread': 'reset-thread', 'reset-fault': 'reset-fault' };
const KEYS = { a: 'arm', d: 'disarm', t: 'reset-thread', r: 'reset-fault' };
const TOAST_MS = 4000;

export function setUpControls(link, isReplay) {
  const give = async (command) => {
    if (isReplay()) return;
    const answer = await link.command(command);
    toast(`${command}: ${answer.accepted ? answer.text || 'done' : `refused – ${answer.text}`}`, !answer.accepted);
  };
  for (const [id, command] of Object.entries(COMMANDS)) $(id).addEventListener('click', () => give(command));
  for (const button of document.querySelectorAll('[data-command]')) button.addEventListener('click', () => give(button.dataset.command));
  // In the capture phase and before anything else: space stops, whatever has the focus.
  addEventListener('keydown', (event) => {
    if (event.code === 'Space' && !isReplay()) {
      if (!event.repeat) give('stop');
      if (isText(event.target)) return; // the blank is written as well
      event.preventDefault();
      event.stopImmediatePropagation();
      return;
    }
    if (isTyping(event) || document.querySelector('dialog[open]')) return;
    const command = KEYS[event.key.toLowerCase()];
    if (command) { event.preventDefault(); give(command); }
  }, { capture: true });
  addEventListener('keyup', (event) => { if (event.code === 'Space' && !isReplay() && !isText(event.target)) event.preventDefault(); }, { capture: true });
}

function isText(target) { return target.tagName === 'TEXTAREA' || (target.tagName === 'INPUT' && target.type === 'text'); }

export function isTyping(event) {
  return event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === 'SELECT' || isText(event.target);
}

/** The button that starts a recording with a name and notes, and ends it. */
export function setUpRecording(link) {
  const say = (answer, what) => toast(`${what}: ${answer.accepted ? answer.text : `refused – ${answer.text}`}`, !answer.accepted);
  $('record').addEventListener('click', async () => {
    if ($('record').dataset.on === 'true') return say(await link.request({ record: 'stop' }), 'recorded');
    $('record-name').value = new Date().toISOString().slice(0, 19).replace(/[:T]/g, '-');
    $('record-notes').value = '';
    $('record-dialog').showModal();
  });
  $('record-dialog').addEventListener('close', async () => {
    if ($('record-dialog').returnValue !== 'start') return;
    say(await link.request({ record: 'start', name: $('record-name').value, notes: $('record-notes').value }), 'recording');
  });
}

export function showRecording({ on, file, why }) {
  $('record').dataset.on = on;
  $('record').textContent = on ? `■ ${file}` : '● Record';
  if (why) toast(`recording of ${file} ended: ${why}`, true);
}

export function toast(text, refused) {
  const box = document.createElement('div');
  box.className = refused ? 'toast refused' : 'toast';
  box.textContent = text;
  $('toasts').append(box);
  while ($('toasts').children.length > 4) $('toasts').firstChild.remove();
  setTimeout(() => box.remove(), TOAST_MS);
}
