//! Names and columns of the files of a recording.

/// A file of a recording: its name and what its columns hold.
pub(crate) struct File {
    pub name: &'static str,
    pub fields: &'static [&'static str],
}

const MOTORS: &[&str] = &["motor 1", "motor 2", "motor 3", "motor 4"];

pub(crate) const TIME: File = File {
    name: "experiment_time_history.csv",
    fields: &["time"],
};
pub(crate) const GOAL: File = File {
    name: "goal_positions_history.csv",
    fields: MOTORS,
};
pub(crate) const PRESENT: File = File {
    name: "present_positions_history.csv",
    fields: MOTORS,
};
pub(crate) const VELOCITIES: File = File {
    name: "present_velocities_history.csv",
    fields: MOTORS,
};
pub(crate) const LOADS: File = File {
    name: "present_loads_history.csv",
    fields: MOTORS,
};
pub(crate) const MOCAP: File = File {
    name: "mocap_frame_data_history.csv",
    fields: &["frame", "body", "qx", "qy", "qz", "qw", "x", "y", "z"],
};
