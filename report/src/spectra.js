// Spectra of the second half of the run, with the frequencies of bearings and meshes, the orders of the shaft, and the largest peaks by name.

import uPlot from 'uplot';
import { h, section, select, choice, table } from './dom.js';
import { css, colour, onTheme } from './theme.js';
import { spectrum } from './fft.js';
import { DRAWN, linesOf, nameOf } from './lines.js';
import { digits, shown } from './units.js';

/** Amplitude in the unit of the plot that is rounding of zeros: no axis can be written for less. */
const NOTHING = 1e-11;
/** Peaks that are named, and share of the largest below which none is. */
const PEAKS = 8, SHARE = 0.02;

export function spectra(run) {
  const candidates = [...run.series.values()].filter(s => !s.constant && s.t.length >= 64 && (run.shaft ? !run.shaft.shafts.some(({ name }) => s.name === `${name}.angle`) : /force|moment|position|torque|power|speed|load$|eccentricity|slip|angle/.test(s.name))).map(s => s.name)
    .filter(name => !run.isNothing(name)).sort((a, b) => a.startsWith('ball[') - b.startsWith('ball[') || a.localeCompare(b));
  if (!candidates.length) return null;
  const liveliest = [...(run.shaft?.meshes ?? []).map(name => `${name}.normal_force`), ...['y', 'z', 'x'].map(axis => (run.shaft ? `${run.shaft.bearings[0].shaft}.${run.shaft.bearings[0].name}.${axis}` : `${run.bearing.loaded}.force.${axis}`))].filter(name => candidates.includes(name));
  const state = { name: liveliest[0] ?? candidates[0], axis: 'Hz', scale: 'log', group: 0 };
  const lines = linesOf(run);
  const body = h('div', { class: 'plot-body', role: 'img', 'aria-label': 'Amplitude spectrum' });
  const [note, peaks, named] = [h('p', { class: 'note' }), h('div'), h('div')];
  const order = frequency => (lines.shaft > 0 ? digits(frequency / lines.shaft, 4) : '\u2013');
  const list = () => named.replaceChildren(table(['line', 'what', 'Hz', 'order'], (lines.groups[state.group]?.lines ?? []).map(line => [line.short, line.long, digits(line.frequency, 5), order(line.frequency)]), { numbers: [2, 3], caption: 'Lines in the plot' }));
  list();
  let plot = null;
  const draw = () => {
    plot?.destroy();
    const series = run.get(state.name);
    const from = series.t.findIndex(t => t >= run.begin + 0.5 * (run.end - run.begin));
    // A last row out of step is left out.
    const dt = (series.t[series.t.length - 2] - series.t[from]) / (series.t.length - 2 - from);
    const values = series.v.slice(from, series.v.length - 1);
    const { amplitudes, n } = spectrum(values);
    const spacing = 1 / (n * dt);
    const per = state.axis === 'order' && lines.shaft > 0 ? lines.shaft : 1e3;
    const [factor, unit] = shown(state.name, series.unit, Math.max(...amplitudes));
    const x = Float64Array.from(amplitudes, (_, k) => (k * spacing) / per);
    const y = Float64Array.from(amplitudes, a => a * factor);
    const top = Math.max(...y) || 1;
    const ink = { stroke: css('--ink-2'), grid: { stroke: css('--grid'), width: 1 }, ticks: { stroke: css('--grid') }, font: '12px system-ui' };
    plot = new uPlot({
      width: Math.max(body.clientWidth, 280), height: 340, legend: { show: true },
      cursor: { drag: { x: true, y: false } },
      scales: { x: { time: false }, y: state.scale === 'log' ? { distr: 3, range: (u, low, high) => [Math.max(low, high * 1e-5, NOTHING), Math.max(high * 1.6, 10 * NOTHING)] } : { range: (u, low, high) => [0, Math.max(high * 1.1, 10 * NOTHING)] } },
      axes: [{ ...ink, label: state.axis === 'order' ? 'order of the shaft' : 'frequency [kHz]' }, { ...ink, size: 78, label: `${state.name}${unit ? ` [${unit}]` : ''}`, values: (u, values) => values.map(v => (v === null ? '' : digits(v, 2))) }],
      series: [{ label: state.axis === 'order' ? 'order' : 'kHz', value: (u, v) => (v === null ? '' : digits(v, 5)) }, { label: state.name, stroke: () => colour(0), width: 1.4, value: (u, v) => (v === null ? '' : digits(v, 4)), points: { show: false } }],
      hooks: { draw: [u => mark(u, lines.groups[state.group]?.lines ?? [], per)] },
    }, [x, Float64Array.from(y, v => (state.scale === 'log' ? Math.max(v, top * 1e-9, NOTHING) : v))], body);
    const stride = series.t.length < (run.record.table_rows ?? 0);
    note.textContent = `Hann window over ${digits(values.length * dt * 1e3, 4)} ms, resolution ${digits(2 / (values.length * dt), 3)} Hz, up to ${digits(0.5e-3 / dt, 4)} kHz, half the frequency of the rows.${stride ? ' The page has every n-th row of the table: what is faster than that folds back.' : ' What is faster than that folds back.'}`;
    const [found, resolution] = [largest(amplitudes, spacing), 2 / (values.length * dt)];
    peaks.replaceChildren(...(found.length ? [table(['peak', 'Hz', 'order', 'amplitude'], found.map(({ frequency, amplitude }) => [nameOf(lines, frequency, spacing, resolution) ?? '\u2013', digits(frequency, 5), order(frequency), `${digits(amplitude * factor, 4)}${unit ? ` ${unit}` : ''}`]), { numbers: [1, 2, 3], caption: 'Largest peaks, and the line that each is on' })] : []));
  };
  onTheme(draw);
  let waiting = 0;
  addEventListener('resize', () => { clearTimeout(waiting); waiting = setTimeout(() => plot?.setSize({ width: Math.max(body.clientWidth, 280), height: 340 }), 120); });
  // Drawn once its place has a width.
  new IntersectionObserver((changes, observer) => { if (changes.some(change => change.isIntersecting)) { draw(); observer.disconnect(); } }, { rootMargin: '300px' }).observe(body);
  return section('spectra', 'Spectra', h('div', { class: 'row' },
    select('Quantity', candidates.map(name => [name, name]), state.name, name => { state.name = name; draw(); }),
    lines.shaft > 0 ? choice('Axis', [['Hz', 'frequency'], ['order', 'order']], state.axis, axis => { state.axis = axis; draw(); }) : null,
    lines.groups.length > 1 ? select('Lines', lines.groups.map(({ name }, i) => [i, name]), state.group, group => { state.group = Number(group); list(); draw(); }) : null,
    choice('Scale', [['log', 'logarithmic'], ['linear', 'linear']], state.scale, scale => { state.scale = scale; draw(); })), body, note, peaks, named);
}

/** Largest peaks between the lines of a spectrum: each with its place on the parabola through the logarithms of three. */
function largest(amplitudes, spacing) {
  const found = [];
  // What leaks from the mean stands at the first frequencies.
  for (let k = 2; k + 1 < amplitudes.length; k++) {
    const [before, at, after] = [amplitudes[k - 1], amplitudes[k], amplitudes[k + 1]];
    if (!(at > before && at >= after && at > NOTHING)) continue;
    const [a, b, c] = [before, at, after].map(v => Math.log(Math.max(v, at * 1e-6)));
    found.push({ frequency: (k + (a - c) / (2 * (a - 2 * b + c))) * spacing, amplitude: at });
  }
  found.sort((one, other) => other.amplitude - one.amplitude);
  return found.filter(({ amplitude }) => amplitude >= SHARE * found[0].amplitude).slice(0, PEAKS);
}

/** Lines in the plot with their names, each in the first row where it has room. */
function mark(u, lines, per) {
  const { ctx } = u, pixel = devicePixelRatio;
  ctx.save();
  ctx.font = `${11 * pixel}px system-ui`;
  ctx.textAlign = 'left';
  const ends = [];
  const drawn = lines.flatMap((line, i) => Array.from({ length: line.once ? 1 : DRAWN }, (_, k) => ({ line, i, multiple: k + 1, x: u.valToPos(((k + 1) * line.frequency) / per, 'x', true) })));
  for (const { line, i, multiple, x } of drawn.filter(({ x }) => x >= u.bbox.left && x <= u.bbox.left + u.bbox.width).sort((one, other) => one.x - other.x)) {
    ctx.strokeStyle = colour(i + 1);
    ctx.globalAlpha = multiple > 1 ? 0.4 : line.once ? 0.6 : 0.9;
    ctx.setLineDash(multiple > 1 ? [4, 4] : line.once ? [2, 3] : []);
    ctx.beginPath(); ctx.moveTo(x, u.bbox.top); ctx.lineTo(x, u.bbox.top + u.bbox.height); ctx.stroke();
    if (multiple > 1) continue;
    const wide = ctx.measureText(line.short).width + 10 * pixel;
    let row = ends.findIndex(end => end <= x);
    if (row < 0) row = ends.length;
    ends[row] = x + wide;
    ctx.globalAlpha = 1;
    ctx.fillStyle = colour(i + 1);
    ctx.fillText(line.short, x + 4 * pixel, u.bbox.top + (14 + 14 * row) * pixel);
  }
  ctx.restore();
}
