// Formats times of ticks; exact to the tick even after a year.

/** @returns text such as "t 12.345 s". */
export function describeTime(tick, period_s) { return `t ${(tick * period_s).toFixed(3)} s`; }

/**
 * Labels of a time axis: enough decimals to distinguish the marks, and the unit on the last one. @param marks_s
 * ascending.
 */
export function axisLabels(marks_s) {
  const step = marks_s.length > 1 ? marks_s[1] - marks_s[0] : 1, decimals = Math.min(6, Math.max(0, Math.ceil(-Math.log10(step) - 1e-6)));
  return marks_s.map((t, i) => `${t.toFixed(decimals)}${i === marks_s.length - 1 ? ' s' : ''}`);
}

/** Smallest width of a label in pixels, so that long numbers do not overlap. */
export function labelRoom(end_s, step_s) { return 22 + 6.5 * (Math.abs(end_s).toFixed(0).length + (step_s < 1 ? 2 : 0)); }
