//! Bodies that are computed together.

use crate::bodies::{Bodies, State};
use crate::hooks::{BoundaryCondition, Damping, Forcing, RodLaw};
use crate::inputs::Moment;
use crate::kernel::Pass;
use crate::vectors::Vectors;
use crate::view::{LawView, LoadView, PoseView, RateView};
use rayon::prelude::*;

/// A body of a [`System`](crate::System).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct BodyId {
    pub(crate) group: usize,
    pub(crate) index: usize,
}

/// A hook, the body of its group that it acts on, and what reports call it.
pub(crate) struct Hooked<T: ?Sized> {
    pub(crate) name: String,
    pub(crate) body: usize,
    pub(crate) hook: Box<T>,
}

/// A rod law and where in the state its memory is.
pub(crate) struct HookedLaw {
    pub(crate) name: String,
    pub(crate) body: usize,
    pub(crate) hook: Box<dyn RodLaw>,
    pub(crate) memory: (usize, usize),
}

impl HookedLaw {
    fn view<'a>(&self, bodies: &'a mut Bodies) -> LawView<'a> {
        LawView::new(bodies, self.body, self.memory)
    }
}

/// Bodies that are computed together, with the hooks that act on one body alone.
#[derive(Default)]
pub(crate) struct Group {
    pub(crate) bodies: Bodies,
    pub(crate) laws: Vec<HookedLaw>,
    pub(crate) forcing: Vec<Hooked<dyn Forcing>>,
    pub(crate) boundary: Vec<Hooked<dyn BoundaryCondition>>,
    pub(crate) damping: Vec<Hooked<dyn Damping>>,
    /// Whether the last step has left all as it should be.
    pub(crate) sound: bool,
    /// Whether poses are those of the middle of a step and rates those of its end.
    pub(crate) midway: bool,
    /// Where several steps at once began.
    pub(crate) start: State,
}

impl Group {
    /// Boundary values of positions and frames.
    pub(crate) fn set_values(&mut self, now: &Moment<'_>) {
        for b in &self.boundary {
            b.hook
                .values(now, &mut PoseView::new(&mut self.bodies, b.body));
        }
    }

    /// Boundary values of rates.
    pub(crate) fn set_rates(&mut self, now: &Moment<'_>) {
        for b in &self.boundary {
            b.hook
                .rates(now, &mut RateView::new(&mut self.bodies, b.body));
        }
    }

    /// All loads but those of joints.
    pub(crate) fn loads(&mut self, now: &Moment<'_>) {
        self.internal_loads(now);
        for f in &self.forcing {
            f.hook
                .apply(now, &mut LoadView::new(&mut self.bodies, f.body));
        }
        for b in &self.boundary {
            b.hook
                .loads(now, &mut LoadView::new(&mut self.bodies, b.body));
        }
    }

    fn internal_loads(&mut self, now: &Moment<'_>) {
        let layouts = self.bodies.layouts();
        if self.laws.is_empty() && !layouts.iter().any(|l| l.walled.contains(&true)) {
            self.bodies.sweep(Pass::Elastic);
            return;
        }
        self.bodies.sweep(Pass::Measure);
        if !self.laws.is_empty() {
            self.bodies.as_built();
        }
        for l in &self.laws {
            l.hook.rest(now, &mut l.view(&mut self.bodies));
        }
        // Few laws add to stresses: unless they did in the last evaluation, that is seen to when they have.
        let apart = std::mem::take(&mut self.bodies.stressed);
        self.bodies.sweep(if apart {
            Pass::Strain
        } else {
            Pass::StrainAndLoads
        });
        for l in &self.laws {
            l.hook.stress(now, &mut l.view(&mut self.bodies));
        }
        if apart || self.bodies.stressed {
            self.bodies.sweep(Pass::Loads);
        }
    }

    /// Lets laws remember the present state.
    pub(crate) fn remember(&mut self, now: &Moment<'_>) {
        for l in &self.laws {
            if l.memory.1 > 0 {
                l.hook.remember(now, &mut l.view(&mut self.bodies));
            }
        }
    }

    /// Rates after a step under the present loads, damped and held.
    pub(crate) fn kick(&mut self, now: &Moment<'_>, dt: f64) {
        self.bodies.sweep(Pass::Kick(dt));
        for d in &self.damping {
            d.hook
                .damp(dt, &mut RateView::new(&mut self.bodies, d.body));
        }
        self.set_rates(now);
    }

    /// The name of the hook whose loads are the first that aren't finite, if one is to blame.
    pub(crate) fn culprit(&mut self, now: &Moment<'_>) -> Option<String> {
        self.internal_loads(now);
        let finite = |b: &Bodies| b.force.all_finite() && b.torque.all_finite();
        if !finite(&self.bodies) {
            let bodies = &self.bodies;
            let spoiled = |l: &&HookedLaw| {
                let layout = &bodies.layouts()[l.body];
                let element = |k: usize| {
                    !bodies.rest_length[k].is_finite()
                        || !finite_at(&bodies.shear_stretch, k)
                        || (finite_at(&bodies.sigma, k) && !finite_at(&bodies.stress, k))
                };
                let cell = |k: usize| {
                    !finite_at(&bodies.bend_twist, k)
                        || (finite_at(&bodies.kappa, k) && !finite_at(&bodies.couple, k))
                };
                layout.element_stations().any(element) || layout.cells().any(cell)
            };
            return self.laws.iter().find(spoiled).map(|l| l.name.clone());
        }
        for f in &self.forcing {
            f.hook
                .apply(now, &mut LoadView::new(&mut self.bodies, f.body));
            if !finite(&self.bodies) {
                return Some(f.name.clone());
            }
        }
        for b in &self.boundary {
            b.hook
                .loads(now, &mut LoadView::new(&mut self.bodies, b.body));
            if !finite(&self.bodies) {
                return Some(b.name.clone());
            }
        }
        None
    }
}

fn finite_at(vectors: &Vectors, k: usize) -> bool {
    vectors.get(k).iter().all(|x| x.is_finite())
}

/// Groups in parallel when there are several.
pub(crate) fn each(groups: &mut [Group], work: impl Fn(&mut Group) + Sync + Send) {
    match groups {
        [only] => work(only),
        many => many.par_iter_mut().for_each(work),
    }
}
