//! `roulement cage`: is the cage of a scene stable when it is pushed, does it rattle, or does it whirl?

use std::error::Error;
use std::path::PathBuf;

use clap::Args;
use roulement_cli::cage::{self, pushed, write_figure};
use roulement_cli::sweep::all::threads;

use super::interrupt::heeded_interrupt;
use super::{load, say, with_count_of_runs};

/// Options of `roulement cage`.
#[derive(Args)]
pub struct Options {
    /// Scene file.
    scene: PathBuf,
    /// Directory for cage.svg, the orbits of the cage's centre, made if missing; of a shaft cage-NAME.svg for each bearing with a cage.
    #[arg(short, long)]
    output: Option<PathBuf>,
    /// Print JSON instead of text.
    #[arg(long)]
    json: bool,
    /// Runs at a time; as many as there are cores if not given.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
}

/// Runs the scene under each push, with the progress on stderr, and prints what its cage does.
///
/// # Errors
/// If there is no cage, if no run comes to its end, or if files cannot be written.
pub fn run(options: &Options) -> Result<(), Box<dyn Error>> {
    let scene = load(&options.scene)?;
    let interrupted = heeded_interrupt()?;
    let jobs = options.jobs.map_or_else(threads, usize::from);
    let cages = with_count_of_runs(|another| pushed(&scene, jobs, &interrupted, another))?;
    let text = match options.json {
        true => format!("{:#}\n", cage::to_json(&cages)),
        false => {
            let heading = format!(
                "the scene under each push of its cage, judged over its second half, {:.3} ms",
                500.0 * scene.duration()
            );
            format!("{}\n{heading}\n\n{}", scene.title(), cage::to_text(&cages).trim_end().to_string() + "\n")
        }
    };
    say(&text)?;
    if let Some(directory) = &options.output {
        let failed = |why| format!("cannot make {}: {why}", directory.display());
        std::fs::create_dir_all(directory).map_err(failed)?;
        for cage in &cages {
            let (file, title) = match cage.bearing.as_str() {
                "" => ("cage.svg".to_string(), "centre of the cage".to_string()),
                name => (format!("cage-{name}.svg"), format!("centre of the cage of bearing {name}")),
            };
            write_figure(cage, &title, &directory.join(file))?;
        }
    }
    if cages.iter().all(|cage| cage.worst().is_none()) {
        return Err("no run came to its end".into());
    }
    Ok(())
}
