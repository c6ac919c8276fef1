//! From a scenario's text to a model: bodies built, plugins read, names resolved, every problem reported at once.

use super::{Applied, Model, Scenario, Targets, Watcher, targets::name_and_place};
use crate::group::BodyId;
use crate::hooks::{
    Actuation, BoundaryCondition, Callback, Damping, Drive, Dwell, Forcing, Joint, RodLaw,
};
use crate::inputs::Inputs;
use crate::site::Place;
use crate::system::System;
use crate::view::ReadBody;
use auxetica_config::{Hook, Problem, Problems, Source, remedy};
use ron::value::RawValue;
use std::collections::BTreeMap;

impl Model {
    /// Builds the scenario. `inputs` replace those of the scenario (a recording's motor angles, say).
    pub fn build(source: &Source, inputs: Option<Inputs>) -> Result<Self, Problems> {
        let scenario: Scenario<'_> = source.parse()?;
        let mut builder = Builder {
            source,
            problems: Problems::default(),
            system: System::default(),
            groups: BTreeMap::new(),
        };
        let dwells = builder.inputs(&scenario, inputs);
        builder.bodies(&scenario);
        // Without bodies or inputs everything after would be refused for the wrong reason.
        if !builder.problems.0.is_empty() {
            return Err(builder.problems);
        }
        builder.hooks(&scenario);
        builder.joints(&scenario);
        let watchers = builder.watchers(&scenario);
        builder.markers(&scenario);
        builder.uncertain(&scenario);
        builder.problems.into_result()?;
        Ok(Self {
            title: scenario.title.clone(),
            system: builder.system,
            solver: scenario.solver.clone(),
            dwells,
            markers: scenario.markers,
            capture: scenario.capture,
            motor_loads: scenario.motor_loads,
            watchers,
            stability_limit: None,
        })
    }
}

struct Builder<'a> {
    source: &'a Source,
    problems: Problems,
    system: System,
    /// Names of groups and their bodies.
    groups: BTreeMap<String, Vec<BodyId>>,
}

impl Builder<'_> {
    fn inputs(&mut self, scenario: &Scenario<'_>, given: Option<Inputs>) -> Vec<Dwell> {
        let mut dwells = Vec::new();
        let mut own = Inputs::default();
        if let Some(slot) = scenario.inputs {
            let built = self.source.build::<dyn Actuation>(slot);
            if let Some(actuation) = self.problems.collect(built) {
                dwells = actuation.dwells();
                let inputs = actuation.inputs();
                let inputs = inputs.map_err(|e| self.source.problem_in(slot, e));
                own = self.problems.collect(inputs).unwrap_or_default();
            }
        }
        let mut inputs = given.unwrap_or(own);
        for entry in &scenario.drives {
            let built = self.source.build::<dyn Drive>(entry.apply);
            let Some(drive) = self.problems.collect(built) else {
                continue;
            };
            let wanted = match &entry.on {
                Targets::All => inputs.names().map(str::to_owned).collect(),
                Targets::Named(names) => names.clone(),
            };
            for name in wanted {
                let arrived = match inputs.get(&name) {
                    Some(given) => drive.transmit(given),
                    None => Err(format!(
                        "there is no input `{name}`; {}",
                        remedy(&name, &inputs.names().collect::<Vec<_>>(), "inputs")
                    )),
                };
                match arrived {
                    Ok(series) => inputs.replace(&name, series),
                    Err(e) => self.refuse_in(entry.apply, e),
                }
            }
        }
        self.system = System::new(inputs);
        dwells
    }

    fn bodies(&mut self, scenario: &Scenario<'_>) {
        if scenario.rods.is_empty() && scenario.cylinders.is_empty() {
            self.refuse(
                "rods",
                "the scenario has no bodies; give `rods` or `cylinders`".into(),
            );
        }
        for (i, group) in scenario.rods.iter().enumerate() {
            match group.rods() {
                Err((field, e)) => self.refuse(&format!("rods[{i}].{field}"), e),
                Ok(rods) => {
                    let mut ids = Vec::new();
                    for rod in &rods {
                        let path = format!("rods[{i}].name");
                        if self.is_new(&rod.name, &path)
                            && let Some(id) = self.kept(&path, |system| system.add_rod(rod))
                        {
                            ids.push(id);
                        }
                    }
                    if !group.at.is_empty() && self.is_new(&group.name, &format!("rods[{i}].name"))
                    {
                        self.groups.insert(group.name.clone(), ids);
                    }
                }
            }
        }
        for (i, spec) in scenario.cylinders.iter().enumerate() {
            match spec.cylinder() {
                Err((field, e)) => self.refuse(&format!("cylinders[{i}].{field}"), e),
                Ok(cylinder) => {
                    let path = format!("cylinders[{i}].name");
                    if self.is_new(&cylinder.name, &path) {
                        self.kept(&path, |system| system.add_cylinder(&cylinder));
                    }
                }
            }
        }
    }

    fn hooks(&mut self, scenario: &Scenario<'_>) {
        let rod = |system: &System, id| system.body(id).is_rod();
        let any = |_: &System, _| true;
        self.slot::<dyn RodLaw>(&scenario.laws, rod, System::add_law);
        self.slot::<dyn Forcing>(&scenario.forcing, any, System::add_forcing);
        self.slot::<dyn BoundaryCondition>(&scenario.boundary, any, System::add_boundary);
        self.slot::<dyn Damping>(&scenario.damping, any, System::add_damping);
    }

    /// Reads every plugin of a slot anew for each body, so that each may keep what it remembers of it.
    fn slot<H: ?Sized + Hook>(
        &mut self,
        applied: &[Applied<'_>],
        fits: impl Fn(&System, BodyId) -> bool,
        add: impl Fn(&mut System, BodyId, &str, Box<H>) -> Result<(), String>,
    ) {
        for entry in applied {
            let path = self.path_of_on(entry.apply);
            let name = self.report_name(entry.apply);
            let ids = match &entry.on {
                Targets::All => {
                    let all = self.system.ids().iter().copied();
                    all.filter(|id| fits(&self.system, *id)).collect()
                }
                Targets::Named(names) => self.resolve(names, &path),
            };
            for id in ids {
                let built = self.source.build::<H>(entry.apply);
                let Some(hook) = self.problems.collect(built) else {
                    break;
                };
                if let Err(e) = add(&mut self.system, id, &name, hook) {
                    self.refuse_in(entry.apply, e);
                    break;
                }
            }
        }
    }

    fn joints(&mut self, scenario: &Scenario<'_>) {
        for (i, entry) in scenario.joints.iter().enumerate() {
            let path = format!("joints[{i}].between");
            let (Some(first), Some(second)) = (
                self.sides(&entry.between.0, &path),
                self.sides(&entry.between.1, &path),
            ) else {
                continue;
            };
            let [second] = second.as_slice() else {
                let e = format!(
                    "`{}` is a group; only the first side may be one",
                    entry.between.1
                );
                self.refuse(&path, e);
                continue;
            };
            let name = self.report_name(entry.apply);
            if first.iter().any(|side| side.0 == second.0) {
                let body = self.system.body(second.0);
                let e = format!(
                    "`{}` is on both sides; name another body on one side",
                    body.name()
                );
                self.refuse(&path, e);
                continue;
            }
            for side in first {
                let built = self.source.build::<dyn Joint>(entry.apply);
                let Some(joint) = self.problems.collect(built) else {
                    break;
                };
                if let Err(e) = self.system.add_joint(&name, [side, *second], joint) {
                    self.refuse_in(entry.apply, e);
                    break;
                }
            }
        }
    }

    fn sides(&mut self, text: &str, path: &str) -> Option<Vec<(BodyId, Place)>> {
        let (name, place) = match name_and_place(text) {
            Ok(found) => found,
            Err(e) => {
                self.refuse(path, e);
                return None;
            }
        };
        let ids = self.resolve(&[name.to_owned()], path);
        for id in &ids {
            let body = self.system.body(*id);
            if let Place::Node(node) = place
                && node >= body.nodes()
            {
                let (name, nodes) = (body.name().to_owned(), body.nodes());
                self.refuse(
                    path,
                    format!("`{name}` has no node {node}; give 0 to {}", nodes - 1),
                );
                return None;
            }
        }
        (!ids.is_empty()).then(|| ids.into_iter().map(|id| (id, place)).collect())
    }

    fn watchers(&mut self, scenario: &Scenario<'_>) -> Vec<Watcher> {
        let mut watchers = Vec::new();
        for entry in &scenario.callbacks {
            let path = self.path_of_on(entry.apply);
            let bodies = match &entry.on {
                Targets::All => self.system.ids().to_vec(),
                Targets::Named(names) => self.resolve(names, &path),
            };
            let built = self.source.build::<dyn Callback>(entry.apply);
            if let Some(callback) = self.problems.collect(built) {
                watchers.push(Watcher {
                    name: self.report_name(entry.apply),
                    every: *entry.every,
                    bodies,
                    callback,
                });
            }
        }
        watchers
    }

    fn markers(&mut self, scenario: &Scenario<'_>) {
        for (i, marker) in scenario.markers.iter().enumerate() {
            let earlier = &scenario.markers[..i];
            if earlier.iter().any(|other| other.name == marker.name) {
                self.refuse(
                    &format!("markers[{i}].name"),
                    format!("the name `{}` is taken; give another", marker.name),
                );
            }
            if self.system.find(&marker.on).is_none() {
                let unknown = self.unknown(&marker.on);
                self.refuse(&format!("markers[{i}].on"), unknown);
            }
            if *marker.along > 1.0 {
                self.refuse(
                    &format!("markers[{i}].along"),
                    format!("{} is past the rod's tip; give 0 to 1", *marker.along),
                );
            }
        }
    }

    fn uncertain(&mut self, scenario: &Scenario<'_>) {
        for (i, number) in scenario.uncertain.iter().enumerate() {
            if let Err((field, e)) = number.nominal(self.source) {
                self.refuse(&format!("uncertain[{i}].{field}"), e);
            }
            let earlier = &scenario.uncertain[..i];
            if earlier.iter().any(|other| other.name == number.name) {
                let e = format!("the name `{}` is taken; give another", number.name);
                self.refuse(&format!("uncertain[{i}].name"), e);
            }
        }
    }

    /// The bodies of these names; a name that there isn't is a problem.
    fn resolve(&mut self, names: &[String], path: &str) -> Vec<BodyId> {
        let mut ids = Vec::new();
        for name in names {
            if let Some(group) = self.groups.get(name) {
                ids.extend(group);
            } else if let Some(id) = self.system.find(name) {
                ids.push(id);
            } else {
                let unknown = self.unknown(name);
                self.refuse(path, unknown);
            }
        }
        ids
    }

    fn unknown(&self, name: &str) -> String {
        let bodies = self.system.ids().iter().map(|id| self.system.body(*id));
        let bodies: Vec<_> = bodies.map(|b| b.name().to_owned()).collect();
        let known: Vec<_> = self.groups.keys().chain(&bodies).map(|n| &**n).collect();
        format!(
            "there is no body named `{name}`; {}",
            remedy(name, &known, "bodies")
        )
    }

    fn is_new(&mut self, name: &str, path: &str) -> bool {
        let taken = self.system.find(name).is_some() || self.groups.contains_key(name);
        if taken {
            self.refuse(path, format!("the name `{name}` is taken; give another"));
        }
        !taken
    }

    fn kept<T>(
        &mut self,
        path: &str,
        add: impl FnOnce(&mut System) -> Result<T, String>,
    ) -> Option<T> {
        add(&mut self.system).map_err(|e| self.refuse(path, e)).ok()
    }

    /// The path of the `on:` beside a plugin.
    fn path_of_on(&self, slot: &RawValue) -> String {
        let path = self.source.path_of(slot);
        match path.strip_suffix("apply") {
            Some(entry) => format!("{entry}on"),
            None => path,
        }
    }

    fn report_name(&self, slot: &RawValue) -> String {
        let plugin: String = slot
            .get_ron()
            .trim_start()
            .chars()
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect();
        format!("{plugin} ({})", self.source.path_of(slot))
    }

    fn refuse(&mut self, path: &str, message: String) {
        let problem = |text: &str| self.source.problem(path, text);
        self.problems.0.push(with_remedy(&message, problem));
    }

    fn refuse_in(&mut self, slot: &RawValue, message: String) {
        let problem = |text: &str| self.source.problem_in(slot, text);
        self.problems.0.push(with_remedy(&message, problem));
    }
}

/// Hooks say what is wrong and, after a semicolon, what to do.
fn with_remedy(message: &str, problem: impl Fn(&str) -> Problem) -> Problem {
    match message.split_once("; ") {
        Some((what, remedy)) => problem(what).with_hint(remedy),
        None => problem(message),
    }
}
