//! A finished picture.

use crate::canvas::{Area, FINE, IN_MEMORY, know_the_font};
use plotters::prelude::{IntoDrawingArea, SVGBackend, WHITE};
use resvg::{tiny_skia, usvg};
use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

/// Dots of the PNG per point of the picture.
const DOTS: f64 = 2.0;

/// A picture in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    svg: String,
}

impl Picture {
    /// Draws a picture of a size in points.
    pub(crate) fn draw((width, height): (u32, u32), draw: impl FnOnce(&Area<'_>)) -> Self {
        know_the_font();
        let mut svg = String::new();
        let fine = |points: u32| points * FINE as u32;
        {
            let area =
                SVGBackend::with_string(&mut svg, (fine(width), fine(height))).into_drawing_area();
            area.fill(&WHITE).expect(IN_MEMORY);
            draw(&area);
            area.present().expect(IN_MEMORY);
        }
        // the view box keeps the fine unit, the size is told in points
        let told = |w: u32, h: u32| format!("width=\"{w}\" height=\"{h}\"");
        let svg = svg.replacen(&told(fine(width), fine(height)), &told(width, height), 1);
        Self { svg }
    }

    /// The picture as SVG, without any reference to other files.
    #[must_use]
    pub fn svg(&self) -> &str {
        &self.svg
    }

    /// The picture as PNG.
    #[must_use]
    pub fn png(&self) -> Vec<u8> {
        let options = usvg::Options {
            fontdb: Arc::clone(fonts()),
            ..usvg::Options::default()
        };
        let tree = usvg::Tree::from_str(&self.svg, &options).expect("plotters writes good SVG");
        let (width, height) = (tree.size().width(), tree.size().height());
        let dots = |points: f32| (f64::from(points) * DOTS).round() as u32;
        let mut map =
            tiny_skia::Pixmap::new(dots(width), dots(height)).expect("pictures have a size");
        let scale = tiny_skia::Transform::from_scale(DOTS as f32, DOTS as f32);
        resvg::render(&tree, scale, &mut map.as_mut());
        map.encode_png().expect("the picture is encoded in memory")
    }

    /// Writes `NAME.svg` and `NAME.png` into a folder that exists, and tells their paths.
    ///
    /// # Errors
    /// When a file can't be written.
    pub fn save(&self, folder: &Path, name: &str) -> std::io::Result<[PathBuf; 2]> {
        let paths = ["svg", "png"].map(|ending| folder.join(format!("{name}.{ending}")));
        std::fs::write(&paths[0], &self.svg)?;
        std::fs::write(&paths[1], self.png())?;
        Ok(paths)
    }
}

/// The built-in font.
fn fonts() -> &'static Arc<usvg::fontdb::Database> {
    static FONTS: OnceLock<Arc<usvg::fontdb::Database>> = OnceLock::new();
    FONTS.get_or_init(|| {
        let mut fonts = usvg::fontdb::Database::new();
        for font in [dejavu::sans::regular(), dejavu::sans::bold()] {
            fonts.load_font_data(font.to_vec());
        }
        fonts.set_sans_serif_family("DejaVu Sans");
        Arc::new(fonts)
    })
}
