//! `ffi.rs` says what `broadside.h` says: the header's declarations, translated here, are those of the crate's sources.
use std::collections::BTreeMap;

const HEADER: &str = include_str!("../../c/broadside.h");
const SOURCES: [&str; 3] =
    [include_str!("../src/ffi.rs"), include_str!("../src/pairs.rs"), include_str!("../src/world.rs")];

/// The text without what lies between `begin` and the next `end`.
fn without(mut text: &str, begin: &str, end: &str) -> String {
    let mut rest = String::new();
    while let Some(at) = text.find(begin) {
        rest += &text[..at];
        let after = &text[at + begin.len()..];
        text = after.find(end).map_or("", |found| &after[found + end.len()..]);
        rest.push('\n');
    }
    rest + text
}

/// `find_options` as `FindOptions`.
fn camel_case(name: &str) -> String {
    let capitalized = |word: &str| word[..1].to_uppercase() + &word[1..];
    name.split('_').map(capitalized).collect()
}

/// The Rust type of a C type without its stars.
fn type_of(name: &str) -> String {
    let translated = match name {
        "void" => "c_void",
        "char" => "c_char",
        "int" => "c_int",
        "double" => "f64",
        "size_t" => "usize",
        "int32_t" => "i32",
        "uint32_t" => "u32",
        "uint64_t" => "u64",
        _ => return camel_case(name.strip_prefix("broadside_").expect(name)),
    };
    translated.into()
}

/// `const broadside_pair** pairs` as `pairs: *mut *const Pair`.
fn variable_of(declaration: &str) -> String {
    let (text, is_const) = match declaration.trim().strip_prefix("const ") {
        Some(text) => (text, true),
        None => (declaration.trim(), false),
    };
    let (c_type, name) = text.rsplit_once(&[' ', '*'][..]).expect(declaration);
    let stars = text.matches('*').count();
    let mut rust_type = type_of(c_type.trim_end_matches('*').trim());
    for star in 0..stars {
        rust_type = format!("*{} {rust_type}", if star == 0 && is_const { "const" } else { "mut" });
    }
    match name.split_once('[') {
        Some((name, length)) => format!("{name}: [{rust_type}; {}]", length.trim_end_matches(']')),
        None => format!("{name}: {rust_type}"),
    }
}

/// The header's declarations in Rust, by name.
fn header() -> BTreeMap<String, String> {
    let text = without(&without(HEADER, "/*", "*/"), "#", "\n");
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut found = BTreeMap::new();
    for part in text.split("typedef struct ").skip(1) {
        let (name, rest) = part.split_once(' ').unwrap();
        let name = camel_case(name.strip_prefix("broadside_").unwrap());
        if let Some((fields, _)) = rest.strip_prefix('{').and_then(|rest| rest.split_once('}')) {
            if !fields.contains('(') {
                let fields: Vec<_> =
                    fields.split(';').filter(|field| field.contains(' ')).filter(|f| !f.trim().is_empty()).collect();
                let fields: Vec<_> = fields.into_iter().map(variable_of).collect();
                found.insert(format!("struct {name}"), fields.join(", "));
            }
        }
    }
    for part in text.split(';') {
        for export in ["BROADSIDE_API ", "BROADSIDE_EXPERIMENTAL "] {
            let (prototype, parameters) = match part.split_once(export).and_then(|(_, rest)| rest.split_once('(')) {
                Some(split) => split,
                None => continue,
            };
            let (result, name) = prototype.rsplit_once(' ').unwrap();
            let result = variable_of(&format!("{result} result")).replacen("result: ", " -> ", 1);
            let parameters = parameters.trim_end_matches(')');
            let parameters: Vec<_> = parameters.split(',').filter(|text| *text != "void").map(variable_of).collect();
            let result = if result == " -> c_void" { "" } else { &result };
            found.insert(format!("fn {name}"), format!("({}){result}", parameters.join(", ")));
        }
    }
    for part in text.split("enum {").skip(1) {
        for constant in part.split('}').next().unwrap().split(',') {
            let (name, value) = constant.split_once('=').unwrap();
            found.insert(format!("const {}", name.trim()), value.trim().into());
        }
    }
    found
}

/// The sources' `repr(C)` structs, functions and constants, by name.
fn sources() -> BTreeMap<String, String> {
    let mut found = BTreeMap::new();
    for source in SOURCES {
        let text = without(source, "//", "\n");
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in text.split("#[repr(C)]").skip(1).filter(|part| !part.contains("$name")) {
            let (name, rest) = part.split_once("pub struct ").unwrap().1.split_once(" { ").unwrap();
            let fields = rest.split_once('}').unwrap().0.replace("pub ", "");
            found.insert(format!("struct {name}"), fields.trim().trim_end_matches(',').into());
        }
        for part in text.split("pub fn broadside_").skip(1) {
            let (name, signature) = part.split(';').next().unwrap().split_at(part.find('(').unwrap());
            found.insert(format!("fn broadside_{name}"), signature.replace("r#", ""));
        }
        for part in text.split("pub const BROADSIDE_").skip(1) {
            let (name, value) = part.split(';').next().unwrap().split_once('=').unwrap();
            let name = name.split(':').next().unwrap();
            found.insert(format!("const BROADSIDE_{name}"), value.trim().into());
        }
    }
    found
}

#[test]
fn are_those_of_the_header() {
    let (mut header, sources) = (header(), sources());
    let version = HEADER.split_once("#define BROADSIDE_C_API_VERSION ").unwrap().1.lines().next().unwrap();
    header.insert("const BROADSIDE_C_API_VERSION".into(), version.into());
    assert!(sources.len() > 60, "{} declarations", sources.len());
    for (name, declaration) in &sources {
        assert_eq!(Some(declaration), header.get(name), "{name}");
    }
}
