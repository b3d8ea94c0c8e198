//! Numbers of single precision of a few sizes, packed without loss: signs and exponents are nearly all among fifteen.
//!
//! Of each number the last three bytes are kept, and in half a byte which of the commonest first bytes it has. The fifteen come first, then
//! the halves, two a byte, then the three bytes each, then the first bytes of those numbers that have another.

/// Number of the commonest first bytes; also what stands for another one.
const COMMON: usize = 15;

/// The numbers of packed bytes, an even count of them.
pub fn unpacked(bytes: &[u8], count: usize) -> Vec<f32> {
    let (common, rest) = bytes.split_at(COMMON);
    let (halves, rest) = rest.split_at(count / 2);
    let (last, other) = rest.split_at(3 * count);
    let mut other = other.iter();
    let first = halves.iter().flat_map(|two| [two & 15, two >> 4]);
    let number = |(which, last): (u8, &[u8])| {
        let first = common.get(usize::from(which)).or_else(|| other.next());
        f32::from_le_bytes([last[0], last[1], last[2], first.copied().unwrap_or(0)])
    };
    first.zip(last.chunks_exact(3)).map(number).collect()
}

/// The packed bytes of an even count of numbers.
pub fn packed(numbers: &[f32]) -> Vec<u8> {
    let bytes: Vec<[u8; 4]> = numbers.iter().map(|number| number.to_le_bytes()).collect();
    let mut often = [0usize; 256];
    bytes.iter().for_each(|[.., first]| often[usize::from(*first)] += 1);
    let mut common: Vec<u8> = (0..=u8::MAX).collect();
    common.sort_by_key(|first| std::cmp::Reverse(often[usize::from(*first)]));
    common.truncate(COMMON);
    let which = |[.., first]: &[u8; 4]| common.iter().position(|one| one == first).unwrap_or(COMMON) as u8;
    let halves = bytes.chunks_exact(2).map(|two| which(&two[0]) | which(&two[1]) << 4);
    let last = bytes.iter().flat_map(|[a, b, c, _]| [*a, *b, *c]);
    let other = bytes.iter().filter(|number| usize::from(which(number)) == COMMON).map(|[.., first]| *first);
    common.iter().copied().chain(halves).chain(last).chain(other).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_numbers_of_all_sizes_are_the_same_bits_again() {
        let sizes = (-30..30).flat_map(|power| [1.3f32, -1.9].map(|one| one * 2f32.powi(power)));
        let usual = (0..500).map(|k| (k as f32).sin());
        let numbers: Vec<f32> = sizes.chain(usual).chain([0.0, -0.0]).collect();
        let back = unpacked(&packed(&numbers), numbers.len());
        assert!(back.iter().map(|one| one.to_bits()).eq(numbers.iter().map(|one| one.to_bits())));
    }
}
