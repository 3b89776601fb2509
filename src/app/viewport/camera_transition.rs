//! Animated transition between two views, so that the user can follow how the object turns. Only the display is
//! animated: the settings have the new view at once.

use chiaroscuro_scene::Camera;

/// Duration of the transition, in seconds: long enough to follow, too short to wait for.
const TRANSITION_S: f64 = 0.15;

/// Camera transition in progress, if any.
#[derive(Debug, Default)]
pub(crate) struct CameraTransition(Option<CameraTransitionState>);

#[derive(Debug)]
struct CameraTransitionState {
    from: Camera,
    to: Camera,
    since_s: f64,
}

impl CameraTransition {
    /// Starts a transition from one view to another; one that is in progress continues from its current view.
    pub(crate) fn begin(&mut self, from: &Camera, to: &Camera, now_s: f64) {
        if from != to {
            let from = self.current_view(from, now_s).unwrap_or_else(|| from.clone());
            self.0 = Some(CameraTransitionState { from, to: to.clone(), since_s: now_s });
        }
    }

    /// Returns the interpolated view to display instead of `camera`, while a transition to it is in progress.
    pub(crate) fn current_view(&mut self, camera: &Camera, now_s: f64) -> Option<Camera> {
        let shown = self.0.as_ref().filter(|turn| turn.to == *camera).and_then(|turn| {
            let share = (now_s - turn.since_s) / TRANSITION_S;
            // Smoothstep: slow at the start and at the end.
            let eased = share * share * (3.0 - 2.0 * share);
            if share < 1.0 { turn.from.interpolate(&turn.to, eased.max(0.0)) } else { None }
        });
        if shown.is_none() {
            self.0 = None;
        }
        shown
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_begins_where_the_eye_is_and_ends_where_it_goes() {
        let from = Camera::default();
        let to = Camera { azimuth_deg: from.azimuth_deg + 90.0, ..from.clone() };
        let mut turning = CameraTransition::default();
        turning.begin(&from, &to, 10.0);
        assert_eq!(turning.current_view(&to, 10.0), Some(from.clone()));
        let half = turning.current_view(&to, 10.0 + 0.5 * TRANSITION_S).map(|camera| camera.azimuth_deg);
        assert!((half.unwrap_or_default() - from.azimuth_deg - 45.0).abs() < 1e-6, "{half:?}");
        assert_eq!(turning.current_view(&to, 10.0 + TRANSITION_S), None);
        assert_eq!(turning.current_view(&to, 10.0), None, "it has ended");
        // A camera change by the user ends the transition.
        turning.begin(&from, &to, 20.0);
        assert_eq!(turning.current_view(&from, 20.1), None);
    }
}
