//! Header check of shared libraries: can a platform of packages load this file?

use std::path::Path;

use roulement::interface::model_description::Version;

use object::{Architecture, BinaryFormat, FileKind, Object, ObjectKind, ObjectSegment};

/// A platform that packages know (FMI 2.0.4, section 2.3; FMI 3.0, section 2.5.1.4). FMI 2.0 names no other machine than x86: folders for these are
/// those that fmi-rs looks into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Platform {
    /// Folder below `binaries`.
    pub folder: &'static str,
    /// That of FMI 3.0.
    folder3: &'static str,
    /// Ending of its libraries.
    pub ending: &'static str,
    format: BinaryFormat,
    machine: Architecture,
}

/// Folders of both versions, ending, kind of file, machine.
const fn platform(
    [folder, folder3, ending]: [&'static str; 3],
    format: BinaryFormat,
    machine: Architecture,
) -> Platform {
    Platform { folder, folder3, ending, format, machine }
}

const PLATFORMS: [Platform; 5] = [
    platform(["linux64", "x86_64-linux", "so"], BinaryFormat::Elf, Architecture::X86_64),
    platform(["win64", "x86_64-windows", "dll"], BinaryFormat::Pe, Architecture::X86_64),
    platform(["darwin64", "x86_64-darwin", "dylib"], BinaryFormat::MachO, Architecture::X86_64),
    platform(["aarch64-linux", "aarch64-linux", "so"], BinaryFormat::Elf, Architecture::Aarch64),
    platform(["aarch64-darwin", "aarch64-darwin", "dylib"], BinaryFormat::MachO, Architecture::Aarch64),
];

/// Platforms whose libraries end as a file's name does.
pub struct Candidates(Vec<Platform>);

impl Candidates {
    /// Those of a file; none if no platform has such libraries.
    pub fn of(library: &Path) -> Option<Self> {
        let ending = library.extension().unwrap_or_default();
        let found: Vec<_> = PLATFORMS.into_iter().filter(|platform| ending == platform.ending).collect();
        (!found.is_empty()).then_some(Self(found))
    }

    /// Their folders, in words.
    pub fn folders(&self) -> String {
        self.0.iter().map(|platform| platform.folder).collect::<Vec<_>>().join(" or ")
    }

    /// Kind of library that one of them loads, in words.
    pub fn wanted(&self) -> String {
        let machines: Vec<_> = self.0.iter().map(|platform| machine_name(platform.machine, 64)).collect();
        format!("a shared library, {} for {}", format_name(self.0[0].format), machines.join(" or "))
    }

    /// The one whose loader loads a library.
    ///
    /// # Errors
    /// Kind of the file if there is none, in words.
    pub fn loading(&self, library: &[u8]) -> Result<Platform, String> {
        let found = kind(library)?;
        self.0.iter().copied().find(|platform| platform.wanted() == found).ok_or(found)
    }
}

fn format_name(format: BinaryFormat) -> String {
    match format {
        BinaryFormat::Elf => "ELF".into(),
        BinaryFormat::Pe => "PE".into(),
        BinaryFormat::MachO => "Mach-O".into(),
        other => format!("{other:?}"),
    }
}

fn machine_name(architecture: Architecture, bits: u32) -> String {
    match architecture {
        Architecture::X86_64 => "x86-64".into(),
        Architecture::Aarch64 if bits == 64 => "aarch64".into(),
        Architecture::Unknown => format!("an unknown machine of {bits} bits"),
        other => format!("{other:?} of {bits} bits"),
    }
}

impl Platform {
    /// Folder below `binaries` of packages of a version.
    pub fn folder_of(&self, version: Version) -> &'static str {
        match version {
            Version::V2 => self.folder,
            Version::V3 => self.folder3,
        }
    }

    /// Kind of library that its loader loads, in words.
    fn wanted(&self) -> String {
        format!("a shared library, {} for {}", format_name(self.format), machine_name(self.machine, 64))
    }
}

/// Kind of a whole file, in words.
///
/// # Errors
/// What it is if nothing loads it, or why it is not whole.
fn kind(library: &[u8]) -> Result<String, String> {
    match FileKind::parse(library) {
        Ok(FileKind::MachOFat32 | FileKind::MachOFat64) => {
            return Err("a universal file for several machines".into());
        }
        Err(_) => return Err("no library of any system, or cut off".into()),
        Ok(_) => {}
    }
    let file = object::File::parse(library).map_err(|why| format!("cut off or damaged ({why})"))?;
    let bits = if file.is_64() { 64 } else { 32 };
    // Programs of Linux that can be loaded anywhere say that they are libraries, but name who loads them.
    let program = file.section_by_name_bytes(b".interp").is_some();
    let kind = match file.kind() {
        ObjectKind::Dynamic if !program => "a shared library",
        ObjectKind::Dynamic | ObjectKind::Executable => "a program",
        ObjectKind::Relocatable => "an object file",
        _ => "neither library nor program",
    };
    let ends = file.segments().map(|segment| segment.file_range()).map(|(at, n)| at.saturating_add(n));
    match ends.max() {
        None | Some(0) if kind == "a shared library" => Err("cut off or damaged (nothing to load)".into()),
        Some(end) if end > library.len() as u64 => Err(format!("cut off: {} of {end} bytes", library.len())),
        _ => Ok(format!(
            "{kind}, {} for {}",
            format_name(file.format()),
            machine_name(file.architecture(), bits)
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const X86_64: u16 = 62;
    const AARCH64: u16 = 183;
    const RISCV: u16 = 243;
    /// Machine number of a PE file.
    const AMD64: u16 = 0x8664;
    const DLL: u16 = 0x2022;

    /// A file of zeros but for these bytes.
    fn bytes(length: usize, parts: &[(usize, &[u8])]) -> Vec<u8> {
        let mut file = vec![0; length];
        for (at, part) in parts {
            file[*at..at + part.len()].copy_from_slice(part);
        }
        file
    }

    /// ELF with a piece of 32 bytes to load.
    fn elf(bits: u8, kind: u16, machine: u16) -> Vec<u8> {
        let (header, entry) = if bits == 64 { (64u16, 56u16) } else { (52, 32) };
        let length = usize::from(header + entry) + 32;
        let class = [0x7f, b'E', b'L', b'F', if bits == 64 { 2 } else { 1 }, 1, 1];
        let (table, sizes) = if bits == 64 { (32, 52) } else { (28, 40) };
        let (at, n) = (u64::from(header + entry).to_le_bytes(), 32u64.to_le_bytes());
        let segment = usize::from(header);
        let (at_place, n_place) = if bits == 64 { (8, 32) } else { (4, 16) };
        let at = if bits == 64 { &at[..] } else { &at[..4] };
        let n = if bits == 64 { &n[..] } else { &n[..4] };
        bytes(
            length,
            &[
                (0, &class),
                (16, &kind.to_le_bytes()),
                (18, &machine.to_le_bytes()),
                (20, &1u32.to_le_bytes()),
                (table, &header.to_le_bytes()),
                (sizes, &header.to_le_bytes()),
                (sizes + 2, &entry.to_le_bytes()),
                (sizes + 4, &1u16.to_le_bytes()),
                (segment, &1u32.to_le_bytes()),
                (segment + at_place, at),
                (segment + n_place, n),
            ],
        )
    }

    /// PE with a section of 32 bytes.
    fn pe(machine: u16, characteristics: u16, bits: u8) -> Vec<u8> {
        let (magic, optional) = if bits == 64 { (0x20bu16, 112u16) } else { (0x10b, 96) };
        let section = 64 + 24 + usize::from(optional);
        bytes(
            section + 40 + 32,
            &[
                (0, b"MZ"),
                (0x3c, &64u32.to_le_bytes()),
                (64, b"PE\0\0"),
                (68, &machine.to_le_bytes()),
                (70, &1u16.to_le_bytes()),
                (84, &optional.to_le_bytes()),
                (86, &characteristics.to_le_bytes()),
                (88, &magic.to_le_bytes()),
                (section + 8, &32u32.to_le_bytes()),
                (section + 16, &32u32.to_le_bytes()),
                (section + 20, &(section as u32 + 40).to_le_bytes()),
            ],
        )
    }

    /// Mach-O of 64 bits with a segment of 32 bytes.
    fn macho(machine: u32, kind: u32) -> Vec<u8> {
        bytes(
            32 + 72 + 32,
            &[
                (0, &0xfeed_facfu32.to_le_bytes()),
                (4, &machine.to_le_bytes()),
                (12, &kind.to_le_bytes()),
                (16, &1u32.to_le_bytes()),
                (20, &72u32.to_le_bytes()),
                (32, &0x19u32.to_le_bytes()),
                (36, &72u32.to_le_bytes()),
                (72, &104u64.to_le_bytes()),
                (80, &32u64.to_le_bytes()),
            ],
        )
    }

    fn check(file: &str, library: &[u8]) -> Result<&'static str, String> {
        Candidates::of(Path::new(file)).unwrap().loading(library).map(|platform| platform.folder)
    }

    #[test]
    fn libraries_are_told_by_their_headers() {
        const AMD64_MAC: u32 = 0x0100_0007;
        const ARM64_MAC: u32 = 0x0100_000c;
        for (name, library, found) in [
            ("a.so", elf(64, 3, X86_64), Ok("linux64")),
            ("a.dll", pe(AMD64, DLL, 64), Ok("win64")),
            ("a.dylib", macho(AMD64_MAC, 6), Ok("darwin64")),
            ("a.so", elf(64, 3, AARCH64), Ok("aarch64-linux")),
            ("a.dylib", macho(ARM64_MAC, 6), Ok("aarch64-darwin")),
            // another machine
            ("a.so", elf(64, 3, RISCV), Err("a shared library, ELF for Riscv64 of 64 bits")),
            ("a.so", elf(64, 3, 0xfefe), Err("a shared library, ELF for an unknown machine of 64 bits")),
            ("a.dll", pe(0xaa64, DLL, 64), Err("a shared library, PE for aarch64")),
            // 32 bits
            ("a.so", elf(32, 3, 3), Err("a shared library, ELF for I386 of 32 bits")),
            ("a.so", elf(32, 3, X86_64), Err("a shared library, ELF for X86_64_X32 of 32 bits")),
            ("a.dll", pe(0x14c, DLL, 32), Err("a shared library, PE for I386 of 32 bits")),
            // another system
            ("a.so", pe(AMD64, DLL, 64), Err("a shared library, PE for x86-64")),
            ("a.dll", elf(64, 3, X86_64), Err("a shared library, ELF for x86-64")),
            ("a.dylib", elf(64, 3, X86_64), Err("a shared library, ELF for x86-64")),
            (
                "a.dylib",
                bytes(64, &[(0, b"\xca\xfe\xba\xbe\0\0\0\x02")]),
                Err("a universal file for several machines"),
            ),
            // no library
            ("a.so", elf(64, 2, X86_64), Err("a program, ELF for x86-64")),
            ("a.so", elf(64, 1, X86_64), Err("an object file, ELF for x86-64")),
            ("a.dll", pe(AMD64, 0x22, 64), Err("a program, PE for x86-64")),
            ("a.so", b"#!/bin/sh\necho no library\n".to_vec(), Err("no library of any system, or cut off")),
            ("a.so", vec![0; 1000], Err("no library of any system, or cut off")),
        ] {
            assert_eq!(check(name, &library), found.map_err(String::from), "{name}");
        }
    }

    #[test]
    fn a_program_named_as_a_library_is_refused() {
        let program = std::fs::read(std::env::current_exe().unwrap_or_default()).unwrap_or_default();
        if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
            assert_eq!(check("a.so", &program), Err("a program, ELF for x86-64".into()));
        }
    }

    #[test]
    fn a_library_cut_anywhere_is_refused() {
        for (name, library) in
            [("a.so", elf(64, 3, X86_64)), ("a.dll", pe(AMD64, DLL, 64)), ("a.dylib", macho(0x0100_0007, 6))]
        {
            assert!(check(name, &library).is_ok());
            for length in 0..library.len() {
                let why = check(name, &library[..length]).expect_err(&format!("{name} cut at {length}"));
                assert!(why.contains("cut off"), "{length}: {why}");
            }
        }
    }

    #[test]
    fn endings_name_the_platforms() {
        let folders = |file: &str| Candidates::of(Path::new(file)).map(|found| found.folders());
        assert_eq!(folders("x/libroulement.so").as_deref(), Some("linux64 or aarch64-linux"));
        assert_eq!(folders("roulement.dll").as_deref(), Some("win64"));
        assert_eq!(folders("libroulement.dylib").as_deref(), Some("darwin64 or aarch64-darwin"));
        assert_eq!((folders("roulement.lib"), folders("so")), (None, None));
    }

    #[test]
    fn every_platform_has_a_folder_of_its_own_in_both_versions() {
        for version in [Version::V2, Version::V3] {
            let mut folders: Vec<_> = PLATFORMS.iter().map(|platform| platform.folder_of(version)).collect();
            folders.sort_unstable();
            folders.dedup();
            assert_eq!(folders.len(), PLATFORMS.len());
        }
    }
}
