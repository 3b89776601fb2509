//! Tests of the automatic balance, in virtual time.

use super::*;
use chiaroscuro_scene::LightLock;

/// Window in virtual time, with 60 frames per second, whose measurements take 0.1 s.
struct BalanceTestWindow {
    keeper: AutoBalance,
    settings: Settings,
    now_s: f64,
    held: bool,
    is_shown: bool,
    /// End time of the running measurement in seconds, and the balance that it finds.
    measuring: Option<(f64, f64)>,
    measured: usize,
    /// Balance after each frame in which it was set.
    set: Vec<f64>,
    answer: f64,
}

impl BalanceTestWindow {
    fn new() -> Self {
        let mut settings = Settings::default();
        settings.shadows.keep_balanced = true;
        settings.shadows.balance = 1.2;
        Self {
            keeper: AutoBalance::new(&settings, true),
            settings,
            now_s: 100.0,
            held: false,
            is_shown: true,
            measuring: None,
            measured: 0,
            set: Vec::new(),
            answer: 1.8,
        }
    }

    fn frame(&mut self) {
        self.now_s += 1.0 / 60.0;
        if let Some((_, balance)) = self.measuring.take_if(|(end_s, _)| *end_s <= self.now_s) {
            self.keeper.set_result(self.now_s, Some(balance));
        }
        let moment = BalanceFrame {
            now_s: self.now_s,
            settings: &self.settings,
            is_shown: self.is_shown,
            user_active: self.held,
            busy: self.measuring.is_some(),
        };
        match self.keeper.next_action(moment) {
            BalanceAction::Nothing => {}
            BalanceAction::Wait(wait_s) => assert!(wait_s > 0.0 && wait_s <= DEBOUNCE_S),
            BalanceAction::Measure => {
                assert!(self.measuring.is_none() && !self.held, "one at a time, and never in a drag");
                self.measured += 1;
                self.measuring = Some((self.now_s + 0.1, self.answer));
            }
            BalanceAction::Set(balance) => {
                self.settings.shadows.balance = balance;
                self.set.push(balance);
            }
        }
    }

    fn pass(&mut self, seconds: f64) {
        for _ in 0..(seconds * 60.0).round() as usize {
            self.frame();
        }
    }

    fn brighten(&mut self) {
        self.settings.lights[0].intensity *= 1.1;
    }
}

#[test]
fn a_change_is_followed_once_it_rests() {
    let mut window = BalanceTestWindow::new();
    window.pass(1.0);
    assert_eq!(window.measured, 0, "the first look is balanced");
    window.brighten();
    window.pass(0.2);
    assert_eq!(window.measured, 0, "too soon");
    assert!(window.keeper.is_due(&window.settings));
    window.pass(2.0);
    assert_eq!((window.measured, window.settings.shadows.balance.to_bits()), (1, 1.8f64.to_bits()));
    assert!(window.set.is_sorted() && window.set.len() > 10, "{:?}", window.set);
    assert!(!window.keeper.is_due(&window.settings), "its own change is none");
    window.answer = 0.9;
    window.brighten();
    window.pass(2.0);
    assert_eq!((window.measured, window.settings.shadows.balance.to_bits()), (2, 0.9f64.to_bits()));
}

#[test]
fn nothing_happens_within_a_drag_or_before_the_picture_is_there() {
    let mut window = BalanceTestWindow::new();
    window.held = true;
    for _ in 0..20 {
        window.brighten();
        window.frame();
    }
    window.pass(2.0);
    assert_eq!(window.measured, 0, "held, though it rests");
    (window.held, window.is_shown) = (false, false);
    window.pass(2.0);
    assert_eq!(window.measured, 0, "not drawn yet");
    window.is_shown = true;
    window.pass(2.0);
    assert_eq!((window.measured, window.settings.shadows.balance.to_bits()), (1, 1.8f64.to_bits()));
}

#[test]
fn what_comes_between_drops_the_result() {
    let stirs: [fn(&mut BalanceTestWindow); 3] = [
        BalanceTestWindow::brighten,
        |window| window.held = true,
        |window| window.settings.camera.azimuth_deg += 5.0,
    ];
    for stir in stirs {
        // During the measurement, and during the easing.
        for after_s in [0.3, 0.5] {
            let mut window = BalanceTestWindow::new();
            window.brighten();
            window.pass(after_s);
            assert_eq!(window.measured, 1);
            stir(&mut window);
            window.frame();
            let balance = window.settings.shadows.balance;
            window.held = false;
            window.pass(0.2);
            assert_eq!(window.settings.shadows.balance.to_bits(), balance.to_bits(), "it stops at once");
            window.answer = 1.5;
            window.pass(2.0);
            assert_eq!((window.measured, window.settings.shadows.balance.to_bits()), (2, 1.5f64.to_bits()));
        }
    }
}

#[test]
fn a_late_result_is_waited_for_and_dropped() {
    let mut window = BalanceTestWindow::new();
    window.brighten();
    window.pass(0.3);
    window.measuring = Some((window.now_s + 1.0, 7.0));
    window.brighten();
    window.pass(0.9);
    assert_eq!((window.measured, window.set.len()), (1, 0));
    window.pass(2.0);
    assert_eq!((window.measured, window.settings.shadows.balance.to_bits()), (2, 1.8f64.to_bits()));
    assert!(window.set.iter().all(|&balance| balance < 2.0), "{:?}", window.set);
}

#[test]
fn a_change_that_is_taken_back_half_way_is_followed_back() {
    let mut window = BalanceTestWindow::new();
    let before = window.settings.lights.clone();
    window.brighten();
    window.pass(0.5);
    window.settings.lights = before;
    window.answer = 1.2;
    window.pass(2.0);
    assert_eq!((window.measured, window.settings.shadows.balance.to_bits()), (2, 1.2f64.to_bits()));
}

#[test]
fn small_differences_and_failures_change_nothing() {
    for answer in [1.2 * 1.019, 1.2 * 0.981] {
        let mut window = BalanceTestWindow { answer, ..BalanceTestWindow::new() };
        window.brighten();
        window.pass(3.0);
        assert_eq!((window.measured, window.set.len()), (1, 0));
    }
    let mut window = BalanceTestWindow::new();
    window.brighten();
    window.pass(0.3);
    window.measuring = None;
    window.keeper.set_result(window.now_s, None);
    window.pass(3.0);
    assert_eq!((window.measured, window.set.len()), (1, 0), "not tried again and again");
}

#[test]
fn what_does_not_make_shadows_darker_is_passed_over() {
    let mut window = BalanceTestWindow::new();
    window.settings.lights[0].lock = LightLock::Camera;
    window.keeper.accept(&window.settings);
    let changes: [fn(&mut Settings); 7] = [
        |look| look.camera.azimuth_deg += 30.0,
        |look| look.lights[0].name = "Sun".to_owned(),
        |look| look.floor.on = true,
        |look| look.output.background.top = [1.0; 3],
        |look| look.output.tone_map = chiaroscuro_scene::ToneMap::Clip,
        |look| look.sampling.engine = RenderEngine::Scatter,
        |look| assert!(look.save_view_for_digit(1, "front")),
    ];
    for change in changes {
        change(&mut window.settings);
        window.pass(1.0);
    }
    assert_eq!(window.measured, 0);
    let changes: [fn(&mut Settings); 5] = [
        |look| look.layer_mut().transfer.interpolation = chiaroscuro_scene::OpacityInterpolation::Extinction,
        |look| look.shading.ambient = 0.4,
        |look| look.shadows.strength = 0.5,
        |look| look.cuts.plane.on = true,
        |look| look.layer_mut().opacity_unit = chiaroscuro_scene::OpacityLength::Voxels(3.0),
    ];
    for (count, change) in changes.into_iter().enumerate() {
        change(&mut window.settings);
        window.pass(1.0);
        assert_eq!(window.measured, count + 1);
    }
}

#[test]
fn it_is_off_when_switched_off_and_measures_when_switched_on() {
    let mut window = BalanceTestWindow::new();
    window.settings.shadows.keep_balanced = false;
    window.brighten();
    window.pass(2.0);
    assert_eq!((window.measured, window.set.len()), (0, 0));
    window.settings.shadows.keep_balanced = true;
    window.pass(2.0);
    assert_eq!((window.measured, window.settings.shadows.balance.to_bits()), (1, 1.8f64.to_bits()));
    window.settings.shadows.algorithm = chiaroscuro_scene::ShadowAlgorithm::Off;
    window.brighten();
    window.pass(2.0);
    assert_eq!(window.measured, 1, "without shadows there is nothing to balance");
}

#[test]
fn a_balance_from_elsewhere_stays() {
    let mut window = BalanceTestWindow::new();
    // Set by the button or a session, while something else changes.
    window.brighten();
    window.settings.shadows.balance = 3.0;
    window.pass(2.0);
    // Undo of a step, with the balance that it had.
    window.brighten();
    window.keeper.accept(&window.settings);
    window.pass(2.0);
    assert_eq!((window.measured, window.set.len()), (0, 0));
}
