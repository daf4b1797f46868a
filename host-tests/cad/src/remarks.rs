//! The text of a file without remarks, its pieces between semicolons, and their references.

use std::borrow::Cow;

/// The text with blanks in place of remarks: every other byte keeps its place.
pub fn without_remarks(text: &str) -> Cow<'_, str> {
    if !text.contains("/*") {
        return Cow::Borrowed(text);
    }
    let mut bytes = text.as_bytes().to_vec();
    let (mut is_name, mut is_remark, mut at) = (false, false, 0);
    while at < bytes.len() {
        let ends = is_remark && bytes[at..].starts_with(b"*/");
        is_name ^= !is_remark && bytes[at] == b'\'';
        is_remark |= !is_name && bytes[at..].starts_with(b"/*");
        let length = if ends { 2 } else { 1 };
        if is_remark {
            bytes[at..at + length].iter_mut().filter(|byte| !byte.is_ascii_whitespace()).for_each(|byte| *byte = b' ');
        }
        is_remark &= !ends;
        at += length;
    }
    String::from_utf8(bytes).map_or(Cow::Borrowed(text), Cow::Owned)
}

/// Pieces between semicolons outside names, of a text without remarks.
pub fn pieces(text: &str) -> impl Iterator<Item = &str> {
    let mut is_name = false;
    text.split(move |c| {
        is_name ^= c == '\'';
        c == ';' && !is_name
    })
}

/// The references in fields, outside names.
pub fn references(text: &str) -> Vec<u64> {
    let parts = text.split('\'').step_by(2);
    let words = parts.flat_map(|part| part.split('#').skip(1));
    words.filter_map(|word| word.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remarks_are_blanks_and_names_stay() {
        let text = "/* a; 'b */#1=A('/* no; */');\n#2=/**/B(/*ü\n*/#1);";
        let blank = without_remarks(text);
        assert_eq!(blank.len(), text.len());
        let found: Vec<String> = pieces(&blank).map(|piece| piece.split_whitespace().collect()).collect();
        assert_eq!(found, ["#1=A('/*no;*/')", "#2=B(#1)", ""]);
    }
}
