// Formats times of ticks; exact to the tick even after a year.

/** @returns text such as "t 12.345 s". */
export function describeTime(tick, period_s) { return `t ${(tick * period_s).toFixed(3)} s`; }

const LETTER_PX = 6.5;

/**
 * Labels of a time axis: enough decimals to distinguish the marks, and the unit on the last one. @param marks_s
 * ascending. @param roomAfter pixels from a mark to the right end; a label that would be cut off there is left out (null).
 */
export function axisLabels(marks_s, roomAfter = () => Infinity) {
  const step = marks_s.length > 1 ? marks_s[1] - marks_s[0] : 1, decimals = Math.min(6, Math.max(0, Math.ceil(-Math.log10(step) - 1e-6)));
  const labels = marks_s.map((t) => t.toFixed(decimals)), fits = (i) => roomAfter(marks_s[i]) >= (LETTER_PX * (labels[i].length + 2)) / 2;
  let last = labels.length - 1;
  while (last > 0 && !fits(last)) labels[last--] = null;
  if (last >= 0) labels[last] += ' s';
  return labels;
}

/** Smallest width of a label in pixels, so that long numbers do not overlap. */
export function labelRoom(end_s, step_s) { return 22 + LETTER_PX * (Math.abs(end_s).toFixed(0).length + (step_s < 1 ? 2 : 0)); }
