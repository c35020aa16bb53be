// The list of recordings in the folder: live in the dialog for recording, in a replay as the choice of the one to play.

const $ = (id) => document.getElementById(id);

/** "12.3 MB". */
export function sizeOf(bytes) { return bytes >= 1e6 ? `${(bytes / 1e6).toPrecision(3)} MB` : `${Math.ceil(bytes / 1e3)} kB`; }

function when(modified_s) { return new Date(1000 * modified_s).toLocaleString(); }

async function ask(link) {
  const answer = await link.request({ record: 'list' });
  return answer.accepted ? { folder: answer.text, files: answer.files ?? [] } : { folder: '', files: [] };
}

/** Fills the list in the dialog. Each line says how to replay the recording. */
export async function listRecordings(link) {
  const { folder, files } = await ask(link);
  $('recordings').replaceChildren(...files.map(({ name, bytes, modified_s }) => {
    const line = document.createElement('li'), title = document.createElement('b');
    title.textContent = name;
    line.append(title, ` ${sizeOf(bytes)}, ${when(modified_s)}`);
    line.title = `ligature-host replay ${folder}/${name}`;
    return line;
  }));
  $('recordings-note').textContent = files.length ? `in ${folder}; replay with: ligature-host replay FILE` : `no recordings in ${folder || 'the folder'} yet`;
}

/** Fills the choice in the replay bar. @param playing name of the recording that is shown. */
export async function offerRecordings(link, playing) {
  const { files } = await ask(link);
  $('open').replaceChildren(...files.map(({ name }) => new Option(name, name)));
  for (const [i, { bytes, modified_s }] of files.entries()) $('open').options[i].title = `${sizeOf(bytes)}, ${when(modified_s)}`;
  $('open').hidden = files.length < 2;
  $('open').value = playing;
}
