//! Examples at the end of the help of every command, with files of the project.

use clap::Command;

/// Commands with their examples: what follows `roulement`.
const EXAMPLES: &[(&str, &[&str])] = &[
    ("run", &["run scenes/radial.toml -o results", "run scenes/thrust.toml --error 1e-3 --means-only"]),
    (
        "check",
        &["check scenes/radial.toml examples/sweeps/misalignment.toml examples/gearbox/three_stage.toml"],
    ),
    (
        "equilibrium",
        &[
            "equilibrium scenes/radial.toml --json",
            "equilibrium scenes/shafts/pinion.toml --up-to \"12000 rpm\"",
        ],
    ),
    ("modes", &["modes scenes/shafts/pinion.toml --up-to \"12000 rpm\" -o modes"]),
    (
        "rating",
        &[
            "rating examples/gearbox/three_stage.toml",
            "rating scenes/effects/rating.toml --loads loads.csv --runs",
        ],
    ),
    ("cage", &["cage scenes/cage.toml -o cage"]),
    (
        "sweep",
        &[
            "sweep examples/sweeps/misalignment.toml --threads 2 -o sweep",
            "sweep cases.csv --scene scenes/radial.toml --columns 'balls.entering_slip_load'",
            "sweep examples/sweeps/misalignment.toml -o sweep --shard 1/64",
            "sweep examples/sweeps/misalignment.toml -o sweep --collect",
        ],
    ),
    ("scene", &["scene --keys friction", "scene --schema > scene.schema.json"]),
    (
        "bearing",
        &[
            "bearing 6205 C3 -o scene.toml",
            "bearing SKF 7206BECBP --candidates --set load.x.force=\"2 kN\"",
            "bearing 6206 --shaft-fit k6 --housing-fit H7 --candidates",
        ],
    ),
    ("import", &["import examples/gearbox/two_shafts.rexsj -o machine.toml"]),
    ("export", &["export examples/gearbox/three_stage.toml -o gearbox.rexs"]),
    ("effects", &["effects scenes/radial.toml", "effects scenes/radial.toml --measure --jobs 2"]),
    ("report", &["report results -o report.html", "report before after -o both.html"]),
    (
        "fmu",
        &[
            "fmu scenes/thrust.toml -o bearing.fmu",
            "fmu scenes/shafts/pinion.toml --fmi 3 --name pinion -o pinion.fmu",
        ],
    ),
    ("system", &["system examples/gearbox/system.toml -o system"]),
    ("field", &["field scenes/thrust.toml --contacts 1.inner,1.outer --times '5 ms' -o field.csv"]),
    (
        "contact",
        &[
            "contact --law kalker_table cases.csv",
            "contact --film scenes/effects/loss_of_lubrication.toml --loads '100 N,500 N' --speeds '5 m/s' -o film",
        ],
    ),
    ("identify", &["identify scenes/thrust.toml -o identified.toml", "identify --axis-ratio 0.2"]),
    ("cost", &["cost scenes/thrust.toml --only tolerance,step-cap -o cost"]),
    ("describe", &["describe scenes/thrust.toml --fmi 3"]),
    (
        "completions",
        &[
            "completions bash > ~/.local/share/bash-completion/completions/roulement",
            "completions fish > ~/.config/fish/completions/roulement.fish",
        ],
    ),
];

/// Commands with their examples behind their help.
pub fn with_examples(commands: Command) -> Command {
    // In a browser some commands are missing.
    let there =
        EXAMPLES.iter().filter(|(name, _)| commands.find_subcommand(name).is_some()).collect::<Vec<_>>();
    there.into_iter().fold(commands, |commands, (name, lines)| {
        let lines: String = lines.iter().map(|line| format!("\n  roulement {line}")).collect();
        commands.mut_subcommand(name, |command| command.after_help(format!("Examples:{lines}")))
    })
}
