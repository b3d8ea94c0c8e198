// The plot of a spectrum with its lines, and its largest peaks by name.

import uPlot from 'uplot';
import { h, table } from './dom.js';
import { css, colour, onTheme } from './theme.js';
import { DRAWN, nameOf } from './lines.js';
import { digits } from './units.js';

/** Amplitude in the unit of the plot that is rounding of zeros: no axis can be written for less. */
export const NOTHING = 1e-11;
/** Peaks that are named, and share of the largest below which none is. */
const PEAKS = 8, SHARE = 0.02;

/** A place for a spectrum, which `look` describes whenever it is drawn: frequencies `x` and amplitudes `y` in units of the plot, labels, is its scale logarithmic, the lines of a group over `per` [Hz]. */
export class SpectrumPlot {
  constructor(label, look) {
    this.body = h('div', { class: 'plot-body', role: 'img', 'aria-label': label });
    this.look = look;
    this.plot = null;
    onTheme(() => this.draw());
    let waiting = 0;
    addEventListener('resize', () => { clearTimeout(waiting); waiting = setTimeout(() => this.plot?.setSize({ width: this.width(), height: 340 }), 120); });
    // Drawn once its place has a width.
    new IntersectionObserver((changes, observer) => { if (changes.some(change => change.isIntersecting)) { this.draw(); observer.disconnect(); } }, { rootMargin: '300px' }).observe(this.body);
  }

  width() { return Math.max(this.body.clientWidth, 280); }

  draw() {
    this.plot?.destroy();
    const { x, y, xLabel, xShort, yLabel, logarithmic, lines, per } = this.look();
    const top = Math.max(...y) || 1;
    const ink = { stroke: css('--ink-2'), grid: { stroke: css('--grid'), width: 1 }, ticks: { stroke: css('--grid') }, font: '12px system-ui' };
    this.plot = new uPlot({
      width: this.width(), height: 340, legend: { show: true },
      cursor: { drag: { x: true, y: false } },
      scales: { x: { time: false }, y: logarithmic ? { distr: 3, range: (u, low, high) => [Math.max(low, high * 1e-5, NOTHING), Math.max(high * 1.6, 10 * NOTHING)] } : { range: (u, low, high) => [0, Math.max(high * 1.1, 10 * NOTHING)] } },
      axes: [{ ...ink, label: xLabel }, { ...ink, size: 78, label: yLabel, values: (u, values) => values.map(v => (v === null ? '' : digits(v, 2))) }],
      series: [{ label: xShort, value: (u, v) => (v === null ? '' : digits(v, 5)) }, { label: yLabel, stroke: () => colour(0), width: 1.4, value: (u, v) => (v === null ? '' : digits(v, 4)), points: { show: false } }],
      hooks: { draw: [u => mark(u, lines, per)] },
    }, [x, Float64Array.from(y, v => (logarithmic ? Math.max(v, top * 1e-9, NOTHING) : v))], this.body);
  }
}

/** A table of the largest peaks of amplitudes at multiples of a spacing [Hz], each with the line that it is on; nothing where there is none. */
export function peakTable(amplitudes, spacing, resolution, lines, shown, order) {
  const found = largest(amplitudes, spacing);
  const rows = found.map(({ frequency, amplitude }) => [nameOf(lines, frequency, spacing, resolution) ?? '\u2013', digits(frequency, 5), order(frequency), shown(amplitude)]);
  return rows.length ? [table(['peak', 'Hz', 'order', 'amplitude'], rows, { numbers: [1, 2, 3], caption: 'Largest peaks, and the line that each is on' })] : [];
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
