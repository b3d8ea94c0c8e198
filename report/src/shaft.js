// The shaft from the side: what is on it, the bearings in their places, housings on their feet.

import { s, h, section } from './dom.js';
import { arrowTo, marker, millimetres, short } from './drawing.js';
import { meshesFigure } from './gears.js';
import { kindOf, linkIn, linksIn } from './links.js';
import { shaftsOf } from './machine.js';
import { ringSections, groovePoint } from './shape.js';
import { digits, rpm } from './units.js';

const WIDTH = 1180, SIDE = 66, ROW = 22, LETTER = 7.4;
/** More rows of labels than this are written aslant in one. */
const ROWS = 4;
/** [px] height of what is drawn, between labels: radii are drawn larger where it would be less. */
const LEAST = 150, MOST = 430;
/** [kg/m3] steel, of which discs are drawn. */
const DENSITY = 7850;

export function shaftDrawing(run, open) {
  const shafts = shaftsOf(run);
  return section('drawing', shafts.length > 1 ? 'The shafts' : 'The shaft', shafts.map(own => {
    // A housing is around what is in it of this shaft.
    const one = { ...run, shaft: { ...run.shaft, ...own } };
    return [shafts.length > 1 ? h('h3', {}, own.name) : null, figureOf(one, open), facts(run, one.shaft)];
  }), meshesFigure(run, shafts, WIDTH));
}

function figureOf(run, open) {
  const { picture, stretched } = draw(run, open);
  return h('figure', { 'data-shaft': run.shaft.name }, h('div', { class: 'scroll' }, picture), h('figcaption', {}, `Seen along +y, to scale${stretched === 1 ? '' : `; radii and heights are drawn ${digits(stretched, 2)} times as large`}. Red: lines through the contacts, to where they meet the axis. Arrows: forces at named places.${run.shaft.discs.length ? ' Discs are drawn as steel ones of their mass and inertia.' : ''}${run.shaft.gears.length ? ` Gears reach to their pitch circle, dots are pitch points${run.shaft.gears.every(gear => gear.face_width) ? '' : '; the width of a gear without a mesh is not known'}.` : ''}${run.shaft.housings.length ? ' What housings look like is not known: frames are around their bearings, feet and places.' : ''}`));
}

/** All that has a place, [m]: x along the axis, r across it, and a label with a leader to the point (x, r). */
function parts(run) {
  const { shaft } = run;
  const list = [];
  const bearings = shaft.bearings.map(({ name, position, direction, housing, bearing }) => {
    const rings = ringSections(bearing);
    const all = [...rings.inner, ...rings.outer];
    const half = Math.max(...all.map(p => Math.abs(p[0]))), outside = Math.max(...all.map(p => p[1]));
    const own = run.mounted.get(name)?.mean('ball[1].outer.contact_angle');
    const angle = Number.isFinite(own) ? own : bearing.contact_angle;
    list.push({ x: [position - half, position + half], r: [-outside, outside], label: { x: position, r: outside, text: `${name} (${direction > 0 ? '+x' : '\u2212x'})`, top: true } });
    return { name, position, direction, housing, bearing, rings, half, outside, angle };
  });
  const discs = shaft.discs.map(({ position, mass, polar_inertia: inertia }, i) => {
    const radius = Math.sqrt((2 * inertia) / mass), half = mass / (2 * DENSITY * Math.PI * radius ** 2);
    list.push({ x: [position - half, position + half], r: [-radius, radius], label: { x: position, r: radius, text: `disc ${i + 1}, ${short(mass, 4)}\u202fkg`, top: true } });
    return { position, radius, half };
  });
  const gears = shaft.gears.map(({ position, pitch_radius: radius, teeth, azimuth, face_width: width, mesh, with: other }, i) => {
    const half = width ? width / 2 : 0.2 * radius;
    list.push({ x: [position - half, position + half], r: [-radius, radius], label: { x: position, r: radius, text: mesh ? `${mesh}, ${teeth} teeth, with ${other}` : `gear ${i + 1}${teeth ? `, ${teeth} teeth` : ''}`, top: true } });
    return { position, radius, half, mesh: radius * Math.sin(azimuth) };
  });
  const sections = shaft.sections.map(({ from, to, outer_diameter: outer, inner_diameter: inner }) => {
    list.push({ x: [from, to], r: [-outer / 2, outer / 2] });
    return { from, to, outer: outer / 2, inner: inner / 2 };
  });
  const links = linksIn(run, list, x => Math.max(0, ...sections.filter(({ from, to }) => x >= from && x <= to).map(({ outer }) => outer)));
  const places = [];
  const place = (name, x, r, force) => {
    list.push({ x: [x, x], r: [r, r], label: { x, r, text: force ? `${name}: ${sizeOf(force)}` : name, top: r > 0 } });
    places.push({ x, r, force });
  };
  for (const { name, position, force } of shaft.loads) place(name, position, 0, force);
  for (const { name, position } of shaft.points) place(name, position, 0);
  const housings = shaft.housings.map((housing, index) => {
    const inside = bearings.filter(bearing => bearing.housing === housing.name);
    const own = [...housing.feet, ...(housing.centre ? [housing.centre] : []), ...[...housing.loads, ...housing.points].map(part => part.position)];
    const xs = [...own.map(p => p[0]), ...inside.flatMap(b => [b.position - b.half, b.position + b.half])], rs = [...own.map(p => p[2]), ...inside.flatMap(b => [-1.15 * b.outside, 1.15 * b.outside])];
    for (const { name, position, force } of housing.loads) place(name, position[0], position[2], force);
    for (const { name, position } of housing.points) place(name, position[0], position[2]);
    if (!xs.length) return null;
    const box = { x: [Math.min(...xs), Math.max(...xs)], r: [Math.min(...rs), Math.max(...rs)] };
    list.push({ ...box, label: { x: box.x[0], r: box.r[1], text: housing.name, top: true } });
    return { ...box, index, centre: housing.centre, feet: housing.feet };
  }).filter(Boolean);
  return { list, bearings, links, discs, gears, sections, places, housings };
}

const largest = ({ least, most }) => (Math.abs(most) > Math.abs(least) ? most : least);

/** Size of a force of three components, each constant or over time. */
function sizeOf(force) {
  const most = Math.hypot(...force.map(largest));
  return `${force.every(({ least, most }) => least === most) ? '' : 'up to '}${short(most, 4)}\u202fN`;
}

/** Labels beside their leaders, [px]: from the right, each in a row beyond all whose leaders its text would cross; many of them aslant. */
function rows(labels, X) {
  const placed = [];
  for (const label of [...labels].sort((a, b) => b.x - a.x)) {
    const from = X(label.x), to = from + LETTER * label.text.length + 14;
    const row = placed.filter(other => other.from <= to).reduce((most, other) => Math.max(most, other.row + 1), 0);
    placed.push({ ...label, from, to, row });
  }
  const count = placed.reduce((most, label) => Math.max(most, label.row + 1), 0);
  if (count <= ROWS) return { placed, high: ROW * count };
  // As far apart as lines are, in the order of their places.
  let last = -Infinity;
  for (const label of placed.reverse()) last = label.at = Math.max(label.from, last + 19);
  return { placed, aslant: true, high: 24 + Math.max(...placed.map(label => LETTER * label.text.length)) * Math.SQRT1_2 };
}

function draw(run, open) {
  const { list, bearings, links, discs, gears, sections, places, housings } = parts(run);
  let [x0, x1] = [Math.min(...list.map(part => part.x[0])), Math.max(...list.map(part => part.x[1]))];
  // A line for a shaft without sections goes a little beyond what is on it.
  if (!sections.length) { const beyond = 0.08 * (x1 - x0); x0 -= beyond; x1 += beyond; }
  const low = Math.min(...list.map(part => part.r[0])), high = Math.max(...list.map(part => part.r[1]));
  const labels = list.map(part => part.label).filter(Boolean);
  // Labels of the last places need room beside them.
  const room = Math.min(0.4 * WIDTH, Math.max(SIDE, ...labels.map(label => LETTER * label.text.length + 20 - ((x1 - label.x) / (x1 - x0)) * (WIDTH - 4 * SIDE))));
  const scale = Math.min((WIDTH - SIDE - room) / (x1 - x0), MOST / (high - low));
  const across = Math.max(scale, LEAST / (high - low));
  const left = SIDE + 0.5 * (WIDTH - SIDE - room - scale * (x1 - x0));
  const X = x => left + (x - x0) * scale;
  const top = rows(labels.filter(label => label.top), X), bottom = rows(labels.filter(label => !label.top), X);
  // Room for arrows of forces beyond the outline.
  const air = places.some(place => place.force) ? 60 : 26;
  const begin = 16 + top.high + air, end = begin + (high - low) * across;
  const R = r => begin + (high - r) * across;
  const under = end + air, height = under + bottom.high + 52;
  const n = value => value.toFixed(2);
  const box = (a, b, c, d, name, more = {}) => s('rect', { x: n(X(a)), y: n(R(d)), width: n(Math.max(X(b) - X(a), 1)), height: n(Math.max(R(c) - R(d), 1)), class: name, ...more });
  const out = [s('defs', {}, marker('load-arrow', 'load-head'), s('pattern', { id: 'hatch-ground', width: 7, height: 7, patternUnits: 'userSpaceOnUse', patternTransform: 'rotate(45)' }, s('line', { x1: 0, y1: 0, x2: 0, y2: 7, class: 'ground-line' })))];
  const ground = (x, y, half, down) => [s('line', { x1: n(x - half), x2: n(x + half), y1: n(y), y2: n(y), class: 'frame' }), s('rect', { x: n(x - half), y: n(down ? y : y - 8), width: n(2 * half), height: 8, fill: 'url(#hatch-ground)' })];
  for (const housing of housings) {
    const pad = 9 / across;
    out.push(box(housing.x[0] - 9 / scale, housing.x[1] + 9 / scale, housing.r[0], housing.r[1] + pad, `housing race-${housing.index % 2}`, { rx: 8 }));
    // Feet behind each other are one in the picture.
    for (const key of new Set(housing.feet.map(([x, , z]) => `${n(X(x))} ${n(R(z))}`))) {
      const [x, y] = key.split(' ').map(Number);
      out.push(s('path', { class: 'foot', d: `M${x} ${y}v4l6 2l-12 4l12 4l-12 4l6 2v3` }), ...ground(x, y + 23, 13, true));
    }
    if (housing.centre) {
      const [x, y] = [X(housing.centre[0]), R(housing.centre[2])];
      out.push(s('g', { class: 'centre' }, s('circle', { cx: n(x), cy: n(y), r: 6 }), s('path', { d: `M${n(x - 9)} ${n(y)}h18M${n(x)} ${n(y - 9)}v18` })));
    }
  }
  for (const { from, to, outer, inner } of sections) {
    out.push(box(from, to, -outer, outer, 'shaft-body'));
    if (inner > 0) for (const r of [inner, -inner]) out.push(s('line', { x1: n(X(from)), x2: n(X(to)), y1: n(R(r)), y2: n(R(r)), class: 'bore' }));
  }
  const axis = s('line', { x1: n(X(x0) - 24), x2: n(X(x1) + 24), y1: n(R(0)), y2: n(R(0)), class: 'axis' });
  if (!sections.length) out.push(axis, s('line', { x1: n(X(x0)), x2: n(X(x1)), y1: n(R(0)), y2: n(R(0)), class: 'shaft-line' }));
  for (const { position, radius, half } of discs) out.push(box(position - half, position + half, -radius, radius, 'disc'));
  for (const { position, radius, half, mesh } of gears) {
    out.push(box(position - half, position + half, -radius, radius, 'gear'), s('circle', { cx: n(X(position)), cy: n(R(mesh)), r: 4, class: 'contact outer' }));
    for (const r of [radius, -radius]) out.push(s('line', { x1: n(X(position - half) - 8), x2: n(X(position + half) + 8), y1: n(R(r)), y2: n(R(r)), class: 'axis' }));
  }
  if (sections.length) out.push(axis);
  for (const part of bearings) out.push(bearingIn(run, part, { X, R, scale, across, n, ground, x0, x1, open }));
  for (const link of links) out.push(linkIn(link, { X, R, n, ground }));
  for (const { x, r, force } of places) {
    out.push(s('circle', { cx: n(X(x)), cy: n(R(r)), r: 3.6, class: 'place' }));
    if (!force) continue;
    const [fx, fy, fz] = force.map(largest), size = Math.hypot(fx, fy, fz);
    if (!(size > 0)) continue;
    // One towards the reader is a circle with a dot, one away from him with a cross.
    const flat = Math.hypot(fx, fz);
    if (flat < 0.05 * size) {
      out.push(s('circle', { cx: n(X(x)), cy: n(R(r)), r: 9, class: 'load' }));
      if (fy > 0) out.push(s('path', { class: 'load', d: `M${n(X(x) - 6)} ${n(R(r) - 6)}l12 12m0 -12l-12 12` }));
    } else {
      const [ux, uy] = [fx / flat, -fz / flat];
      out.push(s('line', { x1: n(X(x) - 56 * ux), y1: n(R(r) - 56 * uy), x2: n(X(x) - 6 * ux), y2: n(R(r) - 6 * uy), class: 'load', 'marker-end': 'url(#load-arrow)' }));
    }
  }
  for (const [group, sign, edge] of [[top, -1, begin - air], [bottom, 1, under]]) {
    for (const { from, at, r, text, row } of group.placed) {
      if (group.aslant) {
        const [near, far] = [edge + sign * 2, edge + sign * 16];
        out.push(s('path', { class: 'leader', d: `M${n(from)} ${n(R(r))}V${n(near)}L${n(at)} ${n(far)}` }), s('text', { class: 'tick place-name', transform: `translate(${n(at + 4)} ${n(far + sign * 3)}) rotate(${45 * sign})` }, text));
        continue;
      }
      const y = edge + sign * (ROW * row + 10);
      out.push(s('path', { class: 'leader', d: `M${n(from)} ${n(R(r))}V${n(y)}` }), s('text', { class: 'tick place-name', x: n(from + 4), y: n(sign > 0 ? y : y + 9) }, text));
    }
  }
  out.push(...ruler(X, x0, x1, height - 30, n), ...arrowTo([14, height - 62], [14, height - 98], 'z'), ...arrowTo([14, height - 62], [42, height - 62], 'x'), ...gravity(run, height - 150));
  const words = bearings.map(({ name, position, direction }) => `${name} at ${millimetres(position)}, ${direction > 0 ? '+x' : '-x'}`).join('; ');
  return { stretched: across / scale, picture: s('svg', { viewBox: `0 0 ${WIDTH} ${Math.round(height)}`, role: 'group', class: 'shaft', 'aria-label': `The shaft from the side, bearings: ${words}` }, out) };
}

/** Sections of a bearing above and below the axis; the line through both contacts. */
function bearingIn(run, { name, position, direction, housing, bearing, rings, half, outside, angle }, { X, R, scale, across, n, ground, x0, x1, open }) {
  const { ball_diameter: ball, pitch_diameter: pitch } = bearing;
  const out = [];
  // Where the line meets the axis, if that is near; else a little beyond both contacts.
  const reach = 0.5 * pitch / Math.cos(angle);
  const apex = position - direction * reach * Math.sin(angle);
  const meets = Math.cos(angle) > 0.1 && apex > x0 - 0.1 * (x1 - x0) && apex < x1 + 0.1 * (x1 - x0);
  for (const side of [1, -1]) {
    const at = ([x, r]) => `${n(X(position + direction * x))} ${n(R(side * r))}`;
    for (const race of ['outer', 'inner']) out.push(s('path', { class: `ring ${race}`, d: `M${rings[race].map(at).join('L')}Z` }));
    out.push(s('ellipse', { cx: n(X(position)), cy: n(R(side * 0.5 * pitch)), rx: n(0.5 * ball * scale), ry: n(0.5 * ball * across), class: 'ball' }));
    const along = length => at([length * Math.sin(angle), 0.5 * pitch + length * Math.cos(angle)]);
    out.push(s('path', { class: 'action', d: `M${along(meets ? -reach : -0.8 * ball)}L${along(0.8 * ball)}` }));
    for (const race of ['inner', 'outer']) {
      const [x, y] = at(groovePoint(bearing, race, angle)).split(' ');
      out.push(s('circle', { cx: x, cy: y, r: 2.6, class: `contact ${race}` }));
    }
    // A seat in nothing else stands on the ground.
    if (!housing) out.push(...ground(X(position), R(side * outside), half * scale, side < 0));
  }
  const own = run.mounted.get(name);
  const use = own ? { tabindex: 0, role: 'button', 'aria-label': `Show the bearing ${name}`, class: 'mounted', onclick: () => open(own), onkeydown: event => { if (event.key === 'Enter' || event.key === ' ') { event.preventDefault(); event.stopPropagation(); open(own); } } } : {};
  return s('g', use, s('title', {}, `${name} at ${millimetres(position)}`), out);
}

/** Places along the axis. */
function ruler(X, x0, x1, y, n) {
  const wanted = (x1 - x0) * 1e3 / 9, power = 10 ** Math.floor(Math.log10(wanted));
  const step = power * [1, 2, 5, 10].find(part => part * power >= wanted);
  const out = [s('line', { x1: n(X(x0)), x2: n(X(x1)), y1: y, y2: y, class: 'extension' })];
  for (let k = Math.ceil((x0 * 1e3) / step); k * step <= x1 * 1e3 + 1e-9; k++) {
    const x = X(k * step * 1e-3);
    out.push(s('line', { x1: n(x), x2: n(x), y1: y - 5, y2: y, class: 'extension' }), s('text', { x: n(x), y: y + 16, class: 'tick', 'text-anchor': 'middle' }, k ? `${short(k * step)}` : 'x = 0'));
  }
  out.push(s('text', { x: n(X(x1) + 10), y: y + 4, class: 'tick' }, 'mm'));
  return out;
}

/** Where gravity points, as far as the view shows it. */
function gravity({ shaft: { gravity: [x, , z] } }, y) {
  const size = Math.hypot(x, z);
  if (!(size > 0)) return [];
  const [ux, uy] = [x / size, -z / size];
  return arrowTo([20 - 14 * ux, y - 14 * uy], [20 + 14 * ux, y + 14 * uy], 'g');
}

/** Words below the drawing. */
function facts(run, shaft) {
  const vector = force => force.map(given => (given.least === given.most ? short(given.start) : `${short(given.least)} to ${short(given.most)}`)).join(', ') + '\u202fN';
  const loads = [...shaft.loads, ...shaft.housings.flatMap(housing => housing.loads.map(load => ({ ...load, name: `${load.name} on ${housing.name}` })))];
  const size = Math.hypot(...shaft.gravity);
  const kinds = new Map();
  for (const { name, bearing } of shaft.bearings) {
    const kind = `${bearing.balls} balls of ${millimetres(bearing.ball_diameter)} on ${millimetres(bearing.pitch_diameter)}`;
    kinds.set(kind, [...(kinds.get(kind) ?? []), name]);
  }
  const rows = [
    ['Shaft', shaft.sections.length ? `${shaft.sections.length} section${shaft.sections.length > 1 ? 's' : ''} of beams` : shaft.modes.length ? 'of matrices' : 'rigid'],
    ['Modes', shaft.modes.length ? `${shaft.modes.length} between held places, ${digits(shaft.modes[0], 4)} to ${digits(shaft.modes.at(-1), 4)}\u202fHz` : null],
    ['Bearings', [...kinds].map(([kind, names]) => `${names.join(', ')}: ${kind}`).join('; ')],
    ['Other links', shaft.links.map(link => `${link.name}: ${kindOf(link)}`).join('; ')],
    ['Gears', shaft.gears.map(({ position, pitch_radius: radius, helix_angle: helix, mesh }, i) => `${mesh ?? `gear ${i + 1}`}: pitch radius ${millimetres(radius)}${helix ? `, helix ${short((helix * 180) / Math.PI, 4)}\u00b0` : ''}, at ${millimetres(position)}`).join('; ')],
    ['Discs', shaft.discs.map(({ position, mass, unbalance }, i) => `disc ${i + 1}: ${short(mass)}\u202fkg${unbalance ? `, unbalance ${short(unbalance * 1e6, 4)}\u202fg\u202fmm` : ''}, at ${millimetres(position)}`).join('; ')],
    ['Forces along x, y, z', loads.map(({ name, force }) => `${name}: ${vector(force)}`).join('; ')],
    ['Gravity', size > 0 ? `${short(size)}\u202fm/s\u00b2` : null],
    ['Speed at the end', rpm(run.get(`${shaft.name}.speed`).v.at(-1))],
  ];
  return h('dl', { class: 'facts' }, rows.filter(([, value]) => value).flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, value)]));
}
