//! Loads of bodies in motion.

use crate::group::Group;
use crate::inputs::Moment;
use crate::view::RateView;

/// Time \[s\] over which damping is asked what it does: short beside any decay, long enough to be seen.
const MOMENT: f64 = 1e-9;

impl Group {
    /// All loads but those of joints, and with them what damping and turning do to rates, so that mass times
    /// acceleration, and inertia over dilatation times angular acceleration, are all that is left (Gazzola et al. 2018,
    /// eq. 2.16, 2.17).
    pub(super) fn loads_in_motion(&mut self, now: &Moment<'_>) {
        self.loads(now);
        self.turning();
        self.damped();
    }

    /// Torques of elements and rigid bodies that turn, and lengthen as they do.
    fn turning(&mut self) {
        let b = &mut self.bodies;
        for k in 0..b.stations() {
            let (omega, momentum) = (b.state.omega.get(k), b.momentum(k));
            let mut torque = momentum.cross(&omega);
            if b.element[k] != 0.0 {
                let spread = b.state.velocity.get(k + 1) - b.state.velocity.get(k);
                torque += momentum * (spread.dot(&b.tangent.get(k)) / b.length[k]);
            }
            b.torque.add(k, torque);
        }
    }

    /// Damping as loads.
    fn damped(&mut self) {
        if self.damping.is_empty() {
            return;
        }
        self.start.velocity.copy_from(&self.bodies.state.velocity);
        self.start.omega.copy_from(&self.bodies.state.omega);
        for d in &self.damping {
            let mut view = RateView::new(&mut self.bodies, d.body);
            d.hook.damp(MOMENT, &mut view);
        }
        let b = &mut self.bodies;
        for k in 0..b.stations() {
            let (velocity, omega) = (self.start.velocity.get(k), self.start.omega.get(k));
            let slowing = (b.state.velocity.get(k) - velocity) / MOMENT;
            b.force.add(k, slowing * b.mass[k]);
            let slowing = (b.state.omega.get(k) - omega) / MOMENT;
            let inertia = b.inertia.get(k) / b.dilatation[k];
            b.torque.add(k, slowing.component_mul(&inertia));
        }
        b.state.velocity.copy_from(&self.start.velocity);
        b.state.omega.copy_from(&self.start.omega);
    }
}

impl crate::bodies::Bodies {
    /// Angular momentum of an element or rigid body, in its own frame; inertia falls with the dilatation.
    fn momentum(&self, k: usize) -> nalgebra::Vector3<f64> {
        let inertia = self.inertia.get(k) / self.dilatation[k];
        inertia.component_mul(&self.state.omega.get(k))
    }
}
