//! The discrete Cosserat equations on flat arrays (Gazzola et al. 2018, section 3), phase by phase.
//!
//! Strains, stresses and couples are material; forces on nodes are world, torques on elements material.

use crate::bodies::Bodies;
use crate::rotation;
use nalgebra::Vector3;

impl Bodies {
    /// Element lengths and tangents, and the rotation vectors between neighbouring elements.
    pub(crate) fn measure(&mut self) {
        for (b, layout) in self.layouts.iter().enumerate() {
            for k in layout.element_stations() {
                let edge = self.state.position.get(k + 1) - self.state.position.get(k);
                let length = edge.norm();
                self.length[k] = length;
                self.tangent.set(k, edge / length);
            }
            for k in layout.cells() {
                let before = if k == layout.first {
                    self.walls[b][0]
                } else {
                    self.state.director.get(k - 1)
                };
                let after = if k == layout.first + layout.elements {
                    self.walls[b][1]
                } else {
                    self.state.director.get(k)
                };
                self.rotation.set(k, rotation::between(&before, &after));
            }
        }
    }

    /// Strains and linear elastic loads from the measures and from what the rod laws set (eq. 2.12, 2.13, 2.18).
    pub(crate) fn strain(&mut self) {
        for layout in &self.layouts {
            for k in layout.element_stations() {
                let dilatation = self.length[k] / self.rest_length[k];
                self.dilatation[k] = dilatation;
                let sigma =
                    self.state.director.get(k) * self.tangent.get(k) * dilatation - Vector3::z();
                self.sigma.set(k, sigma);
                let elastic =
                    (sigma - self.rest_sigma.get(k)).component_mul(&self.shear_stretch.get(k));
                self.stress.set(k, elastic);
            }
            let last = layout.first + layout.elements;
            for k in layout.cells() {
                let (rest, length) = if k == layout.first {
                    (self.rest_length[k] / 2.0, self.length[k] / 2.0)
                } else if k == last {
                    (self.rest_length[k - 1] / 2.0, self.length[k - 1] / 2.0)
                } else {
                    (
                        (self.rest_length[k - 1] + self.rest_length[k]) / 2.0,
                        (self.length[k - 1] + self.length[k]) / 2.0,
                    )
                };
                self.rest_voronoi[k] = rest;
                self.voronoi_dilatation[k] = length / rest;
                let theta = self.rotation.get(k);
                // Twist is referred to its own length, so that a law that lengthens the rod need not dilute it.
                let kappa = Vector3::new(
                    theta.x / rest,
                    theta.y / rest,
                    theta.z / self.twist_length[k],
                );
                self.kappa.set(k, kappa);
                let elastic =
                    (kappa - self.rest_kappa.get(k)).component_mul(&self.bend_twist.get(k));
                self.couple.set(k, elastic);
            }
        }
    }

    /// Internal forces on nodes \[N\] and torques on elements \[N m\] from stresses and couples; overwrites the loads
    /// (eq. 3.2, 3.3 without the inertial terms).
    pub(crate) fn internal_loads(&mut self) {
        for layout in &self.layouts {
            let last = layout.first + layout.elements;
            let mut previous_force = Vector3::zeros();
            let (mut previous_couple, mut previous_transport) =
                self.cell_loads(layout, layout.first);
            for k in layout.element_stations() {
                let director = self.state.director.get(k);
                let stress = self.stress.get(k);
                let force = director.tr_mul(&stress) / self.dilatation[k];
                self.force.set(k, force - previous_force);
                previous_force = force;

                let (couple, transport) = self.cell_loads(layout, k + 1);
                let shear = (director * self.tangent.get(k)).cross(&stress) * self.rest_length[k];
                self.torque.set(
                    k,
                    couple - previous_couple + (transport + previous_transport) / 2.0 + shear,
                );
                (previous_couple, previous_transport) = (couple, transport);
            }
            self.force.set(last, -previous_force);
            if !layout.is_rod() {
                self.torque.set(last, Vector3::zeros());
            }
        }
    }

    /// Couple over dilatation cubed, and the couple that the cell's own rotation transports.
    #[inline]
    fn cell_loads(&self, layout: &crate::bodies::Layout, k: usize) -> (Vector3<f64>, Vector3<f64>) {
        if !layout.cells().contains(&k) {
            return (Vector3::zeros(), Vector3::zeros());
        }
        let couple = self.couple.get(k) / self.voronoi_dilatation[k].powi(3);
        (
            couple,
            self.kappa.get(k).cross(&couple) * self.rest_voronoi[k],
        )
    }

    /// Velocities and angular velocities after `dt` under the present loads (eq. 2.16, 2.17).
    pub(crate) fn kick(&mut self, dt: f64) {
        for layout in &self.layouts {
            for k in layout.first..layout.first + layout.nodes() {
                let change = self.force.get(k) * (dt / self.mass[k]);
                self.state.velocity.add(k, change);
            }
        }
        for layout in &self.layouts {
            for k in layout.first..layout.first + layout.directors() {
                let inertia = self.inertia.get(k);
                let omega = self.state.omega.get(k);
                let (e, torque) = (self.dilatation[k], self.torque.get(k));
                let stretching = if layout.is_rod() {
                    self.stretch_rate[k] / e
                } else {
                    0.0
                };
                let rate = |omega: Vector3<f64>| {
                    let momentum = inertia.component_mul(&omega) / e;
                    let torque = torque + momentum.cross(&omega) + momentum * stretching;
                    torque.component_div(&inertia) * e
                };
                // These torques depend on the rate itself: taken at the middle of the step, or a tumbling body would
                // converge at first order only.
                let change = rate(omega + rate(omega) * (dt / 2.0)) * dt;
                self.state.omega.add(k, change);
            }
        }
    }

    /// Rates of the dilatations \[1/s\], which the unsteady term of [`Bodies::kick`] reads before velocities change.
    pub(crate) fn measure_rates(&mut self) {
        for layout in &self.layouts {
            for k in layout.element_stations() {
                let spread = self.state.velocity.get(k + 1) - self.state.velocity.get(k);
                self.stretch_rate[k] = spread.dot(&self.tangent.get(k)) / self.rest_length[k];
            }
        }
    }

    /// Moves every node and frame with its present rates for `dt` (half a step of position Verlet).
    pub(crate) fn drift(&mut self, dt: f64) {
        self.state.position.add_scaled(dt, &self.state.velocity);
        for layout in &self.layouts {
            for k in layout.first..layout.first + layout.directors() {
                let frame = self.state.director.get(k);
                let turn = self.state.omega.get(k) * dt;
                self.state.director.set(k, rotation::turned(&frame, &turn));
            }
        }
    }
}
