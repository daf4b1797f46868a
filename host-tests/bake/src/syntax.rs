//! What a parser of TOML says, with the line wherever there is one to name, and no line of a file in full that fills
//! the screen.

/// Letters of a line that are shown.
const SHOWN: usize = 120;

/// The parser's words about a text.
pub(super) fn message(text: &str, error: &toml::de::Error) -> String {
    if error.span().is_none()
        && let Some(line) = deepest_key(text)
    {
        return format!("TOML parse error at line {line}, column 1\nkeys nested too deeply: {}", error.message());
    }
    let clipped = |line: &str| match line.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", line[..end].trim_end()),
        None => line.to_owned(),
    };
    error.to_string().lines().map(clipped).collect::<Vec<_>>().join("\n")
}

/// The line whose key has the most parts: of all that nests, only a key has no place in the parser's error.
fn deepest_key(text: &str) -> Option<usize> {
    let dots = |line: &str| line.split('=').next().map_or(0, |key| key.matches('.').count());
    // The first of those that are alike.
    text.lines().zip(1..).max_by_key(|(line, number)| (dots(line), usize::MAX - number)).map(|(_, number)| number)
}
