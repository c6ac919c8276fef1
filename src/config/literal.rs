//! Lengths of the tokens in which brackets and commas mean nothing: strings and comments.

/// Length of the string, byte string or character with which `text` begins, if it begins with
/// one; an error if it is never closed, with the missing mark.
pub(crate) fn string(text: &str) -> Option<Result<usize, char>> {
    let body = text.trim_start_matches(['b', 'r']);
    let prefix = text.len() - body.len();
    let hashes = body.len() - body.trim_start_matches('#').len();
    let mark = body[hashes..].chars().next()?;
    let length = match (&text.as_bytes()[..prefix], mark) {
        (b"" | b"b", '"' | '\'') if hashes == 0 => quoted(&body[1..], mark),
        (b"r" | b"br", '"') => {
            let end = format!("\"{}", "#".repeat(hashes));
            let inside = body[hashes + 1..].find(&end);
            inside.map(|length| hashes + length + end.len())
        }
        _ => return None,
    };
    Some(length.map(|length| prefix + 1 + length).ok_or(mark))
}

/// Length up to and including the closing mark.
fn quoted(text: &str, mark: char) -> Option<usize> {
    let mut chars = text.char_indices();
    while let Some((at, c)) = chars.next() {
        match c {
            '\\' => _ = chars.next(),
            c if c == mark => return Some(at + 1),
            _ => {}
        }
    }
    None
}

/// Length of the block comment with which `text` begins, if it is closed; they nest.
pub(crate) fn block_comment(text: &str) -> Option<usize> {
    let (mut depth, mut at) = (0, 0);
    loop {
        let rest = &text[at..];
        if rest.starts_with("/*") {
            depth += 1;
            at += 2;
        } else if rest.starts_with("*/") {
            depth -= 1;
            at += 2;
        } else {
            at += rest.chars().next()?.len_utf8();
        }
        if depth == 0 {
            return Some(at);
        }
    }
}

/// Length of the word, or of the single mark, with which `text` begins.
pub(crate) fn token(text: &str) -> usize {
    let is_mark = |c: char| c.is_whitespace() || ",:()[]{}\"'".contains(c);
    let word = &text[..text.find(is_mark).unwrap_or(text.len())];
    let comments = ["//", "/*"].iter().filter_map(|mark| word.find(mark));
    match comments.min().unwrap_or(word.len()) {
        0 => text.chars().next().map_or(0, char::len_utf8),
        length => length,
    }
}
