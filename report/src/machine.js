// A machine: shafts and the bearings on them, whose runs follow that of the shafts.

import { h, section, table } from './dom.js';
import { millimetres } from './drawing.js';
import { kindOf } from './links.js';
import { figure, settledNote } from './summary.js';
import { digits, rpm, withUnit } from './units.js';

/** Gives runs of shafts the bearings that follow them, and names that tell bearings of several machines apart. */
export function assemble(runs) {
  const machines = runs.filter(run => run.shaft);
  for (const shaft of machines) {
    const names = shaft.shaft.bearings.map(bearing => bearing.name);
    const next = runs.slice(runs.indexOf(shaft) + 1, runs.indexOf(shaft) + 1 + names.length);
    if (!names.every((name, i) => next[i]?.bearing && next[i].name === name)) continue;
    next.forEach((run, i) => {
      shaft.mounted.set(names[i], run);
      run.of = { shaft, name: names[i] };
      if (machines.length > 1) run.name = `${shaft.name}: ${names[i]}`;
    });
  }
}

/** Runs that stand beside one: shafts beside shafts, a bearing of a machine beside those of its name, any other beside its like. */
export function likes(run, runs) {
  return runs.filter(other => Boolean(other.shaft) === Boolean(run.shaft) && other.of?.name === run.of?.name);
}

/** The shafts of a machine, each with its bearings and what else holds it. */
export function shaftsOf({ shaft }) {
  return shaft.shafts.map(own => ({ ...own, bearings: shaft.bearings.filter(bearing => bearing.shaft === own.name), links: (shaft.links ?? []).filter(link => link.shaft === own.name) }));
}

/** The machine in a few words. */
export function words({ shaft, series }) {
  const count = (list, word) => (list.length ? `${list.length} ${word}${list.length > 1 ? 's' : ''}` : null);
  const all = what => shaft.shafts.flatMap(own => own[what]);
  const speeds = shaft.shafts.map(({ name }) => series.get(`${name}.speed`).v.reduce((high, speed) => (Math.abs(speed) > Math.abs(high) ? speed : high), 0));
  return [shaft.shafts.length > 1 ? `${shaft.shafts.length} shafts` : 'shaft', count(shaft.bearings, 'bearing'), count(all('gears'), 'gear'), count(all('discs'), 'disc'), count(shaft.housings, 'housing'), speeds.map(rpm).join(', ')].filter(Boolean);
}

/** What a bearing does to the shaft, in the shaft's axes: along x, and across; means where there are some, else at the end. */
function forceOf({ figures, error_bars: bars }, direction) {
  const of = axis => [`force.${axis} on the inner race`, `end force.${axis}`].find(name => Number.isFinite(figures[name]));
  const [x, y, z] = ['x', 'y', 'z'].map(axis => figures[of(axis)] ?? NaN);
  const across = Math.hypot(y, z);
  const bar = axis => bars?.[of(axis)];
  return {
    along: direction * x, alongBar: bar('x'), across,
    acrossBar: Number.isFinite(bar('y') + bar('z')) ? (Math.abs(y) * bar('y') + Math.abs(z) * bar('z')) / (across || 1) : null,
  };
}

/** [N] largest load of a ball in the rows of a run. */
const largestLoad = run => Math.max(...['inner', 'outer'].flatMap(race => run.ofBalls(`${race}.load`).map(name => run.range(name)[1])));

/** Life under what acts in the second half, parts of it summed: in million revolutions, and in hours at the mean speed. */
function life(run, name) {
  const used = run.mean(name, value => 1 / value);
  if (!(used > 0)) return null;
  const turns = Math.abs(run.mean('inner.speed') - run.mean('outer.speed')) / (2 * Math.PI);
  const round = value => digits(Number(value.toPrecision(3)), 3);
  const hours = turns > 0 ? `, ${round(1e6 / used / turns / 3600)}\u202fh` : '';
  return `${round(1 / used)}\u00b710\u2076 turns${hours}`;
}

export function cards(run) {
  const { figures } = run.record.summary;
  const list = [];
  const card = (name, value, note, bad) => list.push(h('div', { class: 'card' }, h('div', { class: 'card-name' }, name), h('div', { class: 'card-value' }, value), h('div', { class: `card-note ${bad ? 'bad' : ''}` }, note)));
  for (const { name } of run.shaft.shafts) {
    const [speed, torque] = ['speed', 'torque'].map(what => [`${name}.${what}`, `end ${name}.${what}`].find(key => Number.isFinite(figures[key])));
    const of = run.shaft.shafts.length > 1 ? name : 'the shaft';
    card(`speed of ${of}`, rpm(figures[speed]), settledNote(run, `${name}.speed`));
    if (torque) card(`torque that drives ${of === name ? of : 'it'}`, figure('torque', figures[torque]), settledNote(run, `${name}.torque`));
  }
  const mounted = [...run.mounted];
  if (mounted.length) {
    const powers = mounted.map(([, own]) => own.record.summary.figures['loss.total']);
    if (powers.every(Number.isFinite)) card('losses', withUnit(powers.reduce((sum, power) => sum + power, 0), 'power', 'W', 5), 'mean, of all bearings');
    const worst = get => mounted.map(([name, own]) => [get(own), name]).reduce((a, b) => (b[0] > a[0] ? b : a));
    const [load, at] = worst(largestLoad);
    card('largest ball load', withUnit(load, 'load', 'N'), `in the run, of ${at}`);
    const [pressure, where] = worst(own => own.record.summary.peak_pressure);
    card('peak pressure', withUnit(pressure, 'pressure', 'Pa'), `largest in the run, of ${where}`);
  }
  return h('div', { class: 'cards' }, list);
}

/** A row for each bearing by rollers or by its stiffness and each coupling: forces on the shaft, means over the second half, and what its rollers have met. */
function linksTable(run, several) {
  const links = run.shaft.links ?? [];
  if (!links.length) return null;
  const rolls = links.some(({ rollers }) => rollers);
  const heads = ['held by', ...(several ? ['shaft'] : []), 'position', 'what it is', 'force across', 'force along x', ...(rolls ? ['largest roller load in the run', 'peak pressure'] : [])];
  const rows = links.map(link => {
    const [x, y, z] = ['x', 'y', 'z'].map(axis => run.mean(`${link.name}.force.${axis}`));
    const most = what => (link.rollers ? run.range(`${link.name}.${what}`)[1] : NaN);
    return [link.name, ...(several ? [link.shaft] : []), millimetres(link.position), kindOf(link), withUnit(Math.hypot(y, z), 'force', 'N'), withUnit(x, 'force', 'N'),
      ...(rolls ? [withUnit(most('largest_load'), 'load', 'N'), withUnit(most('peak_pressure'), 'pressure', 'Pa')] : [])];
  });
  return table(heads, rows, { numbers: heads.map((_, i) => i).filter(i => heads[i] === 'position' || i > heads.indexOf('what it is')) });
}

/** A row for each bearing, the energy of shaft and housings, and what is to be warned of. `open` shows the run of a bearing. */
export function machineSection(run, open) {
  const { figures, error_bars: bars } = run.record.summary;
  const mounted = [...run.mounted.values()];
  const lives = [['life.L10r', 'rating life L10r'], ['life.modified', 'modified life']].filter(([name]) => mounted.some(own => own.has(name)));
  const several = run.shaft.shafts.length > 1;
  const heads = ['bearing', ...(several ? ['shaft'] : []), 'position', 'x points to', 'housing'];
  if (mounted.length) heads.push('force across', 'force along x', 'largest ball load at the end', 'in the run', 'peak pressure', 'losses', 'friction torque', ...lives.map(([, head]) => head));
  const rows = run.shaft.bearings.map(bearing => {
    const own = run.mounted.get(bearing.name);
    const row = [own ? h('button', { type: 'button', class: 'open', 'aria-label': `Show the bearing ${bearing.name}`, onclick: () => open(own) }, bearing.name) : bearing.name, ...(several ? [bearing.shaft] : []),
      `${digits(bearing.position * 1e3, 5).replace(/\.0*$|(\.\d*?)0+$/, '$1')}\u202fmm`, bearing.direction > 0 ? '+x' : '\u2212x', bearing.housing ?? '\u2013'];
    if (!own) return row;
    const { figures: f, error_bars: e, peak_pressure: pressure } = own.record.summary;
    const force = forceOf(own.record.summary, bearing.direction);
    const most = f['largest inner load'] > f['largest outer load'] ? 'largest inner load' : 'largest outer load';
    return [...row, cell('force', force.across, force.acrossBar), cell('force', force.along, force.alongBar), cell(most, f[most], e?.[most]), withUnit(largestLoad(own), 'load', 'N'), withUnit(pressure, 'pressure', 'Pa'),
      cell('loss.total', f['loss.total'], e?.['loss.total']), cell('friction torque', f['friction torque'], e?.['friction torque']), ...lives.map(([name]) => life(own, name) ?? '\u2013')];
  });
  const energy = name => ['put in', 'to bearings', 'damped', 'balance'].map(what => cell(`${name} ${what}`, figures[`${name} ${what}`], bars?.[`${name} ${what}`]));
  const bodies = [...run.shaft.shafts.map(({ name }) => [name, name]), ...run.shaft.housings.map(housing => [housing.name, `housing ${housing.name}`])];
  return section('machine', several ? 'Shafts and bearings' : 'Shaft and bearings',
    run.record.ended_early ? h('p', { class: 'warning' }, `The run ended early: ${run.record.ended_early}`) : null, (run.record.warnings ?? []).map(text => h('p', { class: 'warning' }, text)),
    table(heads, rows, { numbers: heads.map((_, i) => i).filter(i => heads[i] === 'position' || i > heads.indexOf('housing')) }),
    linksTable(run, several),
    mounted.length ? h('p', { class: 'note' }, 'Forces are those of the bearings on the shaft, in its axes. Forces, losses and torque are means over the second half, or at the end of a run that is too short for means. \u00b1: numerical error, where \u201c--error\u201d measured it.') : null,
    mounted.length ? null : h('p', { class: 'note' }, 'What the bearings do is in the run of this machine by itself: \u201croulement report\u201d of its folder.'),
    lives.length ? h('p', { class: 'note' }, 'Life under the loads of the second half, their damage summed; hours at its mean speed.') : null,
    h('h3', {}, 'Drive and energy'),
    h('dl', { class: 'facts' }, run.shaft.shafts.flatMap(({ name }) => [['speed', 'speed'], ['torque that drives it', 'torque']].map(([word, what]) => [several ? `${name}, ${word}` : word, `${name}.${what}`])).flatMap(([word, name]) => [h('dt', {}, word), h('dd', {}, drive(run, name))])),
    table(['', 'put in', 'to bearings', 'damped', 'balance'], bodies.map(([word, name]) => [word, ...energy(name)]), { numbers: [1, 2, 3, 4] }));
}

/** A figure in a cell, its error bar below. */
function cell(name, value, bar) {
  const [amount, rest] = figure(name, value, bar).split(' \u00b1 ');
  return rest ? [`${amount} ${rest.slice(rest.indexOf(' ') + 1)}`, h('div', { class: 'error' }, `\u00b1 ${rest}`)] : amount;
}

/** Mean and end of the speed or the torque of a shaft. */
function drive(run, name) {
  const { figures, error_bars: bars } = run.record.summary;
  const text = key => (Number.isFinite(figures[key]) ? figure(name, figures[key], bars?.[key]) + (name.endsWith('.speed') ? `, ${rpm(figures[key])}` : '') : null);
  const [mean, end] = [text(name), text(`end ${name}`)];
  return [mean ? `mean ${mean}` : null, end ? `at the end ${end}` : null].filter(Boolean).join('; ');
}
