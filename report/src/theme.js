// Colours of both themes, for what is not drawn by CSS.

/** Colour-blind safe (Okabe and Ito), a little lighter on dark ground. */
const LIGHT = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#b07c00', '#3a9bd9', '#6b7280'];
const DARK = ['#56b4e9', '#ff9a4d', '#3ddba6', '#e9a3cb', '#f0c452', '#8fc9f5', '#a3adba'];

const listeners = new Set();
const media = matchMedia('(prefers-color-scheme: dark)');
let chosen = null;

export const isDark = () => (chosen ?? (media.matches ? 'dark' : 'light')) === 'dark';

function apply() {
  document.documentElement.dataset.theme = isDark() ? 'dark' : 'light';
  for (const listener of listeners) listener();
}

media.addEventListener('change', apply);

export function toggleTheme() {
  chosen = isDark() ? 'light' : 'dark';
  apply();
}

export function onTheme(listener) { listeners.add(listener); }

export function startTheme() { apply(); }

/** Value of a CSS variable. */
export const css = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export const colour = index => (isDark() ? DARK : LIGHT)[index % 7];

/** Colour of one of many balls: around the circle of hues. */
export const ballColour = (ball, balls) =>
  `hsl(${Math.round((360 * (ball - 1)) / balls + 205) % 360} ${isDark() ? '75% 66%' : '70% 42%'})`;

/** Viridis at a share from 0 to 1, as [r, g, b] from 0 to 1 (Smith and van der Walt, matplotlib; public domain). */
const VIRIDIS = [[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]];

export function viridis(share) {
  const x = Math.min(Math.max(Number.isFinite(share) ? share : 0, 0), 1) * (VIRIDIS.length - 1);
  const i = Math.min(Math.floor(x), VIRIDIS.length - 2);
  return [0, 1, 2].map(k => (VIRIDIS[i][k] + (x - i) * (VIRIDIS[i + 1][k] - VIRIDIS[i][k])) / 255);
}

export const viridisCss = share => `rgb(${viridis(share).map(c => Math.round(255 * c)).join(' ')})`;
