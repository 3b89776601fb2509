//! Easing of automatic changes: their progress over time, and interpolation.
//!
//! Times are in seconds of any monotonic clock.

/// Duration of a change in seconds: long enough to be seen as motion, not as a jump.
pub(super) const EASE_S: f64 = 0.3;

/// Returns the eased progress, from 0 to 1, of a change that began at `since_s`.
pub(super) fn eased_progress(since_s: f64, now_s: f64) -> f64 {
    let t = ((now_s - since_s) / EASE_S).clamp(0.0, 1.0);
    // Smoothstep: the cubic with zero slope at both ends.
    t * t * (3.0 - 2.0 * t)
}

/// Interpolates a positive factor geometrically, since equal ratios look like equal steps.
pub(super) fn interpolate_factor(from: f64, to: f64, share: f64) -> f64 {
    if share >= 1.0 { to } else { from * (to / from).powf(share) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_end_where_they_should() {
        assert_eq!(
            (eased_progress(5.0, 4.0), eased_progress(5.0, 5.0), eased_progress(5.0, 5.0 + EASE_S)),
            (0.0, 0.0, 1.0)
        );
        assert!((eased_progress(5.0, 5.0 + EASE_S / 2.0) - 0.5).abs() < 1e-9);
        assert_eq!((interpolate_factor(2.0, 8.0, 0.5), interpolate_factor(2.0, 0.3, 1.0)), (4.0, 0.3));
    }
}
