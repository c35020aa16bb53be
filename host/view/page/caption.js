// What a saved picture says besides the thread: the knot, the scale, the colours' meaning, scene and time.
import { roundLength } from './round_length.js';

/** @param metresPerPixel of the canvas. */
export function drawCaption(c, { name, note, legend, metresPerPixel, when }) {
  const { width, height } = c.canvas, size = Math.max(12, Math.round(height / 45)), line = Math.round(1.35 * size);
  c.textBaseline = 'alphabetic';
  c.fillStyle = c.strokeStyle = '#e8ecf2';
  c.textAlign = 'left';
  c.font = `bold ${1.6 * size}px sans-serif`;
  c.fillText(name, size, 2 * size);
  c.font = `${size}px sans-serif`;
  c.fillText(note, size, 2 * size + line);
  c.fillText(when, size, height - size);
  c.textAlign = 'right';
  legend.split('\n').filter(Boolean).forEach((text, i) => c.fillText(text, width - size, 2 * size + i * line));
  if (!(metresPerPixel > 0)) return;
  const { length_m, text } = roundLength(0.15 * width * metresPerPixel), long = length_m / metresPerPixel;
  c.lineWidth = Math.max(1.5, size / 8);
  c.beginPath();
  c.moveTo(width - size - long, height - 1.6 * size); c.lineTo(width - size - long, height - size); c.lineTo(width - size, height - size); c.lineTo(width - size, height - 1.6 * size);
  c.stroke();
  c.fillText(text, width - size, height - 2 * size);
}
