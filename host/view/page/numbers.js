// Numbers on the page have three digits. Copying gives the exact ones (copying.js), which are kept beside them.

/** @returns the number with three significant digits. */
export function three(value) {
  if (!Number.isFinite(value) || value === 0) return String(value);
  return Math.abs(value) >= 1000 ? value.toFixed(0) : value.toPrecision(3);
}

/** The exact number: the shortest decimals that read back as the same one; the same as in an exported file. */
export function exact(value) { return Object.is(value, -0) ? '-0' : String(value); }
