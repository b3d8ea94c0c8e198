// What the page has: columns of numbers, runs, sweeps.

async function inflated(text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Columns of equal length: name -> { unit, values }. Bytes of the same place of all rows stand side by side. */
export async function readGrid(json) {
  const rows = json.rows;
  const columns = new Map();
  for (const [name, unit, value] of json.constant) {
    columns.set(name, { unit, values: new Float64Array(rows).fill(value ?? NaN), constant: true });
  }
  const bytes = await inflated(json.data);
  let at = 0;
  for (const [name, unit, offset] of json.moving) {
    const size = offset === 'f64' ? 8 : 4;
    const block = new Uint8Array(rows * size);
    for (let place = 0; place < size; place++) {
      for (let row = 0; row < rows; row++) block[row * size + place] = bytes[at + place * rows + row];
    }
    at += rows * size;
    const raw = size === 8 ? new Float64Array(block.buffer) : Float64Array.from(new Float32Array(block.buffer), v => v + offset);
    columns.set(name, { unit, values: raw });
  }
  return { rows, columns };
}

/** Place of the last row at or before a time. */
export function rowAt(times, t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= t) low = middle; else high = middle - 1;
  }
  return low;
}

/** Value at a time, on the line between two rows. */
export function valueAt({ t, v }, time) {
  const i = rowAt(t, time);
  if (i + 1 >= t.length || time <= t[i]) return v[i];
  const x = (time - t[i]) / (t[i + 1] - t[i]);
  return v[i] + x * (v[i + 1] - v[i]);
}

/** A run: its record, and its columns over time. */
export class Run {
  static async of(record, index) {
    const run = new Run();
    run.index = index;
    run.record = record;
    // One of both.
    run.bearing = record.bearing;
    run.shaft = record.shaft;
    // Runs of the bearings of a shaft by their names (machine.js).
    run.mounted = new Map();
    run.name = record.name;
    run.title = record.title || record.name || (record.shaft ? 'shaft' : 'ball bearing');
    run.grids = [];
    for (const grid of [...record.tables, record.history]) run.grids.push(await readGrid(grid));
    run.series = new Map();
    // The table comes first: it may have more rows.
    for (const grid of run.grids) {
      const t = grid.columns.get('time')?.values;
      if (!t) continue;
      for (const [name, { unit, values, constant }] of grid.columns) {
        if (name !== 'time' && !run.series.has(name)) run.series.set(name, { name, unit, t, v: values, constant });
      }
    }
    for (const [name, { unit, t, v, constant }] of [...run.series]) {
      const acceleration = name.replace(/\.velocity\.([xyz])$/, '.acceleration.$1');
      if (acceleration === name || unit !== 'm/s' || run.series.has(acceleration) || t.length < 2) continue;
      // By how much it has changed since the row before: none comes before the first.
      const values = Float64Array.from(v, (_, i) => (i && t[i] > t[i - 1] ? (v[i] - v[i - 1]) / (t[i] - t[i - 1]) : 0));
      run.series.set(acceleration, { name: acceleration, unit: 'm/s2', t, v: values, constant });
    }
    run.history = run.grids.at(-1);
    run.times = run.history.columns.get('time').values;
    run.begin = run.times[0];
    run.end = run.times[run.times.length - 1];
    run.fields = [];
    for (const field of record.fields ?? []) run.fields.push({ ...field, cells: (await readGrid(field.cells)).columns });
    return run;
  }

  has(name) { return this.series.has(name); }

  get(name) { return this.series.get(name); }

  /** Value of a column at a time; not a number where there is no such column. */
  at(name, time) {
    const series = this.series.get(name);
    return series ? valueAt(series, time) : NaN;
  }

  /** Mean over the second half, of what is made of each value. */
  mean(name, of = value => value) {
    const series = this.series.get(name);
    if (!series) return NaN;
    const from = this.begin + 0.5 * (this.end - this.begin);
    let sum = 0, count = 0;
    for (let i = 0; i < series.t.length; i++) {
      const value = of(series.v[i]);
      if (series.t[i] >= from && Number.isFinite(value)) { sum += value; count++; }
    }
    return count ? sum / count : NaN;
  }

  /** Least and largest value. */
  range(name) {
    const series = this.series.get(name);
    let low = Infinity, high = -Infinity;
    if (series) for (const v of series.v) { if (v < low) low = v; if (v > high) high = v; }
    return [low, high];
  }

  /** Is a column 0 throughout, or not there? */
  isNothing(name) {
    const [low, high] = this.range(name);
    return !(high - low > 0) && (low === 0 || !Number.isFinite(low));
  }

  /** Names of a quantity of every ball: `ball[1].inner.load`, and so on. */
  ofBalls(quantity) {
    const names = Array.from({ length: this.bearing.balls }, (_, i) => `ball[${i + 1}].${quantity}`);
    return names.filter(name => this.has(name));
  }

  /** Azimuth of a ball at a time, the shorter way between two rows. */
  azimuth(ball, time) {
    const series = this.series.get(`ball[${ball}].azimuth`);
    if (!series) return 0;
    const i = rowAt(series.t, time);
    const from = series.v[i];
    if (i + 1 >= series.t.length) return from;
    let step = series.v[i + 1] - from;
    step -= 2 * Math.PI * Math.round(step / (2 * Math.PI));
    return from + step * Math.min(Math.max((time - series.t[i]) / (series.t[i + 1] - series.t[i]), 0), 1);
  }
}
