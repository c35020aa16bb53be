// State, fault and age of the data, large enough to be read from across the room.
import { C } from './frame.js';
import { exact, three } from './numbers.js';
import { conditionName, degradationName, explainFault, limitNames, stateName } from './names.js';

export const STALE_MS = 120; // outdated data is marked within 200 ms: a timer checks every 20 ms
const SLOW_MS = 250, LONGEST_LAG_MS = 1000;
const NOTES = {
  OFF: 'drives are off', CALIBRATE: 'looking at the encoders', IDLE: 'ready, no force', ENGAGE: 'armed: hold still, press the dead-man',
  FORCE: 'forces on', BRAKE: 'forces ramp to zero', FAULT: 'no force until reset',
};
const $ = (id) => document.getElementById(id);

export function showState(now) {
  const name = now?.state === undefined ? 'none' : stateName(now.state);
  const box = $('state');
  if (box.dataset.state !== name) {
    box.dataset.state = name;
    $('state-name').textContent = name === 'none' ? 'NO RIG' : name;
    $('state-note').textContent = NOTES[name] ?? 'waiting for the firmware';
  }
  const fault = now?.fault || 0;
  if ($('fault').dataset.number !== String(fault)) {
    $('fault').dataset.number = fault;
    $('fault').hidden = !fault;
    const [meaning, remedy] = explainFault(fault);
    $('fault-name').textContent = `Fault ${fault}: ${meaning}`;
    $('fault-remedy').textContent = remedy;
  }
}

/**
 * Decides whether the display is outdated, and why: the rig or the host is silent, or this computer is slow.
 * @param age_ms age of the newest ticks as measured by the host, -1: none yet. @param silent_ms since the host's last
 * frame.
 * @param lag_ms delay of this page's own timer; data older by no more than this may have waited in this page.
 * @returns {{text, isOld, isSlow}}
 */
export function judgeAge(age_ms, silent_ms, lag_ms, { isReplay, unreadable }) {
  const allowed_ms = STALE_MS + Math.min(lag_ms, LONGEST_LAG_MS), old = (text) => ({ text, isOld: text !== '', isSlow: false });
  if (silent_ms > allowed_ms) return old(`No word from the host for ${seconds(silent_ms)}: is ligature-host running?`);
  if (age_ms < 0 && unreadable) return old('Messages come that this host cannot read: firmware and host must be of the same version.');
  if (age_ms < 0) return old(isReplay ? '' : 'No ticks yet: is ligature-firmware running on this LCM network?');
  if (age_ms > allowed_ms) return old(`Old picture: no ticks for ${seconds(age_ms)}. The rig may be in any state.`);
  if (lag_ms <= SLOW_MS) return old('');
  return { text: `slow picture: this computer is up to ${seconds(Math.max(lag_ms, age_ms))} behind${isReplay ? '' : '; the rig is heard'}`, isOld: false, isSlow: true };
}

/** Shows the warnings. @returns whether the display is outdated. */
export function showAge(age_ms, silent_ms, lag_ms, rig) {
  const { text, isOld, isSlow } = judgeAge(age_ms, silent_ms, lag_ms, rig);
  $('stale').hidden = !isOld;
  $('stale').textContent = isOld ? text : '';
  $('slow').hidden = !isSlow;
  $('slow').textContent = isSlow ? text : '';
  document.body.classList.toggle('is-stale', isOld);
  return isOld;
}

function seconds(ms) { return ms < 10_000 ? `${(ms / 1000).toFixed(1)} s` : `${Math.round(ms / 1000)} s`; }

export function showStatus(status) {
  if (!status) return;
  const bad = (n) => (n > 0 ? `<b class="bad">${n}</b>` : '<b>0</b>');
  $('facts').innerHTML = `<span id="scene-file"></span> · ${status.realtime ? '<b>real-time</b>' : '<b class="bad">no real-time rights</b>'}`
    + ` · late ${bad(status.deadline_misses)} · lost ${bad(status.periods_lost)}${status.armed ? ' · <b>armed</b>' : ''}`;
  $('scene-file').textContent = `${status.scene_file.split('/').pop()}, firmware ${status.firmware_version}`;
}

/** Writes into the same text node, so that a selection in it stays. */
function write(element, text) {
  element.firstChild ?? element.append('');
  if (element.firstChild.data !== text) element.firstChild.data = text;
}

/**
 * Shows what each hand does, which limits act on it, and which accuracy the solver gave up. @param row newest tick's
 * trace row or null.
 */
export function showHands(now, row) {
  now?.hands?.forEach((hand, i) => {
    const force = Math.hypot(...hand.f_device), isClutched = row?.[i ? C.rightClutch : C.leftClutch];
    const side = i ? 'right' : 'left';
    document.querySelector(`[data-command="clutch ${side}"]`).hidden = !!isClutched;
    document.querySelector(`[data-command="unclutch ${side}"]`).hidden = !isClutched;
    const limits = limitNames(row?.[i ? C.rightLimits : C.leftLimits] ?? 0);
    const condition = conditionName(row?.[i ? C.rightPropagation : C.leftPropagation] ?? 0);
    const [number, words] = $(`hand-${side}`).children;
    number.dataset.exact = `${exact(force)} N`;
    write(number, `${force < 5e-4 ? '0' : three(force)} N`);
    write(words, ` · ${hand.node >= 0 ? `holds node ${hand.node}` : hand.grip ? 'closed' : 'open'}`
      + `${hand.deadMan ? ' · dead-man' : ''}${isClutched ? ' · clutch: tool parked' : ''}${hand.age > 1 ? ` · ${hand.age} ticks old` : ''}`
      + (limits.length ? ` · limited: ${limits.join(', ')}` : '') + (condition && ` · ${condition}`));
  });
  const given = degradationName(row?.[C.degradation] ?? 0);
  $('degraded').hidden = !given;
  $('degraded').textContent = given ? `solver: ${given}` : '';
}
