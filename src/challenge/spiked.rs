//! Real recordings, moved by what an effect changes in a scenario.

use super::ChallengeError;
use super::spec::Onto;
use crate::compare::{CompareError, film};
use crate::config::Source;
use crate::recordings::{Body, Mocap, MotorAngles, Pose, Recording, Track, to_base, to_world};
use crate::reproduce::Data;

/// A real recording with motion capture.
pub(super) struct Background {
    /// As it is recorded, under the name that cases give it.
    recording: Recording,
    /// Its motors' angles.
    motors: MotorAngles,
}

impl Background {
    /// Reads all recordings, those to train on first.
    ///
    /// # Errors
    /// If one is not there, can't be read, or has no motion capture.
    pub(super) fn read(onto: &Onto) -> Result<Vec<Self>, ChallengeError> {
        let roles = [("train", &onto.train), ("holdout", &onto.holdout)];
        let names = roles
            .iter()
            .flat_map(|(role, names)| names.iter().map(move |name| (role, name)));
        let data = Data::from_environment();
        names
            .enumerate()
            .map(|(i, (role, name))| {
                let folder = data.folder().join("recordings").join(name);
                let mut recording = Recording::read(folder)?;
                recording.require_mocap()?;
                recording.name = format!("{role}_{i}_{}", recording.name);
                Ok(Self {
                    motors: MotorAngles::new(&recording),
                    recording,
                })
            })
            .collect()
    }

    /// Poses of platform and ring of a scenario under the recorded motor angles, from the first row with such on.
    ///
    /// # Errors
    /// If it has no steady state at a row.
    pub(super) fn film(&self, source: &Source) -> Result<Vec<[Pose; 2]>, CompareError> {
        Ok(film(source, &self.motors.time, &self.motors.present)?.poses)
    }

    /// The recording with every pose moved and turned as from the poses `plain` to `changed`.
    pub(super) fn moved(&self, plain: &[[Pose; 2]], changed: &[[Pose; 2]]) -> Recording {
        let moved = |body: Body, b: usize| {
            let track = self.track(body);
            Track::new((0..track.position.len()).map(|row| {
                let k = row.saturating_sub(self.motors.first_row);
                let (from, to) = (&plain[k][b], &changed[k][b]);
                let seen = to_base(&track.pose(row));
                let shift = to.translation.vector - from.translation.vector;
                let turn = to.rotation * from.rotation.inverse();
                let place = seen.translation.vector + shift;
                to_world(&Pose::from_parts(place.into(), turn * seen.rotation))
            }))
        };
        Recording {
            mocap: Some(Mocap {
                base: self.track(Body::Base).clone(),
                platform: moved(Body::Platform, 0),
                ring: moved(Body::Ring, 1),
            }),
            ..self.recording.clone()
        }
    }

    fn track(&self, body: Body) -> &Track {
        let mocap = self.recording.mocap.as_ref();
        mocap.expect("it was read with motion capture").track(body)
    }
}
