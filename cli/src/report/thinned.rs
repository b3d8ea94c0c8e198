//! A bounded, even selection of the rows of a run, for plots.

/// [-] rows that a curve is drawn through at most: more than a plot has pixels across.
const MOST: usize = 1024;

/// Every n-th of the items seen, where n is the least power of two that keeps their number bounded; and the last.
#[derive(Clone, Debug)]
pub struct Thinned<T> {
    kept: Vec<T>,
    stride: u64,
    seen: u64,
    last: Option<T>,
}

impl<T> Default for Thinned<T> {
    fn default() -> Self {
        Self { kept: vec![], stride: 1, seen: 0, last: None }
    }
}

impl<T> Thinned<T> {
    /// Adds an item.
    pub fn push(&mut self, item: T) {
        if self.seen.is_multiple_of(self.stride) {
            if self.kept.len() == MOST {
                let mut even = false;
                self.kept.retain(|_| {
                    even = !even;
                    even
                });
                self.stride *= 2;
            }
            // The item at which the list is full stands at an even place, so that it is kept at the new stride, too.
            self.kept.push(item);
            self.last = None;
        } else {
            self.last = Some(item);
        }
        self.seen += 1;
    }

    /// [-] items seen.
    pub fn seen(&self) -> u64 {
        self.seen
    }

    /// The selection, which ends with the last item.
    pub fn finish(mut self) -> Vec<T> {
        self.kept.extend(self.last);
        self.kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invariant_a_selection_is_even_bounded_and_has_both_ends() {
        for n in [1, 2, MOST, MOST + 1, 2 * MOST, 2 * MOST + 1, 5000, 100_000] {
            let mut thinned = Thinned::default();
            (0..n).for_each(|i| thinned.push(i));
            assert_eq!(thinned.seen(), n as u64);
            let kept = thinned.finish();
            assert!(kept.len() <= MOST + 1 && (n < MOST || kept.len() > MOST / 2), "{n}: {}", kept.len());
            assert_eq!((kept[0], kept[kept.len() - 1]), (0, n - 1));
            let stride = kept.get(1).map_or(1, |second| second - kept[0]);
            assert!(kept.windows(2).rev().skip(1).all(|pair| pair[1] - pair[0] == stride), "{n}");
        }
    }
}
