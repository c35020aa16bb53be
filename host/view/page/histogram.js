// Histogram of the control loop's wake-up latency, with logarithmic heights, so that a single late tick among a million
// is visible.
import { C } from './frame.js';
import { three } from './numbers.js';

const BOUNDS_us = [2, 5, 10, 20, 50, 100, 200, 500, 1000];

export class Histogram {
  /**
   * @param redraw callback that requests a redraw, because resizing clears the canvas. @param signal aborted when the
   * histogram is no longer wanted.
   */
  constructor(host, redraw, signal) {
    this.box = Object.assign(document.createElement('div'), { className: 'plot histogram' });
    this.box.innerHTML = '<h2>wake-up latency <em>µs, log count</em></h2>';
    this.canvas = document.createElement('canvas');
    this.box.append(this.canvas);
    host.append(this.box);
    const resizes = new ResizeObserver(redraw);
    resizes.observe(this.box);
    signal.addEventListener('abort', () => { resizes.disconnect(); this.box.remove(); });
  }

  draw(store, from, period_s) {
    fitTo(this.canvas, this.box);
    drawHistogram(this.canvas, store, from, period_s);
  }
}

/** Sets the canvas to as many pixels as are displayed, so that nothing is stretched. */
function fitTo(canvas, box) {
  const width = Math.round(box.clientWidth * devicePixelRatio), height = Math.round(box.clientHeight * devicePixelRatio);
  if (canvas.width === width && canvas.height === height) return;
  canvas.width = width;
  canvas.height = height;
  canvas.style.cssText = `display:block;width:${box.clientWidth}px;height:${box.clientHeight}px`;
}

function drawHistogram(canvas, store, from, period_s) {
  const ctx = canvas.getContext('2d'), ratio = devicePixelRatio;
  const { counts, max } = store.histogram(C.wakeup_ns, BOUNDS_us.map((us) => us * 1000), from);
  const width = canvas.width / ratio, height = canvas.height / ratio, left = 50, bottom = 17, top = 36;
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  const most = Math.max(10, ...counts), cell = (width - left - 8) / counts.length, tall = height - bottom - top;
  ctx.font = '11px sans-serif';
  ctx.textAlign = 'center';
  const widest = ctx.measureText(`<${BOUNDS_us.at(-1)}`).width;
  counts.forEach((count, i) => {
    const x = left + i * cell, h = count ? Math.max(3, (tall * Math.log10(1 + count)) / Math.log10(1 + most)) : 0;
    const isLate = i > 0 && BOUNDS_us[i - 1] * 1e-6 >= period_s;
    ctx.fillStyle = isLate ? '#ff5c47' : '#7b8da6';
    ctx.fillRect(x + 2, height - bottom - h, cell - 4, h);
    ctx.fillStyle = '#9aa6b6';
    const label = i < BOUNDS_us.length ? `<${BOUNDS_us[i]}` : `≥${BOUNDS_us.at(-1)}`, isRoom = cell > 1.05 * widest || (counts.length - 1 - i) % 2 === 0;
    if (isRoom) ctx.fillText(label, x + cell / 2, height - 4);
    if (count) {
      ctx.fillStyle = '#e8ecf2';
      ctx.fillText(count >= 10000 ? `${(count / 1000).toFixed(0)}k` : count, x + cell / 2, height - bottom - h - 3);
    }
  });
  ctx.textAlign = 'right';
  ctx.fillStyle = '#e8ecf2';
  ctx.fillText(`max ${three(max / 1000)} µs`, width - 10, 14);
}
