//! Of a damaged `run.mcap` all whole chunks before the damage are kept, and what is lost is reported.

use super::super::message_file::messages::{Messages, OwnMessage};
use super::*;

/// A linear congruential generator (Knuth, MMIX): the same damage in each run.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        ((self.0 >> 33) as usize) % n
    }
}

/// A file with a damage of one of several kinds.
fn damaged(whole: &[u8], case: usize, random: &mut Random) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    let at = random.below(bytes.len());
    match case % 8 {
        0 => bytes.truncate(at),
        1 => bytes[at..].fill(0),
        2 => drop(bytes.drain(at..(at + 1 + random.below(300)).min(whole.len()))),
        3 => bytes[at] = u8::try_from(random.below(256)).unwrap(),
        // Where lengths and kinds of records are
        4 => bytes[random.below(200)] ^= 1 << random.below(8),
        _ => bytes[at] ^= 1 << random.below(8),
    }
    bytes
}

/// How many messages come with each step.
fn n_of_steps(messages: &[OwnMessage]) -> usize {
    let is_of_row = |topic: &str| ["/step", "/tf", "/body/swimmer"].contains(&topic);
    messages.iter().filter(|one| is_of_row(&one.topic)).count()
}

#[test]
fn of_a_thousand_damaged_files_only_whole_beginnings_are_read() {
    let place = tempfile::tempdir().unwrap();
    Run::new().complete(place.path());
    let whole = std::fs::read(place.path().join("run.mcap")).unwrap();
    let written = Messages::read(&whole);
    assert_eq!(written.damage, None);
    assert_eq!(n_of_steps(&written.all), 3 * (STEPS + 1));
    let (mut random, mut shortened) = (Random(1), 0);
    for case in 0..1000 {
        let found = Messages::read(&damaged(&whole, case, &mut random));
        assert!(written.all.starts_with(&found.all), "damage {case} is not seen");
        shortened += usize::from(found.all.len() < written.all.len());
    }
    assert!(shortened > 400, "{shortened} of the damages cost messages");
}

#[test]
fn a_run_that_goes_on_after_a_damaged_file_tells_what_is_lost() {
    let place = tempfile::tempdir().unwrap();
    let run = Run::new();
    run.complete(place.path());
    let path = place.path().join("run.mcap");
    let whole = std::fs::read(&path).unwrap();
    let history = History::read(place.path(), STEPS, STEPS as f64 * 0.1).unwrap();
    let mut random = Random(2);
    for case in 0..64 {
        let bytes = if case == 0 { whole.clone() } else { damaged(&whole, case, &mut random) };
        std::fs::write(&path, &bytes).unwrap();
        let n_left = n_of_steps(&Messages::read(&bytes).all);
        let start = Start::with_threads(1);
        let directory =
            RunDirectory::create(place.path(), &run.model.case, start, Earlier::Continue).unwrap();
        drop(MessageFile::create(&directory, &run.model, Some(&history), None).unwrap());
        let again = Messages::read(&std::fs::read(&path).unwrap());
        assert_eq!(again.damage, None, "damage {case}");
        assert_eq!(n_of_steps(&again.all), n_left, "damage {case}");
        let reported =
            again.all.iter().filter(|one| String::from_utf8_lossy(&one.data).contains("lost"));
        assert_eq!(reported.count(), usize::from(n_left < 3 * (STEPS + 1)), "damage {case}");
    }
}

#[test]
fn checkpoints_after_the_one_that_is_resumed_from_go() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("checkpoints");
    std::fs::create_dir(&folder).unwrap();
    for step in [10, 17, 20, 1_234_567] {
        std::fs::write(folder.join(format!("{step:06}.state")), "").unwrap();
    }
    let history = History { step: 17, time: 1.7, ..History::default() };
    let case = &Run::new().model.case;
    CheckpointFiles::create(place.path(), case, Some(&history), WriteTimes::default()).unwrap();
    let left = checkpoints(place.path()).unwrap();
    assert_eq!(left, ["000017.state", "000010.state"].map(|name| folder.join(name)));
}

/// Times between two events are not those of the clock on the wall, which may be set back.
#[test]
fn the_clock_on_the_wall_only_dates() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/observer");
    let name = "SystemTime";
    for file in files(&folder) {
        let text = std::fs::read_to_string(&file).unwrap();
        let is_date = file.ends_with("process.rs") || file.ends_with("damage.rs");
        assert!(is_date || !text.contains(name), "{} reads it", file.display());
    }
}
