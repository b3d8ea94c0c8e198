// Inputs of the page, the link that holds them, and the scene that they make.

/** Inputs with their first values; `when` says of which of both ways to name a bearing they are. */
export const FIELDS = [
  { key: 'by', label: 'bearing by its', first: 'name', texts: [['name', 'name'], ['size', 'dimensions and load ratings']] },
  { key: 'name', label: 'name as on the box', first: '6205', when: 'name' },
  { key: 'bore', label: 'bore', unit: 'mm', first: '25', when: 'size' },
  { key: 'outside', label: 'outside diameter', unit: 'mm', first: '52', when: 'size' },
  { key: 'width', label: 'width', unit: 'mm', first: '15', when: 'size' },
  { key: 'c', label: 'dynamic load rating C', unit: 'kN', first: '14', when: 'size' },
  { key: 'c0', label: 'static load rating C0', unit: 'kN', first: '7.85', when: 'size' },
  { key: 'angle', label: 'contact angle, 0 of deep groove', unit: 'deg', first: '0', when: 'size' },
  { key: 'radial', label: 'radial load', unit: 'N', first: '1400', from: 0, to: 10000, step: 10 },
  { key: 'axial', label: 'axial load', unit: 'N', first: '0', from: 0, to: 10000, step: 10 },
  { key: 'tilt', label: 'tilt of the inner ring', unit: 'mrad', first: '0', from: 0, to: 5, step: 0.05 },
  { key: 'speed', label: 'speed', unit: 'rpm', first: '6000', from: 0, to: 30000, step: 100 },
  { key: 'oil', label: 'oil', first: '68', texts: [['', 'none: dry'], ...['10', '22', '32', '46', '68', '100', '150', '220', '320', '460'].map(grade => [grade, `ISO VG ${grade}`])] },
  { key: 'temperature', label: 'temperature of the oil', unit: 'degC', first: '70', from: 0, to: 150, step: 1 },
];

/** Inputs of a link; what it does not name has its first value. */
export function fromHash(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ''));
  return Object.fromEntries(FIELDS.map(({ key, first }) => [key, given.get(key) ?? first]));
}

/** A link to inputs. */
export const toHash = values => `#${new URLSearchParams(FIELDS.filter(({ key, first }) => values[key] !== first).map(({ key }) => [key, values[key]]))}`;

/** Arguments of `roulement bearing`. */
export function bearingOf(values) {
  if (values.by !== 'size') return values.name.trim().split(/\s+/);
  const size = [['bore', 'bore', 'mm'], ['outside', 'outside', 'mm'], ['width', 'width', 'mm'], ['dynamic-load-rating', 'c', 'kN'], ['static-load-rating', 'c0', 'kN']].flatMap(([option, key, unit]) => [`--${option}`, `${values[key]} ${unit}`]);
  return Number(values.angle) ? [...size, '--contact-angle', `${values.angle} deg`] : size;
}

/** The scene of a catalogue bearing under the page's loads, in its oil, for a time [s] with two rows, or for 2 ms. */
export function sceneOf(text, values, duration) {
  const [bearing] = text.split('# An example, to be changed');
  const load = [
    '[load]',
    duration === undefined ? 'duration = "2 ms"\noutput_interval = "10 us"' : `duration = ${duration}\noutput_interval = ${duration}`,
    `inner_speed = "${values.speed} rpm"`,
    `y = { force = "${values.radial} N" }`,
    // A ring that no axial force presses is held along its axis.
    Number(values.axial) ? `x = { force = "${values.axial} N" }` : 'x = { displacement = 0.0 }',
    'ry = { rotation = 0.0 }',
    `rz = { rotation = "${values.tilt} mrad" }`,
  ];
  const film = values.oil ? ['', '[film]', `iso_vg = ${values.oil}`, `temperature = "${values.temperature} degC"`] : [];
  return `${bearing.replace('[effects]\n', '[effects]\nfrequency_outputs = true       # chosen: frequencies of its parts\nper_ball_outputs = true        # chosen: axes of the contact ellipses\n')}${[...load, ...film].join('\n')}\n`;
}
