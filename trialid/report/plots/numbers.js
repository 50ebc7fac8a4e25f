/* What came packed in the page, as numbers, and what is reckoned from it. */

/* base64 of little-endian float32 to numbers; a gap, NaN, becomes the null that uPlot leaves open */
export function numbers(text) {
  const packed = atob(text);
  const bytes = new Uint8Array(packed.length);
  for (let k = 0; k < packed.length; k++) bytes[k] = packed.charCodeAt(k);
  const floats = new Float32Array(bytes.buffer);
  const values = new Array(floats.length);
  for (let k = 0; k < floats.length; k++) values[k] = Number.isNaN(floats[k]) ? null : floats[k];
  return values;
}

/* The samples' times in seconds; an even clock comes as its start and its period. */
export function clock(t) {
  if (t.each !== undefined) return numbers(t.each);
  return Array.from({ length: t.samples }, (_, k) => t.start + k * t.period);
}

export function difference(measured, predicted) {
  return measured.map((y, k) => (y === null || predicted[k] === null ? null : y - predicted[k]));
}

/* Runs of samples that were not measured, as [from, to] in seconds. */
export function gaps(t, values) {
  const found = [];
  for (let k = 0; k < t.length; k++) {
    if (values[k] !== null) continue;
    const from = k;
    while (k + 1 < t.length && values[k + 1] === null) k++;
    found.push([t[Math.max(from - 1, 0)], t[Math.min(k + 1, t.length - 1)]]);
  }
  return found;
}

/* About three digits, as the legend writes them. */
export function rounded(value) {
  if (value === null || value === undefined) return "\u2013";
  const places = Math.min(Math.max(2 - Math.floor(Math.log10(Math.abs(value) || 1)), 1), 5);
  return value.toFixed(places).replace("-", "\u2212");
}
