// Fault numbers are part of the firmware's interface (docs/architecture.md): what each means and what helps.
export const FAULTS = {
  10: ['A hand\'s bus is gone', 'Check the cable or the simulated hand, then reset the fault.'],
  11: ['Joint messages too old', 'A drive stopped sending, or the machine was too slow. Check load and bus, then reset.'],
  12: ['A drive reports a fault', 'Read the drive\'s own error code, clear its cause, then reset.'],
  20: ['A force or position is not a number', 'Reset the thread, then the fault. If it returns, soften the scene.'],
  21: ['The hand moved too fast', 'Hold the stylus still, then reset the fault.'],
  30: ['The control loop lost periods', 'Too much load on the machine: run ligature-firmware doctor, then reset.'],
  40: ['The thread simulation diverged', 'Reset the thread, then the fault. If it returns, soften the scene.'],
};

export function explainFault(number) {
  return FAULTS[number] ?? ['Unknown fault', 'Look the number up in docs/architecture.md; reset when its cause is gone.'];
}
