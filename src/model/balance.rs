//! What may be left of the forces on elements that are in balance wherever the rings are.

/// [-] force that may be left on an element over its loads, and \[N] that which is nothing in any bearing: searches end at 1e-12 of the loads,
/// and a millionth of them is beyond what loads are printed with.
const UNBALANCED: [f64; 2] = [1e-6, 1e-6];

/// \[N] force that may be left on an element with these loads on both races.
pub fn may_be_left(loads: [f64; 2]) -> f64 {
    UNBALANCED[1] + UNBALANCED[0] * (loads[0] + loads[1])
}
