// State, fault and staleness: what must be seen from across the room.
import { C } from './frame.js';
import { degradationName, explainFault, limitNames, stateName } from './names.js';

export const STALE_MS = 120; // shown within 200: a timer looks every 20
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

/** @param age_ms of the newest ticks as the host knows it, -1 none yet; @param silent_ms since the host's last frame.
 *  @returns whether the picture is old. */
export function showAge(age_ms, silent_ms, { isReplay, unreadable }) {
  let text = '';
  if (silent_ms > STALE_MS) text = `No word from the host for ${seconds(silent_ms)}: is ligature-host running?`;
  else if (age_ms < 0 && unreadable) text = 'Messages come that this host cannot read: firmware and host must be of the same version.';
  else if (age_ms < 0) text = isReplay ? '' : 'No ticks yet: is ligature-firmware running on this LCM network?';
  else if (age_ms > STALE_MS) text = `Old picture: no ticks for ${seconds(age_ms)}. The rig may be in any state.`;
  $('stale').hidden = !text;
  $('stale').textContent = text;
  document.body.classList.toggle('is-stale', text !== '');
  return text !== '';
}

function seconds(ms) { return ms < 10_000 ? `${(ms / 1000).toFixed(1)} s` : `${Math.round(ms / 1000)} s`; }

export function showStatus(status) {
  if (!status) return;
  const bad = (n) => (n > 0 ? `<b class="bad">${n}</b>` : '<b>0</b>');
  $('facts').innerHTML = `<span id="scene-file"></span> · ${status.realtime ? '<b>real-time</b>' : '<b class="bad">no real-time rights</b>'}`
    + ` · late ${bad(status.deadline_misses)} · lost ${bad(status.periods_lost)}${status.armed ? ' · <b>armed</b>' : ''}`;
  $('scene-file').textContent = `${status.scene_file.split('/').pop()}, firmware ${status.firmware_version}`;
}

/** What each hand does and what holds it back, and what the solver gave up. @param row newest tick's trace row or null. */
export function showHands(now, row) {
  now?.hands?.forEach((hand, i) => {
    const force = Math.hypot(...hand.f_device), isClutched = row?.[i ? C.rightClutch : C.leftClutch];
    const side = i ? 'right' : 'left';
    document.querySelector(`[data-command="clutch ${side}"]`).hidden = !!isClutched;
    document.querySelector(`[data-command="unclutch ${side}"]`).hidden = !isClutched;
    const limits = limitNames(row?.[i ? C.rightLimits : C.leftLimits] ?? 0);
    $(i ? 'hand-right' : 'hand-left').textContent = `${force.toFixed(2)} N · ${hand.node >= 0 ? `holds node ${hand.node}` : hand.grip ? 'closed' : 'open'}`
      + `${hand.deadMan ? ' · dead-man' : ''}${isClutched ? ' · clutch: tool parked' : ''}${hand.age > 1 ? ` · ${hand.age} ticks old` : ''}`
      + (limits.length ? ` · limited: ${limits.join(', ')}` : '');
  });
  const given = degradationName(row?.[C.degradation] ?? 0);
  $('degraded').hidden = !given;
  $('degraded').textContent = given ? `solver: ${given}` : '';
}

/** Facts of the scene's text that the picture needs; a TOML reader is not: keys are one to a line in our files. */
export function sceneFacts(status) {
  const toml = status.scene_toml ?? '', number = (key) => { const m = toml.match(new RegExp(`^\\s*${key}\\s*=\\s*([-+0-9.eE_]+)`, 'm')); return m ? Number(m[1]) : null; };
  const fixed = [...toml.matchAll(/\{\s*node\s*=\s*-?\d+\s*,\s*position_m\s*=\s*\[([^\]]+)\]/g)].map((m) => m[1].split(',').map(Number));
  return { deskHeight_m: number('desk_height_m'), restLength_m: number('length_m') ?? 0, fixed: fixed.filter((p) => p.length === 3 && p.every(Number.isFinite)), maxForce_N: status.max_force_N || 3.3 };
}
