// Amplitude spectrum of equidistant values: Hann window, radix 2.

/** Values of a series in the second half of a run, and their distance [s]. A last row out of step is left out. */
export function secondHalf({ t, v }, run) {
  const from = t.findIndex(time => time >= run.begin + 0.5 * (run.end - run.begin));
  return { from, values: v.slice(from, v.length - 1), dt: (t[t.length - 2] - t[from]) / (t.length - 2 - from) };
}

/** Amplitudes at k / (n dt) of a history; the mean is taken away first. Zeros behind it make peaks smooth: n is at least twice its rows. */
export function spectrum(values) {
  const rows = values.length;
  const n = 2 << Math.ceil(Math.log2(rows));
  let mean = 0;
  for (let i = 0; i < rows; i++) mean += values[i] / rows;
  const re = new Float64Array(n), im = new Float64Array(n);
  for (let i = 0; i < rows; i++) re[i] = (values[i] - mean) * (1 - Math.cos((2 * Math.PI * i) / rows));
  transform(re, im);
  // A sine of amplitude 1 has 1 in the middle of its peak.
  const amplitudes = new Float64Array(n / 2);
  for (let k = 0; k < n / 2; k++) amplitudes[k] = (2 / rows) * Math.hypot(re[k], im[k]);
  amplitudes[0] = 0;
  return { amplitudes, n };
}

/** Fourier transform in its place, of a power of two of values. */
export function transform(re, im) {
  const n = re.length;
  for (let i = 1, j = 0; i < n; i++) {
    let bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) { [re[i], re[j]] = [re[j], re[i]]; [im[i], im[j]] = [im[j], im[i]]; }
  }
  for (let size = 2; size <= n; size *= 2) {
    const half = size / 2, step = (-2 * Math.PI) / size;
    for (let k = 0; k < half; k++) {
      const c = Math.cos(step * k), d = Math.sin(step * k);
      for (let i = k; i < n; i += size) {
        const j = i + half;
        const x = re[j] * c - im[j] * d, y = re[j] * d + im[j] * c;
        re[j] = re[i] - x; im[j] = im[i] - y;
        re[i] += x; im[i] += y;
      }
    }
  }
}
