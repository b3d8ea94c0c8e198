// Spectra of the second half of the run, with the frequencies of bearings and meshes, the orders of the shaft, and the largest peaks by name.

import { h, section, select, choice, table } from './dom.js';
import { secondHalf, spectrum } from './fft.js';
import { linesOf } from './lines.js';
import { SpectrumPlot, peakTable } from './spectrum_plot.js';
import { digits, shown } from './units.js';

export function spectra(run) {
  const candidates = [...run.series.values()].filter(s => !s.constant && s.t.length >= 64 && (run.shaft ? !run.shaft.shafts.some(({ name }) => s.name === `${name}.angle`) : /force|moment|position|torque|power|speed|load$|eccentricity|slip|angle|acceleration/.test(s.name))).map(s => s.name)
    .filter(name => !run.isNothing(name)).sort((a, b) => a.startsWith('ball[') - b.startsWith('ball[') || a.localeCompare(b));
  if (!candidates.length) return null;
  const liveliest = [...(run.shaft?.meshes ?? []).map(name => `${name}.normal_force`), ...['y', 'z', 'x'].map(axis => (run.shaft ? `${run.shaft.bearings[0].shaft}.${run.shaft.bearings[0].name}.${axis}` : `${run.bearing.loaded}.force.${axis}`))].filter(name => candidates.includes(name));
  const state = { name: liveliest[0] ?? candidates[0], axis: 'Hz', scale: 'log', group: 0 };
  const lines = linesOf(run);
  const [note, peaks, named] = [h('p', { class: 'note' }), h('div'), h('div')];
  const order = frequency => (lines.shaft > 0 ? digits(frequency / lines.shaft, 4) : '\u2013');
  const list = () => named.replaceChildren(table(['line', 'what', 'Hz', 'order'], (lines.groups[state.group]?.lines ?? []).map(line => [line.short, line.long, digits(line.frequency, 5), order(line.frequency)]), { numbers: [2, 3], caption: 'Lines in the plot' }));
  list();
  const plot = new SpectrumPlot('Amplitude spectrum', () => {
    const series = run.get(state.name);
    const { values, dt } = secondHalf(series, run);
    const { amplitudes, n } = spectrum(values);
    const [spacing, resolution] = [1 / (n * dt), 2 / (values.length * dt)];
    const orders = state.axis === 'order' && lines.shaft > 0;
    const per = orders ? lines.shaft : 1e3;
    const [factor, unit] = shown(state.name, series.unit, Math.max(...amplitudes));
    const stride = series.t.length < (run.record.table_rows ?? 0);
    note.textContent = `Hann window over ${digits(values.length * dt * 1e3, 4)} ms, resolution ${digits(resolution, 3)} Hz, up to ${digits(0.5e-3 / dt, 4)} kHz, half the frequency of the rows.${stride ? ' The page has every n-th row of the table: what is faster than that folds back.' : ' What is faster than that folds back.'}`;
    peaks.replaceChildren(...peakTable(amplitudes, spacing, resolution, lines, amplitude => `${digits(amplitude * factor, 4)}${unit ? ` ${unit}` : ''}`, order));
    return {
      x: Float64Array.from(amplitudes, (_, k) => (k * spacing) / per), y: Float64Array.from(amplitudes, a => a * factor),
      xLabel: orders ? 'order of the shaft' : 'frequency [kHz]', xShort: orders ? 'order' : 'kHz', yLabel: `${state.name}${unit ? ` [${unit}]` : ''}`,
      logarithmic: state.scale === 'log', lines: lines.groups[state.group]?.lines ?? [], per,
    };
  });
  const draw = () => plot.draw();
  return section('spectra', 'Spectra', h('div', { class: 'row' },
    select('Quantity', candidates.map(name => [name, name]), state.name, name => { state.name = name; draw(); }),
    lines.shaft > 0 ? choice('Axis', [['Hz', 'frequency'], ['order', 'order']], state.axis, axis => { state.axis = axis; draw(); }) : null,
    lines.groups.length > 1 ? select('Lines', lines.groups.map(({ name }, i) => [i, name]), state.group, group => { state.group = Number(group); list(); draw(); }) : null,
    choice('Scale', [['log', 'logarithmic'], ['linear', 'linear']], state.scale, scale => { state.scale = scale; draw(); })), plot.body, note, peaks, named);
}
