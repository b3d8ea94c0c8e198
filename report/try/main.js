// A bearing by its name or dimensions, answered in the browser by the program itself.

import { h, s, section, table } from '../src/dom.js';
import { startTheme, toggleTheme } from '../src/theme.js';
import { digits } from '../src/units.js';
import { Program } from './program.js';
import { FIELDS, fromHash, toHash, bearingOf, sceneOf } from './scene.js';

const program = new Program(document.getElementById('program'), document.getElementById('worker'));
const values = fromHash(location.hash);
const places = Object.fromEntries(['words', 'loads', 'contacts', 'losses', 'effects', 'scene', 'run', 'trouble'].map(name => [name, h('div', { id: `${name}-place` })]));

function controls() {
  const field = ({ key, label, unit, from, to, step, texts, when }) => {
    const change = value => { values[key] = value; location.replace(toHash(values)); refresh(); };
    const name = `${label}${unit ? ` [${unit}]` : ''}`;
    if (texts) {
      const box = h('select', { onchange: () => change(box.value) }, texts.map(([value, text]) => h('option', { value, selected: value === values[key] }, text)));
      return h('label', { class: 'field', 'data-when': when }, h('span', {}, name), box);
    }
    if (from === undefined) {
      const box = h('input', { type: 'search', value: values[key], placeholder: unit ?? '', 'aria-label': name, oninput: () => change(box.value) });
      return h('label', { class: 'field', 'data-when': when }, h('span', {}, name), box);
    }
    const number = h('input', { type: 'number', value: values[key], step: 'any', 'aria-label': name, oninput: () => { slider.value = number.value; change(number.value); } });
    const slider = h('input', { type: 'range', min: from, max: to, step, value: values[key], 'aria-label': `${name}, slider`, oninput: () => { number.value = slider.value; change(slider.value); } });
    return h('label', { class: 'field', 'data-when': when }, h('span', {}, name), number, slider);
  };
  return FIELDS.map(field);
}

/** An angle in degrees; what is rounding of none is 0. */
const degrees = angle => digits(Math.abs(angle) < 1e-8 ? 0 : (angle * 180) / Math.PI, 4);
const mm = value => `${digits(value * 1e3, 4)}\u202fmm`;

/** Loads of all balls over their azimuth, seen from +x. */
function polar({ azimuth, inner_load: loads }) {
  const most = Math.max(...loads), C = 170, R = 130;
  const at = (angle, radius) => [C + radius * Math.cos(angle), C - radius * Math.sin(angle)].map(v => v.toFixed(1));
  const svg = s('svg', { viewBox: '0 0 340 340', class: 'polar', role: 'img', 'aria-label': 'Loads of all balls over azimuth' });
  for (const part of [0.5, 1]) svg.append(s('circle', { cx: C, cy: C, r: R * part, class: 'grid' }), s('text', { x: C + 4, y: C - R * part - 4, class: 'tick' }, `${digits(most * part, 3)} N`));
  svg.append(s('text', { x: C + R + 8, y: C + 4, class: 'tick' }, '+y'), s('text', { x: C - 6, y: C - R - 18, class: 'tick' }, '+z'));
  azimuth.forEach((angle, i) => {
    const [x, y] = at(angle, most > 0 ? (R * loads[i]) / most : 0);
    svg.append(s('line', { x1: C, y1: C, x2: x, y2: y, class: 'load' }), s('circle', { cx: x, cy: y, r: 5, class: 'ball' }));
  });
  return h('figure', {}, svg, h('figcaption', {}, 'Load of each ball on the inner race over its azimuth, seen from +x'));
}

/** Cells of the last row of a table by their columns without units. */
function lastRow(text) {
  const [head, ...rows] = text.trim().split('\n').map(line => line.split(','));
  return Object.fromEntries(head.map((name, i) => [name.split(' [')[0], Number(rows.at(-1)[i])]));
}

function contacts(row, balls) {
  const of = race => {
    const most = Array.from({ length: balls }, (_, i) => i + 1).reduce((one, ball) => (row[`ball[${ball}].${race}.load`] > row[`ball[${one}].${race}.load`] ? ball : one), 1);
    const get = name => row[`ball[${most}].${race}.${name}`];
    return [race, String(most), `${digits(get('load'), 5)} N`, `${degrees(get('contact_angle'))}\u00b0`, mm(2 * get('semi_axis_transverse')), mm(2 * get('semi_axis_rolling')), `${digits(get('peak_pressure') * 1e-6, 4)} MPa`, ...(get('film_ratio') === undefined ? [] : [digits(get('film_ratio'), 3)])];
  };
  const rows = ['inner', 'outer'].map(of);
  return table(['race', 'ball', 'load', 'contact angle', 'ellipse across', 'along', 'peak pressure', ...(rows[0].length > 7 ? ['film / roughness'] : [])], rows, { numbers: [1, 2, 3, 4, 5, 6, 7], caption: 'The most loaded contact of each race' });
}

function losses(row) {
  const names = { 'loss.sliding': 'sliding and spin of balls', 'loss.rolling': 'rolling resistance of the oil', 'loss.hysteresis': 'hysteresis', 'loss.drag': 'drag of the medium', 'loss.cage': 'cage', 'loss.damping': 'damping of contacts' };
  const power = Object.entries(names).filter(([name]) => row[name] > 0).map(([name, words]) => [words, `${digits(row[name], 4)} W`, `${digits((100 * row[name]) / row['loss.total'], 3)} %`]);
  const lines = [['cage', 'frequency.ftf'], ['balls over a place of the outer race, BPFO', 'frequency.bpfo'], ['balls over a place of the inner race, BPFI', 'frequency.bpfi'], ['turns of a ball, BSF', 'frequency.bsf']].filter(([, name]) => name in row).map(([words, name]) => [words, `${digits(Math.abs(row[name]), 5)} Hz`]);
  return [power.length ? table(['losses at the start of a run', 'power', 'share'], power, { numbers: [1, 2] }) : null, lines.length ? table(['frequencies', 'Hz'], lines, { numbers: [1] }) : null].filter(Boolean);
}

let wanted = 0;

/** All answers to the present inputs; those to former ones are dropped. */
async function refresh() {
  const mine = ++wanted;
  const is = () => mine === wanted;
  document.body.dataset.state = 'working';
  for (const label of document.querySelectorAll('[data-when]')) label.hidden = (values.by === 'size') !== (label.dataset.when === 'size');
  // While a slider moves, its last place counts.
  await new Promise(done => setTimeout(done, 60));
  if (!is()) return;
  const fail = said => { if (is()) { places.trouble.replaceChildren(h('pre', { class: 'warning', id: 'error' }, said)); document.body.dataset.state = 'refused'; } };
  const bearing = await program.run(['bearing', ...bearingOf(values), '-o', 'bearing.toml']);
  if (!is()) return;
  if (bearing.code) return fail(bearing.said);
  const text = sceneOf(bearing.files['bearing.toml'], values);
  places.scene.replaceChildren(h('pre', { id: 'scene-text' }, text));
  const found = await program.run(['equilibrium', 'scene.toml'], { 'scene.toml': text });
  if (!is()) return;
  if (found.code) return fail(found.said);
  places.trouble.replaceChildren(...(found.said ? [h('pre', {}, found.said)] : []));
  places.words.replaceChildren(h('pre', { id: 'equilibrium-text' }, found.out));
  const [numbers, started] = [JSON.parse((await program.run(['equilibrium', 'scene.toml', '--json'], { 'scene.toml': text })).out), await program.run(['run', 'scene.toml', '-o', 'out'], { 'scene.toml': sceneOf(bearing.files['bearing.toml'], values, 10e-6) })];
  if (!is()) return;
  places.loads.replaceChildren(polar(numbers.balls));
  const row = started.files['out/results.csv'] && !started.code ? lastRow(started.files['out/results.csv']) : null;
  places.contacts.replaceChildren(row ? contacts(row, numbers.balls.azimuth.length) : h('pre', { class: 'warning' }, started.said));
  places.losses.replaceChildren(...(row ? losses(row) : []));
  const effects = await program.run(['effects', 'scene.toml'], { 'scene.toml': text });
  if (!is()) return;
  places.effects.replaceChildren(h('pre', { id: 'effects-text' }, effects.code ? effects.said : effects.out));
  document.body.dataset.state = 'done';
}

/** Runs the scene, and shows its report. */
async function simulate(button) {
  button.disabled = true;
  places.run.replaceChildren(h('p', { class: 'note' }, 'The run goes on \u2026'));
  const text = document.getElementById('scene-text').textContent.replace(/^duration = .*/m, `duration = "${Number(document.getElementById('milliseconds').value)} ms"`);
  const ran = await program.run(['run', 'scene.toml', '-o', 'out'], { 'scene.toml': text });
  const report = ran.code ? ran : await program.run(['report', 'out', '-o', 'page.html'], ran.files);
  button.disabled = false;
  if (report.code) { places.run.replaceChildren(h('pre', { class: 'warning' }, report.said)); return; }
  // The program here has no program of the report's page: it lies in this page.
  const page = report.files['page.html'].replace('id="bundle"></script>', `id="bundle">${document.getElementById('report-bundle').textContent}</script>`);
  places.run.replaceChildren(h('iframe', { title: 'Report of the run', srcdoc: page }));
}

async function start() {
  startTheme();
  const run = h('button', { type: 'button', id: 'simulate', onclick: () => simulate(run) }, 'Simulate');
  document.getElementById('try').replaceChildren(
    h('header', {}, h('div', {}, h('h1', {}, 'A ball bearing, at once'), h('p', {}, 'Answers by the program itself, in this browser: nothing is sent anywhere. The link of this page holds the inputs.')), h('button', { type: 'button', onclick: toggleTheme }, 'Light or dark')),
    h('main', { id: 'main' },
      section('inputs', 'Inputs', h('div', { class: 'inputs' }, controls()), places.trouble),
      section('balance', 'In balance', h('div', { class: 'pair' }, places.loads, places.words)),
      section('contact', 'Contacts, losses, frequencies', places.contacts, h('div', { class: 'pair' }, places.losses)),
      section('effects', 'Which effects matter', places.effects),
      section('run', 'A run', h('div', { class: 'row' }, h('label', { class: 'field' }, h('span', {}, 'simulated time [ms]'), h('input', { type: 'number', id: 'milliseconds', value: '2', min: '0.1', max: '50', step: 'any' })), run), places.run),
      section('scene', 'The scene, to take along', h('p', { class: 'note' }, 'Keep it as scene.toml: `roulement run scene.toml`, or `roulement fmu scene.toml -o bearing.fmu` for a co-simulation.'), places.scene)));
  document.body.dataset.state = 'loading';
  await program.ready;
  await refresh();
}

start().catch(why => { document.getElementById('try').textContent = `This browser cannot run the program: ${why}`; });
