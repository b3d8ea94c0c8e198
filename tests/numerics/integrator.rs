//! The HHT scheme with its Newton solver on oscillators with closed solutions.

use nalgebra::Vector3;
use roulement::numerics::hht::HhtStep;
use roulement::numerics::newton::{Equations, NewtonBuffers, NewtonWork, Patience, solve};

/// `x'' = -k x - c x' - q x^3` per unit mass, three components at once.
#[derive(Clone, Copy)]
struct Oscillator {
    stiffness: f64,
    damping: f64,
    cubic: f64,
}

impl Oscillator {
    fn force(&self, x: &Vector3<f64>, v: &Vector3<f64>) -> Vector3<f64> {
        x * -self.stiffness - v * self.damping - x.map(|x| self.cubic * x.powi(3))
    }
}

/// One step of the scheme as the bearing takes it.
struct Step<'a> {
    oscillator: &'a Oscillator,
    step: HhtStep,
    start: [Vector3<f64>; 4],
    end: [Vector3<f64>; 4],
    residual: Vector3<f64>,
    tangent: Vector3<f64>,
}

impl Equations for Step<'_> {
    fn residual(&mut self, unknowns: &[f64], with_tangent: bool) -> f64 {
        let a = Vector3::from_row_slice(unknowns);
        let [x0, v0, a0, g0] = self.start;
        let x = x0 + self.step.displacement(&v0, &a0, &a);
        let v = self.step.velocity(&v0, &a0, &a);
        let g = self.oscillator.force(&x, &v);
        self.end = [x, v, a, g];
        let weight = 1.0 - self.step.alpha_f;
        self.residual = a - g * weight - g0 * self.step.alpha_f;
        if with_tangent {
            let o = self.oscillator;
            self.tangent = x.map(|x| {
                let stiffness = o.stiffness + 3.0 * o.cubic * x * x;
                1.0 + weight * (stiffness * self.step.position_gain() + o.damping * self.step.velocity_gain())
            });
        }
        // Twelve digits of the largest term.
        let size = 1.0
            + a.amax()
            + a0.amax()
            + self.oscillator.stiffness * (x0.amax() + self.step.h * (v0.amax() + self.step.h * a0.amax()));
        self.residual.amax() / (1e-12 * size)
    }
    fn correction(&mut self, correction: &mut [f64]) -> bool {
        for i in 0..3 {
            correction[i] = -self.residual[i] / self.tangent[i];
        }
        true
    }
}

/// Integrates from x = 1, 0.5, -0.2 at rest for `time` in `n` steps; returns the end position and velocity.
fn integrate(oscillator: &Oscillator, alpha_f: f64, time: f64, n: u32) -> (Vector3<f64>, Vector3<f64>) {
    let x = Vector3::new(1.0, 0.5, -0.2);
    let g = oscillator.force(&x, &Vector3::zeros());
    let mut state = [x, Vector3::zeros(), g, g];
    let (mut buffers, mut work) = (NewtonBuffers::default(), NewtonWork::default());
    for _ in 0..n {
        let mut step = Step {
            oscillator,
            step: HhtStep::new(alpha_f, time / f64::from(n)),
            start: state,
            end: state,
            residual: Vector3::zeros(),
            tangent: Vector3::zeros(),
        };
        let mut unknowns = [state[2].x, state[2].y, state[2].z];
        solve(&mut step, &mut unknowns, &mut buffers, &mut work, Patience::USUAL).unwrap();
        state = step.end;
    }
    (state[0], state[1])
}

/// Slope of ln(error) over ln(step) between the finest two of the errors at n, 2n, 4n steps.
fn observed_order(error: impl Fn(u32) -> f64, n: u32) -> f64 {
    (error(2 * n) / error(4 * n)).log2()
}

#[test]
fn order_two_on_a_damped_oscillator() {
    for alpha_f in [0.01, 0.05, 0.2, 1.0 / 3.0] {
        let oscillator = Oscillator { stiffness: 9.0, damping: 0.4, cubic: 0.0 };
        let time = 3.0;
        let decay = 0.5 * oscillator.damping;
        let omega = (oscillator.stiffness - decay * decay).sqrt();
        let exact = (-decay * time).exp() * ((omega * time).cos() + decay / omega * (omega * time).sin());
        let error =
            |n| (integrate(&oscillator, alpha_f, time, n).0 - Vector3::new(1.0, 0.5, -0.2) * exact).norm();
        let order = observed_order(error, 200);
        assert!((order - 2.0).abs() < 0.05, "alpha_f {alpha_f}: order {order}");
    }
}

#[test]
fn order_two_on_a_nonlinear_oscillator() {
    // Energy of the first component: v^2/2 + k x^2/2 + q x^4/4 is constant without damping.
    let oscillator = Oscillator { stiffness: 4.0, damping: 0.0, cubic: 5.0 };
    let energy = |x: f64, v: f64| {
        0.5 * v * v + 0.5 * oscillator.stiffness * x * x + 0.25 * oscillator.cubic * x.powi(4)
    };
    let error = |n| {
        let (x, v) = integrate(&oscillator, 0.05, 1.3, n);
        (energy(x.x, v.x) - energy(1.0, 0.0)).abs()
    };
    let order = observed_order(error, 400);
    assert!(order > 1.9, "order {order}");
}

#[test]
fn closed_form_high_frequencies_are_damped_and_never_grow() {
    // The spectral radius at infinite frequency is (1 - alpha_f)/(1 + alpha_f); a quarter of the steps leaves room for the
    // growth of a multiple root.
    for alpha_f in [0.05, 0.2, 1.0 / 3.0] {
        let oscillator = Oscillator { stiffness: 1e12, damping: 0.0, cubic: 0.0 };
        let (x, _) = integrate(&oscillator, alpha_f, 2.0, 400);
        let radius: f64 = (1.0 - alpha_f) / (1.0 + alpha_f);
        assert!(x.amax() < radius.powi(100).max(1e-11), "alpha_f {alpha_f}: {x}");
    }
}
