// Bearings without balls of their own, by rollers or by their stiffness, and couplings: in drawings, and their rows.

import { s } from './dom.js';
import { millimetres } from './drawing.js';

/** [px] half a spring's height, and its length. */
const HALF = 5, LONG = 26;

/** What a link is, in a few words. */
export function kindOf({ rollers, with: other }) {
  if (other) return `coupling with ${other}`;
  if (!rollers) return 'by its stiffness';
  return `${rollers.count} ${rollers.contact_angle ? 'tapered' : 'cylindrical'} rollers of ${millimetres(rollers.diameter)} on ${millimetres(rollers.pitch_diameter)}`;
}

/** Links of a shaft in its drawing: what room they need goes to `list`, with their labels; `radiusAt` is that of the shaft at a place. */
export function linksIn({ shaft }, list, radiusAt) {
  return shaft.links.map(link => {
    const { name, rollers, position, direction } = link;
    const radius = radiusAt(position), outside = rollers ? 0.5 * rollers.pitch_diameter + 0.95 * rollers.diameter : 1.2 * radius;
    const half = rollers ? 0.65 * rollers.length : 0;
    const way = rollers?.contact_angle ? ` (${direction > 0 ? '+x' : '\u2212x'})` : '';
    list.push({ x: [position - half, position + half], r: [-outside, outside], label: { x: position, r: outside, text: `${name}${way}`, top: true } });
    return { ...link, radius, outside, half };
  });
}

/** A roller with its raceways above the axis, x and r [m] from the middle of the bearing: outlines of rings and roller. */
function section({ diameter, length, pitch_diameter: pitch, contact_angle: outer = 0, roller_angle: between = 0 }) {
  const inner = outer - between, tilt = outer - between / 2, grows = 0.5 * length * Math.tan(between / 2);
  const centre = 0.5 * pitch, along = [Math.cos(tilt), -Math.sin(tilt)], across = [Math.sin(tilt), Math.cos(tilt)];
  const corner = (t, side) => [0, 1].map(i => (i ? centre : 0) + t * length * 0.5 * along[i] + side * (0.5 * diameter - t * grows) * across[i]);
  const raceway = (angle, side) => [-1, 1].map(t => [side * 0.5 * diameter * Math.sin(angle) + t * 0.65 * length * Math.cos(angle), centre + side * 0.5 * diameter * Math.cos(angle) - t * 0.65 * length * Math.sin(angle)]);
  const ring = (angle, side) => { const [a, b] = raceway(angle, side), r = centre + side * 0.95 * diameter; return [a, b, [b[0], r], [a[0], r]]; };
  return { roller: [corner(-1, 1), corner(1, 1), corner(1, -1), corner(-1, -1)], rings: { outer: ring(outer, 1), inner: ring(inner, -1) } };
}

/** A link in the drawing of its shaft. */
export function linkIn(link, { X, R, n, ground }) {
  const { name, position, direction, rollers, radius, outside, half, with: other } = link, out = [];
  const of = rollers && section(rollers);
  for (const side of [1, -1]) {
    const at = ([x, r]) => `${n(X(position + direction * x))} ${n(R(side * r))}`;
    const drawn = (points, name) => s('path', { class: name, d: `M${points.map(at).join('L')}Z` });
    if (of) {
      for (const race of ['outer', 'inner']) out.push(drawn(of.rings[race], `ring ${race}`));
      out.push(drawn(of.roller, 'ball'), ...ground(X(position), R(side * outside), Math.max(X(half) - X(0), 6), side < 0));
    } else if (!other) {
      // A spring from the shaft to the ground.
      const x = X(position), y = R(side * radius), turn = -side * LONG / 6;
      out.push(s('path', { class: 'spring', d: `M${n(x)} ${n(y)}v${n(turn)}l${HALF} ${n(turn / 2)}l${-2 * HALF} ${n(turn)}l${2 * HALF} ${n(turn)}l${-HALF} ${n(turn / 2)}v${n(turn)}` }), ...ground(x, y - side * LONG * (5 / 6), 8, side < 0));
    }
  }
  if (other) out.push(s('rect', { x: n(X(position) - 4), y: n(R(outside)), width: 8, height: n(R(-outside) - R(outside)), class: 'disc' }));
  return s('g', {}, s('title', {}, `${name} at ${millimetres(position)}: ${kindOf(link)}`), out);
}
