//! Arrays of packages of FMI 3.0: variables of the table whose names differ in a number (`ball[3].inner.load`) or in a component
//! (`inner.force.x`), and in nothing else that a master is told. The rows stay what they are; an array lists the references of its elements.

use super::variables::Variable;

/// An array.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// Name: what the names of its elements have in common.
    pub name: String,
    /// One sentence.
    pub description: String,
    /// Number of elements along each of its dimensions.
    pub dimensions: Vec<usize>,
    /// References of its elements; the last dimension is the fastest.
    pub elements: Vec<u32>,
}

/// Something with a reference of its own that may be an element.
pub struct Element<'a> {
    /// Its reference.
    pub reference: u32,
    /// Its name.
    pub name: &'a str,
    /// One sentence.
    pub description: &'a str,
    /// Row with the type, causality, variability and limits that it has.
    pub row: &'a Variable,
    /// Name of its unit.
    pub unit: &'a str,
}

/// Components by their class; a quaternion has one more of the first.
const LINEAR: [&str; 4] = ["w", "x", "y", "z"];
const ANGULAR: [&str; 3] = ["rx", "ry", "rz"];

/// A name without what tells elements apart, and that.
fn split(name: &str) -> (String, Vec<&str>) {
    // Names that users give may have anything between their quotes.
    let own = name.rfind('\'').map_or(0, |quote| quote + 1);
    let (mut stem, mut rest, mut places) = (name[..own].to_string(), &name[own..], vec![]);
    while let Some((before, place, after)) = rest
        .split_once('[')
        .and_then(|(before, behind)| Some((before, behind.split_once(']')?)))
        .map(|(before, (place, after))| (before, place, after))
    {
        stem.push_str(before);
        places.push(place);
        rest = after;
    }
    let mut components = vec![];
    while let Some((before, last)) = rest.rsplit_once('.')
        && (LINEAR.contains(&last) || ANGULAR.contains(&last))
    {
        components.push(last);
        rest = before;
    }
    stem.push_str(rest);
    components.reverse();
    // A matrix has blocks of different units.
    if components.len() > 1 {
        for component in &components {
            stem.push_str(if LINEAR.contains(component) { ".linear" } else { ".angular" });
        }
    }
    places.extend(components);
    (stem, places)
}

/// The description of all elements, from those of the first and the last one: words that differ are a range.
fn common(first: &str, last: &str) -> String {
    let (of_first, of_last): (Vec<_>, Vec<_>) = (first.split(' ').collect(), last.split(' ').collect());
    if of_first.len() != of_last.len() {
        return first.into();
    }
    let word = |(one, other): (&&str, &&str)| match one == other {
        true => (*one).to_string(),
        false => format!("{} to {other}", one.trim_end_matches(',')),
    };
    of_first.iter().zip(&of_last).map(word).collect::<Vec<_>>().join(" ")
}

/// Elements of one name, as far as they are alike.
fn array(name: String, elements: &[(&Element<'_>, Vec<&str>)]) -> Option<Array> {
    let (first, places) = elements.first()?;
    let nature = |element: &Element<'_>| {
        let Variable { kind, causality, limits, .. } = element.row;
        (*kind, *causality, *limits, element.row.offered().map(|offered| offered.variability))
    };
    let alike = |(element, others): &(&Element<'_>, Vec<&str>)| {
        element.unit == first.unit && nature(element) == nature(first) && others.len() == places.len()
    };
    if !elements.iter().all(alike) {
        return None;
    }
    // Along each dimension, what tells elements apart, in the order of the table.
    let mut along: Vec<Vec<&str>> = vec![vec![]; places.len()];
    for (known, place) in elements.iter().flat_map(|(_, places)| places.iter().enumerate()) {
        if !along[known].contains(place) {
            along[known].push(place);
        }
    }
    let number: usize = along.iter().map(Vec::len).product();
    if number != elements.len() || number < 2 {
        return None;
    }
    let mut grid = vec![None; number];
    for (element, places) in elements {
        let at = along.iter().zip(places).try_fold(0, |at, (all, place)| {
            Some(at * all.len() + all.iter().position(|other| other == place)?)
        })?;
        grid[at] = Some(*element);
    }
    let grid: Vec<&Element<'_>> = grid.into_iter().collect::<Option<_>>()?;
    Some(Array {
        name,
        description: common(grid.first()?.description, grid.last()?.description),
        dimensions: along.iter().map(Vec::len).filter(|length| *length > 1).collect(),
        elements: grid.iter().map(|element| element.reference).collect(),
    })
}

/// All arrays among elements, in the order of the first of each.
pub fn arrays(elements: &[Element<'_>]) -> Vec<Array> {
    let mut by_name: Vec<(String, Vec<_>)> = vec![];
    for element in elements {
        let (stem, places) = split(element.name);
        match by_name.iter_mut().find(|(name, _)| *name == stem) {
            Some((_, alike)) => alike.push((element, places)),
            None => by_name.push((stem, vec![(element, places)])),
        }
    }
    by_name.into_iter().filter_map(|(name, elements)| array(name, &elements)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_split_at_numbers_and_components() {
        for (name, stem, places) in [
            ("friction", "friction", &[][..]),
            ("inner.force.x", "inner.force", &["x"]),
            ("ball[12].inner.load", "ball.inner.load", &["12"]),
            ("left.ball[2].spin.axial", "left.ball.spin.axial", &["2"]),
            ("stiffness.x.rz", "stiffness.linear.angular", &["x", "rz"]),
            ("'a[1].x'.force.y", "'a[1].x'.force", &["y"]),
            ("outer.misalignment.ry", "outer.misalignment", &["ry"]),
        ] {
            assert_eq!(split(name), (stem.to_string(), places.to_vec()), "{name}");
        }
    }

    #[test]
    fn descriptions_tell_the_range() {
        assert_eq!(common("load of ball 1 here", "load of ball 10 here"), "load of ball 1 to 10 here");
        assert_eq!(
            common("away from x, y component", "away from x, z component"),
            "away from x, y to z component"
        );
        assert_eq!(common("force, x, world", "force, z, world"), "force, x to z, world");
        assert_eq!(common("one", "another one"), "one");
    }
}
