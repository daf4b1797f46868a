//! Where a file stops being one: the line, and the entity that stands there.

use super::statements::statement;
use step_io::Error;

/// What is wrong with a text that the reader does not take, and where.
pub(super) fn message(text: &str, error: &Error) -> String {
    let place = match error {
        Error::UnexpectedEof { .. } => return ended(text),
        Error::Lex(error) => Some((error.span.line, error.span.column)),
        Error::UnexpectedToken { span, .. }
        | Error::MalformedFileSchema { span }
        | Error::InvalidAttributePosition { span, .. }
        | Error::NestingTooDeep { span }
        | Error::TooLarge { span } => Some((span.line, span.column)),
        _ => None,
    };
    let entity = place.and_then(|(line, column)| {
        let before = up_to(text, line as usize, column as usize);
        begun(&before[behind_statements(before)..])
    });
    entity.map_or_else(|| error.to_string(), |entity| format!("{error}, in {entity}"))
}

/// Of a text that is cut off: the line of its end, and the entity there, or the last one before.
fn ended(text: &str) -> String {
    let line = text.trim_end().lines().count().max(1);
    let whole = behind_statements(text);
    let last = || text[..whole].trim_end_matches(';').rsplit(';').find_map(begun);
    let place = begun(&text[whole..])
        .map(|entity| format!("inside {entity}"))
        .or_else(|| last().map(|entity| format!("behind {entity}")))
        .unwrap_or_else(|| "before its first entity".to_owned());
    format!("it ends on line {line}, {place}")
}

/// The text before a place, both numbers from 1.
fn up_to(text: &str, line: usize, column: usize) -> &str {
    let start: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let length = text[start..].char_indices().nth(column.saturating_sub(1)).map(|(at, _)| at);
    &text[..length.map_or(text.len(), |length| start + length)]
}

/// Where the last whole statement ends. A semicolon in a name ends none.
fn behind_statements(text: &str) -> usize {
    let (mut is_name, mut end) = (false, 0);
    for (at, c) in text.char_indices() {
        is_name ^= c == '\'';
        if c == ';' && !is_name {
            end = at + 1;
        }
    }
    end
}

/// The entity that a text begins: its number, and its type as far as it is there.
fn begun(text: &str) -> Option<String> {
    let (id, kind, _) = statement(text)?;
    Some(if kind.is_empty() { format!("#{id}") } else { format!("#{id} ({kind})") })
}

#[cfg(test)]
mod tests {
    use super::ended;

    #[test]
    fn an_end_is_named_by_line_and_entity() {
        let head = "ISO-10303-21;\nHEADER;\n";
        assert_eq!(ended(head), "it ends on line 2, before its first entity");
        let data = format!("{head}DATA;\n#7 = LINE('a;b',#8,#9);\n");
        assert_eq!(ended(&data), "it ends on line 4, behind #7 (LINE)");
        assert_eq!(ended(&format!("{data}#8 = CARTESIAN")), "it ends on line 5, inside #8 (CARTESIAN)");
        assert_eq!(ended(&format!("{data}#8")), "it ends on line 5, behind #7 (LINE)");
        assert_eq!(ended(&format!("{data}#8=")), "it ends on line 5, inside #8");
        assert_eq!(ended(""), "it ends on line 1, before its first entity");
    }
}
