//! Parts that a library needs to run, without what linkers leave beside it: symbols and debug data.

use std::mem::size_of;

use object::Endianness;
use object::elf::{FileHeader64, SHF_ALLOC, SHT_NOBITS, SectionHeader64, SymbolSection};
use object::endian::{U16, U64};
use object::pod::bytes_of;
use object::read::elf::{FileHeader, ProgramHeader, SectionHeader};

type File = FileHeader64<Endianness>;
type Section = SectionHeader64<Endianness>;

/// A library without its sections that are not loaded; all that is loaded stays where it is. Libraries that are not ELF, or have other
/// sections before loaded ones, are given back whole: linkers for Windows can leave symbols out (`scripts/package`).
pub fn stripped(library: Vec<u8>) -> Vec<u8> {
    shortened(&library).unwrap_or(library)
}

fn shortened(library: &[u8]) -> Option<Vec<u8>> {
    let mut header = *File::parse(library).ok()?;
    let endian = header.endian().ok()?;
    let sections = header.sections(endian, library).ok()?;
    let is_loaded = |section: &Section| section.sh_flags(endian).0 & SHF_ALLOC.0 != 0;
    let all: Vec<Section> = sections.iter().copied().collect();
    // The first one is empty in every file. Those that stay keep their numbers, by which symbols and other sections name them.
    let number = 1 + all.iter().skip(1).take_while(|section| is_loaded(section)).count();
    let (kept, left_out) = all.split_at_checked(number)?;
    if kept.len() == 1 || left_out.iter().any(is_loaded) {
        return None;
    }

    let in_file = kept.iter().filter(|section| section.sh_type(endian) != SHT_NOBITS);
    let sections_end =
        in_file.map(|section| section.sh_offset(endian).saturating_add(section.sh_size(endian)));
    let segments = header.program_headers(endian, library).ok()?.iter();
    let segments_end =
        segments.map(|segment| segment.p_offset(endian).saturating_add(segment.p_filesz(endian)));
    let loaded = usize::try_from(sections_end.chain(segments_end).max()?).ok()?;
    let mut short = library.get(..loaded)?.to_vec();

    // The names of all sections, so that those that stay have theirs at the same place.
    let mut names = *sections.section(header.section_strings_index(endian, library).ok()?).ok()?;
    let text = names.data(endian, library).ok()?;
    names.sh_offset = U64::new(endian, short.len() as u64);
    short.extend(text);
    short.resize(short.len().next_multiple_of(size_of::<u64>()), 0);

    header.e_shoff = U64::new(endian, short.len() as u64);
    header.e_shnum = U16::new(endian, u16::try_from(kept.len() + 1).ok()?);
    header.e_shstrndx = U16::new(endian, SymbolSection(u16::try_from(kept.len()).ok()?));
    kept.iter().chain([&names]).for_each(|section| short.extend(bytes_of(section)));
    short.get_mut(..size_of::<File>())?.copy_from_slice(bytes_of(&header));
    Some(short)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use object::{Object, ObjectSection, ObjectSegment};

    use super::*;

    /// The running test: a file with symbols.
    fn program() -> Vec<u8> {
        std::fs::read(std::env::current_exe().unwrap()).unwrap()
    }

    #[test]
    #[cfg(all(target_os = "linux", target_arch = "x86_64"))]
    fn invariant_all_that_is_loaded_stays() {
        let whole = program();
        let short = stripped(whole.clone());
        assert!(short.len() < whole.len());
        assert_eq!(stripped(short.clone()), short, "there is nothing more to leave out");

        let [before, after] = [&whole, &short].map(|bytes| object::File::parse(bytes.as_slice()).unwrap());
        assert_eq!((before.entry(), before.kind()), (after.entry(), after.kind()));
        // But for the head of the file, which says where the sections are.
        let head = size_of::<File>() as u64;
        for (old, new) in before.segments().zip(after.segments()) {
            assert_eq!((old.address(), old.file_range()), (new.address(), new.file_range()));
            let start = usize::try_from(head.saturating_sub(old.file_range().0)).unwrap();
            assert!(old.data().unwrap().get(start..) == new.data().unwrap().get(start..));
        }
        let names = |file: &object::File<'_>| -> Vec<String> {
            file.sections().map(|section| section.name().unwrap().to_string()).collect()
        };
        let (mut left, names_after) = (names(&before), names(&after));
        left.retain(|name| names_after.contains(name));
        assert_eq!(left, names_after);
        assert!(names_after.iter().any(|name| name == ".text"), "{names_after:?}");
        assert!(!names_after.iter().any(|name| [".symtab", ".strtab", ".comment"].contains(&name.as_str())));
        assert!(after.symbols().next().is_none() && before.symbols().next().is_some());
    }

    #[test]
    fn what_is_no_whole_library_is_given_back() {
        let program = program();
        // A file without sections: where they are and how many.
        let mut alone = program[..size_of::<File>()].to_vec();
        alone[40..48].fill(0);
        alone[60..62].fill(0);
        for bytes in
            [vec![], b"MZ and more".to_vec(), vec![0; 1000], program[..program.len() / 2].to_vec(), alone]
        {
            assert_eq!(stripped(bytes.clone()), bytes);
        }
    }
}
