// Names of numeric codes. The host sends them once at the start (host/names.hpp), so that there is only one list.
export const names = { states: [], limits: [], degradations: [], conditions: [], faults: [] };

export function setNames(given) { Object.assign(names, given); }

export function stateName(number) { return names.states[number] ?? '?'; }

/** Names of the set bits. */
export function limitNames(bits) { return names.limits.filter(([bit]) => bits & bit).map(([, word]) => word); }

export function degradationName(code) { return names.degradations.find(([number]) => number === code)?.[1] ?? ''; }

/** The paper's condition (section IV) for the force on a hand; empty when none acts. */
export function conditionName(code) { return names.conditions.find(([number]) => number === code)?.[1] ?? ''; }

/** @returns [meaning, remedy]. */
export function explainFault(number) {
  const found = names.faults.find(([is]) => is === number);
  return found ? found.slice(1) : ['Unknown fault', 'Look the number up in docs/architecture.md; reset when its cause is gone.'];
}
