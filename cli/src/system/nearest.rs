//! The known name that is nearest to an unknown one, for messages.

/// The one of these names that is nearest to a word: fewest letters to put in, take out or replace (Levenshtein).
fn nearest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let letters: Vec<char> = word.chars().collect();
    let edits = |name: &str| {
        let mut row: Vec<usize> = (0..=letters.len()).collect();
        for (i, other) in name.chars().enumerate() {
            let mut diagonal = std::mem::replace(&mut row[0], i + 1);
            for (j, letter) in letters.iter().enumerate() {
                let replaced = diagonal + usize::from(*letter != other);
                diagonal = row[j + 1];
                row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
            }
        }
        row[letters.len()]
    };
    names.into_iter().min_by_key(|name| edits(name))
}

/// The end of a message about a name that is not known.
pub fn meant<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> String {
    nearest(word, names).map_or(String::new(), |name| format!("; the nearest name is {name}"))
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn the_nearest_name_has_the_fewest_edits() {
        let names = ["inner.force.x", "inner.moment.x", "outer.force.x"];
        for (word, near) in [("inner.forc.x", 0), ("iner.momentx", 1), ("outer.force", 2), ("", 0)] {
            assert_eq!(nearest(word, names), Some(names[near]), "{word}");
        }
        assert_eq!(nearest("inner", []), None);
    }
}
