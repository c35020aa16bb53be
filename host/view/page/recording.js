// The record button, and the dialog for the recording's name and notes.
import { toast } from './controls.js';
import { listRecordings } from './recordings_list.js';

const $ = (id) => document.getElementById(id);

/** Sets up the button, which starts a recording with name and notes, and ends it. @param signal ends the listeners. */
export function setUpRecording(link, signal) {
  const say = (answer, what) => toast(`${what}: ${answer.accepted ? answer.text : `refused – ${answer.text}`}`, !answer.accepted);
  $('record').addEventListener('click', async () => {
    if ($('record').dataset.on === 'true') return say(await link.request({ record: 'stop' }), 'recorded');
    $('record-name').value = new Date().toISOString().slice(0, 19).replace(/[:T]/g, '-');
    $('record-notes').value = '';
    $('record-dialog').show(); // not modal: STOP stays usable
    $('record-name').focus();
    listRecordings(link);
  }, { signal });
  $('record-dialog').addEventListener('close', async () => {
    if ($('record-dialog').returnValue !== 'start') return;
    say(await link.request({ record: 'start', name: $('record-name').value, notes: $('record-notes').value }), 'recording');
  }, { signal });
}

export function showRecording({ on, file, why }) {
  $('record').dataset.on = on;
  $('record').textContent = on ? `■ ${file}` : '● Record';
  if (why) toast(`recording of ${file} ended: ${why}`, true);
}
