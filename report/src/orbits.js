// Paths of the shaft's centre at its bearings in the second half of the run.

import { s, h, section, choice } from './dom.js';
import { clock } from './clock.js';
import { short } from './drawing.js';
import { round } from './polar.js';
import { digits } from './units.js';

const SIZE = 300, C = SIZE / 2, R = 112;
/** Room for words on the left, and none above. */
const BOX = `-34 28 ${SIZE + 14} ${SIZE - 30}`;
/** [-] points of a path at most. */
const MOST = 4000;

export function orbits(run) {
  const paths = run.shaft.bearings.map(bearing => pathOf(run, bearing));
  const holder = h('div', { class: 'orbits' });
  const widest = Math.max(...paths.map(path => path.reach));
  const marks = [];
  const show = scale => {
    marks.length = 0;
    holder.replaceChildren(...paths.map(path => picture(path, round(Math.max(scale === 'same' ? widest : path.reach, 1e-13) * 1e6), marks)));
    follow(run, marks);
  };
  show('same');
  clock.follow(() => { if (holder.isConnected) follow(run, marks); });
  return section('orbits', run.shaft.shafts.length > 1 ? 'Paths of the shafts at their bearings' : 'Paths of the shaft at its bearings',
    h('p', { class: 'note' }, 'Second half of the run, about the mean there, seen from +x; the dot is at the time of the cursor.'),
    paths.length > 1 ? choice('Scale of the paths', [['same', 'same scale'], ['own', 'each its own']], 'same', show) : null, holder);
}

function pathOf(run, { name, shaft }) {
  const [y, z] = ['y', 'z'].map(axis => run.get(`${shaft}.${name}.${axis}`));
  const [my, mz] = [y, z].map(series => run.mean(series.name));
  const from = Math.max(y.t.findIndex(t => t >= run.begin + 0.5 * (run.end - run.begin)), 0);
  let reach = 0;
  for (let i = from; i < y.t.length; i++) reach = Math.max(reach, Math.abs(y.v[i] - my), Math.abs(z.v[i] - mz));
  return { name, y, z, my, mz, from, reach };
}

/** The path within a square of +-`top` micrometres; in nanometres where it is small. */
function picture({ name, y, z, my, mz, from }, top, marks) {
  const point = (a, b) => [C + ((a - my) * 1e6 * R) / top, C - ((b - mz) * 1e6 * R) / top];
  const [factor, unit] = top < 0.1 ? [1e3, 'nm'] : [1, '\u00b5m'];
  const tick = k => short(k * top * factor, 3);
  const stride = Math.ceil((y.t.length - from) / MOST);
  const points = [];
  for (let i = from; i < y.t.length; i += stride) points.push(point(y.v[i], z.v[i]).map(v => v.toFixed(2)).join(' '));
  const dot = s('circle', { r: 4.5, class: 'polar-dot race-1' });
  marks.push({ columns: [y.name, z.name], dot, point });
  const svg = s('svg', { viewBox: BOX, class: 'polar', role: 'img', 'aria-label': `Path of the shaft at ${name}` });
  for (const k of [-1, -0.5, 0, 0.5, 1]) {
    const at = C + k * R;
    svg.append(s('line', { x1: at, x2: at, y1: C - R, y2: C + R, class: 'grid' }), s('line', { x1: C - R, x2: C + R, y1: at, y2: at, class: 'grid' }));
    if (k && Math.abs(k) === 1) svg.append(s('text', { x: at, y: C + R + 16, class: 'tick', 'text-anchor': 'middle' }, tick(k)), s('text', { x: C - R - 5, y: C - k * R + 4, class: 'tick', 'text-anchor': 'end' }, tick(k)));
  }
  svg.append(s('text', { x: C, y: C + R + 30, class: 'tick', 'text-anchor': 'middle' }, `y [${unit}]`), s('text', { x: C - R - 6, y: C + 4, class: 'tick', 'text-anchor': 'end' }, `z [${unit}]`),
    s('path', { class: 'orbit race-0', d: `M${points.join('L')}` }), dot);
  return h('figure', {}, svg, h('figcaption', {}, h('b', {}, name), `: mean y ${digits(my * 1e6, 4)}\u202f\u00b5m, z ${digits(mz * 1e6, 4)}\u202f\u00b5m`));
}

function follow(run, marks) {
  const later = clock.time >= run.begin + 0.5 * (run.end - run.begin);
  for (const { columns, dot, point } of marks) {
    dot.style.display = later ? '' : 'none';
    const [x, y] = point(...columns.map(name => run.at(name, clock.time)));
    dot.setAttribute('cx', x.toFixed(2));
    dot.setAttribute('cy', y.toFixed(2));
  }
}
