//! Unit vectors of any vectors: also of those whose squared length is no number of 32 bits.

use glam::{Quat, Vec3};

/// The direction of a vector; `None` where it has none.
pub(crate) fn direction(vector: Vec3) -> Option<Vec3> {
    usual(vector).or_else(|| usual(vector.as_dvec3().try_normalize()?.as_vec3()))
}

fn usual(vector: Vec3) -> Option<Vec3> {
    vector.try_normalize().filter(|unit| unit.is_normalized())
}

/// The rotation of a quaternion of any length; `None` where it has none.
pub(crate) fn rotation(quaternion: Quat) -> Option<Quat> {
    let usual = |quaternion: Quat| {
        let length = quaternion.length();
        (length.is_finite() && length > 0.0).then(|| quaternion / length).filter(|unit| unit.is_normalized())
    };
    usual(quaternion).or_else(|| {
        let (wide, length) = (quaternion.as_dquat(), quaternion.as_dquat().length());
        (length.is_finite() && length > 0.0).then(|| (wide / length).as_quat())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    #[test]
    fn lengths_from_the_least_number_to_the_largest_are_taken_away() {
        let towards = vec3(0.6, 0.0, -0.8);
        for length in [f32::from_bits(1) * 100.0, 1e-30, 1e-20, 1e-3, 1.0, 1e18, 3e38] {
            let unit = direction(towards * length).unwrap();
            // The least numbers have few digits.
            assert!(unit.is_normalized() && unit.distance(towards) < 1e-2, "{length}: {unit}");
            let turn = rotation(Quat::from_xyzw(0.6, 0.0, 0.0, -0.8) * length).unwrap();
            assert!(turn.is_normalized() && (turn.x - 0.6).abs() < 1e-2, "{length}: {turn}");
        }
    }

    #[test]
    fn nothing_has_no_direction() {
        for vector in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
            assert_eq!(direction(vector), None);
            assert_eq!(rotation(Quat::from_vec4(vector.extend(0.0))), None);
        }
    }
}
