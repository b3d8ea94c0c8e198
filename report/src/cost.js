// What the run cost, and its steps.

import { h, section, table } from './dom.js';
import { digits } from './units.js';

export function cost(runs) {
  const simulated = run => run.end - run.begin;
  const rows = [
    ['simulated time', run => `${digits(simulated(run) * 1e3, 5)} ms`],
    ['CPU time', run => `${digits(run.record.cost.cpu, 3)} s`],
    ['CPU time per simulated second', run => `${digits(run.record.cost.cpu / simulated(run), 3)} s/s`],
    ['wall time', run => `${digits(run.record.cost.wall, 3)} s`],
    ['steps', run => String(run.record.cost.steps)],
    ['mean step', run => `${digits((simulated(run) / run.record.cost.steps) * 1e6, 4)} \u00b5s`],
    ['steps rejected by their error', run => String(run.record.cost.rejected_by_error)],
    ['steps rejected by Newton\u2019s method', run => String(run.record.cost.rejected_by_newton)],
    ['Newton iterations a step', run => digits(run.record.cost.newton_iterations / run.record.cost.steps, 3)],
    ['factorisations', run => String(run.record.cost.factorisations)],
    ['contacts, values', run => String(run.record.cost.contact_values)],
    ['contacts, derivatives', run => String(run.record.cost.contact_tangents)],
    ['rows of the table', run => String(run.record.table_rows ?? '\u2013')],
    ['program', run => run.record.program],
  ];
  // Steps are counted in the runs of the bearings.
  const known = rows.map(([name, get]) => [name, ...runs.map(run => (run.shaft && /step|factor|contacts/.test(name) ? '\u2013' : get(run)))]).filter(row => row.slice(1).some(text => text !== '\u2013'));
  return section('cost', runs[0].shaft ? 'Cost' : 'Cost and steps', table(['', ...runs.map(run => run.name || 'run')], known, { numbers: runs.map((_, i) => i + 1) }));
}

/** Columns that are made of others: the mean step between rows, [s]. */
export function addSteps(run) {
  const steps = run.get('integrator.steps');
  if (!steps || steps.t.length < 2) return;
  const v = Float64Array.from(steps.v, (n, i) => { const k = Math.max(i, 1); const made = steps.v[k] - steps.v[k - 1]; return made > 0 ? (steps.t[k] - steps.t[k - 1]) / made : NaN; });
  run.series.set('integrator.mean_step', { name: 'integrator.mean_step', unit: 's', t: steps.t, v });
}
