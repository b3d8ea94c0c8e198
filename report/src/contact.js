// Where a contact sticks and slips: pressure, tractions and slip over its ellipse.

import { h, section, select, choice, table } from './dom.js';
import { css, isDark, onTheme, viridisCss } from './theme.js';
import { digits } from './units.js';

const QUANTITIES = [['stick', 'stick and slip'], ['traction', 'traction'], ['pressure', 'pressure'], ['slip', 'slip velocity'], ['power', 'friction power density']];

export function contacts(run) {
  if (!run.fields.length) return null;
  const state = { field: 0, quantity: 'stick' };
  const canvas = h('canvas', { class: 'contact-view', role: 'img' });
  const words = h('p', { class: 'note' });
  const draw = () => paint(canvas, words, run.fields[state.field], state.quantity);
  onTheme(draw);
  new ResizeObserver(draw).observe(canvas);
  return section('contact', 'Inside a contact',
    h('div', { class: 'row' },
      select('Contact', run.fields.map((field, i) => [String(i), `ball ${field.ball}, ${field.race} race, ${digits(field.time * 1e3, 4)} ms`]), '0', i => { state.field = Number(i); draw(); }),
      choice('What is shown', QUANTITIES, 'stick', quantity => { state.quantity = quantity; draw(); })),
    h('figure', {}, canvas, words),
    table(['contact', 'semi-axes [\u00b5m], rolling \u00d7 transverse', 'sticks'], run.fields.map(field => [`ball ${field.ball}, ${field.race} race, ${digits(field.time * 1e3, 4)} ms`, field.semi_axes.map(a => digits(a * 1e6, 4)).join(' \u00d7 '), `${digits(100 * field.stick, 3)} %`]), { numbers: [1, 2] }),
    h('p', { class: 'note' }, 'By the half-space solver from load, ellipse and creepages of the simulation. x is along rolling, y across. \u201croulement field\u201d computes other contacts and times; \u201croulement report --field\u201d adds them here.'));
}

function paint(canvas, words, field, quantity) {
  const ratio = Math.min(devicePixelRatio, 2);
  const width = canvas.clientWidth, height = canvas.clientHeight;
  if (!width) return;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const c = canvas.getContext('2d');
  c.scale(ratio, ratio);
  c.fillStyle = css('--panel');
  c.fillRect(0, 0, width, height);
  const get = name => field.cells.get(name).values;
  const [x, y, area, pressure, tx, ty, sx, sy, sticks] = ['x', 'y', 'area', 'pressure', 'traction.x', 'traction.y', 'slip.x', 'slip.y', 'sticks'].map(get);
  const size = i => Math.hypot(tx[i], ty[i]);
  const values = {
    stick: () => Float64Array.from(x, (_, i) => sticks[i]),
    traction: () => Float64Array.from(x, (_, i) => size(i) * 1e-6),
    pressure: () => Float64Array.from(pressure, p => p * 1e-6),
    slip: () => Float64Array.from(x, (_, i) => (sticks[i] ? 0 : Math.hypot(sx[i], sy[i]))),
    power: () => Float64Array.from(x, (_, i) => (sticks[i] ? 0 : Math.abs(tx[i] * sx[i] + ty[i] * sy[i])) * 1e-6),
  }[quantity]();
  const unit = { stick: '', traction: 'MPa', pressure: 'MPa', slip: 'm/s', power: 'W/mm\u00b2' }[quantity];
  const most = Math.max(...values) || 1;
  const [a, b] = field.semi_axes;
  // The long axis lies across the picture: y to the right, rolling upwards, where the ellipse is longer across rolling.
  const turned = b > a;
  const [wide, high] = turned ? [b, a] : [a, b];
  const scale = Math.min((width - 230) / (2 * wide), (height - 90) / (2 * high));
  const cx = (width - 130) / 2 + 10, cy = height / 2 - 6;
  const point = (px, py) => (turned ? [cx + py * scale, cy - px * scale] : [cx + px * scale, cy - py * scale]);
  const spacing = array => { const sorted = [...new Set(Array.from(array, v => Number(v.toPrecision(4))))].sort((p, q) => p - q); let least = Infinity; for (let i = 1; i < sorted.length; i++) { const d = sorted[i] - sorted[i - 1]; if (d > 1e-3 * wide / 24) least = Math.min(least, d); } return least; };
  const dx = spacing(x), dy = spacing(y);
  const [w, v] = turned ? [dy * scale, dx * scale] : [dx * scale, dy * scale];
  const colours = { stick: isDark() ? ['#f08a3c', '#3f8fd2'] : ['#f2a35e', '#5aa2dc'] };
  c.save();
  c.beginPath();
  c.ellipse(cx, cy, (turned ? b : a) * scale, (turned ? a : b) * scale, 0, 0, 2 * Math.PI);
  c.clip();
  for (let i = 0; i < x.length; i++) {
    const [px, py] = point(x[i], y[i]);
    c.fillStyle = quantity === 'stick' ? colours.stick[sticks[i] ? 1 : 0] : viridisCss(values[i] / most);
    c.fillRect(px - w / 2 - 0.3, py - v / 2 - 0.3, w + 0.6, v + 0.6);
  }
  c.restore();
  c.strokeStyle = css('--ink');
  c.lineWidth = 1.5;
  c.beginPath();
  c.ellipse(cx, cy, (turned ? b : a) * scale, (turned ? a : b) * scale, 0, 0, 2 * Math.PI);
  c.stroke();
  // Arrows of the tractions, of some cells.
  const strongest = Math.max(...Array.from(x, (_, i) => size(i))) || 1;
  const every = Math.max(1, Math.round(x.length / 170));
  c.strokeStyle = c.fillStyle = quantity === 'stick' ? css('--ink') : 'rgb(255 255 255 / .9)';
  c.lineWidth = 1.1;
  const longest = Math.max(10, Math.sqrt(w * v * every) * 0.95);
  for (let i = 0; i < x.length; i += every) {
    const [px, py] = point(x[i], y[i]);
    const [ux, uy] = turned ? [ty[i], -tx[i]] : [tx[i], -ty[i]];
    const length = (longest * size(i)) / strongest;
    if (length < 1.5) continue;
    const [nx, ny] = [ux / size(i), uy / size(i)];
    const [qx, qy] = [px + (nx * length) / 2, py + (ny * length) / 2];
    c.beginPath(); c.moveTo(px - (nx * length) / 2, py - (ny * length) / 2); c.lineTo(qx, qy); c.stroke();
    c.beginPath(); c.moveTo(qx, qy); c.lineTo(qx - 4 * nx + 2 * ny, qy - 4 * ny - 2 * nx); c.lineTo(qx - 4 * nx - 2 * ny, qy - 4 * ny + 2 * nx); c.fill();
  }
  // Axes and scale.
  c.fillStyle = css('--ink-2');
  c.font = '13px system-ui';
  c.textAlign = 'center';
  c.fillText(turned ? `y, across rolling: \u00b1${digits(b * 1e6, 4)} \u00b5m` : `x, along rolling: \u00b1${digits(a * 1e6, 4)} \u00b5m`, cx, height - 10);
  c.save();
  c.translate(cx - wide * scale - 22, cy);
  c.rotate(-Math.PI / 2);
  c.fillText(turned ? `x, rolling \u2192 (\u00b1${digits(a * 1e6, 4)} \u00b5m)` : `y (\u00b1${digits(b * 1e6, 4)} \u00b5m)`, 0, 0);
  c.restore();
  c.textAlign = 'left';
  const right = width - 112;
  if (quantity === 'stick') {
    [['sticks', 1], ['slips', 0]].forEach(([text, i], k) => { c.fillStyle = colours.stick[i]; c.fillRect(right, 40 + 26 * k, 16, 16); c.fillStyle = css('--ink'); c.fillText(text, right + 24, 53 + 26 * k); });
  } else {
    const tall = height - 120;
    for (let k = 0; k < tall; k++) { c.fillStyle = viridisCss(1 - k / tall); c.fillRect(right, 40 + k, 16, 1.5); }
    c.fillStyle = css('--ink');
    c.fillText(`${digits(most, 3)} ${unit}`, right + 22, 50);
    c.fillText('0', right + 22, 40 + tall);
  }
  const text = `Ball ${field.ball}, ${field.race} race at ${digits(field.time * 1e3, 4)} ms: ${digits(100 * field.stick, 3)} % of the area sticks, peak pressure ${digits(Math.max(...pressure) * 1e-6, 4)} MPa, largest traction ${digits(strongest * 1e-6, 3)} MPa. Arrows: traction of the ball on the race.`;
  words.textContent = text;
  canvas.setAttribute('aria-label', text);
}
