// Loads, contact angles and pressure of all balls over their azimuth, at the time of the clock.

import { s, h, section, choice } from './dom.js';
import { clock } from './clock.js';
import { colour, onTheme } from './theme.js';
import { digits, shown } from './units.js';

const SIZE = 440, C = SIZE / 2, R = 168;
const RACES = ['inner', 'outer'];
const QUANTITIES = [['load', 'Load'], ['contact_angle', 'Contact angle'], ['peak_pressure', 'Peak pressure'], ['power', 'Friction power']];

export function polar(run) {
  const panels = [picture(run, 'load'), picture(run, 'contact_angle')];
  const holders = panels.map(panel => h('figure', {}, panel.svg, panel.caption));
  const choose = i => choice('Quantity of the polar plot', QUANTITIES.filter(([name]) => run.has(`ball[1].inner.${name}`)), ['load', 'contact_angle'][i], name => {
    panels[i].stop();
    panels[i] = picture(run, name);
    holders[i].replaceChildren(choose.boxes[i], panels[i].svg, panels[i].caption);
  });
  choose.boxes = [0, 1].map(choose);
  holders.forEach((holder, i) => holder.prepend(choose.boxes[i]));
  return section('polar', 'Balls over azimuth',
    h('p', { class: 'note' }, 'Every ball at the time of the cursor, seen from +x; pale bands: all that the run has at that azimuth. Blue: inner race, orange: outer race.'),
    h('div', { class: 'pair' }, holders));
}

function ring(text, radius, label) {
  return [s('circle', { cx: C, cy: C, r: radius, class: 'grid' }), s('text', { x: C + 4, y: C - radius + 12, class: 'tick' }, text), label];
}

/** A round number at or above a value. */
export function round(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * [1, 1.5, 2, 3, 4, 5, 6, 8, 10].find(step => step * power >= value * 0.9999);
}

function picture(run, quantity) {
  const names = race => run.ofBalls(`${race}.${quantity}`);
  const ranges = RACES.flatMap(race => names(race).map(name => run.range(name)));
  let low = Math.min(...ranges.map(range => range[0]), 0), high = Math.max(...ranges.map(range => range[1]));
  if (!(high > low)) high = low + 1;
  const unit = run.get(names('inner')[0])?.unit;
  const [factor, word] = shown(quantity, unit, Math.max(Math.abs(low), Math.abs(high)));
  const top = round(high * factor || 1);
  const bottom = low < -1e-6 * high ? -round(-low * factor) : 0;
  const radius = value => R * Math.min(Math.max((value * factor - bottom) / (top - bottom), 0), 1.05);
  const point = (azimuth, value) => [C + radius(value) * Math.cos(azimuth), C - radius(value) * Math.sin(azimuth)];
  const svg = s('svg', { viewBox: `0 0 ${SIZE} ${SIZE}`, class: 'polar', role: 'img', 'aria-label': `${quantity.replace('_', ' ')} of all balls over azimuth` });
  for (let k = 1; k <= 4; k++) svg.append(...ring(digits(bottom + ((top - bottom) * k) / 4, 3), (R * k) / 4).filter(Boolean));
  for (let degrees = 0; degrees < 360; degrees += 30) {
    const a = (degrees * Math.PI) / 180;
    svg.append(s('line', { x1: C, y1: C, x2: C + R * Math.cos(a), y2: C - R * Math.sin(a), class: 'grid' }));
    svg.append(s('text', { x: C + (R + 20) * Math.cos(a), y: C - (R + 20) * Math.sin(a) + 4, class: 'tick', 'text-anchor': 'middle' }, degrees === 0 ? '+y 0\u00b0' : degrees === 90 ? '+z 90\u00b0' : `${degrees}\u00b0`));
  }
  svg.append(s('text', { x: 8, y: 18, class: 'tick strong' }, `${quantity.replace('_', ' ')} [${word || '1'}]`));
  // What the whole run has, in sectors of azimuth.
  const SECTORS = 72;
  RACES.forEach((race, k) => {
    const least = new Array(SECTORS).fill(Infinity), most = new Array(SECTORS).fill(-Infinity);
    for (let ball = 1; ball <= run.bearing.balls; ball++) {
      const series = run.get(`ball[${ball}].${race}.${quantity}`), azimuths = run.get(`ball[${ball}].azimuth`);
      if (!series || !azimuths || series.t !== azimuths.t) continue;
      const skip = Math.floor(series.v.length * 0.1);
      for (let i = skip; i < series.v.length; i++) {
        const sector = ((Math.floor((azimuths.v[i] / (2 * Math.PI)) * SECTORS) % SECTORS) + SECTORS) % SECTORS;
        least[sector] = Math.min(least[sector], series.v[i]);
        most[sector] = Math.max(most[sector], series.v[i]);
      }
    }
    const d = least.map((value, i) => {
      if (!Number.isFinite(value)) return '';
      const [a, b] = [i, i + 1].map(n => (2 * Math.PI * n) / SECTORS);
      const corners = [point(a, value), point(b, value), point(b, most[i]), point(a, most[i])];
      return `M${corners.map(p => p.map(x => x.toFixed(1)).join(' ')).join('L')}Z`;
    }).join('');
    svg.append(s('path', { d, class: `band race-${k}` }));
  });
  const shapes = RACES.map((race, k) => {
    const line = s('path', { class: `polar-line race-${k}` });
    const dots = names(race).map(() => s('circle', { r: k === 0 ? 5 : 4, class: `polar-dot race-${k}` }));
    svg.append(line, ...dots);
    return { race, line, dots };
  });
  const caption = h('figcaption', {});
  let stopped = false, inSight = true;
  const draw = () => {
    if (stopped || !inSight) return;
    const words = [];
    for (const { race, line, dots } of shapes) {
      const places = [];
      let [least, most] = [Infinity, -Infinity];
      dots.forEach((dot, i) => {
        const azimuth = run.azimuth(i + 1, clock.time), value = run.at(`ball[${i + 1}].${race}.${quantity}`, clock.time);
        const [x, y] = point(azimuth, value);
        dot.setAttribute('cx', x.toFixed(2));
        dot.setAttribute('cy', y.toFixed(2));
        places.push([(azimuth + 4 * Math.PI) % (2 * Math.PI), x, y]);
        least = Math.min(least, value);
        most = Math.max(most, value);
      });
      places.sort((a, b) => a[0] - b[0]);
      line.setAttribute('d', places.length > 2 ? `M${places.map(p => `${p[1].toFixed(2)} ${p[2].toFixed(2)}`).join('L')}Z` : '');
      words.push(`${race} ${digits(least * factor, 4)} to ${digits(most * factor, 4)} ${word}`);
    }
    caption.textContent = words.join(' \u00b7 ');
  };
  clock.follow(draw);
  new IntersectionObserver(([change]) => { inSight = change.isIntersecting; draw(); }, { rootMargin: '100px' }).observe(svg);
  return { svg, caption, stop() { stopped = true; } };
}
