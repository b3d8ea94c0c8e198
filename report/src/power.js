// Where the power goes.

import { h, s, section } from './dom.js';
import { colour, onTheme } from './theme.js';
import { digits, withUnit } from './units.js';

/** Parts of the power, means over the second half. Sliding is what is left of the friction of a race. */
function parts(run) {
  const mean = name => run.mean(name) || 0;
  const list = [];
  for (const race of ['inner', 'outer']) {
    const [friction, spin, groove, film, hysteresis] = ['friction', 'spin', 'groove', 'film', 'hysteresis'].map(part => mean(`power.${race}.${part}`));
    list.push([`${race}: spin`, spin], [`${race}: slip of bent grooves`, groove], [`${race}: rolling in oil`, film], [`${race}: hysteresis`, hysteresis],
      [`${race}: creepage`, friction - spin - groove - film - hysteresis]);
  }
  list.push(['cage pockets', mean('power.pockets')], ['cage lands', mean('power.lands')], ['balls on balls', mean('power.neighbours')], ['drag of the medium', mean('power.drag')], ['damping of contacts', mean('power.damping')]);
  const largest = Math.max(...list.map(part => Math.abs(part[1])), 1e-300);
  return list.filter(part => Math.abs(part[1]) > 1e-4 * largest);
}

export function power(runs) {
  const blocks = runs.map(run => {
    const list = parts(run);
    const sum = list.reduce((total, part) => total + part[1], 0);
    const largest = Math.max(...list.map(part => Math.abs(part[1])));
    const rows = list.map(([name, value]) => h('tr', {}, h('th', { scope: 'row' }, name),
      h('td', { class: 'bar-cell' }, h('div', { class: `bar ${name.startsWith('inner') ? 'inner' : name.startsWith('outer') ? 'outer' : 'rest'}`, style: `width:${(100 * Math.abs(value)) / largest}%` })),
      h('td', { class: 'num' }, withUnit(value, 'power', 'W')), h('td', { class: 'num' }, `${digits((100 * value) / sum, 3)}\u202f%`)));
    return h('div', {}, h('table', { class: 'bars' }, h('caption', {}, `${runs.length > 1 ? `${run.name}: ` : ''}${withUnit(sum, 'power', 'W')} in all, mean over the second half`), h('tbody', {}, rows)));
  });
  return section('power', 'Where the power goes', h('div', { class: runs.length > 1 ? 'pair' : '' }, blocks),
    h('p', { class: 'note' }, 'Creepage is what is left of the friction of a race. Shares of the mean; negative ones give back what another part of the same contact takes.'));
}
