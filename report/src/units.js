// Units that are read easily, from SI.

/** Factor and unit in which a quantity of SI unit is shown, by its name and its largest size. */
export function shown(name, unit, largest = 0) {
  const small = (limit, factor, other, otherUnit) => (largest < limit ? [factor, other] : [1, otherUnit]);
  switch (unit) {
    case 'm': {
      if (/position|eccentricity|approach|gap|thickness|semi_axis|clearance|displacement|\.[xyz]$/.test(name) && largest < 2e-3) return [1e6, '\u00b5m'];
      return [1e3, 'mm'];
    }
    case 'rad':
      if (/angle|azimuth|turned/.test(name)) return [180 / Math.PI, '\u00b0'];
      // Tilts of shafts and housings are small.
      if (largest < 1e-3 && /tilt|rotation|\.r[xyz]$/.test(name) && !/^(inner|outer)\./.test(name)) return [1e6, '\u00b5rad'];
      return [1e3, 'mrad'];
    case 'Pa': return largest < 1e4 ? [1, 'Pa'] : [1e-6, 'MPa'];
    case 'N.m': return small(1, 1e3, 'N mm', 'N m');
    case 'W': return small(0.5, 1e3, 'mW', 'W');
    case 'm/s': return small(1e-2, 1e3, 'mm/s', 'm/s');
    case 'm/s2': return small(10, 1e3, 'mm/s\u00b2', 'm/s\u00b2');
    case 's': return [1e3, 'ms'];
    case 'J': return small(0.5, 1e3, 'mJ', 'J');
    case '1': return largest > 0 && largest < 0.02 ? [1e3, '10\u207b\u00b3'] : [1, ''];
    case '1/m': return [1, '1/m'];
    case 'Pa.s': return [1e3, 'mPa s'];
    default: return [1, unit ?? ''];
  }
}

/** A number in so many digits, without an exponent where that can be read. */
export function digits(value, count = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) {
    const [mantissa, exponent] = value.toExponential(Math.max(count - 2, 1)).split('e');
    const raised = [...String(Number(exponent))].map(c => (c === '-' ? '\u207b' : '\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079'[c])).join('');
    return `${minus(mantissa)}\u00b710${raised}`;
  }
  const decimals = Math.max(0, Math.min(count - 1 - Math.floor(Math.log10(size)), 6));
  return minus(value.toFixed(decimals));
}

const minus = text => text.replace('-', '\u2212');

/** A value with the unit that suits it. */
export function withUnit(value, name, unit, count = 4) {
  if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
  const [factor, text] = shown(name, unit, Math.abs(value));
  return `${digits(value * factor, count)}${text ? '\u202f' + text : ''}`;
}

/** Revolutions per minute of rad/s. */
export const rpm = speed => `${digits(speed * 30 / Math.PI, 5).replace(/(\.\d*?)0+$/, '$1').replace(/\.$/, '')}\u202frpm`;
