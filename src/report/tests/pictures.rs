//! Pictures show what they are given, as PNG and as SVG that stands alone.

use auxetica_report::{
    Axis, Camera, Chart, Curve, Entry, Picture, Pose, Scene, Stripes, View, charts, palette, scenes,
};
use nalgebra::{Point3, Vector3};
use resvg::tiny_skia::Pixmap;

fn pixels(picture: &Picture) -> Pixmap {
    Pixmap::decode_png(&picture.png()).expect("a PNG")
}

/// Share of the pixels that are nearly of this colour.
fn share(map: &Pixmap, colour: palette::Colour) -> f64 {
    let near = |a: u8, b: u8| a.abs_diff(b) < 12;
    let found = map.pixels().iter().filter(|p| {
        near(p.red(), colour.0) && near(p.green(), colour.1) && near(p.blue(), colour.2)
    });
    found.count() as f64 / map.pixels().len() as f64
}

fn chart(y: Axis, points: Vec<(f64, f64)>) -> Chart {
    Chart {
        title: "Title".into(),
        x: Axis::new("x [m]"),
        y,
        curves: vec![Curve::new("curve <&>", palette::VERMILION, points)],
    }
}

#[test]
fn a_chart_has_its_curve_labels_and_size() {
    let chart = chart(Axis::new("y [N]"), vec![(0.0, 1.0), (1.0, 3.0)]);
    let picture = charts(&[chart], 1, (400, 300));
    let map = pixels(&picture);
    assert_eq!((map.width(), map.height()), (800, 600));
    assert!(share(&map, palette::VERMILION) > 1e-3);
    assert!(share(&map, palette::WHITE) > 0.8);
    for text in ["Title", "x [m]", "y [N]", "curve &lt;&amp;&gt;"] {
        assert!(picture.svg().contains(text), "{text}");
    }
    assert!(!picture.svg().contains("href"));
}

#[test]
fn what_a_logarithm_can_not_show_is_left_out() {
    let points = vec![
        (0.0, 0.0),
        (1.0, -1.0),
        (2.0, f64::NAN),
        (3.0, 10.0),
        (4.0, 1000.0),
    ];
    let picture = charts(
        &[chart(Axis::new("y").logarithmic(), points)],
        1,
        (400, 300),
    );
    assert!(share(&pixels(&picture), palette::VERMILION) > 1e-3);
    assert!(!picture.svg().contains("NaN"));
}

#[test]
fn a_chart_without_points_is_drawn() {
    let empty = chart(Axis::new("y"), Vec::new());
    assert!(share(&pixels(&charts(&[empty], 1, (300, 200))), palette::WHITE) > 0.5);
}

#[test]
fn the_nearer_body_hides_the_farther() {
    let camera = Camera {
        target: Point3::origin(),
        azimuth: 0.0,
        elevation: 0.0,
        distance: 1.0,
        height: 0.2,
        up: Vector3::z(),
    };
    let rod = |x: f64, colour| {
        let stripes = Stripes {
            ground: colour,
            stripe: colour,
            count: 4,
        };
        let sections = [-0.08, 0.08].map(|z| Pose::translation(x, 0.0, z));
        let mut scene = Scene::default();
        scene.tube(&sections, 0.02, stripes, 1.0);
        scene
    };
    let mut scene = rod(0.05, palette::BLACK); // towards the camera, which looks along -x
    scene.extend(rod(-0.05, palette::ORANGE));
    let view = View {
        title: "Rods".into(),
        notes: Vec::new(),
        scene,
        camera,
    };
    let map = pixels(&scenes(
        &[view],
        1,
        &[Entry::patch("rod", palette::BLUE)],
        (300, 300),
    ));
    let middle = map.pixel(300, 290).expect("inside");
    assert!(middle.red() < 90 && middle.blue() < 90, "{middle:?}");
}
