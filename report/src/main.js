// The page: reads its data and puts its parts together.

import { h, choice } from './dom.js';
import { Run } from './data.js';
import { clock } from './clock.js';
import { startTheme, toggleTheme } from './theme.js';
import { drawing } from './drawing.js';
import { cards, summary } from './summary.js';
import { assemble, likes, words as machineWords, machineSection, cards as machineCards } from './machine.js';
import { shaftDrawing } from './shaft.js';
import { orbits } from './orbits.js';
import { polar } from './polar.js';
import { drawAll, plotsSection, startPlots, setZoom } from './plots.js';
import { spectra } from './spectra.js';
import { vibration } from './vibration.js';
import { power } from './power.js';
import { contacts } from './contact.js';
import { effects } from './effects.js';
import { cost, addSteps } from './cost.js';
import { playback } from './playback.js';
import { sweepSection, readSweep } from './sweep.js';
import { transport } from './transport.js';
import { digits, rpm, withUnit } from './units.js';

async function start() {
  startTheme();
  const data = JSON.parse(document.getElementById('data').textContent);
  const runs = [];
  for (const record of data.runs) runs.push(await Run.of(record, runs.length));
  runs.forEach(addSteps);
  assemble(runs);
  const sweeps = [];
  for (const sweep of data.sweeps) sweeps.push(await readSweep(sweep));
  const root = document.getElementById('report');
  const body = h('main', { id: 'main' });
  const contents = h('nav', { 'aria-label': 'Contents', class: 'contents' });
  root.replaceChildren(h('a', { class: 'skip', href: '#main' }, 'To the results'), head(runs, sweeps, run => show(run)), contents, body);
  // Pressing its button keeps the choice of runs right.
  const open = run => { root.querySelectorAll('header .choice button')[runs.indexOf(run)].click(); scrollTo({ top: 0 }); };
  // Each run's parts are made once: a part that stays keeps what was chosen in it.
  const made = new Map();
  const bottom = licences();
  const show = (run, beside = run && likes(run, runs)) => {
    if (run) {
      const [begin, end] = [Math.min(...beside.map(other => other.begin)), Math.max(...beside.map(other => other.end))];
      if (!made.size || begin !== clock.begin || end !== clock.end) {
        clock.span(begin, end);
        // Where all balls have found their way.
        clock.seek(begin + 0.5 * (end - begin));
        setZoom(null);
      }
      if (!made.size) {
        root.append(transport());
        startPlots();
      }
      if (!made.has(run)) made.set(run, partsOf(run, beside, open));
    }
    body.replaceChildren(...sweepParts, ...(made.get(run) ?? []), bottom);
    contents.replaceChildren(...[...body.querySelectorAll('section')].map(part => h('a', { href: `#${part.id}` }, part.querySelector('h2').textContent)));
  };
  // A case whose whole run was kept is shown by itself.
  const sweepParts = sweeps.map((sweep, i) => sweepSection(sweep, i, run => (run ? show(run, [run]) : show(runs[0]))));
  show(runs[0]);
  openOnPaper();
  // For tests: what is there, and that it is.
  window.roulement = { runs, sweeps, clock, setZoom, ready: true };
}

/** All that is shown of a run; figures and curves stand beside those of others, and `open` shows one of the bearings of a machine. */
function partsOf(run, beside, open) {
  const [figures, before, after] = run.shaft
    ? [machineCards(run), [shaftDrawing(run, open), machineSection(run, open)], [orbits(run), spectra(run), vibration(run)]]
    : [cards(run), [drawing(run), playback(run), polar(run)], [spectra(run), vibration(run), power(beside), contacts(run), effects(run)]];
  return [h('div', { id: 'cards' }, figures), ...before, summary(beside), plotsSection(beside, run), ...after, cost(beside), sceneText(run)].filter(Boolean);
}

function head(runs, sweeps, show) {
  // Bearings are parts of their machines.
  const title = [...runs.filter(run => !run.of), ...sweeps].map(part => part.title || part.name || 'sweep').join(' \u00b7 ');
  const run = runs[0];
  const words = run?.shaft ? [...machineWords(run), `${withUnit(run.end - run.begin, 'time', 's')} simulated`].join(' \u00b7 ') : run ? [`${run.bearing.balls} balls of ${digits(run.bearing.ball_diameter * 1e3, 4)} mm on ${digits(run.bearing.pitch_diameter * 1e3, 4)} mm`, run.bearing.clearance === null ? `${digits((run.bearing.contact_angle * 180) / Math.PI, 4)}\u00b0` : `${digits(run.bearing.clearance * 1e6, 3)} \u00b5m clearance`,
    `inner ${rpm(run.bearing.speeds.inner.most)}`, `${withUnit(run.end - run.begin, 'time', 's')} simulated`].join(' \u00b7 ') : `${sweeps.reduce((sum, sweep) => sum + sweep.count, 0)} cases`;
  return h('header', {}, h('div', {}, h('h1', {}, title), h('p', {}, words)),
    h('div', { class: 'row' }, runs.length > 1 ? choice('Run that is shown', runs.map((other, i) => [i, other.name || `run ${i + 1}`]), 0, i => show(runs[i])) : null,
      h('button', { type: 'button', id: 'print', onclick: () => print() }, 'Print'),
      h('button', { type: 'button', id: 'theme', onclick: toggleTheme, 'aria-label': 'Dark or light' }, '\u25d0')));
}

function sceneText(run) {
  return h('section', { id: 'scene', 'aria-labelledby': 'scene-title' }, h('h2', { id: 'scene-title' }, 'Scene file'),
    h('details', {}, h('summary', {}, 'The text that was simulated'), h('pre', { tabindex: 0 }, run.record.scene)));
}

/** On paper all that is folded stands open, but for licences; afterwards it is as it was. */
function openOnPaper() {
  let opened = [];
  addEventListener('beforeprint', () => {
    opened = [...document.querySelectorAll('details:not([open]):not(.licences)')];
    opened.forEach(part => { part.open = true; });
    drawAll();
  });
  addEventListener('afterprint', () => opened.forEach(part => { part.open = false; }));
}

/** Texts of what the page is made with (LICENCES is put in by the build). */
function licences() {
  return h('details', { class: 'licences' }, h('summary', {}, 'Made by roulement with three.js and uPlot; their licences'), h('pre', { tabindex: 0 }, LICENCES));
}

start().catch(why => {
  document.getElementById('report').append(h('p', { class: 'warning' }, `The report cannot be shown: ${why.stack ?? why}`));
  throw why;
});
