//! Structs, enums, defaults and constants that scenes are read by, from the sources.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use quote::ToTokens;
use syn::{Attribute, Expr, Fields, File, ImplItem, Item, ItemImpl, Lit, Meta, Stmt, Type};

/// A key of a section.
#[derive(Clone)]
pub struct Field {
    pub name: String,
    /// Its documentation in one line.
    pub doc: String,
    pub kind: Type,
    /// Dimension of a schedule, from what it is deserialised by.
    pub quantity: Option<String>,
    /// Default where it stands beside the field: a function, or the default of a key of `[effects]`.
    pub default: Option<Expr>,
    /// Is the default that of its type?
    pub of_type: bool,
    pub skipped: bool,
}

/// A struct: its documentation and fields, and the name of the struct that is read in its place.
#[derive(Clone)]
pub struct Section {
    pub doc: String,
    pub fields: Vec<Field>,
    pub read_as: Option<String>,
    /// Defaults of all fields by `impl Default`.
    pub defaults: HashMap<String, Expr>,
    /// Are fields that are not given those of the default?
    pub all_default: bool,
}

/// A source file.
#[derive(Default)]
pub struct Source {
    pub path: PathBuf,
    pub sections: HashMap<String, Section>,
    /// Variants of enums: names in a scene and documentation, the default's first.
    pub enums: HashMap<String, Vec<(String, String)>>,
    pub functions: HashMap<String, Expr>,
    pub constants: HashMap<String, Expr>,
    /// Keys of `[effects]`.
    pub keys: Vec<Field>,
}

fn doc(attributes: &[Attribute]) -> String {
    let line = |attribute: &Attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(literal) => match &literal.lit {
                Lit::Str(text) => Some(text.value().trim().to_string()),
                _ => None,
            },
            _ => None,
        },
        _ => None,
    };
    attributes.iter().filter_map(line).collect::<Vec<_>>().join(" ")
}

/// Arguments of `#[serde(...)]`, as text without blanks.
fn serde(attributes: &[Attribute]) -> Vec<String> {
    let of = |attribute: &Attribute| match &attribute.meta {
        Meta::List(list) if list.path.is_ident("serde") => Some(list.tokens.to_string()),
        _ => None,
    };
    let all: Vec<String> = attributes.iter().filter_map(of).collect();
    all.join(",").split(',').map(|part| part.replace(' ', "")).collect()
}

/// What stands in quotes behind a word of `#[serde(...)]`.
fn named(parts: &[String], word: &str) -> Option<String> {
    let rest = parts.iter().find_map(|part| part.strip_prefix(&format!("{word}=\"")))?;
    Some(rest.trim_end_matches('"').to_string())
}

fn expression(text: &str) -> Expr {
    syn::parse_str(text).unwrap_or_else(|why| panic!("{text}: {why}"))
}

fn field(field: &syn::Field) -> Field {
    let parts = serde(&field.attrs);
    let by = named(&parts, "deserialize_with");
    Field {
        name: field.ident.as_ref().map(ToString::to_string).unwrap_or_default(),
        doc: doc(&field.attrs),
        kind: field.ty.clone(),
        // schedule::deserialize::<Angle,_>, of which the first part was cut at the comma.
        quantity: by.and_then(|by| Some(by.split_once("::<")?.1.to_string())),
        default: named(&parts, "default").map(|function| expression(&format!("{function}()"))),
        of_type: parts.iter().any(|part| part == "default"),
        skipped: parts.iter().any(|part| part == "skip"),
    }
}

fn snake_case(name: &str) -> String {
    let mut text = String::new();
    for (place, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && place > 0 {
            text.push('_');
        }
        text.extend(letter.to_lowercase());
    }
    text
}

/// The last expression of a function.
fn value(block: &syn::Block) -> Option<Expr> {
    match block.stmts.last()? {
        Stmt::Expr(value, None) => Some(value.clone()),
        _ => None,
    }
}

/// Fields of `Self { ... }` in `impl Default`.
fn defaults(item: &ItemImpl) -> HashMap<String, Expr> {
    let body = item.items.iter().find_map(|item| match item {
        ImplItem::Fn(function) => value(&function.block),
        _ => None,
    });
    let Some(Expr::Struct(literal)) = body else { return HashMap::new() };
    let of = |field: &syn::FieldValue| (field.member.to_token_stream().to_string(), field.expr.clone());
    literal.fields.iter().map(of).collect()
}

/// Keys of `keys! { /// Doc. "key" => field: Type = default, ... }`.
fn keys(tokens: &str) -> Vec<Field> {
    let own = tokens.split(" ; ").next().unwrap_or(tokens);
    let parse = |part: &str| {
        let (documentation, rest) = part.rsplit_once("] \"")?;
        let (name, rest) = rest.split_once("\" => ")?;
        let (kind, default) = rest.split_once(" : ")?.1.rsplit_once(" = ")?;
        let attributes = format!("{documentation}] struct Documented;");
        let attributes = syn::parse_str::<syn::ItemStruct>(&attributes).ok()?.attrs;
        Some(Field {
            name: name.to_string(),
            doc: doc(&attributes),
            kind: syn::parse_str(kind).ok()?,
            quantity: None,
            default: Some(expression(default)),
            of_type: false,
            skipped: false,
        })
    };
    // Keys end with a comma before the documentation of the next one.
    own.trim_end_matches([',', ' ', ';'])
        .split(" , # [doc")
        .enumerate()
        .filter_map(|(place, part)| {
            parse(&if place == 0 { part.to_string() } else { format!("# [doc{part}") })
        })
        .collect()
}

impl Source {
    fn read(path: &Path) -> Self {
        let file: File = syn::parse_file(&fs::read_to_string(path).unwrap()).unwrap();
        let mut source = Self { path: path.to_path_buf(), ..Self::default() };
        let mut by_default = HashMap::new();
        for item in &file.items {
            match item {
                Item::Struct(item) => {
                    let Fields::Named(fields) = &item.fields else { continue };
                    let parts = serde(&item.attrs);
                    let section = Section {
                        doc: doc(&item.attrs),
                        fields: fields.named.iter().map(field).collect(),
                        read_as: named(&parts, "try_from"),
                        defaults: HashMap::new(),
                        all_default: parts.iter().any(|part| part == "default"),
                    };
                    source.sections.insert(item.ident.to_string(), section);
                }
                Item::Enum(item) => {
                    let mut variants: Vec<_> = item.variants.iter().collect();
                    variants
                        .sort_by_key(|variant| !variant.attrs.iter().any(|of| of.path().is_ident("default")));
                    let own = |variant: &syn::Variant| named(&serde(&variant.attrs), "rename");
                    let of = |variant: &&syn::Variant| {
                        let name = own(variant).unwrap_or_else(|| snake_case(&variant.ident.to_string()));
                        (name, doc(&variant.attrs))
                    };
                    let words = serde(&item.attrs).iter().any(|part| part.starts_with("rename_all"))
                        || variants.iter().all(|variant| own(variant).is_some());
                    if words {
                        source.enums.insert(item.ident.to_string(), variants.iter().map(of).collect());
                    }
                }
                Item::Fn(item) => {
                    if let Some(value) = value(&item.block) {
                        source.functions.insert(item.sig.ident.to_string(), value);
                    }
                }
                Item::Const(item) => {
                    source.constants.insert(item.ident.to_string(), (*item.expr).clone());
                }
                Item::Impl(item) => {
                    let is_default = item.trait_.as_ref().is_some_and(|(path, _)| path.is_ident("Default"));
                    if is_default {
                        by_default.insert(item.self_ty.to_token_stream().to_string(), defaults(item));
                    }
                }
                Item::Macro(item) if item.mac.path.is_ident("keys") => {
                    source.keys = keys(&item.mac.tokens.to_string().replace('\n', " "));
                }
                _ => {}
            }
        }
        for (name, defaults) in by_default {
            if let Some(section) = source.sections.get_mut(&name) {
                section.defaults = defaults;
            }
        }
        source
    }
}

/// All files of a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|of| of == "rs") {
            found.push(path);
        }
    }
}

/// The sources of scenes.
pub fn sources() -> Vec<Source> {
    let root = Path::new(roulement_tests::ROOT).join("src");
    let mut found = vec![];
    for folder in ["schema", "effects", "scene", "contact/ball_race/film", "catalogue"] {
        files(&root.join(folder), &mut found);
    }
    found.sort();
    found.iter().map(|path| Source::read(path)).collect()
}
