// The summary: largest figures as cards, means with error bars and settled marks, of all runs side by side.

import { h, section, table } from './dom.js';
import { digits, rpm, shown } from './units.js';

/** Units of the figures by their names. */
function unitOf(name) {
  // Of a shaft; what its parts are called may be any word.
  if (/ (put in|to bearings|damped|balance)$/.test(name)) return 'J';
  if (/displacement\.[xyz]$/.test(name)) return 'm';
  if (/(tilt|rotation)\.[xyz]$/.test(name)) return 'rad';
  if (/force|load|between balls/.test(name)) return 'N';
  if (/moment|torque/.test(name)) return 'N.m';
  if (/position|eccentricity/.test(name)) return 'm';
  if (/angle/.test(name)) return 'deg';
  if (/power|^loss\./.test(name)) return 'W';
  if (/slip|over /.test(name)) return 'share';
  if (/speed/.test(name)) return 'rad/s';
  return 'J';
}

/** Groups that quantities are told in, and what belongs to them by its name; the first that fits. */
const GROUPS = [['Life', /life|L10|damage|safety/], ['Losses', /power|loss|torque|heat|put in|to bearings|damped|balance|energy/], ['Loads', /force|moment|load|pressure|between balls|over /],
  ['Motion', /./]];
const ORDER = ['Loads', 'Motion', 'Losses', 'Life'];

/** Rows under the heads of their groups: `of` is the quantity of each. */
function grouped(rows, of) {
  const groupOf = name => GROUPS.find(([, words]) => words.test(name))[0];
  return ORDER.flatMap(group => {
    const own = rows.filter((_, i) => groupOf(of[i]) === group);
    return own.length ? [[h('strong', { class: 'group' }, group)], ...own] : [];
  });
}

/** What the run was given, for a reader on paper. */
function inputs(run) {
  const { bearing: of } = run;
  if (!of) return null;
  const millimetres = length => `${digits(length * 1e3, 5)} mm`;
  const span = ({ start, least, most }, show) => (least === most ? show(start) : `${show(start)} at the start, ${show(least)} to ${show(most)}`);
  const units = { x: ['N', 1, 'm'], y: ['N', 1, 'm'], z: ['N', 1, 'm'], ry: ['N\u202fm', 1, 'rad'], rz: ['N\u202fm', 1, 'rad'] };
  const loads = ['inner', 'outer'].flatMap(race => Object.entries(of.loads[race] ?? {}).map(([direction, given]) =>
    [`${given.kind === 'load' ? 'load' : 'motion'} ${direction} of the ${race} race`, span(given, value => `${digits(value, 4)} ${units[direction][given.kind === 'load' ? 0 : 2]}`)]));
  const rows = [['balls', String(of.balls)], ['ball diameter', millimetres(of.ball_diameter)], ['pitch diameter', millimetres(of.pitch_diameter)],
    of.clearance === null ? ['contact angle', `${digits(of.contact_angle * 180 / Math.PI, 4)}\u00b0`] : ['diametral clearance', `${digits(of.clearance * 1e6, 4)} \u00b5m`],
    ['groove radius over ball diameter, inner and outer', `${digits(of.inner.conformity, 4)}, ${digits(of.outer.conformity, 4)}`],
    ['friction coefficient of balls and races', span(of.friction, value => digits(value, 3))], ['creep law', of.creep],
    ...['inner', 'outer'].map(race => [`speed of the ${race} race`, span(of.speeds[race], rpm)]), ...loads, ['simulated time', `${digits(of.duration * 1e3, 4)} ms`]];
  return h('details', { id: 'inputs' }, h('summary', {}, 'What the run was given'), table(['input', 'value'], rows, { caption: `${run.title}: inputs` }));
}

/** A figure with its unit and error bar. */
export function figure(name, value, bar) {
  if (value === undefined || value === null) return '\u2013';
  const unit = unitOf(name);
  const [factor, word] = unit === 'deg' ? [1, '\u00b0'] : unit === 'share' ? [100, '%'] : shown(name, unit, Math.abs(value));
  const error = bar === undefined || bar === null ? '' : ` \u00b1 ${digits(bar * factor, 2)}`;
  return `${digits(value * factor, 5)}${error} ${word}`.trim();
}

const HEADLINES = ['friction torque', 'loss.total', 'largest inner load', 'largest outer load', 'cage speed', 'cage slip'];

const WORDS = { 'loss.total': 'losses' };

export function cards(run) {
  const { figures, error_bars: bars, peak_pressure: pressure } = run.record.summary;
  const card = (name, value, note, good) => h('div', { class: 'card' }, h('div', { class: 'card-name' }, name), h('div', { class: 'card-value' }, value),
    h('div', { class: `card-note ${good === false ? 'bad' : ''}` }, note));
  const list = HEADLINES.filter(name => figures[name] !== undefined && figures[name] !== null).map(name => {
    const note = settledNote(run, name);
    return card(WORDS[name] ?? name, figure(name, figures[name], bars?.[name]), note, !/NOT/.test(note));
  });
  list.push(card('peak pressure', `${digits(pressure * 1e-6, 4)} MPa`, 'largest in the run'));
  return h('div', { class: 'cards' }, list);
}

/** Is a figure a mean, and has it settled? */
export function settledNote(run, name) {
  const state = run.record.summary.means?.quantities.find(mean => mean.quantity === name)?.settled;
  return state === undefined ? 'at the end' : state === null ? 'mean; too few rows to tell' : state ? 'mean, settled' : 'mean, NOT settled';
}

/** How well a mean is known. */
function mark(mean) {
  if (mean.settled === null || mean.settled === undefined) return h('span', { class: 'mark' }, 'unknown');
  return mean.settled ? h('span', { class: 'mark good' }, '\u2713 settled') : h('span', { class: 'mark bad' }, '\u2717 drifts');
}

/** Life in the words of a table. */
function lifeOf(life) {
  if (!life) return '\u2013';
  const hours = life.L10r_hours === null ? '' : ` (${digits(life.L10r_hours, 4)} h)`;
  return `${digits(life.L10r, 4)} million revolutions${hours}`;
}

/** Phases of a run: a row for each. */
function phases(run) {
  const all = run.record.summary.phases ?? [];
  if (!all.length) return null;
  const of = (phase, name) => phase.quantities.find(mean => mean.quantity === name);
  const mean = (phase, name) => { const own = of(phase, name); return own ? figure(name, own.mean, own.error) : '\u2013'; };
  const span = (phase, name) => { const own = of(phase, name); return own ? `${figure(name, own.least)} to ${figure(name, own.largest)}` : '\u2013'; };
  const state = phase => (phase.script_changes ? h('span', { class: 'mark bad' }, '\u2717 script changes') : mark(phase));
  const names = run.shaft ? run.shaft.shafts.flatMap(({ name }) => [`${name}.speed`, `${name}.torque`]) : ['friction power', 'friction torque', 'cage slip'];
  const shownNames = names.filter(name => all.some(phase => of(phase, name)));
  const rows = all.map(phase => [phase.name, `${digits(phase.window[0] * 1e3, 5)} to ${digits(phase.window[1] * 1e3, 5)} ms`,
    ...shownNames.flatMap(name => [mean(phase, name), span(phase, name)]), ...(run.shaft ? [] : [`${digits(phase.heat, 4)} J`, lifeOf(phase.life)]), state(phase)]);
  const heads = ['phase', 'window', ...shownNames.flatMap(name => [`mean ${name}`, 'least to largest']), ...(run.shaft ? [] : ['heat of friction', 'life L10r']), ''];
  return table(heads, rows, { caption: `${run.title}: phases` });
}

/** Life over the duty of a machine: its bearings under all loads, then under each. */
function duty(run) {
  const all = run.record.duty;
  if (!all) return [];
  const number = value => (value === null || value === undefined ? '\u2013' : digits(value, 4));
  const numbers = of => [of.L10r_hours, of.modified_hours, of.static_safety, of.loss, of.damage].map(number);
  const name = bearing => bearing || 'bearing';
  const row = (bearing, of) => [name(bearing), of.speed === undefined ? '\u2013' : rpm(of.speed), number(of.equivalent_load), ...numbers(of)];
  const rows = of => [...Object.entries(of.bearings).map(([bearing, own]) => row(bearing, own)), ...(of.machine ? [row('machine', of.machine)] : [])];
  const worst = Object.values(all.bearings).map(own => (own.worst ? `${own.worst.load} takes ${digits(100 * own.worst.taken, 2)}\u202f%` : '\u2013'));
  const heads = ['', 'speed', 'equivalent load [N]', 'L10r [h]', 'modified [h]', 'static safety', 'losses [W]', 'damage'];
  const hours = all.hours === null ? '' : ` over ${Number(all.hours.toPrecision(6))} h`;
  const whole = rows(all).map((cells, i) => [...cells, worst[i] ?? '']);
  return [table([...heads, 'worst load'], whole, { numbers: [1, 2, 3, 4, 5, 6, 7], caption: `${run.title}: duty of ${all.loads.length} loads${hours}, added up by Miner\u2019s rule` }),
    h('details', {}, h('summary', {}, 'Each load of the duty'), table(['load', 'share', ...heads],
      all.loads.flatMap(load => rows(load).map(cells => [load.name, `${digits(100 * load.share, 3)}\u202f%`, ...cells])),
      { numbers: [1, 3, 4, 5, 6, 7, 8, 9], caption: `${run.title}: loads of the duty` }))];
}

export function summary(runs) {
  return section('summary', 'Summary', runs.length > 1 ? sideBySide(runs) : null, runs.map(of), errorNote(runs));
}

function of(run) {
  const { means, warning } = run.record.summary;
  const parts = [];
  // That of a shaft stands above its table.
  if (run.record.ended_early && !run.shaft) parts.push(h('p', { class: 'warning' }, `The run ended early: ${run.record.ended_early}`));
  if (!run.shaft) parts.push(...(run.record.warnings ?? []).map(text => h('p', { class: 'warning' }, text)));
  if (warning) parts.push(h('p', { class: 'warning' }, warning));
  if (run.record.summary.losses) parts.push(...losses(run));
  if (means) {
    const rows = means.quantities.map(mean => {
      const factorOf = mean.unit === '1' ? [100, '%'] : shown(mean.quantity, mean.unit, Math.abs(mean.mean));
      const show = (value, count) => (value === null || value === undefined ? '\u2013' : digits(value * factorOf[0], count));
      return [mean.quantity, show(mean.mean, 6), factorOf[1], show(mean.interval_95, 2), show(mean.error, 2), show(mean.drift, 2), mark(mean)];
    });
    const [begin, end] = means.window;
    const all = table(['mean of', 'value', 'unit', '\u00b1 95 %', 'numerical error', 'drift', ''], grouped(rows, means.quantities.map(mean => mean.quantity)),
      { numbers: [1, 3, 4, 5], caption: `${run.title}: means over ${digits(begin * 1e3, 4)} to ${digits(end * 1e3, 4)} ms` });
    // A shaft has some for each of its places.
    const drift = means.quantities.filter(mean => mean.settled === false).length;
    parts.push(run.shaft ? h('details', { open: rows.length <= 24 }, h('summary', {}, `Means of all ${rows.length} quantities; ${drift || 'none'} of them ${drift === 1 ? 'drifts' : 'drift'}`), all) : all);
    if (means.settled === false) {
      parts.push(h('p', { class: 'warning' }, means.needed_duration ? `Not all means have settled: a duration of about ${digits(means.needed_duration * 1e3, 3)} ms would do.` : 'Not all means have settled, and no decay is to be seen.'));
    }
  }
  const inPhases = phases(run);
  if (inPhases) parts.push(inPhases);
  parts.push(...duty(run));
  const given = inputs(run);
  if (given) parts.push(given);
  parts.push(h('details', {}, h('summary', {}, 'The summary in words'), h('pre', { tabindex: 0 }, run.record.summary_text ?? '')));
  return parts;
}

/** All losses by part, and what brings them; of a machine, what brings those of all its bearings. */
function losses(run) {
  const { losses: of, error_bars: bars, figures } = run.record.summary;
  const watts = (name, value) => figure(name, value, bars?.[name]);
  const rows = [['all losses', watts('loss.total', figures['loss.total']), '100\u202f%'],
    ...(of.parts ?? []).map(part => [part.words, watts(part.name, part.power), `${digits(100 * part.share, 3)}\u202f%`])];
  const brought = [['torque times speed', of.torque_times_speed], ['other work', of.other_work], ['into motion and springs', of.stored], ['left open', of.left_open]];
  return [table(['losses', 'mean power', 'share'], rows, { numbers: [1, 2], caption: `${run.title}: what is lost` }),
    h('p', { class: 'note' }, `Brought over the same time: ${brought.map(([word, value]) => `${word} ${figure('power', value)}`).join(', ')}.`)];
}

/** Figures of all runs. */
function sideBySide(runs) {
  const names = [...new Set(runs.flatMap(run => Object.keys(run.record.summary.figures)))];
  const rows = names.map(name => [name, ...runs.map(run => figure(name, run.record.summary.figures[name], run.record.summary.error_bars?.[name]))]);
  const all = table(['figure', ...runs.map(run => run.name || run.title)], grouped(rows, names), { numbers: runs.map((_, i) => i + 1), caption: 'All runs side by side' });
  return runs[0].shaft ? h('details', {}, h('summary', {}, `All ${rows.length} figures side by side`), all) : all;
}

function errorNote(runs) {
  const lines = runs.filter(run => !run.record.summary.error_bars).map(run =>
    `${runs.length > 1 ? `${run.name}: ` : ''}numerical error not measured; \u201croulement run --error\u201d measures it.`);
  return lines.map(line => h('p', { class: 'note' }, line));
}
