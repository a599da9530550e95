// Numbers and words as they are shown.

export const isNumber = (value) => typeof value === 'number' && Number.isFinite(value);

export function fixed(value, digits) {
  return isNumber(value) ? value.toFixed(digits) : '–';
}

export function ageText(seconds) {
  if (!isNumber(seconds)) return '–';
  if (seconds < 10) return seconds.toFixed(1);
  if (seconds < 600) return seconds.toFixed(0);
  if (seconds < 7200) return `${Math.floor(seconds / 60)} min`;
  return `${Math.floor(seconds / 3600)} h`;
}

export function ageWithUnit(seconds) {
  const text = ageText(seconds);
  return isNumber(seconds) && seconds < 600 ? `${text} s` : text;
}

export function clockTime(ageS) {
  return new Date(Date.now() - ageS * 1000).toLocaleTimeString([], {hour12: false});
}

// Each state has a sign and a word beside its colour.
export const STATES = {
  up: {sign: '●', word: 'UP'},
  stale: {sign: '◐', word: 'STALE'},
  lost: {sign: '✕', word: 'LOST'},
  waiting: {sign: '○', word: 'WAITING'},
};

export const STAGES = {
  found: '◇', validating: '◈', validated: '◆', tracked: '◉', rejected: '✕', unknown: '?',
};
