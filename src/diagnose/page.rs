//! A diagnosis as one page for the browser, without anything from elsewhere.

use super::verdict::{Diagnosis, Estimated, Kind};
use std::fmt::Write;

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#222}\
    h1{font-size:1.4rem}h2{font-size:1.1rem;margin-top:2rem}.verdict{font-size:1.2rem;padding:1rem;background:#eef4fb;\
    border-left:.4rem solid #2b6cb0}table{border-collapse:collapse}td,th{padding:.25rem .8rem;text-align:right;\
    border-bottom:1px solid #ddd}td:first-child,th:first-child{text-align:left}.bar{display:inline-block;height:.8rem;\
    vertical-align:middle}.before{background:#c05621}.after{background:#2b6cb0}code{background:#f4f4f4;padding:.1rem .3rem}";

/// The page; `scenario` is the file that was diagnosed.
#[must_use]
pub fn page(d: &Diagnosis, scenario: &str) -> String {
    let mut html = format!(
        "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>Diagnosis</title><style>{STYLE}</style>\
         </head><body><h1>Diagnosis of {}</h1><p class=\"verdict\"><b>{}</b> {}</p>",
        escaped(scenario),
        kind(d.verdict),
        escaped(&d.words)
    );
    if !d.effects.is_empty() {
        html += "<h2>What was left out</h2><table><tr><th>effect</th><th>probability</th><th>number</th><th>value</th>\
                 <th>95 %</th><th>unit</th></tr>";
        for e in &d.effects {
            for (i, p) in e.parameters.iter().enumerate() {
                let head = match i {
                    0 => format!(
                        "<td><b>{}</b>: {}<br><code>{}</code></td><td>{:.2}</td>",
                        e.id,
                        escaped(&e.words),
                        escaped(&e.equation),
                        e.probability
                    ),
                    _ => "<td></td><td></td>".into(),
                };
                let _ = write!(html, "<tr>{head}{}</tr>", number(p));
            }
        }
        html += "</table>";
    }
    if let Some(hidden) = &d.hidden {
        let _ = write!(html, "<p>{}</p>", escaped(&hidden.words()));
    }
    if !d.noticeable.is_empty() {
        html +=
            "<h2>What would have been noticed</h2><p>To first order, from these values on:</p><ul>";
        for n in &d.noticeable {
            let _ = write!(html, "<li>{}</li>", escaped(&n.words()));
        }
        html += "</ul>";
    }
    if let Some(e) = &d.experiment {
        let _ = write!(
            html,
            "<h2>What would change the verdict</h2><p>To tell {} apart: {}.</p>",
            e.discriminates.join(", "),
            escaped(&e.words)
        );
    }
    html += "<h2>Where</h2>";
    let _ = write!(
        html,
        "<p>{}.</p><table><tr><th>channel</th><th>share of the mismatch</th></tr>",
        escaped(&d.location.state)
    );
    for c in &d.location.channels {
        let _ = write!(
            html,
            "<tr><td>{} {}</td><td style=\"text-align:left\"><span class=\"bar before\" style=\"width:{:.0}px\"></span> {:.1} %</td></tr>",
            c.body,
            c.channel,
            300.0 * c.share,
            100.0 * c.share
        );
    }
    html += "</table><ul>";
    for t in &d.location.time {
        let _ = write!(
            html,
            "<li>{}: largest from {:.1} to {:.1} s</li>",
            escaped(&t.recording),
            t.seconds[0],
            t.seconds[1]
        );
    }
    html += "</ul><h2>Before and after</h2><table><tr><th>recording</th><th>role</th><th>platform before [mm]</th>\
             <th>after [mm]</th><th></th><th>before [mrad]</th><th>after [mrad]</th></tr>";
    let most = d
        .baseline
        .recordings
        .iter()
        .map(|r| r.position_rmse_mm)
        .fold(1e-9, f64::max);
    for (b, a) in d.baseline.recordings.iter().zip(&d.augmented.recordings) {
        let width = |mm: f64| 200.0 * mm / most;
        let _ = write!(
            html,
            "<tr><td>{}</td><td>{}</td><td>{:.3}</td><td>{:.3}</td><td style=\"text-align:left\"><span class=\"bar before\" \
             style=\"width:{:.0}px\"></span><br><span class=\"bar after\" style=\"width:{:.0}px\"></span></td><td>{:.2}</td>\
             <td>{:.2}</td></tr>",
            escaped(&b.name),
            b.role,
            b.position_rmse_mm,
            a.position_rmse_mm,
            width(b.position_rmse_mm),
            width(a.position_rmse_mm),
            b.rotation_rmse_mrad,
            a.rotation_rmse_mrad
        );
    }
    let _ = write!(
        html,
        "</table><p>Floor: {:.3} mm and {:.2} mrad. Mean squared residual {:.2} before, {:.2} after; the effects explain \
         {:.0} % of what is beyond the noise. Held-out recordings were not fitted to.</p>\
         <h2>Calibrated numbers</h2><table><tr><th>number</th><th>before</th><th>95 %</th><th>unit</th><th>after</th>\
         <th>95 %</th><th>unit</th></tr>",
        d.floor.position_mm,
        d.floor.rotation_mrad,
        d.baseline.reduced_chi2,
        d.augmented.reduced_chi2,
        100.0 * d.explained
    );
    for (b, a) in d.baseline.parameters.iter().zip(&d.augmented.parameters) {
        let cells = |p: &Estimated| {
            number(p)
                .split_once("</td>")
                .map_or(String::new(), |(_, rest)| rest.to_owned())
        };
        let _ = write!(
            html,
            "<tr><td>{}</td>{}{}</tr>",
            escaped(&b.name),
            cells(b),
            cells(a)
        );
    }
    html += "</table><ul>";
    for alarm in &d.alarms {
        let _ = write!(html, "<li>{}</li>", escaped(alarm));
    }
    html += "</ul><h2>The recordings</h2><ul>";
    for line in &d.audit {
        let _ = write!(html, "<li>{}</li>", escaped(line));
    }
    html += "</ul></body></html>\n";
    html
}

fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::None => "Nothing is missing.",
        Kind::Recording => "A fault of the recording.",
        Kind::Effect => "One effect.",
        Kind::Class => "One of several.",
        Kind::Several => "Several effects.",
        Kind::Unexplained => "Not explained.",
    }
}

fn number(p: &Estimated) -> String {
    let [value, interval] = p.figures();
    format!(
        "<td>{}</td><td>{value}</td><td>{interval}</td><td>{}</td>",
        escaped(&p.name),
        escaped(&p.unit)
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
