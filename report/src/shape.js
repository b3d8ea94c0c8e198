// Shapes of a bearing from its dimensions: sections of the rings, for the drawing and the playback. Lengths in metres, (x, r) axial and radial.

/** Sections of both rings as polygons. The grooves and their ends are those of the model; bore, outside and width only frame them. */
export function ringSections(bearing) {
  return { inner: ring(bearing, 'inner'), outer: ring(bearing, 'outer') };
}

/** Point of a groove at a contact angle: where a ball touches it. */
export function groovePoint(bearing, race, angle) {
  const { groove_radius: radius, groove_circle_radius: circle, groove_offset: offset } = bearing[race];
  const side = race === 'inner' ? -1 : 1;
  return [offset + side * radius * Math.sin(angle), circle + side * radius * Math.cos(angle)];
}

function ring(bearing, race) {
  const { outline, ball_diameter: ball, pitch_diameter: pitch } = bearing;
  const [minus, plus] = bearing[race].shoulders;
  const free = bearing.contact_angle;
  let from, to;
  if (bearing.is_thrust_bearing) {
    // Washers: the groove faces along the axis.
    [from, to] = [free - Math.PI / 3.2, free + Math.PI / 3.2];
  } else {
    const most = 1.45;
    [from, to] = race === 'inner' ? [-Math.min(plus, most), Math.min(minus, most)] : [-Math.min(minus, most), Math.min(plus, most)];
  }
  const arc = Array.from({ length: 33 }, (_, i) => groovePoint(bearing, race, from + ((to - from) * i) / 32));
  const xs = arc.map(p => p[0]);
  const half = Math.max(0.5 * outline.width, 1.02 * Math.max(...xs.map(Math.abs)));
  if (bearing.is_thrust_bearing) {
    const back = (race === 'inner' ? -1 : 1) * Math.max(half, 0.75 * ball);
    const [inside, outside] = [0.5 * pitch - 0.8 * ball, 0.5 * pitch + 0.8 * ball];
    const face = arc[0][0];
    const [first, last] = arc[0][1] < arc[arc.length - 1][1] ? [inside, outside] : [outside, inside];
    return [[back, first], [face, first], ...arc, [arc[arc.length - 1][0], last], [back, last]];
  }
  const rs = arc.map(p => p[1]);
  // The rim is beyond the groove even where the outline is a guess.
  const rim = race === 'inner'
    ? Math.min(0.5 * outline.bore, Math.min(...rs) - 0.08 * ball)
    : Math.max(0.5 * outline.outside, Math.max(...rs) + 0.08 * ball);
  const first = arc[0], last = arc[arc.length - 1];
  return [[Math.sign(first[0] || 1) * half, rim], [Math.sign(first[0] || 1) * half, first[1]], ...arc, [Math.sign(last[0] || -1) * half, last[1]], [Math.sign(last[0] || -1) * half, rim]];
}

/** Section of a cage: a band around the pitch circle, or the width that its lands say. */
export function cageSection(bearing) {
  const { ball_diameter: ball, pitch_diameter: pitch, cage } = bearing;
  let [inside, outside] = [0.5 * pitch - 0.13 * ball, 0.5 * pitch + 0.13 * ball];
  if (cage?.land_diameter && cage.guided_by === 'outer') outside = 0.5 * (cage.land_diameter - (cage.guidance_clearance ?? 0));
  if (cage?.land_diameter && cage.guided_by === 'inner') inside = 0.5 * (cage.land_diameter + (cage.guidance_clearance ?? 0));
  if (outside - inside < 0.1 * ball) { if (cage?.guided_by === 'inner') outside = inside + 0.2 * ball; else inside = outside - 0.2 * ball; }
  const pocket = 0.5 * (ball + (cage?.pocket_clearance ?? 0.02 * ball));
  const half = pocket + (cage?.land_width ?? 0.15 * ball);
  return { inside, outside, half, pocket };
}
