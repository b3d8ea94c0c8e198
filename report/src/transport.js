// The bar at the bottom: play, scrub, speed.

import { h } from './dom.js';
import { clock } from './clock.js';
import { digits } from './units.js';

export function transport() {
  const button = h('button', { type: 'button', class: 'play', id: 'play', onclick: () => clock.toggle() });
  const slider = h('input', { type: 'range', id: 'scrub', min: 0, max: 10000, step: 1, 'aria-label': 'Time of the run', oninput: () => clock.seek(clock.begin + (clock.end - clock.begin) * slider.value / 10000) });
  const text = h('output', { id: 'time', for: 'scrub' });
  const speeds = [1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.3, 1];
  // A run takes some ten seconds unless it is faster than that by itself.
  const usual = Math.min((clock.end - clock.begin) / 10, 1);
  const nearest = speeds.reduce((best, speed) => (Math.abs(Math.log(speed / usual)) < Math.abs(Math.log(best / usual)) ? speed : best));
  clock.speed = nearest;
  const speed = h('select', { id: 'speed', 'aria-label': 'Speed of the playback', onchange: () => { clock.speed = Number(speed.value); } },
    speeds.map(value => h('option', { value, selected: value === nearest }, value >= 1 ? 'as fast as the run' : `${digits(1 / value, 3)} times slower`)));
  const bar = h('div', { class: 'transport', role: 'group', 'aria-label': 'Playback' }, button, slider, text, speed);
  clock.follow(() => {
    const label = clock.playing ? 'Pause' : 'Play';
    if (button.getAttribute('aria-label') !== label) { button.setAttribute('aria-label', label); button.textContent = clock.playing ? '\u275a\u275a' : '\u25b6'; }
    slider.value = Math.round((10000 * (clock.time - clock.begin)) / (clock.end - clock.begin || 1));
    const words = `${digits(clock.time * 1e3, 5)} ms`;
    text.textContent = words;
    slider.setAttribute('aria-valuetext', words);
  });
  // Keys for the whole page, but not while something is written or chosen.
  addEventListener('keydown', event => {
    if (event.target.closest?.('input, select, textarea, button, summary, [role=button]') || event.ctrlKey || event.metaKey || event.altKey) return;
    const step = (clock.end - clock.begin) / (event.shiftKey ? 20 : 500);
    if (event.key === ' ') clock.toggle();
    else if (event.key === 'ArrowRight') clock.seek(clock.time + step);
    else if (event.key === 'ArrowLeft') clock.seek(clock.time - step);
    else if (event.key === 'Home') clock.seek(clock.begin);
    else if (event.key === 'End') clock.seek(clock.end);
    else return;
    event.preventDefault();
  });
  return bar;
}
