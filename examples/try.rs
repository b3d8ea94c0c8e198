use roulement::{scene::Scene, simulation::Simulation};
fn main() {
    let path = std::env::args().nth(1).unwrap();
    let scene = Scene::load(path.as_ref()).unwrap();
    let t = std::time::Instant::now();
    let mut s = Simulation::new(&scene).unwrap();
    println!("start {:?}", t.elapsed());
    let t = std::time::Instant::now();
    let dt = scene.load.output_interval.0;
    let n = (scene.load.duration.0 / dt).round() as usize;
    for k in 0..n {
        let i = s.scripted_inputs(s.time());
        s.set_inputs(i);
        if let Err(e) = s.advance((k + 1) as f64 * dt) {
            println!("{e}");
            break;
        }
        if k % (n / 20) == 0 || k < 5 {
            let o = s.outputs();
            let b = &o.balls[0];
            println!(
                "{:.4} Fx {:.3} Qi {:.3} Qo {:.3} ai {:.3} ao {:.3} cage {:.3} slip {:.2e} P {:.4} Pd {:.2e} T {:.5} cx {:.2e} cy {:.2e} sp {:.2} Fy {:.3} Mz {:.2e} h {:.1e} bal {:.2e}",
                o.time,
                o.inner.wrench.force.x,
                b.inner.load,
                b.outer.load,
                b.inner.contact_angle.to_degrees(),
                b.outer.contact_angle.to_degrees(),
                o.cage_speed,
                o.cage_slip,
                o.friction_power,
                o.damping_power,
                o.inner.drive_torque,
                b.inner.creepage_longitudinal,
                b.inner.creepage_lateral,
                b.inner.creepage_spin,
                b.inner.force_lateral,
                b.inner.spin_moment,
                s.state().control.step(),
                o.work - o.dissipated - o.stored_energy
            );
        }
    }
    println!("{:?} {:?}", t.elapsed(), s.state().statistics);
}
