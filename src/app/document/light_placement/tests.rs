//! Tests of the automatic light placement, in virtual time.

use super::*;
use crate::app::document::easing::EASE_S;
use chiaroscuro_render::LightSuggestion;
use chiaroscuro_scene::LightingRig;

/// Window in virtual time, with 60 frames per second, whose searches take 0.1 s.
struct PlacementTestWindow {
    lights: LightPlacement,
    settings: Settings,
    now_s: f64,
    held: bool,
    complete: bool,
    /// End time of the running search, in seconds.
    searching: Option<f64>,
    searches: usize,
    /// Lights after each frame in which they were set.
    set: Vec<Vec<LightSettings>>,
    answer: Option<LightSearchResult>,
}

impl PlacementTestWindow {
    fn new() -> Self {
        let mut settings = Settings {
            lights: LightingRig::KeyAndFill.lights(&Settings::default().camera),
            ..Settings::default()
        };
        (settings.shadows.balance, settings.output.exposure) = (1.5, 1.2);
        Self {
            lights: LightPlacement::new(&settings),
            answer: Some(LightSearchResult::new(
                LightSuggestion::new(settings.lights.clone(), 5.0, [1.5, 1.2]),
                vec![LightSuggestion::new(
                    LightingRig::ThreeQuarter.lights(&settings.camera),
                    6.0,
                    [1.8, 1.1],
                )],
            )),
            settings,
            now_s: 100.0,
            held: false,
            complete: true,
            searching: None,
            searches: 0,
            set: Vec::new(),
        }
    }

    fn frame(&mut self) {
        self.now_s += 1.0 / 60.0;
        if self.searching.take_if(|end_s| *end_s <= self.now_s).is_some() {
            self.lights.set_result(Ok(self.answer.clone()));
        }
        let Self { now_s, complete, held, .. } = *self;
        match self.lights.next_action(LightPlacementFrame {
            now_s,
            settings: &self.settings,
            is_shown: complete,
            user_active: held,
            limit_s: SEARCH_LIMIT_S,
        }) {
            LightPlacementAction::Nothing => {}
            LightPlacementAction::Search => {
                assert!(complete && self.searching.is_none(), "after the picture, and once");
                self.searches += 1;
                self.searching = Some(now_s + 0.1);
            }
            LightPlacementAction::Set(next) => {
                self.settings = *next;
                self.set.push(self.settings.lights.clone());
            }
        }
    }

    fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds * 60.0) as usize {
            self.frame();
        }
    }
}

/// Lights that the search of these tests finds.
fn proposed() -> Vec<LightSettings> {
    LightingRig::ThreeQuarter.lights(&Settings::default().camera)
}

#[test]
fn lights_move_to_their_places_in_one_short_movement() {
    let mut window = PlacementTestWindow::new();
    let start = window.settings.clone();
    window.run(2.0);
    assert_eq!((window.searches, &window.settings.lights), (1, &proposed()));
    assert!(!window.lights.is_due());
    assert!((window.set.len() as f64 / 60.0 - EASE_S).abs() < 0.05, "{} frames", window.set.len());
    // Never further from the end than before.
    let end = DVec3::from(proposed()[0].position);
    let left: Vec<f64> =
        window.set.iter().map(|lights| DVec3::from(lights[0].position).angle_between(end)).collect();
    assert!(left.windows(2).all(|pair| pair[1] <= pair[0] + 1e-9), "{left:?}");
    assert!((window.settings.shadows.balance - 1.8).abs() < 1e-9);
    assert!((window.settings.output.exposure - 1.1).abs() < 1e-9);
    assert_eq!(Settings { lights: start.lights.clone(), ..start.clone() }.camera, window.settings.camera);
}

#[test]
fn the_picture_comes_first() {
    let mut window = PlacementTestWindow::new();
    window.complete = false;
    window.run(2.0);
    assert_eq!(window.searches, 0);
    window.complete = true;
    window.run(0.1);
    assert_eq!(window.searches, 1);
}

/// Edit that the user may make to a look.
type LookEdit = fn(&mut Settings);

#[test]
fn what_somebody_has_touched_is_left_alone() {
    let touch: [(&str, LookEdit); 4] = [
        ("a light", |settings| settings.lights[0].position = [3.0, 0.0, 0.0]),
        ("its brightness", |settings| settings.lights[1].intensity = 0.5),
        ("the exposure", |settings| settings.output.exposure = 2.0),
        ("the floor", |settings| settings.floor.on = true),
    ];
    for (what, touch) in touch {
        // During the search, and during the easing.
        for after_s in [0.05, 0.3] {
            let mut window = PlacementTestWindow::new();
            window.run(after_s);
            touch(&mut window.settings);
            let touched = window.settings.clone();
            window.run(2.0);
            assert!(window.settings == touched, "{what} after {after_s} s");
            assert!(!window.lights.is_due());
        }
    }
}

#[test]
fn a_touch_ends_the_search() {
    for after_s in [0.0, 0.05] {
        let mut window = PlacementTestWindow::new();
        window.run(after_s);
        let lights = window.settings.lights.clone();
        window.held = true;
        window.settings.camera.orbit(3.0, 0.0);
        window.frame();
        window.held = false;
        window.run(2.0);
        assert!(window.set.is_empty() && window.settings.lights == lights && !window.lights.is_due());
    }
    // Lights that move already finish their way, whatever the view.
    let mut window = PlacementTestWindow::new();
    window.run(0.25);
    assert!(!window.set.is_empty());
    window.held = true;
    window.settings.camera.orbit(3.0, 0.0);
    let camera = window.settings.camera.clone();
    window.run(1.0);
    assert_eq!((&window.settings.lights, &window.settings.camera), (&proposed(), &camera));
}

#[test]
fn lights_do_not_move_after_two_seconds() {
    let mut window = PlacementTestWindow::new();
    window.run(0.05);
    window.searching = Some(window.now_s + SEARCH_LIMIT_S);
    assert!(window.lights.is_searching());
    let before = window.settings.clone();
    window.run(3.0);
    assert!(window.settings == before && !window.lights.is_due() && !window.lights.is_searching());
}

#[test]
fn a_search_that_fails_or_finds_nothing_better_changes_nothing() {
    for answer in
        [None, Some(LightSearchResult::new(LightSuggestion::new(Vec::new(), 5.0, [1.0; 2]), Vec::new()))]
    {
        let mut window = PlacementTestWindow::new();
        let mut answer = answer;
        if let Some(found) = &mut answer {
            found.current.lights.clone_from(&window.settings.lights);
        }
        window.answer = answer;
        let before = window.settings.clone();
        window.run(2.0);
        assert!(window.settings == before && window.set.is_empty() && !window.lights.is_due());
    }
    let mut none = LightPlacement::default();
    let settings = Settings::default();
    let moment = LightPlacementFrame {
        now_s: 1.0,
        settings: &settings,
        is_shown: true,
        user_active: false,
        limit_s: SEARCH_LIMIT_S,
    };
    assert!(!none.is_due() && none.next_action(moment) == LightPlacementAction::Nothing);
}

#[test]
fn a_balance_that_the_window_finds_is_nobodys_touch() {
    let mut window = PlacementTestWindow::new();
    window.complete = false;
    window.run(0.1);
    let before = window.settings.clone();
    window.settings.shadows.balance = 1.9;
    window.lights.accept_change(&before, &window.settings);
    window.complete = true;
    window.run(2.0);
    assert_eq!((window.searches, &window.settings.lights), (1, &proposed()));
    // Scaled by the ratio that the search has found, whatever the balance.
    assert!((window.settings.shadows.balance - 1.9 * 1.8 / 1.5).abs() < 1e-9);
}

#[test]
fn what_was_not_finished_goes_on_in_another_window() {
    for after_s in [0.05, 0.25] {
        let mut window = PlacementTestWindow::new();
        window.run(after_s);
        window.lights = std::mem::take(&mut window.lights).restarted();
        (window.searching, window.now_s) = (None, 0.0);
        window.run(2.0);
        assert_eq!((window.searches, &window.settings.lights), (2, &proposed()), "after {after_s} s");
    }
}

#[test]
fn what_was_sought_on_a_device_that_is_lost_is_sought_again_in_another_window() {
    let mut window = PlacementTestWindow::new();
    window.run(0.05);
    assert_eq!((window.searches, window.searching.take().is_some()), (1, true));
    // The search learns of the loss before the window does.
    window.lights.set_result(Err(GpuError::DeviceLost("gone".to_owned())));
    window.run(0.5);
    assert_eq!(window.searches, 1, "not on that device");
    window.lights = std::mem::take(&mut window.lights).restarted();
    window.run(2.0);
    assert_eq!((window.searches, &window.settings.lights), (2, &proposed()));
    // Other errors would occur again.
    let mut window = PlacementTestWindow::new();
    window.run(0.05);
    window.searching = None;
    window.lights.set_result(Err(GpuError::NothingDrawn("picture")));
    assert!(!window.lights.is_due());
}

#[test]
fn steps_of_the_look_that_was_finished_keep_their_views_alone() {
    let before = HistoryStep::default();
    let mut after = before.settings.clone();
    after.lights[0].position = [0.0, 3.0, 0.0];
    let mut turned = before.clone();
    turned.settings.camera.azimuth_deg = 70.0;
    let done = with_automatic_lights(&turned, &before, &after);
    assert_eq!((&done.settings.lights, &done.settings.camera), (&after.lights, &turned.settings.camera));
    let mut other = before.clone();
    other.settings.shading.ambient = 0.9;
    assert_eq!(with_automatic_lights(&other, &before, &after), other);
    let treated = HistoryStep { treated_as: Some(chiaroscuro_volume::KindName::Mask), ..before.clone() };
    assert_eq!(with_automatic_lights(&treated, &before, &after), treated);
}
