// Plots over time: cursors and zoom of all of them go together, and with the playback.

import uPlot from 'uplot';
import { h, section, choice } from './dom.js';
import { clock } from './clock.js';
import { shaftsOf } from './machine.js';
import { css, colour, ballColour, onTheme } from './theme.js';
import { digits, shown } from './units.js';

const ms = 1e3;
const plots = new Set();
let zoom = null;

/** Quantities of the bearing, or of the shaft: title, columns with a word each. */
function groups(run) {
  if (run.shaft) return ofShaft(run);
  const race = run.bearing.loaded;
  const xyz = (name, axes = ['x', 'y', 'z']) => axes.map(axis => [`${name}.${axis}`, axis]);
  return [
    [`Force of the bearing on the ${race} race`, xyz(`${race}.force`)],
    [`Moment of the bearing on the ${race} race, across the axis`, xyz(`${race}.moment`, ['y', 'z'])],
    [`Position of the ${race} race`, xyz(`${race}.position`)],
    [`Rotation of the ${race} race`, xyz(`${race}.rotation`, ['y', 'z'])],
    ['Friction torque', [['friction_torque', 'torque']]],
    ['Power', [['loss.total', 'all losses'], ['friction_power', 'friction'], ['power.inner', 'inner contacts'], ['power.outer', 'outer contacts'], ['power.spin', 'of it spin'], ['damping_power', 'damping']]],
    ['Cage speed', [['cage.speed', 'cage']]],
    ['Slip of cage and balls below rolling', [['cage.slip', 'cage'], ['balls.slip', 'balls']]],
    ['Cage, centre', xyz('cage.eccentricity', ['y', 'z'])],
    ['Loads of balls, extremes', [['balls.largest_load', 'largest'], ['balls.smallest_load', 'least']]],
  ];
}

/** Motion of the shaft at its bearings, then at other places, and of housings; a text is a heading. */
function ofShaft(run) {
  const { shaft } = run;
  const shafts = shaftsOf(run);
  const axes = [['x', 'Displacement along x'], ['y', 'Displacement along y'], ['z', 'Displacement along z']];
  const turns = [['ry', 'Tilt about y'], ['rz', 'Tilt about z']];
  const at = (body, names, axis) => names.map(name => [`${body}.${name}.${axis}`, name]);
  const names = list => list.map(({ name }) => name);
  const motion = (body, list, what) => what.map(([axis, title]) => [title, at(body, list, axis)]);
  return [
    ...shafts.flatMap(({ name, bearings, loads, points }) => {
      const [of, heading] = shafts.length > 1 ? [name, name] : ['the shaft', 'The shaft'];
      return [[`Speed of ${of}`, [[`${name}.speed`, 'speed']]], [`Torque that drives ${of}`, [[`${name}.torque`, 'torque']]],
        `${heading} at its bearings`, ...motion(name, names(bearings), [...axes, ...turns]),
        `${heading} at loads and points`, ...motion(name, names([...loads, ...points]), axes)];
    }),
    ...(shaft.meshes ?? []).length ? ['Meshes', ['Force normal to the teeth', shaft.meshes.map(name => [`${name}.normal_force`, name])], ...['x', 'y', 'z'].map(axis => [`Force on the first gear along ${axis}`, shaft.meshes.map(name => [`${name}.force.${axis}`, name])])] : [],
    ...shaft.housings.flatMap(housing => [`${housing.name}, at its bearings, loads and points`,
      ...motion(housing.name, [...names(shaft.bearings.filter(bearing => bearing.housing === housing.name)), ...names(housing.loads), ...names(housing.points)], [...axes, ['rx', 'Rotation about x'], ['ry', 'Rotation about y'], ['rz', 'Rotation about z']])]),
  ];
}

/** Quantities of every ball. */
const OF_BALLS = [
  ['Load', 'load'], ['Contact angle', 'contact_angle'], ['Peak pressure', 'peak_pressure'],
  ['Longitudinal creepage', 'creepage_longitudinal'], ['Lateral creepage', 'creepage_lateral'], ['Spin creepage', 'creepage_spin'],
  ['Longitudinal creep force', 'force_longitudinal'], ['Lateral creep force', 'force_lateral'], ['Spin moment', 'spin_moment'], ['Friction power', 'power'],
];

export function plotsSection(runs, current) {
  const run = current;
  const blocks = [h('div', { class: 'plots' })];
  for (const group of groups(run)) {
    if (typeof group === 'string') { blocks.push(h('h3', {}, group), h('div', { class: 'plots' })); continue; }
    const [title, columns] = group;
    // Several runs: the same columns of all of them.
    const curves = runs.flatMap((other, k) => columns.filter(([name]) => other.has(name) && !other.isNothing(name))
      .map(([name, word]) => ({ run: other, name, word: runs.length > 1 ? `${word} \u00b7 ${other.name}` : word, dash: k })));
    if (curves.length) blocks.at(-1).append(plot(title, curves));
  }
  // A heading of nothing is left out.
  const whole = blocks.filter((block, i) => (block.tagName === 'H3' ? blocks[i + 1] : block).childElementCount);
  const balls = h('div', { class: 'plots' });
  const showBalls = race => {
    drop(balls);
    for (const [title, quantity] of OF_BALLS) {
      const names = run.ofBalls(`${race}.${quantity}`).filter(name => run.has(name));
      if (!names.length || names.every(name => run.isNothing(name))) continue;
      balls.append(plot(`${title}, ${race} race`, names.map((name, i) => ({ run, name, word: String(i + 1), ball: i + 1 }))));
    }
  };
  if (run.bearing) showBalls('inner');
  const own = h('div', { class: 'plots' });
  const all = [...run.series.keys()].filter(name => run.get(name).t.length > 1).sort();
  const input = h('input', { list: 'columns', type: 'search', placeholder: `column, such as ${run.shaft ? `${run.shaft.bearings[0].shaft}.${run.shaft.bearings[0].name}.z` : 'ball[3].outer.load'}`, 'aria-label': 'Column to plot', onchange: () => add() });
  const add = () => {
    const name = input.value.trim();
    const found = all.includes(name) ? [name] : all.filter(column => name.length > 2 && column.includes(name)).slice(0, 24);
    if (!found.length) return;
    // Columns of one unit go into one plot.
    const unit = run.get(found[0]).unit;
    own.prepend(plot(name, found.filter(column => run.get(column).unit === unit).map(column => ({ run, name: column, word: column })), true));
    input.value = '';
  };
  return section('histories', 'Over time',
    h('p', { class: 'note' }, 'Move over a plot: cursors of all plots and the playback follow. Drag to zoom in, double-click to zoom out. Click a name to hide its curve. Curves that are 0 throughout are left out.'),
    whole, run.bearing ? [h('h3', {}, 'Every ball'), choice('Race', [['inner', 'inner race'], ['outer', 'outer race']], 'inner', showBalls), balls] : null,
    h('h3', {}, `Any of the ${all.length} columns`), h('div', { class: 'row' }, input, h('datalist', { id: 'columns' }, all.map(name => h('option', { value: name }))), h('button', { type: 'button', onclick: add }, 'Plot')), own);
}

/** [px] of a plot, with the name of its time axis. */
const HEIGHT = 228;

function drop(holder) {
  for (const entry of [...plots]) if (holder.contains(entry.holder)) { entry.plot?.destroy(); plots.delete(entry); }
  holder.replaceChildren();
}

/** Curves of runs on the union of their times. */
function joined(curves, factor) {
  const times = [...new Set(curves.map(curve => curve.run.get(curve.name).t))];
  const tables = times.map(t => [Float64Array.from(t, x => x * ms), ...curves.filter(curve => curve.run.get(curve.name).t === t).map(curve => scaled(curve.run.get(curve.name).v, factor))]);
  const order = times.flatMap(t => curves.filter(curve => curve.run.get(curve.name).t === t));
  return { data: tables.length === 1 ? tables[0] : uPlot.join(tables), order };
}

const scaled = (values, factor) => Float64Array.from(values, v => (Number.isFinite(v) ? v * factor : NaN));

/** Range that shows noise as noise, and is not set by the first row alone. */
function range(u, low, high) {
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [0, 1];
  // What is smaller than any axis can be written for is rounding of zeros.
  const span = Math.max(1e-9 * Math.max(Math.abs(low), Math.abs(high)), 1e-11);
  const air = high - low > span ? 0.06 * (high - low) : Math.max(0.05 * Math.abs(high), 1e-9);
  return [low - air, high + air];
}

/** The range of curves without the jump of the first rows, where that is much larger than all that follows. */
function afterStart(data) {
  const x = data[0];
  const from = x[0] + 0.02 * (x[x.length - 1] - x[0]);
  let [low, high, all0, all1] = [Infinity, -Infinity, Infinity, -Infinity];
  for (const values of data.slice(1)) {
    for (let i = 0; i < values.length; i++) {
      const v = values[i];
      if (!Number.isFinite(v)) continue;
      all0 = Math.min(all0, v); all1 = Math.max(all1, v);
      if (x[i] >= from) { low = Math.min(low, v); high = Math.max(high, v); }
    }
  }
  return high - low > 0 && all1 - all0 > 5 * (high - low) ? [low, high] : null;
}

function plot(title, curves, closable = false) {
  const first = curves[0].run.get(curves[0].name);
  const largest = Math.max(...curves.map(curve => Math.max(...curve.run.range(curve.name).map(Math.abs).filter(Number.isFinite), 0)));
  const [factor, unit] = shown(first.name, first.unit, largest);
  const head = `${title}${unit ? ` [${unit}]` : ''}`;
  const body = h('div', { class: 'plot-body' });
  const readout = h('div', { class: 'readout', 'aria-live': 'off' });
  const playhead = h('div', { class: 'playhead' });
  const note = h('button', { type: 'button', class: 'whole', hidden: true, onclick: () => { entry.whole = !entry.whole; note.setAttribute('aria-pressed', String(entry.whole)); rescale(entry); } }, 'show the start');
  const holder = h('figure', { class: 'plot', role: 'group', 'aria-label': `Plot of ${head} over time` },
    h('figcaption', {}, h('span', {}, head), note, closable ? h('button', { type: 'button', class: 'close', 'aria-label': `Remove the plot ${title}`, onclick: () => { entry.plot?.destroy(); plots.delete(entry); holder.remove(); } }, '\u00d7') : null), body, readout);
  const entry = { holder, body, readout, playhead, note, curves, factor, unit, visible: false, plot: null, whole: false, hidden: new Set() };
  plots.add(entry);
  seen.observe(holder);
  entry.holder.entry = entry;
  return holder;
}

/** Plots are made when they come into view. */
const seen = new IntersectionObserver(changes => {
  for (const { target, isIntersecting } of changes) {
    const entry = target.entry;
    entry.visible = isIntersecting;
    if (isIntersecting) { if (!entry.plot) make(entry); else show(entry); }
  }
}, { rootMargin: '200px' });

/** Makes all plots of the page at once, for paper. */
export function drawAll() {
  for (const holder of document.querySelectorAll('.plot')) if (holder.entry && !holder.entry.plot) make(holder.entry);
}

function strokeOf(curve, i, count) {
  if (curve.ball) return ballColour(curve.ball, curve.run.bearing.balls);
  return count > 7 ? ballColour(i + 1, count) : colour(curve.dash !== undefined ? i % Math.max(1, count) : i);
}

function make(entry) {
  const { data, order } = joined(entry.curves, entry.factor);
  entry.order = order;
  entry.data = data;
  entry.range = afterStart(data);
  entry.note.hidden = !entry.range;
  const axis = { stroke: css('--ink-2'), grid: { stroke: css('--grid'), width: 1 }, ticks: { stroke: css('--grid') }, font: '12px system-ui' };
  const options = {
    width: Math.max(entry.body.clientWidth, 240), height: HEIGHT,
    // Cursors follow the clock, which follows the pointer.
    cursor: { y: false, points: { size: 6 }, drag: { x: true, y: false, setScale: true } },
    legend: { show: false },
    scales: { x: { time: false, range: (u, low, high) => (zoom ?? [low, high]) }, y: { range: (u, low, high) => (entry.range && !entry.whole && !zoom ? range(u, ...entry.range) : range(u, low, high)) } },
    axes: [{ ...axis, size: 34, label: 'time [ms]', labelSize: 18, labelGap: 0, labelFont: '12px system-ui', values: (u, values) => values.map(v => label(v, values)) },
      { ...axis, size: (u, values) => Math.max(66, 20 + 7 * Math.max(0, ...(values ?? []).map(text => text.length))), values: (u, values) => values.map(v => label(v, values)) }],
    series: [{}, ...order.map((curve, i) => ({ label: curve.word, stroke: () => strokeOf(curve, i, order.length), width: 1.5, dash: curve.dash ? [6, 3 * curve.dash] : undefined, points: { show: false }, spanGaps: true, show: !entry.hidden.has(i) }))],
    hooks: {
      setCursor: [u => { if (entry.pointed && u.cursor.left >= 0) clock.seek(u.posToVal(u.cursor.left, 'x') / ms); }],
      setScale: [(u, key) => { if (key === 'x' && entry.plot) zoomed(entry); }],
    },
  };
  entry.plot = new uPlot(options, data, entry.body);
  // The group has the name, and the values stand below.
  entry.plot.root.setAttribute('aria-hidden', 'true');
  entry.plot.over.append(entry.playhead);
  entry.plot.over.addEventListener('pointerenter', () => { entry.pointed = true; });
  entry.plot.over.addEventListener('pointerleave', () => { entry.pointed = false; });
  entry.plot.over.addEventListener('dblclick', () => setZoom(null));
  entry.readout.replaceChildren(...order.map((curve, i) => {
    const value = h('b', {}, '');
    const item = h('button', { type: 'button', class: 'curve', 'aria-pressed': 'true', onclick: () => {
      const hide = !entry.hidden.has(i);
      if (hide) entry.hidden.add(i); else entry.hidden.delete(i);
      item.setAttribute('aria-pressed', String(!hide));
      entry.plot.setSeries(i + 1, { show: !hide });
    } }, h('i', { style: `background:${strokeOf(curve, i, order.length)}` }), `${curve.word} `, value);
    return item;
  }));
  entry.values = [...entry.readout.querySelectorAll('b')];
  show(entry);
}

/** Digits that tell the ticks apart. */
export function label(value, values) {
  const step = values.length > 1 ? Math.abs(values[1] - values[0]) : Math.abs(value) || 1;
  const decimals = Math.min(Math.max(Math.ceil(-Math.log10(step) - 1e-9), 0), 8);
  return Math.abs(value) >= 1e6 || (value !== 0 && step < 1e-6) ? digits(value, 3) : value.toFixed(decimals).replace('-', '\u2212');
}

function zoomed(entry) {
  if (setting) return;
  const { min, max } = entry.plot.scales.x;
  if (zoom && Math.abs(zoom[0] - min) < 1e-12 && Math.abs(zoom[1] - max) < 1e-12) return;
  const x = entry.data[0];
  if (!zoom && min <= x[0] && max >= x[x.length - 1]) return;
  setZoom([min, max]);
}

let setting = false;

export function setZoom(span) {
  zoom = span;
  setting = true;
  for (const entry of plots) if (entry.plot) rescale(entry);
  setting = false;
}

function rescale(entry) {
  const x = entry.data[0];
  const before = setting;
  setting = true;
  entry.plot.setScale('x', zoom ? { min: zoom[0], max: zoom[1] } : { min: x[0], max: x[x.length - 1] });
  setting = before;
  show(entry);
}

/** Line and values at the time of the clock. */
function show(entry) {
  const { plot: u } = entry;
  if (!u || !entry.visible) return;
  const time = clock.time * ms;
  const { min, max } = u.scales.x;
  const inside = time >= min && time <= max;
  entry.playhead.style.display = inside ? '' : 'none';
  if (inside) entry.playhead.style.transform = `translateX(${((time - min) / (max - min)) * u.over.clientWidth}px)`;
  entry.order.forEach((curve, i) => {
    const text = digits(curve.run.at(curve.name, clock.time) * entry.factor, 5);
    if (entry.values[i].textContent !== text) entry.values[i].textContent = text;
  });
}

function resize(entry) {
  if (!entry.plot) return;
  if (entry.body.isConnected) {
    entry.plot.setSize({ width: Math.max(entry.body.clientWidth, 240), height: HEIGHT });
  } else {
    // Of a run that is not shown: it is made again when it is.
    entry.plot.destroy();
    entry.plot = null;
  }
}

export function startPlots() {
  clock.follow(() => { for (const entry of plots) if (entry.visible) show(entry); });
  const again = () => {
    for (const entry of plots) if (entry.plot) { entry.plot.destroy(); entry.plot = null; if (entry.visible) make(entry); }
  };
  onTheme(again);
  let waiting = 0;
  addEventListener('resize', () => {
    clearTimeout(waiting);
    waiting = setTimeout(() => { for (const entry of plots) resize(entry); }, 100);
  });
}
