//! Wall-clock time of a command by stages, from the start of its process.

use std::time::Instant;

use serde_json::{Map, Value, json};

/// Clock ticks per second in which Linux tells times of processes to all programs (`USER_HZ`).
const TICKS_PER_SECOND: f64 = 100.0;

/// Times of stages that follow each other without gaps.
#[derive(Debug)]
pub(crate) struct StageTimes {
    last: Instant,
    /// Names and milliseconds, in their order.
    stages: Vec<(&'static str, f64)>,
    /// Names and milliseconds of what threads did beside each other within a stage.
    parallel: Vec<(&'static str, f64)>,
}

impl StageTimes {
    /// Starts the clock. What the process did before is the stage `start`, where the system tells: it loaded the
    /// executable and read the arguments.
    pub(crate) fn new() -> Self {
        let before = process_age_ms().map(|age| ("start", age));
        Self { stages: before.into_iter().collect(), ..Self::from_now() }
    }

    /// Starts the clock, without regard to what the process did before.
    pub(crate) fn from_now() -> Self {
        Self { last: Instant::now(), stages: Vec::new(), parallel: Vec::new() }
    }

    /// Records the time of a part of a stage that another thread did beside it.
    pub(crate) fn add_parallel(&mut self, part: &'static str, ms: f64) {
        self.parallel.push((part, ms));
    }

    /// Ends a stage, which began when the one before ended.
    pub(crate) fn end(&mut self, stage: &'static str) {
        let now = Instant::now();
        let took = now.duration_since(std::mem::replace(&mut self.last, now));
        self.add(stage, took.as_secs_f64() * 1000.0);
    }

    /// Moves part of a stage's time to another stage, at most all of it.
    pub(crate) fn attribute(&mut self, from: &str, to: &'static str, ms: f64) {
        let Some((_, found)) = self.stages.iter_mut().find(|(known, _)| *known == from) else { return };
        let moved = ms.min(*found);
        *found -= moved;
        self.add(to, moved);
    }

    fn add(&mut self, stage: &'static str, ms: f64) {
        match self.stages.iter_mut().find(|(known, _)| *known == stage) {
            Some((_, known)) => *known += ms,
            None => self.stages.push((stage, ms)),
        }
    }

    /// Returns the milliseconds of a stage; 0 if it was not ended.
    pub(crate) fn ms(&self, stage: &str) -> f64 {
        self.stages.iter().find(|(known, _)| *known == stage).map_or(0.0, |(_, ms)| *ms)
    }

    /// Returns the milliseconds of each stage, of all together, and of the parts that ran beside each other.
    pub(crate) fn to_json(&self) -> Value {
        let object = |times: &[(&'static str, f64)]| {
            times.iter().map(|(name, ms)| ((*name).to_owned(), json!(ms))).collect::<Map<_, _>>()
        };
        let mut found = object(&self.stages);
        found.insert("all".to_owned(), json!(self.stages.iter().map(|(_, ms)| ms).sum::<f64>()));
        found.insert("parallel".to_owned(), Value::Object(object(&self.parallel)));
        Value::Object(found)
    }
}

/// Returns the time since the process started, in milliseconds to the nearest ten; `None` if the system does not tell.
fn process_age_ms() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The name of the program, in parentheses, may contain spaces. The start is field 22, in ticks since the boot.
    let started: f64 = text.rsplit_once(')')?.1.split_whitespace().nth(19)?.parse().ok()?;
    let uptime: f64 =
        std::fs::read_to_string("/proc/uptime").ok()?.split_whitespace().next()?.parse().ok()?;
    Some(((uptime - started / TICKS_PER_SECOND) * 1000.0).max(0.0))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn stages_fill_the_time_without_gaps() {
        let begun = Instant::now();
        let mut times = StageTimes::new();
        let before: f64 = times.stages.iter().map(|(_, ms)| ms).sum();
        std::thread::sleep(Duration::from_millis(20));
        times.end("volume");
        std::thread::sleep(Duration::from_millis(5));
        times.end("look");
        times.attribute("look", "shaders", 3.0);
        times.attribute("nothing", "shaders", 3.0);
        times.end("volume");
        let told = times.to_json();
        let all = told["all"].as_f64().unwrap() - before;
        assert!((all - begun.elapsed().as_secs_f64() * 1000.0).abs() < 5.0, "{told}");
        assert!(told["volume"].as_f64() >= Some(20.0) && told["shaders"].as_f64() == Some(3.0), "{told}");
        let order: Vec<_> =
            times.stages.iter().map(|(stage, _)| *stage).filter(|stage| *stage != "start").collect();
        assert_eq!(order, ["volume", "look", "shaders"]);
        assert_eq!((times.ms("shaders"), times.ms("nothing")), (3.0, 0.0));
    }

    #[test]
    fn parts_that_ran_beside_each_other_are_told_apart_from_stages() {
        let mut times = StageTimes::from_now();
        times.end("volume_and_adapter");
        times.add_parallel("volume", 7.0);
        times.add_parallel("device", 5.0);
        let told = times.to_json();
        assert_eq!(told["parallel"], json!({"volume": 7.0, "device": 5.0}));
        assert_eq!(told["all"], told["volume_and_adapter"], "the parts are not counted again");
    }
}
