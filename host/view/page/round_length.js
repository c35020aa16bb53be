// Lengths for scale bars.

/** The longest round length (1, 2 or 5 times a power of ten) that is at most `most_m`. @returns {{length_m, text}}. */
export function roundLength(most_m) {
  const ten = 10 ** Math.floor(Math.log10(most_m)), length_m = [5, 2, 1].map((k) => k * ten).find((l) => l <= most_m * (1 + 1e-9)) ?? ten;
  const [unit, factor] = length_m >= 1 ? ['m', 1] : length_m >= 1e-3 ? ['mm', 1e3] : ['µm', 1e6];
  return { length_m, text: `${+(length_m * factor).toPrecision(3)} ${unit}` };
}
