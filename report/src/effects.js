// Which effects are on, and what the others would matter.

import { h, section, table } from './dom.js';
import { digits } from './units.js';

const GROUPS = [
  ['On, and matters', v => v.standing === 'on' && v.matters, 'good'],
  ['Off, and would matter', v => v.standing === 'off' && v.matters, 'bad'],
  ['Not simulated by any effect yet, and would matter', v => v.standing === 'missing' && v.matters, 'bad'],
  ['On, and does not matter', v => v.standing === 'on' && !v.matters, ''],
  ['Off, and would not matter', v => v.standing === 'off' && !v.matters, ''],
  ['Simulated in every scene', v => v.standing === 'always', ''],
  ['Not simulated by any effect yet', v => v.standing === 'missing' && !v.matters, ''],
];

export function effects(run) {
  const { simulated, estimates = [], why_not: why } = run.record.effects ?? {};
  const value = v => (v.unit === 'rad' ? `${digits((v.value * 180) / Math.PI, 3)}\u00b0` : v.unit ? `${digits(v.value, 3)} ${v.unit}` : `${digits(100 * v.value, 3)} %`);
  const rows = GROUPS.flatMap(([heading, belongs, tone]) => estimates.filter(belongs).map((v, i) =>
    [i === 0 ? h('span', { class: `mark ${tone}` }, heading) : '', v.subject, value(v), h('span', {}, v.sentence, v.standing === 'off' && v.matters && v.write ? h('span', { class: 'write' }, h('br'), v.write) : null)]));
  return section('effects', 'Effects', simulated ? h('p', {}, simulated) : null, why ? h('p', { class: 'warning' }, why) : null,
    rows.length ? table(['', 'effect', 'share', 'what it is'], rows, { numbers: [2], caption: 'Settled states with and without each effect: the largest change of torque, load, life or displacement' }) : null);
}
