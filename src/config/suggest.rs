//! "Did you mean": the nearest of the known names, and lists of them.

/// The candidate that `name` is most likely a slip of, if any is near enough.
pub(crate) fn nearest<'a>(name: &str, candidates: &[&'a str]) -> Option<&'a str> {
    let lower = name.to_lowercase();
    let distance = |known: &str| strsim::damerau_levenshtein(&lower, &known.to_lowercase());
    let best = candidates
        .iter()
        .copied()
        .min_by_key(|known| distance(known))?;
    let is_part = name.len() > 2 && best.to_lowercase().contains(&lower);
    (distance(best) <= name.len().div_ceil(3).min(name.len() / 2) || is_part).then_some(best)
}

/// "did you mean `a`? " (if there is a near one) and "kind: `a`, `b`": the remedy for a `name` that isn't known.
pub fn remedy(name: &str, candidates: &[&str], kind: &str) -> String {
    let known = match candidates {
        [] => format!("there are no {kind}"),
        _ => format!("{kind}: {}", quoted(candidates)),
    };
    match nearest(name, candidates) {
        Some(near) => format!("did you mean `{near}`? {known}"),
        None => known,
    }
}

/// "`a`, `b`, `c`"
pub(crate) fn quoted(names: &[&str]) -> String {
    let names: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}
