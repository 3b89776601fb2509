//! Sides of surfaces to which opacity falls, by density.

use rayon::prelude::*;

use chiaroscuro_scene::BakedTransfer;

/// Returns for each entry of a table the balance of rises and falls of extinction around it, each weighted by
/// e^(−distance / 4 entries): 1 where it rises, −1 where it falls.
pub(super) fn opacity_sides(table: &BakedTransfer) -> Vec<f64> {
    let balance = |entry: usize| {
        let (mut rises, mut falls) = (0.0, 0.0);
        for (at, pair) in table.entries.windows(2).enumerate() {
            // Whole entries between this entry and the nearer end of the step.
            let distance = if at >= entry { at - entry } else { entry - at - 1 };
            let step = f64::from(pair[1][3]) - f64::from(pair[0][3]);
            let share = (-(distance as f64) / 4.0).exp();
            rises += share * step.max(0.0);
            falls += share * (-step).max(0.0);
        }
        if rises + falls > 0.0 { (rises - falls) / (rises + falls) } else { 1.0 }
    };
    (0..table.entries.len()).into_par_iter().map(balance).collect()
}
