// The panel that loads another scene or changes parameters. The firmware lists what can be changed, and answers each
// request.
import { showPanel, toast } from './controls.js';
import { showPreview } from './scene_preview.js';

const $ = (id) => document.getElementById(id);
const STEPS = 200;
const rows = new Map(); // the panel's rows, by parameter key
const asked = new Set(); // keys whose change is not answered yet: what is offered may be the value before or after
let previews = new Map(); // of the offered scenes, by name
const changes = []; // of parameters, made in this page: {key, name, from, to, isTold: the
// firmware has offered `to`}; the last one can be undone

/** @param signal ends the listeners. */
export function setUpChange(link, signal) {
  $('parameters').replaceChildren(); // of a panel that has failed

  const toggle = (on) => { showPanel('change', on); };
  $('change-open').addEventListener('click', () => toggle($('change').hidden), { signal });
  $('change-close').addEventListener('click', () => toggle(false), { signal });
  const ask = async (what, words) => {
    const answer = await link.request(what);
    toast(`${words}: ${answer.accepted ? answer.text : `refused – ${answer.text}`}`, !answer.accepted);
    return answer.accepted;
  };
  $('scenes').addEventListener('change', () => showPreview(previews.get($('scenes').value)), { signal });
  $('load-scene').addEventListener('click', async () => {
    $('load-scene').disabled = true;
    const nodes = $('nodes').value.trim();
    const changes = ($('model').value && ` suture.model=${$('model').value}`) + (nodes && ` suture.nodes=${nodes}`);
    await ask({ command: 'load-scene', text: $('scenes').value + changes }, 'load scene');
    $('load-scene').disabled = false;
  }, { signal });
  $('undo').addEventListener('click', async () => {
    const last = changes.at(-1);
    $('undo').disabled = true;
    asked.add(last.key);
    if (await ask({ command: 'set', text: last.key, value: last.from }, `${last.name}, undone`)) changes.splice(changes.indexOf(last), 1);
    asked.delete(last.key);
    showUndo();
  }, { signal });
  setUpChange.ask = ask;
}

/** Shows which change would be undone. */
function showUndo() {
  const last = changes.at(-1);
  $('undo').disabled = !last;
  $('undo').textContent = last ? `Undo ${last.name}: ${last.to} → ${last.from}` : 'Undo';
}

/** Forgets changes that no longer hold: another scene was loaded, or another page or program set the parameter. */
function forgetOld(parameters) {
  const now = new Map(parameters.map(({ key, value }) => [key, value]));
  for (let i = changes.length - 1; i >= 0; --i) {
    const { key, to, from, isTold } = changes[i];
    if (asked.has(key)) continue;
    if (now.get(key) === to) { changes[i].isTold = true; now.set(key, from); } // before this change it had the value `from`
    else if (isTold || !now.has(key)) changes.splice(i, 1);
  }
  showUndo();
}

export function showOffer({ scenes, previews: told, parameters }) {
  const chosen = $('scenes').value;
  previews = new Map(scenes.map((name, i) => [name, told[i]]));
  $('scenes').replaceChildren(...scenes.map((name) => new Option(name, name)));
  if (scenes.includes(chosen)) $('scenes').value = chosen;
  showPreview(previews.get($('scenes').value));
  for (const [key, row] of rows) if (!parameters.some((p) => p.key === key)) { row.box.remove(); rows.delete(key); }
  forgetOld(parameters);
  for (const parameter of parameters) (rows.get(parameter.key) ?? makeRow(parameter.key)).show(parameter);
}

/** Makes a slider and a number field for one parameter. The slider is logarithmic, unless the range begins at 0. */
function makeRow(key) {
  const box = document.createElement('div'), name = document.createElement('label'), slider = document.createElement('input');
  const number = document.createElement('input'), unit = document.createElement('span');
  Object.assign(slider, { type: 'range', min: 0, max: STEPS, step: 1 });
  Object.assign(number, { type: 'text', inputMode: 'decimal', size: 9, id: `parameter-${key}` });
  name.htmlFor = number.id;
  slider.setAttribute('aria-label', key);
  box.className = 'row parameter';
  box.dataset.key = key;
  box.append(name, slider, number, unit);
  $('parameters').append(box);
  let is = null;
  const isLog = () => is.lowest > 0;
  const toSlider = (v) => STEPS * (isLog() ? Math.log(v / is.lowest) / Math.log(is.highest / is.lowest) : (v - is.lowest) / (is.highest - is.lowest));
  const fromSlider = (s) => Number((isLog() ? is.lowest * (is.highest / is.lowest) ** (s / STEPS) : is.lowest + (is.highest - is.lowest) * s / STEPS).toPrecision(3));
  const settle = () => { number.value = is.value; slider.value = toSlider(is.value); };
  const give = async (value) => {
    if (!Number.isFinite(value)) { toast(`${is.name}: found '${number.value}', allowed a number`, true); return settle(); }
    const from = is.value;
    asked.add(key);
    const isDone = await setUpChange.ask({ command: 'set', text: key, value }, is.name);
    asked.delete(key);
    if (!isDone) return settle();
    if (value !== from) changes.push({ key, name: is.name, from, to: value, isTold: is.value === value });
    showUndo();
  };
  slider.addEventListener('input', () => { number.value = fromSlider(Number(slider.value)); });
  slider.addEventListener('change', () => give(Math.min(is.highest, Math.max(is.lowest, fromSlider(Number(slider.value))))));
  number.addEventListener('change', () => give(number.value.trim() === '' ? NaN : Number(number.value)));
  const row = { box, show(parameter) {
    is = parameter;
    name.textContent = parameter.name;
    unit.textContent = parameter.unit;
    box.title = `${key}: ${parameter.lowest} .. ${parameter.highest} ${parameter.unit}`;
    settle();
  } };
  rows.set(key, row);
  return row;
}
