// The bearing to scale: section and front view, with dimensions, frame, signs and loads.

import { s, h, section } from './dom.js';
import { ringSections, cageSection, groovePoint } from './shape.js';
import { digits, rpm, withUnit } from './units.js';

const SIZE = 560;

export function drawing(run) {
  return section('drawing', 'The bearing',
    h('div', { class: 'pair' },
      figure(axialSection(run), 'Section through a ball, to scale; the axis is drawn nearer. Blue and orange: contacts with the inner and the outer race, at the mean contact angle \u03b1 of ball 1.'),
      figure(front(run), 'Seen from +x, to scale. Azimuth \u03c8 counts from +y towards +z. Arrows: external load on the loaded race, and turns.')),
    facts(run));
}

const figure = (picture, caption) => h('figure', {}, picture, h('figcaption', {}, caption));

export const millimetres = value => `${short(value * 1e3)}\u202fmm`;

/** A number without zeros at its end. */
export function short(value, count = 5) {
  const text = digits(value, count);
  return text.includes('.') ? text.replace(/\.?0+$/, '') : text;
}

/** A dimension line between two points, its text beside the middle. */
function dimension(a, b, text, options = {}) {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const length = Math.hypot(dx, dy) || 1;
  const angle = (Math.atan2(dy, dx) * 180) / Math.PI;
  const upright = angle > 90 || angle <= -90 ? angle + 180 : angle;
  const [mx, my] = [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
  const arrow = ([x, y], sign) => {
    const [ux, uy] = [(sign * dx) / length, (sign * dy) / length];
    return s('path', { class: 'dim-head', d: `M${x} ${y}l${-9 * ux + 3.2 * uy} ${-9 * uy - 3.2 * ux}l${-6.4 * uy} ${6.4 * ux}z` });
  };
  return s('g', { class: 'dim' },
    s('line', { x1: a[0], y1: a[1], x2: b[0], y2: b[1] }), arrow(b, 1), options.one ? null : arrow(a, -1),
    s('text', { x: mx, y: my, transform: `rotate(${upright} ${mx} ${my})`, dy: options.below ? 15 : -6, 'text-anchor': 'middle' }, text));
}

function axialSection(run) {
  const { bearing } = run;
  const { ball_diameter: ball, pitch_diameter: pitch, outline } = bearing;
  const sections = ringSections(bearing);
  const all = [...sections.inner, ...sections.outer];
  const reach = Math.max(...all.map(p => Math.abs(p[0])));
  const [low, high] = [Math.min(...all.map(p => p[1])), Math.max(...all.map(p => p[1]))];
  // Beside the section there is room for dimensions; the axis is drawn closer than it is.
  const scale = Math.min((SIZE - 250) / (2 * reach), (SIZE - 210) / (high - low));
  const cx = SIZE / 2 + 4, top = 50;
  const X = x => cx + x * scale, Y = r => top + (high - r) * scale;
  const axisY = SIZE - 48;
  const path = polygon => 'M' + polygon.map(([x, r]) => `${X(x).toFixed(2)} ${Y(r).toFixed(2)}`).join('L') + 'Z';
  const parts = [
    s('defs', {}, s('pattern', { id: `hatch-${run.index}`, width: 7, height: 7, patternUnits: 'userSpaceOnUse', patternTransform: 'rotate(45)' },
      s('line', { x1: 0, y1: 0, x2: 0, y2: 7, class: 'hatch' })), marker('load-arrow', 'load-head')),
    s('path', { d: path(sections.outer), class: 'ring outer' }), s('path', { d: path(sections.outer), fill: `url(#hatch-${run.index})` }),
    s('path', { d: path(sections.inner), class: 'ring inner' }), s('path', { d: path(sections.inner), fill: `url(#hatch-${run.index})` }),
    s('circle', { cx: X(0), cy: Y(pitch / 2), r: (ball / 2) * scale, class: 'ball' }),
    s('circle', { cx: X(0), cy: Y(pitch / 2), r: 2.2, class: 'mark' }),
    s('line', { x1: 24, y1: axisY, x2: SIZE - 24, y2: axisY, class: 'axis' }),
  ];
  if (bearing.cage) {
    const cage = cageSection(bearing);
    for (const side of [-1, 1]) {
      const [a, b] = [side * cage.pocket, side * cage.half];
      parts.push(s('path', { class: 'cage', d: path([[a, cage.inside], [b, cage.inside], [b, cage.outside], [a, cage.outside]]) }));
    }
  }
  // The line of action through both contacts.
  const angle = bearing.contact_angle;
  const mean = run.mean('ball[1].outer.contact_angle');
  const contact = Number.isFinite(mean) ? mean : angle;
  const along = (length, a) => [X(length * Math.sin(a)), Y(pitch / 2 + length * Math.cos(a))];
  const far = 0.5 * ball + Math.max(0.35 * ball, 1e-4);
  const [p, q] = [along(-far, contact), along(far, contact)];
  parts.push(s('line', { x1: p[0], y1: p[1], x2: q[0], y2: q[1], class: 'action' }));
  parts.push(s('line', { x1: X(0), y1: Y(pitch / 2 + far), x2: X(0), y2: Y(pitch / 2 - far), class: 'axis' }));
  for (const race of ['inner', 'outer']) {
    const [x, r] = groovePoint(bearing, race, contact);
    parts.push(s('circle', { cx: X(x), cy: Y(r), r: 3.4, class: `contact ${race}` }));
  }
  const beside = along(0.5 * far, contact);
  parts.push(s('text', { x: beside[0] + (contact < 0 ? -10 : 10), y: beside[1] + 8, class: 'symbol', 'text-anchor': contact < 0 ? 'end' : 'start' },
    `\u03b1 = ${digits((contact * 180) / Math.PI, 3)}\u00b0`));
  // Dimensions.
  const left = X(-reach) - 26, right = X(reach) + 30;
  const extension = (x1, y1, x2, y2) => s('line', { x1, y1, x2, y2, class: 'extension' });
  parts.push(
    extension(X(0), Y(pitch / 2), left - 58, Y(pitch / 2)), dimension([left - 52, axisY], [left - 52, Y(pitch / 2)], `d\u2098/2 = ${millimetres(pitch / 2)}`),
    extension(X(0), Y(pitch / 2 + ball / 2), right + 6, Y(pitch / 2 + ball / 2)), extension(X(0), Y(pitch / 2 - ball / 2), right + 6, Y(pitch / 2 - ball / 2)),
    dimension([right, Y(pitch / 2 - ball / 2)], [right, Y(pitch / 2 + ball / 2)], `D = ${millimetres(ball)}`, { below: true }));
  if (!bearing.is_thrust_bearing) {
    const rims = { bore: Math.min(...sections.inner.map(point => point[1])), outside: high };
    const about = outline.usual ? '\u2248 ' : '';
    parts.push(
      dimension([right + 46, axisY], [right + 46, Y(rims.bore)], `bore/2 ${about}${millimetres(rims.bore)}`, { below: true }),
      extension(X(0), Y(rims.bore), right + 52, Y(rims.bore)),
      dimension([X(-outline.width / 2), top - 20], [X(outline.width / 2), top - 20], `width ${about}${millimetres(outline.width)}`),
      extension(X(-outline.width / 2), top - 26, X(-outline.width / 2), top), extension(X(outline.width / 2), top - 26, X(outline.width / 2), top));
  }
  parts.push(...grooves(bearing, contact < 0 ? -1 : 1, X, Y, reach, high, extension), ...plays(bearing, X(0) + 18, Y(Math.min(...all.map(p => p[1]))) + 24));
  // Frame.
  const origin = [X(0), axisY];
  parts.push(...arrowTo(origin, [origin[0] + 50, axisY], 'x'), ...arrowTo(origin, [origin[0], axisY - 50], 'r'));
  // Axial load of the race that is loaded, and of the other one its opposite.
  parts.push(...axialLoad(run, X, Y, sections));
  return s('svg', { viewBox: `0 0 ${SIZE} ${SIZE}`, role: 'img', class: 'drawing', 'aria-label': `Section: ${bearing.balls} balls of ${millimetres(ball)}, pitch diameter ${millimetres(pitch)}, contact angle ${digits((contact * 180) / Math.PI, 3)} degrees` }, parts);
}

/** Radii of both grooves, each in its ring on the side that the contact is not on. */
function grooves(bearing, side, X, Y, reach, high, extension) {
  if (bearing.is_thrust_bearing) return [];
  const low = Math.min(...ringSections(bearing).inner.map(p => p[1]));
  return [['outer', -side, Y(high) + 24], ['inner', side, Y(low) - 12]].flatMap(([race, at, y]) => {
    const [minus, plus] = bearing[race].shoulders;
    const [gx, gr] = groovePoint(bearing, race, -0.6 * side * Math.min(side > 0 === (race === 'outer') ? minus : plus, 1.45));
    const x = X(at * reach) - at * 8;
    return [
      extension(x - at * 64, y + (race === 'outer' ? 6 : -14), X(gx), Y(gr)),
      s('g', { class: 'dim' }, s('text', { x, y, 'text-anchor': at < 0 ? 'start' : 'end' }, `r${race === 'outer' ? '\u2092' : '\u1d62'} = ${millimetres(bearing[race].groove_radius)}`))];
  });
}

/** What is too small to be seen to scale, line by line: clearance or free contact angle, and the play of a cage. */
function plays({ clearance, contact_angle: angle, cage }, x, y) {
  const lines = [clearance === null ? `\u03b1\u2080 = ${short((angle * 180) / Math.PI)}\u00b0 without load` : `clearance ${digits(clearance * 1e6, 4)}\u202f\u00b5m`];
  if (cage) lines.push(`pockets ${millimetres(cage.pocket_clearance)} clear`);
  if (cage && cage.guidance_clearance !== null) lines.push(`guidance ${millimetres(cage.guidance_clearance)} clear`);
  return lines.map((line, i) => s('g', { class: 'dim' }, s('text', { x, y: y + 18 * i }, line)));
}

export const marker = (id, name) => s('marker', { id, viewBox: '0 0 10 10', refX: 8, refY: 5, markerWidth: 6, markerHeight: 6, orient: 'auto-start-reverse' },
  s('path', { d: 'M0 0L10 5L0 10z', class: name }));

export const arrowTo = (a, b, text) => [
  s('line', { x1: a[0], y1: a[1], x2: b[0], y2: b[1], class: 'frame', 'marker-end': 'url(#load-arrow)' }),
  s('text', { x: b[0] + (b[0] - a[0]) * 0.18, y: b[1] + (b[1] - a[1]) * 0.18 + 5, class: 'symbol', 'text-anchor': 'middle' }, text)];

/** The external load on a race along an axis, where a force is given; else none. */
function force(run, axis) {
  const { loaded, loads } = run.bearing;
  const given = loads[loaded]?.[axis];
  return given?.kind === 'load' && (given.least !== 0 || given.most !== 0) ? given : null;
}

const size = given => (given.least === given.most ? withUnit(given.start, 'force', 'N') : `${withUnit(given.least, 'force', 'N')} to ${withUnit(given.most, 'force', 'N')}`);

function axialLoad(run, X, Y, sections) {
  const given = force(run, 'x');
  if (!given) return [];
  const polygon = sections[run.bearing.loaded];
  const sign = Math.sign(Math.abs(given.most) > Math.abs(given.least) ? given.most : given.least);
  const xs = polygon.map(p => p[0]), rs = polygon.map(p => p[1]);
  const r = run.bearing.loaded === 'inner' ? Math.min(...rs) + 0.22 * (Math.max(...rs) - Math.min(...rs)) : Math.max(...rs) - 0.22 * (Math.max(...rs) - Math.min(...rs));
  const edge = sign > 0 ? Math.min(...xs) : Math.max(...xs);
  const y = Y(r), x = X(edge);
  return [
    s('line', { x1: x - sign * 62, y1: y, x2: x - sign * 4, y2: y, class: 'load', 'marker-end': 'url(#load-arrow)' }),
    s('text', { x: x + sign * 8, y: y + 5, class: 'load-text', 'text-anchor': sign > 0 ? 'start' : 'end' }, `F\u2093 = ${size(given)}`)];
}

function front(run) {
  const { bearing } = run;
  const { ball_diameter: ball, pitch_diameter: pitch, balls } = bearing;
  const sections = ringSections(bearing);
  const outside = Math.max(...sections.outer.map(p => p[1]));
  const radii = race => { const rs = sections[race].map(p => p[1]); return [Math.min(...rs), Math.max(...rs)]; };
  const scale = (SIZE / 2 - 74) / outside;
  const c = SIZE / 2;
  const circle = (r, name) => s('circle', { cx: c, cy: c, r: r * scale, class: name });
  const annulus = ([a, b], name) => s('path', { class: `ring ${name}`, 'fill-rule': 'evenodd', d: [b, a].map(r => { const R = r * scale; return `M${c - R} ${c}a${R} ${R} 0 1 0 ${2 * R} 0a${R} ${R} 0 1 0 ${-2 * R} 0z`; }).join('') });
  const parts = [s('defs', {}, marker('load-arrow', 'load-head')), annulus(radii('outer'), 'outer'), annulus(radii('inner'), 'inner'), circle(pitch / 2, 'axis')];
  for (let i = 0; i < balls; i++) {
    const angle = bearing.first_ball_azimuth + (2 * Math.PI * i) / balls;
    const [x, y] = [c + 0.5 * pitch * scale * Math.cos(angle), c - 0.5 * pitch * scale * Math.sin(angle)];
    parts.push(s('circle', { cx: x, cy: y, r: 0.5 * ball * scale, class: 'ball' }));
    if (balls <= 40) parts.push(s('text', { x, y: y + 4.5, class: 'number', 'text-anchor': 'middle' }, i + 1));
  }
  const reach = outside * scale;
  parts.push(...arrowTo([c, c], [c + 44, c], 'y'), ...arrowTo([c, c], [c, c - 44], 'z'));
  // Azimuth.
  const r = reach + 14;
  const at = angle => [c + r * Math.cos(angle), c - r * Math.sin(angle)];
  const [from, to] = [at(0), at(0.5)];
  parts.push(s('path', { d: `M${from}A${r} ${r} 0 0 0 ${to}`, class: 'frame', fill: 'none', 'marker-end': 'url(#load-arrow)' }),
    s('text', { x: at(0.25)[0] + 14, y: at(0.25)[1], class: 'symbol' }, '\u03c8'));
  // Radial load.
  const [fy, fz] = [force(run, 'y'), force(run, 'z')];
  const value = given => (given ? (Math.abs(given.most) > Math.abs(given.least) ? given.most : given.least) : 0);
  const [y, z] = [value(fy), value(fz)];
  const radial = Math.hypot(y, z);
  if (radial > 0) {
    const [ux, uy] = [y / radial, -z / radial];
    const [from, to] = [[c + ux * (reach + 6), c + uy * (reach + 6)], [c + ux * (reach + 58), c + uy * (reach + 58)]];
    parts.push(s('line', { x1: from[0], y1: from[1], x2: to[0], y2: to[1], class: 'load', 'marker-end': 'url(#load-arrow)' }),
      s('text', { x: to[0] + 12, y: to[1] + (uy > 0 ? -4 : 12), class: 'load-text' }, `F\u1d63 = ${withUnit(radial, 'force', 'N')}`));
  }
  // Turns of both races.
  for (const [race, radius] of [['inner', radii('inner')[0] * scale - 12], ['outer', reach + 26]]) {
    const speed = bearing.speeds[race];
    const most = Math.abs(speed.most) > Math.abs(speed.least) ? speed.most : speed.least;
    if (!most) continue;
    const sign = Math.sign(most);
    const point = angle => `${c + radius * Math.cos(angle)} ${c - radius * Math.sin(angle)}`;
    const middle = (race === 'inner' ? 215 : 140) * Math.PI / 180;
    parts.push(s('path', { d: `M${point(middle - 0.5 * sign)}A${radius} ${radius} 0 0 ${sign > 0 ? 0 : 1} ${point(middle + 0.5 * sign)}`, class: 'turn', 'marker-end': 'url(#load-arrow)' }));
    if (race === 'inner') parts.push(s('text', { x: c, y: c + 0.5 * radius + 6, class: 'load-text', 'text-anchor': 'middle' }, rpm(most)));
    else parts.push(s('text', { x: 12, y: 24, class: 'load-text' }, `outer ${rpm(most)}`));
  }
  return s('svg', { viewBox: `0 0 ${SIZE} ${SIZE}`, role: 'img', class: 'drawing', 'aria-label': `Front view with ${balls} balls` }, parts);
}

/** Words beside the drawing. */
function facts(run) {
  const { bearing: b } = run;
  const degrees = angle => `${short((angle * 180) / Math.PI)}\u00b0`;
  const both = (get, unit = '') => `${get(b.inner)}${unit} inner, ${get(b.outer)}${unit} outer`;
  const speed = race => { const given = b.speeds[race]; return given.least === given.most ? rpm(given.start) : `${rpm(given.least)} to ${rpm(given.most)}`; };
  const directions = { x: 'force x', y: 'force y', z: 'force z', ry: 'about y', rz: 'about z' };
  const units = { load: { x: 'N', y: 'N', z: 'N', ry: 'N.m', rz: 'N.m' }, motion: { x: 'm', y: 'm', z: 'm', ry: 'rad', rz: 'rad' } };
  const given = Object.entries(b.loads[b.loaded]).map(([axis, g]) => {
    const unit = units[g.kind][axis];
    const name = g.kind === 'load' ? (unit === 'N' ? 'force' : 'moment') : unit === 'm' ? 'position' : 'rotation';
    const text = value => withUnit(value, name, unit);
    return `${g.kind === 'load' ? directions[axis] : `held ${axis}`}: ${g.least === g.most ? text(g.start) : `${text(g.least)} to ${text(g.most)}`}`;
  });
  const rows = [
    ['Balls', `${b.balls} of ${millimetres(b.ball_diameter)} on ${millimetres(b.pitch_diameter)}`],
    b.clearance === null ? ['Free contact angle', degrees(b.contact_angle)] : ['Diametral clearance', `${digits(b.clearance * 1e6, 4)} \u00b5m`],
    ['Conformity (groove radius / D)', both(race => short(race.conformity, 4))],
    ['Drive', both(race => race.drive)],
    ['Speed', `${speed('inner')} inner, ${speed('outer')} outer`],
    [`External load on the ${b.loaded} race`, given.join('; ') || 'none'],
    ['Friction coefficient, creep law', `${b.friction.least === b.friction.most ? short(b.friction.start, 3) : `${digits(b.friction.least, 3)} to ${digits(b.friction.most, 3)}`}, ${b.creep}`],
    ['Cage', b.cage ? `guided by ${b.cage.guided_by === 'balls' ? 'the balls' : `the ${b.cage.guided_by} race`}, ${short(b.cage.mass * 1e3, 3)} g, pockets ${short(b.cage.pocket_clearance * 1e3, 3)} mm clear` : 'none'],
  ];
  return h('div', {}, h('dl', { class: 'facts' }, rows.flatMap(([name, value]) => [h('dt', {}, name), h('dd', {}, value)])),
    h('p', { class: 'note' }, `Signs: x is the bearing axis. Forces and moments of the bearing act on the race, in world axes, about the race's origin; the external load is the opposite in steady motion. Contact angles are positive under thrust of the inner race along +x.${b.outline.usual && !b.is_thrust_bearing ? ' Bore, outside and width are not in the scene: those drawn are usual for such balls.' : ''}`));
}
