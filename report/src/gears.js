// Gears in mesh on the axes of all shafts, seen from +x: their teeth, and the balls and rollers of the bearings, turn with the time of the page.

import { s, h } from './dom.js';
import { arrowTo } from './drawing.js';
import { clock } from './clock.js';

const SIDE = 66, MOST = 430;
/** [-] of the transverse module: tips and roots beyond the pitch circle, and half widths of a tooth there, over the pitch. */
const TIP = 1, ROOT = -1.25, TIP_HALF = 0.13, ROOT_HALF = 0.36;

/** [m] Are two lengths the same but for rounding? */
const near = (one, other) => Math.abs(one - other) < 1e-7;

/** Gears with teeth on the axes of shafts: one of all that are the same, each with the mesh that it is named by. */
function gearsOf(shafts) {
  const list = [];
  for (const { axis, gears, name } of shafts) {
    for (const gear of gears.filter(own => own.mesh)) {
      const same = list.find(other => other.shaft === name && other.teeth === gear.teeth && near(other.position, gear.position) && near(other.radius, gear.pitch_radius));
      if (same) same.meshes.push(gear);
      else list.push({ shaft: name, at: axis, teeth: gear.teeth, position: gear.position, radius: gear.pitch_radius, meshes: [gear] });
    }
  }
  return list;
}

/** Pairs of gears in mesh: the first one, the second, and where they touch seen from each. */
function pairsOf(gears, meshes) {
  return meshes.map(name => gears.flatMap(gear => gear.meshes.filter(({ mesh }) => mesh === name).map(({ azimuth }) => ({ gear, azimuth })))).filter(({ length }) => length === 2);
}

/** Puts teeth of one gear between those of the other, from the first gear on: `tooth` is where one of its teeth stands [rad]. */
function fit(gears, pairs) {
  const open = [...pairs];
  while (open.length) {
    let at = open.findIndex(pair => pair.some(({ gear }) => gear.tooth !== undefined));
    if (at < 0) { at = 0; open[0][0].gear.tooth = open[0][0].azimuth; }
    const [pair] = open.splice(at, 1);
    const [known, other] = pair[0].gear.tooth !== undefined ? pair : [pair[1], pair[0]];
    if (other.gear.tooth !== undefined) continue;
    // Part of a pitch by which a tooth is beyond the pitch point; the other gear turns against it, a ring with it, and has a gap there.
    const beyond = ((known.gear.tooth - known.azimuth) * known.gear.teeth) / (2 * Math.PI);
    const along = other.gear.inside || known.gear.inside ? 1 : -1;
    other.gear.tooth = other.azimuth + ((along * beyond + 0.5) * 2 * Math.PI) / other.gear.teeth;
  }
}

/** Outline of a gear [px] with its centre at 0, 0 and a tooth towards +y. */
function outline({ teeth, radius, inside }, scale) {
  const module = (2 * radius) / teeth, pitch = (2 * Math.PI) / teeth, out = [];
  const point = (part, angle) => {
    const r = (radius + (inside ? -part : part) * module) * scale;
    return `${(r * Math.cos(angle)).toFixed(2)} ${(-r * Math.sin(angle)).toFixed(2)}`;
  };
  for (let k = 0; k < teeth; k++) for (const [part, half] of [[ROOT, -ROOT_HALF], [TIP, -TIP_HALF], [TIP, TIP_HALF], [ROOT, ROOT_HALF]]) out.push(point(part, (k + half) * pitch));
  return `M${out.join('L')}Z`;
}

/** Balls or rollers of bearings on the axes of shafts: how many of what size there are, and where the first one stands at a time. */
function rollingOf(run, shafts) {
  // What has no states turns with the kinematic speed of its cage.
  const turned = ({ shaft, direction }, share) => time => direction * share * (run.at(`${shaft}.angle`, time) || 0);
  return shafts.flatMap(({ axis, bearings, links }) => [
    ...bearings.map(bearing => {
      const { balls: count, ball_diameter: size, pitch_diameter: pitch, contact_angle: angle } = bearing.bearing, own = run.mounted.get(bearing.name);
      const kinematic = turned(bearing, 0.5 * (1 - (size / pitch) * Math.cos(angle)));
      return { ...bearing, axis, count, size, pitch, first: own?.has('ball[1].azimuth') ? time => own.azimuth(1, time) : kinematic };
    }),
    ...links.filter(({ rollers }) => rollers).map(link => {
      const { count, diameter: size, pitch_diameter: pitch, contact_angle: angle = 0 } = link.rollers;
      return { ...link, axis, count, size, pitch, first: turned(link, 0.5 * (1 - (size / pitch) * Math.cos(angle))) };
    }),
  ]);
}

/** The figure; nothing where no gears mesh. */
export function meshesFigure(run, shafts, width) {
  const gears = gearsOf(shafts);
  if (!gears.length) return null;
  const pairs = pairsOf(gears, run.shaft.meshes);
  for (const [one, other] of pairs) {
    const apart = Math.hypot(one.gear.at[0] - other.gear.at[0], one.gear.at[1] - other.gear.at[1]);
    const larger = one.gear.radius > other.gear.radius ? one.gear : other.gear;
    larger.inside = apart < larger.radius;
  }
  fit(gears, pairs);
  const beyond = ({ radius, teeth }) => radius * (1 + 3 / teeth);
  const reach = axis => [Math.min, Math.max].map((most, i) => most(...gears.map(gear => gear.at[axis] + (i ? 1 : -1) * beyond(gear))));
  const [[y0, y1], [z0, z1]] = [0, 1].map(reach);
  const scale = Math.min((width - 2 * SIDE) / (y1 - y0), MOST / (z1 - z0));
  const left = 0.5 * (width - scale * (y1 - y0)), n = value => value.toFixed(2);
  const [Y, Z] = [y => left + (y - y0) * scale, z => 30 + (z1 - z) * scale];
  const height = Math.round(scale * (z1 - z0) + 60);
  const turning = [], out = [];
  // Large ones lie behind.
  for (const gear of [...gears].sort((one, other) => other.radius - one.radius)) {
    const { at: [y, z], radius, teeth, shaft, meshes } = gear;
    const body = s('path', { d: outline(gear, scale), class: gear.inside ? 'gear inside' : 'gear' });
    turning.push({ gear, body });
    out.push(s('g', { class: 'gear-seen', transform: `translate(${n(Y(y))} ${n(Z(z))})` }, s('title', {}, `${meshes.map(({ mesh }) => mesh).join(', ')}: ${teeth} teeth on ${shaft}`), body, s('circle', { r: n(radius * scale), class: 'axis pitch' })));
  }
  for (const [{ gear: { at: [y, z], radius }, azimuth }] of pairs) out.push(s('circle', { cx: n(Y(y + radius * Math.cos(azimuth))), cy: n(Z(z + radius * Math.sin(azimuth))), r: 4, class: 'contact outer' }));
  const rolling = rollingOf(run, shafts);
  for (const own of rolling) {
    const { axis: [y, z], count, size, pitch, name } = own;
    const elements = Array.from({ length: count }, (_, k) => {
      const angle = (2 * Math.PI * k) / count;
      return s('circle', { cx: n(0.5 * pitch * scale * Math.cos(angle)), cy: n(-0.5 * pitch * scale * Math.sin(angle)), r: n(0.5 * size * scale), class: 'ball' });
    });
    own.body = s('g', {}, elements);
    out.push(s('g', { class: 'rolling', transform: `translate(${n(Y(y))} ${n(Z(z))})` }, s('title', {}, `${name}: ${count} ${own.rollers ? 'rollers' : 'balls'}`),
      [-1, 1].map(side => s('circle', { r: n((0.5 * pitch + 0.5 * side * size) * scale), class: 'track' })), own.body));
  }
  // Shafts on one axis have one place.
  const axes = [];
  for (const { name, axis } of shafts) {
    const same = axes.find(other => near(other.axis[0], axis[0]) && near(other.axis[1], axis[1]));
    if (same) same.names.push(name); else axes.push({ axis, names: [name] });
  }
  for (const { axis: [y, z], names } of axes) out.push(s('circle', { cx: n(Y(y)), cy: n(Z(z)), r: 3, class: 'place' }), s('text', { x: n(Y(y) + 6), y: n(Z(z) - 6), class: 'tick place-name' }, names.join(', ')));
  out.push(...arrowTo([14, height - 14], [14, height - 50], 'z'), ...arrowTo([14, height - 14], [42, height - 14], 'y'));
  clock.follow(({ time }) => {
    for (const { gear, body } of turning) {
      const angle = run.at(`${gear.shaft}.angle`, time);
      // Axes up the page: a turn about +x, towards the reader, goes against the clock.
      body.setAttribute('transform', `rotate(${n((-180 / Math.PI) * (gear.tooth + (Number.isFinite(angle) ? angle : 0)))})`);
    }
    for (const { body, first, direction } of rolling) {
      // Seen from +x of the shaft; a bearing the other way round has its own y axis against it.
      const azimuth = direction > 0 ? first(time) : Math.PI - first(time);
      body.setAttribute('transform', `rotate(${n((-180 / Math.PI) * azimuth)})`);
    }
  });
  const given = run.record.scene?.includes('[frame]') ? ' in the frame that is given' : '';
  return [h('h3', {}, 'The meshes'), h('figure', {}, h('div', { class: 'scroll' }, s('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', class: 'shaft meshes', 'aria-label': `Meshes: ${run.shaft.meshes.join(', ')}` }, out)),
    h('figcaption', {}, `Seen from +x, to scale, turning with the time of the page${given}: pitch circles, dots where they touch, and balls and rollers of the bearings. Teeth are drawn in the transverse section, not to their profile.`))];
}
