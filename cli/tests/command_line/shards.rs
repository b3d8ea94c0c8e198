//! `roulement sweep --shard` and `--collect`: parts of a sweep on machines that share no more than a disc.

use std::collections::BTreeMap;
use std::process::Output;
use std::time::{Duration, Instant};

use super::sweep::{columns, good};
use super::*;

/// A sweep of cases in a table of a folder, with its results there.
fn sweep(scratch: &Scratch, cases: &str, to: &str, options: &[&str]) -> Output {
    let (cases, to) = (scratch.path(cases), scratch.path(to));
    let base: &[&str] = if cases.ends_with("csv") { &["--scene", &scene("thrust")] } else { &[] };
    roulement(&[&["sweep", &cases, "-o", &to, "--threads", "2"], base, options].concat())
}

/// What a command says that ends with a code, and what it tells beside that.
fn ended(output: &Output, code: i32) -> (String, String) {
    let [said, told] =
        [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text).into_owned());
    assert_eq!(output.status.code(), Some(code), "{said}{told}");
    (said, told)
}

/// All files of a folder but those of shards, and of runs alone those that tell no time of a clock: path and bytes.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    fn enter(folder: &Path, before: &str, files: &mut BTreeMap<String, Vec<u8>>) {
        for entry in std::fs::read_dir(folder).unwrap().map(Result::unwrap) {
            let name = format!("{before}{}", entry.file_name().to_string_lossy());
            if name == "shards" {
                continue;
            }
            if entry.path().is_dir() {
                enter(&entry.path(), &format!("{name}/"), files);
            } else if !name.ends_with("run.json") && !name.ends_with("summary.txt") {
                files.insert(name, std::fs::read(entry.path()).unwrap());
            }
        }
    }
    let mut files_of = BTreeMap::new();
    enter(folder, "", &mut files_of);
    files_of
}

/// A divided sweep that is joined has the files of one that was not divided.
fn joined_is_whole(scratch: &Scratch, cases: &str, shards: usize, options: &[&str], code: i32) -> String {
    ended(&sweep(scratch, cases, "whole", options), code);
    for number in 1..=shards {
        let shard = format!("{number}/{shards}");
        let output = sweep(scratch, cases, "divided", &[options, &["--shard", &shard]].concat());
        assert!([Some(0), Some(code)].contains(&output.status.code()), "{output:?}");
    }
    let (said, told) = ended(&sweep(scratch, cases, "divided", &[options, &["--collect"]].concat()), code);
    assert!(!told.contains("missing") && !told.contains("unfinished"), "{told}");
    let [whole, divided] = ["whole", "divided"].map(|folder| files(Path::new(&scratch.path(folder))));
    assert_eq!(whole.keys().collect::<Vec<_>>(), divided.keys().collect::<Vec<_>>());
    for (name, bytes) in &whole {
        assert!(*bytes == divided[name], "{name} differs");
    }
    said
}

#[test]
fn invariant_joined_shards_are_the_sweep_that_was_not_divided() {
    let scratch = Scratch::new("shards-joined");
    // A case that fails, one without a scene, and one that stands there twice, in another shard.
    let text = "friction.ball_race,solver.min_step,solver.initial_step,solver.tolerance,load.duration\n\
                0.05,,,,1 ms\n,9 us,10 us,1e-12,1 ms\n-1,,,,1 ms\n0.06,,,,0.5 ms\n0.05,,,,1 ms\n0.07,,,,0.2 ms\n0.08,,,,1 ms\n";
    std::fs::write(scratch.path("cases.csv"), text).unwrap();
    let options = ["--tables", "csv", "--columns", "inner.force.*,ball[*].inner.load", "--runs", "1,4"];
    let said = joined_is_whole(&scratch, "cases.csv", 3, &options, 4);
    assert!(said.contains("5 done, 2 failed, 0 not run\n"), "{said}");
    let whole = files(Path::new(&scratch.path("whole")));
    for kind in ["cases/", "tables/", "runs/"] {
        assert!(whole.keys().filter(|name| name.starts_with(kind)).count() > 1, "{:?}", whole.keys());
    }
    // The part of a shard has its own cases with their numbers.
    let own = columns(&scratch.read("divided/shards/2-of-3/summary.csv"));
    assert_eq!(own["case"], ["2", "5"]);
    assert_eq!(own["status"], ["failed", "done"]);
    // Joined once more, nothing changes.
    ended(&sweep(&scratch, "cases.csv", "divided", &[&options[..], &["--collect"]].concat()), 4);
    assert_eq!(files(Path::new(&scratch.path("divided"))), whole);
}

#[test]
fn invariant_shards_of_a_shaft_with_growth_and_of_ranges_are_joined() {
    let scratch = Scratch::new("shards-shaft");
    let text = format!(
        "scene = {:?}\n[set]\nload.duration = \"0.3 ms\"\n[grid]\n\
         bearing.right.set.outer.misalignment.rz = [0, \"0.5 mrad\"]\nshaft.load.mesh.force.z = [\"1 kN\", \"2 kN\"]\n",
        scene("shafts/pinion")
    );
    std::fs::write(scratch.path("cases.toml"), text).unwrap();
    // More shards than cases: some have nothing to do.
    let options = ["--growth", "--tables", "parquet", "--columns", "shaft.torque,left.ball[*].inner.load"];
    let said = joined_is_whole(&scratch, "cases.toml", 6, &options, 0);
    assert!(said.contains("4 done, 0 failed, 0 not run\n"), "{said}");
    let empty = columns(&scratch.read("divided/shards/6-of-6/summary.csv"));
    assert!(empty.values().all(Vec::is_empty), "{empty:?}");
}

#[test]
fn missing_and_unfinished_shards_are_named_and_the_rest_is_joined() {
    let scratch = Scratch::new("shards-missing");
    let rows: String = (0..12).map(|i| format!("{},0.2 ms\n", 0.05 + 0.001 * f64::from(i))).collect();
    std::fs::write(scratch.path("cases.csv"), format!("friction.ball_race,load.duration\n{rows}")).unwrap();
    let shard = |name: &str| sweep(&scratch, "cases.csv", "out", &["--shard", name]);
    let collect = || sweep(&scratch, "cases.csv", "out", &["--collect"]);
    let (_, told) = ended(&collect(), 1);
    assert!(told.contains("has no shards") && told.contains("--shard 1/N"), "{told}");
    for name in ["2/6", "4/6"] {
        let (said, _) = ended(&shard(name), 0);
        assert!(said.contains("2 cases") && said.contains("2 done, 0 failed, 0 not run"), "{said}");
    }
    // One of the two cases of a shard is lost, of the other a digit.
    let own = columns(&scratch.read("out/shards/4-of-6/summary.csv"));
    std::fs::remove_file(scratch.path(&format!("out/shards/4-of-6/cases/{}.csv", own["file"][1]))).unwrap();
    let (said, told) = ended(&collect(), 4);
    assert!(said.contains("3 done, 0 failed, 9 not run\n"), "{said}");
    assert!(told.contains("missing shards: 1, 3, 5, 6 of 6"), "{told}");
    assert!(told.contains("unfinished shard: 4 of 6, 1 of its 2 cases are not done"), "{told}");
    let summary = columns(&scratch.read("out/summary.csv"));
    let done: Vec<usize> = (1..=12).filter(|case| summary["status"][case - 1] == "done").collect();
    assert_eq!(done, [2, 4, 8]);
    // A shard that is started again does what is missing, and a damaged case anew.
    let damaged = scratch.path(&format!("out/shards/4-of-6/cases/{}.csv", own["file"][0]));
    std::fs::write(&damaged, "status\n").unwrap();
    let (said, told) = ended(&shard("4/6"), 0);
    assert!(
        said.contains("2 done, 0 failed, 0 not run; 0 of them") && told.contains("1 of the finished"),
        "{told}"
    );
    let (_, told) = ended(&collect(), 4);
    assert!(told.contains("missing shards: 1, 3, 5, 6 of 6") && !told.contains("unfinished"), "{told}");
    // What no shard has done, the same command without shards does.
    let (said, _) = ended(&sweep(&scratch, "cases.csv", "out", &[]), 0);
    assert!(said.contains("12 done, 0 failed, 0 not run; 4 of them were there already"), "{said}");
    let (_, told) = ended(&collect(), 0);
    assert!(!told.contains("missing"), "{told}");
}

#[cfg(unix)]
#[test]
fn an_interrupted_shard_goes_on_where_it_was() {
    let scratch = Scratch::new("shards-interrupted");
    let rows: String = (0..24).map(|i| format!("{}\n", 0.05 + 0.001 * f64::from(i))).collect();
    std::fs::write(scratch.path("cases.csv"), format!("friction.ball_race\n{rows}")).unwrap();
    let kept = |to: &str| {
        let folder = scratch.path(&format!("{to}/shards/1-of-2/cases"));
        let names = std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().file_name());
        names.filter(|name| !name.to_string_lossy().starts_with('.')).count()
    };
    for (signal, to) in [("-TERM", "ended"), ("-KILL", "killed")] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_roulement"))
            .args(["sweep", &scratch.path("cases.csv"), "--scene", &scene("thrust"), "--threads", "1"])
            .args(["-o", &scratch.path(to), "--shard", "1/2"])
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        let begin = Instant::now();
        while kept(to) < 2 {
            assert!(begin.elapsed() < Duration::from_secs(120));
            std::thread::sleep(Duration::from_millis(2));
        }
        Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        let code = child.wait().unwrap().code();
        assert!(signal == "-KILL" || code == Some(130), "{code:?}");
        let before = kept(to);
        assert!((2..12).contains(&before), "{before}");
        let (_, told) = ended(&sweep(&scratch, "cases.csv", to, &["--collect"]), 4);
        let left = format!("unfinished shard: 1 of 2, {} of its 12 cases are not done", 12 - before);
        assert!(told.contains(&left) && told.contains("missing shards: 2 of 2"), "{told}");
        let (said, _) = ended(&sweep(&scratch, "cases.csv", to, &["--shard", "1/2"]), 0);
        assert!(said.contains(&format!("12 done, 0 failed, 0 not run; {before} of them")), "{said}");
        good(&sweep(&scratch, "cases.csv", to, &["--shard", "2/2"]));
        good(&sweep(&scratch, "cases.csv", to, &["--collect"]));
    }
    good(&sweep(&scratch, "cases.csv", "whole", &[]));
    for to in ["ended", "killed"] {
        assert_eq!(scratch.read(&format!("{to}/summary.csv")), scratch.read("whole/summary.csv"));
    }
}

#[test]
fn refusals_of_shards_name_what_is_wrong() {
    let scratch = Scratch::new("shards-refused");
    let table = "friction.ball_race,load.duration\n0.05,0.1 ms\n0.06,0.1 ms\n0.07,0.1 ms\n";
    std::fs::write(scratch.path("cases.csv"), table).unwrap();
    for (shard, parts) in [
        ("0/64", &["0/64", "numbers 1 to 64, not 0"][..]),
        ("65/64", &["65/64", "numbers 1 to 64, not 65"]),
        ("1/0", &["1/0", "not 0"]),
        ("7", &["as 7/64"]),
        ("a/b", &["a/b", "as 7/64"]),
        ("-1/4", &["-1/4"]),
        ("1/2/3", &["as 7/64"]),
    ] {
        let output = sweep(&scratch, "cases.csv", "out", &[&format!("--shard={shard}")]);
        let (_, told) = ended(&output, 2);
        assert!(parts.iter().all(|part| told.contains(part)), "{told}");
    }
    assert!(!Path::new(&scratch.path("out")).exists());
    let (_, told) = ended(&sweep(&scratch, "cases.csv", "out", &["--shard", "1/2", "--collect"]), 2);
    assert!(told.contains("--collect") && told.contains("cannot be used with"), "{told}");
    // A key that no case can have is refused by every shard, also by those whose cases do not set it.
    std::fs::write(scratch.path("wrong.csv"), "friction.bal_race,load.duration\n0.05,\n,0.1 ms\n").unwrap();
    for shard in ["1/2", "2/2"] {
        let (_, told) = ended(&sweep(&scratch, "wrong.csv", "out", &["--shard", shard]), 1);
        assert!(told.contains("no case that sets friction.bal_race"), "{told}");
    }

    ended(&sweep(&scratch, "cases.csv", "out", &["--shard", "1/2"]), 0);
    let collect = |cases: &str, options: &[&str]| {
        let (_, told) = ended(&sweep(&scratch, cases, "out", &[&["--collect"], options].concat()), 1);
        told
    };
    // Of another table, and with other things wanted.
    std::fs::write(scratch.path("other.csv"), table.replace("0.07", "0.08")).unwrap();
    for (cases, options) in
        [("other.csv", &[][..]), ("cases.csv", &["--growth"]), ("cases.csv", &["--tables", "csv"])]
    {
        let told = collect(cases, options);
        assert!(told.contains("1-of-2 is of another sweep (3 cases, here 3)"), "{told}");
    }
    // Of another version of the program.
    let record = scratch.path("out/shards/1-of-2/shard.json");
    let text = std::fs::read_to_string(&record).unwrap();
    let version: Value = serde_json::from_str(&text).unwrap();
    let version = version["program"].as_str().unwrap();
    std::fs::write(&record, text.replace(version, "0.0.1")).unwrap();
    let told = collect("cases.csv", &[]);
    assert!(told.contains("by roulement 0.0.1") && told.contains(&format!("this is {version}")), "{told}");
    std::fs::write(&record, "{ }").unwrap();
    assert!(collect("cases.csv", &[]).contains("is no record of a shard"));
    // The shard itself writes it anew; of two divisions none is taken.
    ended(&sweep(&scratch, "cases.csv", "out", &["--shard", "1/2"]), 0);
    ended(&sweep(&scratch, "cases.csv", "out", &["--shard", "3/3"]), 0);
    let told = collect("cases.csv", &[]);
    assert!(told.contains("shards of 2 and of 3"), "{told}");
}

/// The batch file that the documents name, as SLURM runs it: two tasks of an array.
#[cfg(unix)]
#[test]
fn the_batch_file_of_a_job_array_is_a_shell_script_that_runs_shards() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/sweeps/slurm.sh");
    assert!(Command::new("bash").arg("-n").arg(&script).status().unwrap().success());
    let text = std::fs::read_to_string(&script).unwrap();
    let begin = text.lines().take_while(|line| line.is_empty() || line.starts_with('#'));
    let options: Vec<&str> = begin.filter_map(|line| line.strip_prefix("#SBATCH --")).collect();
    // SLURM reads no options behind the first command.
    assert_eq!(options.len(), text.matches("#SBATCH ").count());
    assert!(
        options.iter().all(|option| option.split(['=', ' ']).next().is_some_and(|name| !name.is_empty()))
    );
    assert!(options.iter().any(|option| option.starts_with("array=1-")), "{options:?}");

    let scratch = Scratch::new("shards-slurm");
    std::fs::write(
        scratch.path("cases.csv"),
        "friction.ball_race,load.duration\n0.05,0.1 ms\n0.06,0.1 ms\n0.07,0.1 ms\n",
    )
    .unwrap();
    let [cases, to] = ["cases.csv", "out"].map(|name| scratch.path(name));
    for task in ["1", "2"] {
        let output = Command::new("bash")
            .arg(&script)
            .args([&cases, &scene("thrust"), &to])
            .env("ROULEMENT", env!("CARGO_BIN_EXE_roulement"))
            .env("SLURM_ARRAY_TASK_ID", task)
            .env("SLURM_ARRAY_TASK_COUNT", "2")
            .env("SLURM_CPUS_PER_TASK", "1")
            .output()
            .unwrap();
        let (said, _) = ended(&output, 0);
        assert!(said.contains(&format!("shard {task} of 2")), "{said}");
    }
    let (said, _) = ended(&sweep(&scratch, "cases.csv", "out", &["--collect"]), 0);
    assert!(said.contains("3 done, 0 failed, 0 not run\n"), "{said}");
}
