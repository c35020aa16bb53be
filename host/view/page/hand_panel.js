// Panel with the state of the hands that the user moves from this page.
const $ = (id) => document.getElementById(id);

export function showMode(isOn) {
  $('hand-panel').hidden = !isOn;
  $('hands-toggle').classList.toggle('on', isOn);
  $('hands-toggle').setAttribute('aria-pressed', String(isOn));
}

/** @param mine {left?: {grip, deadMan}, right?}, the taken hands. @param hands of the newest tick. */
export function showHandsHeld(mine, hands, pace_m_per_s) {
  ['left', 'right'].forEach((side, i) => {
    const hand = mine[side], button = $(`jaws-${side}`);
    button.hidden = !hand;
    if (!hand) return;
    const words = hand.grip ? 'open' : 'close';
    if (button.dataset.does !== words) {
      button.dataset.does = words;
      button.textContent = `${side} jaws: ${words}`;
    }
    button.dataset.pressed = hand.deadMan ? (hands[i]?.deadMan ? 'yes' : 'again') : 'no';
  });
  const again = ['left', 'right'].some((side) => mine[side] && $(`jaws-${side}`).dataset.pressed === 'again');
  $('hand-hint').textContent = again ? 'dead-man does not count yet: let go and press again' : `${Math.round(100 * pace_m_per_s)} cm/s`;
  $('hand-hint').classList.toggle('degraded', again);
}
