// Data of the traces for the whole of a recording, from its overview (topic 'marks'): the largest force of each hand in
// each of its parts. The other traces have no overview.

export const BESIDE = 14; // index of the other recording's first column in the data

/**
 * @param now_s time of the displayed tick, at position_s of the recording.
 * @returns {{data, from_s, end_s}} or null while the overview is not complete.
 */
export function wholeRun(marks, replay, now_s) {
  const parts = marks?.left_N?.length ?? 0;
  if (!parts || !replay || replay.survey < 1) return null;
  const from_s = now_s - replay.position_s, none = new Array(parts).fill(null), zero = new Array(parts).fill(0);
  const data = Array.from({ length: BESIDE + 3 }, () => none);
  data[0] = Array.from({ length: parts }, (_, i) => from_s + ((i + 0.5) / parts) * replay.duration_s);
  [data[1], data[5]] = [marks.left_N, marks.right_N];
  for (const flags of [11, 12, 13]) data[flags] = zero;
  return { data, from_s, end_s: from_s + replay.duration_s };
}
