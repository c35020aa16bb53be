// Buttons and keys that command the rig, except STOP (guard.js). The result of each command is shown: done, or refused
// with the reason.
const $ = (id) => document.getElementById(id);
const COMMANDS = { arm: 'arm', disarm: 'disarm', 'reset-thread': 'reset-thread', 'reset-fault': 'reset-fault' };
const KEYS = { a: 'arm', d: 'disarm', t: 'reset-thread', r: 'reset-fault' };
const TOAST_MS = 4000;
/** Keys (event.code) that are in use for moving the hands (hand_keys.js) and must not trigger commands. */
export const takenKeys = new Set();

export function setUpControls(link, isReplay) {
  const give = async (command) => {
    if (isReplay()) return;
    const answer = await link.command(command);
    toast(`${command}: ${answer.accepted ? answer.text || 'done' : `refused – ${answer.text}`}`, !answer.accepted);
  };
  for (const [id, command] of Object.entries(COMMANDS)) $(id).addEventListener('click', () => give(command));
  for (const button of document.querySelectorAll('[data-command]')) button.addEventListener('click', () => give(button.dataset.command));
  if (!window.ligatureGuard) standInForGuard(() => give('stop'), isReplay);
  addEventListener('keydown', (event) => {
    if (isTyping(event) || document.querySelector('dialog[open]')) return;
    const command = KEYS[event.key.toLowerCase()];
    if (command) { event.preventDefault(); give(command); }
  }, { capture: true });
}

/** Makes STOP work when guard.js was not loaded. */
function standInForGuard(stop, isReplay) {
  $('stop').addEventListener('click', stop);
  addEventListener('keydown', (event) => {
    if (event.code !== 'Space' || isReplay()) return;
    if (!event.repeat) stop();
    if (!isText(event.target)) event.preventDefault();
  }, { capture: true });
}

function isText(target) { return target.tagName === 'TEXTAREA' || (target.tagName === 'INPUT' && target.type === 'text'); }

export function isTyping(event) {
  return takenKeys.has(event.code) || event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === 'SELECT' || isText(event.target);
}

/** Opens or closes a panel (`change`, `exercise`). Only one is open at a time, because they have the same place. */
export function showPanel(id, on) {
  for (const panel of document.querySelectorAll('section.change')) {
    const isOpen = on && panel.id === id;
    if (panel.id !== id && !on) continue;
    panel.hidden = !isOpen;
    $(`${panel.id}-open`).setAttribute('aria-expanded', isOpen);
  }
}

export function toast(text, refused) {
  const box = document.createElement('div');
  box.className = refused ? 'toast refused' : 'toast';
  box.textContent = text;
  $('toasts').append(box);
  while ($('toasts').children.length > 4) $('toasts').firstChild.remove();
  setTimeout(() => box.remove(), TOAST_MS);
}
