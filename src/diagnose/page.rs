//! A diagnosis as one page for the browser, without anything from elsewhere.

use super::pictures;
use super::verdict::{
    Diagnosis, Estimated, Experiment, Kind, LoadScore, Loads, Prediction, Scored,
};
use std::fmt::Write;

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem;color:#222}\
    h1{font-size:1.4rem}h2{font-size:1.15rem;margin-top:2rem}.verdict{font-size:1.2rem;padding:1rem;background:#eef4fb;\
    border-left:.4rem solid #2b6cb0}table{border-collapse:collapse;margin:.5rem 0}td,th{padding:.25rem .8rem;\
    text-align:right;border-bottom:1px solid #ddd;vertical-align:top}td:first-child,th:first-child,.left{text-align:left}\
    .bar{display:inline-block;height:.8rem;vertical-align:middle}.before{background:#d55e00}.after{background:#0072b2}\
    .part td{font-weight:bold;background:#f4f4f4}code,pre{background:#f4f4f4;padding:.1rem .3rem}\
    pre{padding:.6rem;white-space:pre-wrap;overflow-wrap:anywhere}svg{max-width:100%;height:auto}.interval{white-space:nowrap}";

/// The page; `scenario` is the file that was diagnosed, `commands` are those that make the page again and use its result.
#[must_use]
pub fn page(d: &Diagnosis, scenario: &str, commands: &[String]) -> String {
    let mut html = format!(
        "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" \
         content=\"width=device-width\"><title>Diagnosis of {0}</title><style>{STYLE}</style></head><body>\
         <h1>Diagnosis of {0}</h1><p class=\"verdict\"><b>{1}</b> {2}</p>",
        escaped(scenario),
        kind(d.verdict),
        escaped(&d.words)
    );
    html += &held_out(d);
    html += &effects(d);
    if let Some(e) = &d.experiment {
        html += &experiment(e);
    }
    html += &location(d);
    html += &results(d);
    html += &numbers(d);
    html += &d.loads.as_ref().map_or_else(String::new, loads);
    html += &section("The recordings", &list(d.audit.iter().map(String::as_str)));
    let commands = commands.iter().map(|c| escaped(c)).collect::<Vec<_>>();
    html += &section(
        "Do it again",
        &format!("<pre>{}</pre>", commands.join("\n")),
    );
    html += "</body></html>\n";
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
        Kind::Insufficient => "Too little data.",
    }
}

/// The figures that count, in a sentence.
fn held_out(d: &Diagnosis) -> String {
    let mean = |recordings: &[Scored]| {
        let held = recordings.iter().filter(|r| r.role == "holdout");
        let squares: Vec<f64> = held.map(|r| r.position_rmse_mm.powi(2)).collect();
        (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt()
    };
    let (before, after) = (mean(&d.baseline.recordings), mean(&d.augmented.recordings));
    // effects that show in loads change no pose
    let change = match (before - after).abs() < 1e-9 {
        true => format!("is <b>{before:.3} mm</b>"),
        false => format!("goes from <b>{before:.3} mm</b> to <b>{after:.3} mm</b>"),
    };
    format!(
        "<p>On recordings that nothing was fitted to, the platform's error {change}; noise and mesh make {:.3} mm.</p>",
        d.floor.position_mm
    )
}

fn effects(d: &Diagnosis) -> String {
    let mut html = String::new();
    if !d.effects.is_empty() {
        let mut rows = String::new();
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
                let _ = write!(
                    rows,
                    "<tr>{head}<td class=\"left\">{}</td>{}<td class=\"left\">{}</td></tr>",
                    escaped(&p.name),
                    value(p),
                    escaped(&p.unit)
                );
            }
        }
        html += &section(
            "What was left out",
            &table(
                &["effect", "probability", "number", "value", "95 %", "unit"],
                &rows,
            ),
        );
    }
    if let Some(hidden) = &d.hidden {
        let _ = write!(html, "<p>{}</p>", escaped(&hidden.words()));
    }
    if !d.noticeable.is_empty() {
        let words: Vec<String> = d.noticeable.iter().map(|n| n.words()).collect();
        let all = list(words.iter().map(String::as_str));
        html += &section(
            "What would have been noticed",
            &format!("<p>To first order, from these values on:</p>{all}"),
        );
    }
    html
}

fn experiment(e: &Experiment) -> String {
    let mut html = format!("<p>{}</p>", escaped(&e.sentence()));
    if let Some(power) = e.power() {
        let row = |p: &Prediction| {
            let three = |v: &[f64; 3], digits: usize| {
                v.iter().fold(String::new(), |cells, x| {
                    cells + &format!("<td>{x:.digits$}</td>")
                })
            };
            let (moved, turned) = (three(&p.position_mm, 2), three(&p.rotation_mrad, 1));
            format!("<tr><td>with {}</td>{moved}{turned}</tr>", escaped(&p.id))
        };
        let heads = [
            "the platform then moves and turns by",
            "x [mm]",
            "y [mm]",
            "z [mm]",
            "about x [mrad]",
            "about y [mrad]",
            "about z [mrad]",
        ];
        html += &table(&heads, &e.predictions.iter().map(row).collect::<String>());
        let _ = write!(
            html,
            "<p>{} Axes are those of the base frame.</p>",
            escaped(&power)
        );
    }
    section("What would change the verdict", &html)
}

fn location(d: &Diagnosis) -> String {
    let mut rows = String::new();
    for c in d.location.channels.iter().filter(|c| c.share >= 0.005) {
        let _ = write!(
            rows,
            "<tr><td>{} {}</td><td class=\"left\"><span class=\"bar before\" style=\"width:{:.0}px\"></span> {:.1} %</td></tr>",
            c.body,
            c.channel,
            300.0 * c.share,
            100.0 * c.share
        );
    }
    let times = d.location.time.iter().map(|t| {
        format!(
            "{}: largest from {:.1} to {:.1} s",
            t.recording, t.seconds[0], t.seconds[1]
        )
    });
    let times: Vec<String> = times.collect();
    let channels = table(
        &["channel", "share of the calibrated scenario's mismatch"],
        &rows,
    );
    section(
        "Where",
        &format!(
            "<p>Over time and over states: {}. Pictures hold the samples at rest and on the way.</p>{}{}{channels}{}",
            escaped(&d.location.state),
            pictures::over_time(d),
            pictures::over_winding(d),
            list(times.iter().map(String::as_str))
        ),
    )
}

fn results(d: &Diagnosis) -> String {
    let pairs = || d.baseline.recordings.iter().zip(&d.augmented.recordings);
    let most = pairs().map(|(b, a)| b.position_rmse_mm.max(a.position_rmse_mm));
    let most = most.fold(1e-9, f64::max);
    let bar = |which: &str, mm: f64| {
        let width = 200.0 * mm / most;
        format!("<span class=\"bar {which}\" style=\"width:{width:.0}px\"></span>")
    };
    let mut rows = String::new();
    for (role, words) in [
        ("train", "trained on"),
        ("holdout", "held out: nothing was fitted to these"),
    ] {
        let _ = write!(
            rows,
            "<tr class=\"part\"><td colspan=\"6\">{words}</td></tr>"
        );
        for (b, a) in pairs().filter(|(b, _)| b.role == role) {
            let _ = write!(
                rows,
                "<tr><td>{}</td><td>{:.3}</td><td>{:.3}</td><td class=\"left\">{}<br>{}</td><td>{:.2}</td><td>{:.2}</td></tr>",
                escaped(&b.name),
                b.position_rmse_mm,
                a.position_rmse_mm,
                bar("before", b.position_rmse_mm),
                bar("after", a.position_rmse_mm),
                b.rotation_rmse_mrad,
                a.rotation_rmse_mrad
            );
        }
    }
    let heads = [
        "platform, at rest",
        "before [mm]",
        "after [mm]",
        "",
        "before [mrad]",
        "after [mrad]",
    ];
    section(
        "Before and after",
        &format!(
            "{}<p>Before: the scenario with its own numbers calibrated; after: with what was left out, too. Root mean \
             squares. Noise and mesh make {:.3} mm and {:.2} mrad. Mean squared residual {:.2} before, {:.2} after, where \
             noise alone makes 1; the effects explain {:.0} % of what is beyond noise.</p>",
            table(&heads, &rows),
            d.floor.position_mm,
            d.floor.rotation_mrad,
            d.baseline.reduced_chi2,
            d.augmented.reduced_chi2,
            100.0 * d.explained
        ),
    )
}

fn numbers(d: &Diagnosis) -> String {
    let pairs = d.baseline.parameters.iter().zip(&d.augmented.parameters);
    let row = |(b, a): (&Estimated, &Estimated)| {
        format!(
            "<tr><td>{}</td>{}{}<td class=\"left\">{}</td></tr>",
            escaped(&b.name),
            value(b),
            value(a),
            escaped(&b.unit)
        )
    };
    let rows = pairs.map(row).collect::<String>();
    let heads = ["number", "before", "95 %", "after", "95 %", "unit"];
    let notes = list(d.alarms.iter().map(String::as_str));
    section("Calibrated numbers", &(table(&heads, &rows) + &notes))
}

fn loads(loads: &Loads) -> String {
    let row = |r: &LoadScore| {
        let [before, after] = r.rms.map(|rms| format!("<td>{rms:.2}</td>"));
        let (name, role) = (escaped(&r.name), escaped(&r.role));
        format!("<tr><td>{name}</td><td class=\"left\">{role}</td>{before}{after}</tr>")
    };
    let rows: String = loads.recordings.iter().map(row).collect();
    let heads = ["recording", "role", "before", "after"];
    let [gain, interval] = loads.gain.figures();
    section(
        "The motors' loads",
        &format!(
            "<p>{}</p>{}<p>Root mean squares of predicted less reported loads, in the motors' unit, of which {gain} \
             ({interval}) are 1 N m in this model. Before: the model that explains the poses as far as it does.</p>",
            escaped(&loads.words),
            table(&heads, &rows)
        ),
    )
}

fn section(title: &str, body: &str) -> String {
    format!("<h2>{title}</h2>{body}")
}

fn table(heads: &[&str], rows: &str) -> String {
    let heads: String = heads
        .iter()
        .map(|head| format!("<th>{head}</th>"))
        .collect();
    format!("<table><tr>{heads}</tr>{rows}</table>")
}

fn list<'a>(items: impl Iterator<Item = &'a str>) -> String {
    let items: String = items
        .map(|item| format!("<li>{}</li>", escaped(item)))
        .collect();
    match items.as_str() {
        "" => items,
        _ => format!("<ul>{items}</ul>"),
    }
}

fn value(p: &Estimated) -> String {
    let [value, interval] = p.figures();
    format!("<td>{value}</td><td class=\"interval\">{interval}</td>")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
