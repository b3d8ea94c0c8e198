//! A spring by a table: force over displacement through points, monotone cubic between them (Fritsch and Carlson 1980, with harmonic means of the secants as
//! slopes), straight on beyond the ends.
//!
//! ```text
//! F(x) = h00 F_0 + h10 h m_0 + h01 F_1 + h11 h m_1          between two points h apart, h00 to h11 Hermite's polynomials
//! V(x) = int_0^x F                                          exact, a polynomial of fourth degree in each piece
//! ```
//! A force that never falls has a stiffness that is never negative. A table from (0, 0) on holds against both directions alike.

/// Force, stiffness, and energy at a displacement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableForce {
    /// \[N or N m] force against the displacement.
    pub force: f64,
    /// [N/m or N m/rad] its slope.
    pub stiffness: f64,
    /// \[J] its integral from no displacement.
    pub stored: f64,
}

/// A point of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    place: f64,
    force: f64,
    slope: f64,
    /// \[J] energy from the first point to this one.
    stored: f64,
}

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct ForceTable {
    knots: Vec<Knot>,
    /// Is it one half of a law that is odd?
    odd: bool,
    /// \[J] energy from the first point to no displacement.
    at_rest: f64,
}

impl ForceTable {
    /// Through points of strictly growing displacement and forces that do not fall, two at least; none of others. Points from (0, 0) on are one half of a law that is odd.
    pub fn through(points: &[[f64; 2]]) -> Option<Self> {
        let grows = points.windows(2).all(|pair| pair[0][0] < pair[1][0] && pair[0][1] <= pair[1][1]);
        if points.len() < 2 || !grows || !points.iter().flatten().all(|value| value.is_finite()) {
            return None;
        }
        let odd = points[0] == [0.0, 0.0];
        let secant = |i: usize| (points[i + 1][1] - points[i][1]) / (points[i + 1][0] - points[i][0]);
        let last = points.len() - 1;
        let slope = |i: usize| match i {
            0 => secant(0),
            i if i == last => secant(last - 1),
            i => {
                let (left, right) = (secant(i - 1), secant(i));
                if left * right > 0.0 { 2.0 * left * right / (left + right) } else { 0.0 }
            }
        };
        let mut knots: Vec<Knot> = vec![];
        for (i, [place, force]) in points.iter().enumerate() {
            let knot = Knot { place: *place, force: *force, slope: slope(i), stored: 0.0 };
            let stored = knots.last().map_or(0.0, |before| piece(before, &knot, *place).stored);
            knots.push(Knot { stored, ..knot });
        }
        let mut table = Self { knots, odd, at_rest: 0.0 };
        table.at_rest = table.of_points(0.0).stored;
        Some(table)
    }

    /// At a displacement.
    pub fn at(&self, x: f64) -> TableForce {
        let side = if self.odd && x < 0.0 { -1.0 } else { 1.0 };
        let TableForce { force, stiffness, stored } = self.of_points(side * x);
        TableForce { force: side * force, stiffness, stored: stored - self.at_rest }
    }

    /// Stiffness of a line from no displacement to the last point: what it is as a whole.
    pub fn mean_stiffness(&self) -> f64 {
        let (first, last) = (self.knots[0], self.knots[self.knots.len() - 1]);
        (last.force - first.force) / (last.place - first.place)
    }

    fn of_points(&self, x: f64) -> TableForce {
        let next = self.knots.partition_point(|knot| knot.place <= x);
        match (next.checked_sub(1).map(|before| &self.knots[before]), self.knots.get(next)) {
            (Some(before), Some(after)) => piece(before, after, x),
            (Some(end), None) | (None, Some(end)) => {
                let way = x - end.place;
                let stored = end.stored + way * (end.force + 0.5 * end.slope * way);
                TableForce { force: end.force + end.slope * way, stiffness: end.slope, stored }
            }
            (None, None) => TableForce { force: 0.0, stiffness: 0.0, stored: 0.0 },
        }
    }
}

/// Between two knots: `F = F_0 + s (a + s (b + s c))` over the share `s`.
fn piece(before: &Knot, after: &Knot, x: f64) -> TableForce {
    let length = after.place - before.place;
    let s = (x - before.place) / length;
    let rise = after.force - before.force;
    let (a, end) = (before.slope * length, after.slope * length);
    let (b, c) = (3.0 * rise - 2.0 * a - end, a + end - 2.0 * rise);
    TableForce {
        force: before.force + s * (a + s * (b + s * c)),
        stiffness: (a + s * (2.0 * b + 3.0 * s * c)) / length,
        stored: before.stored + length * s * (before.force + s * (a / 2.0 + s * (b / 3.0 + s * c / 4.0))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_a_line_is_a_spring_and_energy_is_the_integral_of_a_force_that_does_not_fall() {
        let line = ForceTable::through(&[[0.0, 0.0], [1e-5, 20.0], [3e-5, 60.0]]).unwrap();
        for x in [-5e-5, -1e-6, 0.0, 2e-5, 1e-4] {
            let TableForce { force, stiffness, stored } = line.at(x);
            assert!((force - 2e6 * x).abs() < 1e-9 && (stiffness / 2e6 - 1.0).abs() < 1e-12);
            assert!((stored - 1e6 * x * x).abs() < 1e-15, "{stored}");
        }
        // Play, a hardening spring, and a law of its own on each side.
        let tables = [
            vec![[0.0, 0.0], [1e-5, 0.0], [2e-5, 50.0], [4e-5, 400.0]],
            vec![[-2e-5, -900.0], [-1e-5, -100.0], [1e-5, -20.0], [3e-5, 10.0]],
        ];
        for points in tables {
            let table = ForceTable::through(&points).unwrap();
            let (mut stored, step) = (0.0, 1e-8);
            for k in -6000..6000 {
                let x = step * f64::from(k);
                let [here, next] = [table.at(x), table.at(x + step)];
                assert!(next.force >= here.force && here.stiffness >= 0.0, "{x}");
                let middle = table.at(x + 0.5 * step);
                stored += step / 6.0 * (here.force + 4.0 * middle.force + next.force);
                let slope = (next.force - here.force) / step;
                assert!(
                    (slope - middle.stiffness).abs() < 1e-3 * table.mean_stiffness() + 1e-6 * slope,
                    "{x}"
                );
            }
            let whole = table.at(6e-5).stored - table.at(-6e-5).stored;
            assert!(
                (stored - whole).abs() < 1e-9 * table.at(6e-5).stored.abs().max(1e-3),
                "{stored} {whole}"
            );
            for [place, force] in points {
                assert!((table.at(place).force - force).abs() < 1e-12 * 900.0);
            }
            assert_eq!(table.at(0.0).stored, 0.0);
        }
        let refused: [&[[f64; 2]]; 4] = [
            &[[0.0, 0.0]],
            &[[0.0, 0.0], [0.0, 1.0]],
            &[[0.0, 0.0], [1.0, -1.0]],
            &[[0.0, 0.0], [1.0, f64::NAN]],
        ];
        assert!(refused.into_iter().all(|points| ForceTable::through(points).is_none()));
    }
}
