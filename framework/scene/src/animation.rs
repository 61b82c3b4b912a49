//! Key frames to values (glTF 2.0, Appendix C).

use crate::{Channel, Interpolation, Node, Scene, Track, unit};
use glam::{Quat, Vec3, Vec4};
use std::ops::{Add, Mul};

impl Channel {
    /// Sets the node's property to its value at `time` (seconds).
    pub fn apply(&self, time: f32, node: &mut Node) {
        let Some(key) = Key::find(&self.times, time) else { return };
        match &self.track {
            Track::Translation(values) => node.translation = blend(values, key, self.interpolation, Vec3::lerp),
            Track::Scale(values) => node.scale = blend(values, key, self.interpolation, Vec3::lerp),
            Track::Rotation(values) => node.rotation = rotation(values, key, self.interpolation),
        }
    }

    /// Values that belong to one key: 3 for cubic splines, else 1.
    pub fn values_a_key(interpolation: Interpolation) -> usize {
        if interpolation == Interpolation::CubicSpline { 3 } else { 1 }
    }
}

impl Scene {
    /// Time of the last key, in seconds; 0 when nothing is animated.
    pub fn duration(&self) -> f32 {
        self.animation.iter().filter_map(|channel| channel.times.last()).fold(0.0, |last, &time| last.max(time))
    }
}

impl Track {
    /// How many values it holds.
    pub fn len(&self) -> usize {
        match self {
            Track::Translation(values) | Track::Scale(values) => values.len(),
            Track::Rotation(values) => values.len(),
        }
    }

    /// It holds no values.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Where a time falls between keys.
#[derive(Clone, Copy)]
struct Key {
    /// The key at or before it.
    before: usize,
    /// The key after it; `before` itself outside the keys.
    after: usize,
    /// 0 at `before`, 1 at `after`.
    share: f32,
    /// Seconds from `before` to `after`.
    span: f32,
}

impl Key {
    /// `None` when there are no keys.
    fn find(times: &[f32], time: f32) -> Option<Key> {
        let last = times.len().checked_sub(1)?;
        let after = times.partition_point(|&key| key <= time);
        if after == 0 || after > last {
            let held = if after == 0 { 0 } else { last };
            return Some(Key { before: held, after: held, share: 0.0, span: 0.0 });
        }
        let span = times[after] - times[after - 1];
        Some(Key { before: after - 1, after, share: (time - times[after - 1]) / span, span })
    }
}

fn blend<T>(values: &[T], key: Key, interpolation: Interpolation, linear: impl Fn(T, T, f32) -> T) -> T
where
    T: Copy + Mul<f32, Output = T> + Add<Output = T>,
{
    match interpolation {
        Interpolation::Step => values[key.before],
        Interpolation::Linear => linear(values[key.before], values[key.after], key.share),
        Interpolation::CubicSpline => hermite(values, key),
    }
}

/// Cubic Hermite spline: a key's in-tangent, value and out-tangent stand in a row; tangents are per second.
fn hermite<T>(values: &[T], key: Key) -> T
where
    T: Copy + Mul<f32, Output = T> + Add<Output = T>,
{
    let (t, t2, t3) = (key.share, key.share * key.share, key.share * key.share * key.share);
    let (v0, b0) = (values[3 * key.before + 1], values[3 * key.before + 2]);
    let (a1, v1) = (values[3 * key.after], values[3 * key.after + 1]);
    v0 * (2.0 * t3 - 3.0 * t2 + 1.0) + b0 * (key.span * (t3 - 2.0 * t2 + t)) + v1 * (3.0 * t2 - 2.0 * t3) + a1 * (key.span * (t3 - t2))
}

fn rotation(values: &[Quat], key: Key, interpolation: Interpolation) -> Quat {
    if interpolation != Interpolation::CubicSpline {
        return blend_rotation(values, key, interpolation);
    }
    let values: [Vec4; 6] = std::array::from_fn(|i| {
        let base = if i < 3 { 3 * key.before } else { 3 * key.after };
        values[base + i % 3].into()
    });
    let spline = hermite(&values, Key { before: 0, after: 1, ..key });
    unit::rotation(Quat::from_vec4(spline)).unwrap_or(Quat::from_vec4(values[1]))
}

/// `slerp` takes the shorter way round.
fn blend_rotation(values: &[Quat], key: Key, interpolation: Interpolation) -> Quat {
    match interpolation {
        Interpolation::Step => values[key.before],
        _ => values[key.before].slerp(values[key.after], key.share).normalize(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    fn channel(track: Track, interpolation: Interpolation) -> Channel {
        Channel { node: 0, track, times: vec![1.0, 3.0], interpolation }
    }

    fn translation(values: Vec<Vec3>, interpolation: Interpolation, time: f32) -> Vec3 {
        let mut node = Node::default();
        channel(Track::Translation(values), interpolation).apply(time, &mut node);
        node.translation
    }

    #[test]
    fn held_before_and_after() {
        let ends = [vec3(1.0, 2.0, 3.0), vec3(4.0, 5.0, 6.0)];
        for interpolation in [Interpolation::Step, Interpolation::Linear] {
            assert_eq!(translation(ends.to_vec(), interpolation, 0.0), ends[0]);
            assert_eq!(translation(ends.to_vec(), interpolation, 1.0), ends[0]);
            assert_eq!(translation(ends.to_vec(), interpolation, 3.0), ends[1]);
            assert_eq!(translation(ends.to_vec(), interpolation, 9.0), ends[1]);
        }
    }

    #[test]
    fn step_holds_and_linear_is_straight() {
        let ends = vec![Vec3::ZERO, vec3(4.0, 8.0, -4.0)];
        assert_eq!(translation(ends.clone(), Interpolation::Step, 2.9), Vec3::ZERO);
        assert_eq!(translation(ends, Interpolation::Linear, 1.5), vec3(1.0, 2.0, -1.0));
    }

    #[test]
    fn a_spline_reproduces_a_cubic() {
        // p(s) = s³ − 2s² + 3s + 1 on [1, 3], with its own derivatives as tangents.
        let p = |s: f32| s * s * s - 2.0 * s * s + 3.0 * s + 1.0;
        let d = |s: f32| 3.0 * s * s - 4.0 * s + 3.0;
        let values: Vec<Vec3> = [d(1.0), p(1.0), d(1.0), d(3.0), p(3.0), d(3.0)].map(Vec3::splat).to_vec();
        for step in 0..=20 {
            let time = 1.0 + step as f32 * 0.1;
            let found = translation(values.clone(), Interpolation::CubicSpline, time).x;
            assert!((found - p(time)).abs() < 1e-5 * p(time).abs(), "{found} {}", p(time));
        }
        assert_eq!(translation(values.clone(), Interpolation::CubicSpline, 0.0).x, p(1.0));
        assert_eq!(translation(values, Interpolation::CubicSpline, 4.0).x, p(3.0));
    }

    #[test]
    fn rotation_turns_evenly_and_the_short_way() {
        let mut node = Node::default();
        for (end, sign) in [(2.0_f32, 1.0_f32), (2.0, -1.0)] {
            let keys = vec![Quat::IDENTITY, Quat::from_rotation_y(end) * sign];
            let channel = channel(Track::Rotation(keys), Interpolation::Linear);
            for step in 0..=10 {
                let share = step as f32 / 10.0;
                channel.apply(1.0 + 2.0 * share, &mut node);
                let expected = Quat::from_rotation_y(end * share);
                assert!(node.rotation.dot(expected).abs() > 1.0 - 1e-6, "{share}");
                assert!(node.rotation.is_normalized());
            }
        }
    }

    #[test]
    fn a_rotation_spline_is_normalised() {
        let zero = Quat::from_vec4(Vec4::ZERO);
        let (a, b) = (Quat::IDENTITY, Quat::from_rotation_x(1.0));
        let channel = channel(Track::Rotation(vec![zero, a, zero, zero, b, zero]), Interpolation::CubicSpline);
        let mut node = Node::default();
        channel.apply(2.0, &mut node);
        // Flat tangents: half way the spline is the mean of the two, and normalised it is the half turn.
        assert!(node.rotation.abs_diff_eq(Quat::from_rotation_x(0.5), 1e-6));
    }

    #[test]
    fn no_keys_change_nothing() {
        let empty = Channel { node: 0, track: Track::Scale(vec![]), times: vec![], interpolation: Interpolation::Linear };
        let mut node = Node::default();
        empty.apply(1.0, &mut node);
        assert_eq!(node.scale, Vec3::ONE);
    }
}
