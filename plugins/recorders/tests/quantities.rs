//! Every quantity is what its name says, and lists of quantities are checked when read.

mod common;

use auxetica_engine::{Body, Callback, ReadBody};
use auxetica_recorders::{Csv, Npz};
use common::{recorder, run};
use nalgebra::Vector3;

const ALL: &str = "[Position, Velocity, Director, Omega, Mass, Inertia, Length, ReferenceLength, RestLength, \
    Dilatation, Tangent, Sigma, Stress, Kappa, Rotation, Twist, Couple, RestVoronoi, TwistLength, BuiltShearStretch, \
    BuiltBendTwist, Force, Torque]";

/// Columns and values of all quantities at index 1 of the rod, where everything exists.
fn expected(rod: &Body<'_>) -> Vec<(String, f64)> {
    let world = |name: &str, unit: &str, v: Vector3<f64>| {
        [("x", v.x), ("y", v.y), ("z", v.z)].map(|(c, value)| (format!("{name}_{c}{unit}"), value))
    };
    let material = |name: &str, unit: &str, v: Vector3<f64>| {
        [("d1", v.x), ("d2", v.y), ("d3", v.z)]
            .map(|(c, value)| (format!("{name}_{c}{unit}"), value))
    };
    let number = |name: &str, value: f64| [(name.to_string(), value)];
    let mut columns = Vec::new();
    columns.extend(world("position", "_m", rod.position(1)));
    columns.extend(world("velocity", "_m_per_s", rod.velocity(1)));
    let [d1, d2, d3] = [0, 1, 2].map(|d| rod.director(1).row(d).transpose());
    columns.extend(world("director_d1", "", d1));
    columns.extend(world("director_d2", "", d2));
    columns.extend(world("director_d3", "", d3));
    columns.extend(material("omega", "_rad_per_s", rod.omega(1)));
    columns.extend(number("mass_kg", rod.mass(1)));
    columns.extend(material("inertia", "_kg_m2", rod.inertia(1)));
    columns.extend(number("length_m", rod.length(1)));
    columns.extend(number("reference_length_m", rod.reference_length(1)));
    columns.extend(number("rest_length_m", rod.rest_length(1)));
    columns.extend(number("dilatation", rod.dilatation(1)));
    columns.extend(world("tangent", "", rod.tangent(1)));
    columns.extend(material("sigma", "", rod.sigma(1)));
    columns.extend(material("stress", "_N", rod.stress(1)));
    columns.extend(material("kappa", "_rad_per_m", rod.kappa(1)));
    columns.extend(material("rotation", "_rad", rod.rotation(1)));
    columns.extend(number("twist_rad_per_m", rod.twist(1)));
    columns.extend(material("couple", "_N_m", rod.couple(1)));
    columns.extend(number("rest_voronoi_m", rod.rest_voronoi(1)));
    columns.extend(number("twist_length_m", rod.twist_length(1)));
    columns.extend(material(
        "built_shear_stretch",
        "_N",
        rod.built_shear_stretch(1),
    ));
    columns.extend(material(
        "built_bend_twist",
        "_N_m2",
        rod.built_bend_twist(1),
    ));
    columns.extend(world("force", "_N", rod.force(1)));
    columns.extend(material("torque", "_N_m", rod.torque(1)));
    columns
}

#[test]
fn every_quantity_is_recorded_under_its_name() {
    let out = tempfile::tempdir().unwrap();
    let mut csv: Csv = recorder(&format!("Csv(file: \"all.csv\", quantities: {ALL})"));
    let mut last = Vec::new();
    run(&mut csv, out.path(), 2, |seen| {
        last = expected(&seen.bodies[0])
    });
    csv.finish().unwrap();

    let mut reader = csv::Reader::from_path(out.path().join("all.csv")).unwrap();
    let headers = reader.headers().unwrap().clone();
    let bodies_rows = common::ELEMENTS + 2;
    let record = reader.records().nth(bodies_rows + 1).unwrap().unwrap();
    let values = record.iter().skip(3).map(|text| text.parse().unwrap());
    let found: Vec<_> = headers
        .iter()
        .skip(3)
        .map(String::from)
        .zip(values)
        .collect();
    assert_eq!(found, last);
}

#[test]
fn position_and_director_are_recorded_unless_named() {
    let out = tempfile::tempdir().unwrap();
    let mut npz: Npz = recorder("Npz(file: \"rods.npz\")");
    run(&mut npz, out.path(), 1, |_| ());
    npz.finish().unwrap();
    let archive = npyz::npz::NpzArchive::open(out.path().join("rods.npz")).unwrap();
    let mut names: Vec<_> = archive.array_names().collect();
    names.sort_unstable();
    let expected = [
        "plate, top.director",
        "plate, top.position",
        "rod.director",
        "rod.position",
        "time",
    ];
    assert_eq!(names, expected);
}

#[test]
fn numbers_that_are_not_finite_are_kept() {
    let out = tempfile::tempdir().unwrap();
    let mut csv: Csv = recorder("Csv(file: \"nan.csv\", quantities: [Velocity])");
    let mut system = common::system();
    csv.start(out.path(), &[]).unwrap();
    system.step(f64::NAN).unwrap_err();
    csv.record(&common::snapshot(&system)).unwrap();
    let mut reader = csv::Reader::from_path(out.path().join("nan.csv")).unwrap();
    let records: Result<Vec<csv::StringRecord>, _> = reader.records().collect();
    assert!(
        records.unwrap()[1]
            .iter()
            .skip(3)
            .all(|value| value == "NaN")
    );
}

#[test]
fn quantities_are_named_once() {
    let wrong = |list: &str| {
        let text = format!("Csv(file: \"a.csv\", quantities: {list})");
        ron::from_str::<Csv>(&text).err().unwrap().to_string()
    };
    assert!(wrong("[Position, Kappa, Position]").contains("Position is named twice"));
    assert!(wrong("[]").contains("name at least one quantity"));
    assert!(wrong("[Colour]").contains("Colour"));
}
