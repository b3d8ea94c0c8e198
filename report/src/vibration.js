// Vibration as it is measured on machines: levels, envelope spectra, orders; by the same formulas as `roulement.vibration` of Python.

import { h, section, select, choice, table } from './dom.js';
import { secondHalf, spectrum, transform } from './fft.js';
import { linesOf } from './lines.js';
import { SpectrumPlot, peakTable } from './spectrum_plot.js';
import { digits } from './units.js';

/** Band of the velocity [Hz] (ISO 20816), and what levels in dB are over [m/s2, m/s] (ISO 1683). */
const BAND = [10, 1000], REFERENCE = { acceleration: 1e-6, velocity: 1e-9 };
/** Parts of the range that bands of a kurtogram are (Antoni 2007); share of the power below which a band is none. */
const PARTS = [2, 3, 4, 6, 8, 12, 16, 24, 32, 48], FAINT = 1e-4;
/** Columns that this is about. */
const ACCELERATION = /\.acceleration\.[xyz]$/;

/** Figures of an acceleration [m/s2] at distances [s]; the velocity is its integral between the frequencies of the band. None of what is constant. */
export function levels(values, dt, band = BAND) {
  const rows = values.length;
  const mean = values.reduce((sum, v) => sum + v, 0) / rows;
  let square = 0, fourth = 0, peak = 0;
  for (const value of values) {
    const x = value - mean;
    square += x * x / rows; fourth += x ** 4 / rows; peak = Math.max(peak, Math.abs(x));
  }
  if (!(square > 0)) return null;
  // By Parseval, of those frequencies alone.
  let velocity = 0;
  for (let k = Math.max(1, Math.ceil(band[0] * rows * dt)); k <= band[1] * rows * dt && k < rows / 2; k++) {
    const [c, s] = [Math.cos((2 * Math.PI * k) / rows), Math.sin((2 * Math.PI * k) / rows)];
    let re = 0, im = 0, x = 1, y = 0;
    for (const value of values) {
      re += (value - mean) * x; im += (value - mean) * y;
      [x, y] = [x * c - y * s, x * s + y * c];
    }
    velocity += 2 * (re * re + im * im) / (rows * (2 * Math.PI * k) / (rows * dt)) ** 2;
  }
  const rms = Math.sqrt(square);
  return { rms, peak, crest: peak / rms, kurtosis: fourth / square ** 2, velocity: Math.sqrt(velocity) };
}

/** Transform of a history without its mean. */
function transformed(values) {
  const n = 1 << Math.ceil(Math.log2(values.length));
  const mean = values.reduce((sum, v) => sum + v, 0) / values.length;
  const re = new Float64Array(n), im = new Float64Array(n);
  for (let i = 0; i < values.length; i++) re[i] = values[i] - mean;
  transform(re, im);
  return { re, im, n, rows: values.length };
}

/** Square of the envelope of what is between two frequencies [Hz]: of the analytic signal. */
function envelope({ re, im, n, rows }, dt, band) {
  const x = new Float64Array(n), y = new Float64Array(n);
  for (let k = 0; k < n / 2; k++) {
    const frequency = k / (n * dt);
    // The inverse is the transform of the conjugate.
    if (frequency >= band[0] && frequency < band[1]) { x[k] = (2 * re[k]) / n; y[k] = (-2 * im[k]) / n; }
  }
  transform(x, y);
  return Float64Array.from({ length: rows }, (_, i) => x[i] * x[i] + y[i] * y[i]);
}

/** Band [Hz] with the largest kurtosis of the envelope; null where nothing is heard. */
function loudestBand(of, dt) {
  const mean = values => values.reduce((sum, v) => sum + v, 0) / values.length;
  let power = 0;
  for (let k = 0; k < of.n / 2; k++) power += 2 * (of.re[k] ** 2 + of.im[k] ** 2) / of.n / of.rows;
  let best = -Infinity, found = null;
  for (const parts of PARTS) {
    for (let part = 0; part < parts; part++) {
      const band = [part, part + 1].map(edge => edge / (2 * dt * parts));
      if ((band[1] - band[0]) * of.rows * dt < 16) continue;
      const square = envelope(of, dt, band);
      const first = mean(square);
      if (first < FAINT * power) continue;
      const kurtosis = mean(square.map(v => v * v)) / first ** 2 - 2;
      if (kurtosis > best) [best, found] = [kurtosis, band];
    }
  }
  return found;
}

/** A history at even angles of a shaft that turns at speeds [rad/s], as many a turn as there are in the fastest one; null where it does not turn on. */
function atEvenAngles(values, dt, speeds) {
  const turns = new Float64Array(values.length);
  for (let i = 1; i < turns.length; i++) turns[i] = turns[i - 1] + (dt * Math.abs(speeds[i] + speeds[i - 1])) / (4 * Math.PI);
  const largest = turns.reduce((most, turn, i) => (i ? Math.max(most, turn - turns[i - 1]) : 0), 0);
  const perTurn = Math.floor(1 / largest);
  const count = Math.floor(turns[turns.length - 1] * perTurn);
  if (!(perTurn >= 4) || count < 64 || speeds.some(speed => speed * speeds[0] <= 0)) return null;
  let at = 0;
  const even = Float64Array.from({ length: count }, (_, i) => {
    const turn = i / perTurn;
    while (turns[at + 1] < turn) at++;
    return values[at] + ((values[at + 1] - values[at]) * (turn - turns[at])) / (turns[at + 1] - turns[at]);
  });
  return { values: even, perTurn };
}

/** Speeds of the shaft that orders are of. */
function speedsOf(run) {
  const name = run.shaft ? `${run.shaft.shafts[0].name}.speed` : ['inner', 'outer'].map(race => `${race}.speed`).find(race => !run.isNothing(race));
  return name && run.get(name);
}

export function vibration(run) {
  const names = [...run.series.values()].filter(s => ACCELERATION.test(s.name) && !s.constant && s.t.length >= 128 && !s.name.startsWith('cage.') && !run.isNothing(s.name)).map(s => s.name);
  if (!names.length) return null;
  const lines = linesOf(run);
  const figures = names.map(name => {
    const { values, dt } = secondHalf(run.get(name), run);
    return { name, dt, rows: values.length, ...levels(values, dt) };
  });
  const louder = figures.reduce((one, other) => (other.rms > one.rms ? other : one));
  const { dt, rows } = louder;
  const decibel = (value, of) => digits(20 * Math.log10(value / REFERENCE[of]), 4);
  const all = table(['place', 'rms mm/s\u00b2', 'dB', 'peak mm/s\u00b2', 'crest', 'kurtosis', 'velocity rms mm/s', 'dB'], figures.map(({ name, rms, peak, crest, kurtosis, velocity }) => [
    name.replace('.acceleration', ''), digits(rms * 1e3, 4), decibel(rms, 'acceleration'), digits(peak * 1e3, 4), digits(crest, 3), digits(kurtosis, 3), digits(velocity * 1e3, 4), decibel(velocity, 'velocity'),
  ]), { numbers: [1, 2, 3, 4, 5, 6, 7], caption: `Acceleration over ${digits(rows * dt * 1e3, 4)} ms, in dB over 1 \u00b5m/s\u00b2; velocity from ${digits(Math.max(BAND[0], 1 / (rows * dt)), 3)} Hz to 1 kHz, in dB over 1 nm/s` });
  const state = { name: louder.name, what: 'envelope', band: 'found', group: 0 };
  const [note, peaks] = [h('p', { class: 'note' }), h('div')];
  const order = frequency => (lines.shaft > 0 ? digits(frequency / lines.shaft, 4) : '\u2013');
  const speeds = speedsOf(run);
  const plot = new SpectrumPlot('Spectrum of vibration', () => {
    const { from, values, dt } = secondHalf(run.get(state.name), run);
    const group = lines.groups[state.group]?.lines ?? [];
    const even = state.what === 'orders' && speeds ? atEvenAngles(values, dt, speeds.v.slice(from, from + values.length)) : null;
    if (state.what === 'orders' && even) {
      const { amplitudes, n } = spectrum(even.values);
      // Per turn in place of per second.
      const spacing = even.perTurn / n, resolution = (2 * even.perTurn) / even.values.length;
      const [hz, wide] = [spacing, resolution].map(of => of * lines.shaft);
      note.textContent = `At even angles of the shaft, ${even.perTurn} a turn over ${digits(even.values.length / even.perTurn, 4)} turns: speeds that change do not smear its orders; resolution ${digits(resolution, 3)} orders.`;
      peaks.replaceChildren(...peakTable(amplitudes, hz, wide, lines, amplitude => `${digits(amplitude * 1e3, 4)} mm/s\u00b2`, order));
      return { x: Float64Array.from(amplitudes, (_, k) => k * spacing), y: amplitudes.map(a => a * 1e3), xLabel: 'order of the shaft', xShort: 'order', yLabel: `${state.name} [mm/s\u00b2]`, logarithmic: true, lines: group, per: lines.shaft };
    }
    const of = transformed(values);
    const band = state.band === 'found' ? loudestBand(of, dt) : state.band.split('-').map(Number);
    const square = envelope(of, dt, band ?? [0, 0.5 / dt]);
    const { amplitudes, n } = spectrum(square);
    const [spacing, resolution] = [1 / (n * dt), 2 / (square.length * dt)];
    // Up to where blows of bearings and their multiples are.
    const most = Math.min(0.5 / dt, Math.max(20 * resolution, ...group.map(line => 6 * line.frequency)));
    const kept = amplitudes.slice(0, Math.ceil(most / spacing) + 1);
    note.textContent = `Square of the envelope of ${band ? band.map(edge => digits(edge * 1e-3, 4)).join(' to ') : 'all up to ' + digits(0.5e-3 / dt, 4)} kHz${state.band === 'found' ? ', the band in which blows stand out most (kurtogram)' : ''}; resolution ${digits(resolution, 3)} Hz.${state.what === 'orders' ? ' The shaft does not turn on far enough for orders.' : ''}`;
    peaks.replaceChildren(...peakTable(kept, spacing, resolution, lines, amplitude => `${digits(amplitude * 1e6, 4)} (mm/s\u00b2)\u00b2`, order));
    return { x: Float64Array.from(kept, (_, k) => (k * spacing) / 1e3), y: kept.map(a => a * 1e6), xLabel: 'frequency of the envelope [kHz]', xShort: 'kHz', yLabel: `${state.name}\u00b2 [(mm/s\u00b2)\u00b2]`, logarithmic: false, lines: group, per: 1e3 };
  });
  const draw = () => plot.draw();
  const halves = [...Array(4).keys()].map(k => [0.5 ** (k + 1), 0.5 ** k].map(part => (0.5 / dt) * part));
  const bands = [['found', 'found: kurtogram'], ...halves.map(([low, high]) => [`${low}-${high}`, `${digits(low * 1e-3, 3)} to ${digits(high * 1e-3, 3)} kHz`])];
  return section('vibration', 'Vibration', all, h('div', { class: 'row' },
    select('Place', names.map(name => [name, name]), state.name, name => { state.name = name; draw(); }),
    choice('Spectrum', [['envelope', 'envelope'], ['orders', 'orders']], state.what, what => { state.what = what; draw(); }),
    select('Band', bands, state.band, band => { state.band = band; draw(); }),
    lines.groups.length > 1 ? select('Lines', lines.groups.map(({ name }, i) => [i, name]), state.group, group => { state.group = Number(group); draw(); }) : null), plot.body, note, peaks);
}
