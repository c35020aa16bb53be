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
  // In the capture phase and before anything else: space stops, whatever has the focus.
  addEventListener('keydown', (event) => {
    if (event.code === 'Space' && !isReplay()) {
      event.preventDefault();
      event.stopImmediatePropagation();
      if (!event.repeat) give('stop');
      return;
    }
    if (isTyping(event) || $('help').open) return;
    const command = KEYS[event.key.toLowerCase()];
    if (command) { event.preventDefault(); give(command); }
  }, { capture: true });
  addEventListener('keyup', (event) => { if (event.code === 'Space' && !isReplay()) event.preventDefault(); }, { capture: true });
}

export function isTyping(event) {
  return event.ctrlKey || event.metaKey || event.altKey || ['SELECT', 'TEXTAREA'].includes(event.target.tagName)
    || (event.target.tagName === 'INPUT' && event.target.type === 'text');
}

export function toast(text, refused) {
  const box = document.createElement('div');
  box.className = refused ? 'toast refused' : 'toast';
  box.textContent = text;
  $('toasts').append(box);
  while ($('toasts').children.length > 4) $('toasts').firstChild.remove();
  setTimeout(() => box.remove(), TOAST_MS);
}
