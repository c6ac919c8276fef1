//! Recordings that conceal something, made by a challenge of one case, and their diagnosis.

use auxetica::challenge::{Concealed, NOMINAL, RECORDINGS, Spec, TRUTH, Truth, conceal};
use auxetica::config::Source;
use auxetica::diagnose::verdict::Diagnosis;
use auxetica::diagnose::{Request, diagnose};
use std::path::{Path, PathBuf};

/// What is concealed.
pub enum Hidden<'a> {
    Nothing,
    /// An effect of the library.
    Effect(&'a str),
    /// An entry of a list of the scenario that no effect makes.
    Foreign(&'a str, &'a str),
}

/// Two recordings to train on and two to judge by.
pub struct Case {
    folder: tempfile::TempDir,
}

impl Case {
    /// Recordings of the robot of the concealed cases, wound by up to `angle` \[rad\], in noise.
    pub fn new(hidden: &Hidden<'_>, seed: u64, angle: f64) -> Self {
        Self::on_mesh(hidden, seed, angle, (12, 14))
    }

    /// The same, its rods divided into a number of elements within these.
    pub fn on_mesh(hidden: &Hidden<'_>, seed: u64, angle: f64, (least, most): (u32, u32)) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let shipped =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot_concealed.ron");
        let (kind, listed, foreign) = match hidden {
            Hidden::Nothing => ("controls", vec![], String::new()),
            Hidden::Effect(id) => ("singles", vec![*id], String::new()),
            Hidden::Foreign(list, entry) => (
                "foreigners",
                vec![],
                format!("(words: \"foreign\", list: {list:?}, entry: {entry:?}, range: (1, 1))"),
            ),
        };
        let count = |which: &str| u8::from(which == kind);
        let spec = format!(
            r#"(
                scenario: {shipped:?}, seed: {seed},
                controls: {controls}, singles: {singles}, doubles: 0, foreigners: {foreigners},
                effects: {listed:?}, foreign: [{foreign}],
                mesh: ("rods[0].elements", {least}, {most}), strength: (1, 1),
                recordings: Simulated(
                    set_points: 9, angle: {angle:?}, speed: 1.05, hold: 1.5, rate: 9.26,
                    noise: (5e-5, 5e-4), bias: (1e-5, 1e-4), jitter: 2e-3,
                ),
            )"#,
            controls = count("controls"),
            singles = count("singles"),
            foreigners = count("foreigners"),
        );
        let file = folder.path().join("spec.ron");
        std::fs::write(&file, spec).expect("written");
        let (spec, nominal) = Spec::load(&file).unwrap_or_else(|e| panic!("{e}"));
        let made = folder.path().join("made");
        conceal(&spec, &nominal, &made, &|_| ()).unwrap_or_else(|e| panic!("{e}"));
        Self { folder }
    }

    fn made(&self) -> PathBuf {
        self.folder.path().join("made")
    }

    /// Folders of the recordings.
    pub fn recordings(&self) -> [PathBuf; 4] {
        RECORDINGS.map(|name| self.made().join("case_000").join(name))
    }

    /// What the effect is that is concealed, if there is one.
    pub fn truth(&self) -> Option<Concealed> {
        let text = std::fs::read_to_string(self.made().join(TRUTH)).expect("it is there");
        let mut truths: Vec<Truth> = serde_json::from_str(&text).expect("it is a list of truths");
        truths[0].effects.pop()
    }

    /// What a diagnosis says with these effects, all if there are none, and the scenario with what it names.
    pub fn diagnosed(&self, effects: &[&str]) -> (Diagnosis, Source) {
        let nominal = self.made().join(NOMINAL);
        let source = Source::load(&nominal, &[]).unwrap_or_else(|e| panic!("{e}"));
        let recordings = self.recordings();
        let (train, holdout) = recordings.split_at(2);
        let effects: Vec<String> = effects.iter().map(|e| (*e).to_owned()).collect();
        let request = Request {
            source: &source,
            train,
            holdout,
            effects: &effects,
            seed: 1,
        };
        diagnose(&request, &|_| ()).unwrap_or_else(|e| panic!("{e}"))
    }
}
