//! Numbers on a grid to a millionth, in few bytes: those of neighbouring nodes lie close to each other.
//!
//! Numbers are rounded to multiples of [`RESOLUTION`]; differences along every axis of the grid are kept as whole numbers, function by
//! function. They have the code of Rice: the low bits as they are, and what is above them as that many zeros and a one. Groups of sixteen
//! numbers say before how many low bits they have. (R. F. Rice, Some practical universal noiseless coding techniques, JPL 79-22, 1979.)

/// [-] step of the numbers, 4.8e-7 at most beside what they were: a thousandth of what the table is off by between its nodes.
pub const RESOLUTION: f64 = 1.0 / (1 << 20) as f64;

/// Numbers that share their count of low bits.
const GROUP: usize = 16;
/// Bits of that count.
const HEADER: u32 = 5;

/// Places of a grid's numbers function by function, where they are node by node: the last axis is that of the functions of a node.
fn by_function<const N: usize>(shape: [usize; N]) -> impl Iterator<Item = usize> {
    let functions = shape[N - 1];
    let nodes: usize = shape[..N - 1].iter().product();
    (0..functions).flat_map(move |function| (0..nodes).map(move |node| node * functions + function))
}

/// Axes of the nodes: how far neighbours along each lie apart in the list of a function, and how long a row of it is.
fn axes<const N: usize>(shape: [usize; N]) -> impl DoubleEndedIterator<Item = (usize, usize)> {
    (0..N - 1).map(move |axis| {
        let stride: usize = shape[axis + 1..N - 1].iter().product();
        (stride, stride * shape[axis])
    })
}

/// Reads bits, the lowest of a byte first; behind the end they are 1.
struct Bits<'a> {
    bytes: &'a [u8],
    waiting: u64,
    count: u32,
}

impl Bits<'_> {
    /// Has 32 bits or more waiting.
    fn fill(&mut self) {
        while self.count <= 56 {
            let (next, rest) =
                self.bytes.split_first().map_or((u8::MAX, self.bytes), |(one, rest)| (*one, rest));
            self.waiting |= u64::from(next) << self.count;
            (self.bytes, self.count) = (rest, self.count + 8);
        }
    }

    /// As many as there are up to 32.
    fn take(&mut self, bits: u32) -> u32 {
        self.fill();
        let taken = self.waiting & ((1 << bits) - 1);
        (self.waiting, self.count) = (self.waiting >> bits, self.count - bits);
        taken as u32
    }

    /// Zeros before the next one, which is taken with them.
    fn zeros(&mut self) -> u32 {
        let mut zeros = 0;
        loop {
            self.fill();
            let run = self.waiting.trailing_zeros().min(31);
            self.take(run);
            zeros += run;
            if run < 31 {
                self.take(1);
                return zeros;
            }
        }
    }
}

/// The numbers of a grid of this shape, whose last axis is that of the values of a node, from their packed bytes.
pub fn unpacked<const N: usize>(bytes: &[u8], shape: [usize; N]) -> Vec<f32> {
    let count: usize = shape.iter().product();
    let mut bits = Bits { bytes, waiting: 0, count: 0 };
    let mut whole: Vec<i32> = Vec::with_capacity(count + GROUP);
    while whole.len() < count {
        let low = bits.take(HEADER);
        for _ in 0..GROUP {
            let folded = bits.zeros() << low | bits.take(low);
            whole.push((folded >> 1) as i32 ^ -((folded & 1) as i32));
        }
    }
    whole.truncate(count);
    for (stride, row) in axes(shape).rev() {
        for row in whole.chunks_exact_mut(row) {
            for i in stride..row.len() {
                row[i] = row[i].wrapping_add(row[i - stride]);
            }
        }
    }
    let mut numbers = vec![0.0; count];
    for (whole, place) in whole.into_iter().zip(by_function(shape)) {
        numbers[place] = (f64::from(whole) * RESOLUTION) as f32;
    }
    numbers
}

/// The packed bytes of the numbers of a grid of this shape, whose last axis is that of the values of a node; none if one is not finite or
/// larger than 16.
pub fn packed<const N: usize>(numbers: &[f32], shape: [usize; N]) -> Option<Vec<u8>> {
    if !numbers.iter().all(|number| number.abs() <= 16.0) {
        return None;
    }
    let mut whole: Vec<i32> =
        by_function(shape).map(|place| (f64::from(numbers[place]) / RESOLUTION).round() as i32).collect();
    for (stride, row) in axes(shape) {
        for row in whole.chunks_exact_mut(row) {
            for i in (stride..row.len()).rev() {
                row[i] = row[i].wrapping_sub(row[i - stride]);
            }
        }
    }
    let folded: Vec<u32> = whole.iter().map(|number| (number << 1 ^ number >> 31) as u32).collect();
    let mut bits = vec![];
    let mut put = |value: u32, count: u32| bits.extend((0..count).map(|bit| value >> bit & 1));
    for group in folded.chunks(GROUP) {
        let length = |low: u32| group.iter().map(|one| u64::from(one >> low) + u64::from(low)).sum::<u64>();
        let low = (0..1 << HEADER).min_by_key(|low| length(*low)).unwrap_or_default();
        put(low, HEADER);
        for index in 0..GROUP {
            let one = group.get(index).copied().unwrap_or_default();
            (0..one >> low).for_each(|_| put(0, 1));
            put(1, 1);
            put(one, low);
        }
    }
    Some(bits.chunks(8).map(|eight| eight.iter().rev().fold(0, |byte, bit| byte << 1 | *bit as u8)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_multiples_of_the_resolution_are_the_same_bits_again() {
        let sizes = (-20..4).flat_map(|power| [1.0f32, -1.5].map(|one| one * 2f32.powi(power)));
        let smooth = (0..573).map(|k| (0.01 * k as f32).sin());
        let spikes = [0.0, 16.0, -16.0, RESOLUTION as f32];
        let numbers: Vec<f32> = sizes.chain(smooth).chain(spikes).collect();
        assert_eq!(numbers.len(), 625);
        for shape in [[25, 25, 1], [5, 25, 5], [125, 1, 5], [1, 625, 1]] {
            let once = unpacked(&packed(&numbers, shape).unwrap(), shape);
            for (one, before) in once.iter().zip(&numbers) {
                assert!(f64::from((one - before).abs()) <= 0.5 * RESOLUTION, "{before} became {one}");
            }
            let twice = unpacked(&packed(&once, shape).unwrap(), shape);
            assert!(once.iter().map(|one| one.to_bits()).eq(twice.iter().map(|one| one.to_bits())));
        }
    }

    #[test]
    fn invariant_what_is_no_number_of_the_grid_is_refused() {
        for number in [f32::NAN, f32::INFINITY, 17.0, -17.0] {
            assert!(packed(&[0.0, number], [1, 2, 1]).is_none(), "{number}");
        }
    }

    #[test]
    fn consistency_smooth_numbers_take_less() {
        let numbers: Vec<f32> =
            (0..40 * 30).map(|k| (0.1 * (k % 30) as f32).sin() + (k / 30) as f32 / 30.0).collect();
        assert!(packed(&numbers, [40, 30, 1]).unwrap().len() < 2 * numbers.len());
    }
}
