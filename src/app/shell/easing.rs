//! Changes that the window makes by itself: when they have to wait for somebody's hands, and how values get to their
//! ends. Times are in seconds, of any clock that does not go back.

use eframe::egui;

/// How long a change takes: seen as a movement, and not as a jump.
pub(super) const EASE_S: f64 = 0.3;

/// Whether somebody holds a button of the pointer or a key, or writes.
pub(super) fn is_held(ctx: &egui::Context) -> bool {
    ctx.input(|input| input.pointer.any_down() || !input.keys_down.is_empty()) || ctx.text_edit_focused()
}

/// The share of its way at which a change is that began at a time: slow at both ends, and 1 when it is there.
pub(super) fn share(since_s: f64, now_s: f64) -> f64 {
    let t = ((now_s - since_s) / EASE_S).clamp(0.0, 1.0);
    // The cubic that is level at both ends.
    t * t * (3.0 - 2.0 * t)
}

/// A factor on its way: equal ratios are equal steps for the eye.
pub(super) fn towards(from: f64, to: f64, share: f64) -> f64 {
    if share >= 1.0 { to } else { from * (to / from).powf(share) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_end_where_they_should() {
        assert_eq!((share(5.0, 4.0), share(5.0, 5.0), share(5.0, 5.0 + EASE_S)), (0.0, 0.0, 1.0));
        assert!((share(5.0, 5.0 + EASE_S / 2.0) - 0.5).abs() < 1e-9);
        assert_eq!((towards(2.0, 8.0, 0.5), towards(2.0, 0.3, 1.0)), (4.0, 0.3));
    }
}
