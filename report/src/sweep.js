// A sweep: its cases as a table, maps over their settings, and a click into a case.

import uPlot from 'uplot';
import { h, s, section, select, table } from './dom.js';
import { Run, readGrid } from './data.js';
import { addSteps } from './cost.js';
import { css, colour, onTheme, viridisCss } from './theme.js';
import { label as tickLabel } from './plots.js';
import { digits, shown } from './units.js';

export async function readSweep(json) {
  const numbers = (await readGrid(json.numbers)).columns;
  const texts = new Map(json.texts.map(text => [text.name, text.cells]));
  const words = settingsAsNumbers(json.keys, texts, numbers);
  const tables = new Map();
  for (const [name, grids] of Object.entries(json.tables ?? {})) tables.set(name, await Promise.all(grids.map(readGrid)));
  const runs = new Map();
  for (const [name, record] of Object.entries(json.runs ?? {})) {
    const run = await Run.of(record, 0);
    addSteps(run);
    runs.set(name, run);
  }
  return { ...json, numbers, texts, words, tables, runs, count: json.numbers.rows };
}

/** Settings that are texts have an axis, too: "6000 rpm" by its number where all have one unit, others by their order. Gives what stands at the ticks of those. */
function settingsAsNumbers(keys, texts, numbers) {
  const words = new Map();
  for (const key of keys.filter(name => texts.has(name) && !numbers.has(name))) {
    const cells = texts.get(key);
    const parts = cells.map(cell => /^\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(\D*)$/.exec(cell));
    const units = new Set(parts.filter(Boolean).map(part => part[2].trim()));
    if (units.size === 1 && parts.every((part, i) => part || cells[i] === '')) {
      numbers.set(key, { values: Float64Array.from(parts, part => (part ? Number(part[1]) : NaN)), unit: [...units][0] });
      continue;
    }
    const own = [...new Set(cells.filter(cell => cell !== ''))];
    if (!own.length || own.length > 40) continue;
    words.set(key, own);
    numbers.set(key, { values: Float64Array.from(cells, cell => (cell === '' ? NaN : own.indexOf(cell))), unit: '' });
  }
  return words;
}

/** Cells as texts and as numbers. */
function cell(sweep, name, i, count = 5) {
  const number = sweep.numbers.get(name);
  if (sweep.texts.has(name)) return sweep.texts.get(name)[i];
  if (number) {
    if (!Number.isFinite(number.values[i])) return '';
    if (name === 'case') return String(Math.round(number.values[i]));
    const text = digits(number.values[i], count);
    // Settings are written as their user wrote them.
    return sweep.keys.includes(name) && text.includes('.') ? text.replace(/\.?0+$/, '') : text;
  }
  return sweep.texts.get(name)?.[i] ?? '';
}

/** `open` is given the whole run of the case that is chosen, or nothing where the sweep has not kept it. */
export function sweepSection(sweep, index, open) {
  const id = `sweep-${index}`;
  const isFigure = name => sweep.numbers.has(name) && name !== 'case' && !sweep.keys.includes(name) && !/\.settled$|\.interval$/.test(name);
  const figures = sweep.order.filter(isFigure);
  const numeric = [...sweep.keys.filter(key => sweep.numbers.has(key)), ...figures];
  const preferred = figures.find(name => /friction.torque.*mean|friction_torque/.test(name)) ?? figures.find(name => /mean/.test(name)) ?? figures[0];
  const state = { sort: 'case', down: false, filter: '', x: sweep.keys.find(key => sweep.numbers.has(key)) ?? 'case', y: sweep.keys.filter(key => sweep.numbers.has(key))[1] ?? preferred, c: preferred, chosen: null, columns: [preferred, ...figures.filter(name => name !== preferred && /mean$|\.mean/.test(name))].slice(0, 6) };
  const detail = h('div', { class: 'case', tabindex: -1, 'aria-live': 'polite' });
  const list = h('div', {});
  const map = h('div', {});
  const choose = i => { state.chosen = i; showCase(sweep, i, detail); open(runOf(sweep, i)); drawMap(); drawTable(); detail.scrollIntoView({ behavior: 'smooth', block: 'nearest' }); };
  // Why a case failed stands in its row.
  const stateOf = i => [cell(sweep, 'status', i), sweep.texts.get('reason')?.[i]].filter(Boolean).join(': ');
  const drawTable = () => {
    const names = ['case', ...sweep.keys, 'status', ...state.columns];
    const key = i => { const number = sweep.numbers.get(state.sort); return number ? number.values[i] : cell(sweep, state.sort, i); };
    const rows = Array.from({ length: sweep.count }, (_, i) => i).filter(i => !state.filter || names.some(name => String(cell(sweep, name, i)).includes(state.filter)))
      .sort((a, b) => { const [p, q] = [key(a), key(b)]; const order = typeof p === 'number' ? (Number.isNaN(p) ? 1 : Number.isNaN(q) ? -1 : p - q) : String(p).localeCompare(String(q)); return state.down ? -order : order; });
    const head = names.map(name => h('button', { type: 'button', class: 'sort', 'aria-label': `Sort by ${name}`, onclick: () => { state.down = state.sort === name ? !state.down : false; state.sort = name; drawTable(); } }, label(sweep, name), state.sort === name ? (state.down ? ' \u25be' : ' \u25b4') : ''));
    const shownRows = rows.slice(0, 400);
    list.replaceChildren(table(head, shownRows.map(i => names.map((name, k) => (k === 0 ? h('button', { type: 'button', class: `open ${state.chosen === i ? 'chosen' : ''}`, 'aria-label': `Open case ${cell(sweep, 'case', i)}`, onclick: () => choose(i) }, cell(sweep, 'case', i)) : name === 'status' ? stateOf(i) : cell(sweep, name, i)))), { numbers: names.map((_, i) => i).filter(i => sweep.numbers.has(names[i])) }),
      h('p', { class: 'note' }, `${rows.length} of ${sweep.count} cases${rows.length > shownRows.length ? `, the first ${shownRows.length} are listed` : ''}`));
  };
  const drawMap = () => map.replaceChildren(scatter(sweep, state, choose));
  drawTable();
  drawMap();
  const options = numeric.map(name => [name, label(sweep, name)]);
  const picker = (text, field) => select(text, options, state[field], name => { state[field] = name; drawMap(); });
  onTheme(drawMap);
  return section(id, sweep.name && sweep.name !== 'sweep' ? `Sweep: ${sweep.name}` : 'Sweep',
    h('div', { class: 'row' }, picker('Across', 'x'), picker('Up', 'y'), picker('Colour', 'c')), map, detail,
    h('div', { class: 'row' }, h('label', { class: 'field' }, h('span', {}, 'Find in the table'), h('input', { type: 'search', oninput: event => { state.filter = event.target.value; drawTable(); } })),
      select('Add a column', [['', '\u2026'], ...figures.map(name => [name, label(sweep, name)])], '', name => { if (name && !state.columns.includes(name)) { state.columns.push(name); drawTable(); } })), list);
}

function label(sweep, name) {
  const unit = sweep.numbers.get(name)?.unit;
  return unit && unit !== '1' ? `${name} [${unit}]` : name;
}

/** A map: a point for each case, coloured by a figure. */
function scatter(sweep, state, choose) {
  const [W, H, L, B, T, Rr] = [880, 440, 84, 56, 34, 120];
  const column = name => sweep.numbers.get(name)?.values ?? new Float64Array(sweep.count).fill(NaN);
  const [xs, ys, cs] = [column(state.x), column(state.y), column(state.c)];
  const ok = i => Number.isFinite(xs[i]) && Number.isFinite(ys[i]);
  const rows = Array.from({ length: sweep.count }, (_, i) => i).filter(ok);
  const extent = values => { let [low, high] = [Infinity, -Infinity]; for (const i of rows) if (Number.isFinite(values[i])) { low = Math.min(low, values[i]); high = Math.max(high, values[i]); } if (!(high > low)) { const d = Math.abs(low) * 0.05 || 1; return Number.isFinite(low) ? [low - d, high + d] : [0, 1]; } return [low, high]; };
  const air = ([low, high]) => [low - 0.05 * (high - low), high + 0.05 * (high - low)];
  const [x0, x1] = air(extent(xs)), [y0, y1] = air(extent(ys)), [c0, c1] = extent(cs);
  const px = v => L + ((v - x0) / (x1 - x0)) * (W - L - Rr), py = v => H - B - ((v - y0) / (y1 - y0)) * (H - B - T);
  const svg = s('svg', { viewBox: `0 0 ${W} ${H}`, class: 'map', role: 'group', 'aria-label': `Map of ${state.c} over ${state.x} and ${state.y}` });
  // Words stand at their places, numbers at quarters.
  const ticks = (name, low, high) => {
    const words = sweep.words.get(name);
    if (words) return words.map((word, at) => [at, word.length > 14 ? `${word.slice(0, 13)}\u2026` : word]).filter(([at]) => at % Math.ceil(words.length / 8) === 0);
    const values = [0, 1, 2, 3, 4].map(k => low + ((high - low) * k) / 4);
    return values.map(value => [value, tickLabel(value, values)]);
  };
  for (const [vx, text] of ticks(state.x, x0, x1)) svg.append(s('line', { class: 'grid', x1: px(vx), x2: px(vx), y1: T, y2: H - B }), s('text', { class: 'tick', x: px(vx), y: H - B + 18, 'text-anchor': 'middle' }, text));
  for (const [vy, text] of ticks(state.y, y0, y1)) svg.append(s('line', { class: 'grid', x1: L, x2: W - Rr, y1: py(vy), y2: py(vy) }), s('text', { class: 'tick', x: L - 8, y: py(vy) + 4, 'text-anchor': 'end' }, text));
  svg.append(s('text', { class: 'tick strong', x: (L + W - Rr) / 2, y: H - 12, 'text-anchor': 'middle' }, label(sweep, state.x)),
    s('text', { class: 'tick strong', transform: `translate(20 ${(H - B + T) / 2}) rotate(-90)`, 'text-anchor': 'middle' }, label(sweep, state.y)));
  const radius = rows.length > 600 ? 3 : rows.length > 120 ? 5 : 8;
  for (const i of rows) {
    const open = () => choose(i);
    svg.append(s('circle', { cx: px(xs[i]), cy: py(ys[i]), r: state.chosen === i ? radius + 3 : radius, fill: Number.isFinite(cs[i]) ? viridisCss((cs[i] - c0) / (c1 - c0)) : 'none', class: `case-dot ${state.chosen === i ? 'chosen' : ''}`, tabindex: 0, role: 'button',
      'aria-label': `Case ${cell(sweep, 'case', i)}: ${state.c} ${cell(sweep, state.c, i)}`, onclick: open, onkeydown: event => { if (event.key === 'Enter' || event.key === ' ') { event.preventDefault(); open(); } } },
    s('title', {}, `case ${cell(sweep, 'case', i)}: ${sweep.keys.map(key => `${key} = ${cell(sweep, key, i)}`).join(', ')}; ${state.c} = ${cell(sweep, state.c, i)}`)));
  }
  for (let k = 0; k < 100; k++) svg.append(s('rect', { x: W - Rr + 30, y: H - B - ((k + 1) * (H - B - T - 30)) / 100, width: 16, height: (H - B - T - 30) / 100 + 0.6, fill: viridisCss(k / 99) }));
  svg.append(s('text', { class: 'tick', x: W - Rr + 52, y: H - B }, digits(c0, 3)), s('text', { class: 'tick', x: W - Rr + 52, y: T + 40 }, digits(c1, 3)), s('text', { class: 'tick strong', x: W - 4, y: 20, 'text-anchor': 'end' }, label(sweep, state.c)));
  const left = sweep.count - rows.length;
  return h('div', { class: 'scroll' }, svg, left > 0 ? h('p', { class: 'note' }, `${left} of ${sweep.count} cases have no number there: they failed, or leave the key as it is in the scene.`) : null);
}

/** Name of the files of a case. */
const fileOf = (sweep, i) => sweep.texts.get('file')?.[i] ?? cell(sweep, 'file', i);

const runOf = (sweep, i) => sweep.runs.get(fileOf(sweep, i));

/** All that is known of a case. */
function showCase(sweep, i, holder) {
  const settings = sweep.keys.map(key => [key, cell(sweep, key, i)]);
  const reason = sweep.texts.get('reason')?.[i];
  const others = sweep.order.filter(name => !sweep.keys.includes(name) && !['case', 'file', 'status', 'reason'].includes(name) && cell(sweep, name, i) !== '');
  const parts = [h('h3', {}, `Case ${cell(sweep, 'case', i)}: ${cell(sweep, 'status', i)}`), h('dl', { class: 'facts' }, settings.flatMap(([key, value]) => [h('dt', {}, label(sweep, key)), h('dd', {}, value || 'as in the scene')]))];
  if (reason) parts.push(h('p', { class: 'warning' }, reason));
  const tables = sweep.tables.get(fileOf(sweep, i));
  const number = cell(sweep, 'case', i);
  parts.push(runOf(sweep, i) ? h('p', {}, h('a', { href: '#drawing' }, `Drawing${runOf(sweep, i).shaft ? '' : ', playback'} and plots of case ${number}`), ' stand below.')
    : h('p', { class: 'note' }, 'For its drawing, playback and plots, give the command of the sweep ', h('code', {}, `--runs ${number}`), ' once more, and make this page again.'));
  if (tables) parts.push(caseplots(tables));
  parts.push(h('details', { open: !tables }, h('summary', {}, `All ${others.length} figures`), table(['figure', 'value'], others.map(name => [label(sweep, name), cell(sweep, name, i, 6)]), { numbers: [1] })));
  holder.replaceChildren(...parts);
}

/** Plots of the table of a case. */
function caseplots(grids) {
  const columns = grids.flatMap(grid => [...grid.columns].filter(([name, column]) => name !== 'time' && !column.constant).map(([name, column]) => ({ name, ...column, t: grid.columns.get('time').values })));
  const body = h('div', { class: 'plot-body' });
  let plot = null;
  const draw = name => {
    plot?.destroy();
    const column = columns.find(other => other.name === name);
    const [factor, unit] = shown(name, column.unit, Math.max(...column.values.map(Math.abs)));
    const axis = { stroke: css('--ink-2'), grid: { stroke: css('--grid'), width: 1 }, font: '12px system-ui' };
    plot = new uPlot({ width: Math.max(body.clientWidth, 300), height: 240, legend: { show: false }, scales: { x: { time: false } }, axes: [{ ...axis, label: 'time [ms]' }, { ...axis, size: 70, label: `${name}${unit ? ` [${unit}]` : ''}` }], series: [{}, { stroke: colour(0), width: 1.5, points: { show: false } }] },
      [Float64Array.from(column.t, t => t * 1e3), Float64Array.from(column.values, v => v * factor)], body);
  };
  if (!columns.length) return null;
  const start = columns.find(column => column.name === 'friction_torque')?.name ?? columns[0].name;
  requestAnimationFrame(() => draw(start));
  return h('div', {}, select('Over time', columns.map(column => [column.name, column.name]), start, draw), body);
}
