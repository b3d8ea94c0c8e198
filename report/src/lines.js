// Frequencies that lines of spectra are named by: turns of shafts, meshes with their sidebands, cage and damage of bearings.

/** Multiples of a frequency that are drawn, and that peaks are named as: meshes ring on for longer. */
export const DRAWN = 3;
const OF_MESHES = 10;
/** Sidebands on either side of a mesh. */
const BANDS = 2;

const turnsOf = (run, name) => Math.abs(run.mean(name)) / (2 * Math.PI);
const moving = lines => lines.filter(line => line.frequency > 0);

/** Shafts of a machine with their turns [Hz], and its meshes with those of both shafts. */
function drive(run) {
  const shafts = run.shaft.shafts.map(shaft => ({ ...shaft, frequency: turnsOf(run, `${shaft.name}.speed`) }));
  const gears = shafts.flatMap(shaft => shaft.gears.map((gear, k) => ({ ...gear, shaft, number: k + 1 })));
  const meshes = run.shaft.meshes.map(name => {
    const [first, second] = gears.filter(gear => gear.mesh === name);
    return { name, frequency: first.teeth * first.shaft.frequency, shafts: [first.shaft, second.shaft], words: `mesh of ${first.teeth} teeth on ${first.shaft.name} and ${second.teeth} on ${second.shaft.name}` };
  });
  return { shafts, meshes, alone: gears.filter(gear => gear.teeth && !gear.mesh) };
}

/** Lines of a machine: a group of shafts and meshes, one of each mesh with its sidebands, one of each bearing. */
function ofMachine(run) {
  const { shafts, meshes, alone } = drive(run);
  const several = shafts.length > 1;
  const turns = shafts.map(({ name, frequency }) => ({ short: name, long: several ? `turns of ${name}` : 'turns of the shaft', frequency }));
  const teeth = [
    ...meshes.map(({ name, frequency, words }) => ({ short: name, long: words, frequency, rings: true })),
    ...alone.map(({ number, teeth: count, shaft }) => ({ short: `gear ${number}`, long: `${count} teeth that mesh`, frequency: count * shaft.frequency, rings: true })),
  ];
  const groups = [{ name: several ? 'shafts and meshes' : 'the shaft', lines: moving([...turns, ...teeth]) }];
  for (const mesh of meshes) groups.push({ name: `${mesh.name} and its sidebands`, lines: moving([{ short: mesh.name, long: mesh.words, frequency: mesh.frequency, rings: true }, ...mesh.shafts.flatMap(shaft => sidebands(mesh, shaft))]) });
  for (const { name, shaft } of run.shaft.bearings) {
    const own = run.mounted.get(name);
    if (own) groups.push({ name: `bearing ${name}`, lines: ofBearing(own, shafts.find(other => other.name === shaft).frequency) });
  }
  return { groups: groups.filter(group => group.lines.length), shaft: shafts[0].frequency };
}

/** What is modulated by the turns of a shaft stands beside the mesh. */
function sidebands(mesh, shaft) {
  const list = [];
  for (let k = 1; k <= BANDS; k++) {
    const turns = k === 1 ? shaft.name : `${k}\u2009\u00d7\u2009${shaft.name}`;
    for (const [sign, by] of [['+', k], ['\u2212', -k]]) list.push({ short: `${mesh.name} ${sign} ${turns}`, long: 'sideband', frequency: mesh.frequency + by * shaft.frequency, once: true });
  }
  return list;
}

/** Lines of a bearing whose shaft turns at a frequency [Hz]. */
function ofBearing(run, shaft) {
  const list = [
    ['FTF', 'cage', 'frequency.cage'], ['BPFO', 'balls over a place of the outer race', 'frequency.outer'],
    ['BPFI', 'balls over a place of the inner race', 'frequency.inner'], ['BSF', 'turns of a ball about itself', 'frequency.ball'],
  ].map(([short, long, name]) => ({ short, long, frequency: Math.abs(run.mean(name)) }));
  if (shaft > 0) list.unshift({ short: 'shaft', long: 'turns of the shaft', frequency: shaft });
  return moving(list);
}

/** Groups of lines of a run, each with a name, the one that a plot begins with first; and turns of its (first) shaft [Hz]. */
export function linesOf(run) {
  if (run.shaft) return ofMachine(run);
  const speeds = ['inner', 'outer'].map(race => turnsOf(run, `${race}.speed`));
  const own = run.bearing.loaded === 'inner' ? 0 : 1;
  const shaft = (speeds[own] > 0 ? speeds[own] : speeds[1 - own]) || 0;
  const groups = [{ name: 'this bearing', lines: ofBearing(run, shaft) }];
  // Teeth are heard in every bearing of their machine.
  if (run.of) groups.push(...ofMachine(run.of.shaft).groups.filter(({ name }) => !name.startsWith('bearing ')));
  return { groups: groups.filter(group => group.lines.length), shaft };
}

/** The line that a frequency is on, within half a distance of two frequencies of a spectrum and above its resolution [Hz]: of several that of the first group; null where it is on none. */
export function nameOf({ groups }, frequency, spacing, resolution) {
  for (const { lines } of groups) {
    for (const { short, frequency: base, once, rings } of lines) {
      // What comes hardly more than once in the window has no lines; where multiples stand close, any frequency is on one.
      if (base < resolution) continue;
      const multiple = Math.round(frequency / base);
      const most = once ? 1 : base < 8 * spacing ? 1 : rings ? OF_MESHES : DRAWN;
      if (multiple >= 1 && multiple <= most && Math.abs(frequency - multiple * base) <= 0.5 * spacing) return multiple === 1 ? short : `${multiple} \u00d7 ${short}`;
    }
  }
  return null;
}
