//! Benchmark of the table of P §5: light volume and picture by each of the three shadow algorithms.

use serde_json::{Value, json};

use super::VolumeBenchmark;
use super::report::round_to_microsecond;
use crate::cli::CliError;
use chiaroscuro_scene::{ReconstructionKernel, ShadowAlgorithm};

impl VolumeBenchmark<'_> {
    /// Measures light volume and picture by each algorithm of P §5, and compares the ratios with the paper's for the
    /// lobster.
    pub(super) fn paper(
        &mut self,
        cases: &mut Vec<Value>,
        ratios: &mut serde_json::Map<String, Value>,
    ) -> Result<(), CliError> {
        let algorithms = [
            ("paper-1-direct", ShadowAlgorithm::Direct),
            ("paper-2-raycast", ShadowAlgorithm::Raycast),
            ("paper-3-splat", ShadowAlgorithm::Splat),
        ];
        // The same kernel for all three algorithms.
        self.settings.shadows.kernel = ReconstructionKernel::BSpline;
        let mut took = Vec::new();
        for (name, algorithm) in algorithms {
            self.settings.shadows.algorithm = algorithm;
            let mut made = Vec::new();
            let samples = self.light_drag(&mut made)?;
            let mut case = made.swap_remove(0);
            case["name"] = json!(name);
            case["light_volume_ms"] = json!(round_to_microsecond(samples.light_build()));
            cases.push(case);
            took.push((samples.light_build(), samples.eye()));
        }
        let (with, without) = self.orbit(&mut Vec::new())?;
        let [(_, direct), (raycast, _), (splat, frame)] = took[..] else { return Ok(()) };
        let rows = [
            ("light_volume_raycast_over_splat", raycast / splat, 132.0 / 35.0),
            ("picture_direct_over_splat", direct / frame, 44.0 / 29.0),
            // Number of pictures after which a cached light volume has paid off.
            ("pictures_that_pay_a_splatted_light_volume", splat / (direct - frame), 35.0 / (44.0 - 29.0)),
            ("light_volume_over_picture", splat / frame, 1.25),
            // "Comparable" rendering times, according to the paper.
            ("picture_with_over_without_shadows", with.cost() / without.cost(), 1.0),
        ];
        for (name, found, paper) in rows {
            ratios.insert(
                name.to_owned(),
                json!({ "measured": round_to_microsecond(found), "paper": round_to_microsecond(paper) }),
            );
        }
        Ok(())
    }
}
