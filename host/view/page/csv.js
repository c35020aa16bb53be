// The ticks of the traces as a CSV file: the exact values, in columns with the names of `ligature-host export`.
import { COLUMNS } from './frame.js';
import { exact } from './numbers.js';

const ALONE = { wakeup_ns: 'wakeup_latency_ns', maxStretch: 'max_stretch', minGap_m: 'min_gap_m', threadDone_ns: 'thread_done_ns', timeLost: 'time_lost' };
const OF_HAND = { X: 'device_f_x_N', Y: 'device_f_y_N', Z: 'device_f_z_N', '': 'device_f_N', World: 'world_f_N', Node: 'node', Port_J: 'port_energy_J',
  Dissipated_J: 'dissipated_J', BusLoad: 'bus_load', Heat: 'heat', Limits: 'limits', Clutch: 'clutch', Propagation: 'propagation' };

/** Name of a column of the page (frame.js) in the exported files. */
export function exportedName(column) {
  const [, hand, what] = column.match(/^(left|right)(.*)$/) ?? [];
  return hand && OF_HAND[what] ? `${hand}_${OF_HAND[what]}` : ALONE[column] ?? column;
}

/** @returns {{text, count}}: the ticks [from, to) that the store still has, one line each. */
export function ticksAsCsv(store, from, to) {
  const lines = [COLUMNS.map(exportedName).join()], end = store.rowFrom(to);
  for (let i = store.rowFrom(from); i < end; ++i) lines.push(Array.from(store.row(i), exact).join());
  return { text: `${lines.join('\n')}\n`, count: lines.length - 1 };
}
