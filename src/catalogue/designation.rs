//! Designations as they stand on the box: a maker's name, prefixes, series and bore, then what makers add.
//!
//! Series and bore are what the table is looked up by. Of the rest, clearance, contact angle and balls of silicon nitride change a scene;
//! everything else is named as not simulated, whether it is known or not.

use super::{CatalogueError, Clearance, Entry, table};

/// A designation that was found in the table.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Named {
    /// Its row.
    pub row: Entry,
    /// Class of the radial clearance, if it names one.
    pub clearance: Option<Clearance>,
    /// Are its balls of silicon nitride?
    pub hybrid: bool,
    /// Parts of the designation that no scene has, with their meaning.
    pub ignored: Vec<String>,
}

/// Makers, whose names stand before designations.
const MAKERS: [&str; 24] = [
    "SKF",
    "FAG",
    "INA",
    "NSK",
    "NTN",
    "SNR",
    "KOYO",
    "JTEKT",
    "NACHI",
    "TIMKEN",
    "FAFNIR",
    "RHP",
    "ZVL",
    "ZKL",
    "KINEX",
    "CX",
    "FBJ",
    "EZO",
    "NMB",
    "GMN",
    "SCHAEFFLER",
    "MTK",
    "CRAFT",
    "IBC",
];

/// Effect of a part of a designation.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    /// A class of the radial clearance.
    Class(Clearance),
    /// Balls of silicon nitride.
    Hybrid,
    /// Nothing that is simulated, in words.
    Other(&'static str),
}

const SEALS: Part = Part::Other("seals");
const SHIELDS: Part = Part::Other("shields");
const CAGE: Part = Part::Other("kind of cage");
const TOLERANCE: Part = Part::Other("tolerance class");
const MATCHED: Part = Part::Other("matching in pairs");
const GREASE: Part = Part::Other("grease");

/// Parts behind the number. Of those that begin alike the longer one is taken.
#[rustfmt::skip]
const SUFFIXES: [(&str, Part); 105] = [
    ("C2", Part::Class(Clearance::C2)), ("CN", Part::Class(Clearance::CN)), ("C3", Part::Class(Clearance::C3)),
    ("C4", Part::Class(Clearance::C4)), ("C5", Part::Class(Clearance::C5)),
    ("CM", Part::Other("clearance of electric motors, near CN")), ("EM", Part::Other("quality for electric motors")),
    ("HC5", Part::Hybrid), ("HC", Part::Hybrid), ("SN24", Part::Hybrid), ("HYB", Part::Hybrid),
    ("2RSH2", SEALS), ("2RSH", SEALS), ("2RSL", SEALS), ("2RSR", SEALS), ("2RS1", SEALS), ("2RS2", SEALS), ("2RS", SEALS),
    ("2RZ", SEALS), ("2HRS", SEALS), ("2BRS", SEALS), ("2TS", SEALS), ("2NSE9", SEALS), ("2NSE", SEALS), ("RSH", SEALS),
    ("RSL", SEALS), ("RSR", SEALS), ("RS1", SEALS), ("RS", SEALS), ("RZ", SEALS), ("DDU", SEALS), ("DDW", SEALS), ("DD", SEALS),
    ("VV", SEALS), ("LLU", SEALS), ("LLB", SEALS), ("LLH", SEALS), ("LLC", SEALS), ("LU", SEALS), ("LB", SEALS), ("EE", SEALS),
    ("2ZR", SHIELDS), ("2Z", SHIELDS), ("ZZE", SHIELDS), ("ZZ1", SHIELDS), ("ZZ", SHIELDS), ("Z", SHIELDS),
    ("NR", Part::Other("snap ring")), ("N", Part::Other("groove for a snap ring")), ("K", Part::Other("tapered bore")),
    ("TN9", CAGE), ("TNH", CAGE), ("TNG", CAGE), ("TN", CAGE), ("TVH", CAGE), ("TVP", CAGE), ("T1X", CAGE), ("TYN", CAGE), ("TR", CAGE),
    ("FMA", CAGE), ("MA", CAGE), ("MB", CAGE), ("M", CAGE), ("JN", CAGE), ("J", CAGE), ("Y", CAGE), ("F", CAGE), ("W", CAGE), ("T", CAGE),
    ("P", CAGE),
    ("P4A", TOLERANCE), ("P4S", TOLERANCE), ("P6X", TOLERANCE), ("P2", TOLERANCE), ("P4", TOLERANCE), ("P5", TOLERANCE),
    ("P6", TOLERANCE), ("P0", TOLERANCE), ("ABEC1", TOLERANCE), ("ABEC3", TOLERANCE), ("ABEC5", TOLERANCE), ("ABEC7", TOLERANCE),
    ("ABEC9", TOLERANCE),
    ("DBB", MATCHED), ("DB", MATCHED), ("DF", MATCHED), ("DT", MATCHED), ("DU", MATCHED), ("SUL", MATCHED), ("SU", MATCHED),
    ("UL", MATCHED), ("UA", MATCHED), ("UO", MATCHED), ("CA", MATCHED), ("CB", MATCHED), ("CC", MATCHED), ("GA", MATCHED),
    ("GB", MATCHED), ("GC", MATCHED),
    ("MT33", GREASE), ("MT47", GREASE), ("GJN", GREASE), ("WT", GREASE),
    ("E", Part::Other("maker's design")), ("D", Part::Other("maker's design")),
];

/// Classes of the clearance by the digit that follows a tolerance class.
const CLASSES_OF_TOLERANCES: [(&str, Part); 4] = [
    ("2", Part::Class(Clearance::C2)),
    ("3", Part::Class(Clearance::C3)),
    ("4", Part::Class(Clearance::C4)),
    ("5", Part::Class(Clearance::C5)),
];

/// Parts before the number.
#[rustfmt::skip]
const PREFIXES: [(&str, Part); 8] = [
    ("HCB", Part::Hybrid), ("HC", Part::Hybrid), ("B", Part::Other("spindle bearing")),
    ("W", Part::Other("stainless steel")), ("SS", Part::Other("stainless steel")), ("S", Part::Other("stainless steel")),
    ("F", Part::Other("flange")),
    ("UC", Part::Other("insert bearing: sphere outside, wide inner ring and its screws")),
];

/// Other kinds of bearings by their prefixes.
#[rustfmt::skip]
const KINDS: [(&str, &[&str]); 4] = [
    ("a cylindrical roller bearing", &["NU", "NJ", "NUP", "N", "NF", "NN", "NNU", "NCF", "NJG", "RNU", "RN", "SL"]),
    ("a needle roller bearing", &["HK", "BK", "NK", "NKI", "NKIS", "NKS", "NA", "RNA", "K", "NAO"]),
    ("a thrust needle roller bearing", &["AXK"]),
    ("a four-point contact ball bearing", &["QJ", "Q"]),
];

const TAPERED: &str = "a tapered roller bearing";
const DOUBLE_ROW: &str = "a double-row angular contact ball bearing";
const SELF_ALIGNING: &str = "a self-aligning ball bearing";

/// Other kinds of bearings by how many digits their numbers have, and what these begin with.
#[rustfmt::skip]
const SERIES: [(&str, usize, &[&str]); 10] = [
    (TAPERED, 5, &["302", "303", "313", "320", "322", "323", "329", "330", "331", "332"]),
    ("a spherical roller bearing", 5, &["213", "222", "223", "230", "231", "232", "238", "239", "240", "241"]),
    ("a thrust ball bearing", 5, &["510", "522", "523", "524", "532", "533", "534"]),
    ("a thrust cylindrical roller bearing", 5, &["811", "812", "893", "894"]),
    ("a spherical roller thrust bearing", 5, &["292", "293", "294"]),
    (SELF_ALIGNING, 4, &["12", "13", "22", "23"]),
    (SELF_ALIGNING, 5, &["112", "113"]),
    (DOUBLE_ROW, 4, &["32", "33", "52", "53"]),
    ("a double-row deep groove ball bearing", 4, &["42", "43"]),
    (SELF_ALIGNING, 3, &["108", "126", "127", "129", "135"]),
];

/// Signs between words, beside the slash.
const BETWEEN: [char; 6] = [' ', '-', '_', ',', '.', '+'];

/// Head of a designation: letters, number, and what follows at once.
struct Head {
    prefix: String,
    number: String,
    rest: String,
}

impl Head {
    /// Letters, then three digits or more; a bore after a slash (60/22, 618/8) is part of the number.
    fn of(word: &str) -> Option<Self> {
        let (prefix, tail) = word.split_at(word.find(|sign: char| !sign.is_ascii_alphabetic())?);
        let digits = |text: &str| text.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(text.len());
        let (number, rest) = tail.split_at(digits(tail));
        if let Some(bore) = rest.strip_prefix('/').filter(|_| (2..=3).contains(&number.len())) {
            let (bore, rest) = bore.split_at(digits(bore));
            // 618/8 is the series 618 with a bore of 8 mm, which others call 688.
            let number = match number {
                "618" | "619" if bore.len() == 1 => format!("6{}{bore}", &number[2..]),
                _ => format!("{number}/{bore}"),
            };
            return (!bore.is_empty()).then(|| Self { prefix: prefix.into(), number, rest: rest.into() });
        }
        (number.len() >= 3).then(|| Self { prefix: prefix.into(), number: number.into(), rest: rest.into() })
    }

    /// Does it name an insert, alone or in its housing?
    fn is_insert(&self) -> bool {
        self.prefix.starts_with("UC")
    }

    /// Number in ISO's series: makers leave the 1 out of 61805 and 71905, and inserts have the inside of 62 or 63.
    fn number_of_series(&self) -> String {
        let number = &self.number;
        match number.as_bytes() {
            [b'2' | b'3', _, _] if self.is_insert() => format!("6{number}"),
            [b'6' | b'7', b'8' | b'9', _, _] => format!("{}1{}", &number[..1], &number[1..]),
            _ => number.clone(),
        }
    }

    /// Another kind of bearing, if it is one.
    fn other_kind(&self) -> Option<&'static str> {
        let by_prefix = KINDS.iter().find(|(_, prefixes)| prefixes.contains(&self.prefix.as_str()));
        let by_series = SERIES.iter().find(|(_, digits, series)| {
            let begins = series.iter().any(|of| self.number.starts_with(of));
            self.prefix.is_empty() && self.number.len() == *digits && begins
        });
        by_prefix.map(|(kind, _)| *kind).or(by_series.map(|(kind, ..)| *kind))
    }

    /// Takes the contact angle from what follows the number of an angular-contact bearing, in the table's letters. FAG's spindle bearings
    /// have E for 25 degrees, NSK has A5.
    fn angle(&self, words: &mut String) -> &'static str {
        let spindle = self.prefix == "B" || self.prefix == "HCB";
        let letters = [("AC", "AC"), ("A5", "AC"), ("A", "A"), ("B", "B"), ("C", "C"), ("E", "AC")];
        let text = words.trim_start_matches(' ');
        let found =
            letters.iter().find(|(letter, _)| text.starts_with(letter) && (*letter != "E" || spindle));
        let Some((letter, angle)) = found else { return "" };
        *words = text[letter.len()..].into();
        angle
    }
}

/// Parts of a word, the longest ones that are known; what is left where none is.
fn parts_of(word: &str) -> (Vec<(&'static str, Part)>, &str) {
    let (mut parts, mut rest) = (vec![], word);
    loop {
        let known = SUFFIXES.iter().filter(|(text, _)| rest.starts_with(text));
        // P63 is P6 and C3.
        let class = CLASSES_OF_TOLERANCES.iter().find(|(digit, _)| {
            rest == *digit && matches!(parts.last(), Some((_, part)) if *part == TOLERANCE)
        });
        match known.max_by_key(|(text, _)| text.len()).or(class) {
            Some(&(text, part)) => {
                parts.push((text, part));
                rest = &rest[text.len()..];
            }
            None => return (parts, rest),
        }
    }
}

/// Words of a designation in capitals, but for makers; what stands behind a slash is a word of its own.
pub(super) fn words_of(upper: &str) -> Vec<&str> {
    let words = upper.split(BETWEEN).flat_map(|word| word.split('/'));
    words.filter(|word| !word.is_empty() && !MAKERS.contains(word)).collect()
}

/// Kind, number and clearance of a cylindrical roller bearing of one row; none where a name is of something else.
pub(super) fn rollers(name: &str) -> Option<(String, String, Clearance)> {
    lettered(name, &["N", "NU", "NJ", "NUP"])
}

/// Number and clearance of a four-point contact ball bearing; none where a name is of something else.
pub(super) fn four_point(name: &str) -> Option<(String, Clearance)> {
    lettered(name, &["QJ"]).map(|(_, number, class)| (number, class))
}

/// Letters, number and clearance of a bearing whose kind is some letters before its number; none where they are others.
fn lettered(name: &str, kinds: &[&str]) -> Option<(String, String, Clearance)> {
    let upper = name.to_ascii_uppercase();
    let mut words = words_of(&upper).into_iter().peekable();
    let mut prefix = String::new();
    // The kind may stand apart, as in "NU 206".
    while words.peek()?.chars().all(|sign| sign.is_ascii_alphabetic()) {
        prefix += words.next()?;
    }
    let head = Head::of(words.next()?)?;
    prefix += &head.prefix;
    let parts = std::iter::once(head.rest.as_str()).chain(words).flat_map(|word| parts_of(word).0);
    let class = parts.into_iter().find_map(|(_, part)| match part {
        Part::Class(class) => Some(class),
        Part::Hybrid | Part::Other(_) => None,
    });
    kinds.contains(&prefix.as_str()).then(|| (prefix, head.number, class.unwrap_or_default()))
}

/// Number of a double-row angular contact bearing, and whether its letter is B; none where a name is of something else.
pub(super) fn double_row(name: &str) -> Option<(String, bool)> {
    let upper = name.to_ascii_uppercase();
    let mut words = words_of(&upper).into_iter();
    let head = words.find_map(Head::of)?;
    let is_b = head.rest.starts_with('B') || head.rest.is_empty() && words.next() == Some("B");
    (head.other_kind() == Some(DOUBLE_ROW)).then_some((head.number, is_b))
}

/// Number of a self-aligning ball bearing; none where a name is of something else.
pub(super) fn self_aligning(name: &str) -> Option<String> {
    let upper = name.to_ascii_uppercase();
    let head = words_of(&upper).into_iter().find_map(Head::of)?;
    (head.other_kind() == Some(SELF_ALIGNING)).then_some(head.number)
}

/// Series and code of the bore of a tapered roller bearing; nothing within where what follows them changes its contact angle. None where a name is of something else.
pub(super) fn tapered(name: &str) -> Option<Option<String>> {
    let upper = name.to_ascii_uppercase();
    let mut words = words_of(&upper).into_iter();
    let Head { prefix, number, rest } = words.find_map(Head::of)?;
    // NSK has HR before all of them, SNR and NTN have E and 4T.
    let is_tapered = ["", "HR", "E", "T"].contains(&prefix.as_str())
        && SERIES.iter().any(|(kind, digits, series)| {
            *kind == TAPERED && number.len() == *digits && series.iter().any(|of| number.starts_with(of))
        });
    let steeper = rest.starts_with(['B', 'C', 'D']) || words.next().is_some_and(|next| next.starts_with('B'));
    is_tapered.then(|| (!steeper).then_some(number))
}

/// Looks a designation up.
///
/// # Errors
/// Where the table has no such bearing; says of what kind it is, or which ones are near.
pub(super) fn find(name: &str) -> Result<Named, CatalogueError> {
    let upper = name.to_ascii_uppercase();
    let words: Vec<&str> =
        upper.split(BETWEEN).filter(|word| !word.is_empty() && !MAKERS.contains(word)).collect();
    let unknown = |near: String| CatalogueError::Unknown { name: name.into(), near };
    let at = words.iter().position(|word| Head::of(word).is_some()).ok_or_else(|| unknown(String::new()))?;
    let (before, behind) = words.split_at(at);
    let mut head = Head::of(behind[0]).ok_or_else(|| unknown(String::new()))?;
    // A prefix may stand apart, as in "NU 206" and "W 6205"; what has digits is something else.
    let (letters, other): (Vec<&str>, Vec<&str>) =
        before.iter().partition(|word| word.chars().all(|sign| sign.is_ascii_alphabetic()));
    head.prefix = letters.concat() + &head.prefix;
    if let Some(kind) = head.other_kind() {
        return Err(CatalogueError::Kind { name: name.into(), kind });
    }

    let number = head.number_of_series();
    let mut rest =
        std::iter::once(head.rest.as_str()).chain(behind[1..].iter().copied()).collect::<Vec<_>>().join(" ");
    let angular = number.starts_with('7');
    let thrust = number.starts_with("51");
    let designation = match angular {
        true => format!("{number} {}", head.angle(&mut rest)),
        false => number.clone(),
    };
    let row = table().find(|row| row.designation == designation).ok_or_else(|| {
        let alike = table().map(|row| row.designation).filter(|of| of.split(' ').next() == Some(&number));
        unknown(alike.collect::<Vec<_>>().join(", "))
    })?;

    let mut named = Named { row, clearance: None, hybrid: false, ignored: vec![] };
    let ignore = |text: &str, why: &str| format!("{text} ({why})");
    named.ignored.extend(other.iter().map(|word| ignore(word, "not known")));
    let prefix = PREFIXES.iter().find(|(text, _)| head.prefix == *text || *text == "UC" && head.is_insert());
    match (head.prefix.as_str(), prefix) {
        ("", _) => {}
        (_, Some((_, Part::Hybrid))) => named.hybrid = true,
        (text, Some((_, Part::Other(why)))) => named.ignored.push(ignore(text, why)),
        (text, _) => named.ignored.push(ignore(text, "not known")),
    }
    for word in rest.split([' ', '/']).filter(|word| !word.is_empty()) {
        let (parts, left) = parts_of(word);
        for (text, part) in parts {
            match part {
                Part::Class(_) if angular => {
                    named.ignored.push(ignore(text, "clearance of an angular-contact bearing"));
                }
                Part::Class(_) if thrust => {
                    named.ignored.push(ignore(text, "clearance, which a thrust bearing has none of"));
                }
                Part::Class(class) => named.clearance = Some(class),
                Part::Hybrid => named.hybrid = true,
                Part::Other(why) => named.ignored.push(ignore(text, why)),
            }
        }
        if !left.is_empty() {
            named.ignored.push(ignore(left, "not known"));
        }
    }
    Ok(named)
}
