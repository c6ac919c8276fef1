//! A spring behind a gap.

use nalgebra::Vector3;

/// Newton's steps until a load is found.
const STEPS: usize = 60;

/// The load of a spring of `stiffness` at a displacement (or rotation) `apart`, along it, if `gap` must be crossed first, to
/// whichever side: `apart = load / stiffness + gap s(load)`, where `s = load / sqrt(load^2 + seating^2)` goes to 1 when the
/// load exceeds what seats the joint.
pub(crate) fn load(apart: Vector3<f64>, stiffness: f64, gap: f64, seating: f64) -> Vector3<f64> {
    let size = apart.norm();
    if gap == 0.0 || stiffness == 0.0 || size == 0.0 {
        return apart * stiffness;
    }
    // displacement is a concave function of load: from below, Newton's method stays below
    let mut load = (stiffness * (size - gap)).max(0.0);
    for _ in 0..STEPS {
        let hypotenuse = load.hypot(seating);
        let reached = load / stiffness + gap * load / hypotenuse;
        let slope = 1.0 / stiffness + gap * seating * seating / hypotenuse.powi(3);
        let step = (size - reached) / slope;
        load += step;
        if step.abs() <= f64::EPSILON * load.abs() {
            break;
        }
    }
    apart * (load / size)
}

#[cfg(test)]
mod tests {
    use super::load;
    use approx::assert_relative_eq;
    use nalgebra::Vector3;

    #[test]
    fn a_gap_is_crossed_before_the_spring_is_felt() {
        let (stiffness, gap, seating) = (1e5, 2e-4, 0.05);
        let along = Vector3::new(0.6, 0.0, -0.8);
        let felt = |apart: f64| load(along * apart, stiffness, gap, seating).dot(&along);
        assert_eq!(
            load(Vector3::zeros(), stiffness, gap, seating),
            Vector3::zeros()
        );
        assert!(felt(0.5 * gap) < seating);
        for force in [0.01, 0.05, 0.3, 5.0, 80.0_f64] {
            let apart = force / stiffness + gap * force / force.hypot(seating);
            assert_relative_eq!(felt(apart), force, max_relative = 1e-9);
            assert_relative_eq!(felt(-apart), -force, max_relative = 1e-9);
        }
    }

    #[test]
    fn no_gap_leaves_the_spring() {
        let apart = Vector3::new(1e-4, -3e-4, 2e-4);
        assert_eq!(load(apart, 1e4, 0.0, 0.05), apart * 1e4);
        assert_eq!(load(apart, 0.0, 1e-3, 0.05), Vector3::zeros());
    }
}
