//! Same input, same bits: on one processor family. The system's mathematical functions (sin, atan2, pow) choose at run time
//! whether they multiply and add in one rounding (FMA); here the same program runs with and without that.

use std::path::PathBuf;
use std::process::Command;

/// Numbers of the table of a run of 2 ms, row by row.
fn rows(name: &str, without_fma: bool) -> Vec<Vec<f64>> {
    let dir = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    std::fs::create_dir_all(&dir).unwrap();
    let scene = include_str!("../../../scenes/cage.toml").replace("\"50 ms\"", "\"2 ms\"");
    assert!(scene.contains("\"2 ms\""));
    std::fs::write(dir.join("scene.toml"), scene).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_roulement"));
    command.arg("run").arg(dir.join("scene.toml")).arg("-o").arg(&dir);
    if without_fma {
        command.env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4");
    }
    assert!(command.output().unwrap().status.success());
    let table = std::fs::read_to_string(dir.join("results.csv")).unwrap();
    let numbers = |line: &str| line.split(',').filter_map(|cell| cell.parse().ok()).collect::<Vec<f64>>();
    table.lines().map(numbers).filter(|row| !row.is_empty()).collect()
}

#[test]
fn invariant_a_run_repeats_to_the_bit_and_without_fma_to_rounding() {
    let [one, again, other] =
        [("fma-1", false), ("fma-2", false), ("fma-none", true)].map(|(name, without)| rows(name, without));
    assert!(one.len() > 10 && one[0].len() > 20, "{} {}", one.len(), one[0].len());
    assert_eq!(one, again);
    // Columns apart: each against its largest number. Rounding of 1e-16 grows while contacts strike.
    let columns = one[0].len();
    let mut largest = 0.0f64;
    for column in 0..columns {
        let size = one.iter().map(|row| row[column].abs()).fold(0.0, f64::max);
        for (a, b) in one.iter().zip(&other) {
            let difference = (a[column] - b[column]).abs();
            assert!(difference <= 1e-8 * size, "column {column}: {} and {}", a[column], b[column]);
            largest = largest.max(if size > 0.0 { difference / size } else { 0.0 });
        }
    }
    println!("largest difference without FMA: {largest:.1e}");
}
