//! Tables for people.

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};

/// Widest table, in columns of text.
const WIDEST: u16 = 110;

/// A table with a header; all columns but the first are numbers.
pub(super) fn table(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut table = fitted(presets::UTF8_HORIZONTAL_ONLY, rows);
    table.set_header(header);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.to_string()
}

/// A table with a header, all columns words.
pub(super) fn words(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let mut table = fitted(presets::UTF8_HORIZONTAL_ONLY, rows);
    table.set_header(header);
    table.to_string()
}

/// Columns of words without lines; one column is a paragraph.
pub(super) fn bare(rows: impl IntoIterator<Item = Vec<String>>) -> String {
    fitted(presets::NOTHING, rows).trim_fmt()
}

/// Wrapped to the terminal if there is one.
fn fitted(preset: &str, rows: impl IntoIterator<Item = Vec<String>>) -> Table {
    let mut table = Table::new();
    let terminal = console::Term::stdout().size_checked();
    table
        .load_preset(preset)
        .set_content_arrangement(ContentArrangement::Dynamic)
        .set_width(terminal.map_or(WIDEST, |(_, columns)| columns.min(WIDEST)))
        .add_rows(rows);
    table
}
