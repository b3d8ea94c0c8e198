// Spectra of the second half of the run, with the frequencies of the bearing and the orders of the shaft.

import uPlot from 'uplot';
import { h, section, select, choice, table } from './dom.js';
import { css, colour, onTheme } from './theme.js';
import { spectrum } from './fft.js';
import { digits, shown } from './units.js';

/** Amplitude in the unit of the plot that is rounding of zeros: no axis can be written for less. */
const NOTHING = 1e-11;

export function spectra(run) {
  const candidates = [...run.series.values()].filter(s => !s.constant && s.t.length >= 64 && (run.shaft ? !run.shaft.shafts.some(({ name }) => s.name === `${name}.angle`) : /force|moment|position|torque|power|speed|load$|eccentricity|slip|angle/.test(s.name))).map(s => s.name)
    .filter(name => !run.isNothing(name)).sort((a, b) => a.startsWith('ball[') - b.startsWith('ball[') || a.localeCompare(b));
  if (!candidates.length) return null;
  const liveliest = ['y', 'z', 'x'].map(axis => (run.shaft ? `${run.shaft.bearings[0].shaft}.${run.shaft.bearings[0].name}.${axis}` : `${run.bearing.loaded}.force.${axis}`)).filter(name => candidates.includes(name));
  const state = { name: liveliest[0] ?? candidates[0], axis: 'Hz', scale: 'log' };
  const lines = marked(run);
  const body = h('div', { class: 'plot-body', role: 'img', 'aria-label': 'Amplitude spectrum' });
  const note = h('p', { class: 'note' });
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
      hooks: { draw: [u => mark(u, lines, per)] },
    }, [x, Float64Array.from(y, v => (state.scale === 'log' ? Math.max(v, top * 1e-9, NOTHING) : v))], body);
    const stride = series.t.length < (run.record.table_rows ?? 0);
    note.textContent = `Hann window over ${digits(values.length * dt * 1e3, 4)} ms, resolution ${digits(2 / (values.length * dt), 3)} Hz, up to ${digits(0.5e-3 / dt, 4)} kHz, half the frequency of the rows.${stride ? ' The page has every n-th row of the table: what is faster than that folds back.' : ' What is faster than that folds back.'}`;
  };
  onTheme(draw);
  let waiting = 0;
  addEventListener('resize', () => { clearTimeout(waiting); waiting = setTimeout(() => plot?.setSize({ width: Math.max(body.clientWidth, 280), height: 340 }), 120); });
  // Drawn once its place has a width.
  new IntersectionObserver((changes, observer) => { if (changes.some(change => change.isIntersecting)) { draw(); observer.disconnect(); } }, { rootMargin: '300px' }).observe(body);
  return section('spectra', 'Spectra', h('div', { class: 'row' },
    select('Quantity', candidates.map(name => [name, name]), state.name, name => { state.name = name; draw(); }),
    lines.shaft > 0 ? choice('Axis', [['Hz', 'frequency'], ['order', 'order']], state.axis, axis => { state.axis = axis; draw(); }) : null,
    choice('Scale', [['log', 'logarithmic'], ['linear', 'linear']], state.scale, scale => { state.scale = scale; draw(); })), body, note,
  table(['frequency', 'name', 'Hz', 'order'], lines.list.map(line => [line.short, line.long, digits(line.frequency, 5), lines.shaft > 0 ? digits(line.frequency / lines.shaft, 4) : '\u2013']), { numbers: [2, 3] }));
}

/** Mean frequencies of cage and damage, and of the shaft; of a machine those of its meshes. */
function marked(run) {
  if (run.shaft) {
    const turns = run.shaft.shafts.map(({ name }) => Math.abs(run.mean(`${name}.speed`)) / (2 * Math.PI));
    const list = run.shaft.shafts.flatMap(({ name, gears }, i) => [
      { short: name, long: turns.length > 1 ? `turns of ${name}` : 'turns of the shaft', frequency: turns[i] },
      ...gears.flatMap(({ teeth }, k) => (teeth ? [{ short: `gear ${k + 1}`, long: `${teeth} teeth that mesh`, frequency: teeth * turns[i] }] : [])),
    ]);
    return { list: list.filter(line => line.frequency > 0), shaft: turns[0] };
  }
  const speeds = ['inner', 'outer'].map(race => Math.abs(run.mean(`${race}.speed`)) / (2 * Math.PI));
  const own = run.bearing.loaded === 'inner' ? 0 : 1;
  const shaft = (speeds[own] > 0 ? speeds[own] : speeds[1 - own]) || 0;
  const list = [
    ['FTF', 'cage', 'frequency.cage'], ['BPFO', 'balls over a place of the outer race', 'frequency.outer'],
    ['BPFI', 'balls over a place of the inner race', 'frequency.inner'], ['BSF', 'turns of a ball about itself', 'frequency.ball'],
  ].map(([short, long, name]) => ({ short, long, frequency: Math.abs(run.mean(name)) })).filter(line => line.frequency > 0);
  if (shaft > 0) list.unshift({ short: 'shaft', long: 'turns of the shaft', frequency: shaft });
  return { list, shaft };
}

function mark(u, { list }, per) {
  const { ctx } = u;
  ctx.save();
  ctx.font = `${11 * devicePixelRatio}px system-ui`;
  list.forEach((line, i) => {
    for (let multiple = 1; multiple <= 3; multiple++) {
      const x = u.valToPos((multiple * line.frequency) / per, 'x', true);
      if (!(x >= u.bbox.left && x <= u.bbox.left + u.bbox.width)) continue;
      ctx.strokeStyle = colour(i + 1);
      ctx.globalAlpha = multiple === 1 ? 0.9 : 0.4;
      ctx.setLineDash(multiple === 1 ? [] : [4, 4]);
      ctx.beginPath(); ctx.moveTo(x, u.bbox.top); ctx.lineTo(x, u.bbox.top + u.bbox.height); ctx.stroke();
      if (multiple === 1) { ctx.fillStyle = colour(i + 1); ctx.save(); ctx.translate(x + 4, u.bbox.top + 6 + 18 * i); ctx.fillText(line.short, 0, 10); ctx.restore(); }
    }
  });
  ctx.restore();
}
