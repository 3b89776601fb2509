//! Pictures in the order in which they lie, and where they lie.
//!
//! The order is that of their positions across the pictures, never that of their numbers. Several that lie at each position
//! are time steps, or what else was measured several times.

use std::cmp::Ordering;

use glam::{DAffine3, DMat3, DVec3};

use super::super::placement::Placement;
use super::groups::Slice;
use super::header::plane::{Plane, Taken};

/// Positions that are nearer to each other than this share of what lies between two on average are the same.
const SAME_POSITION: f64 = 0.01;

/// Positions that differ by less are the same in any case: files have six digits.
const SAME_POSITION_MM: f64 = 1e-6;

/// How far from where it should be a slice may lie, as a share of the distance between two, before users are told.
const EVEN: f64 = 0.05;

/// Distances that are longer than the usual one by this factor are gaps.
const GAP: f64 = 1.5;

/// Pictures in order.
#[derive(Debug)]
pub(super) struct Stack {
    /// Volumes, each with its slices from the lowest to the highest, and what sets it apart from others.
    pub(super) steps: Vec<(String, Vec<Slice>)>,
    pub(super) placement: Placement,
}

impl Stack {
    /// Puts pictures that lie in parallel in order. There is at least one.
    pub(super) fn of(mut slices: Vec<Slice>) -> Self {
        let normal = slices.first().and_then(|slice| slice.plane.normal());
        let along = |slice: &Slice| Some(slice.plane.position?.dot(normal?)).filter(|at| at.is_finite());
        let Some(mut at) = slices.iter().map(along).collect::<Option<Vec<f64>>>() else {
            return Self::unplaced(slices);
        };
        // By position, then by time: the sort is stable, so that what says neither stays in the order of its file.
        let mut order: Vec<usize> = (0..slices.len()).collect();
        order.sort_by(|&a, &b| at[a].total_cmp(&at[b]));
        slices = order.iter().map(|&index| slices[index]).collect();
        at = order.iter().map(|&index| at[index]).collect();
        let span = at.last().unwrap_or(&0.0) - at.first().unwrap_or(&0.0);
        let same = (span / slices.len() as f64 * SAME_POSITION).max(SAME_POSITION_MM);
        let mut positions: Vec<Vec<Slice>> = Vec::new();
        let mut last = f64::NEG_INFINITY;
        for (slice, at) in slices.into_iter().zip(at) {
            if at - last > same {
                positions.push(Vec::new());
                last = at;
            }
            if let Some(position) = positions.last_mut() {
                position.push(slice);
            }
        }
        for position in &mut positions {
            position.sort_by(by_time);
        }
        if positions.len() == 1 && positions[0].len() > 1 {
            let slices = positions.swap_remove(0);
            let is_film = slices.iter().all(|slice| slice.plane.has_own_position);
            return if is_film { Self::film(slices) } else { Self::unplaced(slices) };
        }
        let mut remarks = Vec::new();
        let steps = time_steps(positions, &mut remarks);
        let mut placement =
            steps.first().map_or_else(Placement::unknown, |(_, slices)| place(slices, &mut remarks));
        placement.remarks.extend(remarks);
        Self { steps, placement }
    }

    /// Pictures that lie all at one place, taken one after the other.
    fn film(slices: Vec<Slice>) -> Self {
        let mut placement = Placement::unknown();
        placement.remarks.push(format!(
            "its {} pictures lie all at one place: they are stacked in the order in which they were taken",
            slices.len()
        ));
        Self { steps: vec![(String::new(), slices)], placement }
    }

    /// Pictures of which it is not said where each lies: in their order.
    fn unplaced(mut slices: Vec<Slice>) -> Self {
        slices.sort_by(by_time);
        let count = slices.len();
        let plane = slices.first().map(|slice| slice.plane).unwrap_or_default();
        let mut remarks = Vec::new();
        let depth = depth(&slices, &mut remarks);
        let placement = match (plane.spacing, depth) {
            (Some(_), Some(depth)) if plane.position.is_some() && plane.normal().is_some() => {
                // Some say the direction by the sign.
                let sign = plane.between.map_or(1.0, f64::signum);
                placed(&plane, plane.normal().map(|normal| normal * depth * sign))
            }
            (Some([between_rows, between_columns]), Some(depth)) => {
                Placement::spaced([between_columns, between_rows, depth])
            }
            // How pixels compare is known.
            (Some([between_rows, between_columns]), None) => {
                Placement::spaced([between_columns, between_rows, between_rows]).of_unknown_scale()
            }
            _ => Placement::unknown(),
        };
        if count > 1 && !placement.is_scale_known {
            remarks.push(format!(
                "the file does not say how its {count} pictures lie: they are stacked in their order"
            ));
        }
        let placement = Placement { remarks: [placement.remarks.clone(), remarks].concat(), ..placement };
        Self { steps: vec![(String::new(), slices)], placement }
    }
}

/// The order of pictures that lie at one place.
fn by_time(a: &Slice, b: &Slice) -> Ordering {
    let both = a.plane.taken.order().into_iter().zip(b.plane.taken.order());
    both.map(|(a, b)| a.total_cmp(&b)).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
}

/// One volume for each of the pictures that every position has; else of each position the first.
fn time_steps(positions: Vec<Vec<Slice>>, remarks: &mut Vec<String>) -> Vec<(String, Vec<Slice>)> {
    let each = positions.first().map_or(0, Vec::len);
    if positions.iter().any(|position| position.len() != each) {
        let total: usize = positions.iter().map(Vec::len).sum();
        remarks.push(format!(
            "{} of {total} pictures lie where others do: the first of each place are shown",
            total - positions.len()
        ));
        let firsts = positions.into_iter().filter_map(|position| position.into_iter().next());
        return vec![(String::new(), firsts.collect())];
    }
    let taken: Vec<Taken> = positions.first().into_iter().flatten().map(|slice| slice.plane.taken).collect();
    let name = |step: usize| {
        let other = taken.get(usize::from(step == 0)).or(taken.first());
        match (taken.get(step), other) {
            (Some(this), Some(other)) if each > 1 => this.apart_from(other),
            _ => String::new(),
        }
    };
    (0..each).map(|step| (name(step), positions.iter().map(|position| position[step]).collect())).collect()
}

/// Where slices lie that are in order and have positions.
fn place(slices: &[Slice], remarks: &mut Vec<String>) -> Placement {
    let [Some(first), Some(last)] = [slices.first(), slices.last()] else { return Placement::unknown() };
    let ([Some(origin), Some(end)], Some(normal)) =
        ([first, last].map(|slice| slice.plane.position), first.plane.normal())
    else {
        return Placement::unknown();
    };
    let across = if slices.len() > 1 {
        (end - origin) / (slices.len() - 1) as f64
    } else {
        match depth(slices, remarks) {
            Some(depth) => normal * depth,
            None => return Placement::unknown(),
        }
    };
    if first.plane.spacing.is_none() {
        remarks.push("the file does not say how far its pixels lie apart".to_owned());
    }
    check_evenness(slices, origin, across, normal, remarks);
    placed(&first.plane, Some(across))
}

/// Where slices lie of which the lowest lies so, and each other higher by so much.
fn placed(lowest: &Plane, across: Option<DVec3>) -> Placement {
    let (Some(origin), Some([along_row, along_column]), Some([between_rows, between_columns]), Some(across)) =
        (lowest.position, lowest.orientation, lowest.spacing, across)
    else {
        return Placement::unknown();
    };
    // Pictures are not mirrored by a sign that cannot be.
    let remark = (between_rows < 0.0 || between_columns < 0.0).then(|| {
        format!("distances of {between_columns} x {between_rows} mm between pixels cannot be: they are taken without signs")
    });
    let along_row = along_row * between_columns.abs();
    let axes = DMat3::from_cols(along_row, along_column * between_rows.abs(), across);
    Placement::lps(DAffine3 { matrix3: axes, translation: origin }).remarked(remark)
}

/// How far slices lie apart whose positions do not tell.
fn depth(slices: &[Slice], remarks: &mut Vec<String>) -> Option<f64> {
    let plane = slices.first()?.plane;
    let is_usable = |depth: &f64| *depth != 0.0;
    let between = plane.between.filter(is_usable).map(f64::abs);
    if slices.len() > 1 {
        return between;
    }
    let thickness = between.or(plane.thickness.filter(is_usable).map(f64::abs));
    thickness.or_else(|| {
        let [between_rows, _] = plane.spacing?;
        remarks.push(
            "the file does not say how thick its slice is: it is taken for as thick as pixels are".to_owned(),
        );
        Some(between_rows)
    })
}

/// Says where slices are missing, unevenly far apart, or pushed aside.
fn check_evenness(slices: &[Slice], origin: DVec3, across: DVec3, normal: DVec3, remarks: &mut Vec<String>) {
    let positions: Vec<DVec3> = slices.iter().filter_map(|slice| slice.plane.position).collect();
    let mean = across.length();
    let aside = across - normal * across.dot(normal);
    if aside.length() > EVEN * mean {
        remarks.push("its slices lie aslant above each other, as a tilted scanner takes them".to_owned());
    }
    let places = positions.iter().enumerate();
    let furthest =
        places.map(|(at, place)| (*place - origin - across * at as f64).length()).fold(0.0, f64::max);
    if furthest <= EVEN * mean {
        return;
    }
    let mut distances: Vec<f64> = positions.windows(2).map(|two| (two[1] - two[0]).dot(normal)).collect();
    distances.sort_by(f64::total_cmp);
    let [Some(shortest), Some(longest)] = [distances.first(), distances.last()] else { return };
    let usual = distances[distances.len() / 2];
    let missing: f64 =
        distances.iter().filter(|d| **d > GAP * usual).map(|d| (d / usual).round() - 1.0).sum();
    remarks.push(if missing > 0.0 {
        format!(
            "about {missing} slices are missing: most are {usual:.4} mm apart, some {longest:.4} mm; they are shown \
             {mean:.4} mm apart"
        )
    } else {
        format!("its slices are {shortest:.4} to {longest:.4} mm apart: they are shown {mean:.4} mm apart")
    });
}
