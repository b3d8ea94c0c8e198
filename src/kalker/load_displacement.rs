//! Tangential tractions on an ellipse and the displacements they cause, as polynomials (paper eq. 12).
//!
//! Coordinates are X = x/a, Y = y/b on the unit disc; lengths are in units of `c = sqrt(a b)`, tractions in units of
//! the shear modulus. With traction `(1 - X^2 - Y^2)^(-1/2) X^p Y^q`, polar integration of the half-space's influence
//! function (Boussinesq and Cerruti) about the field point leaves a Gauss-Chebyshev mean along each chord, and
//!
//! ```text
//! u(X, Y) = c integral over t in [0, pi) of A(t)/rho(t) g(n, t) dt,   n = -X sin t + Y cos t,
//! ```
//!
//! where g is the chord's mean, a polynomial in n, `rho` the chord's stretch and A the kernel's angular factor. The
//! integrand is periodic and smooth: the trapezoidal rule is exact to rounding.

use std::f64::consts::PI;

use nalgebra::DMatrix;

use super::Patch;

/// Monomials X^p Y^q up to a degree, ordered by degree and then by power of Y.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    /// Powers `(p, q)`.
    pub powers: Vec<(usize, usize)>,
    /// Largest `p + q`.
    pub degree: usize,
}

impl Basis {
    /// All monomials up to `degree`.
    pub fn new(degree: usize) -> Self {
        let powers = (0..=degree).flat_map(|total| (0..=total).map(move |q| (total - q, q))).collect();
        Self { powers, degree }
    }

    /// Index of X^p Y^q.
    pub fn index(&self, p: usize, q: usize) -> usize {
        let total = p + q;
        total * (total + 1) / 2 + q
    }

    /// Number of monomials.
    pub fn len(&self) -> usize {
        self.powers.len()
    }

    /// Never: degree 0 has one monomial.
    pub fn is_empty(&self) -> bool {
        self.powers.is_empty()
    }
}

/// Displacement polynomials of all traction polynomials up to a degree, but for the integrals over the chords' directions,
/// which alone depend on the patch.
///
/// On the chord of direction t, `X = s cos t - n sin t` and `Y = s sin t + n cos t` with `s = sqrt(1 - n^2) cos phi`, and the
/// mean is over phi: that of `X^p Y^q` is a polynomial in n, and `n = -X sin t + Y cos t`. The coefficient of a monomial of
/// the displacement is therefore a sum of integrals of `cos^c t sin^(d - c) t`. By symmetry about the axes of the ellipse
/// a displacement and a traction along the same axis meet in even powers c only, across in odd ones.
#[derive(Clone, Debug)]
pub struct LoadDisplacement {
    basis: Basis,
    entries: Vec<Entry>,
    terms: Vec<Term>,
}

/// A coefficient of the displacement by one of the traction.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// Monomials of displacement and traction.
    row: usize,
    column: usize,
    /// End of its terms; they begin where those of the entry before end.
    end: usize,
    /// Do displacement and traction lie across each other?
    across: bool,
}

/// A multiple of an integral.
#[derive(Clone, Copy, Debug)]
struct Term {
    /// Place in the list of integrals.
    integral: usize,
    factor: f64,
}

/// Rows of Pascal's triangle up to n.
fn binomials(n: usize) -> Vec<Vec<f64>> {
    let mut rows = vec![vec![1.0]];
    for i in 1..=n {
        let last = &rows[i - 1];
        let middle = last.windows(2).map(|pair| pair[0] + pair[1]);
        rows.push(std::iter::once(1.0).chain(middle).chain([1.0]).collect());
    }
    rows
}

/// -1 to the power of n.
fn sign(n: usize) -> f64 {
    if n % 2 == 1 { -1.0 } else { 1.0 }
}

/// Place of the integral of `cos^c sin^(d - c)`, d even, in the list by d and then by c.
fn place(d: usize, c: usize) -> usize {
    let half = d / 2;
    // d + 1 integrals each of 0, 2 .. d - 2 come before.
    half * half + c
}

impl LoadDisplacement {
    /// Prepares the polynomials up to a degree.
    pub fn new(degree: usize) -> Self {
        let basis = Basis::new(degree);
        let binomials = binomials(degree);
        // mean of cos^(2 l) over phi: (2 l - 1)!!/(2 l)!!
        let means: Vec<f64> = std::iter::successors(Some((1usize, 1.0)), |&(l, mean)| {
            Some((l + 1, mean * (2 * l - 1) as f64 / (2 * l) as f64))
        })
        .map(|(_, mean)| mean)
        .take(degree / 2 + 1)
        .collect();
        let (mut entries, mut terms) = (vec![], vec![]);
        // Factors by powers of n and of cos t of the traction's mean, and by powers of cos t of one entry.
        let width = degree + 1;
        let mut mean = vec![0.0; width * width];
        for (column, &(p, q)) in basis.powers.iter().enumerate() {
            mean.fill(0.0);
            for i in 0..=p {
                for j in (i % 2..=q).step_by(2) {
                    let half = (i + j) / 2;
                    let factor = sign(p - i) * binomials[p][i] * binomials[q][j] * means[half];
                    for l in 0..=half {
                        let n_power = p + q + 2 * l - (i + j);
                        mean[n_power * width + i + q - j] += factor * sign(l) * binomials[half][l];
                    }
                }
            }
            for (k, by_cos) in mean.chunks_exact(width).enumerate().take(p + q + 1) {
                for m in 0..=k {
                    let factor = sign(m) * binomials[k][m];
                    let begin = terms.len();
                    for (c, value) in by_cos.iter().enumerate().filter(|(_, value)| **value != 0.0) {
                        terms.push(Term { integral: place(p + q + k, c + k - m), factor: factor * value });
                    }
                    if terms.len() > begin {
                        let across = (q + k - m) % 2 == 1;
                        let row = basis.index(m, k - m);
                        entries.push(Entry { row, column, end: terms.len(), across });
                    }
                }
            }
        }
        Self { basis, entries, terms }
    }

    /// Monomials of displacements and tractions.
    pub fn basis(&self) -> &Basis {
        &self.basis
    }

    /// Displacement polynomials of all traction polynomials on a patch.
    ///
    /// Row and column blocks are (x, y) components; entry (i, j) of a block is the coefficient of monomial i in the
    /// displacement, in units of `c`, by monomial j of the traction over G. Relative displacement of two like bodies.
    pub fn matrix(&self, patch: &Patch) -> DMatrix<f64> {
        let [xx, xy, yy] = self.integrals(patch);
        let n = self.basis.len();
        let mut matrix = DMatrix::zeros(2 * n, 2 * n);
        let mut begin = 0;
        for &Entry { row, column, end, across } in &self.entries {
            let terms = &self.terms[begin..end];
            begin = end;
            let sum =
                |integrals: &[f64]| -> f64 { terms.iter().map(|t| t.factor * integrals[t.integral]).sum() };
            if across {
                let value = sum(&xy);
                matrix[(row, n + column)] = value;
                matrix[(n + row, column)] = value;
            } else {
                matrix[(row, column)] = sum(&xx);
                matrix[(n + row, n + column)] = sum(&yy);
            }
        }
        matrix
    }

    /// Traction polynomials on a patch by displacement polynomials, column by column; none if there are none.
    ///
    /// Displacements and tractions that are even or odd about both axes of the ellipse in the same way have nothing to do
    /// with the others: four systems of a quarter of the size.
    pub fn tractions(&self, patch: &Patch, displacements: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let matrix = self.matrix(patch);
        let mut tractions = DMatrix::zeros(displacements.nrows(), displacements.ncols());
        for symmetry in 0..4 {
            let rows = self.rows_of_symmetry(symmetry);
            let columns: Vec<usize> = (0..displacements.ncols())
                .filter(|&column| rows.iter().any(|&row| displacements[(row, column)] != 0.0))
                .collect();
            let block = DMatrix::from_fn(rows.len(), rows.len(), |i, k| matrix[(rows[i], rows[k])]);
            let right =
                DMatrix::from_fn(rows.len(), columns.len(), |i, k| displacements[(rows[i], columns[k])]);
            let solution = block.lu().solve(&right)?;
            for (k, &column) in columns.iter().enumerate() {
                for (i, &row) in rows.iter().enumerate() {
                    tractions[(row, column)] = solution[(i, k)];
                }
            }
        }
        Some(tractions)
    }

    /// Rows of the x components even (0) or odd (1) in X and of those even (0) or odd (2) in Y, and of the y components that
    /// belong to them.
    fn rows_of_symmetry(&self, symmetry: usize) -> Vec<usize> {
        let n = self.basis.len();
        let parity = |row: usize| {
            let (p, q) = self.basis.powers[row % n];
            p % 2 + 2 * (q % 2)
        };
        // A y component goes with the x component of the opposite symmetries.
        (0..2 * n).filter(|&row| parity(row) == if row < n { symmetry } else { 3 - symmetry }).collect()
    }

    /// Integrals of `A(t)/rho(t) cos^c t sin^(d - c) t` over t, for displacement and traction xx, xy and yy.
    fn integrals(&self, patch: &Patch) -> [Vec<f64>; 3] {
        // Points of the trapezoidal rule over half a turn: slender ellipses have a narrow peak of 1/rho. By symmetry half of
        // them are enough.
        let slenderness = patch.axis_ratio.max(1.0 / patch.axis_ratio);
        let points = 2 * self.basis.degree + 12 + (6.0 * slenderness).ceil() as usize;
        let (a, b) = (patch.axis_ratio.sqrt(), 1.0 / patch.axis_ratio.sqrt());
        let nu = patch.poisson_ratio;
        let degree = 2 * self.basis.degree;
        let mut integrals = [const { Vec::new() }; 3].map(|_: Vec<f64>| vec![0.0; place(degree, degree) + 1]);
        let (mut cos, mut sin) = (vec![1.0; degree + 1], vec![1.0; degree + 1]);
        for point in 0..points {
            let t = 0.5 * PI * (point as f64 + 0.5) / points as f64;
            let (sin_t, cos_t) = t.sin_cos();
            for power in 1..=degree {
                cos[power] = cos[power - 1] * cos_t;
                sin[power] = sin[power - 1] * sin_t;
            }
            let (dx, dy) = (a * cos_t, b * sin_t);
            let rho = dx.hypot(dy);
            // u = 1/(pi G) integral of [(1 - nu)/R + nu R_i R_j/R^3] p dA; a b = 1 in these units, the chord gives pi.
            let weight = PI / points as f64 / rho;
            let [xx, xy, yy] = [
                weight * (1.0 - nu + nu * dx * dx / (rho * rho)),
                weight * nu * dx * dy / (rho * rho),
                weight * (1.0 - nu + nu * dy * dy / (rho * rho)),
            ];
            for d in (0..=degree).step_by(2) {
                for c in 0..=d {
                    let (power, at) = (cos[c] * sin[d - c], place(d, c));
                    if c % 2 == 1 {
                        integrals[1][at] += xy * power;
                    } else {
                        integrals[0][at] += xx * power;
                        integrals[2][at] += yy * power;
                    }
                }
            }
        }
        integrals
    }
}

/// Integral over the unit disc of `(1 - X^2 - Y^2)^(-1/2) X^p Y^q`.
pub fn disc_moment(p: usize, q: usize) -> f64 {
    if p % 2 == 1 || q % 2 == 1 {
        return 0.0;
    }
    // Angle: 2 pi (p-1)!! (q-1)!!/(p+q)!!; radius: integral of r^(k+1) (1 - r^2)^(-1/2) = k!!/(k+1)!!.
    let double = |n: usize| -> f64 { (1..=n).rev().step_by(2).map(|i| i as f64).product() };
    let odd = |n: usize| if n == 0 { 1.0 } else { double(n - 1) };
    let k = p + q;
    2.0 * PI * odd(p) * odd(q) / double(k) * double(k) / double(k + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_disc_moments() {
        // 2 pi for the constant; 2 pi/3 for X^2 (a third of r^2's 4 pi/3).
        assert!((disc_moment(0, 0) - 2.0 * PI).abs() < 1e-14);
        assert!((disc_moment(2, 0) - 2.0 * PI / 3.0).abs() < 1e-14);
        assert!((disc_moment(2, 2) - 2.0 * PI / 15.0).abs() < 1e-14);
        assert_eq!(disc_moment(1, 2), 0.0);
    }

    #[test]
    fn closed_form_constant_traction_on_a_circle() {
        // Mindlin 1949: traction (1 - r^2)^(-1/2) on a circle of radius 1 moves one body rigidly by
        // pi (2 - nu)/(4 G); two bodies by twice that.
        for nu in [0.0, 0.3, 0.5] {
            let patch = Patch { axis_ratio: 1.0, poisson_ratio: nu, rolling_angle: 0.0 };
            let k = LoadDisplacement::new(2).matrix(&patch);
            assert!((k[(0, 0)] - PI * (2.0 - nu) / 2.0).abs() < 1e-13, "{}", k[(0, 0)]);
            for row in 1..k.nrows() {
                assert!(k[(row, 0)].abs() < 1e-13, "row {row}");
            }
        }
    }

    #[test]
    fn invariant_under_exchange_of_the_axes() {
        let basis = Basis::new(5);
        let at = |ratio| {
            LoadDisplacement::new(5).matrix(&Patch {
                axis_ratio: ratio,
                poisson_ratio: 0.3,
                rolling_angle: 0.0,
            })
        };
        let (one, other) = (at(0.2), at(5.0));
        let n = basis.len();
        for (i, &(p, q)) in basis.powers.iter().enumerate() {
            for (j, &(r, s)) in basis.powers.iter().enumerate() {
                let swapped = (n + basis.index(q, p), n + basis.index(s, r));
                assert!((one[(i, j)] - other[swapped]).abs() < 1e-12 * one.amax());
            }
        }
    }

    #[test]
    fn refined_rule_changes_nothing() {
        // The number of points grows with the degree: the same entries with many more of them.
        let patch = Patch { axis_ratio: 0.05, poisson_ratio: 0.3, rolling_angle: 0.0 };
        let (few, many) = (LoadDisplacement::new(4).matrix(&patch), LoadDisplacement::new(24).matrix(&patch));
        let monomials = few.nrows() / 2;
        for i in 0..monomials {
            for j in 0..monomials {
                let error = (few[(i, j)] - many[(i, j)]).abs();
                assert!(error < 1e-9 * few.amax(), "{i} {j}: {error:e}");
            }
        }
    }
}
