// What the run cost, and its steps.

import { h, section, table } from './dom.js';
import { digits } from './units.js';

export function cost(runs) {
  const simulated = run => run.end - run.begin;
  // Records of former programs do not count the steps of shafts.
  const counted = (key, show = String) => run => (run.record.cost[key] === undefined ? '\u2013' : show(run.record.cost[key], run));
  const rows = [
    ['simulated time', run => `${digits(simulated(run) * 1e3, 5)} ms`],
    ['CPU time', run => `${digits(run.record.cost.cpu, 3)} s`],
    ['CPU time per simulated second', run => `${digits(run.record.cost.cpu / simulated(run), 3)} s/s`],
    ['wall time', run => `${digits(run.record.cost.wall, 3)} s`],
    ['steps', counted('steps')],
    ['mean step', counted('steps', (steps, run) => `${digits((simulated(run) / steps) * 1e6, 4)} \u00b5s`)],
    ['steps rejected by their error', counted('rejected_by_error')],
    ['steps rejected by Newton\u2019s method', counted('rejected_by_newton')],
    ['Newton iterations a step', counted('newton_iterations', (iterations, run) => digits(iterations / run.record.cost.steps, 3))],
    ['factorisations', counted('factorisations')],
    ['contacts, values', counted('contact_values')],
    ['contacts, derivatives', counted('contact_tangents')],
    ['rows of the table', run => String(run.record.table_rows ?? '\u2013')],
    ['program', run => run.record.program],
  ];
  const known = rows.map(([name, get]) => [name, ...runs.map(get)]).filter(row => row.slice(1).some(text => text !== '\u2013'));
  return section('cost', 'Cost and steps', table(['', ...runs.map(run => run.name || 'run')], known, { numbers: runs.map((_, i) => i + 1) }));
}

/** Columns that are made of others: the mean step between rows, [s]. */
export function addSteps(run) {
  const steps = run.get('integrator.steps');
  if (!steps || steps.t.length < 2) return;
  const v = Float64Array.from(steps.v, (n, i) => { const k = Math.max(i, 1); const made = steps.v[k] - steps.v[k - 1]; return made > 0 ? (steps.t[k] - steps.t[k - 1]) / made : NaN; });
  run.series.set('integrator.mean_step', { name: 'integrator.mean_step', unit: 's', t: steps.t, v });
}
