//! Numbers of single precision on a grid, packed without loss: values of neighbouring nodes lie close to each other.
//!
//! Numbers are taken for whole ones in their own order, and their differences along the axes of the grid are kept, the small ones in
//! fewer bytes: first how many bytes each difference has, four to a byte, then these bytes, then three of nothing, so that four can be read
//! anywhere.

/// Axes along which differences are taken, one twice: the order with the fewest bytes for the table of Kalker's theory.
fn axes<const N: usize>(shape: [usize; N]) -> impl DoubleEndedIterator<Item = (usize, usize)> {
    let innermost = N.saturating_sub(2);
    (0..=innermost).chain([innermost]).map(move |axis| {
        let stride: usize = shape[axis + 1..].iter().product();
        (stride, stride * shape[axis])
    })
}

/// The bits of a number as a whole number that grows with it, and the other way round.
fn in_order(bits: i32) -> i32 {
    if bits < 0 { bits ^ i32::MAX } else { bits }
}

/// The numbers of a grid of this shape, whose last axis is that of the values of a node, from their packed bytes.
pub fn unpacked<const N: usize>(bytes: &[u8], shape: [usize; N]) -> Vec<f32> {
    let count: usize = shape.iter().product();
    let (lengths, mut rest) = bytes.split_at(count.div_ceil(4));
    let mut numbers = Vec::with_capacity(count + 3);
    for four in lengths {
        for place in [0, 2, 4, 6] {
            let length = four >> place & 3;
            let four = rest.first_chunk().copied().unwrap_or_default();
            let folded = u32::from_le_bytes(four) & u32::MAX >> (8 * (3 - length));
            numbers.push((folded >> 1) as i32 ^ -((folded & 1) as i32));
            rest = rest.get(usize::from(length) + 1..).unwrap_or_default();
        }
    }
    numbers.truncate(count);
    for (stride, row) in axes(shape).rev() {
        for row in numbers.chunks_exact_mut(row) {
            for i in stride..row.len() {
                row[i] = row[i].wrapping_add(row[i - stride]);
            }
        }
    }
    numbers.into_iter().map(|number| f32::from_bits(in_order(number) as u32)).collect()
}

/// The packed bytes of the numbers of a grid of this shape, whose last axis is that of the values of a node.
pub fn packed<const N: usize>(numbers: &[f32], shape: [usize; N]) -> Vec<u8> {
    let mut numbers: Vec<i32> = numbers.iter().map(|number| in_order(number.to_bits() as i32)).collect();
    for (stride, row) in axes(shape) {
        for row in numbers.chunks_exact_mut(row) {
            for i in (stride..row.len()).rev() {
                row[i] = row[i].wrapping_sub(row[i - stride]);
            }
        }
    }
    let folded: Vec<u32> = numbers.iter().map(|number| (number << 1 ^ number >> 31) as u32).collect();
    let length = |folded: u32| (u32::BITS - folded.leading_zeros()).div_ceil(8).max(1) as usize;
    let lengths = folded.chunks(4).map(|four| {
        four.iter().zip([0, 2, 4, 6]).map(|(folded, place)| (length(*folded) as u8 - 1) << place).sum()
    });
    let differences = folded.iter().flat_map(|folded| folded.to_le_bytes().into_iter().take(length(*folded)));
    lengths.chain(differences).chain([0; 3]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_numbers_of_all_sizes_are_the_same_bits_again() {
        let sizes = (-30..30).flat_map(|power| [1.3f32, -1.9].map(|one| one * 2f32.powi(power)));
        let usual = (0..509).map(|k| (k as f32).sin());
        let extremes = [0.0, -0.0, f32::MAX, f32::MIN, f32::INFINITY, f32::NAN, f32::MIN_POSITIVE];
        let numbers: Vec<f32> = sizes.chain(usual).chain(extremes).collect();
        for shape in [[4, 53, 3], [2, 106, 3], [53, 4, 3]] {
            let back = unpacked(&packed(&numbers, shape), shape);
            assert!(
                back.iter().map(|one| one.to_bits()).eq(numbers.iter().map(|one| one.to_bits())),
                "{shape:?}"
            );
        }
    }

    #[test]
    fn consistency_smooth_numbers_take_less() {
        let numbers: Vec<f32> =
            (0..40 * 30).map(|k| (0.1 * (k % 30) as f32).sin() + (k / 30) as f32).collect();
        assert!(packed(&numbers, [40, 30, 1]).len() < 3 * numbers.len());
    }
}
